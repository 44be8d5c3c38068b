// Optical depth between the near plane and the scene for every pixel of the frame that the listed tiles cover. One group a tile, a thread takes
// squares of 2 x 2 pixels, which share the reading of the spheres (at the frame's own resolution: one pixel). With NEAR_FAR also where smoke begins and
// ends. Include it in a compute shader that declares `target` and NEAR_FAR.
layout(constant_id = 0) const uint SCALE = 2u; // of the smoke's pixels
layout(constant_id = 1) const uint DETAIL = 0u;
layout(constant_id = 2) const uint TURN = 8u;
layout(local_size_x = SF_THICK_TILE * SF_THICK_TILE) in;
layout(set = 0, binding = 0, std140) uniform Frame { sf_gpu_frame frame; };
layout(set = 0, binding = 1, std430) readonly buffer Tiles { uint tiles[]; };
layout(set = 0, binding = 2, std140) uniform Args { sf_thick_args args; };
layout(set = 0, binding = 3) uniform sampler2D scene_depth;
layout(set = 0, binding = 4) uniform sampler2D atlas;
layout(set = 0, binding = 5, std430) readonly buffer Spheres { sf_thick_sphere spheres[]; };
layout(set = 0, binding = 6, std430) readonly buffer Ranges { uvec2 ranges[]; };
layout(set = 0, binding = 7, std430) readonly buffer List { uint list[]; };
layout(push_constant) uniform Push { sf_thick_push push; };
layout(set = 0, binding = 9, std430) readonly buffer Mask { uint mask[]; };
#include "thick/spheres.glsl"
#include "thick/view.glsl"

thick_ray sight_of(ivec2 pixel)
{
    ivec2 safe = min(pixel, textureSize(scene_depth, 0) - 1);
    vec2 ndc = ((vec2(safe) + 0.5) * frame.size.zw * 2.0 - 1.0) * vec2(1.0, -1.0);
    return thick_sight(view_ray(ndc).xy, frame.eye.w, texelFetch(scene_depth, safe, 0).r);
}

// Of a sphere that nothing may cut off only the optical depth is wanted: its matter is the extinction times the diameter.
void add(inout vec3 sum, vec4 ball, vec4 detail, float matter, bool cut, thick_ray ray)
{
    float share = thick_share(ball.xyz, ray);
    if (DETAIL != 0u)
        share *= thick_dent(ball.xyz, detail, ray.way);
    if (!cut)
        sum.x += matter * share;
    if (!cut && !NEAR_FAR)
        return;
    thick_chord chord = thick_cross(ball, ray, share);
    bool hit = share > 0.0 && matter > 0.0 && chord.to > chord.from;
    if (cut)
        sum.x += hit ? matter * (chord.to - chord.from) * ray.speed : 0.0;
    if (NEAR_FAR) {
        sum.y = min(sum.y, hit ? chord.from : SF_DEPTH_FAR);
        sum.z = max(sum.z, hit ? chord.to : -SF_DEPTH_FAR);
    }
}

void store(ivec2 pixel, vec3 sum)
{
    if (all(lessThan(pixel, textureSize(scene_depth, 0))))
        imageStore(target, pixel, vec4(sum, 0.0));
}

void square(uvec2 range, ivec2 corner, bool cut)
{
    const vec3 nothing = vec3(0.0, SF_DEPTH_FAR, -SF_DEPTH_FAR);
    vec3 s0 = nothing, s1 = nothing, s2 = nothing, s3 = nothing;
    thick_ray r0 = sight_of(corner), r1, r2, r3;
    if (SCALE > 1u) {
        r1 = sight_of(corner + ivec2(1, 0));
        r2 = sight_of(corner + ivec2(0, 1));
        r3 = sight_of(corner + ivec2(1, 1));
    }
    thick_list touching = thick_keep(range, min(r0.way, SCALE > 1u ? r3.way : r0.way), max(r0.way, SCALE > 1u ? r3.way : r0.way));
    // Twice the same loop, of which one does not run: a software device would take both sides of a branch within.
    for (uint way = 0u; way < 2u; way++) {
        uint count = (way == 1u) == cut ? touching.count : 0u;
        for (uint i = 0u; i < count; i += TURN) {
            thick_turn turn = thick_read(touching, i, DETAIL != 0u, false);
            float matter = way == 0u ? 2.0 * turn.ball.w * turn.extinction : turn.extinction;
            [[unroll]] for (uint k = 0u; k < TURN; k++) {
                vec4 ball = subgroupShuffle(turn.ball, k), detail = vec4(0.0);
                float here = subgroupShuffle(matter, k);
                if (DETAIL != 0u)
                    detail = subgroupShuffle(turn.detail, k);
                add(s0, ball, detail, here, way == 1u, r0);
                if (SCALE > 1u) {
                    add(s1, ball, detail, here, way == 1u, r1);
                    add(s2, ball, detail, here, way == 1u, r2);
                    add(s3, ball, detail, here, way == 1u, r3);
                }
            }
        }
    }
    store(corner, s0);
    if (SCALE > 1u) {
        store(corner + ivec2(1, 0), s1);
        store(corner + ivec2(0, 1), s2);
        store(corner + ivec2(1, 1), s3);
    }
}

void main()
{
    const uint side = SCALE > 1u ? SCALE / 2u : 1u, step = SCALE > 1u ? 2u : 1u; // squares along the tile's edge for each thread
    uint tile = tiles[gl_WorkGroupID.x];
    uvec2 corner = uvec2(tile % push.tiles_x, tile / push.tiles_x) * SF_THICK_TILE * SCALE;
    uvec2 range = ranges[gl_WorkGroupID.x];
    thick_live = args.dispatch_tiles.w;
    // A surface stands before the smoke's back here, or smoke is close to the eye.
    bool cut = mask[tile] == SF_THICK_TILE_CUT || dot(args.centre.xyz - frame.eye.xyz, frame.forward.xyz) - args.centre.w < frame.eye.w;
    for (uint i = 0u; i < side * side; i++)
        square(range, ivec2(corner + (thick_corner(gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID) + uvec2(i % side, i / side) * SF_THICK_TILE) * step), cut);
}
