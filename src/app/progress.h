/* How far the work is, and how long it will still take: a line that moves on a terminal, else a plain line now and
 * then. */
#ifndef SF_APP_PROGRESS_H
#define SF_APP_PROGRESS_H

#include <stdint.h>

struct sf_progress {
    const char *what, *unit; /* "rendering", "frames" */
    uint64_t total, begin_ns, shown_ns;
};

void sf_progress_begin(struct sf_progress *progress, const char *what, const char *unit, uint64_t total);
void sf_progress_show(struct sf_progress *progress, uint64_t done);
/* Takes the moving line away. */
void sf_progress_end(struct sf_progress *progress);
/* "1.4 s", "42 s", "3:25", "1:02:03" */
void sf_duration_print(double seconds, char *text, unsigned room);

#endif
