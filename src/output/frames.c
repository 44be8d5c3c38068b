/* Frame lists and the file names of sequences, as sfumato.h has them. */
#include "sfumato/sfumato.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/log.h"

enum {
    FRAME_MAX = 9999999,       /* the highest frame number */
    FRAME_COUNT_MAX = 1000000, /* the most frames in one list */
    PLACE_DIGITS_MAX = 10,
};

struct frames {
    uint32_t *list;
    size_t count, capacity;
};

struct reader {
    const char *text, *at;
    const struct sf_log *log;
};

static enum sf_status reject(const struct reader *reader, const char *at, const char *why)
{
    return sf_fail(reader->log, SF_ERROR_USAGE, "frame list '%.200s', character %zu: %s", reader->text,
                   (size_t)(at - reader->text) + 1, why);
}

static void skip_blanks(struct reader *reader)
{
    while (*reader->at == ' ' || *reader->at == '\t')
        reader->at++;
}

static enum sf_status read_number(struct reader *reader, const char *what, uint32_t *number)
{
    const char *start;
    char why[96];

    skip_blanks(reader);
    start = reader->at;
    *number = 0;
    for (; *reader->at >= '0' && *reader->at <= '9'; reader->at++) {
        *number = *number * 10 + (uint32_t)(*reader->at - '0');
        if (*number > FRAME_MAX) {
            snprintf(why, sizeof why, "%s is more than %d", what, FRAME_MAX);
            return reject(reader, start, why);
        }
    }
    if (reader->at == start) {
        if (*start == '-')
            snprintf(why, sizeof why, "%s must not be negative", what);
        else
            snprintf(why, sizeof why, "expected %s", what);
        return reject(reader, start, why);
    }
    skip_blanks(reader);
    return SF_OK;
}

struct range {
    uint32_t first, last, step;
};

static enum sf_status read_range(struct reader *reader, struct range *range)
{
    const char *start = reader->at;
    enum sf_status status = read_number(reader, "a frame number", &range->first);

    range->last = range->first;
    range->step = 1;
    if (status != SF_OK || *reader->at != '-')
        return status;
    reader->at++;
    status = read_number(reader, "the range's last frame", &range->last);
    if (status != SF_OK)
        return status;
    if (range->last < range->first)
        return reject(reader, start, "the range runs backwards");
    if (*reader->at != 'x')
        return SF_OK;
    reader->at++;
    start = reader->at;
    status = read_number(reader, "the range's step", &range->step);
    if (status == SF_OK && range->step == 0)
        return reject(reader, start, "the range's step must be at least 1");
    return status;
}

/* `seen` holds one bit for each frame number. */
static enum sf_status add_range(struct reader *reader, const char *start, const struct range *range, uint8_t *seen,
                                struct frames *frames)
{
    for (uint32_t frame = range->first; frame <= range->last; frame += range->step) {
        uint8_t bit = (uint8_t)(1u << frame % 8);

        if (seen[frame / 8] & bit)
            continue;
        seen[frame / 8] |= bit;
        if (frames->count == FRAME_COUNT_MAX)
            return reject(reader, start, "more than 1000000 frames");
        if (!sf_array_reserve((void **)&frames->list, frames->count, &frames->capacity, 1, sizeof *frames->list))
            return sf_fail(reader->log, SF_ERROR_MEMORY, "out of memory for the frame list");
        frames->list[frames->count++] = frame;
    }
    return SF_OK;
}

enum sf_status sf_frames_parse(const char *text, const struct sf_log *log, uint32_t **list, size_t *count)
{
    struct reader reader = {.text = text, .at = text, .log = log};
    uint8_t *seen = calloc(FRAME_MAX / 8 + 1, 1);
    struct frames frames = {0};
    enum sf_status status = SF_OK;

