/* The comparison with the reference in the viewer: when it is made, and when it no longer holds. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "log_line.h"
#include "view.h"

/* What a picture follows from: all numbers, without gaps. */
static struct sf_subject subject_now(const struct sf_view *view)
{
    struct sf_subject subject = {.content = view->content,
                                 .frame = view->playback.frame,
                                 .width = view->options.width,
                                 .height = view->options.height};

    if (view->rig.own)
        sf_rig_view(&view->rig, &subject.eye);
    else
        sf_scene_view(view->model.scene, view->playback.frame / view->model.info.fps, &subject.eye);
    return subject;
}

/* The viewer and a device that computes on the processor need one of them. */
static unsigned threads_to_use(void)
{
    long processors = sysconf(_SC_NPROCESSORS_ONLN);

    return processors > 1 ? (unsigned)processors - 1 : 1;
}

static void drop_map(struct sf_against *against)
{
    sf_looking_finish(&against->heat);
    against->heat = (struct sf_looking){.heat = true, .automatic = true, .zoom = 1};
    against->mapped = false;
}

void sf_against_begin(struct sf_view *view)
{
    struct sf_against *against = &view->against;

    if (sf_shots_recording(view->shots)) {
        sf_view_note(view, SF_LOG_INFO, "no comparison while a sequence is recorded");
        return;
    }
    sf_against_stop(view);
    view->playback.playing = false;
    against->wanted = true;
    against->outdated = false;
    view->settle = true;
}

void sf_against_stop(struct sf_view *view)
{
    struct sf_against *against = &view->against;

    against->wanted = false;
    drop_map(against);
    if (against->comparison)
        sf_comparison_stop(against->comparison);
    against->gone = against->comparison != NULL;
    view->settle = true;
}

bool sf_against_due(const struct sf_view *view)
{
    return view->against.wanted && !view->against.comparison;
}

void sf_against_take(struct sf_view *view, const struct sf_frame *frame)
{
    struct sf_against *against = &view->against;

    against->wanted = false;
    against->gone = against->mapped = false;
    against->comparison =
        sf_comparison_begin(view->model.scene, frame, 1u << against->stride, threads_to_use(), &view->log);
    against->subject = subject_now(view);
    against->probe_wanted = true; /* of the pixel that was shown, in this picture */
    against->way = SF_WAY_AWAITED;
    if (!against->comparison)
        sf_view_note(view, SF_LOG_ERROR, "no memory for a comparison");
}

void sf_against_show(struct sf_view *view)
{
    struct sf_against *against = &view->against;
    uint32_t size[2], compared[2];
    float *values;

    if (against->kind == SF_AGAINST_PICTURE || !against->comparison) {
        free(against->heat.values);
        against->heat.values = NULL;
        return;
    }
    sf_comparison_size(against->comparison, size, compared);
    values = malloc((size_t)compared[0] * compared[1] * sizeof *values);
    if (values && sf_comparison_difference(against->comparison, (enum sf_difference)against->kind, values))
        sf_looking_take(&against->heat, &(struct sf_frame){.inspected = values,
                                                           .inspected_width = compared[0],
                                                           .inspected_height = compared[1],
                                                           .inspected_channels = 1});
    free(values);
}

void sf_against_probe(struct sf_view *view)
{
    const struct sf_against *against = &view->against;

    sf_comparison_probe(against->comparison, against->pixel[0], against->pixel[1]);
    view->dirty = view->dirty || against->way != SF_WAY_NONE;
}

bool sf_against_probes(const struct sf_view *view)
{
    return view->against.comparison && !view->against.gone;
}

void sf_against_aim(struct sf_view *view)
{
    const uint32_t *pixel = view->against.pixel;

    /* None may have been pointed at, or the window has another size now, which ends the comparison. */
    if (view->options.probe && pixel[0] < view->options.width && pixel[1] < view->options.height)
        sf_renderer_set_probe(view->renderer, pixel[0], pixel[1]);
}

void sf_against_land(struct sf_view *view, const struct sf_frame *frame)
{
    struct sf_against *against = &view->against;
    struct sf_probe_point *curve;

    if (!view->options.probe)
        return;
    against->way = SF_WAY_NONE;
    if (!frame->probe)
        return;
    against->way = SF_WAY_AWAITED;
    curve = realloc(against->curve, (frame->probe_count + 1) * sizeof *curve);
    if (!curve) {
        sf_view_note(view, SF_LOG_ERROR, "no memory for the method's samples along a ray");
        return;
    }
    memcpy(curve, frame->probe, frame->probe_count * sizeof *curve);
    against->curve = curve;
    against->curve_count = frame->probe_count;
    memcpy(against->curve_at, frame->probe_at, sizeof against->curve_at);
    against->way = SF_WAY_KNOWN;
    sf_log_line(&view->log, SF_LOG_DEBUG, "probed pixel %u, %u: %u points of the method", frame->probe_at[0],
                frame->probe_at[1], frame->probe_count);
}

/* In the log for those who drive the viewer by scripts, and in the picture's corner. */
static void say_result(struct sf_view *view)
{
    uint32_t unconverged;
    double seconds;
    const struct sf_errors *errors = sf_comparison_errors(view->against.comparison, &unconverged, &seconds);

    if (errors)
        sf_view_note(view, SF_LOG_INFO,
                     "compared with the reference in %.1f s: transmittance mean %.3g, max %.3g; relative MSE %.3g, "
                     "bias %.3g",
                     seconds, errors->transmittance_mean, errors->transmittance_max, errors->relative_mse,
                     errors->bias);
}

void sf_against_update(struct sf_view *view)
{
    struct sf_against *against = &view->against;
    struct sf_subject now = subject_now(view);
    uint64_t version;

    if (against->comparison && !against->gone && memcmp(&now, &against->subject, sizeof now) != 0) {
        bool wanted = against->wanted;

        sf_against_stop(view);
        against->wanted = wanted;
        against->outdated = true;
    }
    if (against->gone && !sf_comparison_busy(against->comparison)) {
        sf_comparison_destroy(&against->comparison);
        against->gone = false;
        view->settle = true;
    }
    if (!against->comparison || against->gone)
        return;
    version = sf_comparison_version(against->comparison);
    view->settle = view->settle || version != against->seen;
    against->seen = version;
    if (!against->mapped && sf_comparison_stage(against->comparison) == SF_COMPARISON_DONE) {
        against->mapped = true;
        sf_against_show(view);
        say_result(view);
    }
}

bool sf_against_busy(const struct sf_view *view)
{
    return view->against.comparison && (view->against.gone || sf_comparison_busy(view->against.comparison));
}

void sf_against_finish(struct sf_view *view)
{
    sf_comparison_destroy(&view->against.comparison);
    sf_looking_finish(&view->against.heat);
    free(view->against.curve);
    view->against.curve = NULL;
}
