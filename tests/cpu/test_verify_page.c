/* verify's plots and page: well-formed whatever the names are, nothing from outside, and nothing replaced that is not
 * its own. */
#include "xml_check.h"

#include <math.h>
#include "app/verify/markup.h"
#include "app/verify/plot.h"
#include "app/verify/plots.h"
#include "app/verify/verify.h"
#include "base/file.h"
#include "output/image.h"

/* ---- markup ---- */

static void assert_markup(const char *text, const char *want)
{
    char *out = NULL;
    size_t bytes = 0;
    FILE *stream = open_memstream(&out, &bytes);

    assert_non_null(stream);
    sf_markup_text(stream, text);
    assert_int_equal(fclose(stream), 0);
    assert_string_equal(out, want);
    free(out);
}

static void test_markup(void **state)
{
    (void)state;
    assert_markup("", "");
    assert_markup("a<b>&\"c'", "a&lt;b&gt;&amp;&quot;c'");
    assert_markup("\t\x01\x7f.", "   .");
    assert_markup("\xc3\xa9 \xe2\x82\xac \xf0\x9f\x8c\xab", "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x8c\xab");
    assert_markup("\xff\xfe \xc3", "?? ?");           /* no UTF-8, cut short */
    assert_markup("\xc0\xaf \xed\xa0\x80", "?? ???"); /* overlong, half a surrogate */
    assert_markup("\xef\xbf\xbf", "???");             /* U+FFFF is none of XML's */
}

/* ---- plots ---- */

static size_t count_of(const char *text, const char *part)
{
    size_t count = 0;

    for (const char *at = text; (at = strstr(at, part)); at += strlen(part))
        count++;
    return count;
}

/* Nothing that a browser would fetch. */
static void assert_offline(const char *text)
{
    assert_int_equal(count_of(text, "http"), count_of(text, "xmlns=\"http://www.w3.org/"));
    assert_null(strstr(text, "@import"));
    assert_null(strstr(text, "url("));
    assert_null(strstr(text, "<script"));
    assert_null(strstr(text, "<link"));
}

static char *plot_of(const struct sf_plot_point *points, size_t count)
{
    static const char *const series[] = {"a<b", "c&d"};

    return sf_plot_svg(&(struct sf_plot){.title = "<title>",
                                         .x_label = "x & x",
                                         .y_label = "\"y\"",
                                         .series = series,
                                         .series_count = 2,
                                         .points = points,
                                         .count = count,
                                         .goal = 0.01,
                                         .goal_label = "goal <"});
}

static void test_plot(void **state)
{
    const struct sf_plot_point points[] = {
        {10, 0.1, "one", 0, 0},     {20, 0.05, "two", 0, 1},    {40, 0.02, "a<c", 0, 1}, {12, 0.2, "", 1, 0},
        {0, 0.1, "lost", 0, 0},     {10, -1, "lost", 0, 0},     {NAN, 1, "lost", 1, 0},  {5, INFINITY, "lost", 1, 0},
        {80, 0.01, "dashed", 1, 2}, {90, 0.01, "dashed2", 1, 2}};
    char *svg = plot_of(points, sizeof points / sizeof *points);
    char *again = plot_of(points, sizeof points / sizeof *points);

    (void)state;
    assert_xml(svg);
    assert_offline(svg);
    assert_string_equal(svg, again);
    assert_int_equal(count_of(svg, "<circle"), 3 + 1); /* and the legend's */
    assert_null(strstr(svg, "lost"));
    assert_null(strstr(svg, "nan"));
    assert_null(strstr(svg, "inf"));
    assert_non_null(strstr(svg, ">a&lt;c</text>"));
    assert_int_equal(count_of(svg, "stroke-opacity"), 2); /* two-a<c, dashed-dashed2 */
    assert_int_equal(count_of(svg, "stroke-dasharray=\"2 3\""), 1);
    free(again);
    free(svg);
}

