/* Shaders that are edited while they run: watches the GLSL files, compiles what changed with glslangValidator beside the
 * drawing, and hands the result to the device. */
#ifndef SF_APP_VIEW_RELOAD_H
#define SF_APP_VIEW_RELOAD_H

#include <stdbool.h>
#include <stdint.h>
#include "sfumato/sfumato.h"

struct sf_reload;
/* `folder` holds the sources ("glsl"). When it is not there, or glslangValidator is not, or the compiler's files have no
 * place, *reload is NULL, and a line at level info says so: the viewer works without. The sources as they are now are taken
 * for those of the library. */
enum sf_status sf_reload_create(const char *folder, struct sf_device *device, const struct sf_log *log,
                                struct sf_reload **reload);
void sf_reload_destroy(struct sf_reload **reload); /* kills a compiler that still runs, removes its files */
/* Call each frame: looks at the files' times (4 times a second at most), starts compilers (one for each core at most, never
 * waiting), takes up finished ones. *renewed: a pipeline changed, the picture should be drawn again. The shaders that
 * include a changed file, over any number of steps, are compiled. */
void sf_reload_poll(struct sf_reload *reload, uint64_t now_ns, bool *renewed);
/* What is wrong now: compilers' messages with file and line ("glsl/thick/march.comp:12: ..."), one a line; "" when nothing
 * is. The shaders concerned stay as they were before, and the line goes when they are mended. Good until the next poll. */
const char *sf_reload_errors(const struct sf_reload *reload);
bool sf_reload_busy(const struct sf_reload *reload);      /* compilers are running */
uint64_t sf_reload_count(const struct sf_reload *reload); /* shaders taken up so far */

#endif
