#include "rig.h"

#include <stdio.h>
#include <string.h>

#include "vector.h"

static const double PI = 3.14159265358979323846;
static const double POLE = 1.5690509975429023; /* rad: as high above the level plane as it goes, 89.9 deg */
static const double FURTHEST = 1e5;            /* m: coordinates of a scene's camera */
static const double FILL = 0.92;               /* of the picture's half, from the middle to a framed box's corner */

/* ---- axes ---- */

/* As src/render makes them of a camera. */
static void make_axes(const double eye[3], const double target[3], const double up[3], double right[3], double above[3],
                      double forward[3])
{
    sf_v3_subtract(target, eye, forward);
    sf_v3_normalize(forward);
    sf_v3_cross(forward, up, right);
    if (sf_v3_dot(right, right) < 1e-12) { /* looking along `up`: any other axis serves */
        double other[3] = {fabs(forward[2]) < 0.5 ? 0 : 1, 0, fabs(forward[2]) < 0.5 ? 1 : 0};

        sf_v3_cross(forward, other, right);
    }
    sf_v3_normalize(right);
    sf_v3_cross(right, forward, above);
}

void sf_view_axes(const struct sf_camera_view *view, double right[3], double above[3], double forward[3])
{
    double eye[3], target[3], up[3];

    for (int i = 0; i < 3; i++) {
        eye[i] = view->eye[i];
        target[i] = view->target[i];
        up[i] = view->up[i];
    }
    make_axes(eye, target, up, right, above, forward);
}

static double distance(const struct sf_rig *rig)
{
    double arm[3];

    sf_v3_subtract(rig->eye, rig->target, arm);
    return sf_v3_length(arm);
}

/* ---- whose camera ---- */

static void take(struct sf_rig *rig, const struct sf_camera_view *view)
{
    for (int i = 0; i < 3; i++) {
        rig->eye[i] = view->eye[i];
        rig->target[i] = view->target[i];
        rig->up[i] = view->up[i];
    }
    rig->fov = view->fov;
    rig->near_clip = view->near_clip;
}

void sf_rig_follow(struct sf_rig *rig, const struct sf_camera_view *scene)
{
    if (!rig->own)
        take(rig, scene);
    if (!(rig->speed > 0))
        rig->speed = distance(rig) / 3;
}

void sf_rig_release(struct sf_rig *rig)
{
    rig->own = false;
}

/* False, and all stays, when a scene's camera could not stand there; not-a-number is nowhere. */
static bool place(struct sf_rig *rig, const double eye[3], const double target[3])
{
    for (int i = 0; i < 3; i++)
        if (!(fabs(eye[i]) <= FURTHEST && fabs(target[i]) <= FURTHEST))
            return false;
    memcpy(rig->eye, eye, sizeof rig->eye);
    memcpy(rig->target, target, sizeof rig->target);
    rig->own = true;
    return true;
}

/* ---- movements ---- */

/* Turns `arm` about `up` by `turn` (rad, counter-clockwise seen from above), then towards it by `rise`, short of the
 * poles. */
static void swing(const double up[3], double turn, double rise, double arm[3])
{
    double length = sf_v3_length(arm), height = sf_v3_dot(arm, up), level[3], side[3], angle;

    sf_v3_add(arm, up, -height, level);
    angle = atan2(height, sf_v3_length(level)) + rise;
    angle = angle > POLE ? POLE : angle < -POLE ? -POLE : angle;
    if (!sf_v3_normalize(level)) { /* along `up`: any level direction serves */
        double other[3] = {fabs(up[0]) < 0.5, fabs(up[0]) >= 0.5, 0};

        sf_v3_cross(up, other, level);
        sf_v3_normalize(level);
    }
    sf_v3_cross(up, level, side);
    for (int i = 0; i < 3; i++)
        arm[i] = length * (cos(angle) * (cos(turn) * level[i] + sin(turn) * side[i]) + sin(angle) * up[i]);
}

