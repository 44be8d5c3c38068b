// Making lists: a workgroup makes one list, each invocation of a run of neighbours, so that every list is in the particles' order,
// whatever the device. Where the lists lie among each other is as it comes, which nobody sees. One that finds no room is SF_REFERENCE_ALL: a
// sphere that is not met adds exactly nothing, so that it gives the same bits.
#ifndef SF_REFERENCE_LIST_GLSL
#define SF_REFERENCE_LIST_GLSL

shared uint found[SF_REFERENCE_RUN];
shared uint place;

// The invocation's run of `live` particles.
uvec2 list_run(uint live)
{
    uint run = (live + SF_REFERENCE_RUN - 1u) / SF_REFERENCE_RUN;
    uint first = min(gl_LocalInvocationID.x * run, live);
    return uvec2(first, min(first + run, live));
}

// After each invocation has counted `here`: makes room for all, and gives where its own go; SF_REFERENCE_ALL: nowhere. All invocations call it.
uint list_place(uint here, uint list)
{
    uint at = 0u, total = 0u;
    found[gl_LocalInvocationID.x] = here;
    barrier();
    for (uint i = 0u; i < SF_REFERENCE_RUN; i++) {
        at += i < gl_LocalInvocationID.x ? found[i] : 0u;
        total += found[i];
    }
    if (gl_LocalInvocationID.x == 0u) {
        uint first = total > 0u ? atomicAdd(verdict.used, total) : 0u;
        bool fits = first <= push.entries && total <= push.entries - first;
        place = fits ? first : SF_REFERENCE_ALL;
        lists[list] = uvec2(place, fits ? total : counts.live);
    }
    barrier();
    return place == SF_REFERENCE_ALL ? SF_REFERENCE_ALL : place + at;
}

#endif
