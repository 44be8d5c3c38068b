// Rays of the camera. Include it where `frame` is declared.
#ifndef SF_REFERENCE_VIEW_GLSL
#define SF_REFERENCE_VIEW_GLSL

// Through a point of the frame, px, rows down: the way from the eye that has unit view depth.
vec3 pixel_ray(vec2 pixel)
{
    vec2 at = pixel * frame.size.zw * 2.0 - 1.0;
    return frame.forward.xyz + at.x * frame.right.xyz - at.y * frame.up.xyz;
}

#endif
