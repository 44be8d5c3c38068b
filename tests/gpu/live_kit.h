/* What the tests of the renderer that changes while it runs share: scenes with sets, pictures kept and compared. */
#ifndef SF_TESTS_LIVE_KIT_H
#define SF_TESTS_LIVE_KIT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "render/renderer.h"
#include "sfumato/sfumato.h"

static struct sf_device *live_device;
static int live_errors;
static char live_message[4096]; /* the last warning or error */
static char live_said[256];     /* the last that is no warning */

static inline void live_write(void *user, enum sf_log_level level, const char *message)
{
    (void)user;
    live_errors += level == SF_LOG_ERROR;
    if (level <= SF_LOG_WARNING)
        snprintf(live_message, sizeof live_message, "%s", message);
    else
        snprintf(live_said, sizeof live_said, "%.255s", message);
    if (getenv("SF_TEST_VERBOSE"))
        fprintf(stderr, "%s\n", message);
}
static const struct sf_log live_log = {.write = live_write, .level = SF_LOG_DEBUG};

/* Files are looked for beside scenes/tiny. NULL when it is no scene. */
static inline struct sf_scene *live_try(const char *text, const char *const *sets, uint32_t count)
{
    const char *root = getenv("SF_SOURCE_ROOT");
    struct sf_scene *scene = NULL;
    char name[1024];

    snprintf(name, sizeof name, "%s/scenes/tiny/test.json", root ? root : ".");
    sf_scene_parse(name, text, strlen(text), sets, count, &live_log, &scene);
    return scene;
}

static inline struct sf_scene *live_parse(const char *text, const char *set)
{
    struct sf_scene *scene = live_try(text, &set, set ? 1 : 0);

    if (!scene)
        fail_msg("%s: %s", set ? set : "", live_message);
    return scene;
}

static inline struct sf_renderer *live_create(const struct sf_scene *scene, const struct sf_renderer_options *options)
{
    struct sf_renderer *renderer = NULL;

    if (sf_renderer_create(live_device, scene, options, &live_log, &renderer) != SF_OK)
        fail_msg("%s", live_message);
    return renderer;
}

static inline struct sf_frame live_frame(struct sf_renderer *renderer, uint32_t number)
{
    struct sf_frame frame;
    uint64_t ticket = 0;

    if (sf_renderer_render(renderer, number, &ticket) != SF_OK || sf_renderer_wait(renderer, ticket, &frame) != SF_OK)
        fail_msg("frame %u: %s", number, live_message);
    return frame;
}

/* All that came back of a frame. */
struct picture {
    struct sf_frame frame; /* without its pointers */
    size_t bytes;
    unsigned char *data;
};

static inline struct picture live_keep(const struct sf_frame *frame)
{
    size_t pixels = (size_t)frame->width * frame->height;
    const struct {
        const void *data;
        size_t bytes;
    } planes[] = {{frame->color, pixels * 8},
                  {frame->color_float, pixels * 16},
                  {frame->depth, pixels * 4},
                  {frame->smoke, pixels * 8},
                  {frame->smoke_depths, pixels * 16}};
    struct picture picture = {.frame = *frame, .data = malloc(pixels * 52)};

    assert_non_null(picture.data);
    for (size_t i = 0; i < SF_COUNT(planes); i++) {
        if (!planes[i].data)
            continue;
        memcpy(picture.data + picture.bytes, planes[i].data, planes[i].bytes);
        picture.bytes += planes[i].bytes;
    }
    return picture;
}

static inline struct picture live_picture(struct sf_renderer *renderer, uint32_t number)
{
    struct sf_frame frame = live_frame(renderer, number);

    return live_keep(&frame);
}

static inline void live_free(struct picture *picture)
{
    free(picture->data);
    picture->data = NULL;
}

