/* The parameter table and what is read off it: parsing, printing, JSON reading, documents. */
#include "scratch.h"

#include <locale.h>
#include <math.h>
#include "base/file.h"
#include "base/hash.h"
#include "params/document.h"
#include "params/json.h"
#include "params/number.h"
#include "scene/scene.h"
#include "scene/effect.h"
#include "scene/table.h"

typedef void (*visit_fn)(const struct sf_param_group *group, const struct sf_param *row);

static void visit(const struct sf_param_group *group, visit_fn fn)
{
    for (size_t i = 0; i < group->count; i++) {
        fn(group, &group->rows[i]);
        if (group->rows[i].group)
            visit(group->rows[i].group, fn);
    }
}

static size_t field_bytes(const struct sf_param *row)
{
    switch (row->type) {
    case SF_PARAM_BOOL:
        return sizeof(bool);
    case SF_PARAM_STRING:
        return sizeof(const char *);
    case SF_PARAM_FILES:
        return sizeof(sf_param_files);
    case SF_PARAM_OBJECT:
        return row->group->size;
    case SF_PARAM_LIST:
        return row->list_pointer ? sizeof(void *) : row->list_max * row->group->size;
    default:
        return sf_param_components(row) * 4;
    }
}

static void check_row(const struct sf_param_group *group, const struct sf_param *row)
{
    const struct sf_param *types = sf_param_kind(group);
    unsigned taken = 0;

    if (!row->doc || strlen(row->doc) < 4 || strlen(row->doc) > 160 || strpbrk(row->doc, "\n|"))
        fail_msg("%s.%s: doc must be one line", group->name, row->key);
    assert_non_null(row->unit);
    assert_true(row->key[strspn(row->key, "abcdefghijklmnopqrstuvwxyz0123456789_")] == '\0');
    for (unsigned i = 0; i < sf_param_components(row); i++) {
        bool numeric = row->type != SF_PARAM_ENUM && row->type != SF_PARAM_BOOL;

        if (numeric && (!(row->min < row->max) || !sf_param_in_range(row, row->value[i])))
            fail_msg("%s.%s: default or range is not sane", group->name, row->key);
    }
    if (row->type == SF_PARAM_ENUM) {
        size_t n = 0;

        while (row->names[n])
            n++;
        assert_true(n >= 2 && row->value[0] >= 0 && row->value[0] < (double)n);
    }
    if (row->type == SF_PARAM_RANGE)
        assert_true(row->value[0] <= row->value[1]);
    assert_true(row->type == SF_PARAM_OBJECT || row->type == SF_PARAM_LIST ? row->group != NULL : row->group == NULL);
    assert_true(row->offset + field_bytes(row) <= group->size);
    if (row->only_for) {
        unsigned words = 1;

        assert_non_null(types);
        for (const char *c = row->only_for; *c; c++)
            words += *c == ' ';
        for (int32_t kind = 0; types->names[kind]; kind++)
            taken += sf_param_applies(group, row, kind);
        if (taken != words)
            fail_msg("%s.%s: only_for names a type that is none", group->name, row->key);
    }
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *other = &group->rows[i];

        if (other == row)
            continue;
        assert_string_not_equal(other->key, row->key);
        if (other->offset < row->offset + field_bytes(row) && row->offset < other->offset + field_bytes(other))
            fail_msg("%s: %s and %s share memory", group->name, row->key, other->key);
    }
}

static void test_rows_are_sane(void **state)
{
    (void)state;
    visit(&sf_scene_group, check_row);
    visit(&sf_effect_group, check_row);
}

/* Prints from one object, parses into another, and compares the field's bits. */
static void round_trip(const struct sf_param_group *group, const struct sf_param *row, const double *values)
{
    char *from = calloc(1, group->size), *to = calloc(1, group->size);
    struct sf_text text = {0};
    enum sf_status status;

    assert_non_null(from);
    assert_non_null(to);
    memset(to, 0x5a, group->size);
    sf_param_store(row, values, from);
    sf_param_print(row, from, &text);
    assert_false(text.failed);
    status = sf_param_parse(row, row->key, text.data, to, NULL);
    if (status != SF_OK || memcmp(from + row->offset, to + row->offset, field_bytes(row)) != 0)
        fail_msg("%s.%s: '%s' does not come back", group->name, row->key, text.data);
    sf_text_finish(&text);
    free(from);
    free(to);
}

static double random_in_range(const struct sf_param *row, uint32_t number)
{
    double share = sf_random_float(7, number, 3), value;

    if (row->type == SF_PARAM_BOOL)
        return number % 2;
    if (row->type == SF_PARAM_ENUM) {
        uint32_t n = 0;

        while (row->names[n])
            n++;
        return number % n;
    }
    /* Small numbers as well as large ones: a random exponent. */
    value = row->min + share * (row->max - row->min);
    value *= number % 2 ? 1 : pow(10, -6 * (double)sf_random_float(8, number, 3));
    value = row->type == SF_PARAM_INT ? floor(value) : (double)(float)value;
    return fmin(fmax(value, row->min), row->max);
}

