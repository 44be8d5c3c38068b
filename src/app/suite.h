/* Suites of benchmarks: published tables of frame rates, run again on the device at hand. suite_tables.c holds what was
 * published, suite.c measures and prints. */
#ifndef SF_APP_SUITE_H
#define SF_APP_SUITE_H

#include "options.h"

enum { SF_SUITE_SETS = 3, SF_SUITE_COLUMNS = 3 };

struct sf_suite_row {
    const char *label;
    const char *sets[SF_SUITE_SETS];    /* over the scene; NULL: no more */
    uint32_t width, height;             /* px */
    double published[SF_SUITE_COLUMNS]; /* frames a second; 0: the row is ours alone */
};

struct sf_suite {
    const char *title;          /* what was published, where, and on what */
    const char *scene;          /* looked for here, beside the program, and in the folder above it */
    const char *const *columns; /* of what was published; NULL-terminated */
    const char *base;           /* what the ratios are to: the first row */
    const struct sf_suite_row *rows;
    size_t row_count;
    const char *const *notes; /* NULL-terminated lines under the table */
};

extern const struct sf_suite sf_suites[];
extern const char *const sf_suite_names[]; /* for --suite, in the same order; NULL-terminated */

enum sf_status sf_suite_run(const struct sf_arguments *arguments);

#endif
