#include "methods/method.h"
#include "methods/atlas_shape.h"
#include "methods/billboard.h"
#include "methods/larsson.h"
#include "methods/mega.h"
#include "methods/reference.h"
#include "methods/sprites.h"
#include "methods/thick.h"
#include "methods/volumetric.h"

/* A method of billboards: `view_of` draws its particles, with assets of sf_<assets>_assets_* and push constants by `update_of`. */
#define BILLBOARDS_WITH(assets, update_of, name_of, doc_of, view_of)                                                   \
    {                                                                                                                  \
        .name = name_of, .doc = doc_of, .goal = 3, .light = sf_billboard_light, .view = view_of, .update = update_of,  \
        .state_bytes = sizeof(struct sf_billboards), .create_assets = sf_##assets##_assets_create,                     \
        .destroy_assets = sf_##assets##_assets_destroy, .same_assets = sf_##assets##_assets_same,                      \
        .bind_assets = sf_##assets##_assets_bind,                                                                      \
    }
#define BILLBOARDS(name_of, doc_of, view_of) BILLBOARDS_WITH(thick, sf_billboard_update, name_of, doc_of, view_of)

const struct sf_method_row sf_methods[] = {
    [SF_METHOD_NONE] = {.name = "none", .doc = "the scene without smoke"},
    [SF_METHOD_THICK] =
        {
            .name = "thick",
            .doc = "thick smoke with volumetric lighting: exact optical depth from lists of spheres, marched, any "
                   "number of clouds "
                   "behind each other (METHODS C1-C15)",
            .goal = 2,
            .light = sf_thick_light,
            .view = sf_thick_view,
            .update = sf_thick_update,
            .state_bytes = sizeof(struct sf_thick),
            .create_assets = sf_thick_assets_create,
            .destroy_assets = sf_thick_assets_destroy,
            .same_assets = sf_thick_assets_same,
            .bind_assets = sf_thick_assets_bind,
        },
    [SF_METHOD_LARSSON] =
        {
            .name = "thick-larsson",
            .doc = "thick smoke the thesis's way: min/max depths from camera and lights, blurred, one interval a ray "
                   "marched "
                   "(METHODS C1-C9)",
            .goal = 2,
            .light = sf_larsson_light,
            .view = sf_larsson_view,
            .update = sf_larsson_update,
            .state_bytes = sizeof(struct sf_thick),
            .create_assets = sf_thick_assets_create,
            .destroy_assets = sf_thick_assets_destroy,
            .same_assets = sf_thick_assets_same,
            .bind_assets = sf_thick_assets_bind,
        },
    [SF_METHOD_REFERENCE] =
        {
            .name = "reference",
            .doc = "the integral itself by ever more samples: single scattering, every light, smoke on smoke exactly "
                   "(METHODS G4)",
            .light = sf_reference_light,
            .view = sf_reference_view,
            .update = sf_reference_update,
            .state_bytes = sizeof(struct sf_reference),
            .plays = sf_reference_plays,
            .judge = sf_reference_judge,
            .create_assets = sf_reference_assets_create,
            .destroy_assets = sf_reference_assets_destroy,
            .same_assets = sf_reference_assets_same,
            .bind_assets = sf_reference_assets_bind,
        },
    [SF_METHOD_HARD] =
        BILLBOARDS("hard", "flat billboards, cut off where they meet the scene (METHODS B1)", sf_hard_view),
    [SF_METHOD_SOFT] = BILLBOARDS(
        "soft", "flat billboards that fade in proportion to the scene's distance (METHODS B2)", sf_soft_view),
    [SF_METHOD_CONTRAST] =
        BILLBOARDS("soft-contrast", "the same with a fade that is steep in its middle (METHODS B3)", sf_contrast_view),
    [SF_METHOD_SPHERICAL] = BILLBOARDS(
        "spherical", "spheres, denser in the middle, cut off by scene and near plane (METHODS B4)", sf_spherical_view),
    [SF_METHOD_MEGA] =
        {
            .name = "mega",
            .doc =
                "mega particles: Phong-lit balls, blurred, displaced by a noise that stays in the world (METHODS B8)",
            .goal = 3,
            .light = sf_mega_light,
            .view = sf_mega_view,
            .update = sf_mega_update,
            .state_bytes = sizeof(struct sf_mega),
            .create_assets = sf_thick_assets_create,
            .destroy_assets = sf_thick_assets_destroy,
            .same_assets = sf_thick_assets_same,
            .bind_assets = sf_thick_assets_bind,
        },
    [SF_METHOD_AVERAGE] = BILLBOARDS(
        "average-density", "slabs of even density, cut off by scene and near plane (METHODS B5)", sf_average_view),
    [SF_METHOD_EXTENT] =
        BILLBOARDS_WITH(atlas, sf_billboard_update, "density-extent",
                        "pictures whose alpha is their depth, lit by their normals (METHODS B6)", sf_extent_view),
    [SF_METHOD_VOLUMETRIC] = BILLBOARDS_WITH(volumetric, sf_billboard_update, "volumetric",
                                             "spheres marched through noise in space (METHODS B7)", sf_volumetric_view),
    [SF_METHOD_LIT] = BILLBOARDS_WITH(
        atlas, sf_lit_update, "lit",
        "billboards with the atlas's normals, each pixel lit, from behind as well (METHODS B9)", sf_lit_view),
    [SF_METHOD_SCATTERING] = BILLBOARDS_WITH(
        atlas, sf_scattering_update, "lit-scattering",
        "the same with light dimmed on its way through the puff's height field (METHODS B10)", sf_scattering_view),
};
const uint32_t sf_method_count = sizeof sf_methods / sizeof sf_methods[0];
