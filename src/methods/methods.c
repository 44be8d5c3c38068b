#include "methods/method.h"
#include "methods/larsson.h"
#include "methods/reference.h"
#include "methods/thick.h"

const struct sf_method_row sf_methods[] = {
    [SF_METHOD_NONE] = {.name = "none", .doc = "the scene without smoke"},
    [SF_METHOD_THICK] =
        {
            .name = "thick",
            .doc = "thick smoke with volumetric lighting: exact optical depth from lists of spheres, marched, any "
                   "number of clouds "
                   "behind each other (METHODS C1-C15)",
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
};
const uint32_t sf_method_count = sizeof sf_methods / sizeof sf_methods[0];
