/* The camera, and the elements of the lists: lights, objects, emitters, forces. */
#include "scene/table_inner.h"

static const struct sf_param camera_key_rows[] = {
    {ROW_FLOAT("time", struct sf_camera_key, time, 0, -1e5, 1e5, "s",
               "counted from frame 0, ascending from key to key"),
     .required = true},
    {ROW_VEC3("eye", struct sf_camera_key, eye, 0, 0, 0, -1e5, 1e5, "m", "where the eye is"), .required = true},
    {ROW_VEC3("target", struct sf_camera_key, target, 0, 0, 0, -1e5, 1e5, "m", "what it looks at"), .required = true},
    {ROW_FLOAT("fov", struct sf_camera_key, fov, 40, 1, 170, "deg", "vertical field of view, from edge to edge")},
};
static const struct sf_param_group camera_key_group = GROUP(
    "camera key", struct sf_camera_key, camera_key_rows, "The camera at a moment; Catmull-Rom between, still outside.");

static const char *const camera_kinds[] = {"fixed", "orbit", "keyframes", NULL};
static const struct sf_param camera_rows[] = {
    {ROW_ENUM("type", struct sf_camera, kind, camera_kinds, SF_CAMERA_FIXED,
              "stands, circles its target, or follows keys")},
    {ROW_VEC3("eye", struct sf_camera, eye, 0, 1.5, 6, -1e5, 1e5, "m", "where the eye is (orbit: at frame 0)"),
     .only_for = "fixed orbit"},
    {ROW_VEC3("target", struct sf_camera, target, 0, 1, 0, -1e5, 1e5, "m", "what it looks at: the picture's centre"),
     .only_for = "fixed orbit"},
    {ROW_VEC3("up", struct sf_camera, up, 0, 1, 0, -1, 1, "",
              "what is up in the picture; need not be at right angles to the view")},
    {ROW_FLOAT("fov", struct sf_camera, fov, 40, 1, 170, "deg", "vertical field of view, from edge to edge"),
     .only_for = "fixed orbit"},
    {ROW_FLOAT("near", struct sf_camera, near_clip, 0.05, 1e-4, 1e3, "m",
               "nothing nearer is drawn (depth along the view)")},
    {ROW_FLOAT("period", struct sf_camera, period, 24, -1e5, 1e5, "s",
               "of one turn about the target's vertical, counter-clockwise from above; negative: clockwise"),
     .only_for = "orbit"},
    {ROW_LIST("keys", struct sf_camera, keys, key_count, camera_key_group, 1, SF_PATH_MAX, "the way it goes"),
     .list_pointer = true, .only_for = "keyframes", .required = true},
};
const struct sf_param_group sf_scene_camera_group =
    GROUP("camera", struct sf_camera, camera_rows, "The eye. No lens distortion.");

static const char *const light_kinds[] = {"directional", "point", "spot", NULL};
static const struct sf_param light_rows[] = {
    {ROW_ENUM("type", struct sf_light, kind, light_kinds, SF_LIGHT_DIRECTIONAL, "a sun, a bulb, a cone of light"),
     .required = true, .rebuild = SF_REBUILD_GRAPH},
    {ROW_COLOR("color", struct sf_light, color, 1, 1, 1, 1e3, "", "multiplies the intensity")},
    {ROW_FLOAT("intensity", struct sf_light, intensity, 3, 0, 1e6, "W/m2, W/sr",
               "directional: irradiance of a surface facing it; point, spot: radiant intensity")},
    {ROW_VEC3("direction", struct sf_light, direction, 0, -1, 0, -1e5, 1e5, "",
              "the way the light travels, of any length but 0"),
     .only_for = "directional spot", .required = true},
    {ROW_VEC3("position", struct sf_light, position, 0, 3, 0, -1e5, 1e5, "m", "where it stands"),
     .only_for = "point spot", .required = true},
    {ROW_FLOAT("inner", struct sf_light, inner, 20, 0, 89, "deg", "half angle inside which it is at full intensity"),
     .only_for = "spot"},
    {ROW_FLOAT("outer", struct sf_light, outer, 30, 0.1, 89, "deg", "half angle outside which it is dark"),
     .only_for = "spot"},
    {ROW_BOOL("shadows", struct sf_light, shadows, 1, "objects and smoke cast shadows in it"),
     .rebuild = SF_REBUILD_GRAPH},
};
const struct sf_param_group sf_scene_light_group = GROUP("light", struct sf_light, light_rows, "A lamp.");

