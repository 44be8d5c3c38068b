/* The settings, the medium, the environment, and the whole. */
#include "scene/table_inner.h"

static const struct sf_param medium_rows[] = {
    {ROW_FLOAT("extinction", struct sf_medium, extinction, 4, 0, 1e4, "1/m",
               "extinction of particles whose emitter states none"),
     .rebuild = SF_REBUILD_SIM},
    {ROW_COLOR("albedo", struct sf_medium, albedo, 0.95, 0.95, 0.95, 1, "", "share of the extinction that scatters")},
    {ROW_FLOAT("g", struct sf_medium, g, 0, -0.99, 0.99, "",
               "Henyey-Greenstein: forward above 0, backward below, even at 0")},
    {ROW_COLOR("emission", struct sf_medium, emission, 0, 0, 0, 1e6, "W/(m2 sr)",
               "source of its own, times the extinction")},
};
static const struct sf_param_group medium_group =
    GROUP("medium", struct sf_medium, medium_rows, "What all the smoke is made of.");

static const struct sf_param ramp_rows[] = {
    {ROW_FLOAT("at", struct sf_ramp_key, at, 0, 0, 1, "", "share of the particle's life, ascending from key to key"),
     .required = true},
    {ROW_COLOR("color", struct sf_ramp_key, color, 1, 1, 1, 1, "", "what the medium's albedo is multiplied by"),
     .required = true},
};
static const struct sf_param_group ramp_group =
    GROUP("ramp", struct sf_ramp_key, ramp_rows,
          "A colour at a moment of a particle's life; linear between, constant outside.");

static const char *const atlas_kinds[] = {"plain", "made", "file", NULL};
static const char *const smoke_kinds[] = {"fbm", "turbulence", "cellular", "dispersed", NULL};
static const struct sf_param atlas_rows[] = {
    {ROW_ENUM("type", struct sf_atlas, kind, atlas_kinds, SF_ATLAS_PLAIN,
              "quick noise and puffs, smoke made by the program, a file"),
     .rebuild = SF_REBUILD_ASSETS},
    {ROW_ENUM("kind", struct sf_atlas, smoke, smoke_kinds, 3, "of smoke: see textures.md"), .only_for = "made",
     .rebuild = SF_REBUILD_ASSETS},
    {ROW_INT("across", struct sf_atlas, across, 2, 1, 8, "", "tiles side by side"), .only_for = "made file",
     .rebuild = SF_REBUILD_ASSETS},
    {ROW_INT("down", struct sf_atlas, down, 2, 1, 8, "", "tiles one below the other"), .only_for = "made file",
     .rebuild = SF_REBUILD_ASSETS},
    {ROW_INT("size", struct sf_atlas, size, 256, 8, 1024, "px", "side of a tile"), .only_for = "made",
     .rebuild = SF_REBUILD_ASSETS},
    {ROW_INT("seed", struct sf_atlas, seed, 1, 0, INT32_MAX, "", "another one, other smoke"), .only_for = "made",
     .rebuild = SF_REBUILD_ASSETS},
    {ROW_STRING("file", struct sf_atlas, file, "EXR or PNG with alpha, as sfumato texture writes them"),
     .only_for = "file", .required = true, .rebuild = SF_REBUILD_ASSETS},
};
static const struct sf_param_group atlas_group =
    GROUP("atlas", struct sf_atlas, atlas_rows, "The pictures of smoke that particles carry.");

