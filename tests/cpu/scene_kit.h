/* For tests of scenes: text in, scene or message out. */
#ifndef SF_TESTS_SCENE_KIT_H
#define SF_TESTS_SCENE_KIT_H

#include "scratch.h"
#include "scene/scene.h"

/* A scene file's path in the source tree. */
static inline const char *source_path(const char *relative)
{
    static char path[1024];
    const char *root = getenv("SF_SOURCE_ROOT");

    snprintf(path, sizeof path, "%s/%s", root ? root : ".", relative);
    return path;
}

static inline struct sf_scene *parse_with(const char *text, const char *const *sets, uint32_t set_count)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_WARNING};
    struct sf_scene *scene = NULL;
    enum sf_status status = sf_scene_parse("test.json", text, strlen(text), sets, set_count, &log, &scene);

    if (status != SF_OK)
        fail_msg("%s: status %d: %s", text, (int)status, caught.text);
    assert_int_equal(caught.errors, 0);
    return scene;
}

static inline struct sf_scene *parse(const char *text)
{
    return parse_with(text, NULL, 0);
}

/* Passes when the text is refused with that status, once, in a line that holds `part`. */
static inline void refuse_with(const char *text, const char *const *sets, uint32_t set_count, enum sf_status expected,
                               const char *part)
{
    struct caught caught = {"", 0};
    struct sf_log log = {caught_write, &caught, SF_LOG_ERROR};
    struct sf_scene *scene = (struct sf_scene *)&caught;
    enum sf_status status = sf_scene_parse("test.json", text, strlen(text), sets, set_count, &log, &scene);

    if (status != expected)
        fail_msg("%.200s: status %d, not %d: %s", text, (int)status, (int)expected, caught.text);
    assert_null(scene);
    assert_caught(&caught, part);
}

static inline void refuse(const char *text, const char *part)
{
    refuse_with(text, NULL, 0, SF_ERROR_SCENE, part);
}

#endif
