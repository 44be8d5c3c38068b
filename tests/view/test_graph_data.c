/* The graphs for the panels: what is read from their JSON, whatever it holds, and the columns of lives. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "app/view/graph_data.h"

static const char SMALL[] =
    "{\"graphs\": [{\"graph\": \"sim\", \"passes\": [{\"name\": \"sim.step\"}]},"
    " {\"graph\": \"frame\", \"memory\": {\"transient\": 3000000000, \"without_sharing\": 5000000000},"
    "  \"resources\": ["
    "   {\"name\": \"frame\", \"kind\": \"buffer\", \"lifetime\": \"upload\", \"bytes\": 1808},"
    "   {\"name\": \"raw\", \"kind\": \"image\", \"lifetime\": \"transient\", \"format\": \"rgba32f\", \"width\": 80,"
    "    \"height\": 40, \"layers\": 2, \"bytes\": 102400, \"first\": 0, \"last\": 1},"
    "   {\"name\": \"color\", \"kind\": \"image\", \"lifetime\": \"transient\", \"shares_with\": \"raw\"},"
    "   {\"name\": \"args\", \"kind\": \"buffer\"},"
    "   {\"name\": \"unused\", \"kind\": \"buffer\", \"lifetime\": \"readback\"}],"
    "  \"passes\": ["
    "   {\"name\": \"draw\", \"kind\": \"raster\", \"bytes_read\": 10, \"bytes_written\": 20,"
    "    \"barriers\": [{\"resource\": \"raw\"}, {\"resource\": \"args\"}],"
    "    \"reads\": [\"frame\", \"args\"], \"writes\": [\"raw\", \"args\"]},"
    "   {\"name\": \"blur\", \"kind\": \"compute\", \"barriers\": [{\"resource\": \"raw\"}],"
    "    \"reads\": [\"raw\", \"nowhere\"], \"writes\": [\"raw\"]},"
    "   {\"name\": \"over\", \"kind\": \"raster\","
    "    \"reads\": [\"color\", \"frame\"], \"writes\": [\"color\"]}],"
    "  \"culled\": [\"a\", \"b\"]}]}";

static struct sf_graph_data *parse(const char *text)
{
    struct sf_graph_data *data = NULL;

    assert_int_equal(sf_graph_data_parse(text, NULL, &data), SF_OK);
    assert_non_null(data);
    return data;
}

static void what_the_text_says_is_there(void **state)
{
    struct sf_graph_data *data = parse(SMALL);
    const struct sf_data_graph *graph = sf_graph_data_frame(data);
    const struct sf_data_resource *raw;

    (void)state;
    assert_int_equal(data->graph_count, 2);
    assert_non_null(graph);
    assert_string_equal(graph->name, "frame");
    assert_true(graph->transient == 3000000000u && graph->without_sharing == 5000000000u);
    assert_int_equal(graph->culled, 2);
    assert_int_equal(graph->resource_count, 5);
    assert_int_equal(graph->pass_count, 3);
    raw = &graph->resources[1];
    assert_string_equal(raw->name, "raw");
    assert_string_equal(raw->format, "rgba32f");
    assert_string_equal(raw->lifetime, "transient");
    assert_true(raw->image && raw->width == 80 && raw->height == 40 && raw->layers == 2 && raw->bytes == 102400);
    assert_int_equal(raw->barriers, 2);
    assert_int_equal(raw->shares_with, SF_DATA_NONE);
    assert_int_equal(graph->resources[2].shares_with, 1);
    assert_false(graph->resources[0].image);
    assert_true(raw->lookable && graph->resources[0].lookable && !graph->resources[4].lookable);
    assert_string_equal(graph->resources[3].lifetime, "");
    assert_string_equal(graph->passes[0].kind, "raster");
    assert_true(graph->passes[0].bytes_read == 10 && graph->passes[0].bytes_written == 20);
    assert_int_equal(graph->passes[0].barriers, 2);
    assert_int_equal(sf_data_find(graph, "color"), 2);
    assert_int_equal(sf_data_find(graph, "colour"), SF_DATA_NONE);
    sf_graph_data_destroy(&data);
    assert_null(data);
    sf_graph_data_destroy(&data);
}

static void assert_use(const struct sf_data_graph *graph, unsigned pass, const char *resource, bool reads, bool writes)
{
    const struct sf_data_use *use = sf_data_use_of(graph, &graph->passes[pass], sf_data_find(graph, resource));

    assert_non_null(use);
    if (use->reads != reads || use->writes != writes)
        fail_msg("pass %u: %s is %s%s", pass, resource, use->reads ? "read " : "", use->writes ? "written" : "");
}

static void uses_say_who_reads_and_who_writes(void **state)
{
    struct sf_graph_data *data = parse(SMALL);
    const struct sf_data_graph *graph = sf_graph_data_frame(data);

    (void)state;
    assert_use(graph, 0, "frame", true, false);
    assert_use(graph, 0, "raw", false, true);
    assert_use(graph, 0, "args", true, true);
    assert_use(graph, 1, "raw", true, true);
    assert_use(graph, 2, "color", true, true);
    assert_int_equal(graph->passes[0].use_count, 3);
    assert_int_equal(graph->passes[1].use_count, 1);
    assert_null(sf_data_use_of(graph, &graph->passes[2], 1));
    assert_null(sf_data_use_of(graph, &graph->passes[2], SF_DATA_NONE));
    sf_graph_data_destroy(&data);
}

static void lanes_are_used_again(void **state)
{
    struct sf_graph_data *data = parse(SMALL);
    const struct sf_data_graph *graph = sf_graph_data_frame(data);

    (void)state;
    assert_true(graph->resources[0].first == 0 && graph->resources[0].last == 2 && graph->resources[0].lane == 0);
    assert_true(graph->resources[1].first == 0 && graph->resources[1].last == 1 && graph->resources[1].lane == 1);
    assert_true(graph->resources[2].first == 2 && graph->resources[2].lane == 1);
    assert_true(graph->resources[3].last == 0 && graph->resources[3].lane == 2);
    assert_true(graph->resources[4].first == SF_DATA_NONE && graph->resources[4].lane == SF_DATA_NONE);
    assert_int_equal(graph->lane_count, 3);
    sf_graph_data_destroy(&data);
}

static void text_that_lacks_things_does_no_harm(void **state)
{
    static const char *const texts[] = {
        "{}", "[]", "{\"graphs\": 3}", "{\"graphs\": [1, null, {\"passes\": {}, \"resources\": 7}]}",
        "{\"graphs\": [{\"graph\": \"frame\", \"passes\": [2, {\"reads\": 1}, {\"writes\": [1, {\"resource\": 4}]}],"
        " \"resources\": [null, {\"name\": null, \"width\": -4, \"bytes\": -1, \"first\": 9, \"last\": 3}]}]}",
        /* No uses: the lives that are told are drawn when they can be. */
        "{\"graphs\": [{\"graph\": \"frame\", \"passes\": [{}, {}], \"resources\": [{\"name\": \"a\", \"first\": 0,"
        " \"last\": 1}, {\"name\": \"b\", \"first\": 1, \"last\": 2}]}]}"};
    struct sf_graph_data *data = NULL;

    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        data = parse(texts[i]);
        if (i == 4) {
            const struct sf_data_resource *resource = &sf_graph_data_frame(data)->resources[1];
            assert_true(resource->width == 0 && resource->bytes == 0 && resource->first == SF_DATA_NONE);
        }
        if (i == 5) {
            const struct sf_data_resource *resources = sf_graph_data_frame(data)->resources;
            assert_true(resources[0].last == 1 && resources[0].lane == 0);
            assert_int_equal(resources[1].lane, SF_DATA_NONE);
        }
        sf_graph_data_destroy(&data);
    }
    assert_int_equal(sf_graph_data_parse("{\"graphs\": [", NULL, &data), SF_ERROR_INTERNAL);
    assert_null(data);
    assert_null(sf_graph_data_frame(NULL));
}