static const char *const object_kinds[] = {"plane", "box", "sphere", "cylinder", "mesh", NULL};
static const struct sf_param object_rows[] = {
    {ROW_ENUM("type", struct sf_object, kind, object_kinds, SF_OBJECT_PLANE, "its shape"), .required = true,
     .rebuild = SF_REBUILD_SIM | SF_REBUILD_GRAPH},
    {ROW_VEC3("position", struct sf_object, position, 0, 0, 0, -1e5, 1e5, "m",
              "plane: a point of it; mesh: its origin; else the centre"),
     .rebuild = SF_REBUILD_SIM},
    {ROW_VEC3("rotation", struct sf_object, rotation, 0, 0, 0, -360, 360, "deg",
              "about x, then y, then z, about its position"),
     .only_for = "box cylinder mesh", .rebuild = SF_REBUILD_SIM},
    {ROW_VEC3("size", struct sf_object, size, 1, 1, 1, 1e-3, 1e5, "m", "full edge lengths"), .only_for = "box",
     .rebuild = SF_REBUILD_SIM},
    {ROW_FLOAT("radius", struct sf_object, radius, 0.5, 1e-3, 1e5, "m", "of the sphere, of the cylinder"),
     .only_for = "sphere cylinder", .rebuild = SF_REBUILD_SIM},
    {ROW_FLOAT("height", struct sf_object, height, 1, 1e-3, 1e5, "m", "along its own y, full"), .only_for = "cylinder",
     .rebuild = SF_REBUILD_SIM},
    {ROW_VEC3("normal", struct sf_object, normal, 0, 1, 0, -1e5, 1e5, "", "the side that is free, of any length but 0"),
     .only_for = "plane", .rebuild = SF_REBUILD_SIM},
    {ROW_FLOAT("scale", struct sf_object, scale, 1, 1e-6, 1e6, "", "m for each unit of the file"), .only_for = "mesh"},
    {ROW_COLOR("albedo", struct sf_object, albedo, 0.5, 0.5, 0.5, 1, "",
               "share of the light that it reflects, evenly to all sides")},
    {ROW_COLOR("albedo2", struct sf_object, albedo2, 0.25, 0.25, 0.25, 1, "", "of the checker's other squares"),
     .only_for = "plane"},
    {ROW_FLOAT("checker", struct sf_object, checker, 0, 0, 1e5, "m", "edge of the checker's squares; 0: none"),
     .only_for = "plane", .rebuild = SF_REBUILD_GRAPH},
    {ROW_BOOL("collide", struct sf_object, collide, 1, "particles cannot enter it"),
     .only_for = "plane box sphere cylinder", .rebuild = SF_REBUILD_SIM},
    {ROW_FLOAT("restitution", struct sf_object, restitution, 0.1, 0, 1, "",
               "share of the speed towards it that bounces back"),
     .only_for = "plane box sphere cylinder", .rebuild = SF_REBUILD_SIM},
    {ROW_FLOAT("friction", struct sf_object, friction, 0.1, 0, 1, "",
               "share of the speed along it that is lost at a touch"),
     .only_for = "plane box sphere cylinder", .rebuild = SF_REBUILD_SIM},
    {ROW_STRING("file", struct sf_object, file, "OBJ or glTF, seen from the scene's folder"), .only_for = "mesh",
     .required = true, .rebuild = SF_REBUILD_ASSETS},
};
const struct sf_param_group sf_scene_object_group =
    GROUP("object", struct sf_object, object_rows, "A solid, matt thing.");

static const struct sf_param path_rows[] = {
    {ROW_FLOAT("time", struct sf_path_key, time, 0, 0, 1e5, "s", "counted from the simulation's beginning, ascending"),
     .required = true},
    {ROW_VEC3("position", struct sf_path_key, position, 0, 0, 0, -1e5, 1e5, "m", "relative to the emitter's position"),
     .required = true},
};
static const struct sf_param_group path_group = GROUP(
    "path key", struct sf_path_key, path_rows, "Where an emitter is at a moment; Catmull-Rom between, still outside.");

