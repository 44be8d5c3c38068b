#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "screen.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"
#include "surface.h"

enum { DROPPED = 16, REASON_BYTES = 256 };

struct sf_screen {
    GLFWwindow *window;
    const struct sf_log *log;
    struct sf_surface_source surface;
    bool happened;
    struct sf_key keys[SF_KEYS_MAX]; /* a ring: the oldest at `first` */
    unsigned first, count;
    char *dropped[DROPPED];
    unsigned dropped_count;
    int windowed[4]; /* place and size before full screen */
};

/* GLFW says why through this, before the call that failed comes back. */
static char reason[REASON_BYTES];

static void on_error(int code, const char *text)
{
    (void)code;
    snprintf(reason, sizeof reason, "%s", text);
    sf_console_say(SF_LOG_DEBUG, "GLFW: %s", text);
}

static struct sf_screen *screen_of(GLFWwindow *window)
{
    struct sf_screen *screen = glfwGetWindowUserPointer(window);

    screen->happened = true;
    return screen;
}

static void on_key(GLFWwindow *window, int key, int scancode, int action, int mods)
{
    struct sf_screen *screen = screen_of(window);

    (void)scancode;
    if (action == GLFW_RELEASE || key == GLFW_KEY_UNKNOWN || screen->count == SF_KEYS_MAX)
        return;
    screen->keys[(screen->first + screen->count++) % SF_KEYS_MAX] = (struct sf_key){key, mods, sf_now_ns()};
}

static void on_drop(GLFWwindow *window, int count, const char **paths)
{
    struct sf_screen *screen = screen_of(window);

    for (int i = 0; i < count && screen->dropped_count < DROPPED; i++) {
        size_t length = strlen(paths[i]) + 1;
        char *copy = malloc(length);

        if (copy)
            screen->dropped[screen->dropped_count++] = memcpy(copy, paths[i], length);
    }
}

/* These only wake the loop: the ui and the loop read the state themselves. */
static void on_two_ints(GLFWwindow *window, int a, int b)
{
    (void)a, (void)b;
    screen_of(window);
}

static void on_two_reals(GLFWwindow *window, double a, double b)
{
    (void)a, (void)b;
    screen_of(window);
}

static void on_button(GLFWwindow *window, int button, int action, int mods)
{
    (void)button, (void)action, (void)mods;
    screen_of(window);
}

static void on_flag(GLFWwindow *window, int flag)
{
    (void)flag;
    screen_of(window);
}

static void on_sign(GLFWwindow *window, unsigned sign)
{
    (void)sign;
    screen_of(window);
}

static void on_refresh(GLFWwindow *window)
{
    screen_of(window);
}

static void hook(struct sf_screen *screen)
{
    GLFWwindow *window = screen->window;

    glfwSetWindowUserPointer(window, screen);
    glfwSetKeyCallback(window, on_key);
    glfwSetDropCallback(window, on_drop);
    glfwSetCharCallback(window, on_sign);
    glfwSetMouseButtonCallback(window, on_button);
    glfwSetCursorPosCallback(window, on_two_reals);
    glfwSetScrollCallback(window, on_two_reals);
    glfwSetFramebufferSizeCallback(window, on_two_ints);
    glfwSetWindowIconifyCallback(window, on_flag);
    glfwSetWindowFocusCallback(window, on_flag);
    glfwSetWindowRefreshCallback(window, on_refresh);
}

enum sf_status sf_screen_create(const char *title, uint32_t width, uint32_t height, bool fullscreen,
                                const struct sf_log *log, struct sf_screen **out)
{
    struct sf_screen *screen = calloc(1, sizeof *screen);

    *out = NULL;
    if (!screen)
        return sf_console_fail(SF_ERROR_MEMORY, "out of memory");
    screen->log = log;
    glfwSetErrorCallback(on_error);
    if (!glfwInit()) {
        free(screen);
        return sf_console_fail(SF_ERROR_DEVICE,
                               "there is no display to open a window on (%s); 'sfumato capture' renders without one",
                               reason[0] ? reason : "GLFW says no more");
    }
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "sfumato");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "sfumato");
    screen->window = glfwCreateWindow((int)width, (int)height, title, NULL, NULL);
    if (!screen->window) {
        glfwTerminate();
        free(screen);
        return sf_console_fail(SF_ERROR_DEVICE, "cannot open a window (%s); 'sfumato capture' renders without one",
                               reason);
    }
    if (!glfwVulkanSupported()) {
        sf_screen_destroy(&screen);
        return sf_console_fail(SF_ERROR_DEVICE,
                               "no Vulkan driver can draw into windows of this display (%s); 'sfumato capture' renders "
                               "without one",
                               reason[0] ? reason : "the loader offers no surface");
    }
    hook(screen);
    screen->surface.extensions = glfwGetRequiredInstanceExtensions(&screen->surface.extension_count);
    screen->surface.create = sf_surface_create;
    screen->surface.user = screen->window;
    if (fullscreen)
        sf_screen_set_fullscreen(screen, true);
    *out = screen;
    return SF_OK;
}

