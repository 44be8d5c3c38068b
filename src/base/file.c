#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/thread.h"

enum { REASON_BYTES = 128, NAME_KEPT_BYTES = 180, TEMPORARY_TRIES = 100 };

/* strerror() that threads can share. */
static const char *reason(int error, char buffer[REASON_BYTES])
{
    if (strerror_r(error, buffer, REASON_BYTES) != 0)
        snprintf(buffer, REASON_BYTES, "error %d", error);
    return buffer;
}

static enum sf_status fail_errno(const struct sf_log *log, const char *what, const char *path, int error)
{
    char buffer[REASON_BYTES];

    return sf_fail(log, error == ENOMEM ? SF_ERROR_MEMORY : SF_ERROR_IO, "cannot %s '%s': %s", what, path,
                   reason(error, buffer));
}

/* Bytes of `path` up to and with its last slash; 0 when it has none. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');

    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* Reads to the end of the file, which may have grown since it was measured. */
static enum sf_status read_all(int fd, const char *path, size_t expected, size_t limit, const struct sf_log *log,
                               char **data, size_t *size)
{
    size_t capacity = expected + 2, used = 0; /* room to see the end without growing */
    char *bytes = malloc(capacity);

    while (bytes) {
        ssize_t got;

        if (used == capacity - 1) {
            size_t wider = capacity > (limit - 1) / 2 ? limit + 1 : capacity * 2 + 64;
            char *grown;

            if (used == limit)
                wider = capacity + 1; /* one byte more, to see whether the file goes on */
            grown = realloc(bytes, wider);
            if (!grown)
                break;
            bytes = grown;
            capacity = wider;
        }
        got = read(fd, bytes + used, capacity - 1 - used);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            int error = errno;

            free(bytes);
            return fail_errno(log, "read", path, error);
        }
        if (got == 0) {
            bytes[used] = '\0';
            *data = bytes;
            *size = used;
            return SF_OK;
        }
        used += (size_t)got;
        if (used > limit) {
            free(bytes);
            return sf_fail(log, SF_ERROR_IO, "cannot read '%s': larger than the limit of %zu bytes", path, limit);
        }
    }
    free(bytes);
    return sf_fail(log, SF_ERROR_MEMORY, "cannot read '%s': out of memory", path);
}

enum sf_status sf_file_read(const char *path, size_t limit, const struct sf_log *log, char **data, size_t *size)
{
    struct stat about;
    enum sf_status status;
    int fd, error;

    *data = NULL;
    *size = 0;
    if (limit > SIZE_MAX / 4)
        limit = SIZE_MAX / 4;
    /* O_NONBLOCK, or opening a pipe that nobody writes to would hang. */
    do
        fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    while (fd < 0 && errno == EINTR);
    if (fd < 0)
        return fail_errno(log, "open", path, errno);
    if (fstat(fd, &about) != 0) {
        error = errno;
        close(fd);
        return fail_errno(log, "read", path, error);
    }
    if (!S_ISREG(about.st_mode))
        status = sf_fail(log, SF_ERROR_IO, "cannot read '%s': %s", path,
                         S_ISDIR(about.st_mode) ? "it is a folder" : "it is not a regular file");
    else if (about.st_size > 0 && (uintmax_t)about.st_size > limit)
        status = sf_fail(log, SF_ERROR_IO, "cannot read '%s': its %jd bytes are more than the limit of %zu", path,
                         (intmax_t)about.st_size, limit);
    else
        status = read_all(fd, path, (size_t)about.st_size, limit, log, data, size);
    close(fd);
    return status;
}

