/* What differs between two scenes, and what that makes anew. The second half holds the table to what the renderer does
 * with a value: without a device it declares the graphs of two scenes that differ in one value, feeds the simulation's
 * steps and lays out what goes to the device; whatever changes must have its bit, and every bit must be needed by some
 * change. */
#include "shipped_kit.h"

#include "base/array.h"
#include "base/hash.h"
#include "methods/thick.h"
#include "params/params.h"
#include "render/assemble.h"
#include "scene/table.h"
#include "sim/feed.h"
#include "sim/particles.h"

enum { READ = SF_REBUILD_READ, GRAPH = READ | SF_REBUILD_GRAPH, SIM = READ | SF_REBUILD_SIM };
enum { ASSETS = READ | SF_REBUILD_ASSETS };

static unsigned difference_with(const char *path, const char *set)
{
    struct sf_scene *before = load_with(path, NULL, 0), *after = load_with(path, &set, 1);
    unsigned found = sf_scene_difference(before, after);

    assert_int_equal(sf_scene_difference(after, before), found);
    assert_int_equal(sf_scene_difference(before, before), 0);
    sf_scene_destroy(&before);
    sf_scene_destroy(&after);
    return found;
}

/* ---- single values ---- */

static void test_single_values(void **state)
{
    static const struct {
        const char *scene, *set;
        unsigned bits;
    } cases[] = {
        {"all", "camera.near=0.03", READ},
        {"all", "camera.type=fixed", READ},
        {"all", "camera.keys.1.fov=41", READ},
        {"all", "lights.0.intensity=2.5", READ},
        {"all", "lights.0.direction=1,-1.5,-1.1", READ}, /* the shadow map is another matter */
        {"all", "lights.0.shadows=false", GRAPH},
        {"all", "lights.2.outer=25", READ},
        {"all", "objects.0.albedo=0.5,0.5,0.6", READ},
        {"all", "objects.0.checker=0", GRAPH},
        {"all", "objects.0.collide=false", SIM},
        {"all", "objects.2.position=-1,0.3,0.1", SIM},
        {"all", "objects.5.scale=0.5", READ},
        {"all", "objects.5.file=../assets/house.obj", ASSETS | GRAPH},
        {"all", "medium.extinction=6", SIM},
        {"all", "medium.albedo=0.9,0.88,0.86", READ},
        {"all", "ramp.1.at=0.5", READ},
        {"all", "emitters.0.rate=41", SIM}, /* by its list */
        {"all", "emitters.0.path.1.time=0.3", SIM},
        {"all", "emitters.3.file=../assets/house.obj", SIM | ASSETS | GRAPH},
        {"all", "emitters.4.particles.1.age=0.2", SIM},
        {"all", "emitters.4.particles.1.extinction=5", 0}, /* what the medium gave it */
        {"all", "forces.5.pull=0.1", SIM},
        {"all", "environment.zenith=0.2,0.3,0.7", READ},
        {"all", "environment.intensity=0.5", READ},
        {"all", "environment.visible=false", GRAPH | ASSETS},
        {"all", "environment.type=sky", 0},
        {"all", "method=none", GRAPH | ASSETS},
        {"all", "sim.seed=8", SIM | ASSETS},
        {"all", "sim.capacity=513", SIM | GRAPH},
        {"all", "sim.fps=25", SIM},
        {"all", "sim.substeps=3", SIM},
        {"all", "sim.preroll=1", READ},
        {"all", "output.exposure=1", READ},
        {"all", "output.tone=neutral", READ},
        {"all", "shadow.map_size=64", GRAPH},
        {"all", "shadow.softness=2", READ},
        {"all", "shadow.exponent=30", READ},
        {"all", "thick.steps=9", GRAPH},
        {"all", "larsson.blur=3", GRAPH},
        {"all", "thick.detail_scale=1.3", READ},
        {"all", "larsson.soft=0", GRAPH},
        {"all", "thick.ambient=1", READ},
        {"all", "thick.resolution=full", GRAPH},
        {"effects", "effects.1.start=0.6", SIM}, /* by its list */
        {"effects", "effects.0.position=0,0.3,0.1", SIM},
        {"effects", "effects.0.file=../assets/effect-inner.json", SIM | ASSETS | GRAPH},
        {"latlong", "environment.rotation=91", READ},
        {"latlong", "environment.type=latlong", 0},
        {"mesh", "objects.1.rotation=0,26,0", SIM},
        {"atlas", "atlas.seed=8", ASSETS},
        {"atlas", "atlas.kind=cellular", ASSETS},
        {"atlas", "atlas.type=plain", ASSETS},
        {"atlas-file", "atlas.down=1", ASSETS},
        {"atlas-file", "atlas.file=../assets/cube-nx.png", ASSETS},
    };

    (void)state;
    for (size_t i = 0; i < SF_COUNT(cases); i++) {
        char relative[64];
        unsigned found;

        snprintf(relative, sizeof relative, "scenes/tiny/%s.json", cases[i].scene);
        found = difference_with(source_path(relative), cases[i].set);
        if (found != cases[i].bits)
            fail_msg("%s: %s: bits %u, not %u", relative, cases[i].set, found, cases[i].bits);
    }
}

