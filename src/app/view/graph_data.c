#include "graph_data.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "log_line.h"

/* ---- reading JSON that may lack anything ---- */

/* The text of a key, cut to its room; "" when there is none. */
static void take_text(const json_t *object, const char *key, char *text, size_t room)
{
    const char *value = json_string_value(json_object_get(object, key));

    snprintf(text, room, "%s", value ? value : "");
}

static uint64_t take_number(const json_t *object, const char *key)
{
    json_int_t value = json_integer_value(json_object_get(object, key));

    return value > 0 ? (uint64_t)value : 0;
}

static uint32_t take_u32(const json_t *object, const char *key, uint32_t missing)
{
    const json_t *value = json_object_get(object, key);
    json_int_t number = json_integer_value(value);

    return json_is_integer(value) && number >= 0 && number < UINT32_MAX ? (uint32_t)number : missing;
}

uint32_t sf_data_find(const struct sf_data_graph *graph, const char *resource)
{
    for (uint32_t r = 0; r < graph->resource_count; r++)
        if (strcmp(graph->resources[r].name, resource) == 0)
            return r;
    return SF_DATA_NONE;
}

static uint32_t find_named(const struct sf_data_graph *graph, const json_t *string)
{
    char name[SF_DATA_NAME_BYTES];
    const char *value = json_string_value(string);

    snprintf(name, sizeof name, "%s", value ? value : ""); /* cut as theirs */
    return name[0] ? sf_data_find(graph, name) : SF_DATA_NONE;
}

static void read_resource(const json_t *object, struct sf_data_resource *resource)
{
    const char *kind = json_string_value(json_object_get(object, "kind"));

    *resource = (struct sf_data_resource){.shares_with = SF_DATA_NONE, .lane = SF_DATA_NONE};
    take_text(object, "name", resource->name, sizeof resource->name);
    take_text(object, "format", resource->format, sizeof resource->format);
    take_text(object, "lifetime", resource->lifetime, sizeof resource->lifetime);
    resource->image = kind && strcmp(kind, "image") == 0;
    resource->lookable =
        resource->name[0] && strcmp(resource->lifetime, "readback") != 0 && strncmp(resource->name, "watch.", 6) != 0;
    resource->width = take_u32(object, "width", 0);
    resource->height = take_u32(object, "height", 0);
    resource->layers = take_u32(object, "layers", 0);
    resource->bytes = take_number(object, "bytes");
    resource->first = take_u32(object, "first", SF_DATA_NONE);
    resource->last = take_u32(object, "last", SF_DATA_NONE);
}

/* The pass's use of a resource, new if there is none yet. */
static struct sf_data_use *use_of(struct sf_data_graph *graph, struct sf_data_pass *pass, uint32_t resource)
{
    for (uint32_t u = pass->first_use; u < pass->first_use + pass->use_count; u++)
        if (graph->uses[u].resource == resource)
            return &graph->uses[u];
    pass->use_count++;
    graph->uses[graph->use_count] = (struct sf_data_use){.resource = resource};
    return &graph->uses[graph->use_count++];
}

/* A list of resources' names: those that the pass reads, or those that it writes. */
static void read_uses(struct sf_data_graph *graph, struct sf_data_pass *pass, const json_t *names, bool writes)
{
    for (size_t i = 0; i < json_array_size(names); i++) {
        uint32_t resource = find_named(graph, json_array_get(names, i));

        if (resource == SF_DATA_NONE)
            continue;
        if (writes)
            use_of(graph, pass, resource)->writes = true;
        else
            use_of(graph, pass, resource)->reads = true;
    }
}

