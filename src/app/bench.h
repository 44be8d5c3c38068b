/* What a benchmark measured; bench.c fills it, report.c and compare.c write it. Times are ns, as double. */
#ifndef SF_APP_BENCH_H
#define SF_APP_BENCH_H

#include "options.h"
#include "sfumato/sfumato.h"

struct json_t;

struct sf_samples {
    double *values;
    size_t count, capacity;
};
struct sf_statistics {
    double min, median, p95, mean;
};

/* A pass, over all measured frames; one that runs several times in a frame counts as their sum. */
struct sf_bench_pass {
    char *name;
    bool simulation;
    struct sf_samples times;
    struct sf_statistics statistics;
    double total;                                                         /* ns over all frames */
    double runs;                                                          /* over all frames */
    double read_bytes, written_bytes;                                     /* over all frames */
    double frame_time, frame_bytes_read, frame_bytes_written, frame_runs; /* of the frame being added up */
};

struct sf_bench_event {
    size_t pass, frame_index;
    uint32_t frame;
    uint64_t begin_ns, end_ns, bytes;
};

struct sf_bench {
    const struct sf_arguments *arguments;
    struct sf_scene_info scene;
    char hash[17];
    struct sf_device_info device;
    uint32_t *frames;
    size_t frame_count; /* of the list; the samples have repeats times as many */
    struct sf_ceilings before, after;
    double goal; /* of the method, in compute copies; 0: none */
    struct sf_bench_pass *passes;
    size_t pass_count, pass_capacity;
    struct sf_samples simulation, picture, sum; /* of the passes' times in a frame */
    struct sf_samples span;                     /* from a frame's first pass to its last one's end */
    struct sf_samples wall;                     /* one frame at a time: from the call to the result */
    struct sf_samples pipelined;                /* a repeat: wall time a frame with two in flight */
    struct sf_samples record;                   /* CPU, to record a frame's passes */
    uint32_t recorded_passes;
    uint32_t live_first, live_last; /* particles in the first and the last frame of the list */
    struct sf_bench_event *events;
    size_t event_count, event_capacity;
};

enum sf_status sf_samples_add(struct sf_samples *samples, double value);
/* Zeros when there are no samples. Sorts them. */
struct sf_statistics sf_samples_describe(struct sf_samples *samples);
/* GB/s of the plain image copy: the better of before and after. */
double sf_bench_copy_rate(const struct sf_bench *bench);
/* ns of the compute copy: the mean of before and after. */
double sf_bench_compute_copy(const struct sf_bench *bench);

enum sf_status sf_bench_run(const struct sf_arguments *arguments);
enum sf_status sf_bench_sort_run(const struct sf_arguments *arguments);

/* ---- report.c ---- */
void sf_report_print(struct sf_bench *bench);
enum sf_status sf_report_json(struct sf_bench *bench, const char *path);
enum sf_status sf_report_csv(const struct sf_bench *bench, const char *path);
/* Writes `root` (a json_t, dumped with jansson's `flags`) and lets go of it; "-" is standard output. A NULL, or a member
 * that is missing for want of memory, is SF_ERROR_MEMORY. */
enum sf_status sf_report_write_json(struct json_t *root, size_t flags, const char *path);
enum sf_status sf_report_trace(const struct sf_bench *bench, const char *path);

/* ---- compare.c ---- */
struct sf_baseline;
/* A report of --json. SF_ERROR_IO, or SF_ERROR_USAGE when the file is something else. */
enum sf_status sf_baseline_load(const char *path, struct sf_baseline **baseline);
void sf_baseline_destroy(struct sf_baseline **baseline);
void sf_baseline_compare(const struct sf_baseline *baseline, struct sf_bench *bench);

#endif
