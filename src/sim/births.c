#include "sim/births.h"

#include <math.h>
#include <string.h>
#include "sim/feed.h"

/* A step of an effect that begins again within one step of the simulation, so often that this many records do not hold
 * it, has the rest of its births in the last one, evenly. */
enum { RECORDS_EACH = 3 };

_Static_assert(SF_SIM_RECORDS >= RECORDS_EACH * SF_EMITTERS_MAX, "every emitter has room");

/* ---- emitters of the scene ---- */

/* The stream's births so far, not rounded, `steps` after its start. Multiplied before it is divided: whole numbers come
 * out whole. */
static double stream(const struct sf_emitter *emitter, double step_rate, double steps)
{
    if (emitter->duration > 0)
        steps = fmin(steps, emitter->duration * step_rate);
    return emitter->rate * steps / step_rate;
}

static uint64_t stream_births(const struct sf_emitter *emitter, double step_rate, uint64_t step)
{
    /* The float nearest to a decimal may lie just above it; a millionth of a particle keeps 0.1 s from becoming a step
     * later. */
    double births = floor(stream(emitter, step_rate, (double)step - emitter->start * step_rate) + 1e-6);

    return births > 0 ? (uint64_t)births : 0;
}

/* What is born all at once in the step that holds `start`. */
static uint64_t burst_births(const struct sf_emitter *emitter)
{
    return emitter->kind == SF_EMITTER_LIST ? emitter->list_count : (uint64_t)emitter->burst;
}

static bool burst_over(const struct sf_emitter *emitter, double step_rate, uint64_t step)
{
    if (emitter->kind == SF_EMITTER_LIST && !(emitter->start > 0))
        return true; /* there from the beginning */
    return emitter->start * step_rate < (double)step;
}

/* ---- emitters of effects ---- */

static double timed_births(const void *user, double local)
{
    const struct sf_emitter *emitter = user;

    return floor(sf_emitter_stream(emitter, local) + 1e-6) + (emitter->start < local ? emitter->burst : 0);
}

uint64_t sf_sim_births(const struct sf_scene *scene, const struct sf_emitter *emitter, uint64_t step)
{
    double step_rate = sf_sim_step_rate(scene);

    if (emitter->timing)
        return (uint64_t)sf_timing_sum(emitter->timing, (double)step / step_rate, timed_births, emitter);
    uint64_t births = burst_over(emitter, step_rate, step) ? burst_births(emitter) : 0;
    return emitter->kind == SF_EMITTER_LIST ? births : births + stream_births(emitter, step_rate, step);
}

/* ---- records ---- */

/* The step at hand. */
struct feeding {
    const struct sf_scene *scene;
    uint64_t step;
    double rate;   /* steps a second */
    uint32_t made; /* records of the emitter at hand */
    uint32_t emitter;
    struct sf_sim_now *now;
    struct sf_sim_births *births;
};

static void add_record(struct feeding *feeding, const struct sf_sim_record *pose, uint64_t births, double moment,
                       double interval)
{
    struct sf_sim_now *now = feeding->now;
    uint32_t room = now->capacity - now->births;
    uint32_t count = births < room ? (uint32_t)births : room;
    struct sf_sim_record *record = &feeding->births->records[now->record_count];

    now->refused += (uint32_t)(births - count);
    if (count == 0)
        return;
    now->births += count;
    if (feeding->made == RECORDS_EACH) {
        record[-1].count += count;
        return;
    }
    *record = *pose;
    record->first = now->births - count;
    record->count = count;
    record->begin[3] = (float)moment;
    record->end[3] = (float)interval;
    now->record_count++;
    feeding->made++;
}

static void feed_emitter(struct feeding *feeding, const struct sf_sim_layout *layout)
{
    const struct sf_emitter *emitter = &feeding->scene->emitters[feeding->emitter];
    uint64_t step = feeding->step;
    double rate = feeding->rate;
    uint64_t before = emitter->kind == SF_EMITTER_LIST ? 0 : stream_births(emitter, rate, step);
    uint64_t after = emitter->kind == SF_EMITTER_LIST ? 0 : stream_births(emitter, rate, step + 1);
    double start = emitter->start * rate, began = stream(emitter, rate, (double)step - start);
    struct sf_sim_record pose = {.emitter = feeding->emitter, .listed = layout->listed[feeding->emitter]};
    float unused[3];

    sf_scene_emitter_at(emitter, (double)step / rate, pose.begin, unused);
    sf_scene_emitter_at(emitter, (double)(step + 1) / rate, pose.end, unused);
    /* The mean velocity over the step: what the line from begin to end amounts to. */
    for (int axis = 0; axis < 3; axis++)
        pose.drift[axis] = (float)(emitter->inherit * ((double)pose.end[axis] - pose.begin[axis]) * rate);
    if (!burst_over(emitter, rate, step) && burst_over(emitter, rate, step + 1))
        add_record(feeding, &pose, burst_births(emitter), start - (double)step, 0);
    if (after > before)
        add_record(feeding, &pose, after - before, ((double)before + 1 - began) / emitter->rate * rate,
                   rate / emitter->rate);
}

/* The births of one run of the emitter's innermost clock within the step. */
static void feed_run(void *user, double begin, double end, double shift)
{
    struct feeding *feeding = user;
    const struct sf_emitter *emitter = &feeding->scene->emitters[feeding->emitter];
    double from = (begin + shift) * feeding->rate - (double)feeding->step, share = (end - begin) * feeding->rate;
    double began = sf_emitter_stream(emitter, begin), ended = sf_emitter_stream(emitter, end);
    uint64_t before = (uint64_t)floor(began + 1e-6), after = (uint64_t)floor(ended + 1e-6);
    struct sf_sim_record pose = {.emitter = feeding->emitter};
    float unused[3];

    sf_scene_emitter_at(emitter, begin, pose.begin, unused);
    sf_scene_emitter_at(emitter, end, pose.end, unused);
    for (int axis = 0; axis < 3; axis++) {
        double way = (double)pose.end[axis] - pose.begin[axis];

        pose.drift[axis] = (float)(emitter->inherit * way / (end - begin));
        /* The device goes from begin to end in a whole step, of which the run may be a part. */
        pose.begin[axis] = (float)(pose.begin[axis] - way * from / share);
        pose.end[axis] = (float)(pose.begin[axis] + way / share);
    }
    if (!(emitter->start < begin) && emitter->start < end)
        add_record(feeding, &pose, (uint64_t)emitter->burst, from + (emitter->start - begin) * feeding->rate, 0);
    if (after > before)
        add_record(feeding, &pose, after - before, from + ((double)before + 1 - began) / (ended - began) * share,
                   share / (ended - began));
}

void sf_sim_feed_births(const struct sf_scene *scene, const struct sf_sim_layout *layout, uint64_t step,
                        struct sf_sim_now *now, struct sf_sim_births *births)
{
    struct feeding feeding = {
        .scene = scene, .step = step, .rate = sf_sim_step_rate(scene), .now = now, .births = births};
    uint64_t first_id = 0;

    for (uint32_t i = 0; i < scene->emitter_count; i++) {
        const struct sf_emitter *emitter = &scene->emitters[i];

        feeding.emitter = i;
        feeding.made = 0;
        first_id += sf_sim_births(scene, emitter, step);
        if (emitter->timing)
            sf_timing_runs(emitter->timing, (double)step / feeding.rate, (double)(step + 1) / feeding.rate, feed_run,
                           &feeding);
        else
            feed_emitter(&feeding, layout);
    }
    now->first_id = (uint32_t)first_id;
}
