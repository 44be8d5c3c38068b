/* For tests over all scenes that ship, and over their controls. */
#ifndef SF_TESTS_SHIPPED_KIT_H
#define SF_TESTS_SHIPPED_KIT_H

#include "scene_kit.h"

/* Calls `visit` with the path of every scene; returns how many there were. */
static inline unsigned each_shipped(void (*visit)(const char *path))
{
    static const char *const folders[] = {"scenes", "scenes/tiny"};
    unsigned count = 0;

    for (int i = 0; i < 2; i++) {
        char root[1024], path[2048];
        struct dirent *entry;
        DIR *list;

        snprintf(root, sizeof root, "%s", source_path(folders[i]));
        assert_non_null(list = opendir(root));
        while ((entry = readdir(list))) {
            size_t length = strlen(entry->d_name);

            if (length < 5 || strcmp(entry->d_name + length - 5, ".json") != 0)
                continue;
            snprintf(path, sizeof path, "%s/%s", root, entry->d_name);
            visit(path);
            count++;
        }
        closedir(list);
    }
    return count;
}

static inline struct sf_scene *load_with(const char *path, const char *const *sets, uint32_t set_count)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    struct sf_scene *scene = NULL;

    if (sf_scene_load(path, sets, set_count, &log, &scene) != SF_OK)
        fail_msg("%s with %s: %s", path, set_count ? sets[0] : "no set", caught.text);
    return scene;
}

struct controls {
    struct sf_control *list;
    uint32_t count;
};

static inline struct controls controls_of(const struct sf_scene *scene)
{
    struct controls controls;

    assert_int_equal(sf_scene_controls(scene, NULL, &controls.list, &controls.count), SF_OK);
    return controls;
}

static inline const struct sf_control *find_control(const struct controls *controls, const char *path)
{
    for (uint32_t i = 0; i < controls->count; i++)
        if (strcmp(controls->list[i].path, path) == 0)
            return &controls->list[i];
    return NULL;
}

static inline bool same_text(const char *a, const char *b)
{
    return a == b || (a && b && strcmp(a, b) == 0);
}

/* Same parameters with the same bits; `why` goes into the message. */
static inline void assert_same_controls(const struct controls *a, const struct controls *b, bool texts, const char *why)
{
    for (uint32_t i = 0; i < a->count && i < b->count; i++) {
        const struct sf_control *x = &a->list[i], *y = &b->list[i];

        if (strcmp(x->path, y->path) != 0)
            fail_msg("%s: %s has become %s", why, x->path, y->path);
        if (memcmp(x->value, y->value, sizeof x->value) != 0 || (texts && !same_text(x->text, y->text)))
            fail_msg("%s: %s has changed: %.9g %.9g %.9g '%s', now %.9g %.9g %.9g '%s'", why, x->path, x->value[0],
                     x->value[1], x->value[2], x->text ? x->text : "", y->value[0], y->value[1], y->value[2],
                     y->text ? y->text : "");
    }
    if (a->count != b->count)
        fail_msg("%s: %u parameters, now %u", why, (unsigned)a->count, (unsigned)b->count);
}

#endif
