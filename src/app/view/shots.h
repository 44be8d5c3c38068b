/* Pictures from the viewer as files: screenshots and recorded sequences, PNG and EXR, written by threads beside the
 * drawing. */
#ifndef SF_APP_VIEW_SHOTS_H
#define SF_APP_VIEW_SHOTS_H

#include <stdbool.h>
#include <stdint.h>
#include "sfumato/sfumato.h"

struct sf_shots;
/* Files go into `folder`, made when first needed; `stem` is the scene's name without folder and extension. `log` is written
 * to by other threads as well. */
enum sf_status sf_shots_create(const char *folder, const struct sf_log *log, struct sf_shots **shots);
/* Waits for files that are being written. */
void sf_shots_destroy(struct sf_shots **shots);
/* Copies the frame (the renderer's memory is free again) and writes folder/stem.0048.png and .exr, with a number more
 * ("stem.0048-2.png") rather than over a file that exists. The paths are said at level info when written (those of a
 * sequence at level debug), failures as errors. Waits only while 4 frames are still to be written. */
enum sf_status sf_shots_take(struct sf_shots *shots, const char *stem, const struct sf_frame *frame, const char *tone,
                             float exposure, double fps, uint64_t scene_hash);
/* A sequence: a new folder/stem-001/ (counting on), said at level info, and all frames taken until the end go there as ####
 * of both kinds, whatever their stem. One that is being recorded ends first. */
enum sf_status sf_shots_record(struct sf_shots *shots, const char *stem);
void sf_shots_stop(struct sf_shots *shots);
bool sf_shots_recording(const struct sf_shots *shots);
uint32_t sf_shots_recorded(const struct sf_shots *shots); /* frames of this sequence */

#endif