static void read_pass(struct sf_data_graph *graph, const json_t *object, struct sf_data_pass *pass)
{
    const json_t *barriers = json_object_get(object, "barriers");

    *pass = (struct sf_data_pass){.first_use = graph->use_count, .barriers = (uint32_t)json_array_size(barriers)};
    take_text(object, "name", pass->name, sizeof pass->name);
    take_text(object, "kind", pass->kind, sizeof pass->kind);
    pass->bytes_read = take_number(object, "bytes_read");
    pass->bytes_written = take_number(object, "bytes_written");
    read_uses(graph, pass, json_object_get(object, "reads"), false);
    read_uses(graph, pass, json_object_get(object, "writes"), true);
    for (size_t i = 0; i < json_array_size(barriers); i++) {
        uint32_t resource = find_named(graph, json_object_get(json_array_get(barriers, i), "resource"));

        if (resource != SF_DATA_NONE)
            graph->resources[resource].barriers++;
    }
}

/* ---- lives ---- */

/* From the uses; what the text said of a resource that no pass of it uses is kept when it fits. */
static void find_lives(struct sf_data_graph *graph)
{
    for (uint32_t r = 0; r < graph->resource_count; r++) {
        struct sf_data_resource *resource = &graph->resources[r];
        uint32_t first = SF_DATA_NONE, last = SF_DATA_NONE;

        for (uint32_t p = 0; p < graph->pass_count; p++)
            if (sf_data_use_of(graph, &graph->passes[p], r)) {
                first = first == SF_DATA_NONE ? p : first;
                last = p;
            }
        if (first == SF_DATA_NONE && resource->first <= resource->last && resource->last < graph->pass_count)
            continue;
        resource->first = first;
        resource->last = last;
    }
}

/* The life to be placed next: the earliest; of those that begin together, the longest. */
static uint32_t next_life(const struct sf_data_graph *graph)
{
    uint32_t best = SF_DATA_NONE;

    for (uint32_t r = 0; r < graph->resource_count; r++) {
        const struct sf_data_resource *life = &graph->resources[r];

        if (life->first == SF_DATA_NONE || life->lane != SF_DATA_NONE)
            continue;
        if (best == SF_DATA_NONE || life->first < graph->resources[best].first ||
            (life->first == graph->resources[best].first && life->last > graph->resources[best].last))
            best = r;
    }
    return best;
}

/* Each life takes the leftmost lane whose last life has ended before it begins. */
static bool find_lanes(struct sf_data_graph *graph)
{
    uint32_t *ends = malloc((graph->resource_count + 1) * sizeof *ends), r;

    if (!ends)
        return false;
    while ((r = next_life(graph)) != SF_DATA_NONE) {
        uint32_t lane = 0;

        while (lane < graph->lane_count && ends[lane] >= graph->resources[r].first)
            lane++;
        graph->lane_count += lane == graph->lane_count;
        graph->resources[r].lane = lane;
        ends[lane] = graph->resources[r].last;
    }
    free(ends);
    return true;
}

/* ---- graphs ---- */

/* At most so many. */
static size_t count_uses(const json_t *passes)
{
    size_t count = 0;

    for (size_t i = 0; i < json_array_size(passes); i++) {
        const json_t *pass = json_array_get(passes, i);

        count += json_array_size(json_object_get(pass, "reads")) + json_array_size(json_object_get(pass, "writes"));
    }
    return count;
}

static enum sf_status read_graph(const json_t *object, struct sf_data_graph *graph)
{
    const json_t *resources = json_object_get(object, "resources"), *passes = json_object_get(object, "passes");
    const json_t *memory = json_object_get(object, "memory");

    take_text(object, "graph", graph->name, sizeof graph->name);
    graph->transient = take_number(memory, "transient");
    graph->without_sharing = take_number(memory, "without_sharing");
    graph->culled = (uint32_t)json_array_size(json_object_get(object, "culled"));
    graph->resources = calloc(json_array_size(resources) + 1, sizeof *graph->resources);
    graph->passes = calloc(json_array_size(passes) + 1, sizeof *graph->passes);
    graph->uses = calloc(count_uses(passes) + 1, sizeof *graph->uses);
    if (!graph->resources || !graph->passes || !graph->uses)
        return SF_ERROR_MEMORY;
    for (size_t i = 0; i < json_array_size(resources); i++)
        read_resource(json_array_get(resources, i), &graph->resources[graph->resource_count++]);
    for (uint32_t r = 0; r < graph->resource_count; r++)
        graph->resources[r].shares_with =
            find_named(graph, json_object_get(json_array_get(resources, r), "shares_with"));
    for (size_t i = 0; i < json_array_size(passes); i++)
        read_pass(graph, json_array_get(passes, i), &graph->passes[graph->pass_count++]);
    find_lives(graph);
    return find_lanes(graph) ? SF_OK : SF_ERROR_MEMORY;
}