static const struct sf_param particle_rows[] = {
    {ROW_VEC3("centre", struct sf_listed, centre, 0, 0, 0, -1e5, 1e5, "m", "where it is"), .required = true},
    {ROW_FLOAT("radius", struct sf_listed, radius, 0.1, 1e-4, 1e4, "m", "of the sphere"), .required = true},
    {ROW_FLOAT("extinction", struct sf_listed, extinction, -1, -1, 1e4, "1/m",
               "inside the sphere; below 0: the emitter's")},
    {ROW_VEC3("velocity", struct sf_listed, velocity, 0, 0, 0, -1e4, 1e4, "m/s", "at first")},
    {ROW_FLOAT("age", struct sf_listed, age, 0, 0, 1e5, "s", "at first")},
    {ROW_FLOAT("lifetime", struct sf_listed, lifetime, 0, 0, 1e5, "s", "the age at which it dies; 0: never")},
    {ROW_FLOAT("tile", struct sf_listed, tile, 0, 0, 3, "", "of the 2x2 atlas, a whole number")},
    {ROW_FLOAT("rotation", struct sf_listed, rotation, 0, -1e4, 1e4, "rad", "of the atlas tile")},
};
const struct sf_param_group sf_scene_particle_group =
    GROUP("particle", struct sf_listed, particle_rows, "One particle, exactly as stated.");

