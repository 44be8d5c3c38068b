/* The compiled graphs of a scene as text, with no device: the simulation's step, the shadow map, the frame. */
#include "render/internal.h"

#include <stdlib.h>
#include <string.h>
#include "base/log.h"
#include "base/suggest.h"
#include "render/assemble.h"
#include "sim/particles.h"

/* A machine of two cores; sizes of workgroups follow from it, the graph's shape does not. */
static const struct sf_gpu_tuning DEFAULT_TUNING = {
    .software = true, .subgroup_size = 8, .workers = 2, .max_group_invocations = 1024, .shared_bytes = 32768};
static const char *const FORMATS[] = {"text", "dot", "json"};

struct printer {
    const struct sf_scene *scene;
    const struct sf_log *log;
    enum sf_plan_format format;
    struct sf_text text;
    uint32_t printed;
};

static void print_plan(struct printer *printer, const struct sf_plan *plan)
{
    if (printer->printed++ > 0)
        sf_text_append(&printer->text, printer->format == SF_PLAN_JSON ? ",\n" : "\n");
    sf_plan_print(plan, printer->format, &printer->text);
}

/* Takes the graph over. */
static enum sf_status print_graph(struct printer *printer, struct sf_graph *graph)
{
    struct sf_plan *plan = NULL;
    enum sf_status status = sf_plan_create(graph, NULL, printer->log, &plan);

    if (!status)
        print_plan(printer, plan);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
    return status;
}

static enum sf_status print_all(struct printer *printer, const struct sf_assembly *assembly)
{
    struct sf_shadow_scene shadow = sf_assembly_shadow(assembly);
    struct sf_shadow_pushes pushes;
    struct sf_graph *graph = NULL;
    enum sf_status status = sf_particles_declare(printer->scene, &DEFAULT_TUNING, printer->log, &graph);

    if (!status)
        status = print_graph(printer, graph);
    if (!status && shadow.cells->count > 0) {
        status = sf_shadow_declare(&shadow, &pushes, printer->log, &graph);
        if (!status)
            status = print_graph(printer, graph);
    }
    if (!status)
        print_plan(printer, assembly->plan);
    return status;
}

static enum sf_status parse_format(const char *name, const struct sf_log *log, enum sf_plan_format *format)
{
    for (size_t i = 0; i < SF_COUNT(FORMATS); i++) {
        if (strcmp(name, FORMATS[i]) == 0) {
            *format = (enum sf_plan_format)i;
            return SF_OK;
        }
    }
    const char *near = sf_suggest(name, FORMATS, SF_COUNT(FORMATS));
    return sf_fail(log, SF_ERROR_USAGE, "unknown graph format '%s'; %s%s%sthere are text, dot and json", name,
                   near ? "did you mean '" : "", near ? near : "", near ? "'? " : "");
}

enum sf_status sf_graph_print(const struct sf_scene *scene, uint32_t width, uint32_t height, uint32_t aovs,
                              const char *format, const struct sf_log *log, char **text)
{
    struct printer printer = {.scene = scene, .log = log};
    const struct sf_assembly_options options = {
        .width = width, .height = height, .aovs = aovs, .capacity = (uint32_t)scene->sim.capacity};
    struct sf_assembly *assembly = NULL;
    enum sf_status status = parse_format(format, log, &printer.format);

    *text = NULL;
    if (!status && (width == 0 || height == 0))
        status = sf_fail(log, SF_ERROR_USAGE, "a frame of %ux%u has no pixels; width and height are at least 1", width,
                         height);
    if (!status)
        status = sf_assembly_create(scene, &options, &DEFAULT_TUNING, NULL, log, &assembly);
    if (!status) {
        sf_text_append(&printer.text, printer.format == SF_PLAN_JSON ? "{\"graphs\": [\n" : "");
        status = print_all(&printer, assembly);
        sf_text_append(&printer.text, printer.format == SF_PLAN_JSON ? "]}\n" : "");
    }
    if (!status && printer.text.failed)
        status = sf_fail(log, SF_ERROR_MEMORY, "printing the graph: out of memory");
    sf_assembly_destroy(&assembly);
    if (status)
        sf_text_finish(&printer.text);
    *text = printer.text.data;
    return status;
}
