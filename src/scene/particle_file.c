#include "scene/particle_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"
#include "base/hash.h"
#include "base/suggest.h"
#include "params/json.h"
#include "params/number.h"
#include "scene/table.h"

#define FILE_BYTES_MAX ((size_t)1 << 30)

void sf_particle_columns(struct sf_particle_column columns[SF_PARTICLE_COLUMNS])
{
    static const struct {
        const char *name, *key;
        size_t offset;
    } known[SF_PARTICLE_COLUMNS] = {
        {"x", "centre", offsetof(struct sf_listed, centre)},
        {"y", "centre", offsetof(struct sf_listed, centre) + sizeof(float)},
        {"z", "centre", offsetof(struct sf_listed, centre) + 2 * sizeof(float)},
        {"radius", "radius", offsetof(struct sf_listed, radius)},
        {"extinction", "extinction", offsetof(struct sf_listed, extinction)},
        {"vx", "velocity", offsetof(struct sf_listed, velocity)},
        {"vy", "velocity", offsetof(struct sf_listed, velocity) + sizeof(float)},
        {"vz", "velocity", offsetof(struct sf_listed, velocity) + 2 * sizeof(float)},
        {"age", "age", offsetof(struct sf_listed, age)},
        {"lifetime", "lifetime", offsetof(struct sf_listed, lifetime)},
        {"tile", "tile", offsetof(struct sf_listed, tile)},
        {"rotation", "rotation", offsetof(struct sf_listed, rotation)},
    };
    for (int i = 0; i < SF_PARTICLE_COLUMNS; i++)
        columns[i] = (struct sf_particle_column){known[i].name, known[i].offset,
                                                 sf_param_find(&sf_scene_particle_group, known[i].key)};
}

enum sf_status sf_particle_add_column(struct sf_particle_source *source, const char *name, const char *where)
{
    const char *names[SF_PARTICLE_COLUMNS], *near;
    char shown[72];

    for (int i = 0; i < SF_PARTICLE_COLUMNS; i++) {
        names[i] = source->known[i].name;
        if (strcmp(names[i], name) != 0)
            continue;
        for (uint32_t j = 0; j < source->column_count; j++)
            if (source->columns[j] == &source->known[i])
                return sf_fail(source->log, SF_ERROR_SCENE, "%s: %s: '%s' comes twice", source->path, where, name);
        source->columns[source->column_count++] = &source->known[i];
        return SF_OK;
    }
    near = sf_suggest(name, names, SF_PARTICLE_COLUMNS);
    sf_param_clean(name, shown, sizeof shown);
    return sf_fail(source->log, SF_ERROR_SCENE, "%s: %s: unknown name '%s'%s%s%s", source->path, where, shown,
                   near ? ", did you mean " : "", near ? near : "", near ? "?" : "");
}

enum sf_status sf_particle_check_columns(const struct sf_particle_source *source)
{
    for (int i = 0; i < SF_PARTICLE_COLUMNS_REQUIRED; i++) {
        bool found = false;

        for (uint32_t j = 0; j < source->column_count; j++)
            found = found || source->columns[j] == &source->known[i];
        if (!found)
            return sf_fail(source->log, SF_ERROR_SCENE,
                           "%s: '%s' is missing; x, y, z, radius and extinction must be there", source->path,
                           source->known[i].name);
    }
    return SF_OK;
}

enum sf_status sf_particle_put(const struct sf_particle_source *source, const struct sf_particle_column *column,
                               double value, const char *place, size_t number, struct sf_listed *particle)
{
    char shown[SF_NUMBER_BYTES], range[SF_PARAM_RANGE_BYTES];
    float stored = (float)value;

    if (!sf_param_in_range(column->row, value)) {
        sf_number_show(value, shown);
        sf_param_range_text(column->row, range);
        return sf_fail(source->log, SF_ERROR_SCENE, "%s: %s %zu: %s: %s is out of range: %s", source->path, place,
                       number, column->name, shown, range);
    }
    if (column->offset == offsetof(struct sf_listed, tile) && value != floor(value))
        return sf_fail(source->log, SF_ERROR_SCENE, "%s: %s %zu: tile is not a whole number", source->path, place,
                       number);
    memcpy((char *)particle + column->offset, &stored, sizeof stored);
    return SF_OK;
}

enum sf_status sf_particle_not_a_number(const struct sf_particle_source *source,
                                        const struct sf_particle_column *column, const char *place, size_t number,
                                        const char *text, size_t length)
{
    char start[64], shown[48];

    snprintf(start, sizeof start, "%.*s", (int)(length < sizeof start ? length : sizeof start - 1), text);
    sf_param_clean(start, shown, sizeof shown);
    return sf_fail(source->log, SF_ERROR_SCENE, "%s: %s %zu: %s: '%s' is not a number", source->path, place, number,
                   column->name, shown);
}

enum sf_status sf_particle_file_read(const char *path, struct sf_arena *arena, const struct sf_log *log,
                                     struct sf_listed **list, uint32_t *count, uint64_t *hash)
{
    struct sf_particle_source source = {.path = path, .log = log, .arena = arena};
    bool csv = sf_path_ends(path, ".csv");
    enum sf_status status;
    char *data = NULL;

    if (!csv && !sf_path_ends(path, ".ply"))
        return sf_fail(log, SF_ERROR_SCENE, "%s: unsupported kind of file; particles come from .csv or .ply", path);
    if ((status = sf_file_read(path, FILE_BYTES_MAX, log, &data, &source.size)) != SF_OK)
        return status;
    source.data = data;
    *hash = sf_hash_bytes(data, source.size, 0);
    sf_particle_columns(source.known);
    status = csv ? sf_particle_read_csv(&source, list, count) : sf_particle_read_ply(&source, list, count);
    free(data);
    return status;
}
