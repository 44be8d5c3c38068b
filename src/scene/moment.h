/* What motion.c needs of moment.c. */
#ifndef SF_SCENE_MOMENT_H
#define SF_SCENE_MOMENT_H

#include "scene/scene.h"

/* Shakes the pose as the scene's effects do at the time (s, counted from frame 0); the same bits when none does. */
void sf_pose_shake(const struct sf_scene *scene, double time, struct sf_camera_pose *pose);

#endif
