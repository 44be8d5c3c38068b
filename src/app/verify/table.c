/* What verify measured, for people. */
#include "verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { NAME_ROOM = 128 };

struct widths {
    int scene, method;
};

static int wider(int width, const char *text)
{
    int length = (int)strlen(text);

    return length > width ? length : width;
}

static struct widths measure(const struct sf_verify *verify)
{
    struct widths widths = {(int)strlen("scene"), (int)strlen("method")};
    char name[NAME_ROOM];

    for (size_t c = 0; c < verify->case_count; c++)
        widths.scene = wider(widths.scene, verify->cases[c].name);
    for (size_t i = 0; i < verify->entry_count; i++) {
        sf_verify_entry_text(&verify->entries[i], name, sizeof name);
        widths.method = wider(widths.method, name);
    }
    return widths;
}

static void print_head(const struct sf_verify *verify, struct widths widths)
{
    const struct sf_arguments *arguments = verify->arguments;

    printf("%s, %s\n%ux%u against the reference to %g", verify->info.name, verify->info.driver, arguments->size.width,
           arguments->size.height, arguments->tolerance.value);
    if (arguments->repeats > 0)
        printf("; times at %ux%u, median of up to %u", arguments->time_size.width, arguments->time_size.height,
               arguments->repeats);
    printf("\n\n%-*s %5s %-*s %8s %8s %8s %9s %8s %8s %9s%s\n", widths.scene, "scene", "frame", widths.method, "method",
           "T mean", "T max", "a max", "rel. MSE", "bias", "p99", "ms", arguments->goals ? "  goals" : "");
}

/* Numbers of a line from "T mean" to "ms"; without smoke or comparison there are none of radiance. */
static void print_numbers(const struct sf_errors *errors, double ms)
{
    if (errors->pixels == 0)
        printf("%8s %8s %8s %9s %8s %8s", "-", "-", "-", "-", "-", "-");
    else
        printf("%8.5f %8.5f %8.5f %9.3g %+7.2f%% %8.3g", errors->transmittance_mean, errors->transmittance_max,
               errors->alpha_max, errors->relative_mse, 100 * errors->bias, errors->p99);
    if (ms > 0)
        printf(" %9.2f", ms);
    else
        printf(" %9s", "-");
}

static void print_row(const struct sf_verify *verify, struct widths widths, const struct sf_verify_case *result,
                      size_t entry)
{
    const struct sf_verify_row *row = &result->rows[entry];
    unsigned missed = sf_goals_missed(&row->errors);
    char name[NAME_ROOM], text[64];

    sf_verify_entry_text(&verify->entries[entry], name, sizeof name);
    printf("%-*s %5u %-*s ", widths.scene, result->name, result->frame, widths.method, name);
    print_numbers(&row->errors, row->samples > 0 ? row->ms : 0);
    if (verify->arguments->goals) {
        sf_verify_missed_text(missed, text, sizeof text);
        printf("  %s%s", missed ? "miss: " : "pass", text);
    }
    if (row->fault.found)
        printf("  NOT A NUMBER in %s", row->fault.image);
    putchar('\n');
}

/* Worst of all scenes, and the mean of times, one line an entry. */
static void print_summary(const struct sf_verify *verify, struct widths widths)
{
    if (verify->case_count < 2)
        return;
    putchar('\n');
    for (size_t i = 0; i < verify->entry_count; i++) {
        struct sf_verify_summary s;
        char name[NAME_ROOM];

        sf_verify_summarise(verify, i, &s);
        const struct sf_errors worst = {.transmittance_mean = s.transmittance_mean,
                                        .transmittance_max = s.transmittance_max,
                                        .alpha_max = s.alpha_max,
                                        .relative_mse = s.relative_mse,
                                        .bias = s.bias,
                                        .p99 = s.p99,
                                        .pixels = s.rows};
        sf_verify_entry_text(&verify->entries[i], name, sizeof name);
        printf("%-*s %5s %-*s ", widths.scene, i == 0 ? "worst" : "", "", widths.method, name);
        print_numbers(&worst, s.ms);
        if (verify->arguments->goals)
            printf("  %zu of %zu pass", verify->case_count - s.missed, verify->case_count);
        putchar('\n');
    }
}

static void print_legend(const struct sf_verify *verify)
{
    char note[512];

    printf(
        "\nT mean, T max: error of the smoke's transmittance; a max: of 1 - alpha; rel. MSE: sum (L-R)^2 / sum R^2 of "
        "the smoke's\nradiance; bias: sum (L-R) / sum R; p99: 99th percentile of |L-R| in smoke / RMS of R; ms: the "
        "picture's passes on the device%s\n",
        verify->case_count > 1 ? " (worst: geometric mean)" : "");
    if (verify->arguments->goals)
        printf("goals: T mean (and a) at most %g, T max (and a) at most %g, rel. MSE at most %g\n",
               sf_goals.transmittance_mean, sf_goals.transmittance_max, sf_goals.relative_mse);
    for (size_t i = 0; sf_verify_note(verify, i, note, sizeof note); i++)
        printf("note: %s\n", note);
}

void sf_verify_print(const struct sf_verify *verify)
{
    struct widths widths = measure(verify);

    print_head(verify, widths);
    for (size_t c = 0; c < verify->case_count; c++)
        for (size_t i = 0; i < verify->entry_count; i++)
            print_row(verify, widths, &verify->cases[c], i);
    print_summary(verify, widths);
    print_legend(verify);
}
