/* sfumato verify: every method against the reference. For each scene the methods draw the smoke alone, the reference is
 * computed from the very particles that they drew, and the difference is put into a few numbers. */
#include "verify.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"
#include "../files.h"
#include "../progress.h"
#include "../session.h"

enum {
    SAMPLE_SIDE = 8,      /* pixels of the shorter side that tell what the reference will cost */
    LIVE_THOROUGH = 20000 /* particles up to which every image of the graph is looked at: a frame for each of them */
};

/* What one case works with; index: the entry. */
struct work {
    struct sf_verify *verify;
    struct sf_verify_case *result;
    struct sf_scene **scenes;
    struct sf_layers *layers; /* copies */
    struct sf_scene_info info;
    struct sf_reference *reference;
    struct sf_reference_picture *picture;
    double crossed; /* spheres, by a ray */
};

static enum sf_status out_of_memory(void)
{
    return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
}

/* ---- drawing ---- */

static struct sf_renderer_options drawing_options(const struct sf_verify *verify)
{
    return (struct sf_renderer_options){.width = verify->arguments->size.width,
                                        .height = verify->arguments->size.height,
                                        .float_color = true,
                                        .float_aovs = true,
                                        .aovs = SF_AOV_SMOKE | SF_AOV_DEPTHS,
                                        .particles = true};
}

/* malloc'ed; NULL when memory is out. */
static float *copy_layer(const float *layer, const struct sf_frame *frame)
{
    size_t bytes = (size_t)frame->width * frame->height * 4 * sizeof *layer;
    float *copy = malloc(bytes);

    if (copy)
        memcpy(copy, layer, bytes);
    return copy;
}

/* Copies of the reference's notes, so that it may go. */
static enum sf_status copy_notes(const struct sf_reference *reference, struct sf_verify_row *row)
{
    uint32_t count = 0;

    while (sf_reference_note(reference, count))
        count++;
    row->notes = calloc(count + 1, sizeof *row->notes);
    for (uint32_t i = 0; row->notes && i < count; i++)
        if (!(row->notes[i] = strdup(sf_reference_note(reference, i))))
            return out_of_memory();
    return row->notes ? SF_OK : out_of_memory();
}

/* The reference that the entry is held against, which is asked of all, so that one that has none says so. The first one
 * is kept: the same particles, lights and medium stand in all of them. */
static enum sf_status open_reference(struct work *work, size_t entry, const struct sf_frame *frame)
{
    const struct sf_arguments *arguments = work->verify->arguments;
    const struct sf_reference_options options = {.tolerance = arguments->tolerance.value,
                                                 .threads = arguments->threads};
    struct sf_reference *reference = NULL;
    enum sf_status status = sf_reference_create(work->scenes[entry], frame, &options, sf_console_log(), &reference);

    if (!status)
        status = copy_notes(reference, &work->result->rows[entry]);
    if (!status && !work->reference) {
        work->reference = reference;
        work->crossed = sf_verify_crossed(frame);
        return SF_OK;
    }
    sf_reference_destroy(&reference);
    return status;
}

static enum sf_status take_frame(struct work *work, size_t entry, const struct sf_frame *frame)
{
    struct sf_layers *layers = &work->layers[entry];

    if (!frame->smoke_float || !frame->smoke_depths)
        return sf_console_fail(SF_ERROR_USAGE,
                               "--methods %s: it has no layers of the smoke alone to be compared; leave it out",
                               work->verify->entries[entry].method);
    *layers = (struct sf_layers){.width = frame->width,
                                 .height = frame->height,
                                 .smoke = copy_layer(frame->smoke_float, frame),
                                 .depths = copy_layer(frame->smoke_depths, frame)};
    work->result->live = frame->live;
    return layers->smoke && layers->depths ? SF_OK : out_of_memory();
}

static enum sf_status draw_entry(struct work *work, size_t entry, struct sf_renderer *renderer)
{
    const struct sf_renderer_options options = drawing_options(work->verify);
    struct sf_verify_row *row = &work->result->rows[entry];
    struct sf_frame frame;
    uint64_t ticket;
    bool thorough;
    enum sf_status status = sf_renderer_render(renderer, work->result->frame, &ticket);

