#include "texture/body.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "texture/texture.h"

#define BOUND   2.2f        /* the noise, in standard deviations, never comes to more */
#define STEP    (1.0f / 32) /* against 1/96, alpha, height and normal differ by 0.005 rms */
#define DARK    0.002f      /* what still passes is not looked at */
#define REACH   0.97f
#define LAYER   0.5f
#define MIDDLE  0.2f /* so that a layer has holes */
#define FILLING 1.2f /* clones times the cube of their mean radius */
#define TWO_PI  6.2831853f

enum {
    CHANCE_TILE = 0x500,
    CHANCE_CLONE = 0x600,
    CHANCE_PLACE = 0x700,
    CHANCE_BEND = 0x800,
    LANES = SF_FIELD_LANES,
    STEPS_MAX = 64 + LANES, /* along a line from REACH to -REACH, and a batch that begins at the last */
};

/* ---- making ---- */

/* Places are spread by the additive recurrence of three dimensions (ratios 1/g, 1/g^2, 1/g^3, g^4 = g + 1), begun
 * anywhere, and a little chance: evenly at any number, without heaps, holes or rows. */
static void place_clone(const struct sf_body *body, uint32_t seed, uint32_t id, struct sf_clone *clone)
{
    static const float ratios[3] = {0.81917251f, 0.67104360f, 0.54970048f};
    float at[3], chance[6], mean = cbrtf(FILLING / (float)body->clone_count);

    for (uint32_t i = 0; i < 6; i++)
        chance[i] = sf_random_float(seed, id, CHANCE_CLONE + i);
    for (uint32_t i = 0; i < 3; i++) {
        at[i] = sf_random_float(seed, i, CHANCE_PLACE) + ratios[i] * (float)id + 0.3f * mean * chance[3 + i];
        at[i] -= floorf(at[i]);
    }
    clone->radius = fminf(mean * (0.65f + 0.9f * chance[0] * chance[0]), 0.45f * body->reach);
    if (body->repeats) {
        clone->middle[0] = body->width * (at[0] - 0.5f);
        clone->middle[1] = body->height * (at[1] - 0.5f);
        clone->middle[2] = (body->reach - clone->radius) * (2 * at[2] - 1);
    } else {
        float out = (body->reach - clone->radius) * cbrtf(at[0]), along = 2 * at[1] - 1;
        float across = sqrtf(1 - along * along), angle = TWO_PI * at[2];

        clone->middle[0] = out * across * cosf(angle);
        clone->middle[1] = out * across * sinf(angle);
        clone->middle[2] = out * along;
    }
    clone->shade = chance[1];
    clone->moment = (uint32_t)(chance[2] * SF_BODY_MOMENTS);
    sf_field_random_turn(seed, CHANCE_CLONE + id, clone->turn);
}

/* The nearest front first; no two are alike to the last bit but by a chance that changes nothing. */
static int compare_fronts(const void *a, const void *b)
{
    const struct sf_clone *one = a, *other = b;
    float first = one->middle[2] + one->radius, second = other->middle[2] + other->radius;

    return (first < second) - (first > second);
}

enum sf_status sf_body_init(const struct sf_texture_options *options, uint32_t tile, struct sf_body *body)
{
    const struct sf_texture_kind *kind = sf_texture_kind_find(options->kind);
    uint32_t shorter = options->width < options->height ? options->width : options->height;
    uint32_t seed = sf_random_u32(options->seed, tile / options->loop, CHANCE_TILE);
    float moment = (float)(tile % options->loop) / (float)options->loop;

    *body = (struct sf_body){
        .repeats = options->tileable,
        .columns = options->width,
        .width = 2 * (float)options->width / (float)shorter,
        .height = 2 * (float)options->height / (float)shorter,
        .pixel = 2 / (float)shorter,
        .reach = options->tileable ? LAYER : fminf(REACH, 1 - 4 / (float)shorter),
        .ragged = options->ragged,
        .soft = options->softness,
        .middle = options->tileable && !kind->clones ? MIDDLE : 1,
        .mottle = options->mottle,
    };
    for (uint32_t i = 0; i < 4; i++)
        body->bend[i] = TWO_PI * sf_random_float(seed, i, CHANCE_BEND);
    body->extinction = options->density / (2 * body->reach);
    struct sf_field_settings field = {
        .kind = kind->field,
        .octaves = options->octaves,
        .lacunarity = options->lacunarity,
        .roughness = options->roughness,
        .frequency = kind->clones ? options->scale / 4 : options->scale / 2,
        .period_x = options->tileable && !kind->clones ? body->width : 0,
        .period_y = options->tileable && !kind->clones ? body->height : 0,
        .changes = options->loop > 1 ? options->changes : 0,
        .seed = seed,
    };
    bool many = kind->clones && options->loop > 1;

