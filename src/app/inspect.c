/* The subcommands that only look: devices, graph, params, check, effect. */
#include "commands.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"
#include "session.h"

static void print_device(uint32_t index, const struct sf_device_info *info)
{
    printf("%u  %s%s%s\n", index, info->name,
           info->suitable ? "" : "  NOT USABLE: ", info->suitable ? "" : info->unsuitable_because);
    printf("   %s, %s, Vulkan %u.%u.%u, %.1f GiB, subgroups of %u, images up to %u px\n   uuid %s\n", info->kind,
           info->driver, info->api_major, info->api_minor, info->api_patch, (double)info->memory_bytes / (1 << 30),
           info->subgroup_size, info->max_image_side, info->uuid);
}

static json_t *device_json(uint32_t index, const struct sf_device_info *info)
{
    char api[48];
    json_t *row;

    snprintf(api, sizeof api, "%u.%u.%u", info->api_major, info->api_minor, info->api_patch);
    row = json_pack("{s:i, s:s, s:s, s:s, s:s, s:s, s:I, s:i, s:i, s:b}", "index", (int)index, "name", info->name,
                    "driver", info->driver, "uuid", info->uuid, "kind", info->kind, "api", api, "memory_bytes",
                    (json_int_t)info->memory_bytes, "subgroup_size", (int)info->subgroup_size, "max_image_side",
                    (int)info->max_image_side, "suitable", (int)info->suitable);
    if (row && !info->suitable)
        json_object_set_new(row, "unsuitable_because", json_string(info->unsuitable_because));
    return row;
}

enum sf_status sf_devices_run(const struct sf_arguments *arguments)
{
    struct sf_device_info *infos = NULL;
    json_t *list;
    uint32_t count = 0;
    enum sf_status status = sf_device_list(sf_console_log(), &infos, &count);
    char *text;

    if (status)
        return status;
    list = json_array();
    for (uint32_t i = 0; i < count; i++) {
        if (arguments->json)
            json_array_append_new(list, device_json(i, &infos[i]));
        else
            print_device(i, &infos[i]);
    }
    text = list ? json_dumps(list, JSON_INDENT(2)) : NULL;
    if (!text)
        status = sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    else if (arguments->json)
        puts(text);
    free(text);
    json_decref(list);
    free(infos);
    return status;
}

/* Prints the library's text, which becomes ours, and ends the last line when it does not do so itself. */
static void print_text(char *text)
{
    size_t length = strlen(text);

    fputs(text, stdout);
    if (length == 0 || text[length - 1] != '\n')
        putchar('\n');
    free(text);
}

enum sf_status sf_graph_run(const struct sf_arguments *arguments)
{
    struct sf_scene *scene = NULL;
    char *text = NULL;
    enum sf_status status = sf_session_scene(arguments, arguments->files.items[0], &scene);

    if (!status)
        status = sf_graph_print(scene, arguments->size.width, arguments->size.height,
                                arguments->aovs ? SF_AOV_SMOKE | SF_AOV_DEPTHS : 0, arguments->format, sf_console_log(),
                                &text);
    if (!status)
        print_text(text);
    sf_scene_destroy(&scene);
    return status;
}

enum sf_status sf_params_run(const struct sf_arguments *arguments)
{
    char format[64], *text = NULL;
    enum sf_status status;

    snprintf(format, sizeof format, "%s%s", arguments->effects ? "effect-" : "", arguments->format);
    status = sf_params_print(format, sf_console_log(), &text);
    if (!status)
        print_text(text);
    return status;
}

static void print_count(uint32_t count, const char *one)
{
    printf(", %u %s%s", count, one, count == 1 ? "" : "s");
}

enum sf_status sf_check_run(const struct sf_arguments *arguments)
{
    enum sf_status first = SF_OK;

    for (size_t i = 0; i < arguments->files.count && !sf_interrupted(); i++) {
        struct sf_scene *scene = NULL;
        struct sf_scene_info info;
        enum sf_status status = sf_session_scene(arguments, arguments->files.items[i], &scene);

        if (!status) {
            sf_scene_describe(scene, &info);
            printf("%s: ok: %s, %g frames/s, room for %u particle%s", info.path, info.method, info.fps, info.capacity,
                   info.capacity == 1 ? "" : "s");
            if (info.listed)
                printf(" (%u listed)", info.listed);
            print_count(info.lights, "light");
            print_count(info.objects, "object");
            print_count(info.emitters, "emitter");
            print_count(info.forces, "force");
            if (info.effects)
                print_count(info.effects, "effect");
            putchar('\n');
        }
        if (!first)
            first = status;
        sf_scene_destroy(&scene);
    }
    return first ? first : sf_interrupted() ? SF_ERROR_INTERRUPTED : SF_OK;
}

enum sf_status sf_effect_run(const struct sf_arguments *arguments)
{
    enum sf_status first = SF_OK;

    for (size_t i = 0; i < arguments->files.count && !sf_interrupted(); i++) {
        char *text = NULL;
        enum sf_status status = sf_effect_print(arguments->files.items[i], sf_console_log(), &text);

        if (!status)
            print_text(text);
        if (!first)
            first = status;
    }
    return first ? first : sf_interrupted() ? SF_ERROR_INTERRUPTED : SF_OK;
}
