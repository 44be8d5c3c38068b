/* A scene, validated: plain structs that everything downstream reads. Units: metres, seconds, degrees in files and
 * here, radiance in linear Rec. 709, right-handed, +Y up. docs/scene.md says what each means to the last sign.
 *
 * Two clocks. Camera times count from frame 0: frame n is at n/fps. Simulation times (an emitter's start and path,
 * turbulence) count from the beginning of the simulation, which is sim.preroll seconds before frame 0: frame n is at
 * preroll + n/fps.
 *
 * A field that an object's kind does not take (docs/params.md lists them) is zero. */
#ifndef SF_SCENE_SCENE_H
#define SF_SCENE_SCENE_H

#include <stdbool.h>
#include <stdint.h>
#include "base/array.h"
#include "base/log.h"
#include "scene/timeline.h"
#include "sfumato/sfumato.h"

enum {
    SF_LIGHTS_MAX = 8,
    SF_OBJECTS_MAX = 64,
    SF_MESHES_MAX = 16,
    SF_EMITTERS_MAX = 128,
    SF_FORCES_MAX = 16,
    SF_EFFECTS_MAX = 64,
    SF_FLASHES_MAX = 32,
    SF_SHAKES_MAX = 32,
    SF_RAMP_MAX = 16,
    SF_PATH_MAX = 64, /* keyframes of a camera or an emitter's path */
    SF_PARTICLES_MAX = 1 << 20,
    SF_CONTROLS_LIST_MAX = 64, /* elements of a longer list are no controls */
};

enum sf_camera_kind { SF_CAMERA_FIXED, SF_CAMERA_ORBIT, SF_CAMERA_KEYFRAMES };
struct sf_camera_key {
    float time; /* s, ascending */
    float eye[3], target[3];
    float fov; /* deg, vertical */
};
struct sf_camera {
    int32_t kind;
    float eye[3], target[3], up[3];
    float fov;       /* deg, vertical, full angle */
    float near_clip; /* m: nothing nearer is drawn (view-space depth) */
    /* orbit: the eye circles the target's vertical axis, starting at `eye` */
    float period;               /* s for one turn, counter-clockwise seen from above when positive */
    struct sf_camera_key *keys; /* keyframes: Catmull-Rom through eye and target, linear in fov */
    uint32_t key_count;
};

enum sf_light_kind { SF_LIGHT_DIRECTIONAL, SF_LIGHT_POINT, SF_LIGHT_SPOT };
struct sf_light {
    int32_t kind;
    float color[3];
    float intensity;    /* directional: irradiance of a surface facing it, W/m2 (times color); point, spot: radiant
                           intensity, W/sr */
    float direction[3]; /* directional, spot: the way the light travels; normalised by the loader */
    float position[3];  /* point, spot */
    float inner, outer; /* spot: half angles in deg; smoothstep of the cosine between them */
    bool shadows;
    const struct sf_timing *timing; /* of an effect's step: its strength multiplies the intensity; NULL: always on */
    float flicker, frequency;       /* of an effect's step: share of it that comes and goes, so often a second */
};

enum sf_object_kind { SF_OBJECT_PLANE, SF_OBJECT_BOX, SF_OBJECT_SPHERE, SF_OBJECT_CYLINDER, SF_OBJECT_MESH };
struct sf_object {
    int32_t kind;
    float position[3]; /* plane: a point of it; else the centre */
    float rotation[3]; /* deg about x, then y, then z (R = Rz Ry Rx), of the object about its position */
    float size[3];     /* box: full edge lengths */
    float radius;      /* sphere, cylinder */
    float height;      /* cylinder: full, along its own y */
    float normal[3];   /* plane: normalised; rotation does not apply */
    float scale;       /* mesh */
    float albedo[3];   /* Lambertian */
    float albedo2[3];  /* checker's second colour; equal to albedo when no checker is asked for */
    /* m: edge of a checker's square on planes, 0: none. With e = +z (if |normal.z| > 0.9: +x), u =
     * normalize(cross(normal, e)) and v = cross(u, normal), it is albedo where floor(u.(x - position)/checker) +
     * floor(v.(x - position)/checker) is even. */
    float checker;
    bool collide;                /* particles collide with it (not meshes) */
    float restitution, friction; /* of the collision: 0..1 */
    const char *file;            /* mesh */
    uint32_t mesh;               /* index into meshes, when kind is mesh */
};