    for (uint32_t i = 0; i < SF_BODY_MOMENTS && (i == 0 || many); i++)
        sf_field_init(&field, moment + (float)i / SF_BODY_MOMENTS, &body->fields[i]);
    if (!kind->clones)
        return SF_OK;
    body->clones = calloc(options->clones, sizeof *body->clones);
    if (!body->clones)
        return SF_ERROR_MEMORY;
    body->clone_count = options->clones;
    for (uint32_t i = 0; i < body->clone_count; i++) {
        place_clone(body, seed, i, &body->clones[i]);
        body->clones[i].moment *= many;
    }
    qsort(body->clones, body->clone_count, sizeof *body->clones, compare_fronts);
    return SF_OK;
}

void sf_body_finish(struct sf_body *body)
{
    free(body->clones);
    *body = (struct sf_body){0};
}

/* ---- density along a line ---- */

struct lanes {
    float density[LANES], shade[LANES];
};

/* Points STEP apart along a pixel's line, the first the nearest. */
struct line {
    float x, y, top; /* z of the first */
    int count;
    float rest[STEPS_MAX];   /* 1 - density */
    float weight[STEPS_MAX]; /* of `shade`, a sum */
    float shade[STEPS_MAX];
    /* What was walked so far. */
    int walked;
    float passes, height, seen_shade; /* what passes; sums weighted by what is seen */
};

/* x where it is positive, else 0; without a choice, which is in a vectorised loop's way. */
static inline float positive(float x)
{
    return 0.5f * (x + fabsf(x));
}

/* Noise weighted by distance: `square` is that to the middle, over reach, squared. Beyond 1 there is nothing, whatever
 * the noise. */
static void weigh(const struct sf_body *body, const float *restrict noise, const float *restrict square,
                  struct lanes *restrict lanes)
{
    float ragged = body->ragged, slope = 1 / body->soft, middle = body->middle;

    for (int i = 0; i < LANES; i++) {
        float n = noise[i] / sqrtf(1 + noise[i] * noise[i] * (1 / (BOUND * BOUND))) * (1 / BOUND);
        float inside = (middle + ragged * n - (middle + ragged) * square[i]) * slope;

        inside = 1 - positive(1 - positive(inside));
        lanes->density[i] = inside * inside * (3 - 2 * inside);
        lanes->shade[i] = 1 - positive(1 - positive(0.5f + n));
    }
}

static void sample_noise(const struct sf_body *body, const struct line *line, int first, struct lanes *lanes)
{
    float p[3][LANES], noise[LANES], square[LANES], shrink = 1 / (body->reach * body->reach);
    float across = body->repeats ? 0 : line->x * line->x + line->y * line->y;

    for (int i = 0; i < LANES; i++) {
        p[0][i] = line->x;
        p[1][i] = line->y;
        p[2][i] = line->top - STEP * (float)(first + i);
        square[i] = (across + p[2][i] * p[2][i]) * shrink;
    }
    sf_field_sample(&body->fields[0], 0.5f / body->pixel, p[0], p[1], p[2], noise);
    weigh(body, noise, square, lanes);
}

static void sample_clone(const struct sf_body *body, const struct sf_clone *clone, const float *way,
                         const struct line *line, int first, struct lanes *lanes)
{
    float p[3][LANES], noise[LANES], square[LANES], away[LANES], shrink = 1 / clone->radius;
    float a = way[0] * shrink, b = way[1] * shrink;

    for (int i = 0; i < LANES; i++) {
        float c = (line->top - STEP * (float)(first + i) - clone->middle[2]) * shrink;

        square[i] = a * a + b * b + c * c;
        away[i] = c;
    }
    for (int axis = 0; axis < 3; axis++) {
        const float *turn = clone->turn[axis];

        for (int i = 0; i < LANES; i++)
            p[axis][i] = turn[0] * a + turn[1] * b + turn[2] * away[i];
    }
    sf_field_sample(&body->fields[clone->moment], 0.5f * clone->radius / body->pixel, p[0], p[1], p[2], noise);
    weigh(body, noise, square, lanes);
    for (int i = 0; i < LANES; i++)
        lanes->shade[i] = 0.5f * (lanes->shade[i] + clone->shade);
}

/* Densities melt into each other: what passes between them is the product of what each lets pass. */
static void add(struct line *line, int first, const struct lanes *lanes)
{
    for (int i = 0; i < LANES; i++) {
        line->rest[first + i] *= 1 - lanes->density[i];
        line->weight[first + i] += lanes->density[i];
        line->shade[first + i] += lanes->density[i] * lanes->shade[i];
    }
}

/* Goes on to point number `end`, which is not reached. From one point to the next the density is the mean of both, and
 * what it hides is hidden, on average, so far behind the first as attenuation by a constant density has it. */
