/* src/texture: what is made. */
#include "texture_kit.h"

#include "base/hash.h"
#include "texture/body.h"
#include "texture/field.h"
#include "texture/texture.h"

/* ---- the field ---- */

static struct sf_field_settings field_settings(int kind)
{
    return (struct sf_field_settings){
        .kind = (enum sf_field_kind)kind, .octaves = 4, .lacunarity = 2, .roughness = 0.5f, .frequency = 2, .seed = 11};
}

struct points {
    float x[SF_FIELD_LANES], y[SF_FIELD_LANES], z[SF_FIELD_LANES];
};

static void scatter(uint32_t number, float size, struct points *points)
{
    for (uint32_t i = 0; i < SF_FIELD_LANES; i++) {
        points->x[i] = size * sf_random_float(number, i, 1) - size / 2;
        points->y[i] = size * sf_random_float(number, i, 2) - size / 2;
        points->z[i] = size * sf_random_float(number, i, 3) - size / 2;
    }
}

/* Mean 0 and variance 1, still and in a cycle; the same bits with and without wide registers. */
static void test_field_moments(void **state)
{
    enum { BATCHES = 8000 };

    (void)state;
    for (int kind = 0; kind < 3; kind++)
        for (uint32_t changes = 0; changes <= 3; changes += 3) {
            struct sf_field_settings settings = field_settings(kind);
            double sum = 0, squares = 0;
            struct sf_field field;

            settings.changes = changes;
            sf_field_init(&settings, 0.3f, &field);
            for (uint32_t n = 0; n < BATCHES; n++) {
                float value[SF_FIELD_LANES], plain[SF_FIELD_LANES];
                struct points points;

                scatter(n, 200, &points);
                sf_field_sample(&field, 1000, points.x, points.y, points.z, value);
                sf_field_sample_portable(&field, 1000, points.x, points.y, points.z, plain);
                assert_memory_equal(value, plain, sizeof value);
                for (int i = 0; i < SF_FIELD_LANES; i++) {
                    sum += value[i];
                    squares += value[i] * value[i];
                }
            }
            sum /= BATCHES * SF_FIELD_LANES;
            squares /= BATCHES * SF_FIELD_LANES;
            if (fabs(sum) > 0.02 || fabs(squares - 1) > 0.03)
                fail_msg("kind %d, %u changes: mean %.4f, variance %.4f", kind, changes, sum, squares);
        }
}

/* Moments 0 and 1 have the same bits; in x and y the field repeats, to the rounding of coordinates. */
static void test_field_repeats(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        struct sf_field_settings settings = field_settings(kind);
        struct sf_field begin, middle, end;
        float value[4][SF_FIELD_LANES];
        struct points points;

        settings.changes = 3;
        settings.period_x = 2;
        settings.period_y = 3;
        sf_field_init(&settings, 0, &begin);
        sf_field_init(&settings, 0.5f, &middle);
        sf_field_init(&settings, 1, &end);
        for (uint32_t n = 0; n < 2000; n++) {
            double change = 0;

            scatter(n, 3, &points);
            sf_field_sample(&begin, 1000, points.x, points.y, points.z, value[0]);
            sf_field_sample(&end, 1000, points.x, points.y, points.z, value[1]);
            assert_memory_equal(value[0], value[1], sizeof value[0]);
            sf_field_sample(&middle, 1000, points.x, points.y, points.z, value[2]);
            for (int i = 0; i < SF_FIELD_LANES; i++) {
                points.x[i] += n % 2 ? 2.0f : -4.0f;
                points.y[i] -= n % 3 ? 3.0f : -6.0f;
            }
            sf_field_sample(&begin, 1000, points.x, points.y, points.z, value[3]);
            for (int i = 0; i < SF_FIELD_LANES; i++) {
                change += fabsf(value[2][i] - value[0][i]);
                if (fabsf(value[3][i] - value[0][i]) > 2e-3f)
                    fail_msg("kind %d: %g a period away from %g", kind, (double)value[3][i], (double)value[0][i]);
            }
            assert_true(change > 0.05 * SF_FIELD_LANES);
        }
    }
}