/* Everything that uses refer to is there. */
static void assert_sound(const struct sf_graph_data *data)
{
    for (uint32_t g = 0; g < data->graph_count; g++) {
        const struct sf_data_graph *graph = &data->graphs[g];

        for (uint32_t p = 0; p < graph->pass_count; p++)
            assert_true(graph->passes[p].first_use + graph->passes[p].use_count <= graph->use_count);
        for (uint32_t u = 0; u < graph->use_count; u++)
            assert_true(graph->uses[u].resource < graph->resource_count);
        for (uint32_t r = 0; r < graph->resource_count; r++) {
            const struct sf_data_resource *a = &graph->resources[r];

            assert_true(a->shares_with == SF_DATA_NONE || a->shares_with < graph->resource_count);
            assert_int_equal(a->lane == SF_DATA_NONE, a->first == SF_DATA_NONE);
            if (a->lane == SF_DATA_NONE)
                continue;
            assert_true(a->lane < graph->lane_count && a->first <= a->last && a->last < graph->pass_count);
            for (uint32_t o = 0; o < r; o++) {
                const struct sf_data_resource *b = &graph->resources[o];
                assert_false(b->lane == a->lane && b->first <= a->last && a->first <= b->last);
            }
        }
    }
}

/* Bytes of the text changed at random; most of it is no JSON any more. */
static void text_that_is_wrong_does_no_harm(void **state)
{
    static const char signs[] = "{}[],:\"0123-.enulltrue \\abframew";
    char text[sizeof SMALL];
    uint32_t random = 1, good = 0;

    (void)state;
    for (unsigned turn = 0; turn < 20000; turn++) {
        struct sf_graph_data *data = NULL;

        memcpy(text, SMALL, sizeof SMALL);
        for (unsigned i = 0; i <= turn % 4; i++) {
            random = random * 1664525u + 1013904223u;
            text[(random >> 8) % (sizeof SMALL - 1)] = signs[(random >> 3) % (sizeof signs - 1)];
        }
        if (sf_graph_data_parse(text, NULL, &data))
            continue;
        good++;
        assert_sound(data);
        sf_graph_data_destroy(&data);
    }
    assert_true(good > 1000);
}

