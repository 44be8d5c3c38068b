/* printf-style logging into the host's sf_log. */
#ifndef SF_BASE_LOG_H
#define SF_BASE_LOG_H

#include <stdarg.h>
#include "sfumato/log.h"
#include "sfumato/status.h"

#if defined(__GNUC__)
#define SF_PRINTF(string, first) __attribute__((format(printf, string, first)))
#else
#define SF_PRINTF(string, first)
#endif

/* `log` may be NULL. Lines longer than 2,000 bytes are cut, control characters become blanks. Thread safe: one lock for
 * the whole library gives every host's function one call at a time, so that function must not call back into the
 * library. */
void sf_log(const struct sf_log *log, enum sf_log_level level, const char *format, ...) SF_PRINTF(3, 4);
void sf_logv(const struct sf_log *log, enum sf_log_level level, const char *format, va_list args);

/* Logs an error and returns `status`, so that a failing line reads `return sf_fail(log, SF_ERROR_IO, "...")`. */
enum sf_status sf_fail(const struct sf_log *log, enum sf_status status, const char *format, ...) SF_PRINTF(3, 4);

#endif
