/* PLY: ascii 1.0 and binary_little_endian 1.0. The element "vertex" comes first and has scalar properties named as the
 * columns of a CSV file; elements after it are not looked at. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "params/number.h"
#include "scene/particle_file.h"

enum { LINE_BYTES = 256, WORDS = 5 };

enum scalar { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, SCALARS };
static const struct {
    const char *name, *alias;
    uint32_t bytes;
} scalars[SCALARS] = {
    {"char", "int8", 1}, {"uchar", "uint8", 1}, {"short", "int16", 2},   {"ushort", "uint16", 2},
    {"int", "int32", 4}, {"uint", "uint32", 4}, {"float", "float32", 4}, {"double", "float64", 8},
};

struct ply {
    struct sf_particle_source *source;
    const char *at, *end;
    size_t line; /* of the header, from 1 */
    bool binary, other_elements;
    uint64_t count;
    enum scalar types[SF_PARTICLE_COLUMNS];
};

static enum sf_status fail(const struct ply *ply, const char *what)
{
    return sf_fail(ply->source->log, SF_ERROR_SCENE, "%s: line %zu: %s", ply->source->path, ply->line, what);
}

/* The next line of the header, cut into words; the number of words, or -1 at the file's end and for a line that is too
 * long. */
static int next_words(struct ply *ply, char line[LINE_BYTES], char *words[WORDS])
{
    const char *newline = memchr(ply->at, '\n', (size_t)(ply->end - ply->at));
    size_t length = newline ? (size_t)(newline - ply->at) : 0;
    int n = 0;

    ply->line++;
    if (!newline || length >= LINE_BYTES)
        return -1;
    memcpy(line, ply->at, length);
    line[length] = '\0';
    ply->at = newline + 1;
    for (char *c = line; n < WORDS;) {
        c += strspn(c, " \t\r");
        if (!*c)
            break;
        words[n++] = c;
        c += strcspn(c, " \t\r");
        if (*c)
            *c++ = '\0';
    }
    return n;
}

static enum sf_status read_element(struct ply *ply, int n, char *words[WORDS], bool *inside)
{
    char *end;

    if (n != 3 || words[2][strspn(words[2], "0123456789")])
        return fail(ply, "expected: element NAME COUNT");
    if (strcmp(words[1], "vertex") != 0) {
        if (ply->source->column_count == 0)
            return fail(ply, "the first element must be vertex");
        ply->other_elements = true;
        *inside = false;
        return SF_OK;
    }
    if (*inside || ply->other_elements)
        return fail(ply, "the element vertex comes twice");
    ply->count = strtoull(words[2], &end, 10);
    if (ply->count > SF_PARTICLES_MAX) {
        char message[96];

        snprintf(message, sizeof message, "more than %d particles", SF_PARTICLES_MAX);
        return fail(ply, message);
    }
    *inside = true;
    return SF_OK;
}

static enum sf_status read_property(struct ply *ply, int n, char *words[WORDS], bool inside)
{
    struct sf_particle_source *source = ply->source;
    uint32_t column = source->column_count;
    char where[32];

    if (!inside) {
        if (!ply->other_elements)
            return fail(ply, "a property before any element");
        return SF_OK;
    }
    if (n != 3)
        return fail(ply, "expected: property TYPE NAME (particles have no lists)");
    for (int type = 0; type < SCALARS; type++) {
        if (strcmp(words[1], scalars[type].name) != 0 && strcmp(words[1], scalars[type].alias) != 0)
            continue;
        if (column < SF_PARTICLE_COLUMNS)
            ply->types[column] = (enum scalar)type;
        snprintf(where, sizeof where, "line %zu", ply->line);
        return sf_particle_add_column(source, words[2], where);
    }
    return fail(ply, "unknown type of property");
}

static enum sf_status read_header(struct ply *ply)
{
    char line[LINE_BYTES], *words[WORDS];
    bool inside = false, format = false;
    enum sf_status status = SF_OK;
    int n = next_words(ply, line, words);

    if (n != 1 || strcmp(words[0], "ply") != 0)
        return fail(ply, "not a PLY file");
    while (status == SF_OK) {
        if ((n = next_words(ply, line, words)) < 0)
            return fail(ply, "the header has no end_header, or a line of more than 255 bytes");
        if (n == 0 || strcmp(words[0], "comment") == 0 || strcmp(words[0], "obj_info") == 0)
            continue;
        if (strcmp(words[0], "end_header") == 0)
            break;
        if (strcmp(words[0], "format") == 0 && !format) {
            ply->binary = n == 3 && strcmp(words[1], "binary_little_endian") == 0;
            if (n != 3 || strcmp(words[2], "1.0") != 0 || (!ply->binary && strcmp(words[1], "ascii") != 0))
                return fail(ply, "unsupported format; ascii 1.0 and binary_little_endian 1.0 are read");
            format = true;
        } else if (strcmp(words[0], "element") == 0) {
            status = read_element(ply, n, words, &inside);
        } else if (strcmp(words[0], "property") == 0) {
            status = read_property(ply, n, words, inside);
        } else {
            return fail(ply, "expected format, comment, element, property or end_header");
        }
    }
    if (status == SF_OK && !format)
        return fail(ply, "the header names no format");
    return status != SF_OK ? status : sf_particle_check_columns(ply->source);
}

