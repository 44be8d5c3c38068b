/* What was published: R. Larsson, Interactive Real-Time Smoke Rendering, Chalmers 2010. */
#include "suite.h"

#define TABLE1_SIZE .width = 1280, .height = 1024

/* 3.4.4. "A quarter of full screen" does not say whether of the sides or of the pixels: there is a row of each. */
static const struct sf_suite_row table1_rows[] = {
    {.label = "hard", .sets = {"method=hard", "thick.resolution=full"}, TABLE1_SIZE, .published = {102, 416, 212}},
    {.label = "soft, depth drawn before",
     .sets = {"method=soft", "thick.resolution=full", "surfaces.prepass=again"},
     TABLE1_SIZE,
     .published = {104, 384, 194}},
    {.label = "soft, and its z used again",
     .sets = {"method=soft", "thick.resolution=full", "surfaces.prepass=equal"},
     TABLE1_SIZE,
     .published = {105, 376, 190}},
    {.label = "soft, 1/4 of the pixels",
     .sets = {"method=soft", "thick.resolution=half", "surfaces.prepass=again"},
     TABLE1_SIZE,
     .published = {104, 264, 166}},
    {.label = "soft, 1/4 of the sides",
     .sets = {"method=soft", "thick.resolution=quarter", "surfaces.prepass=again"},
     TABLE1_SIZE,
     .published = {104, 264, 166}},
    {.label = "soft, depth beside colour", .sets = {"method=soft", "thick.resolution=full"}, TABLE1_SIZE},
    {.label = "  the same, 1/4 of the pixels", .sets = {"method=soft", "thick.resolution=half"}, TABLE1_SIZE},
};
static const char *const table1_columns[] = {"min", "max", "average", NULL};
static const char *const table1_notes[] = {
    "The thesis measured a game that it calls bound by its CPU, with smoke rarely in view, on hardware that it does",
    "not name; here the scene is meant to be like it, and the device's time is counted. Rows 1 to 5 draw what its",
    "rows were; \"a quarter of full screen\" may be of the pixels or of the sides. The last two are this program's own "
    "way.",
    NULL};

/* 3.3.10. How many particles there were is not said; "hundreds" (3.3.1). */
static const struct sf_suite_row fps_rows[] = {
    {.label = "the thesis's way",
     .sets = {"method=thick-larsson", "thick.resolution=full"},
     .width = 800,
     .height = 800,
     .published = {85, 50}},
    {.label = "the thesis's way",
     .sets = {"method=thick-larsson", "thick.resolution=full"},
     .width = 1280,
     .height = 1024,
     .published = {60, 50}},
    {.label = "  at half resolution",
     .sets = {"method=thick-larsson", "thick.resolution=half"},
     .width = 800,
     .height = 800},
    {.label = "  at half resolution",
     .sets = {"method=thick-larsson", "thick.resolution=half"},
     .width = 1280,
     .height = 1024},
    {.label = "thick", .sets = {"method=thick", "thick.resolution=half"}, .width = 800, .height = 800},
    {.label = "thick", .sets = {"method=thick", "thick.resolution=half"}, .width = 1280, .height = 1024},
};
static const char *const fps_columns[] = {"8800 GT", "GTX 260", NULL};
static const char *const fps_notes[] = {
    "The thesis does not say how many particles it drew; scenes/plume.json has about 512. 1280x1024 has 2.05 times the",
    "pixels of 800x800: a method bound by them would come to 0.49. The rows without a thesis's number are this "
    "program's own.",
    NULL};

const struct sf_suite sf_suites[] = {
    {.title = "Hard and soft particles in a game: Larsson's thesis (2010), table 1",
     .scene = "scenes/bench/larsson-table1.json",
     .columns = table1_columns,
     .base = "hard",
     .rows = table1_rows,
     .row_count = sizeof table1_rows / sizeof *table1_rows,
     .notes = table1_notes},
    {.title = "Thick smoke with volumetric lighting: Larsson's thesis (2010), 3.3.10, on two GeForces",
     .scene = "scenes/plume.json",
     .columns = fps_columns,
     .base = "row 1",
     .rows = fps_rows,
     .row_count = sizeof fps_rows / sizeof *fps_rows,
     .notes = fps_notes},
};
const char *const sf_suite_names[] = {"larsson-table1", "larsson-fps", NULL};
_Static_assert(sizeof sf_suites / sizeof *sf_suites + 1 == sizeof sf_suite_names / sizeof *sf_suite_names,
               "a name for each suite");