static void round_trip_row(const struct sf_param_group *group, const struct sf_param *row)
{
    unsigned n = sf_param_components(row);
    double low[3], high[3], values[3];

    if (n == 0)
        return;
    round_trip(group, row, row->value);
    for (unsigned i = 0; i < n; i++) {
        low[i] = row->type == SF_PARAM_ENUM ? 0 : row->min;
        high[i] = row->type == SF_PARAM_ENUM ? 0 : row->max;
    }
    round_trip(group, row, low);
    round_trip(group, row, high);
    for (uint32_t i = 0; i < 200; i++) {
        for (unsigned k = 0; k < n; k++)
            values[k] = random_in_range(row, 3 * i + k);
        if (row->type == SF_PARAM_RANGE && values[0] > values[1])
            values[1] = values[0];
        round_trip(group, row, values);
    }
}

/* What is fetched from a field and stored again is the field. */
static void fetch_row(const struct sf_param_group *group, const struct sf_param *row)
{
    char *from = calloc(1, group->size), *to = calloc(1, group->size);
    double values[3];

    assert_non_null(from);
    assert_non_null(to);
    if (sf_param_components(row)) {
        sf_param_store(row, row->value, from);
        assert_int_equal(sf_param_fetch(row, from, values), sf_param_components(row));
        sf_param_store(row, values, to);
        assert_memory_equal(from, to, group->size);
    }
    free(from);
    free(to);
}

static void test_fetch(void **state)
{
    (void)state;
    visit(&sf_scene_group, fetch_row);
}

static void test_renews(void **state)
{
    (void)state;
    assert_string_equal(sf_param_renews(SF_REBUILD_READ), "");
    assert_string_equal(sf_param_renews(SF_REBUILD_ASSETS), "files");
    assert_string_equal(sf_param_renews(SF_REBUILD_ASSETS | SF_REBUILD_GRAPH), "graph");
    assert_string_equal(sf_param_renews(SF_REBUILD_GRAPH | SF_REBUILD_SIM), "simulation");
}

static void test_print_and_parse_give_the_same_bits(void **state)
{
    (void)state;
    visit(&sf_scene_group, round_trip_row);
    visit(&sf_effect_group, round_trip_row);
}

static void refuse(const struct sf_param_group *group, const struct sf_param *row, const char *text, const char *part)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    char *object = calloc(1, group->size), *copy = calloc(1, group->size);

    assert_non_null(object);
    assert_non_null(copy);
    if (sf_param_parse(row, "name", text, object, &log) != SF_ERROR_USAGE)
        fail_msg("%s.%s takes '%s'", group->name, row->key, text);
    assert_caught(&caught, part);
    assert_memory_equal(object, copy, group->size); /* a refused value changes nothing */
    free(object);
    free(copy);
}

static void refuse_row(const struct sf_param_group *group, const struct sf_param *row)
{
    static const char *const junk[] = {"",     " 1",    "1 ",  "nan",     "inf",  "-inf",
                                       "0x10", "1e999", "abc", "1,2,3,4", "1,,2", ","};
    unsigned n = sf_param_components(row);
    char text[128], low[64], high[64];

    if (row->type == SF_PARAM_OBJECT || row->type == SF_PARAM_LIST || row->type == SF_PARAM_FILES) {
        refuse(group, row, "1", "scene file");
        return;
    }
    if (n == 0)
        return;
    for (size_t i = 0; i < SF_COUNT(junk); i++)
        refuse(group, row, junk[i], junk[i]);
    if (row->type == SF_PARAM_BOOL || row->type == SF_PARAM_ENUM)
        return;
    snprintf(low, sizeof low, "%.17g", row->min - fmax(fabs(row->min) * 0.01, 1));
    snprintf(high, sizeof high, "%.17g", row->max + fmax(fabs(row->max) * 0.01, 1));
    if (row->type == SF_PARAM_INT) {
        snprintf(low, sizeof low, "%.0f", row->min - 1);
        snprintf(high, sizeof high, "%.0f", row->max + 1);
        refuse(group, row, "1.5", "whole number");
    }
    for (int k = 0; k < 2; k++) {
        const char *bad = k ? high : low;
        /* In the last component, the others being right. */
        snprintf(text, sizeof text, n == 3 ? "0,0,%s" : n == 2 ? "1,%s" : "%s", bad);
        refuse(group, row, text, n == 1 ? "out of range" : "o"); /* 0 or 1 may be out of range itself */
    }
}

