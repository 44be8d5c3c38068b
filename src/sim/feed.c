#include "sim/feed.h"

#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "sim/births.h"
#include "sim/obstacle.h"

_Static_assert(sizeof(struct sf_sim_record) == 64 && sizeof(struct sf_sim_emitter) == 128, "std140");
_Static_assert(sizeof(struct sf_sim_turbulence) == 48 && sizeof(struct sf_sim_vortex) == 48, "std140");
_Static_assert(offsetof(struct sf_sim_now, turbulences) == 112, "std140");
_Static_assert(offsetof(struct sf_sim_births, records) == 128 * SF_SIM_EMITTERS, "std430");
_Static_assert(sizeof(struct sf_sim_now) <= 16384, "the least that every device offers for a uniform block");
_Static_assert(SF_SIM_EMITTERS == SF_EMITTERS_MAX && SF_EMITTERS_MAX <= 256, "sf_particle.look has 8 bits");
_Static_assert(SF_SIM_TURBULENCES >= SF_FORCES_MAX && SF_SIM_VORTICES >= SF_FORCES_MAX &&
                   SF_FRAME_OBJECTS >= SF_OBJECTS_MAX,
               "every force has room");
_Static_assert(SF_SIM_CONE == SF_EMITTER_CONE && SF_SIM_SPHERE == SF_EMITTER_SPHERE && SF_SIM_BOX == SF_EMITTER_BOX &&
                   SF_SIM_MESH == SF_EMITTER_MESH && SF_SIM_LIST == SF_EMITTER_LIST,
               "one numbering");

static const double PI = 3.14159265358979323846;

double sf_sim_step_rate(const struct sf_scene *scene)
{
    return (double)scene->sim.fps * scene->sim.substeps;
}

/* Integral of exp(-k t) over 0..h. */
static double decay_integral(double k, double h)
{
    return k * h > 1e-12 ? -expm1(-k * h) / k : h;
}

/* Integral of decay_integral over 0..h. */
static double decay_integral_twice(double k, double h)
{
    double z = k * h;

    if (z < 1e-3)
        return h * h * (1.0 / 2 - z * (1.0 / 6 - z * (1.0 / 24 - z / 120)));
    return h * h * (z + expm1(-z)) / (z * z);
}

/* The coefficients c1 and c2 of glsl/sim/motion.glsl: velocity and way that an acceleration exp(-c t) gives under the
 * drag k. */
static void cooling_integrals(double k, double c, double h, double *c1, double *c2)
{
    double least = fmin(k, c), apart = fabs(k - c);

    *c1 = exp(-least * h) * decay_integral(apart, h);
    if (apart * h > 1e-5) {
        *c2 = (decay_integral(least, h) - decay_integral(least + apart, h)) / apart;
    } else { /* their difference is the derivative, taken half-way: integral of t exp(-m t) */
        double z = (least + 0.5 * apart) * h;

        *c2 = h * h *
              (z < 1e-3 ? 1.0 / 2 - z * (1.0 / 3 - z * (1.0 / 8 - z / 30)) : (-expm1(-z) - z * exp(-z)) / (z * z));
    }
}

static void feed_emitter(const struct sf_scene *scene, const struct sf_sim_layout *layout, uint32_t i,
                         const struct sf_sim_now *now, struct sf_sim_emitter *to)
{
    const struct sf_emitter *from = &scene->emitters[i];
    double h = 1 / sf_sim_step_rate(scene), c1, c2;
    double reach =
        sqrt((double)from->direction[0] * from->direction[0] + (double)from->direction[1] * from->direction[1] +
             (double)from->direction[2] * from->direction[2]);
    bool listed = from->kind == SF_EMITTER_LIST; /* its particles are as stated, and only forces change them */

    memset(to, 0, sizeof *to);
    to->kind = (uint32_t)from->kind;
    cooling_integrals(now->drag, listed ? 0 : from->cooling, h, &c1, &c2);
    to->turn[1] = (float)exp(listed ? 0 : -from->cooling * h);
    to->turn[2] = (float)c1;
    to->turn[3] = (float)c2;
    if (listed)
        return;
    for (int axis = 0; axis < 3; axis++)
        to->direction[axis] = reach > 0 ? (float)(from->direction[axis] / reach) : 0;
    to->direction[3] = (float)cos(from->angle * PI / 180);
    for (int axis = 0; axis < 3; axis++)
        to->shape[axis] = from->kind == SF_EMITTER_BOX    ? 0.5f * from->size[axis]
                          : from->kind == SF_EMITTER_MESH ? from->scale
                                                          : from->radius;
    to->shape[3] = from->extinction >= 0 ? from->extinction : scene->medium.extinction;
    to->start[0] = from->lifetime[0];
    to->start[1] = from->lifetime[1] - from->lifetime[0];
    to->start[2] = from->speed[0];
    to->start[3] = from->speed[1] - from->speed[0];
    to->body[0] = from->particle_radius[0];
    to->body[1] = from->particle_radius[1] - from->particle_radius[0];
    to->body[2] = from->temperature;
    to->body[3] = from->cooling;
    to->change[0] = from->growth;
    to->change[1] = 3 * from->dilution;
    to->change[2] = from->fade_in;
    to->change[3] = from->fade_out;
    to->turn[0] = from->spin;
    to->facing[0] = (float)cos(from->rotation * PI / 180);
    to->facing[1] = (float)sin(from->rotation * PI / 180);
    to->surface = from->surface;
    to->triangles = layout->triangles[i];
    to->triangle_count = layout->triangle_counts[i];
}

