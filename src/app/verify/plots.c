#include "plots.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plot.h"

/* Methods are the series, in the order of the entries. */
struct names {
    const char **list;
    size_t count;
};

static uint32_t series_of(struct names *names, const char *method)
{
    for (size_t i = 0; i < names->count; i++)
        if (strcmp(names->list[i], method) == 0)
            return (uint32_t)i;
    names->list[names->count++] = method;
    return (uint32_t)(names->count - 1);
}

/* `x` and `y` of each entry; 0: none. */
static char *draw(const struct sf_verify *verify, const char *title, const char *y_label, const double *x,
                  const double *y)
{
    struct names names = {.list = calloc(verify->entry_count, sizeof *names.list)};
    struct sf_plot_point *points = calloc(verify->entry_count, sizeof *points);
    char x_label[96], goal[64], *svg = NULL;

    for (size_t i = 0; names.list && points && i < verify->entry_count; i++) {
        const struct sf_verify_entry *entry = &verify->entries[i];

        points[i] = (struct sf_plot_point){.x = x[i],
                                           .y = y[i],
                                           .label = entry->sweep > 0 ? entry->label : entry->method,
                                           .series = series_of(&names, entry->method),
                                           .line = entry->sweep};
    }
    snprintf(x_label, sizeof x_label, "ms on the device, %ux%u", verify->arguments->time_size.width,
             verify->arguments->time_size.height);
    snprintf(goal, sizeof goal, "goal %g", sf_goals.relative_mse);
    if (names.list && points)
        svg = sf_plot_svg(&(struct sf_plot){.title = title,
                                            .x_label = x_label,
                                            .y_label = y_label,
                                            .series = names.list,
                                            .series_count = names.count,
                                            .points = points,
                                            .count = verify->entry_count,
                                            .goal = sf_goals.relative_mse,
                                            .goal_label = goal});
    free(names.list);
    free(points);
    return svg;
}

char *sf_verify_plot_case(const struct sf_verify *verify, const struct sf_verify_case *result)
{
    double *x = calloc(2 * verify->entry_count, sizeof *x), *y = x ? x + verify->entry_count : NULL;
    char title[160], *svg = NULL;

    for (size_t i = 0; x && i < verify->entry_count; i++) {
        const struct sf_verify_row *row = &result->rows[i];

        x[i] = row->samples > 0 ? row->ms : 0;
        y[i] = row->errors.relative_mse;
    }
    snprintf(title, sizeof title, "%.100s, frame %u", result->name, result->frame);
    if (x)
        svg = draw(verify, title, "relative MSE of radiance", x, y);
    free(x);
    return svg;
}

char *sf_verify_plot_all(const struct sf_verify *verify)
{
    double *x = calloc(2 * verify->entry_count, sizeof *x), *y = x ? x + verify->entry_count : NULL;
    char title[96], *svg = NULL;

    for (size_t i = 0; x && i < verify->entry_count; i++) {
        struct sf_verify_summary summary;

        sf_verify_summarise(verify, i, &summary);
        x[i] = summary.ms;
        y[i] = summary.typical_mse;
    }
    snprintf(title, sizeof title, "Error against time, %zu scene%s", verify->case_count,
             verify->case_count == 1 ? "" : "s");
    if (x)
        svg = draw(verify, title, "relative MSE of radiance, geometric mean", x, y);
    free(x);
    return svg;
}
