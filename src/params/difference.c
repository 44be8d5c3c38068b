/* What differs between two structs that the same rows describe, and what that makes anew. */
#include <string.h>
#include "params/params.h"

enum { FILES = sizeof(sf_param_files) / sizeof(const char *) };

static bool same_text(const char *a, const char *b)
{
    return a == b || (a && b && strcmp(a, b) == 0);
}

static bool same_strings(const char *before, const char *after, unsigned count)
{
    sf_param_files a, b;

    memcpy(a, before, count * sizeof a[0]);
    memcpy(b, after, count * sizeof b[0]);
    for (unsigned i = 0; i < count; i++)
        if (!same_text(a[i], b[i]))
            return false;
    return true;
}

static const char *elements(const struct sf_param *row, const void *object, uint32_t *count)
{
    const char *field = (const char *)object + row->offset, *pointed;

    memcpy(count, (const char *)object + row->count_offset, sizeof *count);
    if (!row->list_pointer)
        return field;
    memcpy(&pointed, field, sizeof pointed);
    return pointed;
}

static unsigned list_difference(const struct sf_param *row, const void *before, const void *after, unsigned bits)
{
    uint32_t count, count_after;
    const char *a = elements(row, before, &count), *b = elements(row, after, &count_after);
    unsigned found = 0;

    if (count != count_after)
        return bits | SF_REBUILD_READ | sf_param_rebuild_all(row->group);
    for (uint32_t i = 0; i < count; i++)
        found |= sf_param_difference(row->group, a + i * row->group->size, b + i * row->group->size, bits);
    return found;
}

unsigned sf_param_difference(const struct sf_param_group *group, const void *before, const void *after,
                             unsigned inherited)
{
    unsigned found = 0;

    if (memcmp(before, after, group->size) == 0) /* pointers too, so all that they lead to */
        return 0;
    for (size_t i = 0; i < group->count; i++) {
        const struct sf_param *row = &group->rows[i];
        const char *a = (const char *)before + row->offset, *b = (const char *)after + row->offset;
        unsigned bits = row->rebuild | inherited;
        bool same;

        switch (row->type) {
        case SF_PARAM_OBJECT:
            found |= sf_param_difference(row->group, a, b, bits);
            continue;
        case SF_PARAM_LIST:
            found |= list_difference(row, before, after, bits);
            continue;
        case SF_PARAM_STRING:
            same = same_strings(a, b, 1);
            break;
        case SF_PARAM_FILES:
            same = same_strings(a, b, FILES);
            break;
        case SF_PARAM_BOOL:
            same = memcmp(a, b, sizeof(bool)) == 0;
            break;
        default:
            same = memcmp(a, b, sf_param_components(row) * sizeof(float)) == 0;
        }
        if (!same)
            found |= bits | SF_REBUILD_READ;
    }
    return found;
}

unsigned sf_param_rebuild_all(const struct sf_param_group *group)
{
    unsigned all = 0;

    for (size_t i = 0; i < group->count; i++)
        all |= group->rows[i].rebuild | (group->rows[i].group ? sf_param_rebuild_all(group->rows[i].group) : 0);
    return all;
}

const char *sf_param_renews(unsigned rebuild)
{
    if (rebuild & SF_REBUILD_SIM)
        return "simulation";
    if (rebuild & SF_REBUILD_GRAPH)
        return "graph";
    return rebuild & SF_REBUILD_ASSETS ? "files" : "";
}