static void feed_turbulence(const struct sf_force *force, uint32_t seed, double time, struct sf_sim_turbulence *to)
{
    /* Quarter turns for each 1/rate of time; both senses, and far apart, so that the corners do not come back, or turn
     * about, together. */
    static const double speeds[4] = {0.36, -0.71, 1.23, -1.4};
    double power = 0;

    for (int i = 0; i < 4; i++) {
        double angle = fmod(0.25 * force->rate * speeds[i] * time, 1.0) * 2 * PI;

        to->cosines[i] = (float)cos(angle);
        to->sines[i] = (float)sin(angle);
    }
    for (int i = 0; i < force->octaves; i++)
        power += pow(4, -i / 3.0); /* as sf_curl_noise_octaves weighs them */
    to->frequency = 1 / force->scale;
    to->amplitude = (float)(force->strength / sqrt(power));
    to->octaves = (uint32_t)force->octaves;
    to->seed = seed;
}

static void feed_vortex(const struct sf_force *force, struct sf_sim_vortex *to)
{
    double length = sqrt((double)force->axis[0] * force->axis[0] + (double)force->axis[1] * force->axis[1] +
                         (double)force->axis[2] * force->axis[2]);

    for (int i = 0; i < 3; i++) {
        to->position[i] = force->position[i];
        to->axis[i] = (float)(force->axis[i] / length);
    }
    to->position[3] = 1 / force->radius;
    to->axis[3] = force->strength;
    to->pull[0] = force->pull;
}

static void feed_forces(const struct sf_scene *scene, uint64_t step, struct sf_sim_now *now)
{
    double h = 1 / sf_sim_step_rate(scene);

    for (uint32_t i = 0; i < scene->force_count; i++) {
        const struct sf_force *force = &scene->forces[i];

        switch (force->kind) {
        case SF_FORCE_GRAVITY:
            for (int axis = 0; axis < 3; axis++)
                now->acceleration[axis] += force->acceleration[axis];
            break;
        case SF_FORCE_BUOYANCY:
            now->lift += force->strength;
            break;
        case SF_FORCE_DRAG:
            now->drag += fmaxf(force->strength, 0);
            break;
        case SF_FORCE_WIND:
            for (int axis = 0; axis < 3; axis++)
                now->wind[axis] += force->velocity[axis];
            break;
        case SF_FORCE_TURBULENCE:
            /* Purposes above those of particles (shared/sim.h): one field a force. */
            feed_turbulence(force, sf_random_u32(now->seed, i, 0x10000u), ((double)step + 0.5) * h,
                            &now->turbulences[now->turbulence_count++]);
            break;
        default:
            feed_vortex(force, &now->vortices[now->vortex_count++]);
            break;
        }
    }
    now->motion[0] = (float)exp(-now->drag * h);
    now->motion[1] = (float)decay_integral(now->drag, h);
    now->motion[2] = (float)decay_integral_twice(now->drag, h);
    /* What the forces themselves give within two steps is resting, not bouncing. */
    now->quiet = 0.01f + (float)(2 * h *
                                 sqrt((double)now->acceleration[0] * now->acceleration[0] +
                                      (double)now->acceleration[1] * now->acceleration[1] +
                                      (double)now->acceleration[2] * now->acceleration[2]));
}

size_t sf_sim_feed(const struct sf_scene *scene, const struct sf_sim_layout *layout, uint64_t step,
                   struct sf_sim_now *now, struct sf_sim_births *births)
{
    memset(now, 0, offsetof(struct sf_sim_now, objects));
    now->seed = (uint32_t)scene->sim.seed;
    now->capacity = (uint32_t)scene->sim.capacity;
    now->dt = (float)(1 / sf_sim_step_rate(scene));
    feed_forces(scene, step, now);
    sf_sim_feed_births(scene, layout, step, now, births);
    for (uint32_t i = 0; i < scene->emitter_count; i++)
        feed_emitter(scene, layout, i, now, &births->emitters[i]);
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (sf_obstacle_collides(&scene->objects[i]))
            sf_obstacle_fill(&scene->objects[i], &now->objects[now->object_count++]);
    return offsetof(struct sf_sim_now, objects) + now->object_count * sizeof now->objects[0];
}