static inline bool live_same(const struct picture *a, const struct picture *b)
{
    const struct sf_frame *x = &a->frame, *y = &b->frame;

    return x->width == y->width && x->height == y->height && x->frame == y->frame && x->time == y->time &&
           x->live == y->live && x->dropped == y->dropped &&
           memcmp(x->bounds_min, y->bounds_min, sizeof x->bounds_min) == 0 &&
           memcmp(x->bounds_max, y->bounds_max, sizeof x->bounds_max) == 0 &&
           memcmp(x->world_to_camera, y->world_to_camera, sizeof x->world_to_camera) == 0 &&
           memcmp(x->world_to_clip, y->world_to_clip, sizeof x->world_to_clip) == 0 && a->bytes == b->bytes &&
           memcmp(a->data, b->data, a->bytes) == 0;
}

/* The frame of a renderer made for this and nothing else. */
static inline struct picture live_fresh(const struct sf_scene *scene, const struct sf_renderer_options *options,
                                        uint32_t number)
{
    struct sf_renderer *renderer = live_create(scene, options);
    struct picture picture = live_picture(renderer, number);

    sf_renderer_destroy(&renderer);
    return picture;
}

/* Fails unless the renderer draws what a fresh one does; both pictures are dropped. */
static inline void live_compare(struct sf_renderer *renderer, const struct sf_scene *scene,
                                const struct sf_renderer_options *options, uint32_t number, const char *what)
{
    struct picture got = live_picture(renderer, number), want = live_fresh(scene, options, number);
    bool same = live_same(&got, &want);

    live_free(&got);
    live_free(&want);
    if (!same)
        fail_msg("%s: frame %u is not that of a fresh renderer", what, number);
}

static inline bool live_count(void *user, uint64_t done, uint64_t total)
{
    (void)done;
    (void)total;
    ++*(int *)user;
    return true;
}

/* Whether the simulation must make more steps than those of one frame to come to it. */
static inline bool live_restarted(struct sf_renderer *renderer, uint32_t next)
{
    int calls = 0;

    assert_int_equal(sf_renderer_seek(renderer, next, live_count, &calls), SF_OK);
    return calls > 0;
}

static inline int live_open(void **state)
{
    const struct sf_device_options options = {.validate = true, .no_cache = true};

    (void)state;
    return sf_device_create(&options, &live_log, &live_device);
}

/* Nothing may have been said by the layers, not even while the device goes. */
static inline int live_close(void **state)
{
    int messages = (int)sf_device_validation_messages(live_device);

    (void)state;
    live_errors = 0;
    sf_device_destroy(&live_device);
    if (messages + live_errors)
        fprintf(stderr, "%d validation messages, %d at the end: %s\n", messages, live_errors, live_message);
    return messages + live_errors;
}

/* 77 without a device. */
static inline int live_probe(void)
{
    const struct sf_device_options options = {.validate = true, .no_cache = true};
    enum sf_status status = sf_device_create(&options, NULL, &live_device);

    sf_device_destroy(&live_device);
    return status == SF_ERROR_DEVICE ? 77 : 0;
}

