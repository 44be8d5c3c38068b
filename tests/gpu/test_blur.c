/* Thick smoke's blur against a plain CPU blur: depths averaged over smoke only, optical depth with its mean kept, cells
 * apart. */
#include <math.h>

#include "gpu_kit.h"
#include "shared/frame.h"
#include "shared/thick.h"

enum { SIDE = 64, CELLS = 2, WIDTH = SIDE * CELLS, HEIGHT = SIDE, RADIUS = 5 };

static float source[HEIGHT][WIDTH][4];
static struct sf_thick_blur_push push = {.width = WIDTH, .height = HEIGHT, .cell = SIDE};

/* Two blobs far enough from the edges that the blur loses nothing; G holds minus the far depth, as blending leaves it.
 */
static void fill_source(void)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double away = fmin(hypot(x - 30, y - 28), hypot(x - 95, y - 37));
            float *texel = source[y][x];
            if (away < 14) {
                texel[0] = (float)(3 + 0.1 * sin(x * 0.9) + away * 0.02);
                texel[1] = -(float)(5 + 0.2 * cos(y * 0.7));
                texel[2] = (float)(0.5 + 0.4 * sin(x + y));
                texel[3] = (float)(1.5 + sin(x * 1.3) * cos(y * 1.1));
            } else {
                texel[0] = texel[1] = (float)SF_DEPTH_FAR;
                texel[2] = 1;
                texel[3] = 0;
            }
        }
}

/* One direction, written as the definition says it. */
static void blur_cpu(const float (*from)[WIDTH][4], float (*to)[WIDTH][4], int dx, int dy)
{
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double sum[4] = {0}, held = 0;
            for (int t = -RADIUS; t <= RADIUS; t++) {
                int u = x + t * dx, v = y + t * dy;
                if (u < 0 || v < 0 || u >= WIDTH || v >= HEIGHT || u / SIDE != x / SIDE)
                    continue;
                const float *texel = from[v][u];
                double weight = (double)push.weight[abs(t)];
                sum[3] += weight * (double)texel[3];
                if ((double)texel[0] < SF_DEPTH_FAR) {
                    held += weight;
                    for (int k = 0; k < 3; k++)
                        sum[k] += weight * (double)texel[k];
                }
            }
            to[y][x][0] = held > 0 ? (float)(sum[0] / held) : (float)SF_DEPTH_FAR;
            to[y][x][1] = held > 0 ? (float)(sum[1] / held) * (dx ? -1 : 1) : (float)SF_DEPTH_FAR;
            to[y][x][2] = held > 0 ? (float)(sum[2] / held) : 0;
            to[y][x][3] = (float)sum[3];
        }
}

