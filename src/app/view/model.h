/* The scene being looked at: its file's text, what was changed over it, and the scene that both make. A change makes a new
 * scene from text and sets (a quarter of a millisecond); it takes the old one's place only when the renderer takes it. */
#ifndef SF_APP_VIEW_MODEL_H
#define SF_APP_VIEW_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include "sfumato/sfumato.h"

struct sf_model {
    char *path;
    char *text; /* of the file, as last read */
    size_t bytes;
    int64_t stamp[2]; /* of the file's last change (ns) and its size, when it was last looked at */
    char **sets;      /* "thick.steps=24": at most one a path, in the order of their first change; those of the command
                         line first */
    uint32_t set_count;
    char **own; /* what the file itself says, as sets of every control */
    uint32_t own_count;
    struct sf_scene *scene;
    struct sf_scene_info info;
    struct sf_control *controls; /* of the scene */
    uint32_t control_count;
    char error[1024];    /* why the file as it is now cannot be used; "" when it can */
    uint64_t missing_ns; /* since when it is missing or empty; 0: it is there */
    const struct sf_log *log;
    /* Offers a scene to whoever draws it; not OK: it is given back. NULL: nobody yet. */
    enum sf_status (*accept)(void *user, const struct sf_scene *scene);
    void *user;
};

/* Reads the file and makes the scene; `model` holds zeros but for log, accept and user. Finish in either case. */
enum sf_status sf_model_open(struct sf_model *model, const char *path, const char *const *sets, uint32_t set_count);
void sf_model_finish(struct sf_model *model);
/* Another file in this one's place, without sets; on failure the old one goes on, and the log has said why. */
enum sf_status sf_model_replace(struct sf_model *model, const char *path);
/* "path=value" over what is there. Setting what the file says takes the set away. Another type ("lights.0.type=spot") drops
 * those sets of its group that do not fit it, with a warning. On failure all stays, and the log has said why. */
enum sf_status sf_model_set(struct sf_model *model, const char *assignment);
/* Several at once (all or none). */
enum sf_status sf_model_set_many(struct sf_model *model, const char *const *assignments, uint32_t count);
/* The file's own value again; of everything when `path` is NULL. */
enum sf_status sf_model_reset(struct sf_model *model, const char *path);
bool sf_model_changed(const struct sf_model *model, const char *path);                     /* a set is over it */
const struct sf_control *sf_model_control(const struct sf_model *model, const char *path); /* NULL: no such */
/* Has the file changed on disk since it was read? Then it is read again, with the sets over it; a set that no longer fits
 * is dropped with a warning. A file that cannot be used leaves scene and text as they are, and `error` says why, the log
 * too; one that is missing or empty, as while an editor writes it, only after half a second. *renewed is whether a new
 * scene is in place. Cheap enough for every frame: one stat. */
void sf_model_watch(struct sf_model *model, bool *renewed);
/* Writes the scene with its sets, and `extra` sets over them, to a file. Extras that begin with a group's type
 * ("camera.type=fixed") stand for the whole group: the model's other sets of it go. */
enum sf_status sf_model_save(const struct sf_model *model, const char *path, const char *const *extra, uint32_t count);

/* "sfumato capture scenes/a.json --frames 48 -s 800x800 --set ... -o a.####.png", quoted for a POSIX shell: the capture of
 * exactly this frame. malloc'ed; NULL when memory is out. `extra`: sets of the camera, as for sf_model_save. */
char *sf_model_command(const struct sf_model *model, uint32_t frame, uint32_t width, uint32_t height,
                       const char *const *extra, uint32_t count);

#endif