static void differ(const char *before, const char *after, unsigned bits)
{
    struct sf_scene *a = parse(before), *b = parse(after);

    if (sf_scene_difference(a, b) != bits || sf_scene_difference(b, a) != bits)
        fail_msg("%s and %s: bits %u and %u, not %u", before, after, sf_scene_difference(a, b),
                 sf_scene_difference(b, a), bits);
    sf_scene_destroy(&a);
    sf_scene_destroy(&b);
}

#define LIGHT        "{\"type\":\"point\",\"position\":[0,1,0]}"
#define SPHERE       "{\"type\":\"sphere\"}"
#define FORCES(list) "{\"forces\":[" list "]}"
#define KEY(time)    "{\"time\":" time ",\"eye\":[0,1,5],\"target\":[0,0,0]}"
#define KEYS(list)   "{\"camera\":{\"type\":\"keyframes\",\"keys\":[" list "]}}"
#define PATH(list)   "{\"emitters\":[{\"type\":\"cone\",\"path\":[" list "]}]}"
#define AT(time)     "{\"time\":" time ",\"position\":[0,0,0]}"

static void test_lists(void **state)
{
    unsigned objects = SIM | GRAPH | ASSETS;

    (void)state;
    differ("{}", "{\"lights\":[" LIGHT "]}", GRAPH);
    differ("{\"lights\":[" LIGHT "]}", "{\"lights\":[" LIGHT "," LIGHT "]}", GRAPH);
    differ("{}", "{\"objects\":[" SPHERE "]}", objects);
    differ("{\"objects\":[" SPHERE "]}", "{\"objects\":[{\"type\":\"box\"}]}", SIM | GRAPH);
    differ("{}", "{\"ramp\":[{\"at\":0,\"color\":[1,1,1]}]}", READ);
    differ("{}", "{\"emitters\":[{\"type\":\"cone\"}]}", SIM | ASSETS);
    differ("{}", FORCES("{\"type\":\"gravity\"}"), SIM);
    differ(FORCES("{\"type\":\"gravity\"},{\"type\":\"drag\",\"strength\":1}"),
           FORCES("{\"type\":\"drag\",\"strength\":1},{\"type\":\"gravity\"}"), SIM);
    differ(KEYS(KEY("0")), KEYS(KEY("0") "," KEY("1")), READ);
    differ(PATH(AT("0")), PATH(AT("0") "," AT("1")), SIM);
    differ("{\"emitters\":[{\"type\":\"list\",\"particles\":[]}]}",
           "{\"emitters\":[{\"type\":\"list\",\"particles\":[{\"centre\":[0,0,0],\"radius\":1}]}]}", SIM);
    /* What comes to the same is the same. */
    differ("{\"lights\":[{\"type\":\"directional\",\"direction\":[0,-1,0]}]}",
           "{\"lights\":[{\"type\":\"directional\",\"direction\":[0,-3,0]}],\"//\":1}", 0);
    differ("{\"objects\":[{\"type\":\"plane\"}]}", "{\"objects\":[{\"type\":\"plane\",\"albedo2\":[1,1,1]}]}", 0);
}

