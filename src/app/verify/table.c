/* What verify measured, for people. */
#include "verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../console.h"

void sf_verify_missed_text(unsigned missed, char *text, size_t room)
{
    static const struct {
        unsigned bit;
        const char *name;
    } goals[] = {{SF_GOAL_MEAN, "T mean"}, {SF_GOAL_MAX, "T max"}, {SF_GOAL_MSE, "MSE"}};
    size_t used = 0;

    text[0] = '\0';
    for (size_t i = 0; i < 3 && used < room; i++)
        if (missed & goals[i].bit)
            used += (size_t)snprintf(text + used, room - used, "%s%s", used ? ", " : "", goals[i].name);
}

static void print_head(const struct sf_verify *verify)
{
    const struct sf_arguments *arguments = verify->arguments;

    printf("%s, %s\n%ux%u against the reference to %g; times at %ux%u, median of up to %u\n\n", verify->info.name,
           verify->info.driver, arguments->size.width, arguments->size.height, arguments->tolerance.value,
           arguments->time_size.width, arguments->time_size.height, arguments->repeats);
    printf("%-16s %5s %-16s %8s %8s %8s %9s %8s %8s %9s%s\n", "scene", "frame", "method", "T mean", "T max", "a max",
           "rel. MSE", "bias", "p99", "ms", arguments->goals ? "  goals" : "");
}

static void print_row(const struct sf_verify *verify, const struct sf_verify_case *result, size_t entry)
{
    const struct sf_verify_row *row = &result->rows[entry];
    const struct sf_errors *errors = &row->errors;
    unsigned missed = sf_goals_missed(errors);
    char text[64], ms[32] = "-";

    if (row->samples > 0)
        snprintf(ms, sizeof ms, "%.2f", row->ms);
    printf("%-16s %5u %-16s ", result->name, result->frame, verify->entries[entry].method);
    if (errors->pixels == 0)
        printf("%8s %8s %8s %9s %8s %8s", "-", "-", "-", "-", "-", "-");
    else
        printf("%8.5f %8.5f %8.5f %9.3g %+7.2f%% %8.3g", errors->transmittance_mean, errors->transmittance_max,
               errors->alpha_max, errors->relative_mse, 100 * errors->bias, errors->p99);
    printf(" %9s", ms);
    if (verify->arguments->goals) {
        sf_verify_missed_text(missed, text, sizeof text);
        printf("  %s%s", missed ? "miss: " : "pass", text);
    }
    if (row->fault.found)
        printf("  NOT A NUMBER in %s", row->fault.image);
    putchar('\n');
}

/* Notes of one entry, each said once over all scenes. */
static bool said_before(const struct sf_verify *verify, size_t last, size_t entry, const char *note)
{
    for (size_t c = 0; c < last; c++)
        for (char *const *other = verify->cases[c].rows[entry].notes; other && *other; other++)
            if (strcmp(*other, note) == 0)
                return true;
    return false;
}

static void print_notes(const struct sf_verify *verify)
{
    for (size_t c = 0; c < verify->case_count; c++) {
        const struct sf_verify_case *result = &verify->cases[c];

        if (result->stride > 1)
            printf("note: %s would take the reference long: one pixel of each %ux%u is compared (--stride 1: all)\n",
                   result->name, result->stride, result->stride);
        if (result->live == 0)
            printf("note: %s, frame %u: there are no particles (--frames)\n", result->name, result->frame);
        if (result->unconverged > 0)
            printf("note: %s, frame %u: %u pixels of the reference are less exact than asked for\n", result->name,
                   result->frame, result->unconverged);
        for (size_t i = 0; i < verify->entry_count; i++)
            for (char *const *note = result->rows[i].notes; note && *note; note++)
                if (!said_before(verify, c, i, *note))
                    printf("note: %s, %s: %s\n", result->name, verify->entries[i].method, *note);
    }
}

static void print_legend(const struct sf_verify *verify)
{
    printf(
        "\nT mean, T max: error of the smoke's transmittance; a max: of 1 - alpha; rel. MSE: sum (L-R)^2 / sum R^2 of "
        "the smoke's radiance;\nbias: sum (L-R) / sum R; p99: 99th percentile of |L-R| in smoke / RMS of R; ms: all "
        "passes of the picture on the device\n");
    if (verify->arguments->goals)
        printf("goals: T mean (and a) at most %g, T max (and a) at most %g, rel. MSE at most %g\n",
               sf_goals.transmittance_mean, sf_goals.transmittance_max, sf_goals.relative_mse);
}

void sf_verify_print(const struct sf_verify *verify)
{
    print_head(verify);
    for (size_t c = 0; c < verify->case_count; c++)
        for (size_t i = 0; i < verify->entry_count; i++)
            print_row(verify, &verify->cases[c], i);
    print_legend(verify);
    print_notes(verify);
}
