// The atlas's picture on a billboard (src/methods/atlas_shape.h): colour and alpha, normals and heights. Include it after billboard/particle.glsl.
#ifndef SF_BILLBOARD_PICTURE_GLSL
#define SF_BILLBOARD_PICTURE_GLSL
#include "shared/billboard.h"

layout(set = 0, binding = 1, std430) readonly buffer Billboards { sf_billboard billboards[]; };
layout(set = 0, binding = 4) uniform sampler2DArray atlas_color; // premultiplied; alpha
layout(set = 0, binding = 5) uniform sampler2DArray atlas_shape; // (127 normal + 128) / 255, so that 0 is exact; height
layout(set = 0, binding = 6, std140) uniform Means { vec4 means; }; // of alpha, of each tile
layout(location = 6) flat in uint number;

// Where the fragment lies in the particle's picture.
struct sf_picture {
    vec3 at;    // texture coordinates and layer
    vec2 turn;  // cosine and sine of the picture's turn
    float mean; // alpha of the whole tile
    bool inside;
};

sf_picture picture_of(vec4 tile) // as struct sf_billboard has it
{
    vec2 turned = vec2(tile.x * ray.z - tile.y * ray.w, tile.y * ray.z + tile.x * ray.w);
    uint layer = uint(tile.z) & 3u;
    return sf_picture(vec3(0.5 + 0.5 * turned * vec2(1.0, -1.0), float(layer)), tile.xy, means[layer], max(abs(turned.x), abs(turned.y)) < 1.0);
}

vec4 picture_color(sf_picture picture)
{
    return picture.inside ? textureLod(atlas_color, picture.at, 0.0) : vec4(0.0);
}

// Unit normal, x to the right, y up, z to the viewer of the frame; height, in radii before the particle's plane.
vec4 picture_shape(sf_picture picture)
{
    vec4 shape = textureLod(atlas_shape, picture.at, 0.0) * vec4(vec3(255.0 / 127.0), 1.0) - vec4(vec3(128.0 / 127.0), 0.0);
    float shrink = inversesqrt(max(dot(shape.xyz, shape.xyz), 1e-12)); // filtering shortens
    return vec4(vec2(picture.turn.x * shape.x + picture.turn.y * shape.y, picture.turn.x * shape.y - picture.turn.y * shape.x) * shrink, shape.z * shrink, shape.w);
}

#endif