static void test_bad_values_are_refused(void **state)
{
    (void)state;
    visit(&sf_scene_group, refuse_row);
    visit(&sf_effect_group, refuse_row);
}

static void test_messages_help(void **state)
{
    const struct sf_param_group *camera = sf_param_find(&sf_scene_group, "camera")->group, *emitters;

    (void)state;
    refuse(camera, sf_param_find(camera, "type"), "orbti",
           "name: 'orbti' is not one of fixed, orbit, keyframes, did you mean orbit?");
    refuse(camera, sf_param_find(camera, "fov"), "171", "name: 171 is out of range: 1 to 170 deg");
    refuse(camera, sf_param_find(camera, "eye"), "1,2", "three numbers with commas");
    assert_null(sf_param_find(camera, "fovy"));
    refuse(&sf_scene_particle_group, sf_param_find(&sf_scene_particle_group, "tile"), "4",
           "name: 4 is out of range: 0 to 3");
    emitters = sf_param_find(&sf_scene_group, "emitters")->group;
    refuse(emitters, sf_param_find(emitters, "lifetime"), "2,1",
           "name: '2,1' is not a range: the lower number comes first");
}

static void test_defaults(void **state)
{
    struct sf_scene *scene = calloc(1, sizeof *scene);
    const struct sf_param_group *lights = sf_param_find(&sf_scene_group, "lights")->group;
    struct sf_light light;

    (void)state;
    assert_non_null(scene);
    sf_param_defaults(&sf_scene_group, scene);
    assert_int_equal(scene->method, SF_METHOD_THICK);
    assert_int_equal(scene->sim.capacity, 4096);
    assert_float_equal(scene->camera.fov, 40, 0);
    assert_float_equal(scene->camera.period, 0, 0); /* a fixed camera has no period */
    assert_int_equal(scene->light_count, 0);
    sf_param_defaults(lights, &light);
    assert_float_equal(light.intensity, 3, 0);
    assert_float_equal(light.position[1], 0, 0);
    assert_float_equal(light.direction[1], -1, 0);
    free(scene);
}

/* ---- numbers ---- */

static void check_number(const char *text)
{
    double value = 0, reference = strtod(text, NULL);

    if (!sf_number_parse(text, strlen(text), &value) || memcmp(&value, &reference, sizeof value) != 0)
        fail_msg("%s: %.17g, not %.17g", text, value, reference);
}

static void test_numbers(void **state)
{
    static const char *const fine[] = {"0",
                                       "-0",
                                       "+1",
                                       "1.",
                                       ".5",
                                       "1e5",
                                       "1E-5",
                                       "1e+5",
                                       "123456789012345678901234567890",
                                       "0.1",
                                       "9007199254740993",
                                       "1e22",
                                       "1e23",
                                       "1e-22",
                                       "2.2250738585072014e-308",
                                       "1.7976931348623157e308",
                                       "4.9e-324",
                                       "000123.4500"};
    static const char *const bad[] = {"",    "-",  "+",  ".",   "e5",  "1e",    "1e+",   "1.2.3",
                                      "--1", "1 ", " 1", "nan", "inf", "0x1p3", "1e400", "1_000"};
    char text[64];
    double value;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(fine); i++)
        check_number(fine[i]);
    for (size_t i = 0; i < SF_COUNT(bad); i++)
        if (sf_number_parse(bad[i], strlen(bad[i]), &value))
            fail_msg("'%s' was read as %g", bad[i], value);
    for (uint32_t i = 0; i < 20000; i++) {
        int digits = 1 + (int)(sf_random_u32(1, i, 0) % 20), exponent = (int)(sf_random_u32(1, i, 1) % 60) - 30;

        snprintf(text, sizeof text, "%.*e", digits, (sf_random_float(1, i, 2) - 0.5) * pow(10, exponent));
        check_number(text);
        snprintf(text, sizeof text, "%.*f", digits, (sf_random_float(1, i, 3) - 0.5) * 1000);
        check_number(text);
    }
    /* Every float comes back, in the shortest form: sampled over all bit patterns. */
    for (uint32_t i = 0; i < 50000; i++) {
        uint32_t bits = sf_random_u32(2, i, 0);
        float single;

        memcpy(&single, &bits, sizeof single);
        if (!isfinite(single))
            continue;
        sf_number_print(single, text);
        assert_true(sf_number_parse(text, strlen(text), &value));
        assert_true((float)value == single);
    }
    /* And every double. */
    for (uint32_t i = 0; i < 50000; i++) {
        uint64_t bits = (uint64_t)sf_random_u32(2, i, 1) << 32 | sf_random_u32(2, i, 2);
        double wide;

        memcpy(&wide, &bits, sizeof wide);
        if (!isfinite(wide))
            continue;
        sf_number_print_double(wide, text);
        assert_true(sf_number_parse(text, strlen(text), &value));
        assert_memory_equal(&value, &wide, sizeof wide);
    }
    sf_number_print_double(0.1, text);
    assert_string_equal(text, "0.1");
    sf_number_print_double(-0.0, text);
    assert_string_equal(text, "-0");
    sf_number_print(0.1f, text);
    assert_string_equal(text, "0.1");
    sf_number_print(16777216.0f, text);
    assert_string_equal(text, "16777216");
}

