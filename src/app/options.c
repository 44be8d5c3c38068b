#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"

enum { CANDIDATES_MAX = 64, WORD_MAX = 64, NAME_COLUMNS = 26 };

/* ---- "did you mean" ---- */

/* How many letters put in, taken out, replaced, or swapped with their neighbours turn one word into the other. */
static size_t edits(const char *a, const char *b)
{
    size_t rows[3][WORD_MAX + 1], length = strlen(b);

    for (size_t j = 0; j <= length; j++)
        rows[0][j] = j;
    for (size_t i = 1; a[i - 1]; i++) {
        const size_t *last = rows[(i - 1) % 3], *before = rows[(i + 1) % 3];
        size_t *row = rows[i % 3];

        row[0] = i;
        for (size_t j = 1; j <= length; j++) {
            size_t best = last[j - 1] + (a[i - 1] != b[j - 1]);

            if (last[j] + 1 < best)
                best = last[j] + 1;
            if (row[j - 1] + 1 < best)
                best = row[j - 1] + 1;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] && before[j - 2] + 1 < best)
                best = before[j - 2] + 1;
            row[j] = best;
        }
    }
    return rows[strlen(a) % 3][length];
}

const char *sf_nearest_word(const char *word, const char *const *candidates, size_t count)
{
    size_t length = strlen(word), limit = length / 3 > 1 ? length / 3 : 1;
    const char *found = NULL;

    if (length < 2 || length > WORD_MAX)
        return NULL;
    for (size_t i = 0; i < count; i++) {
        size_t distance;

        if (strlen(candidates[i]) > WORD_MAX)
            continue;
        distance = strncmp(candidates[i], word, length) == 0 ? 1 : edits(word, candidates[i]);
        if (distance <= limit && (!found || distance < limit)) {
            found = candidates[i];
            limit = distance;
        }
    }
    return found;
}

/* ---- values ---- */

static bool parse_unsigned(const char *text, char **end, uint64_t *value)
{
    if (text[0] < '0' || text[0] > '9')
        return false;
    errno = 0;
    *value = strtoull(text, end, 10);
    if (errno == ERANGE)
        *value = UINT64_MAX;
    return true;
}

enum sf_status sf_numbers_parse(const char *option, const char *text, uint32_t min, uint32_t max, uint32_t **numbers,
                                size_t *count)
{
    size_t room = 1;
    const char *at = text;

    for (const char *c = text; *c; c++)
        room += *c == ',';
    *count = 0;
    *numbers = calloc(room, sizeof **numbers);
    if (!*numbers)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    for (;;) {
        uint64_t value;
        char *end;

        if (!parse_unsigned(at, &end, &value) || value < min || value > max || (*end && *end != ',')) {
            free(*numbers);
            *numbers = NULL;
            return sf_console_fail(SF_ERROR_USAGE, "%s %s: must be whole numbers from %u to %u with commas between",
                                   option, text, min, max);
        }
        (*numbers)[(*count)++] = (uint32_t)value;
        if (!*end)
            return SF_OK;
        at = end + 1;
    }
}

static enum sf_status parse_number(const struct sf_option *row, const char *shown, const char *text, uint32_t *number)
{
    uint64_t value;
    char *end;

    if (!parse_unsigned(text, &end, &value) || *end || (double)value < row->min || (double)value > row->max)
        return sf_console_fail(SF_ERROR_USAGE, "%s %s: must be a whole number from %.0f to %.0f", shown, text, row->min,
                               row->max);
    *number = (uint32_t)value;
    return SF_OK;
}

static enum sf_status parse_real(const struct sf_option *row, const char *shown, const char *text,
                                 struct sf_argument_real *real)
{
    char *end;
    double value = strtod(text, &end);

    if (end == text || *end || !(value >= row->min && value <= row->max))
        return sf_console_fail(SF_ERROR_USAGE, "%s %s: must be a number from %g to %g", shown, text, row->min,
                               row->max);
    *real = (struct sf_argument_real){.given = true, .value = value};
    return SF_OK;
}

static enum sf_status parse_size(const struct sf_option *row, const char *shown, const char *text,
                                 struct sf_argument_size *size)
{
    bool grid = row->kind == SF_OPTION_GRID;
    uint64_t width, height;
    char *end;

    if (!parse_unsigned(text, &end, &width) || (*end != 'x' && *end != 'X') ||
        !parse_unsigned(end + 1, &end, &height) || *end)
        return sf_console_fail(SF_ERROR_USAGE, "%s %s: must be %s", shown, text,
                               grid ? "ACROSSxDOWN, such as 2x2" : "WIDTHxHEIGHT in pixels, such as 800x800");
    if ((double)width < row->min || (double)width > row->max || (double)height < row->min || (double)height > row->max)
        return sf_console_fail(SF_ERROR_USAGE, "%s %s: each side must be %.0f to %.0f%s", shown, text, row->min,
                               row->max, grid ? "" : " pixels");
    *size = (struct sf_argument_size){.width = (uint32_t)width, .height = (uint32_t)height};
    return SF_OK;
}

