#version 460
#extension GL_GOOGLE_include_directive : require
#include "sort/slice.glsl"
#include "sort/prefix.glsl"

// A tile is LOCAL * ITEMS pairs. Sorted by the digit in shared memory, in two stable rounds of four bits, its pairs of one digit lie together and go
// out side by side.
layout(constant_id = 1) const uint ITEMS = 8u;
layout(set = 0, binding = 0, std430) readonly buffer Count { uint counts[]; };
layout(set = 0, binding = 1, std430) readonly buffer Source { uvec2 source[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Target { uvec2 target[]; };
layout(set = 0, binding = 3, std430) readonly buffer Table { uint table[]; };

const uint TILE = LOCAL * ITEMS;
const uint NIBBLES = 16u;
shared uint keys[TILE];
shared uint payloads[TILE];
shared uint counters[NIBBLES / 2u * LOCAL]; // of each invocation's items: nibble n in the low half of word n, n + 8 in the high half
shared uint places[SF_SORT_DIGITS];         // where the next pair of each digit goes
shared uint starts[SF_SORT_DIGITS];         // where each digit's pairs begin in the sorted tile

// Where this slice's pairs of each digit begin in the target.
void find_places()
{
    uint lane = gl_LocalInvocationID.x, sum = 0u;

    for (uint first = 0u; first < SF_SORT_DIGITS; first += LOCAL) {
        uint digit = first + lane, total;
        uint count = digit < SF_SORT_DIGITS ? table[SF_SORT_DIGITS * push.groups + digit] : 0u;
        uint before = prefix_sum(count, total);
        if (digit < SF_SORT_DIGITS)
            places[digit] = sum + before + table[digit * push.groups + gl_WorkGroupID.x];
        sum += total;
    }
    barrier();
}

// Past the end of the list a tile is filled up with the last digit, which leaves the filling behind all pairs.
uint nibble_of(uint i, uint filled, uint key, uint round)
{
    return i < filled ? bitfieldExtract(digit_of(key), int(round) * 4, 4) : NIBBLES - 1u;
}

void sort_tile(uint filled, uint round)
{
    uint lane = gl_LocalInvocationID.x;
    uint key[ITEMS], payload[ITEMS], rank[ITEMS];

    for (uint word = 0u; word < NIBBLES / 2u; word++)
        counters[word * LOCAL + lane] = 0u;
    for (uint item = 0u; item < ITEMS; item++) {
        uint i = lane * ITEMS + item;
        key[item] = keys[i];
        payload[item] = payloads[i];
        uint nibble = nibble_of(i, filled, key[item], round), word = (nibble & 7u) * LOCAL + lane;
        int low_bit = int(nibble >> 3u) * 16;
        rank[item] = bitfieldExtract(counters[word], low_bit, 16);
        counters[word] += 1u << low_bit;
    }
    barrier();

    // Counts become ranks: nibbles in order, within a nibble invocations in order. All low halves come before the high ones.
    uint sum = 0u, total;
    for (uint i = 0u; i < NIBBLES / 2u; i++)
        sum += counters[lane * (NIBBLES / 2u) + i];
    uint before = prefix_sum(sum, total);
    before += total << 16u;
    for (uint i = 0u; i < NIBBLES / 2u; i++) {
        uint word = lane * (NIBBLES / 2u) + i, count = counters[word];
        counters[word] = before;
        before += count;
    }
    barrier();

    for (uint item = 0u; item < ITEMS; item++) {
        uint nibble = nibble_of(lane * ITEMS + item, filled, key[item], round);
        uint base = counters[(nibble & 7u) * LOCAL + lane];
        rank[item] += bitfieldExtract(base, int(nibble >> 3u) * 16, 16);
        keys[rank[item]] = key[item];
        payloads[rank[item]] = payload[item];
    }
    barrier();
}

void write_tile(uint filled)
{
    uint lane = gl_LocalInvocationID.x;

    for (uint i = lane; i < filled; i += LOCAL) {
        uint digit = digit_of(keys[i]);
        if (i == 0u || digit_of(keys[i - 1u]) != digit)
            starts[digit] = i;
    }
    barrier();
    for (uint i = lane; i < filled; i += LOCAL) {
        uint digit = digit_of(keys[i]);
        target[places[digit] + i - starts[digit]] = uvec2(keys[i], payloads[i]);
    }
    barrier();
    for (uint i = lane; i < filled; i += LOCAL) {
        uint digit = digit_of(keys[i]);
        if (i + 1u == filled || digit_of(keys[i + 1u]) != digit)
            places[digit] += i + 1u - starts[digit];
    }
    barrier();
}

void main()
{
    uvec2 bounds = slice_bounds(min(counts[push.count_word], push.capacity), gl_WorkGroupID.x);

    find_places();
    for (uint first = bounds.x; first < bounds.y; first += TILE) {
        uint filled = min(TILE, bounds.y - first);
        for (uint i = gl_LocalInvocationID.x; i < filled; i += LOCAL) {
            uvec2 pair = source[first + i];
            keys[i] = pair.x;
            payloads[i] = pair.y;
        }
        barrier();
        sort_tile(filled, 0u);
        sort_tile(filled, 1u);
        write_tile(filled);
    }
}
