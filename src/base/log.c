#include "base/log.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

enum { LINE_MAX_BYTES = 2000 };

/* One lock for all logs: a host sees one call at a time for each sf_log, and lines are rare enough not to contend. */
static pthread_mutex_t write_lock = PTHREAD_MUTEX_INITIALIZER;

/* Ends a line that was cut with dots, never in the middle of a UTF-8 sequence. `room` is the line's length. */
static void mark_cut(char *line, size_t room)
{
    size_t end = room - 3;

    while (end > 0 && ((unsigned char)line[end] & 0xC0u) == 0x80u)
        end--;
    memcpy(line + end, "...", 4);
}

void sf_logv(const struct sf_log *log, enum sf_log_level level, const char *format, va_list args)
{
    char line[LINE_MAX_BYTES + 1];
    int length;

    if (!log || !log->write || level > log->level)
        return;
    length = vsnprintf(line, sizeof line, format, args);
    if (length < 0)
        snprintf(line, sizeof line, "(a message that could not be formatted: %s)", format);
    else if (length > LINE_MAX_BYTES)
        mark_cut(line, LINE_MAX_BYTES);
    /* File names and scene text come from outside: one line stays one line, and no escape codes reach a terminal. */
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < 0x20u || *c == 0x7F)
            *c = ' ';
    pthread_mutex_lock(&write_lock);
    log->write(log->user, level, line);
    pthread_mutex_unlock(&write_lock);
}

void sf_log(const struct sf_log *log, enum sf_log_level level, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    sf_logv(log, level, format, args);
    va_end(args);
}

enum sf_status sf_fail(const struct sf_log *log, enum sf_status status, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    sf_logv(log, SF_LOG_ERROR, format, args);
    va_end(args);
    return status;
}