/* Octaves that are too fine are left out; the others weigh what they did. */
static void test_field_finest(void **state)
{
    struct sf_field_settings settings = field_settings(SF_FIELD_SUM);
    struct sf_field four, two;
    float value[2][SF_FIELD_LANES];
    struct points points;

    (void)state;
    sf_field_init(&settings, 0, &four); /* frequencies 2, 4, 8, 16 */
    settings.octaves = 2;
    sf_field_init(&settings, 0, &two);
    scatter(1, 5, &points);
    sf_field_sample(&four, 8, points.x, points.y, points.z, value[0]);
    sf_field_sample(&two, 8, points.x, points.y, points.z, value[1]);
    for (int i = 0; i < SF_FIELD_LANES; i++)
        assert_float_equal(value[0][i] / four.scale, value[1][i] / two.scale, 1e-5);
    sf_field_sample(&four, 2, points.x, points.y, points.z, value[0]);
    for (int i = 0; i < SF_FIELD_LANES; i++)
        assert_true(value[0][i] == 0);
}

/* ---- along a line, against a naive sum in small steps ---- */

static double limit(double noise)
{
    return noise / sqrt(1 + noise * noise / (2.2 * 2.2)) / 2.2;
}

static double field_at(const struct sf_field *field, double finest, const double *p)
{
    float x[SF_FIELD_LANES] = {(float)p[0]}, y[SF_FIELD_LANES] = {(float)p[1]}, z[SF_FIELD_LANES] = {(float)p[2]};
    float value[SF_FIELD_LANES];

    sf_field_sample(field, (float)finest, x, y, z, value);
    return value[0];
}

static double ball(const struct sf_body *body, double noise, double square)
{
    double inside = (1 + body->ragged * limit(noise) - (1 + body->ragged) * square) / body->soft;

    inside = fmin(fmax(inside, 0), 1);
    return square < 1 ? inside * inside * (3 - 2 * inside) : 0;
}

static double density_at(const struct sf_body *body, const double *p)
{
    double rest = 1, r2 = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];

    if (!body->clones)
        return ball(body, field_at(&body->fields[0], 0.5 / (double)body->pixel, p),
                    r2 / ((double)body->reach * (double)body->reach));
    for (uint32_t i = 0; i < body->clone_count; i++) {
        const struct sf_clone *clone = &body->clones[i];
        double q[3], t[3], square = 0;

        for (int axis = 0; axis < 3; axis++) {
            q[axis] = (p[axis] - (double)clone->middle[axis]) / (double)clone->radius;
            square += q[axis] * q[axis];
        }
        if (square >= 1)
            continue;
        for (int axis = 0; axis < 3; axis++)
            t[axis] = (double)clone->turn[axis][0] * q[0] + (double)clone->turn[axis][1] * q[1] +
                      (double)clone->turn[axis][2] * q[2];
        rest *=
            1 - ball(body, field_at(&body->fields[clone->moment], 0.5 * (double)clone->radius / (double)body->pixel, t),
                     square);
    }
    return 1 - rest;
}

static void test_against_sum(void **state)
{
    enum { SIDE = 48, STEPS = 800 };

    (void)state;
    for (int kind = 0; kind < KIT_KINDS; kind++) {
        struct sf_texture_options options = kit_options(kit_kinds[kind], SIDE);
        double alpha_error = 0, height_error = 0, deepest = 0;
        struct sf_body_pixel pixels[SIDE];
        uint32_t *list, count = 0;
        struct sf_body body;

        options.clones = 30;
        assert_int_equal(sf_body_init(&options, 0, &body), SF_OK);
        list = calloc((size_t)body.clone_count + 1, sizeof *list);
        assert_non_null(list);
        for (uint32_t row = 5; row < SIDE; row += 7) {
            sf_body_look(&body, row, list, pixels);
            for (uint32_t column = 2; column < SIDE; column += 3, count++) {
                double p[3] = {(column + 0.5) * 2 / SIDE - 1, 1 - (row + 0.5) * 2 / SIDE, 0}, passes = 1, height = 0;

                for (int step = 0; step < STEPS; step++) {
                    double left;

                    p[2] = 1 - (step + 0.5) * 2 / STEPS;
                    left = exp(-density_at(&body, p) * options.density / (2 * (double)body.reach) * 2 / STEPS);
                    height += passes * (1 - left) * fmax(p[2], 0);
                    passes *= left;
                }
                alpha_error += fabs(1 - passes - (double)pixels[column].alpha);
                height_error += fabs(height - (double)pixels[column].height);
                deepest = fmax(deepest, 1 - passes);
            }
        }
        if (alpha_error / count > 0.002 || height_error / count > 0.002 || deepest < 0.9)
            fail_msg("%s: alpha is off by %.5f, height by %.5f on average; greatest alpha %.3f", kit_kinds[kind],
                     alpha_error / count, height_error / count, deepest);
        free(list);
        sf_body_finish(&body);
    }
}