struct sf_mesh { /* triangles, deduplicated by file */
    const char *file;
    float *positions; /* [vertex_count][3] */
    float *normals;   /* [vertex_count][3] */
    uint32_t *indices;
    uint32_t vertex_count, index_count;
    float min[3], max[3];
};

struct sf_medium {
    float extinction;  /* 1/m: default of emitters that do not state theirs */
    float albedo[3];   /* single-scattering */
    float g;           /* Henyey-Greenstein, -0.99..0.99 */
    float emission[3]; /* W/(m2 sr), times extinction */
};

enum sf_emitter_kind { SF_EMITTER_CONE, SF_EMITTER_SPHERE, SF_EMITTER_BOX, SF_EMITTER_MESH, SF_EMITTER_LIST };
struct sf_path_key {
    float time;
    float position[3];
};
struct sf_listed {                       /* one explicit particle, exactly as stated */
    float centre[3], radius, extinction; /* m, m, 1/m */
    float velocity[3];                   /* m/s, default 0 */
    float age, lifetime;                 /* s; lifetime 0: does not die */
    float tile, rotation;                /* atlas tile 0..3; rad */
};
struct sf_emitter {
    int32_t kind;
    float position[3];
    float direction[3]; /* cone's axis; normalised. Sphere, box, mesh: direction of the first velocity; 0,0,0: outward
                           (from the centre; mesh: normal) */
    float angle;        /* cone: half angle in deg; elsewhere the spread about direction */
    float radius;       /* cone: of its mouth; sphere: of it */
    float size[3];      /* box */
    const char *file;   /* mesh, or list's CSV/PLY */
    uint32_t mesh;
    float scale;
    float rotation;        /* box, mesh: deg about +y, about position; does not turn `direction` */
    bool surface;          /* sphere, box: only from the surface */
    float rate;            /* 1/s */
    int32_t burst;         /* particles at `start` */
    float start, duration; /* s on the simulation's clock; duration 0: for ever. A list appears at `start`, all of it */
    float lifetime[2];     /* s, uniform between */
    float speed[2];        /* m/s */
    float particle_radius[2]; /* m at birth */
    float growth;             /* m/s */
    float extinction;         /* 1/m at birth; the loader puts the medium's where the file gives none */
    /* 0: extinction stays as the particle grows; 1: it falls with the radius cubed, so that mass is kept:
     * extinction * pow(radius_at_birth / radius, 3 dilution). */
    float dilution;
    /* Fractions of life over which extinction rises from 0 and falls to 0. With l = age/lifetime: times smoothstep(0,
     * fade_in, l) and 1 - smoothstep(1 - fade_out, 1, l); 0: no fade. */
    float fade_in, fade_out;
    float temperature;        /* K above the ambient at birth: drives buoyancy */
    float cooling;            /* 1/s: temperature * exp(-cooling age) */
    float spin;               /* rad/s, of the atlas tile, random sign */
    float inherit;            /* share of the emitter's own velocity given to the particle */
    bool still;               /* list: does not move, age or die */
    struct sf_path_key *path; /* moving emitter: Catmull-Rom; positions relative to `position` */
    uint32_t path_count;
    bool path_loop;
    struct sf_listed *list;
    uint32_t list_count;
    /* Of an effect's step: `start`, `duration` and the path count on its innermost clock, and its strength multiplies
     * the rate. NULL: a scene's own, on the simulation's clock. */
    const struct sf_timing *timing;
    const char *origin; /* where it comes from, for messages; NULL: the scene's list */
};

