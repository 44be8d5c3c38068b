/* A screen of the test's own (Xvfb), a window on it by GLFW, and what the screen shows. No window manager: a window
 * stands where it is put and is as large as it is told. Without Xvfb the test is to be skipped. */
#ifndef SF_TESTS_SCREEN_KIT_H
#define SF_TESTS_SCREEN_KIT_H

#include <vulkan/vulkan_core.h>
#include <GLFW/glfw3.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include "sfumato/sfumato.h"

struct kit_screen {
    pid_t server;
    char folder[64]; /* where Xvfb keeps its framebuffer, as a file in the form of xwd */
    GLFWwindow *window;
    struct sf_surface_source source; /* of the window; for the device's options */
};

static inline enum sf_status kit_screen_surface(void *user, void *instance, uint64_t *surface)
{
    VkSurfaceKHR handle = VK_NULL_HANDLE;
    VkResult result = glfwCreateWindowSurface((VkInstance)instance, user, NULL, &handle);

    *surface = (uint64_t)handle;
    return result == VK_SUCCESS ? SF_OK : SF_ERROR_DEVICE;
}

static inline void kit_screen_close(struct kit_screen *screen)
{
    char file[96];

    if (screen->window)
        glfwDestroyWindow(screen->window);
    glfwTerminate();
    if (screen->server > 0) {
        kill(screen->server, SIGTERM);
        waitpid(screen->server, NULL, 0);
    }
    snprintf(file, sizeof file, "%s/Xvfb_screen0", screen->folder);
    unlink(file);
    rmdir(screen->folder);
    *screen = (struct kit_screen){0};
}

/* Starts the server on a display that is free; the number of the display, or -1. */
static inline int kit_screen_serve(struct kit_screen *screen)
{
    int ends[2], number = -1;
    char text[16] = {0}, descriptor[16];
    size_t length = 0;

    if (pipe(ends) != 0)
        return -1;
    screen->server = fork();
    if (screen->server == 0) {
        close(ends[0]);
        if (!freopen("/dev/null", "w", stderr))
            _exit(127);
        snprintf(descriptor, sizeof descriptor, "%d", ends[1]);
        /* -terminate: it ends with its last client, however the test ends. */
        execlp("Xvfb", "Xvfb", "-displayfd", descriptor, "-screen", "0", "1024x768x24", "-nolisten", "tcp",
               "-terminate", "-fbdir", screen->folder, (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    while (length < sizeof text - 1 && read(ends[0], text + length, 1) == 1 && text[length] != '\n')
        length++;
    close(ends[0]);
    if (text[length] == '\n' && sscanf(text, "%d", &number) != 1)
        number = -1;
    return number;
}

/* False, with the reason on stderr and nothing left behind, when there can be no window here. */
static inline bool kit_screen_open(struct kit_screen *screen, int width, int height)
{
    const char *wrong = "no Xvfb";
    char display[16];
    int number;

    *screen = (struct kit_screen){0};
    snprintf(screen->folder, sizeof screen->folder, "/tmp/sfumato-screen-XXXXXX");
    if (!mkdtemp(screen->folder)) {
        fprintf(stderr, "skipped: no folder for the screen\n");
        return false;
    }
    number = kit_screen_serve(screen);
    if (number >= 0) {
        snprintf(display, sizeof display, ":%d", number);
        setenv("DISPLAY", display, 1);
        unsetenv("WAYLAND_DISPLAY");
        wrong = "GLFW finds no Vulkan";
        if (glfwInit() && glfwVulkanSupported()) {
            glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
            wrong = "no window";
            screen->window = glfwCreateWindow(width, height, "test", NULL, NULL);
        }
    }
    if (!screen->window) {
        fprintf(stderr, "skipped: %s\n", wrong);
        kit_screen_close(screen);
        return false;
    }
    glfwSetWindowPos(screen->window, 0, 0);
    screen->source = (struct sf_surface_source){.create = kit_screen_surface, .user = screen->window};
    screen->source.extensions = glfwGetRequiredInstanceExtensions(&screen->source.extension_count);
    return true;
}

static inline void kit_screen_pause(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 5000000}, NULL);
}

/* Sets the window's size and waits until the framebuffer has it. */
static inline bool kit_screen_resize(const struct kit_screen *screen, int width, int height)
{
    int w = 0, h = 0;

    glfwSetWindowSize(screen->window, width, height);
    for (int i = 0; i < 1000 && (w != width || h != height); i++) {
        glfwPollEvents();
        glfwGetFramebufferSize(screen->window, &w, &h);
        if (w != width || h != height)
            kit_screen_pause();
    }
    return w == width && h == height;
}

/* 0xRRGGBB that the screen shows now at that place, y down; -1 when it cannot be read. */
static inline long kit_screen_pixel(const struct kit_screen *screen, int x, int y)
{
    enum { HEADER_SIZE = 0, BITS = 11, LINE_BYTES = 12, COLORS = 19, WORDS = 20, COLOR_BYTES = 12 };
    uint8_t header[WORDS * 4], pixel[4];
    uint32_t words[WORDS];
    char name[96];
    FILE *file;
    long result = -1;

    snprintf(name, sizeof name, "%s/Xvfb_screen0", screen->folder);
    file = fopen(name, "rb");
    if (!file)
        return -1;
    if (fread(header, sizeof header, 1, file) == 1) {
        for (int i = 0; i < WORDS; i++)
            words[i] = (uint32_t)header[4 * i] << 24 | (uint32_t)header[4 * i + 1] << 16 |
                       (uint32_t)header[4 * i + 2] << 8 | header[4 * i + 3];
        if (words[BITS] == 32 &&
            fseek(file,
                  (long)(words[HEADER_SIZE] + words[COLORS] * COLOR_BYTES + (uint32_t)y * words[LINE_BYTES] +
                         4 * (uint32_t)x),
                  SEEK_SET) == 0 &&
            fread(pixel, sizeof pixel, 1, file) == 1)
            result = (long)pixel[2] << 16 | (long)pixel[1] << 8 | pixel[0];
    }
    fclose(file);
    return result;
}

/* Waits until the screen shows this there: pictures come when the server gets to it. */
static inline bool kit_screen_shows(const struct kit_screen *screen, int x, int y, long rgb)
{
    for (int i = 0; i < 1000; i++) {
        if (kit_screen_pixel(screen, x, y) == rgb)
            return true;
        kit_screen_pause();
    }
    return false;
}

#endif