/* One point, none, a hundred decades, many in one place: still a picture, with points inside of it. */
static void test_plot_extremes(void **state)
{
    struct sf_plot_point points[200] = {{3, 0.004, "alone", 0, 0}};
    char *svg = plot_of(points, 1);

    (void)state;
    assert_xml(svg);
    assert_non_null(strstr(svg, ">alone</text>"));
    free(svg);
    svg = plot_of(NULL, 0);
    assert_xml(svg);
    free(svg);
    points[1] = (struct sf_plot_point){1e100, 1e-200, "far", 1, 0};
    svg = plot_of(points, 2);
    assert_xml(svg);
    assert_int_equal(count_of(svg, "<circle"), 2);
    assert_true(strlen(svg) < 100000);
    free(svg);
    for (size_t i = 0; i < 200; i++)
        points[i] = (struct sf_plot_point){100, 1, "the same", 0, 0};
    svg = plot_of(points, 200);
    assert_xml(svg);
    assert_true(count_of(svg, ">the same<") >= 5 && count_of(svg, ">the same<") < 100); /* what has room */
    free(svg);
}

/* Where a point is, in the picture's pixels, grows with its logarithm. */
static void test_plot_places(void **state)
{
    const struct sf_plot_point points[] = {{1, 1, "", 0, 0}, {10, 0.1, "", 0, 0}, {100, 0.01, "", 0, 0}};
    char *svg = plot_of(points, 3);
    const char *at = svg;
    double x[3], y[3];

    (void)state;
    for (int i = 0; i < 3; i++) {
        at = strstr(at, "<circle cx=\"");
        assert_non_null(at);
        assert_int_equal(sscanf(at, "<circle cx=\"%lf\" cy=\"%lf\"", &x[i], &y[i]), 2);
        at++;
    }
    assert_true(fabs((x[2] - x[1]) - (x[1] - x[0])) < 0.2 && x[1] - x[0] > 100);
    assert_true(fabs((y[2] - y[1]) - (y[1] - y[0])) < 0.2 && y[1] - y[0] > 50);
    free(svg);
}

/* ---- the page ---- */

enum { SIDE = 4 };

/* Two cases of three entries, with names and numbers to stumble over. */
struct made {
    struct sf_arguments arguments;
    struct sf_verify verify;
    struct sf_verify_entry entries[3];
    struct sf_verify_case cases[2];
    struct sf_verify_row rows[2][3];
    char *notes[2];
};

static char evil_note[] = "thick.x <is> & \"so\"", evil_name[] = "<a> & \"b\" 'c'", plain_name[] = "plain";
static char thick[] = "thick", other[] = "none", set[] = "thick.steps=4";

static void make(struct made *made, const char *folder)
{
    memset(made, 0, sizeof *made);
    made->arguments =
        (struct sf_arguments){.folder = folder, .size = {SIDE, SIDE}, .time_size = {80, 60}, .repeats = 3};
    made->arguments.tolerance.value = 1e-4;
    made->entries[0] = (struct sf_verify_entry){thick, NULL, "", 0};
    made->entries[1] = (struct sf_verify_entry){thick, set, "steps=4", 2};
    made->entries[2] = (struct sf_verify_entry){other, NULL, "", 0};
    made->notes[0] = evil_note;
    for (int c = 0; c < 2; c++) {
        made->cases[c] = (struct sf_verify_case){.path = c ? "a/plain.json" : "a/<a> & \"b\".json",
                                                 .name = c ? plain_name : evil_name,
                                                 .frame = 7,
                                                 .live = 1,
                                                 .stride = 1,
                                                 .rows = made->rows[c]};
        for (int i = 0; i < 3; i++)
            made->rows[c][i] =
                (struct sf_verify_row){.errors = {.relative_mse = 0.02 * (i + 1), .pixels = 16, .smoky = 9, .rms = 1},
                                       .ms = 10 * (i + 1),
                                       .ms_least = 9,
                                       .samples = 3,
                                       .notes = made->notes};
    }
    made->rows[0][2].fault = (struct sf_verify_fault){.found = true, .image = "im<age", .pass = "p&ass", .value = NAN};
    made->rows[0][2].errors = (struct sf_errors){.relative_mse = INFINITY, .bias = -INFINITY, .pixels = 4};
    made->cases[1].stride = 3;
    snprintf(made->verify.info.name, sizeof made->verify.info.name, "GPU <1> & co");
    made->verify.arguments = &made->arguments;
    made->verify.entries = made->entries;
    made->verify.entry_count = 3;
    made->verify.cases = made->cases;
    made->verify.case_total = made->verify.case_count = 2;
}

static char *read_text(const char *path)
{
    char *text;
    size_t size;

    assert_int_equal(sf_file_read(path, 1 << 24, NULL, &text, &size), SF_OK);
    return text;
}

