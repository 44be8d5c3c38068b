#include "base/array.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ARENA_ALIGN = 16, ARENA_BLOCK_BYTES = 16 * 1024 };

bool sf_array_reserve(void **data, size_t count, size_t *capacity, size_t extra, size_t size)
{
    size_t wanted, limit = SIZE_MAX / 2 / (size ? size : 1);
    void *grown;

    if (extra > limit || count > limit - extra)
        return false;
    wanted = count + extra;
    if (wanted <= *capacity)
        return true;
    if (wanted < 8)
        wanted = 8;
    if (*capacity <= limit / 2 && wanted < *capacity * 2)
        wanted = *capacity * 2;
    grown = realloc(*data, wanted * (size ? size : 1));
    if (!grown)
        return false;
    *data = grown;
    *capacity = wanted;
    return true;
}

/* The newest block stands first; small requests are cut from it. */
struct sf_arena_block {
    struct sf_arena_block *next;
    unsigned char *cursor, *end;
};

static void *block_take(struct sf_arena_block *block, size_t size)
{
    uintptr_t misfit = (uintptr_t)block->cursor % ARENA_ALIGN;
    size_t pad = misfit ? ARENA_ALIGN - misfit : 0, room = (size_t)(block->end - block->cursor);
    unsigned char *place;

    if (room < pad || room - pad < size)
        return NULL;
    place = block->cursor + pad;
    block->cursor = place + size;
    return place;
}

void *sf_arena_alloc(struct sf_arena *arena, size_t size)
{
    struct sf_arena_block *block = arena->blocks;
    size_t payload = size > ARENA_BLOCK_BYTES / 4 ? size : ARENA_BLOCK_BYTES;
    void *place;

    if (size == 0)
        size = payload = 1;
    if (block && (place = block_take(block, size)))
        return place;
    if (payload > SIZE_MAX - sizeof *block - ARENA_ALIGN)
        return NULL;
    block = calloc(1, sizeof *block + ARENA_ALIGN + payload);
    if (!block)
        return NULL;
    block->cursor = (unsigned char *)(block + 1);
    block->end = block->cursor + ARENA_ALIGN + payload;
    if (arena->blocks && payload != ARENA_BLOCK_BYTES) {
        /* A block of its own goes behind the head, whose rest stays in use. */
        block->next = arena->blocks->next;
        arena->blocks->next = block;
    } else {
        block->next = arena->blocks;
        arena->blocks = block;
    }
    return block_take(block, size);
}

char *sf_arena_strdup(struct sf_arena *arena, const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = sf_arena_alloc(arena, size);

    return copy ? memcpy(copy, text, size) : NULL;
}

char *sf_arena_printf(struct sf_arena *arena, const char *format, ...)
{
    va_list args, again;
    char *text = NULL;
    int length;

    va_start(args, format);
    va_copy(again, args);
    length = vsnprintf(NULL, 0, format, args);
    if (length >= 0 && (text = sf_arena_alloc(arena, (size_t)length + 1)))
        vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    va_end(args);
    return text;
}

void sf_arena_finish(struct sf_arena *arena)
{
    if (!arena)
        return;
    while (arena->blocks) {
        struct sf_arena_block *next = arena->blocks->next;

        free(arena->blocks);
        arena->blocks = next;
    }
}

static bool text_reserve(struct sf_text *text, size_t extra)
{
    if (!text->failed && !sf_array_reserve((void **)&text->data, text->length, &text->capacity, extra + 1, 1))
        text->failed = true;
    return !text->failed;
}

void sf_text_printf(struct sf_text *text, const char *format, ...)
{
    va_list args, again;
    int length;

    va_start(args, format);
    va_copy(again, args);
    length = vsnprintf(NULL, 0, format, args);
    if (length < 0)
        text->failed = true;
    else if (text_reserve(text, (size_t)length)) {
        vsnprintf(text->data + text->length, (size_t)length + 1, format, again);
        text->length += (size_t)length;
    }
    va_end(again);
    va_end(args);
}

void sf_text_append(struct sf_text *text, const char *string)
{
    size_t length = strlen(string);

    if (!text_reserve(text, length))
        return;
    memcpy(text->data + text->length, string, length + 1);
    text->length += length;
}

void sf_text_finish(struct sf_text *text)
{
    if (!text)
        return;
    free(text->data);
    *text = (struct sf_text){0};
}