enum sf_force_kind {
    SF_FORCE_GRAVITY,
    SF_FORCE_BUOYANCY,
    SF_FORCE_DRAG,
    SF_FORCE_WIND,
    SF_FORCE_TURBULENCE,
    SF_FORCE_VORTEX
};
/* dv/dt = gravity + buoyancy + drag (u(x, t) - v), where u is the sum of all winds, turbulences and vortices. */
struct sf_force {
    int32_t kind;
    float acceleration[3]; /* gravity: m/s2 */
    float strength;    /* buoyancy: m/s2 per K, along +y; drag: 1/s towards the local wind; turbulence: m/s (rms) of the
                          velocity field; vortex: m/s at radius */
    float velocity[3]; /* wind: m/s, what drag pulls towards */
    float scale;       /* turbulence: m, size of the largest eddies */
    int32_t octaves;   /* turbulence */
    float rate;        /* turbulence: 1/s, how fast the field changes */
    float position[3], axis[3]; /* vortex: a point of its axis, and the axis, normalised */
    float radius; /* vortex: core radius. At distance d from the axis, with s = d/radius and e pointing away from the
                     axis, u = 2s/(1 + s^2) (strength cross(axis, e) - pull e) */
    float pull;   /* vortex: m/s inward at radius */
};

/* ---- effects: what of them is neither an emitter nor a light ---- */

struct sf_placed_effect { /* as the scene states it */
    const char *file;
    float position[3];
    float rotation; /* deg about +y */
    float scale;
    struct sf_clock clock; /* on the simulation's clock */
};
struct sf_flash {
    float color[3], strength; /* W/(m2 sr) added to the whole picture, times the timing's strength */
    const struct sf_timing *timing;
};
struct sf_shake {
    float amplitude, angle, frequency; /* m, deg, 1/s; times the timing's strength */
    const struct sf_timing *timing;
};

enum sf_environment_kind { SF_ENVIRONMENT_SKY, SF_ENVIRONMENT_COLOR, SF_ENVIRONMENT_LATLONG, SF_ENVIRONMENT_CUBE };
struct sf_environment {
    int32_t kind;
    float zenith[3], horizon[3],
        ground[3]; /* gradient sky radiance along direction d: mix(horizon, zenith, smoothstep(0, 1, d.y)) above,
                      mix(horizon, ground, smoothstep(0, 0.25, -d.y)) below */
    float color[3];
    const char *file;     /* lat-long: EXR, HDR, PNG */
    const char *files[6]; /* cube: +x -x +y -y +z -z */
    float intensity;      /* times the picture or gradient */
    float rotation; /* deg about +y: along d one sees the picture's radiance along Ry(-rotation) d. `pixels` are not yet
                       rotated, `sh` is */
    bool visible;   /* drawn behind the scene; else `background` */
    float background[3];
    /* loaded pixels, linear, before `intensity`: lat-long [height][width][3], centre of the picture looks along -z, +y
     * up, +x to the right of it (u = 1/2 + atan2(x, -z)/2pi, v = acos(y)/pi from the top row); NULL for sky and color.
     * At most 1024x512. A cube file is resampled to this by the loader. */
    float *pixels;
    uint32_t width, height;
    /* Radiance (times intensity) convolved with the clamped cosine over pi, so that a constant L gives L: irradiance
     * over pi of a surface with normal n is sh0 + sh1 y + sh2 z + sh3 x + sh4 xy + sh5 yz + sh6 (3zz - 1) + sh7 xz +
     * sh8 (xx - yy): the basis' constants are multiplied in already. Filled by the loader for every kind. */
    float sh[9][3];
};

enum sf_atlas_kind { SF_ATLAS_PLAIN, SF_ATLAS_MADE, SF_ATLAS_FILE };
/* The pictures of smoke that particles carry. */
struct sf_atlas {
    int32_t kind;
    int32_t smoke;        /* made: which one of sfumato.h's kinds of texture, in their order there */
    int32_t across, down; /* tiles */
    int32_t size;         /* made: px of a tile's side */
    int32_t seed;         /* made */
    const char *file;
    struct sf_texture *texture; /* of the file, with alpha at least; the scene's. NULL for the other kinds */
    uint64_t hash;              /* of its pixels */
};

struct sf_ramp_key {
    float at;       /* 0 birth .. 1 death */
    float color[3]; /* multiplies the medium's albedo */
};

