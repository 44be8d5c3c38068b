#include "progress.h"

#include <stdio.h>
#include <string.h>

#include "console.h"

enum { BAR_WIDTH_MAX = 40, TEXT_MAX = 256 };
static const uint64_t REDRAW_NS = 100000000u, PLAIN_NS = 5000000000u;

void sf_duration_print(double seconds, char *text, unsigned room)
{
    uint64_t whole = seconds < 0 ? 0 : seconds > 1e9 ? 1000000000u : (uint64_t)(seconds + 0.5);
    unsigned s = (unsigned)(whole % 60), m = (unsigned)(whole / 60 % 60), h = (unsigned)(whole / 3600);

    if (h)
        snprintf(text, room, "%u:%02u:%02u", h, m, s);
    else if (m)
        snprintf(text, room, "%u:%02u", m, s);
    else if (seconds < 9.95)
        snprintf(text, room, "%.1f s", seconds < 0 ? 0.0 : seconds);
    else
        snprintf(text, room, "%u s", s);
}

void sf_progress_begin(struct sf_progress *progress, const char *what, const char *unit, uint64_t total)
{
    uint64_t now = sf_now_ns();

    /* A plain line comes only once the work has gone on for a while; the moving one at once. */
    *progress = (struct sf_progress){.what = what, .unit = unit, .total = total, .begin_ns = now, .shown_ns = now};
    if (sf_console_moves()) {
        progress->shown_ns = 0;
        sf_progress_show(progress, 0);
    }
}

static void draw_bar(const struct sf_progress *progress, uint64_t done, const char *numbers)
{
    char text[TEXT_MAX], bar[BAR_WIDTH_MAX + 1];
    unsigned width = sf_console_width(), used = (unsigned)(strlen(numbers) + strlen(progress->what) + 6);
    unsigned room = width > used ? width - used : 0, full;

    if (room > BAR_WIDTH_MAX)
        room = BAR_WIDTH_MAX;
    full = progress->total ? (unsigned)(room * done / progress->total) : room;
    for (unsigned i = 0; i < room; i++)
        bar[i] = i < full ? '=' : i == full ? '>' : ' ';
    bar[room] = '\0';
    snprintf(text, sizeof text, "%s [%s] %s", progress->what, bar, numbers);
    sf_console_line(text);
}

void sf_progress_show(struct sf_progress *progress, uint64_t done)
{
    uint64_t now = sf_now_ns();
    double elapsed = (double)(now - progress->begin_ns) * 1e-9;
    char numbers[TEXT_MAX / 2], left[32] = "";

    if (now - progress->shown_ns < (sf_console_moves() ? REDRAW_NS : PLAIN_NS) || sf_console_quiet())
        return;
    progress->shown_ns = now;
    if (done > progress->total)
        done = progress->total;
    if (done > 0 && elapsed > 0) {
        sf_duration_print(elapsed / (double)done * (double)(progress->total - done), left, sizeof left);
        snprintf(numbers, sizeof numbers, "%llu/%llu  %.3g %s/s  %s left", (unsigned long long)done,
                 (unsigned long long)progress->total, (double)done / elapsed, progress->unit, left);
    } else {
        snprintf(numbers, sizeof numbers, "%llu/%llu", (unsigned long long)done, (unsigned long long)progress->total);
    }
    if (sf_console_moves())
        draw_bar(progress, done, numbers);
    else
        sf_console_note("%s %s", progress->what, numbers);
}

void sf_progress_end(struct sf_progress *progress)
{
    (void)progress;
    sf_console_line("");
}