static void test_blur(void **state)
{
    (void)state;
    static float half_way[HEIGHT][WIDTH][4], truth[HEIGHT][WIDTH][4];
    struct sf_gpu *gpu = kit_gpu(0);
    struct sf_graph *graph = NULL;
    struct sf_plan *plan = NULL;
    struct sf_player *player = NULL;
    struct sf_gpu_image *image = NULL;
    uint64_t serial = 0;
    double total = 0;
    for (int i = 0; i <= RADIUS; i++) {
        push.weight[i] = (float)exp(-0.5 * i * i / 4.0);
        total += (i ? 2 : 1) * (double)push.weight[i];
    }
    for (int i = 0; i <= RADIUS; i++)
        push.weight[i] /= (float)total;
    fill_source();
    assert_int_equal(
        sf_gpu_image_create(gpu, "source", SF_FORMAT_RGBA32F, WIDTH, HEIGHT, 1, SF_ACCESS_SAMPLED, source, &image),
        SF_OK);
    assert_int_equal(sf_graph_create("blur", &kit_log, &graph), SF_OK);
    const struct sf_image_desc desc = {.format = SF_FORMAT_RGBA32F, .size = {.width = WIDTH, .height = HEIGHT}};
    struct sf_image_desc imported = desc, first = desc, second = desc;
    imported.name = "source";
    imported.lifetime = SF_IMPORTED;
    imported.outside = SF_ACCESS_SAMPLED;
    first.name = "first";
    second.name = "second";
    sf_resource images[3] = {sf_graph_image(graph, &imported), sf_graph_image(graph, &first),
                             sf_graph_image(graph, &second)};
    sf_resource back = sf_graph_buffer(
        graph, &(struct sf_buffer_desc){.name = "back", .lifetime = SF_READBACK, .bytes = sizeof truth});
    for (uint32_t vertical = 0; vertical < 2; vertical++) {
        const struct sf_use uses[] = {
            {.resource = images[vertical], .access = SF_ACCESS_SAMPLED, .binding = 0},
            {.resource = images[vertical + 1], .access = SF_ACCESS_STORAGE_WRITE, .binding = 1}};
        sf_graph_pass(graph, &(struct sf_pass_desc){.name = vertical ? "y" : "x",
                                                    .kind = SF_PASS_COMPUTE,
                                                    .shader = "thick/blur.comp",
                                                    .uses = uses,
                                                    .use_count = 2,
                                                    .constants = {vertical, RADIUS},
                                                    .constant_count = 2,
                                                    .push = &push,
                                                    .push_bytes = sizeof push,
                                                    .groups = {WIDTH / SF_THICK_TILE, HEIGHT / SF_THICK_TILE, 1}});
    }
    const struct sf_use copy[] = {{.resource = images[2], .access = SF_ACCESS_TRANSFER_READ},
                                  {.resource = back, .access = SF_ACCESS_TRANSFER_WRITE}};
    sf_graph_pass(graph,
                  &(struct sf_pass_desc){.name = "back", .kind = SF_PASS_TRANSFER, .uses = copy, .use_count = 2});
    const struct sf_plan_memory memory = {.needs = sf_gpu_memory_needs, .user = gpu};
    assert_int_equal(sf_plan_create(graph, &memory, &kit_log, &plan), SF_OK);
    assert_int_equal(sf_player_create(gpu, plan, &player), SF_OK);
    sf_player_bind_image(player, images[0], image);
    assert_int_equal(sf_frame_begin(gpu), SF_OK);
    assert_int_equal(sf_player_play(player), SF_OK);
    assert_int_equal(sf_frame_end(gpu, &serial), SF_OK);
    assert_int_equal(sf_frame_wait(gpu, serial), SF_OK);

    float(*found)[WIDTH][4] = malloc(sizeof truth);
    assert_non_null(found);
    memcpy(found, sf_player_readback(player, back, serial), sizeof truth);
    blur_cpu((const float(*)[WIDTH][4])source, half_way, 1, 0);
    blur_cpu((const float(*)[WIDTH][4])half_way, truth, 0, 1);
    double worst = 0, sum_before = 0, sum_after = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            for (int k = 0; k < 4; k++)
                worst = fmax(worst, fabs((double)found[y][x][k] - (double)truth[y][x][k]) /
                                        fmax(1, fabs((double)truth[y][x][k])));
            sum_before += (double)source[y][x][3];
            sum_after += (double)found[y][x][3];
            if (found[y][x][3] > 0)
                assert_true(found[y][x][0] <= found[y][x][1]);
        }
    printf("  worst difference %.2e; mean optical depth %.6f -> %.6f\n", worst, sum_before / (WIDTH * HEIGHT),
           sum_after / (WIDTH * HEIGHT));
    assert_true(worst < 1e-5);
    assert_true(fabs(sum_after - sum_before) < 1e-4 * sum_before);

    free(found);
    sf_player_destroy(&player);
    sf_plan_destroy(&plan);
    sf_graph_destroy(&graph);
    sf_gpu_image_destroy(&image);
    kit_finish(&gpu);
}

int main(void)
{
    int skip = kit_probe();
    if (skip)
        return skip;
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_blur)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
