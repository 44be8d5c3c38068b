/* What several subcommands begin with: the scene with its sets, the device, and the checks that need both. */
#ifndef SF_APP_SESSION_H
#define SF_APP_SESSION_H

#include "options.h"
#include "sfumato/sfumato.h"

enum sf_status sf_session_scene(const struct sf_arguments *arguments, const char *path, struct sf_scene **scene);
/* The sets of --set, and of --method, as sf_scene_load wants them. */
enum sf_status sf_session_sets(const struct sf_arguments *arguments, char ***sets, uint32_t *count);
void sf_session_sets_finish(char **sets, uint32_t count);
/* `surface`: NULL unless it is for a window. */
enum sf_status sf_session_device(const struct sf_arguments *arguments, const struct sf_surface_source *surface,
                                 struct sf_device **device);
/* Can the device draw pictures of the size asked for? SF_ERROR_USAGE names its limit. */
enum sf_status sf_session_size(const struct sf_arguments *arguments, const struct sf_device *device);
/* SF_ERROR_INTERNAL when --validate was given and the layers have spoken. */
enum sf_status sf_session_validated(const struct sf_arguments *arguments, const struct sf_device *device);
/* The frame list of --frames, in order, malloc'ed. */
enum sf_status sf_session_frames(const struct sf_arguments *arguments, uint32_t **frames, size_t *count);
/* Steps the simulation up to `frame` with a progress line: for long ways. SF_ERROR_INTERRUPTED after Ctrl-C. */
enum sf_status sf_session_seek(struct sf_renderer *renderer, uint32_t frame);
/* All but the end of a picture that takes long, likewise. */
enum sf_status sf_session_refine(struct sf_renderer *renderer, uint32_t frame);

#endif
