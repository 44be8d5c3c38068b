/* Points in a plane of two logarithmic axes, as an SVG picture that needs nothing else: no fonts, no styles, no scripts
 * from outside. */
#ifndef SF_APP_VERIFY_PLOT_H
#define SF_APP_VERIFY_PLOT_H

#include <stddef.h>
#include <stdint.h>

struct sf_plot_point {
    double x, y;       /* above 0; points with others, or with infinities, are left out */
    const char *label; /* "" */
    uint32_t series;   /* colour and marker */
    uint32_t line;     /* neighbours in the list of the same series and line are joined; 0: not joined */
};

struct sf_plot {
    const char *title, *x_label, *y_label;
    const char *const *series; /* names, [series_count] */
    size_t series_count;
    const struct sf_plot_point *points;
    size_t count;
    double goal; /* a dashed line at this y; 0: none */
    const char *goal_label;
};

/* malloc'ed; NULL when memory is out. The same plot has the same text. */
char *sf_plot_svg(const struct sf_plot *plot);
/* Colour number `series` as "#rrggbb". */
const char *sf_plot_color(size_t series);

#endif
