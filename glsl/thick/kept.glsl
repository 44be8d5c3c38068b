// The few spheres of a tile's list that a subgroup's own rays may meet: most of a tile's spheres are smaller than the tile. Each lane asks one sphere
// at a time, and what is kept is written down in the workgroup's memory in the list's order. Where it does not fit the whole list is used.
#ifndef SF_THICK_KEPT_GLSL
#define SF_THICK_KEPT_GLSL

shared uint kept_words[SF_THICK_KEPT];
struct thick_kept {
    uint first; // in kept_words
    uint room;
    uint count; // so far; above `room`: too many
};

thick_kept kept_begin()
{
    uint room = SF_THICK_KEPT / gl_NumSubgroups / SF_THICK_TURN * SF_THICK_TURN;
    return thick_kept(gl_SubgroupID * room, room, 0u);
}

// `wanted`: this lane's `number` is to be kept.
void kept_add(inout thick_kept kept, bool wanted, uint number)
{
    uvec4 ballot = subgroupBallot(wanted);
    uint at = kept.count + subgroupBallotExclusiveBitCount(ballot);
    if (wanted && at < kept.room)
        kept_words[kept.first + at] = number;
    kept.count += subgroupBallotBitCount(ballot);
}

// Pads with `nothing`, a sphere that no ray meets. False: they did not fit.
bool kept_end(inout thick_kept kept, uint nothing)
{
    uint end = (kept.count + SF_THICK_TURN - 1u) / SF_THICK_TURN * SF_THICK_TURN;
    for (uint at = kept.count + gl_SubgroupInvocationID; at < min(end, kept.room); at += gl_SubgroupSize)
        kept_words[kept.first + at] = nothing;
    bool fits = kept.count <= kept.room;
    kept.count = end;
    subgroupMemoryBarrierShared();
    return fits;
}

// Where invocation `index` of a workgroup stands in its square, so that the lanes of a subgroup are neighbours: along a Z-shaped curve.
uvec2 thick_corner(uint index)
{
    return uvec2(index & 1u | index >> 1 & 2u | index >> 2 & 4u | index >> 3 & 8u, index >> 1 & 1u | index >> 2 & 2u | index >> 3 & 4u | index >> 4 & 8u);
}

#endif