void sf_rig_orbit(struct sf_rig *rig, double dx, double dy, double height)
{
    double arm[3], eye[3];

    if (dx == 0 && dy == 0)
        return;
    sf_v3_subtract(rig->eye, rig->target, arm);
    swing(rig->up, -PI * dx / height, PI * dy / height, arm);
    sf_v3_add(rig->target, arm, 1, eye);
    place(rig, eye, rig->target);
}

void sf_rig_look(struct sf_rig *rig, double dx, double dy, double height)
{
    double arm[3], target[3];

    if (dx == 0 && dy == 0)
        return;
    sf_v3_subtract(rig->target, rig->eye, arm);
    swing(rig->up, -PI / 2 * dx / height, -PI / 2 * dy / height, arm);
    sf_v3_add(rig->eye, arm, 1, target);
    place(rig, rig->eye, target);
}

static void move(struct sf_rig *rig, const double by[3])
{
    double eye[3], target[3];

    sf_v3_add(rig->eye, by, 1, eye);
    sf_v3_add(rig->target, by, 1, target);
    place(rig, eye, target);
}

void sf_rig_pan(struct sf_rig *rig, double dx, double dy, double height)
{
    double scale = 2 * tan(rig->fov * (PI / 360)) * distance(rig) / height; /* m for each px in the target's plane */
    double right[3], above[3], forward[3], by[3];

    if (dx == 0 && dy == 0)
        return;
    make_axes(rig->eye, rig->target, rig->up, right, above, forward);
    for (int i = 0; i < 3; i++)
        by[i] = scale * (dy * above[i] - dx * right[i]);
    move(rig, by);
}

void sf_rig_dolly(struct sf_rig *rig, double steps)
{
    double arm[3], eye[3], least = 1e-3, before = distance(rig), after = before * pow(0.9, steps);

    if (steps == 0)
        return;
    /* As floats, eye and target must still be two places. */
    for (int i = 0; i < 3; i++)
        least = fmax(least, 1e-5 * fabs(rig->target[i]));
    after = fmax(after, fmin(least, before));
    sf_v3_subtract(rig->eye, rig->target, arm);
    sf_v3_add(rig->target, arm, after / before, eye);
    place(rig, eye, rig->target);
}

void sf_rig_fly(struct sf_rig *rig, double right, double up, double forward, double seconds)
{
    double axes[3][3], by[3], way = rig->speed * seconds;

    if ((right == 0 && up == 0 && forward == 0) || way == 0)
        return;
    make_axes(rig->eye, rig->target, rig->up, axes[0], axes[1], axes[2]);
    for (int i = 0; i < 3; i++)
        by[i] = way * (right * axes[0][i] + up * rig->up[i] + forward * axes[2][i]);
    move(rig, by);
}

bool sf_rig_frame(struct sf_rig *rig, const float min[3], const float max[3], double aspect)
{
    double tan_y = FILL * tan(rig->fov * (PI / 360)), tan_x = tan_y * aspect, away = 0;
    double right[3], above[3], forward[3], target[3], eye[3];

    for (int i = 0; i < 3; i++) {
        if (!(min[i] <= max[i]))
            return false;
        target[i] = ((double)min[i] + max[i]) / 2;
    }
    if (!(aspect > 0))
        return false;
    make_axes(rig->eye, rig->target, rig->up, right, above, forward);
    for (int corner = 0; corner < 8; corner++) {
        double from[3], depth;

        for (int i = 0; i < 3; i++)
            from[i] = (corner >> i & 1 ? max[i] : min[i]) - target[i];
        depth = sf_v3_dot(from, forward);
        away = fmax(away, fabs(sf_v3_dot(from, right)) / tan_x - depth);
        away = fmax(away, fabs(sf_v3_dot(from, above)) / tan_y - depth);
        away = fmax(away, 1.01 * rig->near_clip - depth);
    }
    sf_v3_add(target, forward, -away, eye);
    return place(rig, eye, target);
}