/* ---- files ---- */

static void write_mesh(const char *path, double height, bool twice)
{
    FILE *file = fopen(path, "w");

    assert_non_null(file);
    fprintf(file, "v 0 0 0\nv 1 0 0\nv 0 %g 1\nv 1 1 1\nf 1 2 3\n%s", height, twice ? "f 2 3 4\n" : "");
    fclose(file);
}

static void write_list(const char *path, int z)
{
    FILE *file = fopen(path, "w");

    assert_non_null(file);
    fprintf(file, "x,y,z,radius,extinction\n0,0,%d,1,1\n", z);
    fclose(file);
}

static unsigned renewed(const char *text, const char *path, const char *kind, int change)
{
    struct sf_scene *before, *after;
    unsigned found;

    for (int i = 0; i < 2; i++) {
        if (strcmp(kind, "mesh") == 0)
            write_mesh(path, i && change == 1 ? 2 : 1, i && change == 2);
        else
            write_list(path, i && change == 1 ? 1 : 0);
        if (i == 0)
            before = parse(text);
        else
            after = parse(text);
    }
    found = sf_scene_difference(before, after);
    assert_int_equal(sf_scene_difference(after, before), found);
    sf_scene_destroy(&before);
    sf_scene_destroy(&after);
    return found;
}

static void test_files_count_by_their_contents(void **state)
{
    static const char *const object = "{\"objects\":[{\"type\":\"mesh\",\"file\":\"a.obj\"}]}";
    static const char *const emitter = "{\"emitters\":[{\"type\":\"mesh\",\"file\":\"a.obj\"}]}";
    static const char *const list = "{\"emitters\":[{\"type\":\"list\",\"file\":\"a.csv\"}]}";

    (void)state;
    assert_int_equal(renewed(object, "a.obj", "mesh", 0), 0);
    assert_int_equal(renewed(object, "a.obj", "mesh", 1), ASSETS);
    assert_int_equal(renewed(object, "a.obj", "mesh", 2), ASSETS | GRAPH);
    assert_int_equal(renewed(emitter, "a.obj", "mesh", 0), 0);
    assert_int_equal(renewed(emitter, "a.obj", "mesh", 1), ASSETS | SIM);
    assert_int_equal(renewed(list, "a.csv", "list", 0), 0);
    assert_int_equal(renewed(list, "a.csv", "list", 1), SIM);
    /* Two names of one and the same: loaded again, nothing more. Two meshes that change places: the graph. */
    write_mesh("a.obj", 1, false);
    write_mesh("b.obj", 1, false);
    differ(object, "{\"objects\":[{\"type\":\"mesh\",\"file\":\"b.obj\"}]}", ASSETS);
    write_mesh("b.obj", 1, true);
    differ("{\"objects\":[{\"type\":\"mesh\",\"file\":\"a.obj\"},{\"type\":\"mesh\",\"file\":\"b.obj\"},"
           "{\"type\":\"mesh\",\"file\":\"a.obj\"}]}",
           "{\"objects\":[{\"type\":\"mesh\",\"file\":\"a.obj\"},{\"type\":\"mesh\",\"file\":\"b.obj\"},"
           "{\"type\":\"mesh\",\"file\":\"b.obj\"}]}",
           ASSETS | GRAPH);
}

static void test_pictures(void **state)
{
    struct sf_scene *before = load_with(source_path("scenes/tiny/latlong.json"), NULL, 0);
    struct sf_scene *after = load_with(source_path("scenes/tiny/latlong.json"), NULL, 0);

    (void)state;
    assert_int_equal(sf_scene_difference(before, after), 0);
    after->environment.pixels[5] += 1;
    assert_int_equal(sf_scene_difference(before, after), ASSETS);
    after->environment.pixels[5] -= 1;
    after->environment.height /= 2;
    assert_int_equal(sf_scene_difference(before, after), ASSETS | GRAPH);
    sf_scene_destroy(&before);
    sf_scene_destroy(&after);
}

