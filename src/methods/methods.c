#include "methods/method.h"
#include "methods/reference.h"
#include "methods/thick.h"

const struct sf_method_row sf_methods[] = {
    [SF_METHOD_NONE] = {.name = "none", .doc = "the scene without smoke"},
    [SF_METHOD_THICK] =
        {
            .name = "thick",
            .doc = "thick smoke with volumetric lighting: min/max depths from camera and lights, blurred, marched "
                   "(METHODS C1-C9)",
            .light = sf_thick_light,
            .view = sf_thick_view,
            .update = sf_thick_update,
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