static enum sf_status parse_word(const struct sf_option *row, const char *shown, const char *text, const char **word)
{
    char known[256] = "";
    size_t count = 0, used = 0;
    const char *nearest;

    for (; row->words[count]; count++) {
        if (strcmp(row->words[count], text) == 0) {
            *word = row->words[count];
            return SF_OK;
        }
        if (used < sizeof known)
            used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", count ? ", " : "", row->words[count]);
    }
    nearest = sf_nearest_word(text, row->words, count);
    if (nearest)
        return sf_console_fail(SF_ERROR_USAGE, "%s %s: did you mean %s? (known: %s)", shown, text, nearest, known);
    return sf_console_fail(SF_ERROR_USAGE, "%s %s: must be one of %s", shown, text, known);
}

/* `shown` is the option as it was typed. Room for every item of a list was made at the start. */
static enum sf_status set_value(const struct sf_option *row, const char *shown, const char *text,
                                struct sf_arguments *arguments)
{
    void *field = (char *)arguments + row->offset;
    struct sf_argument_list *list = field;

    switch (row->kind) {
    case SF_OPTION_FLAG:
        *(bool *)field = true;
        return SF_OK;
    case SF_OPTION_COUNT:
        ++*(uint32_t *)field;
        return SF_OK;
    case SF_OPTION_TEXT:
    case SF_OPTION_LIST:
        if (!text[0])
            return sf_console_fail(SF_ERROR_USAGE, "%s: %s is empty", shown, row->value);
        if (row->kind == SF_OPTION_LIST)
            list->items[list->count++] = text;
        else
            *(const char **)field = text;
        return SF_OK;
    case SF_OPTION_WORD:
        return parse_word(row, shown, text, field);
    case SF_OPTION_NUMBER:
        return parse_number(row, shown, text, field);
    case SF_OPTION_REAL:
        return parse_real(row, shown, text, field);
    case SF_OPTION_SIZE:
    case SF_OPTION_GRID:
        return parse_size(row, shown, text, field);
    }
    return SF_ERROR_INTERNAL;
}

static bool takes_value(const struct sf_option *row)
{
    return row->kind != SF_OPTION_FLAG && row->kind != SF_OPTION_COUNT;
}

/* ---- the command line ---- */

static const struct sf_option *find_option(const struct sf_command *command, const char *name, size_t length,
                                           char letter)
{
    for (const struct sf_option *const *table = command->tables; *table; table++)
        for (const struct sf_option *row = *table; row->name; row++)
            if (letter ? row->letter == letter : strncmp(row->name, name, length) == 0 && !row->name[length])
                return row;
    return NULL;
}

static enum sf_status unknown_option(const struct sf_command *command, const char *shown, const char *name)
{
    const char *candidates[CANDIDATES_MAX], *nearest;
    size_t count = 0;

    for (const struct sf_option *const *table = command->tables; *table; table++)
        for (const struct sf_option *row = *table; row->name && count < CANDIDATES_MAX; row++)
            candidates[count++] = row->name;
    nearest = sf_nearest_word(name, candidates, count);
    if (nearest)
        return sf_console_fail(SF_ERROR_USAGE, "%s: unknown option %s; did you mean --%s?", command->name, shown,
                               nearest);
    return sf_console_fail(SF_ERROR_USAGE, "%s: unknown option %s (sfumato %s --help lists them)", command->name, shown,
                           command->name);
}

/* The value is the next argument; one that looks like a long option is taken for a forgotten value. */
static const char *next_value(int argc, char **argv, int *index)
{
    if (*index + 1 >= argc || strncmp(argv[*index + 1], "--", 2) == 0)
        return NULL;
    return argv[++*index];
}

static enum sf_status no_value(const struct sf_option *row, const char *shown)
{
    return sf_console_fail(SF_ERROR_USAGE, "%s: needs a value: %s", shown, row->value);
}

static enum sf_status parse_long(const struct sf_command *command, int argc, char **argv, int *index,
                                 struct sf_arguments *arguments)
{
    char shown[WORD_MAX + 3];
    const char *name = argv[*index] + 2, *equals = strchr(name, '='), *value;
    size_t length = equals ? (size_t)(equals - name) : strlen(name);
    const struct sf_option *row = find_option(command, name, length, 0);

