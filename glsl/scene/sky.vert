#version 460
#extension GL_GOOGLE_include_directive : require
// What lies behind everything: drawn where the one plane is not, or everywhere when there are none or several.
#include "scene/shade.glsl"
#include "scene/half_plane.glsl"

layout(location = 0) flat out vec4 forward; // w: 1/width
layout(location = 1) flat out vec4 right;   // w: 1/height
layout(location = 2) flat out vec4 up;      // w: alpha
layout(location = 3) flat out vec4 zenith;
layout(location = 4) flat out vec4 horizon;
layout(location = 5) flat out vec4 ground;

void main()
{
    forward = vec4(frame.forward.xyz, frame.size.z);
    right = vec4(frame.right.xyz, frame.size.w);
    up = vec4(frame.up.xyz, 1.0);
    zenith = frame.zenith;
    horizon = frame.horizon;
    ground = frame.ground;
    if (ENVIRONMENT == 1u || ENVIRONMENT == 3u)
        horizon = frame.background;
    if (ENVIRONMENT == 3u)
        up.w = sign(dot(frame.background.rgb, vec3(1.0))); // black is nothing at all: for laying over another picture

    vec3 beyond = vec3(0.0, 0.0, 1.0); // everything
    if (PLANES == 1u) {
        float height;
        vec3 nearer = plane_horizon(0u, height);
        // The plane ends at SF_DEPTH_FAR, and near the eye at the near plane: then all of it may be open.
        float steepest = abs(nearer.x) + abs(nearer.y) + abs(nearer.z);
        if (height > frame.eye.w * steepest)
            beyond = vec3(0.0, 0.0, 2.0 * (height / SF_DEPTH_FAR + pixel_slope(nearer))) - nearer;
    }
    vec2 corner = half_plane_corner(beyond, gl_VertexIndex);
    gl_Position = vec4(corner.x, -corner.y, 0.0, 1.0);
}
