/* Files that the program itself writes (reports), and what must hold before work begins. */
#ifndef SF_APP_FILES_H
#define SF_APP_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include "sfumato/status.h"

/* Is there a folder for `path` that can be written into, and is `path` not a folder itself? SF_ERROR_IO, with the
 * remedy. */
enum sf_status sf_folder_check(const char *path);
/* Besides that, does no file of that name exist, unless it may be replaced? */
enum sf_status sf_new_file_check(const char *path, bool overwrite);
/* `name` as seen from the current folder, from the program's, or from the one above that, where something of that name is
 * first found: malloc'ed. NULL when it is nowhere. */
char *sf_file_beside_program(const char *name);
/* The final name holds all of the text or what it held before; errno says why it could not be written. */
bool sf_file_replace(const char *path, const char *text, size_t length);
/* The same with an error on the console. "-" is standard output. */
enum sf_status sf_report_write(const char *path, const char *text, size_t length);
/* Flushes standard output and turns a lost write into SF_ERROR_IO; gives `status` back when that is an error already.
 */
enum sf_status sf_output_finish(enum sf_status status);

#endif
