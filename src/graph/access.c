/* The tables of what an access, a format, a lifetime and a kind of pass are. */
#include "graph/internal.h"

enum {
    COMPUTE = 1 << SF_PASS_COMPUTE,
    RASTER = 1 << SF_PASS_RASTER,
    TRANSFER = 1 << SF_PASS_TRANSFER,
    SHADERS = COMPUTE | RASTER,
};

static const struct access_row {
    const char *name;
    bool reads, writes, on_image, on_buffer, shader, attachment;
    unsigned kinds; /* of pass that may make it */
    enum sf_layout layout;
} accesses[SF_ACCESS_COUNT] = {
    [SF_ACCESS_NONE] = {.name = "none"},
    [SF_ACCESS_SAMPLED] = {"sampled", true, false, true, false, true, false, SHADERS, SF_LAYOUT_SAMPLED},
    [SF_ACCESS_UNIFORM] = {"uniform", true, false, false, true, true, false, SHADERS, SF_LAYOUT_NONE},
    [SF_ACCESS_STORAGE_READ] = {"storage_read", true, false, true, true, true, false, SHADERS, SF_LAYOUT_GENERAL},
    [SF_ACCESS_STORAGE_WRITE] = {"storage_write", false, true, true, true, true, false, SHADERS, SF_LAYOUT_GENERAL},
    [SF_ACCESS_STORAGE_MODIFY] = {"storage_modify", true, true, true, true, true, false, SHADERS, SF_LAYOUT_GENERAL},
    [SF_ACCESS_INDIRECT] = {"indirect", true, false, false, true, false, false, SHADERS, SF_LAYOUT_NONE},
    [SF_ACCESS_COLOR] = {"color", true, true, true, false, false, true, RASTER, SF_LAYOUT_COLOR},
    [SF_ACCESS_DEPTH] = {"depth", true, true, true, false, false, true, RASTER, SF_LAYOUT_DEPTH},
    [SF_ACCESS_DEPTH_READ] = {"depth_read", true, false, true, false, false, true, RASTER, SF_LAYOUT_DEPTH_READ},
    [SF_ACCESS_TRANSFER_READ] = {"transfer_read", true, false, true, true, false, false, TRANSFER,
                                 SF_LAYOUT_TRANSFER_READ},
    [SF_ACCESS_TRANSFER_WRITE] = {"transfer_write", false, true, true, true, false, false, TRANSFER,
                                  SF_LAYOUT_TRANSFER_WRITE},
    [SF_ACCESS_HOST_READ] = {"host_read", true, false, false, true, false, false, 0, SF_LAYOUT_NONE},
    [SF_ACCESS_PRESENT] = {"present", true, false, true, false, false, false, 0, SF_LAYOUT_PRESENT},
};

static const struct access_row *access_row(enum sf_access access)
{
    return &accesses[(unsigned)access < SF_ACCESS_COUNT ? access : SF_ACCESS_NONE];
}

const char *sf_access_name(enum sf_access access)
{
    return access_row(access)->name;
}

bool sf_access_writes(enum sf_access access)
{
    return access_row(access)->writes;
}

bool sf_access_reads(enum sf_access access)
{
    return access_row(access)->reads;
}

bool sf_access_suits(enum sf_access access, bool image)
{
    return image ? access_row(access)->on_image : access_row(access)->on_buffer;
}

bool sf_access_in_kind(enum sf_access access, enum sf_pass_kind kind)
{
    return access_row(access)->kinds >> kind & 1;
}

bool sf_access_by_pass(enum sf_access access)
{
    return access_row(access)->kinds != 0;
}

bool sf_access_in_shader(enum sf_access access)
{
    return access_row(access)->shader;
}

bool sf_access_attaches(enum sf_access access)
{
    return access_row(access)->attachment;
}

enum sf_layout sf_access_layout(enum sf_access access, enum sf_format format)
{
    if (format == SF_FORMAT_NONE)
        return SF_LAYOUT_NONE;
    /* One layout for both read-only uses of depth, so that they can be had at once and share a barrier. */
    if (access == SF_ACCESS_SAMPLED && format == SF_FORMAT_D32F)
        return SF_LAYOUT_DEPTH_READ;
    return access_row(access)->layout;
}

uint32_t sf_access_outside(enum sf_access access, struct sf_touch touches[2])
{
    unsigned kinds = access_row(access)->kinds ? access_row(access)->kinds : TRANSFER;
    uint32_t count = 0;

    for (enum sf_pass_kind kind = SF_PASS_COMPUTE; kind <= SF_PASS_TRANSFER; kind++)
        if (kinds >> kind & 1)
            touches[count++] = (struct sf_touch){access, kind};
    return count;
}

bool sf_use_overwrites(const struct sf_use *use)
{
    if (use->access == SF_ACCESS_STORAGE_WRITE || use->access == SF_ACCESS_TRANSFER_WRITE)
        return true;
    return (use->access == SF_ACCESS_COLOR || use->access == SF_ACCESS_DEPTH) && use->load != SF_LOAD_KEEP;
}

static const struct {
    const char *name;
    uint32_t bytes;
} formats[SF_FORMAT_COUNT] = {
    [SF_FORMAT_NONE] = {"none", 0},
    [SF_FORMAT_R8_UNORM] = {"r8_unorm", 1},
    [SF_FORMAT_RGBA8_UNORM] = {"rgba8_unorm", 4},
    [SF_FORMAT_RGBA8_SRGB] = {"rgba8_srgb", 4},
    [SF_FORMAT_BGRA8_UNORM] = {"bgra8_unorm", 4},
    [SF_FORMAT_R16F] = {"r16f", 2},
    [SF_FORMAT_RG16F] = {"rg16f", 4},
    [SF_FORMAT_RGBA16F] = {"rgba16f", 8},
    [SF_FORMAT_R32F] = {"r32f", 4},
    [SF_FORMAT_RG32F] = {"rg32f", 8},
    [SF_FORMAT_RGBA32F] = {"rgba32f", 16},
    [SF_FORMAT_R32_UINT] = {"r32_uint", 4},
    [SF_FORMAT_D32F] = {"d32f", 4},
};

const char *sf_format_name(enum sf_format format)
{
    return formats[(unsigned)format < SF_FORMAT_COUNT ? format : SF_FORMAT_NONE].name;
}

uint32_t sf_format_bytes(enum sf_format format)
{
    return formats[(unsigned)format < SF_FORMAT_COUNT ? format : SF_FORMAT_NONE].bytes;
}

const char *sf_lifetime_name(enum sf_lifetime lifetime)
{
    switch (lifetime) {
    case SF_TRANSIENT:
        return "transient";
    case SF_PERSISTENT:
        return "persistent";
    case SF_HISTORY:
        return "history";
    case SF_IMPORTED:
        return "imported";
    case SF_UPLOAD:
        return "upload";
    case SF_READBACK:
        return "readback";
    }
    return "none";
}

const char *sf_pass_kind_name(enum sf_pass_kind kind)
{
    switch (kind) {
    case SF_PASS_COMPUTE:
        return "compute";
    case SF_PASS_RASTER:
        return "raster";
    case SF_PASS_TRANSFER:
        return "transfer";
    }
    return "none";
}
