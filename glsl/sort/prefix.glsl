// Exclusive sums over a workgroup of LOCAL invocations. All of them must call.
#ifndef SF_SORT_PREFIX_GLSL
#define SF_SORT_PREFIX_GLSL

shared uint prefix_words[2u * LOCAL];

uint prefix_sum(uint value, out uint total)
{
    uint lane = gl_LocalInvocationID.x, from = 0u, sum = value;

    prefix_words[lane] = sum;
    for (uint reach = 1u; reach < LOCAL; reach <<= 1u) {
        barrier();
        if (lane >= reach)
            sum += prefix_words[from + lane - reach];
        from = LOCAL - from;
        prefix_words[from + lane] = sum;
    }
    barrier();
    total = prefix_words[from + LOCAL - 1u];
    barrier();
    return sum - value;
}

#endif