/* Without noise it is a ball: alpha and height by an integral of one variable. */
static void test_ball(void **state)
{
    enum { SIDE = 64, STEPS = 20000 };
    struct sf_texture_options options = kit_options("fbm", SIDE);
    struct sf_texture *texture;
    struct sf_texture_info info;

    (void)state;
    options.ragged = 0;
    options.softness = 0.5f;
    options.density = 3;
    options.mottle = 0;
    texture = kit_make(&options);
    info = kit_info(texture);
    for (uint32_t column = 0; column < SIDE; column++) {
        double x = (column + 0.5) * 2 / SIDE - 1, y = 1.0 / SIDE, reach = 1 - 4.0 / SIDE, passes = 1, height = 0;
        const float *color = kit_texel(&info, info.color, 0, column, SIDE / 2 - 1),
                    *shape = kit_texel(&info, info.shape, 0, column, SIDE / 2 - 1);

        for (int step = 0; step < STEPS; step++) {
            double z = 1 - (step + 0.5) * 2 / STEPS,
                   inside = fmin(fmax((1 - (x * x + y * y + z * z) / reach / reach) / 0.5, 0), 1),
                   left = exp(-inside * inside * (3 - 2 * inside) * 3 / (2 * reach) * 2 / STEPS);

            height += passes * (1 - left) * fmax(z, 0);
            passes *= left;
        }
        assert_float_equal(color[3], 1 - passes, 1e-3);
        assert_float_equal(shape[3], height, 1e-3);
        assert_true(color[0] == 1 && color[1] == 1 && color[2] == 1);
    }
    sf_texture_destroy(&texture);
}

/* ---- whole atlases ---- */

/* Nothing at a tile's border, so that neighbours do not bleed; numbers within their ranges; a puff, not a speck or a
 * square. */
static void test_border(void **state)
{
    static const uint32_t sizes[][2] = {{8, 8}, {33, 20}, {21, 50}, {64, 64}};

    (void)state;
    for (int kind = 0; kind < KIT_KINDS; kind++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            struct sf_texture_options options = kit_options(kit_kinds[kind], 0);
            uint32_t width = sizes[s][0], height = sizes[s][1], shorter = width < height ? width : height;
            struct sf_texture *texture;
            struct sf_texture_info info;
            double alpha = 0;

            options.tiles_x = 3;
            options.width = width;
            options.height = height;
            options.ragged = 2;
            texture = kit_make(&options);
            info = kit_info(texture);
            for (uint32_t tile = 0; tile < 3; tile++)
                for (uint32_t y = 0; y < height; y++)
                    for (uint32_t x = 0; x < width; x++) {
                        const float *color = kit_texel(&info, info.color, tile, x, y),
                                    *shape = kit_texel(&info, info.shape, tile, x, y);

                        for (int c = 0; c < 4; c++)
                            assert_true(color[c] >= 0 && color[c] <= 1 && fabsf(shape[c]) <= 1.00001f);
                        assert_true(shape[2] > 0 && shape[3] >= 0);
                        if (x == 0 || y == 0 || x + 1 == width || y + 1 == height)
                            assert_true(color[3] == 0 && shape[3] == 0);
                        alpha += color[3];
                    }
            alpha /= 3.0 * shorter * shorter;
            if (alpha < 0.05 || alpha > 0.7)
                fail_msg("%s of %ux%u covers %.3f of a square", kit_kinds[kind], width, height, alpha);
            sf_texture_destroy(&texture);
        }
}