static void walk(struct line *line, int end, float extinction)
{
    for (; line->walked + 1 < end && line->passes > DARK; line->walked++) {
        int a = line->walked, b = a + 1;
        float depth = (1 - 0.5f * (line->rest[a] + line->rest[b])) * extinction * STEP;

        if (depth > 0) {
            float left = expf(-depth), seen = line->passes * (1 - left);
            float behind = depth < 1e-2f ? 0.5f - depth / 12 : 1 / depth - left / (1 - left);
            float height = line->top - STEP * ((float)a + behind);

            line->height += seen * (height > 0 ? height : 0);
            line->seen_shade += seen * (line->shade[a] + line->shade[b]) / (line->weight[a] + line->weight[b]);
            line->passes *= left;
        }
    }
}

static void walk_noise(const struct sf_body *body, struct line *line)
{
    struct lanes lanes;

    for (int first = 0; first < line->count && line->passes > DARK; first += LANES) {
        sample_noise(body, line, first, &lanes);
        add(line, first, &lanes);
        walk(line, first + LANES, body->extinction);
    }
}

/* From a clone's middle to the line, along the tile's axes: the shortest way where the tile repeats. */
static void way_to(const struct sf_body *body, const struct sf_clone *clone, float x, float y, float way[2])
{
    way[0] = x - clone->middle[0];
    way[1] = y - clone->middle[1];
    if (body->repeats) {
        way[0] -= body->width * floorf(way[0] / body->width + 0.5f);
        way[1] -= body->height * floorf(way[1] / body->height + 0.5f);
    }
}

/* Clones come with the nearest front first: what lies before it is done. */
static void walk_clones(const struct sf_body *body, const uint32_t *list, uint32_t count, struct line *line)
{
    for (uint32_t number = 0; number < count && line->passes > DARK; number++) {
        const struct sf_clone *clone = &body->clones[list[number]];
        float way[2], half, front;
        struct lanes lanes;

        way_to(body, clone, line->x, line->y, way);
        half = clone->radius * clone->radius - way[0] * way[0] - way[1] * way[1];
        if (half <= 0)
            continue;
        half = sqrtf(half);
        front = (line->top - clone->middle[2] - clone->radius) / STEP;
        if (front > 0)
            walk(line, (int)front, body->extinction);
        int first = (int)ceilf((line->top - clone->middle[2] - half) / STEP),
            end = (int)floorf((line->top - clone->middle[2] + half) / STEP) + 1;
        for (first = first > 0 ? first : 0; first < end && first < line->count; first += LANES) {
            sample_clone(body, clone, way, line, first, &lanes);
            add(line, first, &lanes);
        }
    }
    walk(line, line->count, body->extinction);
}

/* A lattice that repeats stands along the tile's sides, which the eye would see: its lines are bent, by waves that
 * repeat too. */
static void bend(const struct sf_body *body, float *x, float *y)
{
    float across = TWO_PI * *x / body->width, up = TWO_PI * *y / body->height;

    *x += body->width * (0.03f * sinf(up + body->bend[0]) + 0.01f * sinf(2 * up + body->bend[1]));
    *y += body->height * (0.03f * sinf(across + body->bend[2]) + 0.01f * sinf(2 * across + body->bend[3]));
}

static void start(const struct sf_body *body, float x, float y, struct line *line)
{
    float out = body->reach * body->reach - (body->repeats ? 0 : x * x + y * y);
    int half = out > 0 ? (int)floorf(sqrtf(out) / STEP) + 1 : 0;

    if (body->repeats && !body->clones)
        bend(body, &x, &y);
    line->x = x;
    line->y = y;
    line->top = STEP * (float)half;
    line->count = half > 0 ? 2 * half + 1 : 0;
    line->walked = 0;
    line->passes = 1;
    line->height = line->seen_shade = 0;
    for (int i = 0; i < line->count + LANES && i < STEPS_MAX; i++) {
        line->rest[i] = 1;
        line->weight[i] = line->shade[i] = 0;
    }
}

void sf_body_look(const struct sf_body *body, uint32_t row, uint32_t *list, struct sf_body_pixel *pixels)
{
    float y = 0.5f * body->height - ((float)row + 0.5f) * body->pixel, way[2];
    uint32_t count = 0;
    struct line line;

    for (uint32_t i = 0; i < body->clone_count; i++) {
        way_to(body, &body->clones[i], 0, y, way);
        if (fabsf(way[1]) < body->clones[i].radius)
            list[count++] = i;
    }
    for (uint32_t column = 0; column < body->columns; column++) {
        start(body, ((float)column + 0.5f) * body->pixel - 0.5f * body->width, y, &line);
        if (body->clones)
            walk_clones(body, list, count, &line);
        else
            walk_noise(body, &line);
        float alpha = 1 - line.passes, shade = alpha > 0 ? fminf(line.seen_shade / alpha, 1) : 1;

        pixels[column] =
            (struct sf_body_pixel){.alpha = alpha, .height = line.height, .shade = 1 - body->mottle * (1 - shade)};
    }
}
