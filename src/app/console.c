#include "console.h"

#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

enum { MESSAGE_MAX = 4096, LINE_MAX_BYTES = 512 };

static struct {
    pthread_mutex_t lock;
    struct sf_log log;
    unsigned errors; /* printed so far */
    bool terminal, color;
    char line[LINE_MAX_BYTES]; /* the moving line as it stands; "" when there is none */
} console = {.lock = PTHREAD_MUTEX_INITIALIZER};

static volatile sig_atomic_t interrupted;

static void print_message(enum sf_log_level level, const char *message)
{
    static const char *const labels[] = {
        [SF_LOG_ERROR] = "error: ", [SF_LOG_WARNING] = "warning: ", [SF_LOG_INFO] = "", [SF_LOG_DEBUG] = "debug: "};
    static const char *const colors[] = {
        [SF_LOG_ERROR] = "\033[1;31m", [SF_LOG_WARNING] = "\033[1;33m", [SF_LOG_INFO] = "", [SF_LOG_DEBUG] = "\033[2m"};

    pthread_mutex_lock(&console.lock);
    console.errors += level == SF_LOG_ERROR;
    if (console.line[0])
        fputs("\r\033[K", stderr);
    if (console.color && colors[level][0])
        fprintf(stderr, "sfumato: %s%s\033[0m%s\n", colors[level], labels[level], message);
    else
        fprintf(stderr, "sfumato: %s%s\n", labels[level], message);
    if (console.line[0])
        fputs(console.line, stderr);
    fflush(stderr);
    pthread_mutex_unlock(&console.lock);
}

static void write_log(void *user, enum sf_log_level level, const char *message)
{
    const struct sf_log *log = user;

    if (level <= log->level)
        print_message(level, message);
}

void sf_console_start(enum sf_log_level level)
{
    const char *term = getenv("TERM"), *no_color = getenv("NO_COLOR");

    console.terminal = isatty(STDERR_FILENO) && (!term || strcmp(term, "dumb") != 0);
    console.color = console.terminal && !(no_color && *no_color);
    console.log = (struct sf_log){.write = write_log, .user = &console.log, .level = level};
}

const struct sf_log *sf_console_log(void)
{
    return &console.log;
}

unsigned sf_console_errors(void)
{
    unsigned errors;

    pthread_mutex_lock(&console.lock);
    errors = console.errors;
    pthread_mutex_unlock(&console.lock);
    return errors;
}

bool sf_console_moves(void)
{
    return console.terminal && !sf_console_quiet();
}

bool sf_console_quiet(void)
{
    return console.log.level == SF_LOG_ERROR;
}

void sf_console_say(enum sf_log_level level, const char *format, ...)
{
    char message[MESSAGE_MAX];
    va_list args;

    if (level > console.log.level)
        return;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    print_message(level, message);
}

enum sf_status sf_console_fail(enum sf_status status, const char *format, ...)
{
    char message[MESSAGE_MAX];
    va_list args;

    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    print_message(SF_LOG_ERROR, message);
    return status;
}

void sf_console_note(const char *format, ...)
{
    char message[MESSAGE_MAX];
    va_list args;

    if (sf_console_quiet())
        return;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    print_message(SF_LOG_INFO, message);
}

unsigned sf_console_width(void)
{
    struct winsize size;
    const char *columns = getenv("COLUMNS");

    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
        return size.ws_col;
    if (columns && atoi(columns) > 0)
        return (unsigned)atoi(columns);
    return 80;
}

void sf_console_line(const char *text)
{
    unsigned width = sf_console_width();
    size_t length;

    pthread_mutex_lock(&console.lock);
    if (text[0] || console.line[0]) {
        snprintf(console.line, sizeof console.line, "%s", text);
        length = strlen(console.line);
        /* One column short: a full line would wrap, and \r would then come back to the wrong one. */
        if (length >= width)
            console.line[width - 1] = '\0';
        fprintf(stderr, "\r\033[K%s", console.line);
        fflush(stderr);
    }
    pthread_mutex_unlock(&console.lock);
}

uint64_t sf_now_ns(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000u + (uint64_t)now.tv_nsec;
}

static void on_interrupt(int number)
{
    (void)number;
    interrupted = 1;
}

void sf_signals_start(void)
{
    static const int stops[] = {SIGINT, SIGTERM};
    /* The handler goes after its first call, so that the second signal does what it always does. */
    struct sigaction stop = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART | (int)SA_RESETHAND};
    struct sigaction ignore = {.sa_handler = SIG_IGN}, before;

    sigemptyset(&stop.sa_mask);
    sigemptyset(&ignore.sa_mask);
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++)
        if (sigaction(stops[i], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(stops[i], &stop, NULL);
    sigaction(SIGPIPE, &ignore, NULL);
}

bool sf_interrupted(void)
{
    return interrupted != 0;
}