/* "<folder>/.<name>.<random>.tmp", with the name cut (at a whole UTF-8 character) so that the file system takes it. */
static char *temporary_name(const char *path)
{
    static atomic_uint counter;
    size_t folder = folder_length(path), kept = strlen(path + folder), size;
    uint64_t mix = sf_clock_ns() ^ (uint64_t)getpid() << 40;
    unsigned turn = atomic_fetch_add(&counter, 1);
    char *name;

    if (kept > NAME_KEPT_BYTES) {
        kept = NAME_KEPT_BYTES;
        while (kept > 0 && ((unsigned char)path[folder + kept] & 0xC0u) == 0x80u)
            kept--;
    }
    size = folder + kept + 48;
    name = malloc(size);
    if (name)
        snprintf(name, size, "%.*s.%.*s.%016jx-%x.tmp", (int)folder, path, (int)kept, path + folder, (uintmax_t)mix,
                 turn);
    return name;
}

enum sf_status sf_file_writer_open(struct sf_file_writer *writer, const char *path, const struct sf_log *log)
{
    struct stat about;
    size_t length = strlen(path);
    int error = EEXIST;

    *writer = (struct sf_file_writer){.fd = -1};
    if (length == 0)
        return sf_fail(log, SF_ERROR_IO, "cannot write a file with an empty name");
    if (length > 1 << 20)
        return fail_errno(log, "write", "(a very long name)", ENAMETOOLONG);
    if (path[length - 1] == '/')
        return sf_fail(log, SF_ERROR_IO, "cannot write '%s': it names a folder", path);
    /* A rename over a device or a pipe would put a plain file in its place. */
    if (stat(path, &about) == 0 && !S_ISREG(about.st_mode))
        return sf_fail(log, SF_ERROR_IO, "cannot write '%s': %s", path,
                       S_ISDIR(about.st_mode) ? "it is a folder" : "it is not a regular file");
    writer->path = malloc(length + 1);
    if (!writer->path)
        return sf_fail(log, SF_ERROR_MEMORY, "cannot write '%s': out of memory", path);
    memcpy(writer->path, path, length + 1);
    for (unsigned i = 0; i < TEMPORARY_TRIES && (error == EEXIST || error == EINTR); i++) {
        free(writer->temporary);
        writer->temporary = temporary_name(path);
        if (!writer->temporary) {
            error = ENOMEM;
            break;
        }
        writer->fd = open(writer->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (writer->fd >= 0)
            return SF_OK;
        error = errno;
    }
    free(writer->temporary);
    writer->temporary = NULL;
    sf_file_writer_abort(writer);
    if (error == ENOENT)
        return sf_fail(log, SF_ERROR_IO, "cannot write '%s': its folder does not exist", path);
    return fail_errno(log, "write", path, error);
}

enum sf_status sf_file_writer_write(const struct sf_file_writer *writer, const void *data, size_t size, uint64_t offset,
                                    const struct sf_log *log)
{
    const char *bytes = data;

    while (size > 0) {
        size_t part = size < (size_t)1 << 30 ? size : (size_t)1 << 30;
        ssize_t put = pwrite(writer->fd, bytes, part, (off_t)offset);

        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return fail_errno(log, "write", writer->path, put < 0 ? errno : ENOSPC);
        bytes += put;
        size -= (size_t)put;
        offset += (uint64_t)put;
    }
    return SF_OK;
}

/* Makes a rename in the folder of `path` last. Not every file system can; only a failing disk counts. */
static int sync_folder(const char *path)
{
    size_t length = folder_length(path);
    char *folder = malloc(length + 2);
    int fd, error = 0;

    if (!folder)
        return ENOMEM;
    memcpy(folder, path, length);
    folder[length] = '\0';
    fd = open(length > 0 ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    free(folder);
    if (fd < 0)
        return 0; /* a folder may be writable and yet not readable */
    if (fsync(fd) != 0 && (errno == EIO || errno == ENOSPC || errno == EDQUOT))
        error = errno;
    close(fd);
    return error;
}

enum sf_status sf_file_writer_commit(struct sf_file_writer *writer, const struct sf_log *log)
{
    enum sf_status status = SF_OK;
    int error = 0, synced;

    do
        synced = fsync(writer->fd);
    while (synced != 0 && errno == EINTR);
    if (synced != 0 && errno != EINVAL && errno != ENOTSUP)
        error = errno;
    /* Some file systems (NFS) report a full disk only here. After EINTR Linux has closed it all the same. */
    if (close(writer->fd) != 0 && error == 0 && errno != EINTR)
        error = errno;
    writer->fd = -1;
    if (error == 0 && rename(writer->temporary, writer->path) != 0)
        error = errno;
    if (error == 0) {
        free(writer->temporary);
        writer->temporary = NULL;
        error = sync_folder(writer->path);
    }
    if (error != 0)
        status = fail_errno(log, "write", writer->path, error);
    sf_file_writer_abort(writer);
    return status;
}

void sf_file_writer_abort(struct sf_file_writer *writer)
{
    if (!writer)
        return;
    if (writer->temporary) {
        if (writer->fd >= 0)
            close(writer->fd);
        unlink(writer->temporary);
    }
    free(writer->temporary);
    free(writer->path);
    *writer = (struct sf_file_writer){.fd = -1};
}

enum sf_status sf_file_write(const char *path, const void *data, size_t size, const struct sf_log *log)
{
    struct sf_file_writer writer;
    enum sf_status status = sf_file_writer_open(&writer, path, log);

    if (status == SF_OK)
        status = sf_file_writer_write(&writer, data, size, 0, log);
    if (status == SF_OK)
        status = sf_file_writer_commit(&writer, log);
    sf_file_writer_abort(&writer);
    return status;
}

bool sf_file_exists(const char *path)
{
    struct stat about;

    return stat(path, &about) == 0;
}

enum sf_status sf_folder_create(const char *path, const struct sf_log *log)
{
    size_t length = strlen(path);
    struct stat about;
    char *partial;
    int error = 0;

    if (length == 0)
        return sf_fail(log, SF_ERROR_IO, "cannot create a folder with an empty name");
    partial = malloc(length + 1);
    if (!partial)
        return sf_fail(log, SF_ERROR_MEMORY, "cannot create folder '%s': out of memory", path);
    memcpy(partial, path, length + 1);
    for (size_t i = 1; i <= length && error == 0; i++) {
        if (path[i] != '/' && path[i] != '\0')
            continue;
        partial[i] = '\0';
        /* Another process may create it in between: what counts is that it is there afterwards. */
        if (mkdir(partial, 0777) != 0) {
            error = errno;
            if (stat(partial, &about) == 0 && S_ISDIR(about.st_mode))
                error = 0;
        }
        if (path[i] == '/')
            partial[i] = '/';
    }
    free(partial);
    return error == 0 ? SF_OK : fail_errno(log, "create folder", path, error);
}

char *sf_cache_path(const char *name)
{
    const char *base = getenv("XDG_CACHE_HOME"), *between = "/sfumato/";
    size_t size;
    char *path;

    /* The XDG base directory specification: a relative one is to be ignored. */
    if (!base || base[0] != '/') {
        base = getenv("HOME");
        between = "/.cache/sfumato/";
        if (!base || base[0] != '/')
            return NULL;
    }
    size = strlen(base) + strlen(between) + strlen(name) + 1;
    path = malloc(size);
    if (path)
        snprintf(path, size, "%s%s%s", base, between, name);
    return path;
}

char *sf_path_beside(const char *from, const char *name)
{
    size_t folder = name[0] == '/' ? 0 : folder_length(from), length = strlen(name);
    char *path = malloc(folder + length + 1);

    if (!path)
        return NULL;
    memcpy(path, from, folder);
    memcpy(path + folder, name, length + 1);
    return path;
}

bool sf_path_ends(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);

    if (length < tail)
        return false;
    for (size_t i = 0; i < tail; i++) {
        char c = path[length - tail + i];

        if ((c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c) != ending[i])
            return false;
    }
    return true;
}
