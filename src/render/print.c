/* The compiled graphs as text: the simulation's step, the shadow map, the frame. Of a scene, with no device, or of a
 * renderer. */
#include <string.h>
#include "base/log.h"
#include "base/suggest.h"
#include "render/renderer.h"

/* A machine of two cores; sizes of workgroups follow from it, the graph's shape does not. */
static const struct sf_gpu_tuning DEFAULT_TUNING = {
    .software = true, .subgroup_size = 8, .workers = 2, .max_group_invocations = 1024, .shared_bytes = 32768};
static const char *const FORMATS[] = {"text", "dot", "json"};

struct printer {
    const struct sf_log *log;
    const struct sf_plan_memory *memory; /* the device's needs, or NULL */
    enum sf_plan_format format;
    struct sf_text text;
    uint32_t printed;
};

static void print_plan(struct printer *printer, const struct sf_plan *plan)
{
    bool json = printer->format == SF_PLAN_JSON;

    if (printer->printed++ > 0)
        sf_text_append(&printer->text, json ? ",\n" : "\n");
    else
        sf_text_append(&printer->text, json ? "{\"graphs\": [\n" : "");
    sf_plan_print(plan, printer->format, &printer->text);
}

/* Takes the graph over. */
static enum sf_status print_graph(struct printer *printer, struct sf_graph *graph)
{
    struct sf_plan *plan = NULL;
    enum sf_status status = sf_plan_create(graph, printer->memory, printer->log, &plan);

    if (!status)
        print_plan(printer, plan);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
    return status;
}

static enum sf_status print_shadow(struct printer *printer, const struct sf_drawn *drawn)
{
    struct sf_shadow_scene shadow = sf_drawn_shadow(drawn);
    struct sf_shadow_pushes pushes;
    struct sf_graph *graph = NULL;
    enum sf_status status;

    if (shadow.cells->count == 0)
        return SF_OK;
    status = sf_shadow_declare(&shadow, &pushes, printer->log, &graph);
    return status ? status : print_graph(printer, graph);
}

/* Ends the text and hands it over. */
static enum sf_status finish(struct printer *printer, enum sf_status status, char **text)
{
    if (printer->format == SF_PLAN_JSON)
        sf_text_append(&printer->text, "]}\n");
    if (!status && printer->text.failed)
        status = sf_fail(printer->log, SF_ERROR_MEMORY, "printing the graph: out of memory");
    if (status)
        sf_text_finish(&printer->text);
    *text = printer->text.data;
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
    struct printer printer = {.log = log};
    const struct sf_assembly_options options = {
        .width = width, .height = height, .aovs = aovs, .capacity = (uint32_t)scene->sim.capacity};
    struct sf_assembly *assembly = NULL;
    struct sf_graph *simulation = NULL;
    enum sf_status status = parse_format(format, log, &printer.format);

    if (!status && (width == 0 || height == 0))
        status = sf_fail(log, SF_ERROR_USAGE, "a frame of %ux%u has no pixels; width and height are at least 1", width,
                         height);
    if (!status)
        status = sf_assembly_create(scene, &options, &DEFAULT_TUNING, NULL, log, &assembly);
    if (!status)
        status = sf_particles_declare(scene, &DEFAULT_TUNING, log, &simulation);
    if (!status)
        status = print_graph(&printer, simulation);
    if (!status)
        status = print_shadow(&printer, &assembly->drawn);
    if (!status)
        print_plan(&printer, assembly->plan);
    sf_assembly_destroy(&assembly);
    return finish(&printer, status, text);
}

enum sf_status sf_renderer_graph_print(const struct sf_renderer *renderer, const char *format, char **text)
{
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = renderer->device->gpu};
    struct printer printer = {.log = renderer->log, .memory = &memory};
    enum sf_status status = parse_format(format, renderer->log, &printer.format);

    if (!status) {
        print_plan(&printer, sf_particles_plan(renderer->particles));
        status = print_shadow(&printer, &renderer->sides[0].stage.assembly->drawn);
    }
    if (!status)
        print_plan(&printer, renderer->sides[0].stage.assembly->plan);
    return finish(&printer, status, text);
}
