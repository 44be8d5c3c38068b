/* Validation of one pass by itself: its uses, its shaders, the size of its work. */
#include "graph/internal.h"

#include <stdarg.h>
#include <stdio.h>

struct check {
    const struct sf_graph *graph;
    const struct sf_pass_desc *pass;
    const struct sf_log *log;
};

static enum sf_status fail(const struct check *check, const char *format, ...) SF_PRINTF(2, 3);

static enum sf_status fail(const struct check *check, const char *format, ...)
{
    char why[768];
    va_list args;

    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    return sf_fail(check->log, SF_ERROR_INTERNAL, "graph '%s': pass '%s': %s", check->graph->name, check->pass->name,
                   why);
}

static bool known(const struct sf_graph *graph, sf_resource resource)
{
    return resource != 0 && resource <= graph->resource_count;
}

static enum sf_status check_format(const struct check *check, const struct sf_use *use,
                                   const struct sf_graph_resource *resource)
{
    enum sf_format format = resource->image.format;
    const char *name = resource->name, *access = sf_access_name(use->access), *format_name = sf_format_name(format);
    bool depth = format == SF_FORMAT_D32F;

    if ((use->access == SF_ACCESS_DEPTH || use->access == SF_ACCESS_DEPTH_READ) && !depth)
        return fail(check, "uses '%s' as %s, but its format is %s; depth attachments are d32f", name, access,
                    format_name);
    if (use->access == SF_ACCESS_COLOR && depth)
        return fail(check, "uses '%s' as color, but its format is d32f; use the access depth", name);
    if (sf_access_layout(use->access, format) == SF_LAYOUT_GENERAL && (depth || format == SF_FORMAT_RGBA8_SRGB))
        return fail(check, "uses '%s' as %s, but %s cannot be a storage image; sample it, or choose another format",
                    name, access, format_name);
    if (use->access == SF_ACCESS_SAMPLED && use->sampler != SF_SAMPLER_NEAREST && format == SF_FORMAT_R32_UINT)
        return fail(check, "samples '%s' linearly, but r32_uint cannot be filtered; use SF_SAMPLER_NEAREST", name);
    if (use->access == SF_ACCESS_COLOR && format == SF_FORMAT_R32_UINT &&
        check->pass->raster.blend[use->binding] != SF_BLEND_NONE)
        return fail(check, "blends into '%s', but r32_uint cannot be blended; use SF_BLEND_NONE", name);
    return SF_OK;
}

static enum sf_status check_use(const struct check *check, const struct sf_use *use)
{
    const struct sf_graph_resource *resource;
    const char *access = sf_access_name(use->access);
    bool writes = sf_access_writes(use->access);

    if (!known(check->graph, use->resource))
        return fail(check, "uses an unknown resource (number %u); pass what sf_graph_image or sf_graph_buffer gave",
                    use->resource);
    resource = sf_graph_get(check->graph, use->resource);
    if (!sf_access_in_kind(use->access, check->pass->kind))
        return fail(check, "wrong usage of '%s': no %s pass can use the access %s", resource->name,
                    sf_pass_kind_name(check->pass->kind), access);
    if (!sf_access_suits(use->access, resource->is_image))
        return fail(check, "wrong usage of '%s': it is %s, which the access %s does not fit", resource->name,
                    resource->is_image ? "an image" : "a buffer", access);
    if (use->access == SF_ACCESS_COLOR && use->binding >= SF_PASS_COLORS_MAX)
        return fail(check, "color attachment number %u of '%s' is over the limit; SF_PASS_COLORS_MAX is %d",
                    use->binding, resource->name, SF_PASS_COLORS_MAX);
    if ((unsigned)use->sampler >= SF_SAMPLER_COUNT || (unsigned)use->load > SF_LOAD_DISCARD)
        return fail(check, "the sampler or load of '%s' is none of its enumeration", resource->name);
    if (use->load != SF_LOAD_KEEP && use->access != SF_ACCESS_COLOR && use->access != SF_ACCESS_DEPTH)
        return fail(check, "wrong usage of '%s': `load` is for color and depth attachments, not for %s; leave it out",
                    resource->name, access);
    if (use->previous && !sf_resource_paired(resource))
        return fail(check, "uses the previous copy of '%s', which has none; give it the lifetime SF_HISTORY",
                    resource->name);
    if (use->previous && (writes || use->access == SF_ACCESS_INDIRECT))
        return fail(check,
                    "wrong usage of '%s': its previous copy can be read only, and not as indirect arguments; write the "
                    "current one",
                    resource->name);
    if (writes && resource->lifetime == SF_UPLOAD)
        return fail(check, "writes '%s', but upload buffers are written by the CPU only; use a transient buffer",
                    resource->name);
    if (resource->lifetime == SF_READBACK && use->access != SF_ACCESS_TRANSFER_WRITE)
        return fail(check, "uses the readback buffer '%s' as %s; only a transfer may touch it: copy into it",
                    resource->name, access);
    return resource->is_image ? check_format(check, use, resource) : SF_OK;
}

