/* The room's own view of the textures of sfumato.h. */
#ifndef SF_TEXTURE_TEXTURE_H
#define SF_TEXTURE_TEXTURE_H

#include "sfumato/sfumato.h"
#include "texture/field.h"

struct sf_texture_kind {
    const char *name;
    enum sf_field_kind field;
    bool clones;
};
/* NULL when there is none of that name. */
const struct sf_texture_kind *sf_texture_kind_find(const char *name);
/* SF_ERROR_USAGE names the option. */
enum sf_status sf_texture_options_check(const struct sf_texture_options *options, const struct sf_log *log);
/* All options that matter, on one line: malloc'ed, NULL when memory is out. */
char *sf_texture_options_print(const struct sf_texture_options *options);

struct sf_texture {
    struct sf_texture_info info; /* its planes are these: */
    float *color, *shape;
    char *made; /* from which options; NULL: read from a file */
};

/* With room for the pixels, all 0. NULL when memory is out. */
struct sf_texture *sf_texture_alloc(uint32_t width, uint32_t height, uint32_t tiles_x, uint32_t tiles_y);
/* Normals of the heights in texture->shape, tile by tile: central differences. */
void sf_texture_normals(struct sf_texture *texture);

#endif