/* Of the same name and size, but another picture. */
static void test_atlas_file(void **state)
{
    static const char *const text = "{\"atlas\":{\"type\":\"file\",\"file\":\"a.exr\"}}";
    struct sf_texture_options options;
    struct sf_scene *scenes[3];

    (void)state;
    sf_texture_options_init(&options);
    options.width = options.height = 8;
    for (uint32_t i = 0; i < 3; i++) {
        const struct sf_exr_options exr = {.compression = "zip", .half = true};
        struct sf_texture *texture = NULL;

        options.density = i < 2 ? 3 : 4;
        assert_int_equal(sf_texture_create(&options, NULL, NULL, NULL, &texture), SF_OK);
        assert_int_equal(sf_texture_write_exr(texture, "a.exr", SF_TEXTURE_ALL, &exr, NULL), SF_OK);
        sf_texture_destroy(&texture);
        scenes[i] = parse(text);
    }
    assert_int_equal(sf_scene_difference(scenes[0], scenes[1]), 0);
    assert_true(scenes[0]->hash == scenes[1]->hash && scenes[1]->hash != scenes[2]->hash);
    assert_int_equal(sf_scene_difference(scenes[1], scenes[2]), ASSETS);
    for (int i = 0; i < 3; i++)
        sf_scene_destroy(&scenes[i]);
}

/* ---- the table against the renderer ---- */

/* All that a change could make anew, as hashes. */
struct trace {
    uint64_t graph, sim, assets;
};

static void stir(uint64_t *hash, const void *data, size_t bytes)
{
    *hash = sf_hash_bytes(data, bytes, *hash);
}

static void stir_text(uint64_t *hash, const char *text)
{
    stir(hash, text ? text : "", strlen(text ? text : "") + 1);
}

#define STIR(hash, value) stir(hash, &(value), sizeof(value))

static void stir_resources(uint64_t *hash, const struct sf_graph *graph)
{
    for (sf_resource i = 1; i <= sf_graph_resource_count(graph); i++) {
        const struct sf_image_desc *image = sf_graph_image_at(graph, i);
        const struct sf_buffer_desc *buffer = sf_graph_buffer_at(graph, i);

        stir_text(hash, image ? image->name : buffer->name);
        if (image) {
            STIR(hash, image->format);
            STIR(hash, image->size.width);
            STIR(hash, image->size.height);
            STIR(hash, image->layers);
        } else {
            STIR(hash, buffer->bytes);
        }
    }
}

/* `pushes`: those of the pass are filled when it is declared, and never again. */
static void stir_pass(uint64_t *hash, const struct sf_pass_desc *pass, bool pushes)
{
    stir_text(hash, pass->name);
    stir_text(hash, pass->shader);
    stir_text(hash, pass->fragment);
    for (uint32_t i = 0; i < pass->use_count; i++) {
        STIR(hash, pass->uses[i].resource);
        STIR(hash, pass->uses[i].access);
        STIR(hash, pass->uses[i].binding);
        STIR(hash, pass->uses[i].load);
        STIR(hash, pass->uses[i].clear);
        STIR(hash, pass->uses[i].sampler);
    }
    stir(hash, pass->constants, pass->constant_count * sizeof pass->constants[0]);
    STIR(hash, pass->push_bytes);
    if (pushes)
        stir(hash, pass->push, pass->push_bytes);
    STIR(hash, pass->groups);
    STIR(hash, pass->domain);
    STIR(hash, pass->indirect);
    STIR(hash, pass->indirect_offset);
    STIR(hash, pass->vertices);
    STIR(hash, pass->instances);
    STIR(hash, pass->raster.blend);
    STIR(hash, pass->raster.cull);
    STIR(hash, pass->raster.depth);
}

static const struct sf_gpu_tuning tuning = {
    .software = true, .subgroup_size = 8, .workers = 2, .max_group_invocations = 1024, .shared_bytes = 32768};