    if (!status)
        status = sf_renderer_wait(renderer, ticket, &frame);
    if (status)
        return status;
    sf_verify_check_particles(&frame, &row->fault);
    if (row->fault.found)
        return SF_OK;
    thorough = work->verify->entries[entry].sweep == 0 && frame.live <= LIVE_THOROUGH;
    status = take_frame(work, entry, &frame);
    if (!status)
        status = open_reference(work, entry, &frame);
    if (!status)
        status = sf_verify_trace(renderer, &options, &frame, thorough, &row->fault);
    return status;
}

static enum sf_status draw_entries(struct work *work)
{
    const struct sf_verify *verify = work->verify;
    const struct sf_renderer_options options = drawing_options(verify);
    struct sf_renderer *renderer = NULL;
    enum sf_status status = sf_renderer_create(verify->device, work->scenes[0], &options, sf_console_log(), &renderer);

    if (!status)
        status = sf_session_seek(renderer, work->result->frame);
    for (size_t i = 0; i < verify->entry_count && !status; i++) {
        if (i > 0)
            status = sf_renderer_set_scene(renderer, work->scenes[i]);
        if (!status)
            status = draw_entry(work, i, renderer);
        if (!work->reference)
            break; /* the particles are no good, for any of them */
        if (!status && sf_interrupted())
            status = SF_ERROR_INTERRUPTED;
    }
    sf_renderer_destroy(&renderer);
    return status;
}

/* ---- comparing ---- */

static bool show_rows(void *user, uint64_t done, uint64_t total)
{
    (void)total;
    sf_progress_show(user, done);
    return !sf_interrupted();
}

/* One pixel of each stride x stride into work->picture. */
static enum sf_status render_reference(struct work *work, const char *kind, uint32_t stride)
{
    struct sf_argument_size size = work->verify->arguments->size;
    struct sf_progress progress;
    enum sf_status status;
    char what[96];

    snprintf(what, sizeof what, "%s %zu of %zu, %.40s", kind, work->verify->case_count + 1, work->verify->case_total,
             work->result->name);
    sf_progress_begin(&progress, what, "rows", (size.height - 1) / stride + 1);
    status = sf_reference_render(work->reference, NULL, size.width, size.height, stride, show_rows, &progress,
                                 &work->picture);
    sf_progress_end(&progress);
    return status;
}

static enum sf_status compute_reference(struct work *work)
{
    const struct sf_arguments *arguments = work->verify->arguments;
    struct sf_argument_size size = arguments->size;
    struct sf_verify_case *result = work->result;
    uint64_t begin = sf_now_ns();
    uint32_t least = size.width < size.height ? size.width : size.height;
    enum sf_status status = SF_OK;

    result->stride = arguments->stride;
    if (result->stride == 0) {
        status = render_reference(work, "sample", least > SAMPLE_SIDE ? least / SAMPLE_SIDE : 1);
        if (status)
            return status;
        result->stride = sf_verify_stride(work->picture, size.width, size.height, work->crossed, work->info.lights);
        sf_reference_picture_destroy(&work->picture);
    }
    status = render_reference(work, "reference", result->stride);
    if (status)
        return status;
    result->unconverged = work->picture->unconverged;
    result->seconds = (double)(sf_now_ns() - begin) * 1e-9;
    return SF_OK;
}

static enum sf_status compare(struct work *work)
{
    const struct sf_arguments *arguments = work->verify->arguments;
    const struct sf_verify_drawn drawn = {work->layers, work->picture, work->info.tone, work->info.exposure};
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < work->verify->entry_count && !status; i++)
        status =
            sf_errors_measure(&work->layers[i], work->picture, work->result->stride, &work->result->rows[i].errors);
    if (!status && arguments->folder)
        status = sf_verify_write_pictures(work->verify, work->result, &drawn);
    return status;
}

/* ---- a case ---- */

static enum sf_status begin_case(struct work *work)
{
    struct sf_verify *verify = work->verify;
    struct sf_verify_case *result = work->result;
    enum sf_status status = SF_OK;

