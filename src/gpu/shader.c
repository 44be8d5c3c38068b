/* Shaders at run time: those of the library by name, others that took their place, and whether these fit the passes that
 * use them. The library's own were compiled with their passes; a stranger that uses a binding which its pass does not
 * have, or pushes more than it gets, would be undefined behaviour in the driver, so it is read and refused here. */
#include "gpu/vk.h"

#include <stdlib.h>
#include <string.h>

enum { HEADER_WORDS = 5, MAGIC = 0x07230203, IDS_MAX = 1 << 20 };

/* The few of SPIR-V's numbers that matter here. */
enum {
    OP_ENTRY_POINT = 15,
    OP_TYPE_INT = 21,
    OP_TYPE_FLOAT = 22,
    OP_TYPE_VECTOR = 23,
    OP_TYPE_MATRIX = 24,
    OP_TYPE_IMAGE = 25,
    OP_TYPE_SAMPLED_IMAGE = 27,
    OP_TYPE_ARRAY = 28,
    OP_TYPE_STRUCT = 30,
    OP_TYPE_POINTER = 32,
    OP_CONSTANT = 43,
    OP_SPEC_CONSTANT = 50,
    OP_FUNCTION = 54,
    OP_FUNCTION_END = 56,
    OP_FUNCTION_CALL = 57,
    OP_VARIABLE = 59,
    OP_IMAGE_TEXEL_POINTER = 60,
    OP_LOAD = 61,
    OP_STORE = 62,
    OP_ACCESS_CHAIN = 65,
    OP_IN_BOUNDS_ACCESS_CHAIN = 66,
    OP_ARRAY_LENGTH = 68,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    DECORATION_ARRAY_STRIDE = 6,
    DECORATION_BUFFER_BLOCK = 3,
    DECORATION_BINDING = 33,
    DECORATION_SET = 34,
    DECORATION_OFFSET = 35,
    STORAGE_UNIFORM_CONSTANT = 0,
    STORAGE_UNIFORM = 2,
    STORAGE_PUSH_CONSTANT = 9,
    STORAGE_STORAGE_BUFFER = 12,
    MODEL_VERTEX = 0,
    MODEL_FRAGMENT = 4,
    MODEL_COMPUTE = 5,
    IMAGE_SAMPLED_STORAGE = 2, /* an image that is not sampled */
};