    *list = NULL;
    *count = 0;
    if (!seen)
        return sf_fail(log, SF_ERROR_MEMORY, "out of memory for the frame list");
    for (;;) {
        const char *start = reader.at;
        struct range range;

        status = read_range(&reader, &range);
        if (status == SF_OK)
            status = add_range(&reader, start, &range, seen, &frames);
        if (status != SF_OK || *reader.at == '\0')
            break;
        if (*reader.at != ',') {
            status =
                reject(&reader, reader.at, "expected a comma or the end (a range is FIRST-LAST or FIRST-LASTxSTEP)");
            break;
        }
        reader.at++;
    }
    free(seen);
    if (status != SF_OK) {
        free(frames.list);
        return status;
    }
    *list = frames.list;
    *count = frames.count;
    return SF_OK;
}

/* Where a pattern wants its number: a run of # (so many digits, zeros in front), or %d, or %04d, in the file name;
 * folders are taken as they are. "%%" stands for a percent sign. A number that is longer is written in full. */
struct place {
    size_t at, length; /* bytes of the pattern that the number replaces; length 0: none */
    int digits;        /* at least so many, with zeros in front */
};

static const char *file_name(const char *pattern)
{
    const char *slash = strrchr(pattern, '/');

    return slash ? slash + 1 : pattern;
}

/* The length of a conversion %d or %0Nd at `text`, 0 when it is another. */
static size_t conversion(const char *text, int *digits)
{
    size_t i = 1;

    *digits = 1;
    if (text[i] == '0') {
        for (*digits = 0, i++; text[i] >= '0' && text[i] <= '9' && *digits <= PLACE_DIGITS_MAX; i++)
            *digits = *digits * 10 + (text[i] - '0');
        if (*digits < 1 || *digits > PLACE_DIGITS_MAX)
            return 0;
    }
    return text[i] == 'd' ? i + 1 : 0;
}

/* Finds the place; NULL, or what is wrong with the pattern. */
static const char *find_place(const char *pattern, struct place *place)
{
    const char *name = file_name(pattern);

    *place = (struct place){0};
    if (*name == '\0')
        return "it has no file name";
    for (const char *c = name; *c; c++) {
        struct place found = {.at = (size_t)(c - pattern)};

        if (*c == '#') {
            found.length = strspn(c, "#");
            if (found.length > PLACE_DIGITS_MAX)
                return "a run of # is at most 10 long";
            found.digits = (int)found.length;
        } else if (c[0] == '%' && c[1] == '%') {
            c++;
            continue;
        } else if (*c == '%') {
            found.length = conversion(c, &found.digits);
            if (found.length == 0)
                return "after % only d, a width such as 04d, or another % may stand";
        } else {
            continue;
        }
        if (place->length > 0)
            return "it has more than one place for the frame number";
        *place = found;
        c += found.length - 1;
    }
    return NULL;
}

enum sf_status sf_sequence_name(const char *pattern, uint32_t frame, bool many, const struct sf_log *log, char **path)
{
    size_t folder = (size_t)(file_name(pattern) - pattern), size = strlen(pattern) + PLACE_DIGITS_MAX + 1,
           used = folder;
    struct place place;
    const char *wrong = find_place(pattern, &place);

    *path = NULL;
    if (!wrong && place.length == 0 && many)
        wrong =
            "it has no place (#### or %04d in its file name) for the frame number, and there is more than one frame";
    if (wrong)
        return sf_fail(log, SF_ERROR_USAGE, "output name '%.1000s': %s", pattern, wrong);
    *path = malloc(size);
    if (!*path)
        return sf_fail(log, SF_ERROR_MEMORY, "out of memory for output names");
    memcpy(*path, pattern, folder);
    for (size_t i = folder; pattern[i];) {
        if (place.length > 0 && i == place.at) {
            used += (size_t)snprintf(*path + used, size - used, "%0*u", place.digits, (unsigned)frame);
            i += place.length;
        } else {
            (*path)[used++] = pattern[i];
            i += pattern[i] == '%' ? 2 : 1; /* only "%%" can stand here */
        }
    }
    (*path)[used] = '\0';
    return SF_OK;
}