    result->rows = calloc(verify->entry_count, sizeof *result->rows);
    work->scenes = calloc(verify->entry_count, sizeof(struct sf_scene *));
    work->layers = calloc(verify->entry_count, sizeof *work->layers);
    if (!result->rows || !work->scenes || !work->layers)
        return out_of_memory();
    for (size_t i = 0; i < verify->entry_count && !status; i++)
        status = sf_verify_load(verify, result->path, &verify->entries[i], &work->scenes[i]);
    if (status)
        return status;
    sf_scene_describe(work->scenes[0], &work->info);
    snprintf(result->hash, sizeof result->hash, "%016llx", (unsigned long long)work->info.hash);
    return SF_OK;
}

static void end_case(struct work *work)
{
    for (size_t i = 0; i < work->verify->entry_count; i++) {
        if (work->scenes)
            sf_scene_destroy(&work->scenes[i]);
        if (work->layers) {
            free((void *)work->layers[i].smoke);
            free((void *)work->layers[i].depths);
        }
    }
    free(work->scenes);
    free(work->layers);
    sf_reference_picture_destroy(&work->picture);
    sf_reference_destroy(&work->reference);
}

static enum sf_status measure_case(struct sf_verify *verify)
{
    struct sf_verify_case *result = &verify->cases[verify->case_count];
    struct work work = {.verify = verify, .result = result};
    enum sf_status status = begin_case(&work);

    if (!status)
        status = draw_entries(&work);
    if (!status && work.reference)
        status = compute_reference(&work);
    if (!status && work.picture)
        status = compare(&work);
    if (!status && work.picture && verify->arguments->repeats > 0)
        status = sf_verify_time(verify, work.scenes, result);
    end_case(&work);
    if (status)
        return status;
    verify->case_count++;
    return verify->arguments->folder ? sf_verify_write_page(verify, verify->case_count == verify->case_total) : SF_OK;
}

/* ---- the command ---- */

static char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *stem = slash ? slash + 1 : path, *dot = strrchr(stem, '.');

    return strndup(stem, dot && dot > stem ? (size_t)(dot - stem) : strlen(stem));
}

/* Every scene at every frame. */
static enum sf_status list_cases(struct sf_verify *verify)
{
    size_t count = verify->path_count * verify->frame_count;

    verify->cases = calloc(count, sizeof *verify->cases);
    if (!verify->cases)
        return out_of_memory();
    verify->case_total = count;
    for (size_t i = 0; i < count; i++) {
        struct sf_verify_case *result = &verify->cases[i];

        result->path = verify->paths[i / verify->frame_count];
        result->frame = verify->frames[i % verify->frame_count];
        result->name = name_of(result->path);
        if (!result->name)
            return out_of_memory();
    }
    return SF_OK;
}

/* All scenes are read before anything is drawn, so that a mistake in the last one does not come after minutes. */
static enum sf_status check_scenes(const struct sf_verify *verify)
{
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < verify->path_count && !status; i++) {
        struct sf_scene *scene = NULL;

        status = sf_verify_load(verify, verify->paths[i], &verify->entries[0], &scene);
        sf_scene_destroy(&scene);
    }
    return status;
}

static enum sf_status begin(struct sf_verify *verify)
{
    const struct sf_arguments *arguments = verify->arguments;
    enum sf_status status;

    if (arguments->overwrite && !arguments->folder)
        return sf_console_fail(SF_ERROR_USAGE, "verify: --overwrite needs --output");
    status = sf_session_frames(arguments, &verify->frames, &verify->frame_count);
    if (!status)
        status = sf_verify_find_entries(verify);
    if (!status)
        status = sf_verify_find_scenes(verify);
    if (!status)
        status = list_cases(verify);
    if (!status && arguments->folder)
        status = sf_verify_folder_open(verify);
    if (!status)
        status = check_scenes(verify);
    if (!status)
        status = sf_session_device(arguments, NULL, &verify->device);
    if (!status)
        status = sf_session_size(arguments, verify->device);
    if (status)
        return status;
    sf_device_describe(verify->device, &verify->info);
    return SF_OK;
}