static void trace_graph(const struct sf_scene *scene, uint64_t *hash)
{
    const struct sf_assembly_options options = {
        .width = 64, .height = 48, .aovs = SF_AOV_SMOKE, .capacity = (uint32_t)scene->sim.capacity};
    struct sf_assembly *assembly = NULL;

    assert_int_equal(sf_assembly_create(scene, &options, &tuning, NULL, NULL, &assembly), SF_OK);
    stir_resources(hash, assembly->graph);
    for (uint32_t i = 0; i < sf_graph_pass_count(assembly->graph); i++) {
        const struct sf_pass_desc *pass = sf_graph_pass_at(assembly->graph, i);

        /* The method's are renewed before each play. */
        stir_pass(hash, pass, strncmp(pass->name, "scene.", 6) == 0);
    }
    sf_assembly_destroy(&assembly);
}

static void trace_sim(const struct sf_scene *scene, uint64_t *hash)
{
    static struct sf_sim_now now;
    static struct sf_sim_births births;
    struct sf_sim_layout layout;
    struct sf_particle_counts counts;
    struct sf_graph *graph = NULL;

    assert_int_equal(sf_particles_declare(scene, &tuning, NULL, &graph), SF_OK);
    stir_resources(hash, graph);
    for (uint32_t i = 0; i < sf_graph_pass_count(graph); i++)
        stir_pass(hash, sf_graph_pass_at(graph, i), false);
    sf_graph_destroy(&graph);
    sf_sim_layout_fill(scene, &layout);
    STIR(hash, layout);
    for (uint64_t step = 0; step < 100; step += 1 + step / 8) {
        size_t bytes = sf_sim_feed(scene, &layout, step, &now, &births);

        stir(hash, &now, bytes);
        stir(hash, births.emitters, scene->emitter_count * sizeof births.emitters[0]);
        stir(hash, births.records, now.record_count * sizeof births.records[0]);
    }
    struct sf_particle *particles = calloc(layout.first_total + layout.listed_total + 1, sizeof *particles);
    struct sf_sim_triangle *triangles = calloc(layout.triangle_total + 1, sizeof *triangles);
    assert_non_null(particles);
    assert_non_null(triangles);
    sf_sim_first_particles(scene, particles, &counts);
    sf_sim_listed_particles(scene, particles + layout.first_total);
    assert_int_equal(sf_sim_triangles(scene, NULL, triangles), SF_OK);
    stir(hash, particles, (layout.first_total + layout.listed_total) * sizeof *particles);
    stir(hash, triangles, layout.triangle_total * sizeof *triangles);
    free(particles);
    free(triangles);
    /* Every particle draws lots with it. */
    STIR(hash, scene->sim.seed);
}

/* As src/render/assets.c puts them on the device. */
static void trace_assets(const struct sf_scene *scene, uint64_t *hash)
{
    const struct sf_environment *environment = &scene->environment;

    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const struct sf_mesh *mesh = &scene->meshes[i];

        stir(hash, mesh->positions, 3 * sizeof(float) * mesh->vertex_count);
        stir(hash, mesh->normals, 3 * sizeof(float) * mesh->vertex_count);
        stir(hash, mesh->indices, sizeof(uint32_t) * mesh->index_count);
    }
    if (sf_scene_shows_picture(scene))
        stir(hash, environment->pixels, (size_t)environment->width * environment->height * 3 * sizeof(float));
    STIR(hash, scene->method);
    if (scene->method == SF_METHOD_THICK && scene->atlas.kind == SF_ATLAS_PLAIN) {
        STIR(hash, scene->sim.seed);
    } else if (scene->method == SF_METHOD_THICK) {
        unsigned char texels[32 * 32];

        assert_int_equal(sf_thick_scene_atlas(scene, 32, NULL, texels), SF_OK);
        STIR(hash, texels);
    }
}

static struct trace trace_of(const struct sf_scene *scene)
{
    struct trace trace = {0};