static void test_numbers_in_a_locale_with_commas(void **state)
{
    static const char *const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"};
    const char *set = NULL;
    char text[SF_NUMBER_BYTES];
    double value;

    (void)state;
    for (size_t i = 0; i < SF_COUNT(names) && !set; i++)
        set = setlocale(LC_NUMERIC, names[i]);
    if (!set)
        skip();
    sf_number_print(0.15625f, text);
    assert_string_equal(text, "0.15625");
    assert_true(sf_number_parse("3.14159265358979323846", 22, &value));
    assert_float_equal(value, 3.14159265358979323846, 0);
    setlocale(LC_NUMERIC, "C");
}

/* ---- documents ---- */

static void compare_document(const char *format, const char *relative)
{
    const char *root = getenv("SF_SOURCE_ROOT");
    char path[1024], *text = NULL, *file = NULL;
    size_t size = 0;

    snprintf(path, sizeof path, "%s/%s", root ? root : ".", relative);
    assert_int_equal(sf_params_print(format, NULL, &text), SF_OK);
    if (sf_file_read(path, 16 << 20, NULL, &file, &size) != SF_OK)
        fail_msg("%s is missing: sfumato params --format %s > %s", relative, format, relative);
    if (strlen(text) != size || memcmp(text, file, size) != 0)
        fail_msg("%s is stale: sfumato params --format %s > %s", relative, format, relative);
    free(text);
    free(file);
}

static void test_documents_are_fresh(void **state)
{
    (void)state;
    compare_document("markdown", "docs/params.md");
    compare_document("json-schema", "docs/scene.schema.json");
    compare_document("effect-markdown", "docs/effect-params.md");
    compare_document("effect-json-schema", "docs/effect.schema.json");
}

static const char *listed_text;
static void check_listed(const struct sf_param_group *group, const struct sf_param *row)
{
    char needle[96];

    (void)group;
    if (row->group)
        return;
    snprintf(needle, sizeof needle, "%s ", row->key);
    if (!strstr(listed_text, needle))
        fail_msg("%s is not listed", row->key);
}

static void test_text_lists_every_row(void **state)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    char *text = NULL;

    (void)state;
    assert_int_equal(sf_params_print("text", NULL, &text), SF_OK);
    listed_text = text;
    visit(&sf_scene_group, check_listed);
    assert_non_null(strstr(text, "emitters.N.path.N.time"));
    assert_non_null(strstr(text, "thick.steps"));
    free(text);
    assert_int_equal(sf_params_print("yaml", &log, &text), SF_ERROR_USAGE);
    assert_caught(&caught, "unknown format 'yaml'");
}

static void test_schema_knows_the_types(void **state)
{
    char *text = NULL;
    json_error_t error;
    json_t *schema, *variants, *sphere;

    (void)state;
    assert_int_equal(sf_params_print("json-schema", NULL, &text), SF_OK);
    schema = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    assert_non_null(schema);
    assert_true(json_is_false(json_object_get(schema, "additionalProperties")));
    assert_non_null(json_object_get(json_object_get(schema, "properties"), "//"));
    variants = json_object_get(schema, "properties");
    variants = json_object_get(json_object_get(json_object_get(variants, "objects"), "items"), "oneOf");
    assert_int_equal(json_array_size(variants), 5);
    sphere = json_object_get(json_array_get(variants, SF_OBJECT_SPHERE), "properties");
    assert_string_equal(json_string_value(json_object_get(json_object_get(sphere, "type"), "const")), "sphere");
    assert_non_null(json_object_get(sphere, "radius"));
    assert_null(json_object_get(sphere, "height"));
    json_decref(schema);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_are_sane),
        cmocka_unit_test(test_print_and_parse_give_the_same_bits),
        cmocka_unit_test(test_fetch),
        cmocka_unit_test(test_renews),
        cmocka_unit_test(test_bad_values_are_refused),
        cmocka_unit_test(test_messages_help),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_numbers_in_a_locale_with_commas),
        cmocka_unit_test(test_documents_are_fresh),
        cmocka_unit_test(test_text_lists_every_row),
        cmocka_unit_test(test_schema_knows_the_types),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
