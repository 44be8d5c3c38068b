#include "stats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double NS_TO_MS = 1e-6;
enum { UNKNOWN = SF_STATS_PASSES, LINE_BYTES = 160 };

/* Of the `count` values that are above 0 (those that are not were not measured); mixes `values` up. 0 when there are
 * none. */
static float median_of(float *values, unsigned count)
{
    unsigned kept = 0, low = 0, high, middle;
    float below = 0;

    for (unsigned i = 0; i < count; i++)
        if (values[i] > 0)
            values[kept++] = values[i];
    if (kept == 0)
        return 0;
    middle = kept / 2;
    high = kept - 1;
    while (low < high) { /* Hoare's selection: what is left of `middle` is at most it */
        float pivot = values[(low + high) / 2];
        unsigned i = low, j = high;

        for (;; i++, j--) {
            while (values[i] < pivot)
                i++;
            while (values[j] > pivot)
                j--;
            if (i >= j)
                break;
            float other = values[i];
            values[i] = values[j];
            values[j] = other;
        }
        if (middle <= j)
            high = j;
        else
            low = j + 1;
    }
    if (kept % 2)
        return values[middle];
    for (unsigned i = 0; i < middle; i++)
        below = values[i] > below ? values[i] : below;
    return (below + values[middle]) / 2;
}

/* ---- passes ---- */

static unsigned find(const struct sf_stats *stats, const char *name)
{
    for (unsigned i = 0; i < stats->pass_count; i++)
        if (strncmp(stats->passes[i].name, name, SF_STATS_NAME_BYTES - 1) == 0)
            return i;
    return UNKNOWN;
}

/* Index of a new pass; when all are taken, of one that did not run in this frame. */
static unsigned add(struct sf_stats *stats, const char *name, const bool *seen)
{
    unsigned index = stats->pass_count;

    if (index == SF_STATS_PASSES) {
        for (index = 0; index < SF_STATS_PASSES && seen[index]; index++)
            ;
        if (index == SF_STATS_PASSES)
            return UNKNOWN;
    } else {
        stats->pass_count++;
    }
    stats->passes[index] = (struct sf_stats_pass){0};
    snprintf(stats->passes[index].name, SF_STATS_NAME_BYTES, "%s", name);
    return index;
}

/* Puts the passes that ran into the order in which they did; those that did not stay behind the ones that they stood
 * behind. `ran`: indices in that order. */
static void reorder(struct sf_stats *stats, const unsigned *ran, unsigned ran_count, const bool *seen)
{
    unsigned order[SF_STATS_PASSES], rank[SF_STATS_PASSES], place[SF_STATS_PASSES], count = 0, done = 0;

    for (unsigned i = 0; i < ran_count; i++)
        rank[ran[i]] = i;
    for (unsigned i = 0; i < stats->pass_count; i++) {
        if (!seen[i])
            order[count++] = i;
        else
            while (done <= rank[i])
                order[count++] = ran[done++];
    }
    for (unsigned i = 0; i < count; i++)
        place[order[i]] = i;
    for (unsigned i = 0; i < count; i++)
        while (place[i] != i) {
            unsigned to = place[i];
            struct sf_stats_pass pass = stats->passes[to];

            stats->passes[to] = stats->passes[i];
            stats->passes[i] = pass;
            place[i] = place[to];
            place[to] = to;
        }
}

/* The frame's runs, summed for each pass. */
static void gather(struct sf_stats *stats, const struct sf_pass_timing *timings, uint32_t count)
{
    bool seen[SF_STATS_PASSES] = {0};
    unsigned ran[SF_STATS_PASSES], ran_count = 0;

    for (uint32_t i = 0; i < count; i++) {
        const struct sf_pass_timing *timing = &timings[i];
        unsigned index = find(stats, timing->name);

        if (index == UNKNOWN)
            index = add(stats, timing->name, seen);
        if (index == UNKNOWN)
            continue;
        struct sf_stats_pass *pass = &stats->passes[index];
        if (!seen[index]) {
            seen[index] = true;
            ran[ran_count++] = index;
            pass->last = 0;
            pass->bytes = 0;
        }
        if (timing->end_ns > timing->begin_ns)
            pass->last += (float)((double)(timing->end_ns - timing->begin_ns) * NS_TO_MS);
        pass->bytes += timing->bytes_read + timing->bytes_written;
    }
    for (unsigned i = 0; i < stats->pass_count; i++)
        stats->passes[i].present = seen[i];
    reorder(stats, ran, ran_count, seen);
}

static void settle_pass(struct sf_stats_pass *pass)
{
    float sorted[SF_STATS_KEPT];

    pass->ms[pass->next] = pass->last;
    pass->next = (pass->next + 1) % SF_STATS_KEPT;
    pass->count += pass->count < SF_STATS_KEPT;
    memcpy(sorted, pass->ms, pass->count * sizeof *sorted);
    pass->median = median_of(sorted, pass->count);
}

/* ---- frames ---- */

/* From the first pass's begin to the last one's end. */
static float span_of(const struct sf_pass_timing *timings, uint32_t count)
{
    uint64_t begin = UINT64_MAX, end = 0;

    for (uint32_t i = 0; i < count; i++) {
        begin = timings[i].begin_ns < begin ? timings[i].begin_ns : begin;
        end = timings[i].end_ns > end ? timings[i].end_ns : end;
    }
    return end > begin ? (float)((double)(end - begin) * NS_TO_MS) : 0;
}