/* Normals are unit, and those of the heights: twice the height's difference over two texels, in units of half a side. */
static void test_normals(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIT_KINDS; kind++) {
        struct sf_texture_options options = kit_options(kit_kinds[kind], 48);
        struct sf_texture *texture;
        struct sf_texture_info info;
        double steep = 0;

        options.tiles_x = 2;
        options.height = 64;
        texture = kit_make(&options);
        info = kit_info(texture);
        for (uint32_t tile = 0; tile < 2; tile++)
            for (uint32_t y = 1; y < 63; y++)
                for (uint32_t x = 1; x < 47; x++) {
                    const float *n = kit_texel(&info, info.shape, tile, x, y);
                    double dx = (double)n[4 + 3] - (double)n[-4 + 3], unit = 2.0 / 48;
                    double dy = (double)kit_texel(&info, info.shape, tile, x, y - 1)[3] -
                                (double)kit_texel(&info, info.shape, tile, x, y + 1)[3];
                    double slope_x = dx / (2 * unit), slope_y = dy / (2 * unit);

                    assert_float_equal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
                    assert_float_equal(-n[0] / n[2], slope_x, 1e-3 * (1 + fabs(slope_x)));
                    assert_float_equal(-n[1] / n[2], slope_y, 1e-3 * (1 + fabs(slope_y)));
                    steep = fmax(steep, fabs(slope_x));
                }
        assert_true(steep > 0.3);
        sf_texture_destroy(&texture);
    }
}

/* The same bits on any number of threads; tiles by their number, wherever they lie; another seed, another smoke. */
static void test_repeatable(void **state)
{
    (void)state;
    for (int kind = 0; kind < KIT_KINDS; kind++) {
        struct sf_texture_options options = kit_options(kit_kinds[kind], 40);
        struct sf_texture *one, *other;
        struct sf_texture_info a, b;
        double change = 0;

        options.tiles_x = options.tiles_y = 2;
        options.threads = 1;
        one = kit_make(&options);
        options.threads = 5;
        other = kit_make(&options);
        a = kit_info(one);
        b = kit_info(other);
        assert_memory_equal(a.color, b.color, 80 * 80 * 4 * sizeof(float));
        assert_memory_equal(a.shape, b.shape, 80 * 80 * 4 * sizeof(float));
        sf_texture_destroy(&other);
        options.tiles_x = 4;
        options.tiles_y = 1;
        other = kit_make(&options);
        b = kit_info(other);
        for (uint32_t tile = 0; tile < 4; tile++)
            for (uint32_t y = 0; y < 40; y++) {
                assert_memory_equal(kit_texel(&a, a.color, tile, 0, y), kit_texel(&b, b.color, tile, 0, y),
                                    40 * 4 * sizeof(float));
                for (uint32_t x = 0; x < 40 && tile > 0; x++)
                    change += fabsf(kit_texel(&b, b.color, tile, x, y)[3] - kit_texel(&b, b.color, tile - 1, x, y)[3]);
            }
        assert_true(change / (3 * 40 * 40) > 0.02);
        sf_texture_destroy(&other);
        options.tiles_x = 2;
        options.tiles_y = 2;
        options.seed++;
        other = kit_make(&options);
        b = kit_info(other);
        assert_memory_not_equal(a.color, b.color, 80 * 80 * 4 * sizeof(float));
        sf_texture_destroy(&other);
        sf_texture_destroy(&one);
    }
}

/* ---- cycles in time, repetition in space, light ---- */

static double tile_change(const struct sf_texture_info *info, uint32_t one, uint32_t other)
{
    uint32_t width = info->width / info->tiles_x, height = info->height / info->tiles_y;
    double squares = 0;

    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            double alpha = (double)kit_texel(info, info->color, one, x, y)[3] -
                           (double)kit_texel(info, info->color, other, x, y)[3];
            double above = (double)kit_texel(info, info->shape, one, x, y)[3] -
                           (double)kit_texel(info, info->shape, other, x, y)[3];

            squares += alpha * alpha + above * above;
        }
    return sqrt(squares / (width * height));
}

/* The step from the last phase to the first is like the others, and none is a jump; half a cycle away it is other
 * smoke; the next K tiles are another one. */
static void test_loop(void **state)
{
    enum { PHASES = 32 };

    (void)state;
    for (int tileable = 0; tileable < 2; tileable++)
        for (int kind = 0; kind < KIT_KINDS; kind++) {
            struct sf_texture_options options = kit_options(kit_kinds[kind], 40);
            double least = HUGE_VAL, greatest = 0, last, apart;
            struct sf_texture *texture;
            struct sf_texture_info info;

            options.tiles_x = 8;
            options.tiles_y = 8;
            options.loop = PHASES;
            options.tileable = tileable;
            texture = kit_make(&options);
            info = kit_info(texture);
            for (uint32_t i = 0; i + 1 < PHASES; i++) {
                double change = tile_change(&info, i, i + 1);

                least = fmin(least, change);
                greatest = fmax(greatest, change);
            }
            last = tile_change(&info, PHASES - 1, 0);
            apart = tile_change(&info, 0, PHASES / 2);
            if (least < 0.2 * greatest || last < 0.8 * least || last > 1.25 * greatest || apart < 1.5 * greatest)
                fail_msg("%s: steps of %.4f to %.4f, the last %.4f, half a cycle %.4f", kit_kinds[kind], least,
                         greatest, last, apart);
            assert_true(tile_change(&info, 0, PHASES) > greatest);
            sf_texture_destroy(&texture);
        }
}

