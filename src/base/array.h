/* A growing array of one element type, and an arena for things that die together. */
#ifndef SF_BASE_ARRAY_H
#define SF_BASE_ARRAY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/log.h"

#define SF_COUNT(a) (sizeof(a) / sizeof((a)[0]))

/* Makes room for `extra` more elements of `size` bytes in *data (capacity in elements); doubles. False when memory is
 * out, and then nothing has changed. Use: if (!sf_array_reserve((void **)&v, n, &cap, 1, sizeof *v)) ... v[n++] = x; */
bool sf_array_reserve(void **data, size_t count, size_t *capacity, size_t extra, size_t size);

/* A bump allocator: everything is freed at once. Zero-initialised memory, 16-byte aligned; NULL when memory is out. */
struct sf_arena {
    struct sf_arena_block *blocks;
};
void *sf_arena_alloc(struct sf_arena *arena, size_t size);
char *sf_arena_strdup(struct sf_arena *arena, const char *text);
char *sf_arena_printf(struct sf_arena *arena, const char *format, ...) SF_PRINTF(2, 3);
void sf_arena_finish(struct sf_arena *arena);

/* A growing, always terminated string; `failed` is sticky when memory runs out (check once at the end). */
struct sf_text {
    char *data;
    size_t length, capacity;
    bool failed;
};
void sf_text_printf(struct sf_text *text, const char *format, ...) SF_PRINTF(2, 3);
void sf_text_append(struct sf_text *text, const char *string);
void sf_text_finish(struct sf_text *text);

#endif
