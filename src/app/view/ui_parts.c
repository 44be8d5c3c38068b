#include "ui_parts.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../console.h"

static const double TIP_S = 0.35;  /* the mouse rests so long before a tooltip comes */
static const double BLINK_S = 0.3; /* a text cursor's */
enum { WORDS_BYTES = 2048, FIELD_BYTES = 1024 };

const uint32_t sf_ui_plain = 0xffd8dee3, sf_ui_dim = 0xff868e94, sf_ui_accent = 0xff66a0d9, sf_ui_warning = 0xff5cc8ec,
               sf_ui_error = 0xff6474ea;

const char *sf_ui_parts_font(void)
{
    static const char *const files[] = {
        "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",   /* Debian */
        "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf", /* Fedora */
        "/usr/share/fonts/TTF/DejaVuSans.ttf",               /* Arch */
    };

    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++)
        if (access(files[i], R_OK) == 0)
            return files[i];
    return NULL;
}

/* Latin 1; Greek; dashes and dots; raised and lowered digits; arrows; signs of mathematics; shapes; ticks. */
const uint16_t sf_ui_parts_glyphs[] = {0x20,   0xff,   0x391,  0x3c9,  0x2010, 0x2026, 0x2070, 0x2089, 0x2190, 0x21bb,
                                       0x2211, 0x221e, 0x2248, 0x2265, 0x25a0, 0x25cf, 0x2713, 0x2717, 0};

/* Warm greys over near black, and one accent for what is chosen, held or changed. */
const uint32_t *sf_ui_parts_color(const char *name)
{
    enum { WHITE = 0xe8f4ff, AMBER = 0x66a0d9 };
    static const struct {
        const char *name;
        uint32_t color;
    } palette[] = {
        {"Text", 0xffd8dee3},
        {"TextDisabled", 0xff868e94},
        {"WindowBg", 0xeb151617},
        {"PopupBg", 0xff1c1e20},
        {"TitleBg", 0xf81c1e20},
        {"TitleBgCollapsed", 0xd01c1e20},
        {"TitleBgActive", 0xf8232629},
        {"Border", 0x1c000000 | WHITE},
        {"Separator", 0x1c000000 | WHITE},
        {"FrameBg", 0x14000000 | WHITE},
        {"FrameBgHovered", 0x22000000 | WHITE},
        {"FrameBgActive", 0x2c000000 | WHITE},
        {"Button", 0x1c000000 | WHITE},
        {"ButtonHovered", 0x30000000 | WHITE},
        {"ButtonActive", 0x80000000 | AMBER},
        {"Header", 0x30000000 | AMBER},
        {"HeaderHovered", 0x48000000 | AMBER},
        {"HeaderActive", 0x66000000 | AMBER},
        {"Tab", 0x0c000000 | WHITE},
        {"TabHovered", 0x2c000000 | WHITE},
        {"TabActive", 0x58000000 | AMBER},
        {"TabUnfocused", 0x0c000000 | WHITE},
        {"TabUnfocusedActive", 0x58000000 | AMBER},
        {"ScrollbarBg", 0},
        {"ScrollbarGrab", 0x24000000 | WHITE},
        {"ScrollbarGrabHovered", 0x3a000000 | WHITE},
        {"ScrollbarGrabActive", 0xb0000000 | AMBER},
        {"ResizeGrip", 0x18000000 | WHITE},
        {"ResizeGripHovered", 0x80000000 | AMBER},
        {"ResizeGripActive", 0xff000000 | AMBER},
        {"SeparatorHovered", 0x80000000 | AMBER},
        {"SeparatorActive", 0xff000000 | AMBER},
        {"CheckMark", 0xff000000 | AMBER},
        {"SliderGrab", 0xb8000000 | AMBER},
        {"SliderGrabActive", 0xff7cb2e8},
        {"PlotLines", 0xff000000 | AMBER},
        {"PlotLinesHovered", 0xff9ac7f0},
        {"PlotHistogram", 0x90000000 | AMBER},
        {"PlotHistogramHovered", 0xc0000000 | AMBER},
        {"TextSelectedBg", 0x60000000 | AMBER},
        {"DragDropTarget", 0xff000000 | AMBER},
        {"NavHighlight", 0xff000000 | AMBER},
        {"NavWindowingHighlight", 0xa0000000 | AMBER},
        {"NavWindowingDimBg", 0x60000000},
    };

    for (size_t i = 0; i < sizeof palette / sizeof palette[0]; i++)
        if (strcmp(palette[i].name, name) == 0)
            return &palette[i].color;
    return NULL;
}

