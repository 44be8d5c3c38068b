/* Where numbers that are none come from: every image of the frame's graph is looked at, in the order in which it was last
 * written, so that the first one found was made by that pass and not handed on to it. */
#include "verify.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"

/* The array's element of that name. */
static const json_t *find_named(const json_t *list, const char *name)
{
    size_t index;
    const json_t *item;

    json_array_foreach(list, index, item)
    {
        const char *own = json_string_value(json_object_get(item, "name"));

        if (own && strcmp(own, name) == 0)
            return item;
    }
    return NULL;
}

static bool has_name(const json_t *names, const char *name)
{
    size_t index;
    const json_t *item;

    json_array_foreach(names, index, item)
    {
        if (strcmp(json_string_value(item), name) == 0)
            return true;
    }
    return false;
}

static bool writes(const json_t *pass, const char *image)
{
    return has_name(json_object_get(pass, "writes"), image);
}

static bool written_later(const json_t *passes, size_t after, const char *image)
{
    for (size_t i = after + 1; i < json_array_size(passes); i++)
        if (writes(json_array_get(passes, i), image))
            return true;
    return false;
}

/* ---- one image ---- */

/* NaN; an infinity too when `infinities`. What no pass wrote is none of both. */
static bool is_fault(float value, bool infinities)
{
    return isnan(value) ? !sf_frame_unwritten(value) : infinities && isinf(value);
}

/* The first one in the rows' order. */
static bool look(const float *values, uint32_t width, uint32_t height, uint32_t channels, bool infinities,
                 struct sf_verify_fault *fault)
{
    size_t count = (size_t)width * height * channels;

    for (size_t i = 0; i < count; i++) {
        if (!is_fault(values[i], infinities))
            continue;
        fault->found = true;
        fault->value = values[i];
        fault->x = (uint32_t)(i / channels % width);
        fault->y = (uint32_t)(i / channels / width);
        return true;
    }
    return false;
}

static enum sf_status look_inside(struct sf_renderer *renderer, const struct sf_renderer_options *options,
                                  uint32_t number, const char *image, bool infinities, struct sf_verify_fault *fault)
{
    struct sf_renderer_options inspecting = *options;
    struct sf_frame frame;
    uint64_t ticket;
    enum sf_status status;

    inspecting.inspect = image;
    status = sf_renderer_set_options(renderer, &inspecting);
    if (!status)
        status = sf_renderer_render(renderer, number, &ticket);
    if (!status)
        status = sf_renderer_wait(renderer, ticket, &frame);
    if (!status && frame.inspected &&
        look(frame.inspected, frame.inspected_width, frame.inspected_height, frame.inspected_channels, infinities,
             fault))
        snprintf(fault->image, sizeof fault->image, "%s", image);
    return status;
}

/* ---- all of them ---- */

static void name_passes(const json_t *passes, size_t last, const char *image, struct sf_verify_fault *fault)
{
    size_t used = 0;

    snprintf(fault->pass, sizeof fault->pass, "%s",
             json_string_value(json_object_get(json_array_get(passes, last), "name")));
    for (size_t i = 0; i < last && used < sizeof fault->others; i++) {
        const json_t *pass = json_array_get(passes, i);

        if (writes(pass, image))
            used += (size_t)snprintf(fault->others + used, sizeof fault->others - used, "%s%s", used ? ", " : "",
                                     json_string_value(json_object_get(pass, "name")));
    }
}

static enum sf_status look_at_all(struct sf_renderer *renderer, const struct sf_renderer_options *options,
                                  uint32_t number, const json_t *graph, bool infinities, struct sf_verify_fault *fault)
{
    const json_t *passes = json_object_get(graph, "passes"), *resources = json_object_get(graph, "resources");
    enum sf_status status = SF_OK;

    for (size_t i = 0; i < json_array_size(passes) && !status && !fault->found; i++) {
        const json_t *names = json_object_get(json_array_get(passes, i), "writes");

        for (size_t k = 0; k < json_array_size(names) && !status && !fault->found; k++) {
            const char *name = json_string_value(json_array_get(names, k));
            const json_t *kind = json_object_get(find_named(resources, name), "kind");

            if (!kind || strcmp(json_string_value(kind), "image") != 0 || written_later(passes, i, name))
                continue;
            status = look_inside(renderer, options, number, name, infinities, fault);
            if (fault->found)
                name_passes(passes, i, name, fault);
        }
    }
    return status;
}

/* The graph "frame" of the renderer's; NULL with a message. */
static json_t *read_graph(const struct sf_renderer *renderer)
{
    char *text = NULL;
    json_t *root = sf_renderer_graph_print(renderer, "json", &text) == SF_OK ? json_loads(text, 0, NULL) : NULL;
    json_t *graphs = json_object_get(root, "graphs"), *graph, *found = NULL;
    size_t index;

    json_array_foreach(graphs, index, graph)
    {
        const char *name = json_string_value(json_object_get(graph, "graph"));

        if (name && strcmp(name, "frame") == 0)
            found = json_incref(graph);
    }
    json_decref(root);
    free(text);
    return found;
}

void sf_verify_check_particles(const struct sf_frame *frame, struct sf_verify_fault *fault)
{
    *fault = (struct sf_verify_fault){.found = false};
    for (uint32_t i = 0; i < frame->live; i++) {
        const struct sf_frame_particle *p = &frame->particles[i];
        const float values[] = {p->position[0], p->position[1], p->position[2], p->radius,     p->velocity[0],
                                p->velocity[1], p->velocity[2], p->extinction,  p->temperature};

        if (!look(values, sizeof values / sizeof *values, 1, 1, true, fault))
            continue;
        snprintf(fault->image, sizeof fault->image, "particles");
        snprintf(fault->pass, sizeof fault->pass, "sim.step");
        snprintf(fault->others, sizeof fault->others, "sim.emit");
        fault->x = i;
        return;
    }
}

/* In between an infinity may be meant; in what comes out it never is. */
static bool comes_out_wrong(const struct sf_frame *frame)
{
    const float *const out[] = {frame->color_float, frame->smoke_float, frame->smoke_depths};
    struct sf_verify_fault fault;

    for (size_t i = 0; i < sizeof out / sizeof *out; i++)
        if (look(out[i], frame->width, frame->height, 4, true, &fault))
            return true;
    return look(frame->depth, frame->width, frame->height, 1, true, &fault);
}

enum sf_status sf_verify_trace(struct sf_renderer *renderer, const struct sf_renderer_options *options,
                               const struct sf_frame *frame, bool thorough, struct sf_verify_fault *fault)
{
    uint32_t number = frame->frame;
    bool wrong = comes_out_wrong(frame);
    enum sf_status status, restored;
    json_t *graph;

    *fault = (struct sf_verify_fault){.found = false};
    if (!wrong && !thorough)
        return SF_OK;
    graph = read_graph(renderer);
    if (!graph)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    status = look_at_all(renderer, options, number, graph, wrong, fault);
    json_decref(graph);
    restored = sf_renderer_set_options(renderer, options);
    return status ? status : restored;
}
