#include "compiler.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PATH_BYTES = 1024, OUTPUT_BYTES_MAX = 1 << 16, WORDS_BYTES_MAX = 1 << 24, LINE_BYTES = 512 };

static const char program_name[] = "glslangValidator";
extern char **environ;

struct sf_compiler {
    char program[PATH_BYTES], sources[PATH_BYTES], folder[PATH_BYTES];
};

/* ---- where things are ---- */

/* Looks for the program as the shell does. */
static bool find_program(char program[PATH_BYTES])
{
    const char *at = getenv("PATH");

    while (at && *at) {
        size_t bytes = strcspn(at, ":");
        struct stat info;

        snprintf(program, PATH_BYTES, "%.*s/%s", bytes ? (int)bytes : 1, bytes ? at : ".", program_name);
        if (access(program, X_OK) == 0 && stat(program, &info) == 0 && S_ISREG(info.st_mode))
            return true;
        at += bytes + (at[bytes] == ':');
    }
    return false;
}

struct sf_compiler *sf_compiler_create(const char *sources, char *reason, size_t room)
{
    struct sf_compiler *compiler = calloc(1, sizeof *compiler);
    const char *base = getenv("TMPDIR");
    struct stat info;
    size_t bytes = strlen(sources);

    if (!compiler) {
        snprintf(reason, room, "out of memory");
        return NULL;
    }
    while (bytes > 1 && sources[bytes - 1] == '/')
        bytes--;
    snprintf(compiler->sources, sizeof compiler->sources, "%.*s", (int)bytes, sources);
    snprintf(compiler->folder, sizeof compiler->folder, "%s/sfumato-shaders-XXXXXX", base && *base ? base : "/tmp");
    if (stat(compiler->sources, &info) != 0 || !S_ISDIR(info.st_mode))
        snprintf(reason, room, "there is no folder %s here", compiler->sources);
    else if (!find_program(compiler->program))
        snprintf(reason, room, "%s is not installed", program_name);
    else if (!mkdtemp(compiler->folder))
        snprintf(reason, room, "%s: %s", compiler->folder, strerror(errno));
    else
        return compiler;
    free(compiler);
    return NULL;
}

void sf_compiler_destroy(struct sf_compiler **compiler)
{
    if (!*compiler)
        return;
    rmdir((*compiler)->folder);
    free(*compiler);
    *compiler = NULL;
}

const char *sf_compiler_sources(const struct sf_compiler *compiler)
{
    return compiler->sources;
}

static void output_path(const struct sf_compiler *compiler, uint32_t slot, const char *ending,
                        char path[PATH_BYTES + 32])
{
    snprintf(path, PATH_BYTES + 32, "%s/%u.%s", compiler->folder, slot, ending);
}

/* ---- the process ---- */

bool sf_compilation_start(const struct sf_compiler *compiler, const char *name, uint32_t slot,
                          struct sf_compilation *compilation)
{
    char includes[PATH_BYTES + 2], words[PATH_BYTES + 32], said[PATH_BYTES + 32], input[2 * PATH_BYTES];
    /* The options of spirv/meson.build. */
    char *arguments[] = {(char[]){"glslangValidator"},
                         (char[]){"-V"},
                         (char[]){"--target-env"},
                         (char[]){"vulkan1.3"},
                         (char[]){"-g0"},
                         (char[]){"--quiet"},
                         includes,
                         (char[]){"-o"},
                         words,
                         input,
                         NULL};
    posix_spawn_file_actions_t actions;
    int error;