    trace_graph(scene, &trace.graph);
    trace_sim(scene, &trace.sim);
    trace_assets(scene, &trace.assets);
    return trace;
}

/* Which bits each row was found to need, in some change: "emitters.rate" without numbers. */
static struct {
    char path[96];
    unsigned bits, needed;
} rows[400];
static size_t row_count;

static void note(const char *path, unsigned bits, unsigned needed)
{
    char plain[96];
    size_t n = 0, i;

    for (const char *at = path; *at && n + 1 < sizeof plain; at++) {
        if (*at == '.' && at[1] >= '0' && at[1] <= '9')
            at += strspn(at + 1, "0123456789");
        else
            plain[n++] = *at;
    }
    plain[n] = '\0';
    for (i = 0; i < row_count && strcmp(rows[i].path, plain) != 0; i++)
        continue;
    assert_true(i < sizeof rows / sizeof rows[0]);
    if (i == row_count) {
        memcpy(rows[i].path, plain, n + 1);
        row_count++;
    }
    rows[i].bits |= bits;
    rows[i].needed |= needed;
}

/* The bits of the row at a control's path, those of what it stands in among them. */
static unsigned row_bits(const char *path)
{
    const struct sf_param_group *group = &sf_scene_group;
    unsigned bits = 0;

    for (;;) {
        char key[64];
        size_t length = strcspn(path, ".");
        const struct sf_param *row;

        snprintf(key, sizeof key, "%.*s", (int)length, path);
        path += length + (path[length] == '.');
        if (key[0] >= '0' && key[0] <= '9')
            continue;
        assert_non_null(row = sf_param_find(group, key));
        bits |= row->rebuild;
        if (!row->group)
            return bits;
        group = row->group;
    }
}

static const char *drawn_by = "method=thick"; /* the set that all scenes have */

static void try_value(const char *path, const struct sf_scene *before, const struct trace *trace,
                      const struct sf_control *control)
{
    char *set = sf_control_print(control);
    const char *const sets[] = {drawn_by, set};
    struct sf_scene *after = NULL;

    assert_non_null(set);
    if (sf_scene_load(path, sets, 2, NULL, &after) == SF_OK) {
        struct trace now = trace_of(after);
        unsigned found = sf_scene_difference(before, after), needed = 0, row = row_bits(control->path);
        bool kind = strcmp(control->key, "type") == 0;

        needed |= now.graph != trace->graph ? SF_REBUILD_GRAPH : 0;
        needed |= now.sim != trace->sim ? SF_REBUILD_SIM : 0;
        needed |= now.assets != trace->assets ? SF_REBUILD_ASSETS : 0;
        if (needed & ~found)
            fail_msg("%s: %s has bits %u and needs %u", path, set, found, needed);
        /* One row has changed, and has the bits of that row (a type brings other rows with it, a file its contents). */
        if (found && !kind && control->kind != SF_CONTROL_TEXT && found != (row | SF_REBUILD_READ))
            fail_msg("%s: %s has bits %u, and its row %u", path, set, found, row);
        note(control->path, row, needed);
    }
    sf_scene_destroy(&after);
    free(set);
}

static char panorama[4096]; /* where one of 4 x 2 px is */

static void write_panorama(void)
{
    static const unsigned char pixels[4 * 2 * 4] = {90, 80, 70, 129};
    FILE *file = fopen("small.hdr", "wb");

    assert_non_null(file);
    fputs("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n", file);
    fwrite(pixels, 1, sizeof pixels, file);
    fclose(file);
    assert_non_null(getcwd(panorama, sizeof panorama - 16));
    strcat(panorama, "/small.hdr");
}