void sf_screen_destroy(struct sf_screen **out)
{
    struct sf_screen *screen = out ? *out : NULL;

    if (!screen)
        return;
    glfwDestroyWindow(screen->window);
    glfwTerminate();
    for (unsigned i = 0; i < screen->dropped_count; i++)
        free(screen->dropped[i]);
    free(screen);
    *out = NULL;
}

struct GLFWwindow *sf_screen_window(struct sf_screen *screen)
{
    return screen->window;
}

const struct sf_surface_source *sf_screen_surface(struct sf_screen *screen)
{
    return &screen->surface;
}

void sf_screen_title(struct sf_screen *screen, const char *title)
{
    glfwSetWindowTitle(screen->window, title);
}

bool sf_screen_poll(struct sf_screen *screen, double seconds)
{
    bool happened;

    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
    happened = screen->happened;
    screen->happened = false;
    return happened;
}

bool sf_screen_closed(const struct sf_screen *screen)
{
    return glfwWindowShouldClose(screen->window);
}

void sf_screen_size(const struct sf_screen *screen, uint32_t *width, uint32_t *height)
{
    int size[2] = {0, 0};

    if (!glfwGetWindowAttrib(screen->window, GLFW_ICONIFIED))
        glfwGetFramebufferSize(screen->window, &size[0], &size[1]);
    *width = size[0] > 0 && size[1] > 0 ? (uint32_t)size[0] : 0;
    *height = *width > 0 ? (uint32_t)size[1] : 0;
}

float sf_screen_scale(const struct sf_screen *screen)
{
    float x = 1, y = 1;

    glfwGetWindowContentScale(screen->window, &x, &y);
    return x > 0 ? x : 1;
}

bool sf_screen_fullscreen(const struct sf_screen *screen)
{
    return glfwGetWindowMonitor(screen->window) != NULL;
}

void sf_screen_set_fullscreen(struct sf_screen *screen, bool fullscreen)
{
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;
    int *at = screen->windowed;

    if (fullscreen == sf_screen_fullscreen(screen))
        return;
    if (!fullscreen) {
        glfwSetWindowMonitor(screen->window, NULL, at[0], at[1], at[2], at[3], GLFW_DONT_CARE);
    } else if (mode) {
        glfwGetWindowPos(screen->window, &at[0], &at[1]);
        glfwGetWindowSize(screen->window, &at[2], &at[3]);
        glfwSetWindowMonitor(screen->window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    } else if (screen->log) {
        screen->log->write(screen->log->user, SF_LOG_WARNING, "this display has no screen to fill");
    }
}

void sf_screen_copy(struct sf_screen *screen, const char *text)
{
    glfwSetClipboardString(screen->window, text);
}

char *sf_screen_dropped(struct sf_screen *screen)
{
    char *path = screen->dropped_count > 0 ? screen->dropped[0] : NULL;

    if (path)
        memmove(screen->dropped, screen->dropped + 1, --screen->dropped_count * sizeof path);
    return path;
}

bool sf_screen_key(struct sf_screen *screen, struct sf_key *key)
{
    if (screen->count == 0)
        return false;
    *key = screen->keys[screen->first];
    screen->first = (screen->first + 1) % SF_KEYS_MAX;
    screen->count--;
    return true;
}

unsigned sf_screen_keys(const struct sf_screen *screen, struct sf_key keys[SF_KEYS_MAX])
{
    for (unsigned i = 0; i < screen->count; i++)
        keys[i] = screen->keys[(screen->first + i) % SF_KEYS_MAX];
    return screen->count;
}

bool sf_screen_held(const struct sf_screen *screen, int key)
{
    return glfwGetKey(screen->window, key) == GLFW_PRESS;
}

int sf_screen_mods(const struct sf_screen *screen)
{
    static const struct {
        int key, mod;
    } keys[] = {{GLFW_KEY_LEFT_SHIFT, GLFW_MOD_SHIFT},     {GLFW_KEY_RIGHT_SHIFT, GLFW_MOD_SHIFT},
                {GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL}, {GLFW_KEY_RIGHT_CONTROL, GLFW_MOD_CONTROL},
                {GLFW_KEY_LEFT_ALT, GLFW_MOD_ALT},         {GLFW_KEY_RIGHT_ALT, GLFW_MOD_ALT}};
    int mods = 0;

    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        mods |= sf_screen_held(screen, keys[i].key) ? keys[i].mod : 0;
    return mods;
}
