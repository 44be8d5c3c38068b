/* The model for others: as a scene file, and as a command line. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "log_line.h"
#include "model.h"
#include "model_sets.h"

static bool merge(const struct sf_model *model, const char *const *extra, uint32_t count, struct sf_sets *sets)
{
    const struct sf_sets own = {.items = model->sets, .count = model->set_count};

    return sf_sets_merge(sets, &own, extra, count);
}

enum sf_status sf_model_save(const struct sf_model *model, const char *path, const char *const *extra, uint32_t count)
{
    struct sf_sets sets = {0};
    enum sf_status status;

    if (merge(model, extra, count, &sets))
        status =
            sf_scene_save(model->path, model->text, model->bytes, sf_sets_view(&sets), sets.count, path, model->log);
    else
        status = sf_log_fail(model->log, SF_ERROR_MEMORY, "%s: out of memory", path);
    sf_sets_finish(&sets);
    return status;
}

/* ---- the command line ---- */

/* One word for a POSIX shell: as it is when no character of it means anything there. */
static void put_word(FILE *stream, const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-+=:,./@%#";
    bool safe = word[0] && word[0] != '#' && !word[strspn(word, plain)];

    fputc(' ', stream);
    if (safe) {
        fputs(word, stream);
        return;
    }
    fputc('\'', stream);
    for (const char *c = word; *c; c++) {
        if (*c == '\'')
            fputs("'\\''", stream);
        else
            fputc(*c, stream);
    }
    fputc('\'', stream);
}

/* The path as an argument that is not taken for an option. malloc'ed. */
static char *operand_of(const char *path)
{
    size_t lead = path[0] == '-' ? 2 : 0, length = strlen(path);
    char *operand = malloc(lead + length + 1);

    if (!operand)
        return NULL;
    memcpy(operand, "./", lead);
    memcpy(operand + lead, path, length + 1);
    return operand;
}

/* "a/b.c.json" -> "b.c.####.png"; characters that would make another place for the number become '_'. */
static char *pattern_of(const char *path)
{
    static const char tail[] = ".####.png";
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name), lead = name[0] == '-' ? 2 : 0;
    char *pattern = malloc(lead + length + sizeof tail);

    if (!pattern)
        return NULL;
    memcpy(pattern, "./", lead);
    memcpy(pattern + lead, name, length);
    memcpy(pattern + lead + length, tail, sizeof tail);
    for (size_t i = lead; i < lead + length; i++)
        if (pattern[i] == '#' || pattern[i] == '%')
            pattern[i] = '_';
    return pattern;
}

static void put_command(FILE *stream, const char *path, const char *pattern, uint32_t frame, uint32_t width,
                        uint32_t height, const struct sf_sets *sets)
{
    fputs("sfumato capture", stream);
    put_word(stream, path);
    fprintf(stream, " --frames %u -s %ux%u", frame, width, height);
    for (uint32_t i = 0; i < sets->count; i++) {
        fputs(" --set", stream);
        put_word(stream, sets->items[i]);
    }
    fputs(" -o", stream);
    put_word(stream, pattern);
}

char *sf_model_command(const struct sf_model *model, uint32_t frame, uint32_t width, uint32_t height,
                       const char *const *extra, uint32_t count)
{
    struct sf_sets sets = {0};
    char *text = NULL, *path = operand_of(model->path), *pattern = pattern_of(model->path);
    size_t bytes = 0;
    bool ready = path && pattern && merge(model, extra, count, &sets);
    FILE *stream = ready ? open_memstream(&text, &bytes) : NULL;

    if (stream) {
        put_command(stream, path, pattern, frame, width, height, &sets);
        if (fclose(stream) != 0) {
            free(text);
            text = NULL;
        }
    }
    free(path);
    free(pattern);
    sf_sets_finish(&sets);
    return text;
}
