#include "files.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "console.h"

enum { PATH_BYTES = 4096 };

static char *folder_of(const char *path)
{
    char *copy = strdup(path), *folder = copy ? strdup(dirname(copy)) : NULL;

    free(copy);
    return folder;
}

enum sf_status sf_folder_check(const char *path)
{
    char *folder = folder_of(path);
    enum sf_status status = SF_OK;
    struct stat info;

    if (!folder)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    if (stat(folder, &info) != 0) {
        if (errno == ENOENT)
            status = sf_console_fail(SF_ERROR_IO, "%s: there is no folder %s (mkdir -p '%s')", path, folder, folder);
        else
            status = sf_console_fail(SF_ERROR_IO, "%s: folder %s: %s", path, folder, strerror(errno));
    } else if (!S_ISDIR(info.st_mode)) {
        status = sf_console_fail(SF_ERROR_IO, "%s: %s is not a folder", path, folder);
    } else if (access(folder, W_OK | X_OK) != 0) {
        status = sf_console_fail(SF_ERROR_IO, "%s: cannot write into folder %s: %s", path, folder, strerror(errno));
    } else if (stat(path, &info) == 0 && S_ISDIR(info.st_mode)) {
        status = sf_console_fail(SF_ERROR_IO, "%s: is a folder", path);
    }
    free(folder);
    return status;
}

enum sf_status sf_new_file_check(const char *path, bool overwrite)
{
    enum sf_status status = sf_folder_check(path);
    struct stat info;

    /* A dangling link is there as well: the rename would replace it. */
    if (!status && !overwrite && lstat(path, &info) == 0)
        status = sf_console_fail(SF_ERROR_IO, "%s: exists (--overwrite replaces it)", path);
    return status;
}

char *sf_file_beside_program(const char *name)
{
    static const char *const places[] = {"", "/", "/../"};
    char folder[PATH_BYTES], path[2 * PATH_BYTES];
    ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1); /* fails where the system does not tell */
    char *slash;

    folder[length > 0 ? length : 0] = '\0';
    slash = strrchr(folder, '/');
    if (slash)
        *slash = '\0';
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        if (i > 0 && !folder[0])
            continue;
        snprintf(path, sizeof path, "%s%s%s", i > 0 ? folder : "", places[i], name);
        if (access(path, F_OK) == 0)
            return strdup(path);
    }
    return NULL;
}

static bool write_all(int fd, const char *data, size_t size)
{
    while (size > 0) {
        ssize_t written = write(fd, data, size);

        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        data += written;
        size -= (size_t)written;
    }
    return true;
}

/* The rename itself must reach the disk too. Some file systems cannot sync a folder, which is no reason to fail. */
static void sync_folder(const char *path)
{
    char *folder = folder_of(path);
    int fd = folder ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;

    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
    free(folder);
}

bool sf_file_replace(const char *path, const char *text, size_t length)
{
    size_t room = strlen(path) + 32;
    char *temporary = malloc(room);
    bool written;
    int fd, error;

    if (!temporary)
        return false;
    snprintf(temporary, room, "%s.%ld.tmp", path, (long)getpid());
    fd = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    written = fd >= 0 && write_all(fd, text, length) && fsync(fd) == 0;
    error = errno;
    if (fd >= 0 && close(fd) != 0 && written) {
        written = false;
        error = errno;
    }
    if (written && rename(temporary, path) != 0) {
        written = false;
        error = errno;
    }
    if (!written && fd >= 0)
        unlink(temporary);
    free(temporary);
    if (written)
        sync_folder(path);
    errno = error;
    return written;
}

enum sf_status sf_report_write(const char *path, const char *text, size_t length)
{
    if (strcmp(path, "-") == 0) {
        fwrite(text, 1, length, stdout);
        return SF_OK;
    }
    if (sf_file_replace(path, text, length))
        return SF_OK;
    if (errno == ENOMEM)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    return sf_console_fail(SF_ERROR_IO, "%s: cannot be written: %s", path, strerror(errno));
}

enum sf_status sf_output_finish(enum sf_status status)
{
    /* An earlier write that failed has left its mark, though not its reason. */
    if (fflush(stdout) != 0)
        sf_console_fail(SF_ERROR_IO, "standard output: %s", strerror(errno));
    else if (ferror(stdout))
        sf_console_fail(SF_ERROR_IO, "standard output: could not be written");
    else
        return status;
    return status ? status : SF_ERROR_IO;
}
