/* glsl/shared/noise.h on the device against itself in C: the same bits. */
#include "gpu_kit.h"

#include <math.h>
#include "base/hash.h"
#include "shared/noise.h"

enum { POINTS = 20000, VALUES = 10 };

/* Within the periods 5, 7, 11 and 2; every eighth on the lattice, or a step beside it. */
static void fill_points(float (*points)[4])
{
    static const float sizes[4] = {5, 7, 11, 2};

    for (uint32_t i = 0; i < POINTS; i++)
        for (uint32_t axis = 0; axis < 4; axis++) {
            float at = sizes[axis] * sf_random_float(1, i, axis);

            if (i % 8 == 0)
                at = floorf(at + 0.5f);
            if (i % 16 == 8)
                at = nextafterf(at, i % 32 == 8 ? 0 : sizes[axis]);
            points[i][axis] = at;
        }
}

static void evaluate(const float *p, float *values)
{
    struct sf_noise_cells open = sf_noise_cells3(p[0], p[1], p[2], 0, 0, 0, 0.6f, 0.8f, 7);
    struct sf_noise_cells closed = sf_noise_cells3(p[0], p[1], p[2], 5, 7, 11, 1, 0, 8);

    values[0] = sf_noise2(p[0], p[1], 0, 0, 1);
    values[1] = sf_noise2(p[0], p[1], 5, 7, 2);
    values[2] = sf_noise3(p[0], p[1], p[2], 0, 0, 0, 3);
    values[3] = sf_noise3(p[0], p[1], p[2], 5, 7, 11, 4);
    values[4] = sf_noise4(p[0], p[1], p[2], p[3], 0, 0, 0, 0, 5);
    values[5] = sf_noise4(p[0], p[1], p[2], p[3], 5, 7, 11, 2, 6);
    values[6] = open.first;
    values[7] = open.second;
    values[8] = closed.first;
    values[9] = closed.second;
}

static void test_bits(void **state)
{
    static float points[POINTS][4];
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = kit_graph("noise");
    struct sf_plan *plan = NULL;
    struct sf_player *player;
    struct sf_gpu_buffer *buffer = NULL;
    const float *got;

    (void)state;
    fill_points(points);
    sf_resource in = sf_graph_buffer(graph, &(struct sf_buffer_desc){.name = "points",
                                                                     .lifetime = SF_IMPORTED,
                                                                     .bytes = sizeof points,
                                                                     .outside = SF_ACCESS_STORAGE_READ});
    sf_resource values = kit_buffer(graph, "values", SF_TRANSIENT, POINTS * VALUES * sizeof(float));
    sf_resource out = kit_buffer(graph, "out", SF_READBACK, POINTS * VALUES * sizeof(float));
    const struct sf_use uses[] = {{.resource = in, .access = SF_ACCESS_STORAGE_READ, .binding = 0},
                                  {.resource = values, .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}};
    sf_graph_pass(graph, &(struct sf_pass_desc){.name = "noise",
                                                .kind = SF_PASS_COMPUTE,
                                                .uses = uses,
                                                .use_count = 2,
                                                .shader = "test/noise.comp",
                                                .groups = {(POINTS + 63) / 64, 1, 1}});
    kit_copy(graph, "read", values, out);
    player = kit_player(gpu, graph, &plan);
    assert_int_equal(sf_gpu_buffer_create(gpu, "points", sizeof points, false, SF_ACCESS_STORAGE_READ, points, &buffer),
                     SF_OK);
    sf_player_bind_buffer(player, in, buffer);
    got = sf_player_readback(player, out, kit_play(gpu, player));
    assert_non_null(got);
    for (uint32_t i = 0; i < POINTS; i++) {
        float wanted[VALUES];

        evaluate(points[i], wanted);
        for (uint32_t v = 0; v < VALUES; v++)
            if (memcmp(&wanted[v], &got[VALUES * i + v], sizeof(float)) != 0)
                fail_msg("value %u at (%a, %a, %a, %a) is %a in C and %a on the device", v, (double)points[i][0],
                         (double)points[i][1], (double)points[i][2], (double)points[i][3], (double)wanted[v],
                         (double)got[VALUES * i + v]);
    }
    kit_drop(&player, &plan, &graph);
    sf_gpu_buffer_destroy(&buffer);
    kit_finish(&gpu);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_bits)};
    int skip = kit_probe();

    return skip ? skip : cmocka_run_group_tests(tests, NULL, NULL);
}
