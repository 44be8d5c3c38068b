/* The program's words to a person, all on standard error: messages, and the one line that shows progress. Any thread.
 */
#ifndef SF_APP_CONSOLE_H
#define SF_APP_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>
#include "sfumato/log.h"
#include "sfumato/status.h"

#if defined(__GNUC__)
#define SF_APP_PRINTF(string, first) __attribute__((format(printf, string, first)))
#else
#define SF_APP_PRINTF(string, first)
#endif

/* Messages above `level` are dropped. Colour and the moving line only when standard error is a terminal. */
void sf_console_start(enum sf_log_level level);
/* The log that the library gets. */
const struct sf_log *sf_console_log(void);
/* Errors that were printed so far. */
unsigned sf_console_errors(void);
bool sf_console_moves(void);
bool sf_console_quiet(void);

void sf_console_say(enum sf_log_level level, const char *format, ...) SF_APP_PRINTF(2, 3);
/* Prints an error and returns `status`. */
enum sf_status sf_console_fail(enum sf_status status, const char *format, ...) SF_APP_PRINTF(2, 3);
/* A line of the result that standard output must not carry; unless --quiet. */
void sf_console_note(const char *format, ...) SF_APP_PRINTF(1, 2);

/* Redraws the moving line, cut to the terminal's width; "" removes it. Messages push it aside. Only when
 * sf_console_moves. */
void sf_console_line(const char *text);
/* Columns of the terminal; 80 when unknown. */
unsigned sf_console_width(void);

/* Monotonic nanoseconds. */
uint64_t sf_now_ns(void);

/* First SIGINT or SIGTERM: sf_interrupted becomes true and the work ends after the frame in hand; the second one kills.
 * SIGPIPE is ignored, so that writing to a closed pipe is an error like any other. An interrupt that is ignored at the
 * start stays ignored. */
void sf_signals_start(void);
bool sf_interrupted(void);

#endif