static struct made made;

static void test_page(void **state)
{
    char *text;

    (void)state;
    make(&made, "page");
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_OK);
    made.verify.case_count = 0;
    assert_int_equal(sf_verify_write_page(&made.verify, false), SF_OK);
    text = read_text("page/index.html");
    assert_xml(text);
    assert_non_null(strstr(text, "Not complete"));
    free(text);
    made.verify.case_count = 2;
    assert_int_equal(sf_verify_write_page(&made.verify, true), SF_OK);
    text = read_text("page/index.html");
    assert_true(assert_xml(text) > 100);
    assert_offline(text);
    assert_null(strstr(text, "Not complete"));
    assert_null(strstr(text, "nan<"));
    assert_int_equal(count_of(text, "thick.x &lt;is&gt; &amp; &quot;so&quot;"),
                     2); /* once a method, not once a scene */
    assert_non_null(strstr(text, "im&lt;age"));
    assert_non_null(strstr(text, "one pixel of each 3x3"));
    assert_non_null(strstr(text, "src=\"01-_a_____b___c_-7-thick-difference.png\""));
    assert_non_null(strstr(text, "&#8734;")); /* an infinite error */
    free(text);
    text = read_text("page/plot.svg");
    assert_xml(text);
    free(text);
    text = read_text("page/verify.json");
    assert_null(strstr(text, "inf"));
    free(text);
}

/* The ends of the colours, and what is no number. */
static void test_pictures(void **state)
{
    float smoke[2][SIDE * SIDE * 4] = {{0}}, depths[SIDE * SIDE * 4] = {0};
    struct sf_reference_pixel pixels[SIDE * SIDE] = {{{0}, 0, 0, 0, 0, 0, 0, false}};
    const struct sf_layers layers[3] = {
        {SIDE, SIDE, smoke[0], depths}, {SIDE, SIDE, smoke[1], depths}, {SIDE, SIDE, smoke[1], depths}};
    const struct sf_reference_picture reference = {SIDE, SIDE, pixels, 0};
    const struct sf_verify_drawn drawn = {layers, &reference, "linear", 0};
    struct sf_image image;
    double rgb[3];

    (void)state;
    make(&made, "pictures");
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_OK);
    for (int c = 0; c < 3; c++) {
        smoke[0][c] = 1;                                /* pixel 0: 1 too bright */
        pixels[1].radiance[c] = 1;                      /* pixel 1: 1 too dark */
        smoke[0][8 + c] = pixels[2].radiance[c] = 0.5f; /* pixel 2: right */
        smoke[0][12 + c] = c == 1 ? NAN : 0;            /* pixel 3: no number */
    }
    assert_int_equal(sf_verify_write_pictures(&made.verify, &made.cases[0], &drawn), SF_OK);
    assert_true(made.cases[0].scale == 1);
    assert_int_equal(sf_image_read("pictures/01-_a_____b___c_-7-thick-difference.png", &image, NULL), SF_OK);
    assert_true(image.pixels[0] > 3 * image.pixels[2]);         /* red */
    assert_true(image.pixels[4 + 2] > 3 * image.pixels[4]);     /* blue */
    assert_true(image.pixels[8] == 1 && image.pixels[10] == 1); /* white */
    assert_true(image.pixels[12] == 0 && image.pixels[13] > 0.5f && image.pixels[14] == 0);
    sf_image_finish(&image);
    assert_int_equal(scratch_count("pictures"), 1 + 2 * 2); /* none of the setting's */
    sf_verify_heat(0, rgb);
    assert_true(rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1);
    sf_verify_heat(7, rgb);
    assert_true(rgb[0] > rgb[2] && rgb[0] <= 1);
}

static void put_file(const char *path, const char *text)
{
    assert_int_equal(sf_file_write(path, text, strlen(text), NULL), SF_OK);
}