/* ---- settings: the groups of the parameter table that are not lists ---- */

enum sf_method {
    SF_METHOD_NONE,
    SF_METHOD_THICK,
    SF_METHOD_LARSSON,
    SF_METHOD_REFERENCE,
    SF_METHOD_HARD,
    SF_METHOD_SOFT,
    SF_METHOD_CONTRAST,
    SF_METHOD_SPHERICAL,
    SF_METHOD_MEGA,
    SF_METHOD_AVERAGE,
    SF_METHOD_EXTENT,
    SF_METHOD_VOLUMETRIC,
    SF_METHOD_LIT,
    SF_METHOD_SCATTERING,
};
enum sf_prepass { SF_PREPASS_NONE, SF_PREPASS_AGAIN, SF_PREPASS_EQUAL };
enum sf_resolution { SF_RESOLUTION_FULL, SF_RESOLUTION_HALF, SF_RESOLUTION_QUARTER };
enum sf_thick_placement { SF_PLACEMENT_EQUAL, SF_PLACEMENT_UNIFORM, SF_PLACEMENT_JITTERED };
enum sf_tone { SF_TONE_LINEAR, SF_TONE_REINHARD, SF_TONE_ACES, SF_TONE_NEUTRAL };

struct sf_sim_settings {
    int32_t seed;
    int32_t capacity; /* live particles at most */
    float fps;        /* frames a second: frame n is at time n/fps */
    int32_t substeps; /* fixed steps a frame: dt = 1/(fps substeps) */
    float preroll;    /* s simulated before frame 0 */
};
struct sf_output_settings {
    float exposure; /* stops, for PNG and window only */
    int32_t tone;
};
struct sf_surface_settings {
    int32_t prepass; /* enum sf_prepass: how the scene's depth is made */
};
struct sf_shadow_settings {
    int32_t map_size; /* px: exponential shadow map of scene on scene and on smoke, per light */
    float softness;   /* px: sigma of its blur */
    float exponent;   /* of the map */
};
/* Of thick and of thick-larsson, but for placement and light_slices, which are of thick alone. Methods of billboards read
 * resolution, octaves, detail, detail_scale, ambient and the shadows. */
struct sf_thick_settings {
    int32_t resolution;   /* of the smoke's passes, against the frame */
    int32_t steps;        /* samples along the camera ray */
    int32_t placement;    /* enum sf_thick_placement */
    int32_t octaves;      /* of multiple scattering, 1..4; 1 is single scattering, what the reference computes */
    int32_t light_size;   /* px: light-view map, per light */
    int32_t light_slices; /* depths of each of its texels */
    float light_blur;     /* px: sigma in the light map */
    float detail;         /* 0..1 strength of the atlas in density */
    float detail_scale;   /* tiles across a particle's diameter */
    float ambient;        /* times the environment's */
    bool scene_shadow;    /* scene objects shadow the smoke */
    bool ground_shadow;   /* smoke shadows the scene */
};

/* Of thick-larsson alone. */
struct sf_larsson_settings {
    float blur;         /* px of the full frame: sigma of the camera-view blur */
    float density_blur; /* 0: exact optical depth; 1: blurred as the thesis does */
    float thin; /* optical depth across a particle below which its surfaces recede from the min/max views; 0: never, as
                   in the thesis */
    float soft; /* m: extra fade towards the scene's surface (thesis pass 10); 0: none, the clipped chord does it */
    float life_fade; /* exponent of the thesis' alpha-from-life; 0: none */
};
struct sf_reference_settings {
    int32_t samples;     /* along each ray through the smoke, when the picture is finished */
    int32_t batch;       /* of them in one play of the graph: what is done between two pictures of the viewer */
    int32_t shadow_size; /* px: map of the smoke's shadow on the scene, per light */
    bool ground_shadow;  /* smoke shadows the scene */
};

