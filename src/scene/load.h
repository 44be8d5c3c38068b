/* The stages of loading, each in its file. All report through the reader, with the place in the scene file. */
#ifndef SF_SCENE_LOAD_H
#define SF_SCENE_LOAD_H

#include "params/json.h"
#include "scene/scene.h"

/* The tree of a scene file's text, the caller's. SF_ERROR_SCENE says where it is not JSON, or too large. */
enum sf_status sf_scene_parse_json(const char *name, const char *text, size_t bytes, const struct sf_log *log,
                                   json_t **tree);
/* Applies the sets to the tree in their order; afterwards they are the reader's (in its arena). */
enum sf_status sf_scene_apply_sets(struct sf_param_reader *reader, json_t *tree, const char *const *sets,
                                   uint32_t set_count);
/* What one key alone cannot say: directions have a length, keys ascend, the camera looks somewhere. Normalises
 * directions, and fills in values that depend on others. Before files are read. */
enum sf_status sf_scene_check(struct sf_scene *scene, struct sf_param_reader *reader);
/* Reads the files that the scene names, seen from the folder of scene->path, and stirs their contents into scene->hash.
 */
enum sf_status sf_scene_load_assets(struct sf_scene *scene, struct sf_param_reader *reader);
/* After the files: every explicit particle, and the number of them all. */
enum sf_status sf_scene_check_particles(struct sf_scene *scene, struct sf_param_reader *reader);

#endif
