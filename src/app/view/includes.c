/* A name that is included is looked for beside the including file and in the folder that is given to the compiler by -I,
 * and both places are watched, whether there is a file or not: one that appears changes what is compiled. Lines that the
 * preprocessor leaves out count all the same, which costs a compilation and no more. */
#include "includes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_BYTES = 1024, NO_FILE = -1 };

struct source {
    char *name;       /* below the folder */
    int64_t stamp[2]; /* of the last change in ns, and bytes; NO_FILE: missing */
    bool waiting;     /* missing or empty at the last look */
    bool changed;
    bool read; /* its includes are known */
    uint32_t *includes;
    uint32_t count;
};

struct sf_includes {
    char *folder;
    struct source *sources;
    uint32_t count;
};

struct sf_includes *sf_includes_create(const char *folder)
{
    struct sf_includes *includes = calloc(1, sizeof *includes);

    if (includes && !(includes->folder = strdup(folder)))
        sf_includes_destroy(&includes);
    return includes;
}

void sf_includes_destroy(struct sf_includes **includes)
{
    struct sf_includes *gone = *includes;

    if (!gone)
        return;
    for (uint32_t i = 0; i < gone->count; i++) {
        free(gone->sources[i].name);
        free(gone->sources[i].includes);
    }
    free(gone->sources);
    free(gone->folder);
    free(gone);
    *includes = NULL;
}

static void stamp_of(const struct sf_includes *includes, const char *name, int64_t stamp[2])
{
    char path[PATH_BYTES];
    struct stat info;

    snprintf(path, sizeof path, "%s/%s", includes->folder, name);
    stamp[0] = 0;
    stamp[1] = NO_FILE;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return;
    stamp[0] = (int64_t)info.st_ctim.tv_sec * 1000000000 + info.st_ctim.tv_nsec;
    stamp[1] = (int64_t)info.st_size;
}

bool sf_includes_add(struct sf_includes *includes, const char *name, uint32_t *file)
{
    struct source *sources, source = {0};

    for (*file = 0; *file < includes->count; ++*file)
        if (strcmp(includes->sources[*file].name, name) == 0)
            return true;
    if (!(sources = realloc(includes->sources, ((size_t)includes->count + 1) * sizeof *sources)))
        return false;
    includes->sources = sources;
    if (!(source.name = strdup(name)))
        return false;
    stamp_of(includes, name, source.stamp);
    sources[includes->count++] = source;
    return true;
}

/* ---- reading ---- */

/* The name between quotes when the line includes one; "" else. */
static void included_name(const char *line, char name[PATH_BYTES])
{
    static const char word[] = "include", blanks[] = " \t";
    size_t bytes;

    name[0] = '\0';
    line += strspn(line, blanks);
    if (*line++ != '#')
        return;
    line += strspn(line, blanks);
    if (strncmp(line, word, sizeof word - 1) != 0)
        return;
    line += sizeof word - 1;
    line += strspn(line, blanks);
    if (*line++ != '"')
        return;
    bytes = strcspn(line, "\"\n");
    if (line[bytes] != '"' || bytes == 0 || bytes >= PATH_BYTES)
        return;
    memcpy(name, line, bytes);
    name[bytes] = '\0';
}

static bool add_include(struct sf_includes *includes, uint32_t file, const char *name)
{
    struct source *source;
    uint32_t *list, other;

    if (!sf_includes_add(includes, name, &other))
        return false;
    source = &includes->sources[file];
    if (!(list = realloc(source->includes, ((size_t)source->count + 1) * sizeof *list)))
        return false;
    source->includes = list;
    list[source->count++] = other;
    return true;
}

/* What the file includes, from its text. */
static void read_includes(struct sf_includes *includes, uint32_t file)
{
    char path[PATH_BYTES], line[PATH_BYTES], name[PATH_BYTES], beside[2 * PATH_BYTES];
    const char *own = includes->sources[file].name, *slash = strrchr(own, '/');
    int folder = slash ? (int)(slash + 1 - own) : 0;
    bool ok = true;
    FILE *stream;

    includes->sources[file].count = 0;
    snprintf(path, sizeof path, "%s/%s", includes->folder, own);
    includes->sources[file].read = true;
    if (!(stream = fopen(path, "r")))
        return;
    while (ok && fgets(line, sizeof line, stream)) {
        included_name(line, name);
        if (!name[0])
            continue;
        snprintf(beside, sizeof beside, "%.*s%s", folder, own, name);
        ok = add_include(includes, file, name) && add_include(includes, file, beside);
    }
    fclose(stream);
    includes->sources[file].read = ok; /* the list may have moved */
}

/* ---- looking ---- */

static void look_at(struct sf_includes *includes, struct source *source)
{
    int64_t stamp[2];

    source->changed = false;
    stamp_of(includes, source->name, stamp);
    if (stamp[0] == source->stamp[0] && stamp[1] == source->stamp[1]) {
        source->waiting = false;
        return;
    }
    if (stamp[1] <= 0 && !source->waiting) {
        source->waiting = true;
        return;
    }
    source->waiting = false;
    source->stamp[0] = stamp[0];
    source->stamp[1] = stamp[1];
    source->changed = true;
    source->read = false;
}

void sf_includes_look(struct sf_includes *includes)
{
    for (uint32_t i = 0; i < includes->count; i++)
        look_at(includes, &includes->sources[i]);
    /* The list grows while it is read. What finds no memory is read at the next look. */
    for (uint32_t i = 0; i < includes->count; i++)
        if (!includes->sources[i].read)
            read_includes(includes, i);
}

/* `seen` keeps circles from going on for ever. */
static bool reaches_change(const struct sf_includes *includes, uint32_t file, bool *seen)
{
    const struct source *source = &includes->sources[file];

    if (seen[file])
        return false;
    seen[file] = true;
    if (source->changed)
        return true;
    for (uint32_t i = 0; i < source->count; i++)
        if (reaches_change(includes, source->includes[i], seen))
            return true;
    return false;
}

bool sf_includes_changed(const struct sf_includes *includes, uint32_t file)
{
    bool *seen = calloc(includes->count, sizeof *seen);
    bool changed = !seen || reaches_change(includes, file, seen); /* in doubt it is compiled */

    free(seen);
    return changed;
}

bool sf_includes_exists(const struct sf_includes *includes, uint32_t file)
{
    return includes->sources[file].stamp[1] != NO_FILE;
}
