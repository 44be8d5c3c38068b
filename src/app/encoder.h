/* Worker threads that turn finished frames into files while the next ones are rendered. A frame sits in a slot until
 * all its files are written; the renderer's memory behind it must stay until then. */
#ifndef SF_APP_ENCODER_H
#define SF_APP_ENCODER_H

#include <stdbool.h>
#include "sfumato/sfumato.h"
#include "targets.h"

enum { SF_ENCODER_SLOTS_MAX = 8 };

struct sf_encoder_settings {
    struct sf_exr_options exr;
    const char *tone;
    float exposure; /* stops */
    bool inspected; /* write the inspected image and not the picture */
    const struct sf_target *targets;
    size_t target_count;
};

struct sf_encoder;
/* The settings' strings and targets must outlive it. */
enum sf_status sf_encoder_create(unsigned threads, const struct sf_encoder_settings *settings,
                                 struct sf_encoder **encoder);
/* Hands over a frame for slot 0..SF_ENCODER_SLOTS_MAX-1, which must be free. `paths`: one a target, NULL is passed
 * over; they must live as long. */
void sf_encoder_push(struct sf_encoder *encoder, unsigned slot, const struct sf_frame *frame, char *const *paths);
/* Waits until the slot is free. Gives the first failure of any file so far; after one, files that wait are not written
 * any more. */
enum sf_status sf_encoder_wait(struct sf_encoder *encoder, unsigned slot);
/* Frames of which every file is written. */
uint64_t sf_encoder_frames(struct sf_encoder *encoder);
/* Waits for everything, joins, frees, nulls; the first failure. */
enum sf_status sf_encoder_destroy(struct sf_encoder **encoder);

#endif
