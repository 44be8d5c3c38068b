/* The stages of loading, each in its file. All report through the reader, with the place in the scene file. */
#ifndef SF_SCENE_LOAD_H
#define SF_SCENE_LOAD_H

#include "params/json.h"
#include "scene/scene.h"

/* The tree of a file's text, the caller's. SF_ERROR_SCENE says where it is not JSON, or too large. `what`: "a scene". */
enum { SF_SCENE_MIB_MAX = 64 };
enum sf_status sf_scene_parse_json(const char *name, const char *what, const char *text, size_t bytes,
                                   const struct sf_log *log, json_t **tree);
/* The hash of the tree as it stands, keys in any order, without comments and $schema, which it takes out. */
enum sf_status sf_scene_hash_tree(const char *name, json_t *tree, const struct sf_log *log, uint64_t *hash);
/* Applies the sets to the tree in their order; afterwards they are the reader's (in its arena). */
enum sf_status sf_scene_apply_sets(struct sf_param_reader *reader, json_t *tree, const char *const *sets,
                                   uint32_t set_count);
/* What one key alone cannot say: directions have a length, keys ascend, the camera looks somewhere. Normalises
 * directions, and fills in values that depend on others. Before files are read. */
enum sf_status sf_scene_check(struct sf_scene *scene, struct sf_param_reader *reader);
/* The same of one light or emitter, which stands at the pointer `at`. */
enum sf_status sf_scene_check_light(struct sf_light *light, struct sf_param_reader *reader, const char *at);
enum sf_status sf_scene_check_emitter(const struct sf_scene *scene, struct sf_emitter *emitter,
                                      struct sf_param_reader *reader, const char *at);
/* Reads the scene's effects, and puts what they are made of into it; stirs their files into scene->hash. After
 * sf_scene_check, and before meshes are read. */
enum sf_status sf_scene_load_effects(struct sf_scene *scene, struct sf_param_reader *reader);
/* Reads the files that the scene names, seen from the folder of scene->path, and stirs their contents into scene->hash.
 */
enum sf_status sf_scene_load_assets(struct sf_scene *scene, struct sf_param_reader *reader);
/* Readers of files name the file; the scene's loader says where in the scene it is named. So their error is caught, and
 * told once, with both. */
struct sf_listener {
    struct sf_log log; /* for the reader of the file */
    const struct sf_param_reader *reader;
    char error[1024];
};
void sf_listener_init(struct sf_listener *listener, const struct sf_param_reader *reader);
enum sf_status sf_listener_retell(const struct sf_listener *listener, enum sf_status status);

/* After the files: every explicit particle, and the number of them all. */
enum sf_status sf_scene_check_particles(struct sf_scene *scene, struct sf_param_reader *reader);

#endif