/* Two uses of one copy: both read, and an image is in one layout for both. */
static enum sf_status check_pair(const struct check *check, const struct sf_use *a, const struct sf_use *b)
{
    const struct sf_graph_resource *resource = sf_graph_get(check->graph, a->resource);
    enum sf_format format = resource->is_image ? resource->image.format : SF_FORMAT_NONE;

    if (sf_access_in_shader(a->access) && sf_access_in_shader(b->access) && a->binding == b->binding)
        return fail(check, "binding %u is taken twice, by '%s' and '%s'; number the bindings as the shader does",
                    a->binding, resource->name, sf_graph_get(check->graph, b->resource)->name);
    if (a->access == SF_ACCESS_COLOR && b->access == SF_ACCESS_COLOR && a->binding == b->binding)
        return fail(check, "color attachment %u is taken twice, by '%s' and '%s'; number them from 0", a->binding,
                    resource->name, sf_graph_get(check->graph, b->resource)->name);
    if (a->resource != b->resource || a->previous != b->previous)
        return SF_OK;
    if (sf_access_writes(a->access) || sf_access_writes(b->access))
        return fail(
            check,
            "two uses of '%s' conflict: %s and %s in one pass; use storage_modify, or another resource for the result",
            resource->name, sf_access_name(a->access), sf_access_name(b->access));
    if (sf_access_layout(a->access, format) != sf_access_layout(b->access, format))
        return fail(check, "two uses of '%s' conflict: %s and %s need different layouts; use one of them for both",
                    resource->name, sf_access_name(a->access), sf_access_name(b->access));
    return SF_OK;
}

static enum sf_status check_uses(const struct check *check)
{
    struct sf_use a, b;
    enum sf_status status;

    if (check->pass->indirect && !known(check->graph, check->pass->indirect))
        return fail(check, "`indirect` is an unknown resource (number %u); pass what sf_graph_buffer gave",
                    check->pass->indirect);
    for (uint32_t i = 0; sf_pass_use(check->pass, i, &a); i++) {
        status = check_use(check, &a);
        for (uint32_t j = 0; j < i && !status; j++) {
            sf_pass_use(check->pass, j, &b);
            status = check_pair(check, &b, &a);
        }
        if (status)
            return status;
    }
    return SF_OK;
}

static enum sf_status check_attachments(const struct check *check)
{
    const struct sf_pass_desc *pass = check->pass;
    const struct sf_graph_resource *first = NULL;
    uint32_t width = 0, height = 0, colors = 0, numbers = 0, depths = 0;

    for (uint32_t i = 0; i < pass->use_count; i++) {
        const struct sf_use *use = &pass->uses[i];
        const struct sf_graph_resource *resource = sf_graph_get(check->graph, use->resource);
        uint32_t w, h;

        if (!sf_access_attaches(use->access))
            continue;
        sf_image_extent(check->graph, use->resource, &w, &h);
        if (resource->image.layers > 1)
            return fail(check,
                        "attaches '%s', which has %u layers; attachments have one: place cells side by side instead",
                        resource->name, resource->image.layers);
        if (first && (w != width || h != height))
            return fail(check, "its attachments differ in size: '%s' is %u x %u, '%s' is %u x %u; make them equal",
                        first->name, width, height, resource->name, w, h);
        first = resource;
        width = w;
        height = h;
        if (use->access == SF_ACCESS_COLOR) {
            colors++;
            numbers |= 1u << use->binding;
        } else {
            depths++;
        }
    }
    if (!first)
        return fail(check, "is a raster pass with no attachment; give it a color or depth use");
    if (numbers != (1u << colors) - 1)
        return fail(check, "its color attachments leave a number out; number them 0, 1, ...");
    if (depths > 1)
        return fail(check, "has %u depth attachments; it can have one", depths);
    if (depths && pass->raster.depth == SF_DEPTH_OFF)
        return fail(check, "has a depth attachment but its depth test is off; set raster.depth, or drop the use");
    if (!depths && pass->raster.depth != SF_DEPTH_OFF)
        return fail(check, "has a depth test but no depth attachment; add a use, or set SF_DEPTH_OFF");
    return SF_OK;
}

