/* For tests that write files: a scratch folder to work in, and a log that remembers. */
#ifndef SF_TESTS_SCRATCH_H
#define SF_TESTS_SCRATCH_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "sfumato/log.h"

/* The last error and how many there were. */
struct caught {
    char text[2048];
    unsigned errors;
};

static inline void caught_write(void *user, enum sf_log_level level, const char *message)
{
    struct caught *caught = user;

    if (level != SF_LOG_ERROR)
        return;
    snprintf(caught->text, sizeof caught->text, "%s", message);
    caught->errors++;
}

/* Passes when exactly one error was logged since the last look, and its line holds `part`. */
static inline void assert_caught(struct caught *caught, const char *part)
{
    if (caught->errors != 1 || !strstr(caught->text, part))
        fail_msg("expected one error with \"%s\", got %u: %s", part, caught->errors, caught->text);
    caught->errors = 0;
    caught->text[0] = '\0';
}

static inline void scratch_empty(const char *folder)
{
    DIR *list = opendir(folder);
    struct dirent *entry;

    while (list && (entry = readdir(list))) {
        size_t size = strlen(folder) + strlen(entry->d_name) + 2;
        char *path = malloc(size);
        struct stat about;

        if (path && strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            snprintf(path, size, "%s/%s", folder, entry->d_name);
            if (lstat(path, &about) == 0 && S_ISDIR(about.st_mode)) {
                chmod(path, 0700);
                scratch_empty(path);
                rmdir(path);
            } else {
                unlink(path);
            }
        }
        free(path);
    }
    if (list)
        closedir(list);
}

/* Entries of the folder, hidden ones too: a forgotten temporary shows. */
static inline unsigned scratch_count(const char *folder)
{
    DIR *list = opendir(folder);
    unsigned count = 0;

    while (list && readdir(list))
        count++;
    if (list)
        closedir(list);
    return count >= 2 ? count - 2 : 0;
}

/* cmocka group set-up: makes a folder of its own the working folder. */
static inline int scratch_enter(void **state)
{
    const char *base = getenv("TMPDIR");
    char *folder = malloc(4096);

    if (!folder)
        return -1;
    snprintf(folder, 4096, "%s/sfumato-test-XXXXXX", base ? base : "/tmp");
    *state = folder;
    return mkdtemp(folder) && chdir(folder) == 0 ? 0 : -1;
}

static inline int scratch_leave(void **state)
{
    char *folder = *state;

    scratch_empty(folder);
    if (chdir("/") != 0 || rmdir(folder) != 0)
        fprintf(stderr, "left behind: %s\n", folder);
    free(folder);
    return 0;
}

#endif