/* Of all methods of billboards; they take from thick what is common to both. */
struct sf_billboard_settings {
    int32_t upsample; /* enum sf_upsample */
    float density;    /* times the medium's extinction */
    float near_fade;  /* radii before the near plane in which a flat billboard fades */
    bool self_shadow; /* particles shadow each other */
};
enum sf_upsample { SF_UPSAMPLE_DEPTH, SF_UPSAMPLE_PLAIN };
struct sf_soft_settings {
    float distance; /* m of the fade; 0: the particle's radius */
    float power;    /* of soft-contrast */
};
struct sf_average_settings {
    float depth;   /* radii: of the volume, D */
    float plane;   /* share of it before the particle's centre */
    float opacity; /* V */
};
struct sf_extent_settings {
    float depth;     /* radii: how far the picture's alpha reaches to either side of the plane, D */
    float opacity;   /* V */
    float deviation; /* 0..1: of the picture's heights, by which the plane is moved to the viewer */
    float lighting;  /* 0..1: how strongly normals light the particle */
};
struct sf_volumetric_settings {
    int32_t steps;   /* through a particle */
    float scale;     /* features of the noise across a particle */
    float strength;  /* 0..1: 0 is the uniform sphere */
    float evolution; /* cycles of the noise in a particle's life */
    float lighting;  /* 0..1: how much brighter the lit side is */
};

/* What is in the picture is in heights of the frame, so that it looks the same at any size. Beside these, thick's
 * resolution, ambient and shadows. */
enum sf_mega_noise { SF_MEGA_WORLD, SF_MEGA_SCREEN };
struct sf_mega_settings {
    float blur;         /* frame heights: sigma */
    int32_t noise;      /* enum sf_mega_noise: what it is fixed to */
    float amplitude;    /* frame heights: root mean square length of the displacement */
    float scale;        /* m: of the world's noise; 0: the largest diameter at birth */
    float screen_scale; /* frame heights: of the screen's noise */
    int32_t octaves;    /* of the noise; 0: no displacement */
    float speed;        /* 1/s: rate of its change */
    float diffuse;      /* times the medium's albedo */
    float specular;     /* share of light in the lobe */
    float shininess;    /* exponent of the lobe */
    float soft;         /* m before the scene in which smoke fades; 0: the largest radius at birth */
};
/* Of lit and lit-scattering. */
struct sf_lit_settings {
    float relief;       /* 0: lit as balls; 1: by the atlas's normals; between: a mix */
    float wrap;         /* 0..1: how far light reaches round a puff */
    float translucency; /* strength of the light from behind: 1 takes in as much of it as isotropic smoke */
    float halo;         /* of lit: how much of it the middle of a puff takes away, as an exponent */
    float blend;        /* 0: covers what is behind; 1: adds to it */
    int32_t ramp;       /* enum sf_lit_ramp: what the scene's ramp runs over */
};
enum sf_lit_ramp { SF_LIT_RAMP_LIFE, SF_LIT_RAMP_INTENSITY };
struct sf_scattering_settings {
    int32_t steps;     /* of a ray through the height field, at most */
    int32_t steps_min; /* at least, or `steps` where that is less */
    int32_t more;      /* enum sf_scattering_more: which pixels have more of them */
    float absorption;  /* times the medium's extinction in the height field */
    float dampening;   /* 1/particle: of the light, by the number of particles */
};
enum sf_scattering_more { SF_SCATTERING_MORE_GRAZING, SF_SCATTERING_MORE_FACING };