/* ---- triangles ---- */

static struct {
    struct sf_overlay_vertex *vertices;
    uint32_t *indices;
    struct sf_overlay_batch *batches;
    uint32_t vertex_count, index_count, batch_count;
    uint32_t vertex_room, index_room, batch_room;
    float width, height;
} mesh;

/* Room for `count` more after *items[used]; false when memory is out. */
static bool grow(void **items, size_t size, uint32_t used, uint32_t count, uint32_t *room)
{
    uint64_t wanted = (uint64_t)used + count;
    void *larger;

    if (wanted <= *room)
        return true;
    wanted += wanted / 2 + 64;
    larger = wanted <= UINT32_MAX ? realloc(*items, (size_t)wanted * size) : NULL;
    if (!larger)
        return false;
    *items = larger;
    *room = (uint32_t)wanted;
    return true;
}

void sf_ui_mesh_clear(float width, float height)
{
    mesh.vertex_count = mesh.index_count = mesh.batch_count = 0;
    mesh.width = width;
    mesh.height = height;
}

void sf_ui_mesh_batch(const float clip[4], const uint16_t *indices, uint32_t count, uint32_t offset)
{
    struct sf_overlay_batch batch = {
        .clip = {clip[0] > 0 ? clip[0] : 0, clip[1] > 0 ? clip[1] : 0, clip[2] < mesh.width ? clip[2] : mesh.width,
                 clip[3] < mesh.height ? clip[3] : mesh.height},
        .first_index = mesh.index_count,
        .index_count = count,
    };
    struct sf_overlay_batch *last = mesh.batch_count > 0 ? &mesh.batches[mesh.batch_count - 1] : NULL;
    bool joins = last && memcmp(last->clip, batch.clip, sizeof batch.clip) == 0;
    void *index_items = mesh.indices, *batch_items = mesh.batches;

    if (count == 0 || !(batch.clip[0] < batch.clip[2]) || !(batch.clip[1] < batch.clip[3]))
        return;
    if (!grow(&index_items, sizeof *mesh.indices, mesh.index_count, count, &mesh.index_room))
        return;
    mesh.indices = index_items;
    if (!joins && !grow(&batch_items, sizeof *mesh.batches, mesh.batch_count, 1, &mesh.batch_room))
        return;
    mesh.batches = batch_items;
    for (uint32_t i = 0; i < count; i++)
        mesh.indices[mesh.index_count + i] = mesh.vertex_count + offset + indices[i];
    mesh.index_count += count;
    if (joins)
        mesh.batches[mesh.batch_count - 1].index_count += count;
    else
        mesh.batches[mesh.batch_count++] = batch;
}

void sf_ui_mesh_vertices(const void *vertices, uint32_t count)
{
    void *items = mesh.vertices;

    if (!grow(&items, sizeof *mesh.vertices, mesh.vertex_count, count, &mesh.vertex_room)) {
        mesh.index_count = mesh.batch_count = mesh.vertex_count = 0; /* indices of what is not there */
        return;
    }
    mesh.vertices = items;
    if (count > 0)
        memcpy(mesh.vertices + mesh.vertex_count, vertices, count * sizeof *mesh.vertices);
    mesh.vertex_count += count;
}

void sf_ui_mesh_overlay(struct sf_overlay *overlay)
{
    *overlay = (struct sf_overlay){mesh.vertices,     mesh.indices,     mesh.batches,
                                   mesh.vertex_count, mesh.index_count, mesh.batch_count};
}

void sf_ui_parts_end(void)
{
    free(mesh.vertices);
    free(mesh.indices);
    free(mesh.batches);
    memset(&mesh, 0, sizeof mesh);
}

/* ---- words ---- */

/* Formats what follows `format` into `words`, a char array. */
#define FORMAT(words, format)                                                                                          \
    do {                                                                                                               \
        va_list list;                                                                                                  \
        va_start(list, format);                                                                                        \
        vsnprintf(words, sizeof(words), format, list);                                                                 \
        va_end(list);                                                                                                  \
    } while (0)

void sf_ui_text(const char *format, ...)
{
    char words[WORDS_BYTES];

    FORMAT(words, format);
    sf_ui_raw_words(sf_ui_plain, -1, words);
}

void sf_ui_text_color(uint32_t color, const char *format, ...)
{
    char words[WORDS_BYTES];

    FORMAT(words, format);
    sf_ui_raw_words(color, -1, words);
}

void sf_ui_text_wrapped(uint32_t color, const char *text)
{
    sf_ui_raw_words(color, 0, text);
}

/* ---- tooltips, and when the next frame is due ---- */

