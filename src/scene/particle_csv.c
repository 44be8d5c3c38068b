/* CSV: a header line that names the columns, then a line for each particle. '#' begins a comment line; empty lines are
 * passed over. */
#include <stdio.h>
#include <string.h>
#include "params/number.h"
#include "scene/particle_file.h"

enum { NAME_BYTES = 64 };

struct line {
    const char *start, *end; /* without the line's end */
    size_t number;           /* from 1 */
};

/* The next line that says something; false at the end of the file. */
static bool next_line(const struct sf_particle_source *source, const char **at, struct line *line)
{
    const char *last = source->data + source->size;

    while (*at < last) {
        const char *newline = memchr(*at, '\n', (size_t)(last - *at));

        line->start = *at;
        line->end = newline ? newline : last;
        line->number++;
        *at = newline ? newline + 1 : last;
        if (line->end > line->start && line->end[-1] == '\r')
            line->end--;
        while (line->start < line->end && (*line->start == ' ' || *line->start == '\t'))
            line->start++;
        if (line->start < line->end && *line->start != '#')
            return true;
    }
    return false;
}

/* The next field, trimmed, into [*start, *end); `*at` moves behind its comma, or to NULL after the last. */
static void next_field(const char **at, const char *line_end, const char **start, const char **end)
{
    const char *comma = memchr(*at, ',', (size_t)(line_end - *at));

    *start = *at;
    *end = comma ? comma : line_end;
    *at = comma ? comma + 1 : NULL;
    while (*start < *end && (**start == ' ' || **start == '\t'))
        ++*start;
    while (*start < *end && ((*end)[-1] == ' ' || (*end)[-1] == '\t'))
        --*end;
}

static enum sf_status read_header(struct sf_particle_source *source, const struct line *line)
{
    char name[NAME_BYTES], where[32];
    const char *start, *end;
    enum sf_status status;

    snprintf(where, sizeof where, "line %zu", line->number);
    for (const char *at = line->start; at;) {
        next_field(&at, line->end, &start, &end);
        snprintf(name, sizeof name, "%.*s", (int)(end - start < NAME_BYTES ? end - start : NAME_BYTES - 1), start);
        if ((status = sf_particle_add_column(source, name, where)) != SF_OK)
            return status;
    }
    return sf_particle_check_columns(source);
}

static enum sf_status read_row(const struct sf_particle_source *source, const struct line *line,
                               struct sf_listed *particle)
{
    const char *at = line->start, *start, *end;
    enum sf_status status;
    double value;

    for (uint32_t i = 0; i < source->column_count; i++) {
        const struct sf_particle_column *column = source->columns[i];

        if (!at)
            return sf_fail(source->log, SF_ERROR_SCENE, "%s: line %zu: %u fields, but the header names %u columns",
                           source->path, line->number, (unsigned)i, (unsigned)source->column_count);
        next_field(&at, line->end, &start, &end);
        if (!sf_number_parse(start, (size_t)(end - start), &value))
            return sf_particle_not_a_number(source, column, "line", line->number, start, (size_t)(end - start));
        if ((status = sf_particle_put(source, column, value, "line", line->number, particle)) != SF_OK)
            return status;
    }
    if (at)
        return sf_fail(source->log, SF_ERROR_SCENE,
                       "%s: line %zu: more fields than the %u columns that the header names", source->path,
                       line->number, (unsigned)source->column_count);
    return SF_OK;
}

enum sf_status sf_particle_read_csv(struct sf_particle_source *source, struct sf_listed **list, uint32_t *count)
{
    const char *at = source->data, *rest;
    struct line line = {NULL, NULL, 0}, counting;
    enum sf_status status;
    uint32_t n = 0;

    if (source->size >= 3 && memcmp(at, "\xef\xbb\xbf", 3) == 0)
        at += 3; /* the mark that some programs put before UTF-8 */
    if (!next_line(source, &at, &line))
        return sf_fail(source->log, SF_ERROR_SCENE, "%s: is empty; the first line names the columns", source->path);
    if ((status = read_header(source, &line)) != SF_OK)
        return status;
    counting = line;
    for (rest = at; next_line(source, &rest, &counting);)
        if (n++ == SF_PARTICLES_MAX)
            return sf_fail(source->log, SF_ERROR_SCENE, "%s: more than %d particles", source->path, SF_PARTICLES_MAX);
    if (!(*list = sf_arena_alloc(source->arena, n * sizeof **list)))
        return sf_fail(source->log, SF_ERROR_MEMORY, "%s: out of memory for %u particles", source->path, (unsigned)n);
    for (uint32_t i = 0; i < n && next_line(source, &at, &line); i++)
        if ((status = read_row(source, &line, &(*list)[i])) != SF_OK)
            return status;
    *count = n;
    return SF_OK;
}