static enum sf_status read_graphs(const json_t *root, struct sf_graph_data *data)
{
    const json_t *graphs = json_object_get(root, "graphs");
    enum sf_status status = SF_OK;

    data->graphs = calloc(json_array_size(graphs) + 1, sizeof *data->graphs);
    if (!data->graphs)
        return SF_ERROR_MEMORY;
    for (size_t i = 0; i < json_array_size(graphs) && !status; i++)
        status = read_graph(json_array_get(graphs, i), &data->graphs[data->graph_count++]);
    return status;
}

enum sf_status sf_graph_data_parse(const char *text, const struct sf_log *log, struct sf_graph_data **data)
{
    json_error_t error = {.text = ""};
    json_t *root = json_loads(text, 0, &error);
    struct sf_graph_data *made;
    enum sf_status status;

    *data = NULL;
    if (!root)
        return sf_log_fail(log, SF_ERROR_INTERNAL, "the graph cannot be drawn, its text is no JSON: line %d: %s",
                           error.line, error.text);
    made = calloc(1, sizeof *made);
    status = made ? read_graphs(root, made) : SF_ERROR_MEMORY;
    json_decref(root);
    if (status) {
        sf_graph_data_destroy(&made);
        return sf_log_fail(log, status, "the graph cannot be drawn: out of memory");
    }
    *data = made;
    return SF_OK;
}

void sf_graph_data_destroy(struct sf_graph_data **data)
{
    if (!*data)
        return;
    for (uint32_t g = 0; (*data)->graphs && g < (*data)->graph_count; g++) {
        free((*data)->graphs[g].passes);
        free((*data)->graphs[g].resources);
        free((*data)->graphs[g].uses);
    }
    free((*data)->graphs);
    free(*data);
    *data = NULL;
}

const struct sf_graph_data *sf_graph_data_refresh(struct sf_graph_data **data, const struct sf_renderer *renderer,
                                                  uint64_t version, const struct sf_log *log)
{
    char *text = NULL;

    if (*data && (*data)->version == version)
        return *data;
    sf_graph_data_destroy(data);
    if (!renderer || sf_renderer_graph_print(renderer, "json", &text) || sf_graph_data_parse(text, log, data))
        *data = calloc(1, sizeof **data);
    free(text);
    if (*data)
        (*data)->version = version;
    return *data;
}

/* ---- looking things up ---- */

const struct sf_data_graph *sf_graph_data_frame(const struct sf_graph_data *data)
{
    for (uint32_t g = 0; data && g < data->graph_count; g++)
        if (strcmp(data->graphs[g].name, "frame") == 0)
            return &data->graphs[g];
    return NULL;
}

const struct sf_data_use *sf_data_use_of(const struct sf_data_graph *graph, const struct sf_data_pass *pass,
                                         uint32_t resource)
{
    for (uint32_t u = pass->first_use; u < pass->first_use + pass->use_count; u++)
        if (graph->uses[u].resource == resource)
            return &graph->uses[u];
    return NULL;
}

const char *sf_bytes_text(uint64_t bytes, char text[SF_BYTES_TEXT])
{
    static const char *const units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
    double value = (double)bytes;
    unsigned unit = 0;

    for (; value >= 1023.5 && unit + 1 < sizeof units / sizeof *units; unit++)
        value /= 1024;
    snprintf(text, SF_BYTES_TEXT, "%.*f %s", unit > 0 && value < 9.95 ? 1 : 0, value, units[unit]);
    return text;
}