/* Root mean square step of alpha, height and normal from column a to b, and from row a to b. */
static double seam(const struct sf_texture_info *info, bool rows, uint32_t a, uint32_t b)
{
    double squares = 0;

    for (uint32_t i = 0; i < info->width; i++) {
        size_t p = 4 * (rows ? (size_t)a * info->width + i : (size_t)i * info->width + a),
               q = 4 * (rows ? (size_t)b * info->width + i : (size_t)i * info->width + b);

        for (size_t c = 0; c < 4; c++)
            squares += pow((double)info->shape[p + c] - (double)info->shape[q + c], 2) +
                       pow((double)info->color[p + c] - (double)info->color[q + c], 2);
    }
    return sqrt(squares / info->width);
}

static void test_tileable(void **state)
{
    enum { SIDE = 96 };

    (void)state;
    for (int kind = 0; kind < KIT_KINDS; kind++) {
        struct sf_texture_options options = kit_options(kit_kinds[kind], SIDE);
        struct sf_texture *texture;
        struct sf_texture_info info;

        options.tileable = true;
        texture = kit_make(&options);
        info = kit_info(texture);
        for (int rows = 0; rows < 2; rows++) {
            double greatest = 0, mean = 0, over;

            for (uint32_t i = 0; i + 1 < SIDE; i++) {
                double step = seam(&info, rows, i, i + 1);

                greatest = fmax(greatest, step);
                mean += step / (SIDE - 1);
            }
            over = seam(&info, rows, SIDE - 1, 0);
            if (over > greatest || over > 1.6 * mean || over < 0.5 * mean)
                fail_msg("%s: a step of %.4f over the border, %.4f on average and %.4f at most within", kit_kinds[kind],
                         over, mean, greatest);
        }
        sf_texture_destroy(&texture);
    }
}

static void test_lighting(void **state)
{
    double slope, correlation;
    struct sf_texture *lit;

    (void)state;
    for (int kind = 0; kind < KIT_KINDS; kind++) {
        struct sf_texture_options options = kit_options(kit_kinds[kind], 96);
        struct sf_texture *texture;

        options.tiles_x = options.tiles_y = 2;
        texture = kit_make(&options);
        sf_texture_lighting(texture, &slope, &correlation);
        if (!(slope > 0 && slope < 0.1 && correlation < 0.5))
            fail_msg("%s: light in the colour, slope %.3f, correlation %.3f", kit_kinds[kind], slope, correlation);
        sf_texture_destroy(&texture);
    }
    /* A white ball lit from the viewer, and the same in one colour. */
    lit = sf_texture_alloc(200, 200, 1, 1);
    assert_non_null(lit);
    for (uint32_t i = 0; i < 200 * 200; i++) {
        float x = ((float)(i % 200) + 0.5f) / 100 - 1, y = ((float)(i / 200) + 0.5f) / 100 - 1, z2 = 1 - x * x - y * y;

        lit->shape[4 * i] = x;
        lit->shape[4 * i + 1] = -y;
        lit->shape[4 * i + 2] = sqrtf(fmaxf(z2, 0));
        for (int c = 0; c < 3; c++)
            lit->color[4 * i + (uint32_t)c] = lit->shape[4 * i + 2];
        lit->color[4 * i + 3] = z2 > 0 ? 1 : 0;
    }
    sf_texture_lighting(lit, &slope, &correlation);
    assert_float_equal(slope, 1.5, 0.01);
    assert_float_equal(correlation, 1, 1e-4);
    for (uint32_t i = 0; i < 200 * 200; i++)
        for (int c = 0; c < 3; c++)
            lit->color[4 * i + (uint32_t)c] = 0.7f;
    sf_texture_lighting(lit, &slope, &correlation);
    assert_true(slope == 0 && correlation == 0);
    sf_texture_destroy(&lit);
}

