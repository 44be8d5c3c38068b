// What the passes of the scene write: the surface's light, and its view depth (m); or one of the two.
#ifndef SF_SCENE_TARGETS_GLSL
#define SF_SCENE_TARGETS_GLSL

#if defined(SF_ONLY_DEPTH)
vec4 color;
layout(location = 0) out float depth;
#elif defined(SF_ONLY_COLOR)
layout(location = 0) out vec4 color;
float depth;
#else
layout(location = 0) out vec4 color;
layout(location = 1) out float depth;
#endif

#endif