static enum sf_status report(const struct sf_verify *verify)
{
    char *text;

    if (!verify->arguments->json) {
        sf_verify_print(verify);
        return SF_OK;
    }
    text = sf_verify_json(verify);
    if (!text)
        return out_of_memory();
    puts(text);
    free(text);
    return SF_OK;
}

static void say_fault(const struct sf_verify_case *result, const struct sf_verify_entry *entry,
                      const struct sf_verify_fault *fault)
{
    char others[300] = "";

    if (strcmp(fault->image, "particles") == 0) {
        sf_console_fail(SF_ERROR_INTERNAL, "%s, frame %u: particle %u has a value of %g: %s or %s made it",
                        result->path, result->frame, fault->x, (double)fault->value, fault->pass, fault->others);
        return;
    }
    if (fault->others[0])
        snprintf(others, sizeof others, " (or %s before it)", fault->others);
    sf_console_fail(SF_ERROR_INTERNAL,
                    "%s, frame %u, method %s%s%s: %g in pixel (%u, %u) of image %s: pass %s made it%s", result->path,
                    result->frame, entry->method, entry->set ? ", " : "", entry->set ? entry->set : "",
                    (double)fault->value, fault->x, fault->y, fault->image, fault->pass, others);
}

/* What was found decides about the end: numbers that are none, and missed goals where they are asked for. */
static enum sf_status judge(const struct sf_verify *verify)
{
    enum sf_status status = SF_OK;
    size_t missed = 0;

    for (size_t c = 0; c < verify->case_count; c++) {
        for (size_t i = 0; i < verify->entry_count; i++) {
            const struct sf_verify_row *row = &verify->cases[c].rows[i];

            missed += sf_goals_missed(&row->errors) != 0;
            if (!row->fault.found)
                continue;
            say_fault(&verify->cases[c], &verify->entries[i], &row->fault);
            status = SF_ERROR_INTERNAL;
        }
    }
    if (!status && missed > 0 && verify->arguments->require_goals)
        return sf_console_fail(SF_ERROR_INTERNAL, "%zu of %zu rows miss a goal", missed,
                               verify->case_count * verify->entry_count);
    return status;
}

static void finish(struct sf_verify *verify)
{
    for (size_t c = 0; c < verify->case_total; c++) {
        struct sf_verify_case *result = &verify->cases[c];

        for (size_t i = 0; result->rows && i < verify->entry_count; i++) {
            for (char **note = result->rows[i].notes; note && *note; note++)
                free(*note);
            free(result->rows[i].notes);
        }
        free(result->rows);
        free(result->name);
    }
    for (size_t i = 0; i < verify->entry_count; i++) {
        free(verify->entries[i].method);
        free(verify->entries[i].set);
    }
    for (size_t i = 0; i < verify->path_count; i++)
        free(verify->paths[i]);
    free(verify->cases);
    free(verify->entries);
    free(verify->paths);
    free(verify->frames);
    sf_device_destroy(&verify->device);
}

enum sf_status sf_verify_run(const struct sf_arguments *arguments)
{
    struct sf_verify verify = {.arguments = arguments};
    enum sf_status status = begin(&verify), told;

    /* A page that says that it is not complete comes first: by it the pictures are known to be ours. */
    if (!status && arguments->folder)
        status = sf_verify_write_page(&verify, false);
    while (!status && verify.case_count < verify.case_total)
        status = measure_case(&verify);
    if (!status)
        status = sf_session_validated(arguments, verify.device);
    /* What is done is shown, even when the rest is not. */
    if (verify.case_count > 0 && (!status || status == SF_ERROR_INTERRUPTED)) {
        told = report(&verify);
        status = status ? status : told;
    }
    if (status == SF_ERROR_INTERRUPTED)
        sf_console_note("interrupted: %zu of %zu scenes were compared", verify.case_count, verify.case_total);
    if (!status && arguments->folder)
        sf_console_note("wrote %s/index.html", arguments->folder);
    if (!status)
        status = judge(&verify);
    finish(&verify);
    return status;
}