/* The library's own words, as they are today. */
static void a_scene_s_graphs_are_understood(void **state)
{
    char path[1024], *text = NULL;
    const char *root = getenv("SF_SOURCE_ROOT");
    struct sf_scene *scene = NULL;
    struct sf_graph_data *data;
    const struct sf_data_graph *frame;
    unsigned images = 0, writers = 0;

    (void)state;
    snprintf(path, sizeof path, "%s/scenes/plume.json", root ? root : ".");
    assert_int_equal(sf_scene_load(path, NULL, 0, NULL, &scene), SF_OK);
    assert_int_equal(sf_graph_print(scene, 640, 480, 0, "json", NULL, &text), SF_OK);
    data = parse(text);
    assert_sound(data);
    assert_true(data->graph_count >= 2);
    frame = sf_graph_data_frame(data);
    assert_non_null(frame);
    assert_true(frame->pass_count > 10 && frame->lane_count > 3 && frame->lane_count < frame->resource_count);
    assert_true(frame->transient > 0 && frame->transient <= frame->without_sharing);
    for (uint32_t r = 0; r < frame->resource_count; r++) {
        const struct sf_data_resource *resource = &frame->resources[r];
        images += resource->image;
        assert_true(resource->bytes > 0 && resource->lifetime[0]);
        assert_true(!resource->image || (resource->format[0] && resource->width > 0 && resource->layers > 0));
    }
    assert_true(images > 5 && images < frame->resource_count);
    for (uint32_t p = 0; p < frame->pass_count; p++) {
        bool writes = false;

        assert_true(frame->passes[p].name[0] && frame->passes[p].kind[0] && frame->passes[p].use_count > 0);
        for (uint32_t u = 0; u < frame->passes[p].use_count; u++)
            writes |= frame->uses[frame->passes[p].first_use + u].writes;
        writers += writes;
    }
    assert_int_equal(writers, frame->pass_count); /* one that writes nothing would have been culled */
    uint32_t color = sf_data_find(frame, "color");
    assert_true(color != SF_DATA_NONE && frame->resources[color].width == 640 && frame->resources[color].height == 480);
    sf_graph_data_destroy(&data);
    free(text);
    sf_scene_destroy(&scene);
}

static void the_version_decides(void **state)
{
    struct sf_graph_data *data = NULL;
    const struct sf_graph_data *first = sf_graph_data_refresh(&data, NULL, 3, NULL);

    (void)state;
    assert_true(first == data && data->version == 3 && data->graph_count == 0);
    data->graph_count = 0;
    data->graphs = calloc(1, sizeof *data->graphs); /* would be gone after reading again */
    sf_graph_data_refresh(&data, NULL, 3, NULL);
    assert_non_null(data->graphs);
    sf_graph_data_refresh(&data, NULL, 4, NULL);
    assert_null(data->graphs);
    assert_int_equal(data->version, 4);
    sf_graph_data_destroy(&data);
}

static void bytes_are_said_shortly(void **state)
{
    static const struct {
        uint64_t bytes;
        const char *text;
    } rows[] = {{0, "0 B"},           {1023, "1023 B"},     {1024, "1.0 KiB"},    {13680, "13 KiB"},
                {1048575, "1.0 MiB"}, {2560000, "2.4 MiB"}, {10433332, "10 MiB"}, {UINT64_MAX, "16777216 TiB"}};
    char text[SF_BYTES_TEXT];

    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        assert_string_equal(sf_bytes_text(rows[i].bytes, text), rows[i].text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_the_text_says_is_there),
        cmocka_unit_test(uses_say_who_reads_and_who_writes),
        cmocka_unit_test(lanes_are_used_again),
        cmocka_unit_test(text_that_lacks_things_does_no_harm),
        cmocka_unit_test(text_that_is_wrong_does_no_harm),
        cmocka_unit_test(a_scene_s_graphs_are_understood),
        cmocka_unit_test(the_version_decides),
        cmocka_unit_test(bytes_are_said_shortly),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
