/* What table and page say in words, and over all scenes. */
#include "verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double MSE_LEAST = 1e-12;

void sf_verify_missed_text(unsigned missed, char *text, size_t room)
{
    static const struct {
        unsigned bit;
        const char *name;
    } goals[] = {{SF_GOAL_MEAN, "T mean"}, {SF_GOAL_MAX, "T max"}, {SF_GOAL_MSE, "MSE"}};
    size_t used = 0;

    text[0] = '\0';
    for (size_t i = 0; i < sizeof goals / sizeof *goals && used < room; i++)
        if (missed & goals[i].bit)
            used += (size_t)snprintf(text + used, room - used, "%s%s", used ? ", " : "", goals[i].name);
}

void sf_verify_entry_text(const struct sf_verify_entry *entry, char *text, size_t room)
{
    snprintf(text, room, "%s%s%s", entry->method, entry->label[0] ? " " : "", entry->label);
}

void sf_verify_summarise(const struct sf_verify *verify, size_t entry, struct sf_verify_summary *summary)
{
    double logs = 0, time_logs = 0;
    size_t timed = 0;

    *summary = (struct sf_verify_summary){0};
    for (size_t c = 0; c < verify->case_count; c++) {
        const struct sf_verify_row *row = &verify->cases[c].rows[entry];
        const struct sf_errors *errors = &row->errors;

        summary->missed += sf_goals_missed(errors) != 0;
        if (row->samples > 0 && row->ms > 0) {
            time_logs += log(row->ms);
            timed++;
        }
        if (errors->smoky == 0)
            continue;
        summary->rows++;
        summary->transmittance_mean = fmax(summary->transmittance_mean, errors->transmittance_mean);
        summary->transmittance_max = fmax(summary->transmittance_max, errors->transmittance_max);
        summary->alpha_max = fmax(summary->alpha_max, errors->alpha_max);
        summary->relative_mse = fmax(summary->relative_mse, errors->relative_mse);
        summary->p99 = fmax(summary->p99, errors->p99);
        if (fabs(errors->bias) > fabs(summary->bias))
            summary->bias = errors->bias;
        logs += log(fmax(errors->relative_mse, MSE_LEAST));
    }
    summary->typical_mse = summary->rows > 0 ? exp(logs / (double)summary->rows) : 0;
    summary->ms = timed > 0 ? exp(time_logs / (double)timed) : 0;
}

/* ---- notes ---- */

/* A row's note that the same entry had at an earlier case. */
static bool said_before(const struct sf_verify *verify, size_t last, size_t entry, const char *note)
{
    for (size_t c = 0; c < last; c++)
        for (char *const *other = verify->cases[c].rows[entry].notes; other && *other; other++)
            if (strcmp(*other, note) == 0)
                return true;
    return false;
}

/* Those about the case itself: false behind the third. `chosen`: --stride was given. */
static bool case_note(const struct sf_verify_case *result, bool chosen, size_t index, char *text, size_t room)
{
    text[0] = '\0';
    if (index == 0 && result->stride > 1)
        snprintf(text, room, "%s: one pixel of each %ux%u is compared%s", result->name, result->stride, result->stride,
                 chosen ? "" : ": the reference would take long (--stride 1: all)");
    if (index == 1 && result->live == 0)
        snprintf(text, room, "%s: frame %u has no particles (--frames)", result->name, result->frame);
    if (index == 2 && result->unconverged > 0)
        snprintf(text, room, "%s: %u pixels of the reference are less exact than asked for", result->name,
                 result->unconverged);
    return index < 3;
}

/* Whether a method makes its picture in many steps, of which the renderer times the last. */
static bool has_steps(const struct sf_verify *verify)
{
    for (size_t i = 0; i < verify->entry_count; i++)
        if (strcmp(verify->entries[i].method, "reference") == 0)
            return true;
    return false;
}

bool sf_verify_note(const struct sf_verify *verify, size_t index, char *text, size_t room)
{
    char name[128];
    size_t seen = 0;

    for (size_t c = 0; c < verify->case_count; c++) {
        const struct sf_verify_case *result = &verify->cases[c];

        for (size_t i = 0; case_note(result, verify->arguments->stride > 0, i, text, room); i++)
            if (text[0] && seen++ == index)
                return true;
        for (size_t i = 0; i < verify->entry_count; i++) {
            /* What is changed is changed at the scene's own settings, which have the same notes. */
            if (verify->entries[i].sweep > 0)
                continue;
            for (char *const *note = result->rows[i].notes; note && *note; note++) {
                if (said_before(verify, c, i, *note) || seen++ != index)
                    continue;
                sf_verify_entry_text(&verify->entries[i], name, sizeof name);
                snprintf(text, room, "%s, %s: %s", result->name, name, *note);
                return true;
            }
        }
    }
    if (seen != index || verify->arguments->repeats == 0 || !has_steps(verify))
        return false;
    snprintf(text, room,
             "ms of method reference is that of its last step, not of the picture: sfumato bench has the wall time");
    return true;
}
