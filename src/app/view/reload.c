#include "reload.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compiler.h"
#include "includes.h"
#include "log_line.h"

enum { COMPILERS_MAX = 16, REASON_BYTES = 1200, LINE_BYTES = 1024 };
static const uint64_t LOOK_NS = 250000000;

struct shader {
    const char *name;
    uint32_t file;
    bool stale;   /* what it is made of has changed since it was last compiled */
    char *errors; /* lines, each ended by '\n'; NULL: none */
};

struct sf_reload {
    struct sf_device *device;
    const struct sf_log *log;
    struct sf_compiler *compiler;
    struct sf_includes *includes;
    struct shader *shaders;
    uint32_t shader_count;
    struct sf_compilation running[COMPILERS_MAX]; /* slot: the shader */
    uint32_t lanes;                               /* of `running` that are used: one a core */
    char *errors;                                 /* of all shaders, each line once; NULL: none */
    uint64_t looked_ns, count;
};

static bool add_shaders(struct sf_reload *reload)
{
    uint32_t count = 0;

    while (sf_shader_name(count))
        count++;
    if (!(reload->shaders = calloc((size_t)count + 1, sizeof *reload->shaders)))
        return false;
    for (; reload->shader_count < count; reload->shader_count++) {
        struct shader *shader = &reload->shaders[reload->shader_count];

        shader->name = sf_shader_name(reload->shader_count);
        if (!sf_includes_add(reload->includes, shader->name, &shader->file))
            return false;
    }
    return true;
}

enum sf_status sf_reload_create(const char *folder, struct sf_device *device, const struct sf_log *log,
                                struct sf_reload **reload)
{
    struct sf_reload *made = calloc(1, sizeof *made);
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    char reason[REASON_BYTES];

    *reload = NULL;
    if (!made)
        return sf_log_fail(log, SF_ERROR_MEMORY, "out of memory");
    made->device = device;
    made->log = log;
    made->lanes = cores < 1 ? 1 : cores > COMPILERS_MAX ? COMPILERS_MAX : (uint32_t)cores;
    if (!(made->compiler = sf_compiler_create(folder, reason, sizeof reason))) {
        sf_log_line(log, SF_LOG_INFO, "shaders are not watched: %s", reason);
        sf_reload_destroy(&made);
        return SF_OK;
    }
    made->includes = sf_includes_create(folder);
    if (!made->includes || !add_shaders(made)) {
        sf_reload_destroy(&made);
        return sf_log_fail(log, SF_ERROR_MEMORY, "out of memory");
    }
    sf_includes_look(made->includes);
    *reload = made;
    return SF_OK;
}

static void drop_files(struct sf_reload *reload, uint32_t slot)
{
    char *errors;
    size_t bytes;

    free(sf_compilation_take(reload->compiler, reload->shaders[slot].name, slot, -1, &bytes, &errors));
    free(errors);
}

void sf_reload_destroy(struct sf_reload **reload)
{
    struct sf_reload *gone = *reload;

    if (!gone)
        return;
    for (uint32_t i = 0; i < gone->lanes; i++) {
        bool runs = gone->running[i].process != 0;

        sf_compilation_kill(&gone->running[i]);
        if (runs)
            drop_files(gone, gone->running[i].slot);
    }
    for (uint32_t i = 0; i < gone->shader_count; i++)
        free(gone->shaders[i].errors);
    free(gone->shaders);
    free(gone->errors);
    sf_includes_destroy(&gone->includes);
    sf_compiler_destroy(&gone->compiler);
    free(gone);
    *reload = NULL;
}

/* ---- errors ---- */

/* Is the line one of those in `text`? A header's error comes from every shader that includes it. */
static bool has_line(const char *text, const char *line, size_t bytes)
{
    for (const char *at = text; at && *at; at = strchr(at, '\n') + 1)
        if (strncmp(at, line, bytes) == 0)
            return true;
    return false;
}

/* Joins all shaders' errors anew, and logs the lines that are news. */
static void join_errors(struct sf_reload *reload)
{
    size_t room = 1, used = 0;
    char *joined;

    for (uint32_t i = 0; i < reload->shader_count; i++)
        room += reload->shaders[i].errors ? strlen(reload->shaders[i].errors) : 0;
    if (!(joined = malloc(room)))
        return;
    joined[0] = '\0';
    for (uint32_t i = 0; i < reload->shader_count; i++)
        for (const char *at = reload->shaders[i].errors; at && *at;) {
            size_t bytes = strcspn(at, "\n") + 1;

            if (!has_line(joined, at, bytes)) {
                memcpy(joined + used, at, bytes);
                used += bytes;
                joined[used] = '\0';
                if (!has_line(reload->errors, at, bytes))
                    sf_log_line(reload->log, SF_LOG_WARNING, "%.*s", (int)bytes - 1, at);
            }
            at += bytes;
        }
    free(reload->errors);
    reload->errors = joined;
}

