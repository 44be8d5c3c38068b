/* Which files a capture is to write: made and checked in full before any work begins. */
#ifndef SF_APP_TARGETS_H
#define SF_APP_TARGETS_H

#include "options.h"

enum { SF_TARGETS_MAX = 8 };
enum sf_target_kind { SF_TARGET_EXR, SF_TARGET_PNG };

struct sf_target {
    char *pattern;
    enum sf_target_kind kind;
};

struct sf_targets {
    struct sf_target items[SF_TARGETS_MAX];
    size_t count;
    uint32_t *frames; /* [frame_count]: those with a file to write */
    size_t frame_count;
    char **paths; /* [frame_count][count]; NULL: exists already and is skipped */
    size_t files, skipped;
};

/* From -o, --frames, --overwrite and --skip-existing. `scene_path` names the files when there is no -o. SF_ERROR_USAGE:
 * a bad pattern, extension or frame list; SF_ERROR_IO: no folder to write into, or a file that exists. Finish in either
 * case. */
enum sf_status sf_targets_init(const struct sf_arguments *arguments, const char *scene_path,
                               struct sf_targets *targets);
void sf_targets_finish(struct sf_targets *targets);

#endif
