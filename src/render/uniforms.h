/* The frame's uniform block and object list, from the scene at a moment. No GPU. */
#ifndef SF_RENDER_UNIFORMS_H
#define SF_RENDER_UNIFORMS_H

#include "scene/scene.h"
#include "shared/frame.h"

/* Everything but the lights' shadow and world_to_map, which src/light/shadow.h fills. `time` in s. */
void sf_uniforms_fill(const struct sf_scene *scene, uint32_t width, uint32_t height, uint32_t frame_number, double time,
                      struct sf_gpu_frame *frame);

/* The eye is elsewhere than the scene's camera says. */
void sf_uniforms_view(const struct sf_camera_pose *pose, uint32_t width, uint32_t height, struct sf_gpu_frame *frame);

/* As the loader makes a pose of a fixed camera. False where no picture can be: an eye at its target, or nowhere. */
bool sf_pose_from_view(const struct sf_camera_view *view, struct sf_camera_pose *pose);

/* Which objects of the scene stand in the object list: planes first, then boxes, spheres and cylinders, then meshes, each in the scene's
 * order. */
struct sf_object_list {
    uint32_t planes, solids, meshes;
    uint32_t from[SF_OBJECTS_MAX]; /* index into the scene's objects */
};
void sf_object_list_fill(const struct sf_scene *scene, struct sf_object_list *list);
void sf_object_fill(const struct sf_object *from, struct sf_gpu_object *object);

/* Column-major (as the GPU has it) to row-major. */
void sf_matrix_transpose(const float from[16], float to[16]);

#endif
