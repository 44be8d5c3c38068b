#version 460
#extension GL_GOOGLE_include_directive : require
// shared/noise.h at the points given, all there is of it: the words of the test of the same name.
#include "shared/noise.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Points { vec4 points[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Values { float values[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;

    if (i < points.length()) {
        vec4 p = points[i];
        sf_noise_cells open = sf_noise_cells3(p.x, p.y, p.z, 0, 0, 0, 0.6, 0.8, 7u);
        sf_noise_cells closed = sf_noise_cells3(p.x, p.y, p.z, 5, 7, 11, 1.0, 0.0, 8u);

        values[10 * i] = sf_noise2(p.x, p.y, 0, 0, 1u);
        values[10 * i + 1] = sf_noise2(p.x, p.y, 5, 7, 2u);
        values[10 * i + 2] = sf_noise3(p.x, p.y, p.z, 0, 0, 0, 3u);
        values[10 * i + 3] = sf_noise3(p.x, p.y, p.z, 5, 7, 11, 4u);
        values[10 * i + 4] = sf_noise4(p.x, p.y, p.z, p.w, 0, 0, 0, 0, 5u);
        values[10 * i + 5] = sf_noise4(p.x, p.y, p.z, p.w, 5, 7, 11, 2, 6u);
        values[10 * i + 6] = open.first;
        values[10 * i + 7] = open.second;
        values[10 * i + 8] = closed.first;
        values[10 * i + 9] = closed.second;
    }
}