static enum sf_status check_domain(const struct check *check)
{
    const struct sf_pass_desc *pass = check->pass;

    if (!known(check->graph, pass->domain) || !sf_graph_get(check->graph, pass->domain)->is_image)
        return fail(check, "its domain is not an image of this graph; pass what sf_graph_image gave");
    if (!pass->local[0] || !pass->local[1])
        return fail(check, "has a domain but local is 0; say how many pixels a workgroup covers");
    return SF_OK;
}

/* Exactly one of the ways to say how much work there is. */
static enum sf_status check_work(const struct check *check)
{
    const struct sf_pass_desc *pass = check->pass;
    bool groups = pass->groups[0] || pass->groups[1] || pass->groups[2];
    bool draw = pass->vertices || pass->instances;
    uint64_t arguments = pass->kind == SF_PASS_COMPUTE ? SF_DISPATCH_ARGUMENT_BYTES : SF_DRAW_ARGUMENT_BYTES;
    int ways = (groups || pass->groups_live) + (pass->domain != 0) + (pass->indirect != 0) + (draw || pass->draw_live);

    if (ways != 1)
        return fail(check,
                    "says the size of its work %s; give one of groups, domain, indirect, or vertices and instances",
                    ways ? "twice" : "nowhere");
    if (pass->indirect) {
        /* check_uses saw that it is a buffer. */
        uint64_t bytes = sf_graph_get(check->graph, pass->indirect)->buffer.bytes;

        if (pass->indirect_offset % 4 || pass->indirect_offset > bytes || bytes - pass->indirect_offset < arguments)
            return fail(
                check,
                "its indirect arguments do not lie in '%s'; the offset is a multiple of 4 and %u bytes follow it",
                sf_graph_get(check->graph, pass->indirect)->name, (unsigned)arguments);
        return SF_OK;
    }
    if (pass->kind == SF_PASS_COMPUTE) {
        if (draw || pass->draw_live)
            return fail(check, "is a compute pass with vertices; give groups, domain or indirect");
        if (pass->domain)
            return check_domain(check);
        if (!pass->groups_live && (!pass->groups[0] || !pass->groups[1] || !pass->groups[2]))
            return fail(check, "dispatches %u x %u x %u groups; each must be at least 1", pass->groups[0],
                        pass->groups[1], pass->groups[2]);
        return SF_OK;
    }
    if (groups || pass->groups_live || pass->domain)
        return fail(check, "is a raster pass with groups or a domain; give vertices and instances, or indirect");
    if (!pass->draw_live && (!pass->vertices || !pass->instances))
        return fail(check, "draws %u vertices x %u instances; each must be at least 1", pass->vertices,
                    pass->instances);
    return SF_OK;
}

static enum sf_status check_copy(const struct check *check, sf_resource from, sf_resource to)
{
    const struct sf_graph_resource *source = sf_graph_get(check->graph, from), *target = sf_graph_get(check->graph, to);
    uint32_t w0, h0, w1, h1;

    if (source->is_image && target->is_image) {
        sf_image_extent(check->graph, from, &w0, &h0);
        sf_image_extent(check->graph, to, &w1, &h1);
        if (w0 != w1 || h0 != h1 || source->image.layers != target->image.layers)
            return fail(check, "copies '%s' (%u x %u x %u) to '%s' (%u x %u x %u); make them equal in size",
                        source->name, w0, h0, source->image.layers, target->name, w1, h1, target->image.layers);
        if (sf_format_bytes(source->image.format) != sf_format_bytes(target->image.format) ||
            (source->image.format == SF_FORMAT_D32F) != (target->image.format == SF_FORMAT_D32F))
            return fail(
                check, "copies '%s' (%s) to '%s' (%s); texels must be of one size, and depth goes to depth only",
                source->name, sf_format_name(source->image.format), target->name, sf_format_name(target->image.format));
        return SF_OK;
    }
    /* A copy between buffers may fill the front of a larger one; with an image the buffer holds all of the image. */
    if (!target->is_image && sf_resource_bytes(check->graph, from) > sf_resource_bytes(check->graph, to))
        return fail(check, "copies '%s' to '%s', which is smaller; make the target at least as large", source->name,
                    target->name);
    if (target->is_image && sf_resource_bytes(check->graph, from) < sf_resource_bytes(check->graph, to))
        return fail(check, "copies '%s' to '%s', but the buffer does not hold the whole image; make it larger",
                    source->name, target->name);
    return SF_OK;
}