struct sf_scene {
    const char *path; /* where it came from */
    uint64_t hash;    /* of the canonical JSON after --set, plus the bytes of the files that it names */
    struct sf_camera camera;
    struct sf_light lights[SF_LIGHTS_MAX];
    uint32_t light_count;
    struct sf_object objects[SF_OBJECTS_MAX];
    uint32_t object_count;
    struct sf_mesh meshes[SF_MESHES_MAX];
    uint32_t mesh_count;
    struct sf_medium medium;
    struct sf_ramp_key ramp[SF_RAMP_MAX];
    uint32_t ramp_count; /* 0: white */
    struct sf_atlas atlas;
    struct sf_emitter emitters[SF_EMITTERS_MAX];
    uint32_t emitter_count;
    struct sf_force forces[SF_FORCES_MAX];
    uint32_t force_count;
    /* As the file lists them. The loader has put their emitters and lights behind the scene's own, and these: */
    struct sf_placed_effect effects[SF_EFFECTS_MAX];
    uint32_t effect_count;
    struct sf_flash flashes[SF_FLASHES_MAX];
    uint32_t flash_count;
    struct sf_shake shakes[SF_SHAKES_MAX];
    uint32_t shake_count;
    struct sf_environment environment;
    int32_t method; /* enum sf_method */
    struct sf_sim_settings sim;
    struct sf_output_settings output;
    struct sf_surface_settings surfaces;
    struct sf_shadow_settings shadow;
    struct sf_thick_settings thick;
    struct sf_larsson_settings larsson;
    struct sf_reference_settings reference;
    struct sf_billboard_settings billboard;
    struct sf_soft_settings soft;
    struct sf_mega_settings mega;
    struct sf_average_settings average;
    struct sf_extent_settings extent;
    struct sf_volumetric_settings volumetric;
    struct sf_lit_settings lit;
    struct sf_scattering_settings scattering;
    /* The values as they were given, before directions are normalised, emitters take the medium's extinction, and files
     * are read: what controls show. NULL in a scene that was not loaded. */
    const struct sf_scene *stated;
    struct sf_arena arena;
};

/* sf_scene_load, sf_scene_parse, sf_scene_destroy, sf_scene_describe: sfumato.h. Errors (SF_ERROR_SCENE; SF_ERROR_IO
 * when the scene file itself cannot be read; SF_ERROR_USAGE for a bad set) name the file, a JSON pointer, what is wrong
 * and the remedy. */

/* What differs between two scenes: bits of enum sf_rebuild (params/params.h), SF_REBUILD_READ among them; 0 when every
 * picture of the two is the same. Rows count as the table says. Files count by their contents: meshes and environment
 * pictures that differ are SF_REBUILD_ASSETS, with SF_REBUILD_GRAPH when they are not of the same size and SF_REBUILD_SIM
 * when an emitter uses the mesh; lists of particles are SF_REBUILD_SIM. Shadow maps have no bit: who draws them compares
 * what they are drawn from. */
unsigned sf_scene_difference(const struct sf_scene *before, const struct sf_scene *after);

/* Where an emitter comes from, for messages: "/emitters/3", or the place in the effect file. */
enum { SF_PLACE_BYTES = 512 };
const char *sf_emitter_place(const struct sf_scene *scene, uint32_t emitter, char buffer[SF_PLACE_BYTES]);

/* The lights as they are at a moment (s, counted from frame 0): those of effects with the intensity that they have then. */
void sf_scene_lights(const struct sf_scene *scene, double time, struct sf_light lights[SF_LIGHTS_MAX]);
/* Radiance that flashes add to the whole picture at that moment. */
void sf_scene_flash(const struct sf_scene *scene, double time, float rgb[3]);

/* The camera at a moment (fixed, orbit, keyframes resolved), shaken by what shakes it then. */
struct sf_camera_pose {
    float eye[3], target[3], up[3], fov, near_clip;
};
void sf_scene_camera(const struct sf_scene *scene, double time, struct sf_camera_pose *pose);
/* Where an emitter is at a moment of the clock that its path counts on (the simulation's, or of its step), and its velocity (zero before the path's first key and
 * after its last). */
void sf_scene_emitter_at(const struct sf_emitter *emitter, double time, float position[3], float velocity[3]);

/* What sf_texture_create makes the atlas from, when it is to be made. */
void sf_scene_atlas_options(const struct sf_atlas *atlas, struct sf_texture_options *options);
/* Particles, not rounded, that the stream of an effect's emitter has made when its step's innermost clock has run for
 * `local` s. */
double sf_emitter_stream(const struct sf_emitter *emitter, double local);

/* Radiance of the environment seen along a unit vector: what is drawn behind the scene when it is visible. */
void sf_environment_radiance(const struct sf_environment *environment, const float direction[3], float rgb[3]);
/* `sh` evaluated: irradiance over pi. */
void sf_environment_ambient(const struct sf_environment *environment, const float normal[3], float rgb[3]);

#endif