    snprintf(includes, sizeof includes, "-I%s", compiler->sources);
    snprintf(input, sizeof input, "%s/%s", compiler->sources, name);
    output_path(compiler, slot, "spv", words);
    output_path(compiler, slot, "txt", said);
    if ((errno = posix_spawn_file_actions_init(&actions)) != 0)
        return false;
    error = posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (!error)
        error = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, said, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (!error)
        error = posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    if (!error)
        error = posix_spawn(&compilation->process, compiler->program, &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    compilation->slot = slot;
    if (error)
        compilation->process = 0;
    errno = error;
    return error == 0;
}

bool sf_compilation_done(struct sf_compilation *compilation, int *status)
{
    pid_t ended = waitpid(compilation->process, status, WNOHANG);

    if (ended == 0 || (ended < 0 && errno == EINTR))
        return false;
    if (ended < 0)
        *status = -1; /* children are not waited for where SIGCHLD was ignored at the start */
    compilation->process = 0;
    return true;
}

void sf_compilation_kill(struct sf_compilation *compilation)
{
    if (!compilation->process)
        return;
    kill(compilation->process, SIGKILL);
    while (waitpid(compilation->process, NULL, 0) < 0 && errno == EINTR)
        ;
    compilation->process = 0;
}

/* ---- what it has written ---- */

/* All of a file, with a zero behind; NULL: not there, empty or larger than `most`. Removes it. */
static char *take_file(const char *path, size_t most, size_t *bytes)
{
    int file = open(path, O_RDONLY | O_CLOEXEC);
    char *data = NULL;
    struct stat info;

    *bytes = 0;
    if (file >= 0 && fstat(file, &info) == 0 && info.st_size > 0 && (uint64_t)info.st_size <= most &&
        (data = malloc((size_t)info.st_size + 1))) {
        ssize_t got = read(file, data, (size_t)info.st_size);

        *bytes = got > 0 ? (size_t)got : 0;
        data[*bytes] = '\0';
    }
    if (file >= 0)
        close(file);
    unlink(path);
    return data;
}

/* Does "path:12: " stand at the start? Returns what follows, or NULL. */
static const char *skip_place(const char *line)
{
    for (const char *at = strchr(line, ':'); at; at = strchr(at + 1, ':')) {
        size_t digits = strspn(at + 1, "0123456789");

        if (digits && at[1 + digits] == ':' && at[2 + digits] == ' ')
            return at + 3 + digits;
    }
    return NULL;
}

static bool starts(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* One message of the compiler, without its "ERROR: ", as a line: "a:12: 'x' :  what " becomes "a:12: 'x': what". Messages
 * without a place get the shader's path. */
static void put_message(FILE *stream, const char *path, const char *message)
{
    const char *rest = skip_place(message), *gap;
    size_t bytes;

    if (rest)
        fprintf(stream, "%.*s", (int)(rest - message), message);
    else
        fprintf(stream, "%s: ", path);
    rest = rest ? rest : message;
    if ((gap = strstr(rest, " : "))) {
        if (!starts(rest, "'' "))
            fprintf(stream, "%.*s: ", (int)(gap - rest), rest);
        rest = gap + 3;
    }
    rest += strspn(rest, " ");
    for (bytes = strlen(rest); bytes > 0 && rest[bytes - 1] == ' ';)
        bytes--;
    fprintf(stream, "%.*s\n", (int)bytes, rest);
}

/* Of all that it says: the errors with their places; else those without. What follows from them is left out. */
static unsigned put_messages(FILE *stream, const char *path, const char *said, bool placed)
{
    static const char mark[] = "ERROR: ";
    unsigned count = 0;

    for (const char *at = said; at && *at;) {
        char line[LINE_BYTES];
        size_t bytes = strcspn(at, "\n");

        snprintf(line, sizeof line, "%.*s", (int)bytes, at);
        at += bytes + (at[bytes] == '\n');
        if (!starts(line, mark) || strstr(line, " : compilation terminated") || strstr(line, "compilation errors."))
            continue;
        if (placed == (skip_place(line + sizeof mark - 1) != NULL)) {
            put_message(stream, path, line + sizeof mark - 1);
            count++;
        }
    }
    return count;
}

static char *read_errors(const char *path, const char *said, int status)
{
    char *errors = NULL;
    size_t bytes = 0;
    FILE *stream = open_memstream(&errors, &bytes);

    if (!stream)
        return NULL;
    if (!put_messages(stream, path, said, true) && !put_messages(stream, path, said, false)) {
        if (status != -1 && WIFSIGNALED(status))
            fprintf(stream, "%s: %s was ended by signal %d\n", path, program_name, WTERMSIG(status));
        else
            fprintf(stream, "%s: %s gave no SPIR-V\n", path, program_name);
    }
    if (fclose(stream) != 0) {
        free(errors);
        errors = NULL;
    }
    return errors;
}

uint32_t *sf_compilation_take(const struct sf_compiler *compiler, const char *name, uint32_t slot, int status,
                              size_t *bytes, char **errors)
{
    char path[PATH_BYTES + 32], source[2 * PATH_BYTES], *words, *said;
    size_t said_bytes;

    output_path(compiler, slot, "spv", path);
    words = take_file(path, WORDS_BYTES_MAX, bytes);
    output_path(compiler, slot, "txt", path);
    said = take_file(path, OUTPUT_BYTES_MAX, &said_bytes);
    *errors = NULL;
    if (!words || !(status == -1 || (WIFEXITED(status) && WEXITSTATUS(status) == 0))) {
        snprintf(source, sizeof source, "%s/%s", compiler->sources, name);
        *errors = read_errors(source, said, status);
        free(words);
        words = NULL;
    }
    free(said);
    return (uint32_t *)(void *)words;
}