    snprintf(shown, sizeof shown, "--%.*s", (int)(length < WORD_MAX ? length : WORD_MAX), name);
    if (!row)
        return unknown_option(command, shown, shown + 2);
    if (!takes_value(row)) {
        if (equals)
            return sf_console_fail(SF_ERROR_USAGE, "%s: takes no value", shown);
        return set_value(row, shown, NULL, arguments);
    }
    value = equals ? equals + 1 : next_value(argc, argv, index);
    return value ? set_value(row, shown, value, arguments) : no_value(row, shown);
}

/* "-o FILE", "-oFILE", "-o=FILE", and flags together as in "-vv". */
static enum sf_status parse_short(const struct sf_command *command, int argc, char **argv, int *index,
                                  struct sf_arguments *arguments)
{
    for (const char *at = argv[*index] + 1; *at; at++) {
        char shown[3] = {'-', *at, '\0'};
        const struct sf_option *row = find_option(command, NULL, 0, *at);
        enum sf_status status;

        if (!row)
            return unknown_option(command, argv[*index], argv[*index] + 1);
        if (takes_value(row)) {
            const char *value = at[1] == '=' ? at + 2 : at[1] ? at + 1 : next_value(argc, argv, index);

            return value ? set_value(row, shown, value, arguments) : no_value(row, shown);
        }
        status = set_value(row, shown, NULL, arguments);
        if (status)
            return status;
    }
    return SF_OK;
}

static enum sf_status start_arguments(const struct sf_command *command, int argc, struct sf_arguments *arguments)
{
    struct sf_argument_list *const lists[] = {&arguments->files, &arguments->sets, &arguments->outputs};
    enum sf_status status = SF_OK;

    memset(arguments, 0, sizeof *arguments);
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        lists[i]->items = calloc((size_t)argc + 1, sizeof *lists[i]->items);
        if (!lists[i]->items)
            return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    }
    for (const struct sf_option *const *table = command->tables; *table; table++)
        for (const struct sf_option *row = *table; row->name && !status; row++)
            if (row->initial)
                status = set_value(row, row->name, row->initial, arguments);
    return status;
}

enum sf_status sf_arguments_parse(const struct sf_command *command, int argc, char **argv,
                                  struct sf_arguments *arguments)
{
    enum sf_status status = start_arguments(command, argc, arguments);
    bool options = true;

    for (int i = 0; i < argc && !status; i++) {
        if (options && strcmp(argv[i], "--") == 0)
            options = false;
        else if (options && strncmp(argv[i], "--", 2) == 0)
            status = parse_long(command, argc, argv, &i, arguments);
        else if (options && argv[i][0] == '-' && argv[i][1])
            status = parse_short(command, argc, argv, &i, arguments);
        else
            arguments->files.items[arguments->files.count++] = argv[i];
    }
    if (status || arguments->help)
        return status;
    if (arguments->files.count < command->files_min)
        return sf_console_fail(SF_ERROR_USAGE, "%s: needs %s (sfumato %s --help)", command->name, command->operands,
                               command->name);
    if (arguments->files.count > command->files_max)
        return sf_console_fail(SF_ERROR_USAGE, "%s: too many arguments: %s", command->name,
                               arguments->files.items[command->files_max]);
    return SF_OK;
}

void sf_arguments_finish(struct sf_arguments *arguments)
{
    free(arguments->files.items);
    free(arguments->sets.items);
    free(arguments->outputs.items);
    memset(arguments, 0, sizeof *arguments);
}

/* ---- help ---- */

static void print_option(const struct sf_option *row)
{
    char left[64], letter[5] = "    ";

    if (row->letter)
        snprintf(letter, sizeof letter, "-%c, ", row->letter);
    snprintf(left, sizeof left, "%s--%s%s%s", letter, row->name, row->value ? " " : "", row->value ? row->value : "");
    printf("  %-*s %s", NAME_COLUMNS, left, row->doc);
    if (row->words) {
        printf(": ");
        for (size_t i = 0; row->words[i]; i++)
            printf("%s%s", i ? ", " : "", row->words[i]);
    }
    if (row->initial)
        printf(" [%s]", row->initial);
    putchar('\n');
}

void sf_command_help(const struct sf_command *command)
{
    printf("sfumato %s [OPTIONS]%s%s\n%s\n\n", command->name, command->operands[0] ? " " : "", command->operands,
           command->summary);
    for (const struct sf_option *const *table = command->tables; *table; table++)
        for (const struct sf_option *row = *table; row->name; row++)
            print_option(row);
    if (command->notes && command->notes[0])
        putchar('\n');
    for (size_t i = 0; command->notes && command->notes[i]; i++)
        printf("%s\n", command->notes[i]);
}