/* `errors` becomes the shader's; NULL: none. */
static void set_errors(struct sf_reload *reload, struct shader *shader, char *errors)
{
    bool changed = errors || shader->errors;

    free(shader->errors);
    shader->errors = errors;
    if (changed)
        join_errors(reload);
}

static void set_error(struct sf_reload *reload, struct shader *shader, const char *what, const char *why)
{
    char line[LINE_BYTES];

    snprintf(line, sizeof line, "%s/%s: %s: %s\n", sf_compiler_sources(reload->compiler), shader->name, what, why);
    set_errors(reload, shader, strdup(line));
}

/* ---- compiling ---- */

static void look(struct sf_reload *reload)
{
    sf_includes_look(reload->includes);
    for (uint32_t i = 0; i < reload->shader_count; i++) {
        struct shader *shader = &reload->shaders[i];

        if (!sf_includes_changed(reload->includes, shader->file))
            continue;
        shader->stale = sf_includes_exists(reload->includes, shader->file);
        if (!shader->stale) /* taken away: the last one that came stays */
            set_errors(reload, shader, NULL);
    }
}

/* A compiler has ended. What has changed since is compiled again, so its result is not wanted. */
static bool take_up(struct sf_reload *reload, uint32_t slot, int ended)
{
    struct shader *shader = &reload->shaders[slot];
    size_t bytes;
    char *errors;
    uint32_t *words = sf_compilation_take(reload->compiler, shader->name, slot, ended, &bytes, &errors);
    enum sf_status status = SF_OK;
    bool taken = words && !shader->stale;

    if (shader->stale) {
        free(errors);
    } else if (!words) {
        set_errors(reload, shader, errors);
    } else if ((status = sf_device_set_shader(reload->device, shader->name, words, bytes)) != SF_OK) {
        set_error(reload, shader, "compiles, but the device does not take it", sf_status_name(status));
        taken = false;
    } else {
        set_errors(reload, shader, NULL);
        reload->count++;
        sf_log_line(reload->log, SF_LOG_INFO, "%s/%s: taken up", sf_compiler_sources(reload->compiler), shader->name);
    }
    free(words);
    return taken;
}

static bool is_running(const struct sf_reload *reload, uint32_t slot)
{
    for (uint32_t i = 0; i < reload->lanes; i++)
        if (reload->running[i].process && reload->running[i].slot == slot)
            return true;
    return false;
}

/* Compiles the next stale shader; false: there is none. */
static bool start_next(struct sf_reload *reload, struct sf_compilation *lane)
{
    for (uint32_t slot = 0; slot < reload->shader_count; slot++) {
        struct shader *shader = &reload->shaders[slot];

        if (!shader->stale || is_running(reload, slot))
            continue;
        shader->stale = false;
        if (sf_compilation_start(reload->compiler, shader->name, slot, lane))
            return true;
        set_error(reload, shader, "glslangValidator cannot be started", strerror(errno));
    }
    return false;
}

void sf_reload_poll(struct sf_reload *reload, uint64_t now_ns, bool *renewed)
{
    int ended;

    *renewed = false;
    if (now_ns - reload->looked_ns >= LOOK_NS) {
        reload->looked_ns = now_ns;
        look(reload);
    }
    for (uint32_t i = 0; i < reload->lanes; i++) {
        struct sf_compilation *lane = &reload->running[i];

        if (lane->process && sf_compilation_done(lane, &ended))
            *renewed |= take_up(reload, lane->slot, ended);
    }
    for (uint32_t i = 0; i < reload->lanes; i++)
        if (!reload->running[i].process && !start_next(reload, &reload->running[i]))
            break;
}

const char *sf_reload_errors(const struct sf_reload *reload)
{
    return reload->errors ? reload->errors : "";
}

bool sf_reload_busy(const struct sf_reload *reload)
{
    for (uint32_t i = 0; i < reload->lanes; i++)
        if (reload->running[i].process)
            return true;
    return false;
}

uint64_t sf_reload_count(const struct sf_reload *reload)
{
    return reload->count;
}
