/* Whole files: read at once, or written so that the final name holds all of it or nothing. */
#ifndef SF_BASE_FILE_H
#define SF_BASE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/log.h"

/* Reads a regular file of at most `limit` bytes; *data is malloc'ed, has a terminating zero beyond `size`, and is the
 * caller's. SF_ERROR_IO when missing, not a regular file, unreadable or larger than `limit`; SF_ERROR_MEMORY. */
enum sf_status sf_file_read(const char *path, size_t limit, const struct sf_log *log, char **data, size_t *size);

/* Opens a temporary beside `path` (same folder), hands out its descriptor; commit fsyncs it, renames it to `path`,
 * fsyncs the folder. */
struct sf_file_writer {
    char *path, *temporary;
    int fd;
};
enum sf_status sf_file_writer_open(struct sf_file_writer *writer, const char *path, const struct sf_log *log);
/* Writes all of `size` bytes at `offset`; the error names the final file and the system's reason. Safe from several
 * threads at once. */
enum sf_status sf_file_writer_write(const struct sf_file_writer *writer, const void *data, size_t size, uint64_t offset,
                                    const struct sf_log *log);
/* On failure the temporary is gone and `path` is as it was. */
enum sf_status sf_file_writer_commit(struct sf_file_writer *writer, const struct sf_log *log);
/* Removes the temporary; also legal after commit or on a zeroed writer. */
void sf_file_writer_abort(struct sf_file_writer *writer);
enum sf_status sf_file_write(const char *path, const void *data, size_t size, const struct sf_log *log);

bool sf_file_exists(const char *path);
/* Creates `path` and its missing parents, mode 0777 less umask. */
enum sf_status sf_folder_create(const char *path, const struct sf_log *log);
/* <XDG_CACHE_HOME or ~/.cache>/sfumato/<name>, malloc'ed; NULL when there is no home. Does not create it. */
char *sf_cache_path(const char *name);
/* `name` seen from the folder of `from` (absolute names pass through); malloc'ed, NULL when memory is out. */
char *sf_path_beside(const char *from, const char *name);

/* Whether the name ends so; `ending` in lower case, the name in either: ".csv". */
bool sf_path_ends(const char *path, const char *ending);

#endif
