/* glslangValidator as a process beside the drawing, and what it says. */
#ifndef SF_APP_VIEW_COMPILER_H
#define SF_APP_VIEW_COMPILER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

struct sf_compiler; /* where it is, and a folder of its own for what it writes */
/* NULL: *reason says why not. `sources`: the folder of the shaders. */
struct sf_compiler *sf_compiler_create(const char *sources, char *reason, size_t room);
/* Nothing may run any more. */
void sf_compiler_destroy(struct sf_compiler **compiler);
const char *sf_compiler_sources(const struct sf_compiler *compiler); /* the folder, as its messages have it */

struct sf_compilation {
    pid_t process; /* 0: none */
    uint32_t slot; /* of its files: no two running ones have the same */
};
/* Starts it for the shader of that name; never waits. False: errno says why. */
bool sf_compilation_start(const struct sf_compiler *compiler, const char *name, uint32_t slot,
                          struct sf_compilation *compilation);
bool sf_compilation_done(struct sf_compilation *compilation, int *status); /* as waitpid has it; -1: unknown */
void sf_compilation_kill(struct sf_compilation *compilation);
/* Once it is done: the SPIR-V, or NULL and what is wrong, a line each, ended by '\n' ("glsl/thick/march.comp:12: ...");
 * both malloc'ed. Both NULL: memory is out. Removes the files. */
uint32_t *sf_compilation_take(const struct sf_compiler *compiler, const char *name, uint32_t slot, int status,
                              size_t *bytes, char **errors);

#endif