/* Nothing is replaced unless it was asked for and the folder is one of ours. */
static void test_folder(void **state)
{
    char *text;

    (void)state;
    make(&made, "taken");
    assert_int_equal(mkdir("taken", 0777), 0);
    put_file("taken/plot.svg", "mine");
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_ERROR_IO);
    made.arguments.overwrite = true;
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_ERROR_IO); /* no page says whose it is */
    put_file("taken/index.html", "<html>somebody's</html>");
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_ERROR_IO);
    text = read_text("taken/plot.svg");
    assert_string_equal(text, "mine");
    free(text);
    unlink("taken/index.html");
    unlink("taken/plot.svg");
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_OK);
    assert_int_equal(sf_verify_write_page(&made.verify, true), SF_OK);
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_OK);
    made.arguments.overwrite = false;
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_ERROR_IO);
    made.arguments.folder = "taken/index.html";
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_ERROR_IO);
    made.arguments.folder = "no/such";
    assert_int_equal(sf_verify_folder_open(&made.verify), SF_ERROR_IO);
    assert_int_equal(scratch_count("taken"), 3); /* no temporary is left */
}

static void test_summary(void **state)
{
    struct sf_verify_summary summary;
    char text[64];

    (void)state;
    make(&made, "none");
    made.rows[1][0].errors.relative_mse = 0.0002;
    made.rows[1][0].errors.bias = -0.5;
    made.rows[1][0].ms = 40;
    made.rows[0][0].errors.bias = 0.25;
    sf_verify_summarise(&made.verify, 0, &summary);
    assert_true(fabs(summary.typical_mse - 0.002) < 1e-9);
    assert_true(summary.relative_mse == 0.02 && summary.bias == -0.5 && fabs(summary.ms - 20) < 1e-9);
    assert_int_equal(summary.rows, 2);
    assert_int_equal(summary.missed, 1);
    sf_verify_missed_text(SF_GOAL_MAX | SF_GOAL_MSE, text, sizeof text);
    assert_string_equal(text, "T max, MSE");
    sf_verify_entry_text(&made.entries[1], text, sizeof text);
    assert_string_equal(text, "thick steps=4");
}

/* A hundred spheres in a box of 2 m: by Cauchy's formula a ray through a body of area A meets n pi r^2 / (A / 4) of
 * them. And the reference that would take hours is made sparse, by counts alone. */
static void test_cost(void **state)
{
    struct sf_frame_particle particles[100];
    struct sf_reference_pixel pixels[64] = {{{0}, 0, 0, 0, 0, 0, 0, false}};
    const struct sf_reference_picture sample = {8, 8, pixels, 0};
    struct sf_frame frame = {.particles = particles, .live = 100, .bounds_min = {0, 0, 0}, .bounds_max = {2, 2, 2}};

    (void)state;
    memset(particles, 0, sizeof particles);
    for (int i = 0; i < 100; i++)
        particles[i].radius = 0.1f;
    assert_true(fabs(sf_verify_crossed(&frame) - 3.14159 / 4) < 1e-4);
    frame.live = 0;
    assert_true(sf_verify_crossed(&frame) == 0);
    assert_int_equal(sf_verify_stride(&sample, 200, 200, 0, 1), 1);
    for (int i = 0; i < 64; i++)
        pixels[i].evaluations = 3000;
    assert_int_equal(sf_verify_stride(&sample, 200, 200, 0, 1), 1); /* 60 s, just so */
    assert_int_equal(sf_verify_stride(&sample, 201, 200, 0, 1), 2);
    assert_int_equal(sf_verify_stride(&sample, 200, 200, 0, 4), 2);
    assert_int_equal(sf_verify_stride(&sample, 200, 200, 1000, 1), 15); /* 201 times that */
}

/* A particle whose velocity is none. */
static void test_particles(void **state)
{
    struct sf_frame_particle particles[3] = {{{0}, 1, {0}, 1, 0, 0, 0, 0, 1, 1, 0, 0}};
    const struct sf_frame frame = {.particles = particles, .live = 3};
    struct sf_verify_fault fault;

    (void)state;
    sf_verify_check_particles(&frame, &fault);
    assert_false(fault.found);
    particles[2].velocity[1] = INFINITY;
    sf_verify_check_particles(&frame, &fault);
    assert_true(fault.found && fault.x == 2 && isinf(fault.value));
    assert_string_equal(fault.image, "particles");
    assert_string_equal(fault.pass, "sim.step");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_markup),      cmocka_unit_test(test_plot),    cmocka_unit_test(test_plot_extremes),
        cmocka_unit_test(test_plot_places), cmocka_unit_test(test_page),    cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_folder),      cmocka_unit_test(test_summary), cmocka_unit_test(test_particles),
        cmocka_unit_test(test_cost),
    };

    return cmocka_run_group_tests(tests, scratch_enter, scratch_leave);
}
