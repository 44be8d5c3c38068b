/* What verify measured, for programs. */
#include "verify.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

/* JSON has no infinities. */
static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *fault_json(const struct sf_verify_fault *fault)
{
    if (!fault->found)
        return json_null();
    return json_pack("{s:s, s:s, s:s, s:i, s:i, s:s}", "image", fault->image, "pass", fault->pass, "earlier_passes",
                     fault->others, "x", (int)fault->x, "y", (int)fault->y, "value",
                     isnan(fault->value) ? "NaN"
                     : fault->value > 0  ? "Inf"
                                         : "-Inf");
}

static json_t *errors_json(const struct sf_errors *errors)
{
    unsigned missed = sf_goals_missed(errors);

    return json_pack("{s:{s:o, s:o, s:[ii]}, s:{s:o, s:o}, s:{s:o, s:o, s:o, s:o}, s:I, s:I, s:I, s:{s:b, s:b, s:b}}",
                     "transmittance", "mean", number(errors->transmittance_mean), "max",
                     number(errors->transmittance_max), "worst", (int)errors->worst[0], (int)errors->worst[1], "alpha",
                     "mean", number(errors->alpha_mean), "max", number(errors->alpha_max), "radiance", "relative_mse",
                     number(errors->relative_mse), "bias", number(errors->bias), "p99", number(errors->p99), "rms",
                     number(errors->rms), "pixels", (json_int_t)errors->pixels, "smoky", (json_int_t)errors->smoky,
                     "not_finite", (json_int_t)errors->not_finite, "goals", "transmittance_mean",
                     !(missed & SF_GOAL_MEAN), "transmittance_max", !(missed & SF_GOAL_MAX), "relative_mse",
                     !(missed & SF_GOAL_MSE));
}

static json_t *row_json(const struct sf_verify *verify, const struct sf_verify_case *result, size_t entry)
{
    const struct sf_verify_row *row = &result->rows[entry];
    const struct sf_verify_entry *from = &verify->entries[entry];
    json_t *object = json_pack("{s:s, s:o}", "method", from->method, "setting",
                               from->set ? json_string(from->set) : json_null()),
           *notes = json_array();

    json_object_update_new(object, errors_json(&row->errors));
    if (row->samples > 0)
        json_object_set_new(object, "time",
                            json_pack("{s:f, s:f, s:i}", "median_ms", row->ms, "least_ms", row->ms_least, "samples",
                                      (int)row->samples));
    json_object_set_new(object, "fault", fault_json(&row->fault));
    for (char *const *note = row->notes; note && *note; note++)
        json_array_append_new(notes, json_string(*note));
    json_object_set_new(object, "notes", notes);
    return object;
}

static json_t *case_json(const struct sf_verify *verify, const struct sf_verify_case *result)
{
    json_t *rows = json_array();

    for (size_t i = 0; i < verify->entry_count; i++)
        json_array_append_new(rows, row_json(verify, result, i));
    return json_pack("{s:s, s:s, s:s, s:i, s:I, s:{s:i, s:i, s:f}, s:o}", "scene", result->path, "name", result->name,
                     "scene_hash", result->hash, "frame", (int)result->frame, "particles", (json_int_t)result->live,
                     "reference", "stride", (int)result->stride, "unconverged", (int)result->unconverged, "seconds",
                     result->seconds, "rows", rows);
}

char *sf_verify_json(const struct sf_verify *verify)
{
    const struct sf_arguments *arguments = verify->arguments;
    json_t *cases = json_array(), *root;
    char *text;

    for (size_t i = 0; i < verify->case_count; i++)
        json_array_append_new(cases, case_json(verify, &verify->cases[i]));
    root = json_pack("{s:s, s:{s:s, s:s, s:s, s:s}, s:i, s:i, s:i, s:i, s:i, s:f, s:{s:f, s:f, s:f}, s:o}", "sfumato",
                     SF_VERSION, "device", "name", verify->info.name, "driver", verify->info.driver, "uuid",
                     verify->info.uuid, "kind", verify->info.kind, "width", (int)arguments->size.width, "height",
                     (int)arguments->size.height, "time_width", (int)arguments->time_size.width, "time_height",
                     (int)arguments->time_size.height, "repeats", (int)arguments->repeats, "tolerance",
                     arguments->tolerance.value, "goals", "transmittance_mean", sf_goals.transmittance_mean,
                     "transmittance_max", sf_goals.transmittance_max, "relative_mse", sf_goals.relative_mse, "cases",
                     cases);
    text = root ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(root);
    return text;
}