static double begun_s, moved_s;         /* the last frame; the mouse's last move */
static bool tip_waits, tip_is, tip_was; /* for the mouse to rest; shown in this frame; in the one before */
static bool used_keys;

static double now_s(void)
{
    return (double)sf_now_ns() * 1e-9;
}

void sf_ui_parts_begin(bool moved)
{
    begun_s = now_s();
    if (moved)
        moved_s = begun_s;
    tip_was = tip_is;
    tip_is = tip_waits = used_keys = false;
}

bool sf_ui_parts_used_keys(void)
{
    return used_keys;
}

/* Once one is there, the mouse may wander on to the next thing, whose tooltip then comes at once. */
void sf_ui_tooltip(const char *format, ...)
{
    char words[WORDS_BYTES];

    if (!sf_ui_raw_hovered() || sf_ui_mouse_down(0))
        return;
    if (!tip_was && now_s() - moved_s < TIP_S) {
        tip_waits = true;
        return;
    }
    tip_is = true;
    FORMAT(words, format);
    sf_ui_raw_tooltip(words, 400 * sf_ui_scale());
}

double sf_ui_due(void)
{
    double now = now_s(), due = 1e9;

    if (tip_waits)
        due = moved_s + TIP_S - now;
    else if (sf_ui_takes_keys())
        due = begun_s + BLINK_S - now;
    return due > 0 ? due : 0;
}

/* ---- controls ---- */

static bool tab_chosen;   /* the next one */
static unsigned typed_id; /* the field that is being typed in */
static char typed[FIELD_BYTES];

void sf_ui_tab_choose(const char *label)
{
    (void)label; /* that of the begin which follows */
    tab_chosen = true;
}

bool sf_ui_tab_begin(const char *label)
{
    bool choose = tab_chosen;

    tab_chosen = false;
    return sf_ui_raw_tab(label, choose);
}

bool sf_ui_choice(const char *label, int *value, const char *const *choices)
{
    int before = *value, count = 0;

    while (choices[count])
        count++;
    sf_ui_raw_choice(label, value, choices, count);
    return *value != before;
}

/* When the mouse goes to a control that was drawn earlier, ImGui forgets what was typed last: it is kept here. */
bool sf_ui_input(const char *label, const char *hint, char *text, unsigned room)
{
    char before[FIELD_BYTES];
    unsigned id = sf_ui_raw_id(label), state;
    bool done;

    snprintf(before, sizeof before, "%s", text);
    state = sf_ui_raw_field(label, hint ? hint : "", text, room, true);
    done = (state & SF_UI_FIELD_CHANGED) || ((state & SF_UI_FIELD_LEFT) && !sf_ui_raw_escape(false));
    if (state & SF_UI_FIELD_ACTIVE) {
        typed_id = id;
        snprintf(typed, sizeof typed, "%s", text);
    } else if (typed_id == id) {
        typed_id = 0;
        if (done && room <= sizeof typed && strcmp(before, text) == 0)
            snprintf(text, room, "%s", typed);
    }
    return done;
}

bool sf_ui_search(const char *label, const char *hint, char *text, unsigned room, bool focus)
{
    if (focus)
        sf_ui_raw_focus();
    return sf_ui_raw_field(label, hint ? hint : "", text, room, false) & SF_UI_FIELD_CHANGED;
}

bool sf_ui_canvas(const char *name, float width, float height, float *x, float *y)
{
    sf_ui_raw_place(x, y);
    sf_ui_raw_canvas(name, width > 1 ? width : 1, height > 1 ? height : 1);
    return sf_ui_last_active();
}

/* ---- the box ---- */

/* No popup of ImGui's: one of those would go on blocking everything when it is no longer called. */
bool sf_ui_box_begin(const char *title, bool *open)
{
    float size[2];
    bool beside;

    if (!*open)
        return false;
    sf_ui_raw_size(size);
    sf_ui_panel_begin("##shade", 0, 0, size[0], size[1], SF_UI_UNTITLED | SF_UI_SOLID | SF_UI_SHADE, NULL);
    beside = sf_ui_raw_panel_clicked();
    sf_ui_panel_end();
    sf_ui_panel_begin(title, size[0] / 2, size[1] / 2, size[0] * 0.92f, size[1] * 0.92f, SF_UI_BOX, open);
    if (sf_ui_raw_escape(true)) {
        used_keys = true;
        *open = false;
    }
    if (beside)
        *open = false;
    if (!*open)
        sf_ui_panel_end();
    return *open;
}

void sf_ui_box_end(void)
{
    sf_ui_panel_end();
}