#define NOT_LIST "cone sphere box mesh"
static const char *const emitter_kinds[] = {"cone", "sphere", "box", "mesh", "list", NULL};
static const struct sf_param emitter_rows[] = {
    {ROW_ENUM("type", struct sf_emitter, kind, emitter_kinds, SF_EMITTER_CONE,
              "a disc that blows in a cone, a sphere, a box, a mesh's surface, or particles one by one"),
     .required = true},
    {ROW_VEC3("position", struct sf_emitter, position, 0, 0, 0, -1e5, 1e5, "m", "of its centre or origin"),
     .only_for = NOT_LIST},
    {ROW_VEC3("direction", struct sf_emitter, direction, 0, 1, 0, -1e5, 1e5, "",
              "of the first velocity, of any length; 0,0,0 (not for a cone): outward"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("angle", struct sf_emitter, angle, 15, 0, 180, "deg", "half angle of the cone of directions about it"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("radius", struct sf_emitter, radius, 0.2, 0, 1e4, "m", "of the cone's mouth, of the sphere"),
     .only_for = "cone sphere"},
    {ROW_VEC3("size", struct sf_emitter, size, 1, 1, 1, 0, 1e4, "m", "full edge lengths"), .only_for = "box"},
    {ROW_STRING("file", struct sf_emitter, file, "mesh: OBJ or glTF; list: CSV or PLY; seen from the scene's folder"),
     .only_for = "mesh list", .rebuild = SF_REBUILD_ASSETS},
    {ROW_FLOAT("scale", struct sf_emitter, scale, 1, 1e-6, 1e6, "", "m for each unit of the file"), .only_for = "mesh"},
    {ROW_FLOAT("rotation", struct sf_emitter, rotation, 0, -360, 360, "deg",
               "of the box or mesh about +y; direction stays"),
     .only_for = "box mesh"},
    {ROW_BOOL("surface", struct sf_emitter, surface, 0, "only from its surface"), .only_for = "sphere box"},
    {ROW_FLOAT("rate", struct sf_emitter, rate, 60, 0, 1e7, "1/s", "particles a second"), .only_for = NOT_LIST},
    {ROW_INT("burst", struct sf_emitter, burst, 0, 0, SF_PARTICLES_MAX, "particles", "all at once at the start"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("start", struct sf_emitter, start, 0, 0, 1e5, "s",
               "when it begins, counted from the simulation's beginning")},
    {ROW_FLOAT("duration", struct sf_emitter, duration, 0, 0, 1e5, "s", "how long it goes on; 0: for ever"),
     .only_for = NOT_LIST},
    {ROW_RANGE("lifetime", struct sf_emitter, lifetime, 4, 5, 1e-3, 1e5, "s", "of a particle, even between the two"),
     .only_for = NOT_LIST},
    {ROW_RANGE("speed", struct sf_emitter, speed, 0.8, 1.2, 0, 1e4, "m/s", "at first"), .only_for = NOT_LIST},
    {ROW_RANGE("particle_radius", struct sf_emitter, particle_radius, 0.15, 0.25, 1e-4, 1e4, "m", "at first"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("growth", struct sf_emitter, growth, 0.1, 0, 1e4, "m/s", "of the radius"), .only_for = NOT_LIST},
    {ROW_FLOAT("extinction", struct sf_emitter, extinction, -1, -1, 1e4, "1/m",
               "of a particle at first; below 0: the medium's")},
    {ROW_FLOAT("dilution", struct sf_emitter, dilution, 0.3, 0, 1, "",
               "how extinction falls as a particle grows: 0 not at all, 1 with its volume"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("fade_in", struct sf_emitter, fade_in, 0.08, 0, 1, "", "share of life in which extinction rises from 0"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("fade_out", struct sf_emitter, fade_out, 0.5, 0, 1, "", "share of life in which it falls to 0"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("temperature", struct sf_emitter, temperature, 30, -273, 1e4, "K", "above the air's, at first"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("cooling", struct sf_emitter, cooling, 0.4, 0, 1e3, "1/s", "the temperature falls as exp(-cooling age)"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("spin", struct sf_emitter, spin, 0.3, 0, 100, "rad/s", "of the atlas tile, to either side"),
     .only_for = NOT_LIST},
    {ROW_FLOAT("inherit", struct sf_emitter, inherit, 0.2, -10, 10, "",
               "share of the emitter's own velocity that particles get"),
     .only_for = NOT_LIST},
    {ROW_BOOL("still", struct sf_emitter, still, 0, "its particles neither move, nor age, nor die"),
     .only_for = "list"},
    {ROW_LIST("path", struct sf_emitter, path, path_count, path_group, 1, SF_PATH_MAX, "the way it moves"),
     .list_pointer = true, .only_for = NOT_LIST},
    {ROW_BOOL("path_loop", struct sf_emitter, path_loop, 0,
              "the path begins again after its last key, which must be at the first one's position"),
     .only_for = NOT_LIST},
    {ROW_LIST("particles", struct sf_emitter, list, list_count, sf_scene_particle_group, 0, SF_PARTICLES_MAX,
              "the particles, unless a file holds them"),
     .list_pointer = true, .only_for = "list"},
};
const struct sf_param_group sf_scene_emitter_group =
    GROUP("emitter", struct sf_emitter, emitter_rows, "A source of particles.");

static const char *const force_kinds[] = {"gravity", "buoyancy", "drag", "wind", "turbulence", "vortex", NULL};
static const struct sf_param force_rows[] = {
    {ROW_ENUM("type", struct sf_force, kind, force_kinds, SF_FORCE_GRAVITY,
              "what pushes; winds, turbulence and vortices push through drag"),
     .required = true},
    {ROW_VEC3("acceleration", struct sf_force, acceleration, 0, -9.81, 0, -1e4, 1e4, "m/s2", "the same everywhere"),
     .only_for = "gravity"},
    {ROW_FLOAT("strength", struct sf_force, strength, 1, -1e4, 1e4, "m/s2/K, 1/s, m/s",
               "buoyancy: upward, for each K; drag: towards the air's velocity, not below 0; turbulence: root mean "
               "square, not below 0; "
               "vortex: speed at its radius"),
     .only_for = "buoyancy drag turbulence vortex", .required = true},
    {ROW_VEC3("velocity", struct sf_force, velocity, 1, 0, 0, -1e4, 1e4, "m/s", "of the air"), .only_for = "wind",
     .required = true},
    {ROW_FLOAT("scale", struct sf_force, scale, 1, 1e-3, 1e5, "m", "size of the largest eddies"),
     .only_for = "turbulence"},
    {ROW_INT("octaves", struct sf_force, octaves, 3, 1, 8, "", "each of half the size of the one before"),
     .only_for = "turbulence"},
    {ROW_FLOAT("rate", struct sf_force, rate, 0.5, 0, 1e3, "1/s", "how fast the eddies change"),
     .only_for = "turbulence"},
    {ROW_VEC3("position", struct sf_force, position, 0, 0, 0, -1e5, 1e5, "m", "a point of the axis"),
     .only_for = "vortex"},
    {ROW_VEC3("axis", struct sf_force, axis, 0, 1, 0, -1e5, 1e5, "", "about which it turns, of any length but 0"),
     .only_for = "vortex"},
    {ROW_FLOAT("radius", struct sf_force, radius, 0.5, 1e-3, 1e5, "m", "where it is fastest"), .only_for = "vortex"},
    {ROW_FLOAT("pull", struct sf_force, pull, 0, -1e4, 1e4, "m/s", "speed towards the axis at its radius"),
     .only_for = "vortex"},
};
const struct sf_param_group sf_scene_force_group =
    GROUP("force", struct sf_force, force_rows, "What moves particles: dv/dt = gravity + buoyancy + drag (air - v).");