/* ---- what cannot be ---- */

static void test_options(void **state)
{
    static const struct {
        size_t offset;
        bool whole;
        double wrong;
        const char *says;
    } cases[] = {
#define CASE(field, whole, wrong) {offsetof(struct sf_texture_options, field), whole, wrong, "texture: " #field " is"}
        CASE(tiles_x, true, 0),
        CASE(tiles_x, true, 65),
        CASE(tiles_y, true, 0),
        CASE(width, true, 7),
        CASE(height, true, 8193),
        CASE(octaves, true, 0),
        CASE(octaves, true, 11),
        CASE(lacunarity, false, 1.1),
        CASE(lacunarity, false, 5),
        CASE(roughness, false, -1),
        CASE(roughness, false, 1.5),
        CASE(scale, false, 0),
        CASE(ragged, false, 2.5),
        CASE(softness, false, 0),
        CASE(density, false, (double)NAN),
        CASE(density, false, 1000),
        CASE(mottle, false, 1.1),
        CASE(clones, true, 0),
        CASE(clones, true, 2001),
        CASE(changes, true, 0),
        CASE(changes, true, 33),
#undef CASE
        {offsetof(struct sf_texture_options, loop), true, 3, "a loop of 3 does not divide the 2x2 tiles"},
        {offsetof(struct sf_texture_options, loop), true, 0, "a loop of 0"},
        {offsetof(struct sf_texture_options, height), true, 8192, "over the limit"},
    };
    struct sf_texture *texture = (struct sf_texture *)&caught;
    struct sf_texture_options options;

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        sf_texture_options_init(&options);
        options.width = 8192;
        if (cases[i].whole)
            *(uint32_t *)(void *)((char *)&options + cases[i].offset) = (uint32_t)cases[i].wrong;
        else
            *(float *)(void *)((char *)&options + cases[i].offset) = (float)cases[i].wrong;
        assert_int_equal(sf_texture_create(&options, NULL, NULL, &log_caught, &texture), SF_ERROR_USAGE);
        assert_null(texture);
        assert_caught(&caught, cases[i].says);
    }
    options.kind = "turbulance";
    assert_int_equal(sf_texture_create(&options, NULL, NULL, &log_caught, &texture), SF_ERROR_USAGE);
    assert_caught(&caught, "did you mean turbulence?");
    options.kind = "marble";
    assert_int_equal(sf_texture_create(&options, NULL, NULL, &log_caught, &texture), SF_ERROR_USAGE);
    assert_caught(&caught, "'marble': fbm, turbulence");
    sf_texture_destroy(&texture);
    sf_texture_destroy(NULL);
}

struct watch {
    uint64_t last, total;
    unsigned calls, stop;
};

static bool watch(void *user, uint64_t done, uint64_t total)
{
    struct watch *seen = user;

    assert_true(done >= seen->last && done <= total);
    seen->last = done;
    seen->total = total;
    return ++seen->calls != seen->stop;
}

static void test_progress(void **state)
{
    struct sf_texture_options options = kit_options("fbm", 64);
    struct watch seen = {0};
    struct sf_texture *texture;

    (void)state;
    options.tiles_x = 3;
    assert_int_equal(sf_texture_create(&options, watch, &seen, &log_caught, &texture), SF_OK);
    assert_true(seen.last == 3 * 64 && seen.total == 3 * 64 && seen.calls > 3);
    sf_texture_destroy(&texture);
    for (unsigned stop = 1; stop <= 3; stop++) {
        seen = (struct watch){.stop = stop};
        assert_int_equal(sf_texture_create(&options, watch, &seen, &log_caught, &texture), SF_ERROR_INTERRUPTED);
        assert_null(texture);
    }
    assert_int_equal(caught.errors, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_field_moments), cmocka_unit_test(test_field_repeats), cmocka_unit_test(test_field_finest),
        cmocka_unit_test(test_against_sum),   cmocka_unit_test(test_ball),          cmocka_unit_test(test_border),
        cmocka_unit_test(test_normals),       cmocka_unit_test(test_repeatable),    cmocka_unit_test(test_loop),
        cmocka_unit_test(test_tileable),      cmocka_unit_test(test_lighting),      cmocka_unit_test(test_options),
        cmocka_unit_test(test_progress),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
