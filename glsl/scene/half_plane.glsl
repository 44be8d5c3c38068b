// The part of the picture where a line's equation is positive, as a strip of four vertices.
#ifndef SF_SCENE_HALF_PLANE_GLSL
#define SF_SCENE_HALF_PLANE_GLSL

// Corner `number` of the half plane line.x x + line.y y + line.z > 0 of -1..1 (y up); everything or nothing when the line is too far away.
vec2 half_plane_corner(vec3 line, int number)
{
    float slope = length(line.xy);
    vec2 inward = slope > 1e-12 ? line.xy / slope : vec2(0.0, 1.0);
    float start = clamp(slope > 1e-12 ? -line.z / slope : line.z > 0.0 ? -2.0 : 2.0, -2.0, 2.0);
    vec2 along = vec2(-inward.y, inward.x);
    return inward * (number < 2 ? start : 2.0) + along * ((number & 1) == 0 ? -2.0 : 2.0);
}

// Where the eye's ray comes nearer to plane `i`: x right + y up + z >= 0 for ndc (x, y). The planes' distance from the eye goes to `height`, with
// its sign taken off.
vec3 plane_horizon(uint i, out float height)
{
    vec4 row = objects[i].row1;
    height = dot(row.xyz, frame.eye.xyz) + row.w;
    vec3 down = height > 0.0 ? -row.xyz : row.xyz;
    height = abs(height);
    return vec3(dot(down, frame.right.xyz), dot(down, frame.up.xyz), dot(down, frame.forward.xyz));
}

// A pixel, in units of a line's equation.
float pixel_slope(vec3 line)
{
    return dot(abs(line.xy), frame.size.zw) * 2.0;
}

#endif