/* Two kinds of each thing, so that every group has controls. Small: a change is quick. */
static const char live_sky[] =
    "{\"camera\":{\"type\":\"orbit\",\"eye\":[1.5,1.2,3],\"target\":[0,0.7,0],\"period\":3},"
    "\"lights\":[{\"type\":\"directional\",\"direction\":[-1,-1.5,-0.4],\"intensity\":2},"
    "{\"type\":\"spot\",\"position\":[1.5,2.5,1],\"direction\":[-1.5,-2,-1],\"intensity\":20}],"
    "\"objects\":[{\"type\":\"plane\",\"checker\":0.5},{\"type\":\"sphere\",\"position\":[0.5,0.3,0],\"radius\":0.3},"
    "{\"type\":\"box\",\"position\":[-0.6,0.2,0.1],\"size\":[0.3,0.4,0.3],\"rotation\":[0,20,0]}],"
    "\"medium\":{\"extinction\":9,\"g\":0.2,\"emission\":[0.02,0.01,0]},"
    "\"ramp\":[{\"at\":0,\"color\":[1,0.8,0.6]},{\"at\":1,\"color\":[0.8,0.9,1]}],"
    "\"emitters\":[{\"type\":\"cone\",\"position\":[0,0.1,0],\"rate\":150,\"burst\":12,\"lifetime\":[0.4,0.7],"
    "\"speed\":[1,1.4],\"particle_radius\":[0.08,0.14],\"temperature\":40,\"path\":[{\"time\":0,\"position\":[0,0,0]},"
    "{\"time\":0.4,\"position\":[0.2,0,0.3]},{\"time\":0.8,\"position\":[0,0,0]}]},"
    "{\"type\":\"box\",\"position\":[0.3,0.9,0],\"size\":[0.3,0.2,0.3],\"rate\":80,\"lifetime\":0.5,\"speed\":0.3}],"
    "\"forces\":[{\"type\":\"gravity\",\"acceleration\":[0,-0.3,0]},{\"type\":\"buoyancy\",\"strength\":0.05},"
    "{\"type\":\"turbulence\",\"strength\":0.6,\"octaves\":2},{\"type\":\"drag\",\"strength\":2}],"
    "\"environment\":{\"type\":\"sky\"},"
    "\"sim\":{\"capacity\":256,\"fps\":24,\"substeps\":2,\"preroll\":0.25},"
    "\"shadow\":{\"map_size\":64,\"softness\":1.2},"
    "\"thick\":{\"steps\":5,\"light_size\":48,"
    "\"octaves\":2},\"larsson\":{\"blur\":2,\"soft\":0.05,\"density_blur\":0.4,\"life_fade\":0.3}}";

static const char live_lists[] =
    "{\"camera\":{\"type\":\"keyframes\",\"keys\":[{\"time\":0,\"eye\":[1.5,1.2,3],\"target\":[0,0.7,0]},"
    "{\"time\":1,\"eye\":[-1,1,3],\"target\":[0,0.5,0],\"fov\":50}]},"
    "\"lights\":[{\"type\":\"point\",\"position\":[-1,2,1],\"intensity\":8}],"
    "\"objects\":[{\"type\":\"plane\",\"albedo\":[0.4,0.5,0.3]},"
    "{\"type\":\"cylinder\",\"position\":[0.6,0.3,0],\"radius\":0.2,\"height\":0.6},"
    "{\"type\":\"mesh\",\"file\":\"../assets/pyramid.gltf\",\"position\":[-0.5,0,0.3],\"scale\":0.4}],"
    "\"emitters\":[{\"type\":\"sphere\",\"position\":[0,0.6,0],\"direction\":[0,0,0],\"radius\":0.2,\"rate\":100,"
    "\"lifetime\":0.6,\"speed\":0.3,\"particle_radius\":0.1},"
    "{\"type\":\"mesh\",\"file\":\"../assets/pyramid.gltf\",\"position\":[-0.5,0,0.3],\"scale\":0.4,\"rate\":60,"
    "\"lifetime\":0.5,\"speed\":0.3,\"particle_radius\":0.08},"
    "{\"type\":\"list\",\"particles\":[{\"centre\":[0.2,0.5,0.4],\"radius\":0.2,\"velocity\":[0,0.2,0],"
    "\"lifetime\":2,\"age\":0.1,\"tile\":1},{\"centre\":[-0.3,0.9,0.1],\"radius\":0.15}]},"
    "{\"type\":\"list\",\"file\":\"../assets/tiny.csv\",\"start\":0.05}],"
    "\"forces\":[{\"type\":\"wind\",\"velocity\":[0.4,0,0]},{\"type\":\"drag\",\"strength\":2},"
    "{\"type\":\"vortex\",\"strength\":0.5,\"position\":[0,0,0.1]}],"
    "\"environment\":{\"type\":\"latlong\",\"file\":\"../assets/dusk.hdr\",\"rotation\":20},"
    "\"sim\":{\"capacity\":200,\"fps\":24,\"substeps\":1},\"shadow\":{\"map_size\":64},"
    "\"thick\":{\"steps\":4,\"light_size\":48,\"resolution\":\"full\",\"detail\":0},\"larsson\":{\"blur\":1}}";

#endif