void sf_rig_side(struct sf_rig *rig, enum sf_rig_side side)
{
    const double low = cos(POLE), high = sin(POLE);
    const double from[][3] = {
        [SF_RIG_FRONT] = {0, 0, 1}, [SF_RIG_BACK] = {0, 0, -1},    [SF_RIG_LEFT] = {-1, 0, 0},
        [SF_RIG_RIGHT] = {1, 0, 0}, [SF_RIG_TOP] = {0, high, low}, [SF_RIG_BOTTOM] = {0, -high, low},
    };
    double eye[3];

    sf_v3_add(rig->target, from[side], distance(rig), eye);
    if (place(rig, eye, rig->target))
        memcpy(rig->up, (const double[]){0, 1, 0}, sizeof rig->up);
}

/* ---- presets and sets ---- */

void sf_rig_store(struct sf_rig *rig, unsigned preset)
{
    if (preset >= SF_RIG_PRESETS)
        return;
    sf_rig_view(rig, &rig->presets[preset]);
    rig->preset_set[preset] = true;
}

bool sf_rig_recall(struct sf_rig *rig, unsigned preset)
{
    if (preset >= SF_RIG_PRESETS || !rig->preset_set[preset])
        return false;
    take(rig, &rig->presets[preset]);
    rig->own = true;
    return true;
}

/* Scenes scale `up` to length 1 when they are loaded. What is printed must keep its bits in that: the largest component
 * follows from the others, so that the length is 1 to within half its unit in the last place, and dividing by it rounds
 * each component back. */
static void settle_up(const double up[3], float settled[3])
{
    double length = sf_v3_length(up), rest = 1;
    int largest = 1;

    for (int i = 0; i < 3; i++) {
        settled[i] = length > 0 ? (float)(up[i] / length) : 0;
        if (fabsf(settled[i]) > fabsf(settled[largest]))
            largest = i;
    }
    for (int i = 0; i < 3; i++)
        if (i != largest)
            rest -= (double)settled[i] * settled[i];
    settled[largest] = copysignf((float)sqrt(rest), settled[largest]);
}

void sf_rig_view(const struct sf_rig *rig, struct sf_camera_view *view)
{
    for (int i = 0; i < 3; i++) {
        view->eye[i] = (float)rig->eye[i];
        view->target[i] = (float)rig->target[i];
        view->up[i] = (float)rig->up[i];
    }
    view->fov = (float)rig->fov;
    view->near_clip = (float)rig->near_clip;
    if (!rig->own)
        return;
    settle_up(rig->up, view->up);
    for (int i = 0; i < 3; i++) { /* -0 would only puzzle who reads the sets */
        view->eye[i] += 0.0f;
        view->target[i] += 0.0f;
        view->up[i] += 0.0f;
    }
}

unsigned sf_rig_sets(const struct sf_rig *rig, char sets[SF_RIG_SETS][SF_RIG_SET_BYTES])
{
    struct sf_camera_view view;
    const float *const vectors[] = {view.eye, view.target, view.up};
    static const char *const names[] = {"eye", "target", "up"};
    unsigned count = 0;

    if (!rig->own)
        return 0;
    sf_rig_view(rig, &view);
    snprintf(sets[count++], SF_RIG_SET_BYTES, "camera.type=fixed");
    for (int i = 0; i < 3; i++)
        snprintf(sets[count++], SF_RIG_SET_BYTES, "camera.%s=%.9g,%.9g,%.9g", names[i], vectors[i][0], vectors[i][1],
                 vectors[i][2]);
    snprintf(sets[count++], SF_RIG_SET_BYTES, "camera.fov=%.9g", view.fov);
    snprintf(sets[count++], SF_RIG_SET_BYTES, "camera.near=%.9g", view.near_clip);
    return count;
}
