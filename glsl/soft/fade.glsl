// How far behind the billboard's plane the scene is, for soft particles. Include it after billboard/particle.glsl.
#ifndef SF_SOFT_FADE_GLSL
#define SF_SOFT_FADE_GLSL

// 0: in the plane or before it .. 1: at the distance of the settings (own.x, m; 0: the particle's radius) or beyond.
float distance_share()
{
    return clamp((depth_of_scene() - sphere.z) / (own.x > 0.0 ? own.x : sphere.w), 0.0, 1.0);
}

#endif
