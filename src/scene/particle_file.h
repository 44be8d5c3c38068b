/* Explicit particles from CSV and PLY files. Strict: every row must be whole, every number in its range, or the row is
 * named. */
#ifndef SF_SCENE_PARTICLE_FILE_H
#define SF_SCENE_PARTICLE_FILE_H

#include "params/params.h"
#include "scene/scene.h"

/* Reads by the name's ending (.csv, .ply). The list is in the arena; *hash is of the file's bytes. SF_ERROR_SCENE:
 * unsupported ending, malformed, out of range, more than SF_PARTICLES_MAX; SF_ERROR_IO; SF_ERROR_MEMORY. The messages
 * begin with the path. */
enum sf_status sf_particle_file_read(const char *path, struct sf_arena *arena, const struct sf_log *log,
                                     struct sf_listed **list, uint32_t *count, uint64_t *hash);

/* ---- between the readers ---- */

/* A column or property: a float of struct sf_listed and the row that has its range. */
struct sf_particle_column {
    const char *name;
    size_t offset;
    const struct sf_param *row;
};
enum { SF_PARTICLE_COLUMNS = 12, SF_PARTICLE_COLUMNS_REQUIRED = 5 };
/* Fills the known columns: x, y, z, radius, extinction, which every file has, then those that it may have. */
void sf_particle_columns(struct sf_particle_column columns[SF_PARTICLE_COLUMNS]);

struct sf_particle_source {
    const char *path;
    const char *data; /* zero-terminated */
    size_t size;
    const struct sf_log *log;
    struct sf_arena *arena;
    struct sf_particle_column known[SF_PARTICLE_COLUMNS];
    const struct sf_particle_column *columns[SF_PARTICLE_COLUMNS]; /* of this file, in its order */
    uint32_t column_count;
};
/* Adds the column of that name to the file's. `where` ("line 1", "property 3") is for messages. */
enum sf_status sf_particle_add_column(struct sf_particle_source *source, const char *name, const char *where);
/* All five columns that must be are there. */
enum sf_status sf_particle_check_columns(const struct sf_particle_source *source);
/* Checks and stores. `place` is "line" or "vertex". */
enum sf_status sf_particle_put(const struct sf_particle_source *source, const struct sf_particle_column *column,
                               double value, const char *place, size_t number, struct sf_listed *particle);
/* SF_ERROR_SCENE: the text of a number is none. */
enum sf_status sf_particle_not_a_number(const struct sf_particle_source *source,
                                        const struct sf_particle_column *column, const char *place, size_t number,
                                        const char *text, size_t length);
enum sf_status sf_particle_read_csv(struct sf_particle_source *source, struct sf_listed **list, uint32_t *count);
enum sf_status sf_particle_read_ply(struct sf_particle_source *source, struct sf_listed **list, uint32_t *count);

#endif