static enum sf_status check_front(const struct check *check, sf_resource from, sf_resource to)
{
    const struct sf_graph_resource *source = sf_graph_get(check->graph, from), *target = sf_graph_get(check->graph, to);

    if (source->is_image || target->is_image)
        return fail(check, "copies the front of '%s' to '%s', but only buffers have one; use SF_TRANSFER_COPY",
                    source->name, target->name);
    return SF_OK;
}

static enum sf_status check_transfer(const struct check *check)
{
    const struct sf_pass_desc *pass = check->pass;
    const struct sf_graph_resource *target;

    if (pass->shader || pass->fragment || pass->push_bytes || pass->indirect || pass->domain || pass->vertices ||
        pass->instances || pass->draw_live || pass->groups_live || pass->groups[0] || pass->groups[1] ||
        pass->groups[2])
        return fail(check, "is a transfer with a shader, constants to push or a size of work; leave them out");
    if (pass->transfer == SF_TRANSFER_COPY || pass->transfer == SF_TRANSFER_FRONT) {
        if (pass->use_count != 2 || pass->uses[0].access != SF_ACCESS_TRANSFER_READ ||
            pass->uses[1].access != SF_ACCESS_TRANSFER_WRITE)
            return fail(check, "is a copy; give it two uses, transfer_read and then transfer_write");
        if (pass->transfer == SF_TRANSFER_COPY)
            return check_copy(check, pass->uses[0].resource, pass->uses[1].resource);
        return check_front(check, pass->uses[0].resource, pass->uses[1].resource);
    }
    if (pass->transfer != SF_TRANSFER_FILL)
        return fail(check, "its transfer is none of enum sf_transfer");
    if (pass->use_count != 1 || pass->uses[0].access != SF_ACCESS_TRANSFER_WRITE)
        return fail(check, "is a fill; give it one use, transfer_write");
    target = sf_graph_get(check->graph, pass->uses[0].resource);
    if (target->is_image || target->buffer.bytes % 4)
        return fail(check, "fills '%s'; only buffers of a multiple of 4 bytes can be filled", target->name);
    return SF_OK;
}

static enum sf_status check_shaders(const struct check *check)
{
    const struct sf_pass_desc *pass = check->pass;

    if (!pass->shader || !*pass->shader)
        return fail(check, "names no shader; give it as under glsl/, such as \"thick/march.comp\"");
    if (pass->kind == SF_PASS_COMPUTE && pass->fragment)
        return fail(check, "is a compute pass with a fragment shader; leave it out");
    if (pass->push_bytes > SF_PUSH_BYTES_MAX || pass->push_bytes % 4)
        return fail(check, "pushes %u bytes; at most %d, in words of 4: put more into a uniform buffer",
                    pass->push_bytes, SF_PUSH_BYTES_MAX);
    if ((pass->push != NULL) != (pass->push_bytes != 0))
        return fail(check, "`push` and `push_bytes` do not agree; give both or neither");
    return SF_OK;
}

enum sf_status sf_graph_validate_pass(const struct sf_graph *graph, const struct sf_pass_desc *pass,
                                      const struct sf_log *log)
{
    const struct check check = {graph, pass, log};
    enum sf_status status;

    if ((unsigned)pass->kind > SF_PASS_TRANSFER)
        return fail(&check, "its kind is none of enum sf_pass_kind");
    if (!(pass->coverage >= 0.0f && pass->coverage <= 1.0f))
        return fail(&check, "its coverage is not within 0..1; 0 means all");
    status = check_uses(&check);
    if (status)
        return status;
    if (pass->kind == SF_PASS_TRANSFER)
        return check_transfer(&check);
    status = check_shaders(&check);
    if (!status && pass->kind == SF_PASS_RASTER)
        status = check_attachments(&check);
    return status ? status : check_work(&check);
}