static void try_control(const char *path, const struct sf_scene *scene, const struct trace *trace,
                        const struct sf_control *from)
{
    const char *const files[] = {"../assets/pyramid.gltf", "../assets/house.obj",        "../assets/tiny.csv", panorama,
                                 "../assets/cube-nx.png",  "../assets/effect-inner.json"};
    struct sf_control control = *from;

    if (control.kind == SF_CONTROL_TEXT) {
        for (size_t i = 0; i < SF_COUNT(files); i++) {
            control.text = files[i];
            try_value(path, scene, trace, &control);
        }
    } else if (control.kind == SF_CONTROL_CHOICE || control.kind == SF_CONTROL_BOOL) {
        for (control.value[0] = control.min; control.value[0] <= control.max; control.value[0]++)
            try_value(path, scene, trace, &control);
    } else {
        for (int way = 0; way < 4; way++) {
            for (uint32_t k = 0; k < control.numbers; k++) {
                double value = from->value[k], step = control.kind == SF_CONTROL_INT ? 1 : 0.0625 * (k + 1);

                value = way == 0 ? 0 : way == 1 ? value + step : way == 2 ? value - step : 2 * value;
                control.value[k] = value < control.min ? control.min : value > control.max ? control.max : value;
            }
            try_value(path, scene, trace, &control);
        }
    }
}

/* Has every row been tried? */
static void seek_rows(const char *path, const struct sf_param_group *group)
{
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        char deeper[96];
        size_t k = 0;

        snprintf(deeper, sizeof deeper, "%.60s%s%.30s", path, *path ? "." : "", row->key);
        if (row->group)
            seek_rows(deeper, row->group);
        while (k < row_count && strcmp(rows[k].path, deeper) != 0)
            k++;
        if (k == row_count && !row->group && row->type != SF_PARAM_FILES)
            fail_msg("%s: no scene of the test has it", deeper);
    }
}

static void test_every_row_has_the_bits_that_it_needs(void **state)
{
    /* Scenes with pictures or larger meshes take long to load: only what they alone have is tried. */
    static const struct {
        const char *name, *part, *set;
    } scenes[] = {{"all", "", "method=thick"},
                  {"all", "", "method=reference"},
                  {"all", "larsson", "method=thick-larsson"},
                  {"mesh", "objects", "method=thick"},
                  {"latlong", "environment", "method=thick"},
                  {"cube", "camera", "method=thick"},
                  {"sphere", "", "method=thick"},
                  {"effects", "effects", "method=thick"},
                  {"list-csv", "", "method=thick"},
                  {"list-ply", "", "method=thick"},
                  {"atlas", "atlas", "method=thick"},
                  {"atlas-file", "atlas", "method=thick"},
                  {"all", "billboard", "method=hard"},
                  {"all", "soft", "method=soft-contrast"},
                  {"all", "mega", "method=mega"},
                  {"all", "average_density", "method=average-density"},
                  {"all", "density_extent", "method=density-extent"},
                  {"all", "volumetric", "method=volumetric"},
                  {"all", "lit", "method=lit"},
                  {"all", "scattering", "method=lit-scattering"}};

    (void)state;
    write_panorama();
    for (size_t i = 0; i < SF_COUNT(scenes); i++) {
        char path[1024], relative[64];
        struct sf_scene *scene;
        struct controls controls;
        struct trace trace;

        snprintf(relative, sizeof relative, "scenes/tiny/%s.json", scenes[i].name);
        snprintf(path, sizeof path, "%s", source_path(relative));
        drawn_by = scenes[i].set;
        scene = load_with(path, &drawn_by, 1);
        trace = trace_of(scene);
        controls = controls_of(scene);
        for (uint32_t k = 0; k < controls.count; k++)
            if (strncmp(controls.list[k].path, scenes[i].part, strlen(scenes[i].part)) == 0)
                try_control(path, scene, &trace, &controls.list[k]);
        free(controls.list);
        sf_scene_destroy(&scene);
    }
    seek_rows("", &sf_scene_group);
    for (size_t i = 0; i < row_count; i++)
        if (rows[i].bits & ~rows[i].needed)
            fail_msg("%s has bits %u, and no change needed more than %u", rows[i].path, rows[i].bits, rows[i].needed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_single_values),
        cmocka_unit_test(test_lists),
        cmocka_unit_test(test_files_count_by_their_contents),
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_atlas_file),
        cmocka_unit_test(test_every_row_has_the_bits_that_it_needs),
    };
    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