static const char *const environment_kinds[] = {"sky", "color", "latlong", "cube", NULL};
static const struct sf_param environment_rows[] = {
    {ROW_ENUM("type", struct sf_environment, kind, environment_kinds, SF_ENVIRONMENT_SKY,
              "a gradient, one colour, a panorama, six pictures"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_COLOR("zenith", struct sf_environment, zenith, 0.25, 0.42, 0.75, 1e6, "W/(m2 sr)", "radiance straight up"),
     .only_for = "sky"},
    {ROW_COLOR("horizon", struct sf_environment, horizon, 0.62, 0.7, 0.8, 1e6, "W/(m2 sr)", "radiance at eye level"),
     .only_for = "sky"},
    {ROW_COLOR("ground", struct sf_environment, ground, 0.2, 0.19, 0.17, 1e6, "W/(m2 sr)", "radiance from below"),
     .only_for = "sky"},
    {ROW_COLOR("color", struct sf_environment, color, 0.5, 0.5, 0.5, 1e6, "W/(m2 sr)", "the same from everywhere"),
     .only_for = "color"},
    {ROW_STRING("file", struct sf_environment, file, "EXR, HDR or PNG, twice as wide as high, -z in its middle"),
     .only_for = "latlong", .required = true, .rebuild = SF_REBUILD_ASSETS},
    {.key = "files",
     .type = SF_PARAM_FILES,
     .offset = SF_OFFSET(struct sf_environment, files, sf_param_files),
     .unit = "",
     .doc = "EXR, HDR or PNG squares: +x, -x, +y, -y, +z, -z",
     .only_for = "cube",
     .required = true,
     .rebuild = SF_REBUILD_ASSETS},
    {ROW_FLOAT("intensity", struct sf_environment, intensity, 1, 0, 1e4, "", "multiplies its radiance")},
    {ROW_FLOAT("rotation", struct sf_environment, rotation, 0, -360, 360, "deg", "turns the pictures about +y"),
     .only_for = "latlong cube"},
    {ROW_BOOL("visible", struct sf_environment, visible, 1, "drawn behind the scene"),
     .rebuild = SF_REBUILD_GRAPH | SF_REBUILD_ASSETS}, /* only a picture that is seen is on the device */
    {ROW_COLOR("background", struct sf_environment, background, 0, 0, 0, 1e6, "W/(m2 sr)",
               "drawn behind the scene when the environment is not visible")},
};
static const struct sf_param_group environment_group =
    GROUP("environment", struct sf_environment, environment_rows,
          "Light from all around: it gives the ambient light, and the background.");

static const struct sf_param sim_rows[] = {
    {ROW_INT("seed", struct sf_sim_settings, seed, 1, 0, INT32_MAX, "",
             "of all randomness: the same seed, the same bits"),
     .rebuild = SF_REBUILD_SIM | SF_REBUILD_ASSETS}, /* the plain atlas is made from it */
    {ROW_INT("capacity", struct sf_sim_settings, capacity, 4096, 1, SF_PARTICLES_MAX, "particles",
             "live particles at most; what is emitted beyond is lost"),
     .rebuild = SF_REBUILD_SIM | SF_REBUILD_GRAPH},
    {ROW_FLOAT("fps", struct sf_sim_settings, fps, 24, 1, 1000, "1/s", "frames a second: frame n is at n/fps"),
     .rebuild = SF_REBUILD_SIM},
    {ROW_INT("substeps", struct sf_sim_settings, substeps, 2, 1, 64, "",
             "fixed steps of the simulation from one frame to the next"),
     .rebuild = SF_REBUILD_SIM},
    {ROW_FLOAT("preroll", struct sf_sim_settings, preroll, 0, 0, 600, "s", "simulated before frame 0")},
};
static const struct sf_param_group sim_group =
    GROUP("sim", struct sf_sim_settings, sim_rows, "How the particles are stepped through time.");

static const char *const tones[] = {"linear", "reinhard", "aces", "neutral", NULL};
static const struct sf_param output_rows[] = {
    {ROW_FLOAT("exposure", struct sf_output_settings, exposure, 0, -20, 20, "stops",
               "for PNG and window; EXR files hold the scene's radiance")},
    {ROW_ENUM("tone", struct sf_output_settings, tone, tones, SF_TONE_ACES,
              "curve from radiance to screen, for PNG and window")},
};
static const struct sf_param_group output_group =
    GROUP("output", struct sf_output_settings, output_rows, "How pictures for the eye are made.");

static const struct sf_param shadow_rows[] = {
    {ROW_INT("map_size", struct sf_shadow_settings, map_size, 512, 16, 8192, "px",
             "side of the shadow map of scene on scene and on smoke, per light"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("softness", struct sf_shadow_settings, softness, 1.5, 0, 16, "px", "sigma of the shadow map's blur")},
    {ROW_FLOAT("exponent", struct sf_shadow_settings, exponent, 40, 1, 80, "",
               "of the exponential shadow map: larger is sharper, and leaks less light")},
};
static const struct sf_param_group shadow_group =
    GROUP("shadow", struct sf_shadow_settings, shadow_rows, "Shadows of the scene's objects.");

static const char *const prepasses[] = {"none", "again", "equal", NULL};
static const struct sf_param surface_rows[] = {
    {ROW_ENUM("prepass", struct sf_surface_settings, prepass, prepasses, SF_PREPASS_NONE,
              "the scene's depth: beside its colours; before, and again with them; before, and they where it is equal"),
     .rebuild = SF_REBUILD_GRAPH},
};
static const struct sf_param_group surface_group =
    GROUP("surfaces", struct sf_surface_settings, surface_rows, "How the scene's objects are drawn.");

static const char *const placements[] = {"equal", "uniform", "jittered", NULL};
static const char *const resolutions[] = {"full", "half", "quarter", NULL};
static const struct sf_param thick_rows[] = {
    {ROW_ENUM("resolution", struct sf_thick_settings, resolution, resolutions, SF_RESOLUTION_HALF,
              "of the smoke's passes, against the frame's"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_INT("steps", struct sf_thick_settings, steps, 8, 1, 256, "",
             "samples along the camera's ray through the smoke"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_ENUM(
         "placement", struct sf_thick_settings, placement, placements, SF_PLACEMENT_EQUAL,
         "of the samples: equal shares of the light seen, equal lengths, or shares with a random shift (thick only)"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_INT("octaves", struct sf_thick_settings, octaves, 1, 1, 4, "",
             "of multiple scattering; 1: single scattering, as the reference computes it"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_INT("light_size", struct sf_thick_settings, light_size, 192, 16, 4096, "px",
             "side of the light's view of the smoke, per light"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_INT("light_slices", struct sf_thick_settings, light_slices, 16, 1, 64, "",
             "depths in each texel of it, rounded up to a multiple of 16 (thick only)"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("light_blur", struct sf_thick_settings, light_blur, 1.5, 0, 9.5, "px",
               "sigma of the light view's blur, in its own pixels"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("detail", struct sf_thick_settings, detail, 0.5, 0, 1, "",
               "how much of the density the atlas modulates"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("detail_scale", struct sf_thick_settings, detail_scale, 1, 0.05, 64, "",
               "tiles of the atlas across a particle")},
    {ROW_FLOAT("ambient", struct sf_thick_settings, ambient, 1, 0, 100, "",
               "multiplies the environment's light in the smoke")},
    {ROW_BOOL("scene_shadow", struct sf_thick_settings, scene_shadow, 1, "objects cast shadows on the smoke"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_BOOL("ground_shadow", struct sf_thick_settings, ground_shadow, 1, "the smoke casts shadows on objects"),
     .rebuild = SF_REBUILD_GRAPH},
};
static const struct sf_param_group thick_group =
    GROUP("thick", struct sf_thick_settings, thick_rows,
          "The methods thick and thick-larsson, thick smoke with volumetric lighting; and for the methods of "
          "billboards what they share with these.");

static const struct sf_param larsson_rows[] = {
    {ROW_FLOAT("blur", struct sf_larsson_settings, blur, 4, 0, 38, "px",
               "sigma of the camera view's blur, in pixels of the frame"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("density_blur", struct sf_larsson_settings, density_blur, 0, 0, 1, "",
               "0: exact optical depth; 1: the blurred one of the thesis; between: a mix")},
    {ROW_FLOAT("thin", struct sf_larsson_settings, thin, 1, 0, 100, "",
               "optical depth across a particle below which its surfaces recede from the depth views; 0: never")},
    {ROW_FLOAT("soft", struct sf_larsson_settings, soft, 0, 0, 100, "m",
               "extra fade of the smoke towards surfaces; 0: none, the smoke is cut there exactly"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("life_fade", struct sf_larsson_settings, life_fade, 0, 0, 16, "",
               "exponent of the thesis' fade with life; 0: none, emitters fade by themselves")},
};
static const struct sf_param_group larsson_group =
    GROUP("larsson", struct sf_larsson_settings, larsson_rows,
          "The method thick-larsson alone: the thesis's way, one interval a ray.");

static const struct sf_param reference_rows[] = {
    {ROW_INT("samples", struct sf_reference_settings, samples, 1024, 8, 65536, "",
             "along each ray through the smoke, in the finished picture: the error falls with their number")},
    {ROW_INT("batch", struct sf_reference_settings, batch, 16, 8, 256, "",
             "of them at once: between two pictures of the viewer")},
    {ROW_INT("shadow_size", struct sf_reference_settings, shadow_size, 512, 16, 4096, "px",
             "side of the map of the smoke's shadow on the scene, per light"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_BOOL("ground_shadow", struct sf_reference_settings, ground_shadow, 1, "the smoke casts shadows on objects"),
     .rebuild = SF_REBUILD_GRAPH},
};
static const struct sf_param_group reference_group =
    GROUP("reference", struct sf_reference_settings, reference_rows,
          "The method reference: the integral itself, to any exactness, slowly.");

static const char *const upsamples[] = {"depth", "plain", NULL};
static const struct sf_param billboard_rows[] = {
    {ROW_ENUM("upsample", struct sf_billboard_settings, upsample, upsamples, SF_UPSAMPLE_DEPTH,
              "how reduced smoke is taken up: with a look at the depth of edges, or without"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("density", struct sf_billboard_settings, density, 1, 0, 100, "",
               "multiplies the medium's extinction: 1 is the smoke that thick draws")},
    {ROW_FLOAT("near_fade", struct sf_billboard_settings, near_fade, 1, 0, 100, "radii",
               "before the near plane, in which a flat billboard fades; 0: it pops")},
    {ROW_BOOL("self_shadow", struct sf_billboard_settings, self_shadow, 1, "particles cast shadows on each other"),
     .rebuild = SF_REBUILD_GRAPH},
};
static const struct sf_param_group billboard_group =
    GROUP("billboard", struct sf_billboard_settings, billboard_rows,
          "What all methods of billboards share, beside resolution, octaves, detail, detail_scale, ambient, "
          "scene_shadow and ground_shadow of thick.");

static const struct sf_param soft_rows[] = {
    {ROW_FLOAT("distance", struct sf_soft_settings, distance, 0, 0, 1000, "m",
               "to the scene behind it, within which a particle fades; 0: its radius")},
    {ROW_FLOAT("power", struct sf_soft_settings, power, 2, 1, 16, "",
               "of the fade of soft-contrast: 1 is linear, more is steeper in the middle")},
};
static const struct sf_param_group soft_group =
    GROUP("soft", struct sf_soft_settings, soft_rows,
          "The methods soft and soft-contrast; of the distance also lit and lit-scattering.");

static const char *const lit_ramps[] = {"life", "intensity", NULL};
static const struct sf_param lit_rows[] = {
    {ROW_FLOAT("relief", struct sf_lit_settings, relief, 0.35, 0, 1, "",
               "how much of the atlas's normals there is in the light; 0: puffs are lit as balls")},
    {ROW_FLOAT("wrap", struct sf_lit_settings, wrap, 0.6, 0, 1, "",
               "how far light reaches round a puff: 0 to where it grazes, 1 to the far side")},
    {ROW_FLOAT("translucency", struct sf_lit_settings, translucency, 0.5, 0, 100, "",
               "strength of light that comes through from behind")},
    {ROW_FLOAT("halo", struct sf_lit_settings, halo, 1.5, 0, 32, "",
               "how much darker than its rim the middle of a puff is in light from behind (lit only)")},
    {ROW_FLOAT("blend", struct sf_lit_settings, blend, 0, 0, 1, "",
               "0: smoke covers what is behind it; 1: it adds its light; between: a mix")},
    {ROW_ENUM(
         "ramp", struct sf_lit_settings, ramp, lit_ramps, SF_LIT_RAMP_LIFE,
         "what the scene's ramp runs over: a particle's life, or how much of the lights' full strength a pixel gets"),
     .rebuild = SF_REBUILD_GRAPH},
};
static const struct sf_param_group lit_group =
    GROUP("lit", struct sf_lit_settings, lit_rows,
          "The methods lit and lit-scattering, billboards lit for each pixel by the normals of the scene's atlas.");

static const char *const mores[] = {"grazing", "facing", NULL};
static const struct sf_param scattering_rows[] = {
    {ROW_INT("steps", struct sf_scattering_settings, steps, 8, 1, 256, "",
             "samples along the ray to a light through a puff's heights, at most")},
    {ROW_INT("steps_min", struct sf_scattering_settings, steps_min, 4, 1, 256, "",
             "the same at least; steps where that is less")},
    {ROW_ENUM("more", struct sf_scattering_settings, more, mores, SF_SCATTERING_MORE_GRAZING,
              "which pixels have more of them: those whose normal turns away from the eye, or towards it"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("absorption", struct sf_scattering_settings, absorption, 1, 0, 100, "",
               "multiplies the extinction of what stands between a pixel and a light within its puff")},
    {ROW_FLOAT("dampening", struct sf_scattering_settings, dampening, 0, 0, 1, "1/particle",
               "dims all lights by 1 / (1 + dampening particles): a substitute for billboard.self_shadow")},
};
static const struct sf_param_group scattering_group =
    GROUP("scattering", struct sf_scattering_settings, scattering_rows,
          "The method lit-scattering alone: light through a puff's height field.");

static const char *const mega_noises[] = {"world", "screen", NULL};
static const struct sf_param mega_rows[] = {
    {ROW_FLOAT("blur", struct sf_mega_settings, blur, 0.016, 0, 0.2, "frame heights",
               "sigma of the blur of the balls; it reaches 24 pixels of the smoke's image at most"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_ENUM(
         "noise", struct sf_mega_settings, noise, mega_noises, SF_MEGA_WORLD,
         "where the noise is fixed: in the world, or on the screen as in the thesis, where smoke that moves slides "
         "under it"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("amplitude", struct sf_mega_settings, amplitude, 0.02, 0, 0.5, "frame heights",
               "root mean square of the displacement by the noise")},
    {ROW_FLOAT("scale", struct sf_mega_settings, scale, 0, 0, 1000, "m",
               "of the world's noise; 0: the largest diameter that particles are born with")},
    {ROW_FLOAT("screen_scale", struct sf_mega_settings, screen_scale, 0.1, 0.001, 10, "frame heights",
               "of the screen's noise")},
    {ROW_INT("octaves", struct sf_mega_settings, octaves, 3, 0, 6, "", "of the noise; 0: no displacement"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("speed", struct sf_mega_settings, speed, 0.5, 0, 100, "1/s", "of the noise's change")},
    {ROW_FLOAT("diffuse", struct sf_mega_settings, diffuse, 1, 0, 100, "",
               "multiplies the medium's albedo in the light that the balls reflect diffusely")},
    {ROW_FLOAT("specular", struct sf_mega_settings, specular, 0.05, 0, 1, "",
               "share of light that Phong's highlight reflects")},
    {ROW_FLOAT("shininess", struct sf_mega_settings, shininess, 4, 1, 1000, "",
               "exponent of the highlight: larger is smaller and brighter")},
    {ROW_FLOAT("soft", struct sf_mega_settings, soft, 0, 0, 1000, "m",
               "before the scene, in which the smoke fades; 0: the largest radius that particles are born with")},
};
static const struct sf_param_group mega_group =
    GROUP("mega", struct sf_mega_settings, mega_rows,
          "The method mega; it reads resolution, ambient, scene_shadow and ground_shadow of thick, too.");
static const struct sf_param average_rows[] = {
    {ROW_FLOAT("depth", struct sf_average_settings, depth, 2, 0.02, 2, "radii",
               "of the volume that a particle stands for: 2 is its sphere's")},
    {ROW_FLOAT("plane", struct sf_average_settings, plane, 0.5, 0, 1, "",
               "share of that depth before the particle's centre: 0: the centre is the front")},
    {ROW_FLOAT("opacity", struct sf_average_settings, opacity, 1, 0, 1, "",
               "multiplies what a particle covers when nothing cuts it")},
};
static const struct sf_param_group average_group =
    GROUP("average_density", struct sf_average_settings, average_rows, "The method average-density.");

static const struct sf_param extent_rows[] = {
    {ROW_FLOAT("depth", struct sf_extent_settings, depth, 1, 0.01, 1, "radii",
               "how far a particle extends to either side of its plane where the atlas is opaque")},
    {ROW_FLOAT("opacity", struct sf_extent_settings, opacity, 1, 0, 1, "",
               "multiplies what a particle covers when nothing cuts it")},
    {ROW_FLOAT("deviation", struct sf_extent_settings, deviation, 0.5, 0, 1, "",
               "of the atlas's heights, by which the plane is moved to the viewer pixel by pixel"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("lighting", struct sf_extent_settings, lighting, 0.6, 0, 1, "",
               "how much brighter the atlas's normals are towards the light than away from it"),
     .rebuild = SF_REBUILD_GRAPH},
};
static const struct sf_param_group extent_group =
    GROUP("density_extent", struct sf_extent_settings, extent_rows, "The method density-extent.");

static const struct sf_param volumetric_rows[] = {
    {ROW_INT("steps", struct sf_volumetric_settings, steps, 8, 1, 64, "", "along each ray through a particle"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("scale", struct sf_volumetric_settings, scale, 3, 0.25, 16, "",
               "features of the noise across a particle")},
    {ROW_FLOAT("strength", struct sf_volumetric_settings, strength, 0.8, 0, 1, "",
               "of the noise in the density; 0: even spheres, exactly"),
     .rebuild = SF_REBUILD_GRAPH},
    {ROW_FLOAT("evolution", struct sf_volumetric_settings, evolution, 0.5, 0, 16, "",
               "how often the noise becomes another one, and itself again, in a particle's life")},
    {ROW_FLOAT("lighting", struct sf_volumetric_settings, lighting, 0.7, 0, 1, "",
               "how much brighter a particle is where its light comes from"),
     .rebuild = SF_REBUILD_GRAPH},
};
static const struct sf_param_group volumetric_group =
    GROUP("volumetric", struct sf_volumetric_settings, volumetric_rows, "The method volumetric.");

#define ROW_OBJECT(k, f, of, text)                                                                                     \
    .key = k, .type = SF_PARAM_OBJECT, .offset = offsetof(struct sf_scene, f), .group = &of, .unit = "", .doc = text

static const char *const methods[] = {
    "none",           "thick",         "thick-larsson", "reference",      "hard",
    "soft",           "soft-contrast", "spherical",     "mega",           "average-density",
    "density-extent", "volumetric",    "lit",           "lit-scattering", NULL};
static const struct sf_param scene_rows[] = {
    {ROW_OBJECT("camera", camera, sf_scene_camera_group, "the eye")},
    {ROW_LIST("lights", struct sf_scene, lights, light_count, sf_scene_light_group, 0, SF_LIGHTS_MAX, "lamps")},
    {ROW_LIST("objects", struct sf_scene, objects, object_count, sf_scene_object_group, 0, SF_OBJECTS_MAX,
              "solid things")},
    {ROW_OBJECT("medium", medium, medium_group, "the smoke's matter")},
    {ROW_LIST("ramp", struct sf_scene, ramp, ramp_count, ramp_group, 0, SF_RAMP_MAX, "colour over a particle's life")},
    {ROW_OBJECT("atlas", atlas, atlas_group, "pictures of smoke")},
    {ROW_LIST("emitters", struct sf_scene, emitters, emitter_count, sf_scene_emitter_group, 0, SF_EMITTERS_MAX,
              "where smoke comes from"),
     .rebuild = SF_REBUILD_SIM},
    {ROW_LIST("forces", struct sf_scene, forces, force_count, sf_scene_force_group, 0, SF_FORCES_MAX,
              "what moves the smoke"),
     .rebuild = SF_REBUILD_SIM},
    {ROW_LIST("effects", struct sf_scene, effects, effect_count, sf_scene_effect_group, 0, SF_EFFECTS_MAX,
              "effects from files"),
     .rebuild = SF_REBUILD_SIM},
    {ROW_OBJECT("environment", environment, environment_group, "light from all around")},
    {ROW_ENUM("method", struct sf_scene, method, methods, SF_METHOD_THICK, "how the smoke is drawn"),
     .rebuild = SF_REBUILD_GRAPH | SF_REBUILD_ASSETS}, /* methods have textures of their own */
    {ROW_OBJECT("sim", sim, sim_group, "the simulation")},
    {ROW_OBJECT("output", output, output_group, "pictures for the eye")},
    {ROW_OBJECT("surfaces", surfaces, surface_group, "how objects are drawn")},
    {ROW_OBJECT("shadow", shadow, shadow_group, "shadows of objects")},
    {ROW_OBJECT("thick", thick, thick_group, "the methods thick and thick-larsson")},
    {ROW_OBJECT("larsson", larsson, larsson_group, "the method thick-larsson")},
    {ROW_OBJECT("reference", reference, reference_group, "the method reference")},
    {ROW_OBJECT("billboard", billboard, billboard_group, "the methods of billboards")},
    {ROW_OBJECT("soft", soft, soft_group, "the methods soft and soft-contrast")},
    {ROW_OBJECT("mega", mega, mega_group, "the method mega")},
    {ROW_OBJECT("average_density", average, average_group, "the method average-density")},
    {ROW_OBJECT("density_extent", extent, extent_group, "the method density-extent")},
    {ROW_OBJECT("volumetric", volumetric, volumetric_group, "the method volumetric")},
    {ROW_OBJECT("lit", lit, lit_group, "the methods lit and lit-scattering")},
    {ROW_OBJECT("scattering", scattering, scattering_group, "the method lit-scattering")},
};
const struct sf_param_group sf_scene_group =
    GROUP("scene", struct sf_scene, scene_rows, "The outermost object of a scene file.");