/* ---- rows ---- */

static double load_scalar(const unsigned char *bytes, enum scalar type)
{
    uint64_t word = 0;
    uint32_t narrow;
    float single;
    double wide;

    for (uint32_t i = 0; i < scalars[type].bytes; i++)
        word |= (uint64_t)bytes[i] << 8 * i;
    narrow = (uint32_t)word;
    switch (type) {
    case INT8:
        return (double)word - (word & 0x80 ? 256.0 : 0);
    case INT16:
        return (double)word - (word & 0x8000 ? 65536.0 : 0);
    case INT32:
        return (double)word - (word & 0x80000000 ? 4294967296.0 : 0);
    case FLOAT32:
        memcpy(&single, &narrow, sizeof single);
        return single;
    case FLOAT64:
        memcpy(&wide, &word, sizeof wide);
        return wide;
    default:
        return (double)word;
    }
}

static enum sf_status cut_short(const struct ply *ply, uint64_t row)
{
    return sf_fail(ply->source->log, SF_ERROR_SCENE,
                   "%s: is cut short: the header promises %llu vertices, the data end in vertex %llu",
                   ply->source->path, (unsigned long long)ply->count, (unsigned long long)row);
}

static enum sf_status read_binary(struct ply *ply, struct sf_listed *list)
{
    const struct sf_particle_source *source = ply->source;
    const unsigned char *at = (const unsigned char *)ply->at;
    uint64_t left = (uint64_t)(ply->end - ply->at), stride = 0;
    enum sf_status status;

    for (uint32_t i = 0; i < source->column_count; i++)
        stride += scalars[ply->types[i]].bytes;
    if (left / stride < ply->count)
        return cut_short(ply, left / stride);
    for (uint64_t row = 0; row < ply->count; row++) {
        for (uint32_t i = 0; i < source->column_count; i++) {
            double value = load_scalar(at, ply->types[i]);

            at += scalars[ply->types[i]].bytes;
            if ((status = sf_particle_put(source, source->columns[i], value, "vertex", (size_t)row, &list[row])) !=
                SF_OK)
                return status;
        }
    }
    if (left > stride * ply->count && !ply->other_elements)
        return sf_fail(source->log, SF_ERROR_SCENE, "%s: %llu bytes follow the last vertex", source->path,
                       (unsigned long long)(left - stride * ply->count));
    return SF_OK;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static enum sf_status read_ascii(struct ply *ply, struct sf_listed *list)
{
    const struct sf_particle_source *source = ply->source;
    const char *at = ply->at, *start;
    enum sf_status status;
    double value;

    for (uint64_t row = 0; row < ply->count; row++) {
        for (uint32_t i = 0; i < source->column_count; i++) {
            while (at < ply->end && is_space(*at))
                at++;
            for (start = at; at < ply->end && !is_space(*at);)
                at++;
            if (at == start)
                return cut_short(ply, row);
            if (!sf_number_parse(start, (size_t)(at - start), &value))
                return sf_particle_not_a_number(source, source->columns[i], "vertex", (size_t)row, start,
                                                (size_t)(at - start));
            if ((status = sf_particle_put(source, source->columns[i], value, "vertex", (size_t)row, &list[row])) !=
                SF_OK)
                return status;
        }
        while (at < ply->end && is_space(*at) && *at != '\n')
            at++;
        if (at < ply->end && *at != '\n')
            return sf_fail(source->log, SF_ERROR_SCENE, "%s: vertex %llu: more numbers than the %u properties",
                           source->path, (unsigned long long)row, (unsigned)source->column_count);
    }
    while (at < ply->end && is_space(*at))
        at++;
    if (at < ply->end && !ply->other_elements)
        return sf_fail(source->log, SF_ERROR_SCENE, "%s: something follows the last vertex", source->path);
    return SF_OK;
}

enum sf_status sf_particle_read_ply(struct sf_particle_source *source, struct sf_listed **list, uint32_t *count)
{
    struct ply ply = {.source = source, .at = source->data, .end = source->data + source->size};
    enum sf_status status = read_header(&ply);

    if (status != SF_OK)
        return status;
    /* Each number takes at least two bytes of ascii, so that a lying header cannot make us allocate. */
    if (!ply.binary && (uint64_t)(ply.end - ply.at) / source->column_count + 2 < ply.count)
        return cut_short(&ply, 0);
    if (!(*list = sf_arena_alloc(source->arena, (size_t)ply.count * sizeof **list)))
        return sf_fail(source->log, SF_ERROR_MEMORY, "%s: out of memory for %llu particles", source->path,
                       (unsigned long long)ply.count);
    status = ply.binary ? read_binary(&ply, *list) : read_ascii(&ply, *list);
    *count = (uint32_t)ply.count;
    return status;
}
