#version 460
// One word of a uniform block into a place of a buffer; the upload of each play differs.
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std140) uniform Block { uvec4 word; } block;
layout(set = 0, binding = 1, std430) buffer Result { uint result[]; };

void main()
{
    result[block.word.x] = block.word.y;
}