const struct sf_shader *sf_shader_find(const char *name)
{
    size_t low = 0, high = 0;

    while (sf_shaders[high].name)
        high++;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        int order = strcmp(name, sf_shaders[middle].name);

        if (order == 0)
            return &sf_shaders[middle];
        if (order < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return NULL;
}

const struct sf_shader *sf_shader_now(const struct sf_gpu *gpu, const struct sf_shader *shader)
{
    const struct sf_shader *other = gpu->shaders ? &gpu->shaders[shader - sf_shaders] : shader;

    return other->words ? other : shader;
}

/* ---- reading SPIR-V ---- */

/* What is known of an id; ids are defined before they are used, but for pointers, whose sizes nobody asks. */
struct id {
    uint32_t op, type, storage; /* type: what a pointer, an array or a variable is of */
    uint32_t size;              /* bytes of a type; value of a constant */
    uint32_t stride, last_member, last_offset;
    uint32_t binding, set;
    bool used, called, buffer_block, storage_image;
};

struct module {
    struct id *ids;
    uint32_t bound;
    bool has_main, in_function;
    uint32_t model; /* of main */
};

/* Id 0 is nobody's: it takes what points outside. */
static struct id *id_at(struct module *module, uint32_t id)
{
    return &module->ids[id < module->bound ? id : 0];
}

static void read_decoration(struct id *id, uint32_t decoration, uint32_t value)
{
    if (decoration == DECORATION_BINDING)
        id->binding = value;
    else if (decoration == DECORATION_SET)
        id->set = value;
    else if (decoration == DECORATION_ARRAY_STRIDE)
        id->stride = value;
    else if (decoration == DECORATION_BUFFER_BLOCK)
        id->buffer_block = true;
}

static void read_type(struct module *module, uint32_t op, const uint32_t w[8], const uint32_t *words, uint32_t length)
{
    struct id *id = id_at(module, w[1]), *of = id_at(module, w[2]);

    id->op = op;
    if (op == OP_TYPE_INT || op == OP_TYPE_FLOAT) {
        id->size = w[2] / 8;
    } else if (op == OP_TYPE_VECTOR) {
        id->size = of->size * w[3];
    } else if (op == OP_TYPE_MATRIX) { /* columns of 3 lie as those of 4 */
        id->size = (of->size > 8 ? 16 : of->size) * w[3];
    } else if (op == OP_TYPE_IMAGE) {
        id->storage_image = w[7] == IMAGE_SAMPLED_STORAGE;
    } else if (op == OP_TYPE_ARRAY) {
        id->size = (id->stride ? id->stride : of->size) * id_at(module, w[3])->size;
    } else if (op == OP_TYPE_STRUCT) {
        if ((uint64_t)id->last_member + 2 < length)
            id->size = id->last_offset + id_at(module, words[2 + id->last_member])->size;
    } else if (op == OP_TYPE_POINTER) {
        id->storage = w[2];
        id->type = w[3];
    }
}

static void read_instruction(struct module *module, const uint32_t *words, uint32_t length)
{
    uint32_t w[8] = {0}, op = words[0] & 0xffff;

    memcpy(w, words, (length < SF_COUNT(w) ? length : SF_COUNT(w)) * sizeof *w);
    if (op == OP_ENTRY_POINT && length > 4 && memcmp(&w[3], "main\0\0\0", 8) == 0) {
        module->has_main = true;
        module->model = w[1];
        id_at(module, w[2])->called = true;
    } else if (op == OP_DECORATE) {
        read_decoration(id_at(module, w[1]), w[2], w[3]);
    } else if (op == OP_MEMBER_DECORATE && w[3] == DECORATION_OFFSET) {
        struct id *block = id_at(module, w[1]);

        if (w[4] >= block->last_offset) {
            block->last_member = w[2];
            block->last_offset = w[4];
        }
    } else if (op >= OP_TYPE_INT && op <= OP_TYPE_POINTER) {
        read_type(module, op, w, words, length);
    } else if (op == OP_CONSTANT || op == OP_SPEC_CONSTANT) {
        id_at(module, w[2])->size = w[3];
    } else if (op == OP_VARIABLE) {
        struct id *variable = id_at(module, w[2]);

        variable->op = OP_VARIABLE;
        variable->storage = w[3];
        variable->type = id_at(module, w[1])->type;
    } else if (op == OP_STORE) {
        id_at(module, w[1])->used = true;
    } else if (op == OP_LOAD || op == OP_IMAGE_TEXEL_POINTER || op == OP_ACCESS_CHAIN ||
               op == OP_IN_BOUNDS_ACCESS_CHAIN || op == OP_ARRAY_LENGTH) {
        id_at(module, w[3])->used = true;
    } else if (op == OP_FUNCTION || op == OP_FUNCTION_END) {
        module->in_function = op == OP_FUNCTION;
        id_at(module, w[2])->op = op;
    } else if (op == OP_FUNCTION_CALL) {
        id_at(module, w[3])->called = true;
        for (uint32_t i = 4; i < length; i++)
            id_at(module, words[i])->used = true;
    }
}

/* All that is called is there, and ends. */
static bool whole(const struct module *module)
{
    bool all = !module->in_function;

    for (uint32_t i = 1; i < module->bound; i++)
        all = all && (!module->ids[i].called || module->ids[i].op == OP_FUNCTION);
    return all;
}

/* When it fails, there is nothing to free. */
static enum sf_status read_module(const struct sf_gpu *gpu, const struct sf_shader *shader, struct module *module)
{
    size_t count = shader->bytes / sizeof *shader->words, at = HEADER_WORDS;
    const char *wrong = NULL;

    *module = (struct module){0};
    if (shader->bytes % sizeof *shader->words || count < HEADER_WORDS || shader->words[0] != MAGIC)
        wrong = "they do not begin as SPIR-V does";
    else if (shader->words[3] == 0 || shader->words[3] > IDS_MAX)
        wrong = "the number of ids is wrong";
    if (!wrong) {
        module->bound = shader->words[3];
        module->ids = calloc(module->bound, sizeof *module->ids);
        if (!module->ids)
            return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory to read the shader '%s'", shader->name);
    }
    while (!wrong && at < count) {
        uint32_t length = shader->words[at] >> 16;

        if (length == 0 || length > count - at) {
            wrong = "they are cut off or damaged";
        } else {
            read_instruction(module, shader->words + at, length);
            at += length;
        }
    }
    if (!wrong && !module->has_main)
        wrong = "there is no entry point 'main'";
    if (!wrong && !whole(module))
        wrong = "they are cut off or damaged";
    if (!wrong)
        return SF_OK;
    free(module->ids);
    module->ids = NULL;
    return sf_fail(gpu->log, SF_ERROR_USAGE, "the new words of the shader '%s' cannot be used: %s", shader->name,
                   wrong);
}

/* ---- does it fit? ---- */

static uint32_t model_of(const char *name)
{
    const char *dot = strrchr(name, '.');

    if (dot && strcmp(dot, ".vert") == 0)
        return MODEL_VERTEX;
    return dot && strcmp(dot, ".frag") == 0 ? MODEL_FRAGMENT : MODEL_COMPUTE;
}

/* VK_DESCRIPTOR_TYPE_MAX_ENUM: none that a pass can bind. */
static VkDescriptorType descriptor_of(struct module *module, const struct id *variable)
{
    const struct id *type = id_at(module, variable->type);

    if (variable->storage == STORAGE_STORAGE_BUFFER || (variable->storage == STORAGE_UNIFORM && type->buffer_block))
        return type->op == OP_TYPE_STRUCT ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER : VK_DESCRIPTOR_TYPE_MAX_ENUM;
    if (variable->storage == STORAGE_UNIFORM)
        return type->op == OP_TYPE_STRUCT ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_MAX_ENUM;
    if (type->op == OP_TYPE_SAMPLED_IMAGE)
        return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    return type->op == OP_TYPE_IMAGE && type->storage_image ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                                            : VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

static const char *descriptor_name(VkDescriptorType type)
{
    switch (type) {
    case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
        return "a sampled image";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
        return "a storage image";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
        return "a uniform buffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
        return "a storage buffer";
    default:
        return "something that no pass binds";
    }
}

static enum sf_status check_binding(const struct sf_gpu *gpu, const struct sf_shader *shader, const char *pass,
                                    const struct sf_pipeline_key *key, const struct id *variable, VkDescriptorType type)
{
    struct sf_text has = {0};
    enum sf_status status;

    for (uint32_t i = 0; i < key->binding_count && variable->set == 0; i++)
        if (key->bindings[i].binding == variable->binding) {
            if (key->bindings[i].type == type)
                return SF_OK;
            return sf_fail(gpu->log, SF_ERROR_USAGE,
                           "the new words of the shader '%s' use binding %u as %s; the pass '%s' has %s there",
                           shader->name, variable->binding, descriptor_name(type), pass,
                           descriptor_name(key->bindings[i].type));
        }
    for (uint32_t i = 0; i < key->binding_count; i++)
        sf_text_printf(&has, "%s%u", i ? ", " : "", key->bindings[i].binding);
    status = sf_fail(gpu->log, SF_ERROR_USAGE,
                     "the new words of the shader '%s' use binding %u of set %u, which the pass '%s' does not have; it "
                     "has: %s (all in set 0)",
                     shader->name, variable->binding, variable->set, pass, has.data ? has.data : "none");
    sf_text_finish(&has);
    return status;
}

static enum sf_status check_module(const struct sf_gpu *gpu, const struct sf_shader *shader, const char *pass,
                                   const struct sf_pipeline_key *key, struct module *module)
{
    enum sf_status status = SF_OK;

    if (module->model != model_of(shader->name))
        return sf_fail(gpu->log, SF_ERROR_USAGE, "the new words of the shader '%s' are of another stage", shader->name);
    for (uint32_t i = 1; i < module->bound && key && !status; i++) {
        const struct id *variable = &module->ids[i];
        uint32_t bytes = id_at(module, variable->type)->size;

        if (variable->op != OP_VARIABLE || !variable->used)
            continue;
        if (variable->storage == STORAGE_PUSH_CONSTANT && bytes > key->push_bytes)
            status = sf_fail(gpu->log, SF_ERROR_USAGE,
                             "the new words of the shader '%s' read %u bytes of push constants; the pass '%s' gives %u",
                             shader->name, bytes, pass, key->push_bytes);
        else if (variable->storage == STORAGE_UNIFORM_CONSTANT || variable->storage == STORAGE_UNIFORM ||
                 variable->storage == STORAGE_STORAGE_BUFFER)
            status = check_binding(gpu, shader, pass, key, variable, descriptor_of(module, variable));
    }
    return status;
}

enum sf_status sf_shader_check(const struct sf_gpu *gpu, const struct sf_shader *shader, const char *pass,
                               const struct sf_pipeline_key *key)
{
    struct module module;
    enum sf_status status = read_module(gpu, shader, &module);

    if (!status)
        status = check_module(gpu, shader, pass, key, &module);
    free(module.ids);
    return status;
}

/* ---- taking another's place ---- */

static enum sf_status make_room(struct sf_gpu *gpu)
{
    size_t count = 0;

    while (sf_shaders[count].name)
        count++;
    if (!gpu->shaders)
        gpu->shaders = calloc(count, sizeof *gpu->shaders);
    return gpu->shaders ? SF_OK : sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for another shader");
}

enum sf_status sf_gpu_set_shader(struct sf_gpu *gpu, const char *name, const uint32_t *words, size_t bytes)
{
    const struct sf_shader *shader = sf_shader_find(name);
    struct sf_shader other = {.name = name, .bytes = bytes}, before, *now;
    enum sf_status status = sf_gpu_refuse_lost(gpu);

    if (!status && !shader)
        status = sf_fail(gpu->log, SF_ERROR_USAGE, "there is no shader '%s'", name);
    if (!status && gpu->recording)
        status = sf_fail(gpu->log, SF_ERROR_USAGE, "the shader '%s' is set while a frame is open", name);
    if (!status)
        status = make_room(gpu);
    if (status)
        return status;
    now = &gpu->shaders[shader - sf_shaders];
    if (!words && !now->words)
        return SF_OK;
    other.name = shader->name;
    if (words) {
        uint32_t *copy = malloc(bytes ? bytes : 1);

        if (!copy)
            return sf_fail(gpu->log, SF_ERROR_MEMORY, "no memory for the new words of the shader '%s'", name);
        memcpy(copy, words, bytes);
        other.words = copy;
        status = sf_shader_check(gpu, &other, NULL, NULL);
    }
    before = *now;
    if (!status) {
        sf_gpu_settle(gpu);
        *now = other;
        status = gpu->stuck ? sf_fail(gpu->log, SF_ERROR_DEVICE_LOST, "the device does not answer: '%s' stays", name)
                            : sf_pipelines_remake(gpu, shader);
    }
    if (status) {
        *now = before;
        before = other;
    }
    free((void *)before.words);
    return status;
}

void sf_shaders_finish(struct sf_gpu *gpu)
{
    for (size_t i = 0; gpu->shaders && sf_shaders[i].name; i++)
        free((void *)gpu->shaders[i].words);
    free(gpu->shaders);
    gpu->shaders = NULL;
}
