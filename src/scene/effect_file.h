/* Reading and checking effect files, each once for a scene. */
#ifndef SF_SCENE_EFFECT_FILE_H
#define SF_SCENE_EFFECT_FILE_H

#include <sys/types.h>
#include "scene/effect.h"
#include "scene/load.h"

/* A file that has been read. Memory of the scene's arena. */
struct sf_effect_file {
    const char *name; /* seen from the scene's folder */
    const char *path; /* for messages */
    dev_t device;     /* with inode: the file itself, by whatever name */
    ino_t inode;
    struct sf_effect effect;
    struct sf_effect_file *next;
};

/* The file of that name, from `files` or from the disk, and then it is put in front of them and its hash stirred into scene->hash. `named`
 * is where its name stands: a file that cannot be read is an error there. What is in it is an error in the file itself. */
enum sf_status sf_effect_file_get(struct sf_scene *scene, const struct sf_param_reader *named, const char *name,
                                  struct sf_effect_file **files, const struct sf_effect_file **out);

#endif
