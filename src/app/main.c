/* sfumato: the program. Exit codes are enum sf_status. */
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "console.h"
#include "files.h"
#include "sfumato/sfumato.h"

enum { COMMANDS_MAX = 16 };

static void print_help(FILE *stream)
{
    fputs("sfumato COMMAND [OPTIONS] ...\nSmoke, fire and clouds in real time with Vulkan.\n\n", stream);
    for (const struct sf_command *command = sf_commands; command->name; command++)
        fprintf(stream, "  %-8s %-10s %s\n", command->name, command->operands, command->summary);
    fputs("  help     [COMMAND]  Prints this, or the options of a command.\n\n"
          "sfumato --version prints the version. Exit codes: 0 ok, 1 a defect of the program, 2 usage, 3 bad scene,\n"
          "4 no device, 5 device lost, 6 out of memory, 7 a file could not be read or written, 130 interrupted.\n",
          stream);
}

static const struct sf_command *find_command(const char *name)
{
    const char *names[COMMANDS_MAX], *nearest;
    size_t count = 0;

    for (const struct sf_command *command = sf_commands; command->name; command++) {
        if (strcmp(command->name, name) == 0)
            return command;
        names[count++] = command->name;
    }
    names[count++] = "help";
    nearest = sf_nearest_word(name, names, count);
    if (nearest)
        sf_console_fail(SF_ERROR_USAGE, "unknown command %s; did you mean %s?", name, nearest);
    else
        sf_console_fail(SF_ERROR_USAGE, "unknown command %s (sfumato help lists them)", name);
    return NULL;
}

static enum sf_status run_help(int argc, char **argv)
{
    const struct sf_command *command;

    if (argc == 0) {
        print_help(stdout);
        return SF_OK;
    }
    if (argc > 1)
        return sf_console_fail(SF_ERROR_USAGE, "help: too many arguments: %s", argv[1]);
    command = find_command(argv[0]);
    if (!command)
        return SF_ERROR_USAGE;
    sf_command_help(command);
    return SF_OK;
}

static enum sf_status run_command(const struct sf_command *command, int argc, char **argv)
{
    struct sf_arguments arguments;
    enum sf_status status = sf_arguments_parse(command, argc, argv, &arguments);

    if (!status && arguments.help) {
        sf_command_help(command);
    } else if (!status) {
        sf_console_start(arguments.quiet          ? SF_LOG_ERROR
                         : arguments.verbose == 0 ? SF_LOG_WARNING
                         : arguments.verbose == 1 ? SF_LOG_INFO
                                                  : SF_LOG_DEBUG);
        status = command->run(&arguments);
    }
    sf_arguments_finish(&arguments);
    return status;
}

static enum sf_status run(int argc, char **argv)
{
    const struct sf_command *command;

    if (argc < 2) {
        print_help(stderr);
        return SF_ERROR_USAGE;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("sfumato %s\n", SF_VERSION);
        return SF_OK;
    }
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)
        return run_help(argc - 2, argv + 2);
    if (argv[1][0] == '-')
        return sf_console_fail(SF_ERROR_USAGE, "%s: a command comes first (sfumato help lists them)", argv[1]);
    command = find_command(argv[1]);
    return command ? run_command(command, argc - 2, argv + 2) : SF_ERROR_USAGE;
}

int main(int argc, char **argv)
{
    sf_console_start(SF_LOG_WARNING);
    sf_signals_start();
    return sf_output_finish(run(argc, argv));
}