static float median_of_frames(const struct sf_stats *stats, const float *ms)
{
    float sorted[SF_STATS_FRAMES];

    memcpy(sorted, ms, stats->frame_count * sizeof *sorted);
    return median_of(sorted, stats->frame_count);
}

void sf_stats_add(struct sf_stats *stats, const struct sf_pass_timing *timings, uint32_t count, float cpu_ms,
                  float wall_ms, float record_ms)
{
    gather(stats, timings, count);
    for (unsigned i = 0; i < stats->pass_count; i++)
        if (stats->passes[i].present)
            settle_pass(&stats->passes[i]);
    stats->gpu_ms[stats->next] = span_of(timings, count);
    stats->cpu_ms[stats->next] = cpu_ms;
    stats->wall_ms[stats->next] = wall_ms;
    stats->record_ms = record_ms;
    stats->next = (stats->next + 1) % SF_STATS_FRAMES;
    stats->frame_count += stats->frame_count < SF_STATS_FRAMES;
    stats->gpu_median = median_of_frames(stats, stats->gpu_ms);
    stats->cpu_median = median_of_frames(stats, stats->cpu_ms);
    stats->wall_median = median_of_frames(stats, stats->wall_ms);
}

void sf_stats_clear(struct sf_stats *stats)
{
    stats->pass_count = 0;
}

float sf_stats_share(const struct sf_stats *stats, const struct sf_stats_pass *pass)
{
    const struct sf_ceilings *ceilings = &stats->ceilings;

    if (pass->median <= 0 || ceilings->bytes == 0 || ceilings->image_copy_ns == 0)
        return 0;
    return (float)((double)pass->bytes / pass->median * NS_TO_MS * (double)ceilings->image_copy_ns /
                   (double)ceilings->bytes);
}

enum sf_stats_group sf_stats_group_of(const struct sf_stats_pass *pass)
{
    static const struct {
        const char *room;
        enum sf_stats_group group;
    } rooms[] = {{"sim.", SF_STATS_SIMULATION},
                 {"scene.", SF_STATS_SCENE},
                 {"shadow.", SF_STATS_SCENE},
                 {"output.", SF_STATS_OUTPUT}};

    for (unsigned i = 0; i < sizeof rooms / sizeof *rooms; i++)
        if (strncmp(pass->name, rooms[i].room, strlen(rooms[i].room)) == 0)
            return rooms[i].group;
    return SF_STATS_SMOKE;
}

const char *sf_stats_group_name(enum sf_stats_group group)
{
    static const char *const names[SF_STATS_GROUPS] = {"simulation", "scene", "smoke", "output"};

    return names[group];
}

float sf_stats_group_ms(const struct sf_stats *stats, enum sf_stats_group group)
{
    float sum = 0;

    for (unsigned i = 0; i < stats->pass_count; i++)
        if (stats->passes[i].present && sf_stats_group_of(&stats->passes[i]) == group)
            sum += stats->passes[i].median;
    return sum;
}

/* ---- as text ---- */

/* One line at `text`, which has LINE_BYTES; its length. */
static size_t print_pass(const struct sf_stats *stats, const struct sf_stats_pass *pass, char *text)
{
    float share = sf_stats_share(stats, pass);
    double megabytes = (double)pass->bytes * 1e-6;
    int length = snprintf(text, LINE_BYTES, "%-28s %8.3f %8.3f %9.3f %7.2f", pass->name, (double)pass->last,
                          (double)pass->median, megabytes, pass->median > 0 ? megabytes / (double)pass->median : 0);

    if (share > 0)
        length += snprintf(text + length, LINE_BYTES - (size_t)length, " %6.1f%%", (double)share * 100);
    length += snprintf(text + length, LINE_BYTES - (size_t)length, "\n");
    return (size_t)length;
}

char *sf_stats_print(const struct sf_stats *stats)
{
    size_t used = 0;
    char *text = malloc((size_t)(stats->pass_count + SF_STATS_GROUPS + 4) * LINE_BYTES);

    if (!text)
        return NULL;
    used += (size_t)snprintf(text, LINE_BYTES, "%-28s %8s %8s %9s %7s %7s\n", "pass, a frame", "last ms", "median",
                             "MB", "GB/s", "of copy");
    for (enum sf_stats_group group = 0; group < SF_STATS_GROUPS; group++) {
        float ms = sf_stats_group_ms(stats, group);

        for (unsigned i = 0; i < stats->pass_count; i++)
            if (stats->passes[i].present && sf_stats_group_of(&stats->passes[i]) == group)
                used += print_pass(stats, &stats->passes[i], text + used);
        if (ms > 0)
            used += (size_t)snprintf(text + used, LINE_BYTES, "%-28s %8s %8.3f\n", sf_stats_group_name(group), "",
                                     (double)ms);
    }
    snprintf(text + used, 3 * LINE_BYTES,
             "frame on the device %.3f ms, recording %.3f ms, CPU %.3f ms, from picture to picture %.3f ms\n",
             (double)stats->gpu_median, (double)stats->record_ms, (double)stats->cpu_median,
             (double)stats->wall_median);
    return text;
}
