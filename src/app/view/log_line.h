/* Lines for the host's log, from the viewer's parts that are given one. */
#ifndef SF_APP_VIEW_LOG_LINE_H
#define SF_APP_VIEW_LOG_LINE_H

#include <stdarg.h>
#include <stdio.h>
#include "sfumato/log.h"
#include "sfumato/status.h"
#include "../console.h"

enum { SF_LOG_LINE_BYTES = 2048 };

static inline void sf_log_line_args(const struct sf_log *log, enum sf_log_level level, const char *format, va_list args)
{
    char line[SF_LOG_LINE_BYTES];

    if (!log || !log->write || level > log->level)
        return;
    vsnprintf(line, sizeof line, format, args);
    log->write(log->user, level, line);
}

/* `log` may be NULL. */
static inline void SF_APP_PRINTF(3, 4)
    sf_log_line(const struct sf_log *log, enum sf_log_level level, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    sf_log_line_args(log, level, format, args);
    va_end(args);
}

/* An error; returns `status`. */
static inline enum sf_status SF_APP_PRINTF(3, 4)
    sf_log_fail(const struct sf_log *log, enum sf_status status, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    sf_log_line_args(log, SF_LOG_ERROR, format, args);
    va_end(args);
    return status;
}

#endif
