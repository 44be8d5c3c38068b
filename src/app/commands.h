/* The subcommands and their option tables. */
#ifndef SF_APP_COMMANDS_H
#define SF_APP_COMMANDS_H

#include "options.h"

/* A NULL name ends the list. */
extern const struct sf_command sf_commands[];

/* ---- inspect.c ---- */
enum sf_status sf_devices_run(const struct sf_arguments *arguments);
enum sf_status sf_graph_run(const struct sf_arguments *arguments);
enum sf_status sf_params_run(const struct sf_arguments *arguments);
enum sf_status sf_effect_run(const struct sf_arguments *arguments);
enum sf_status sf_check_run(const struct sf_arguments *arguments);

#endif
