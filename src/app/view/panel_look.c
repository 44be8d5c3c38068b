/* Any image or buffer of the frame's graph: the list of them, how the one looked at is mapped, its values. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "graph_data.h"
#include "looking.h"
#include "panel_draw.h"
#include "view.h"

enum { TEXT_BYTES = 128, LIST_LINES = 10, WORD_LINES = 18, CHANNELS = 4 };
static const float TEXT_HEIGHT = 14, OFFSET_WIDTH = 46, WIDE = 580; /* px at scale 1 */
static const char CHANNEL_NAMES[] = "RGBA";

/* ---- the list ---- */

static bool holds(const char *text, const char *part)
{
    for (; *text; text++) {
        size_t i = 0;

        while (part[i] && text[i] && (text[i] | 32) == (part[i] | 32))
            i++;
        if (!part[i])
            return true;
    }
    return !*part;
}

/* "400x400", "512x512 x3". */
static void print_size(const struct sf_data_resource *resource, char *text, size_t room)
{
    int used = snprintf(text, room, "%" PRIu32 "x%" PRIu32, resource->width, resource->height);

    if (resource->layers > 1 && used > 0 && (size_t)used < room)
        snprintf(text + used, room - (size_t)used, " x%" PRIu32, resource->layers);
}

static void list_resource(struct sf_view *view, const struct sf_data_resource *resource)
{
    char text[TEXT_BYTES], bytes[SF_BYTES_TEXT];
    bool selected = strcmp(view->looking.name, resource->name) == 0;
    float place[4], right;

    if (sf_ui_selectable(resource->name, selected))
        sf_view_look(view, selected ? "" : resource->name);
    sf_ui_last_rectangle(place);
    place[1] += (place[3] - TEXT_HEIGHT * sf_ui_scale()) / 2;
    right = place[0] + place[2] - 4 * sf_ui_scale();
    if (resource->image) {
        sf_ui_draw_text(place[0] + 0.4f * place[2], place[1], sf_ui_dim, resource->format);
        print_size(resource, text, sizeof text);
        sf_ui_draw_text(place[0] + 0.61f * place[2], place[1], sf_ui_dim, text);
    }
    sf_draw_text_right(right, place[1], sf_ui_dim, sf_bytes_text(resource->bytes, bytes));
}

static void list_kind(struct sf_view *view, const struct sf_data_graph *graph, bool image)
{
    for (uint32_t r = 0; r < graph->resource_count; r++) {
        const struct sf_data_resource *resource = &graph->resources[r];

        if (resource->image == image && resource->lookable && resource->lane != SF_DATA_NONE &&
            holds(resource->name, view->look_search))
            list_resource(view, resource);
    }
}

static void list_all(struct sf_view *view, const struct sf_data_graph *graph)
{
    sf_ui_width(-1);
    sf_ui_search("##resources", "search images and buffers", view->look_search, sizeof view->look_search, false);
    if (sf_ui_child_begin("resources", LIST_LINES * sf_ui_line())) {
        if (sf_ui_selectable("the picture", !view->looking.name[0]))
            sf_view_look(view, "");
        list_kind(view, graph, true);
        list_kind(view, graph, false);
    }
    sf_ui_child_end();
}

/* ---- an image ---- */

static void choose_channel(struct sf_looking *looking)
{
    static const char *const names[] = {"colour", "R", "G", "B", "A"};
    const char *choices[CHANNELS + 2] = {0};

    if (looking->channels < 2)
        return;
    for (uint32_t c = 0; c <= looking->channels && c <= CHANNELS; c++)
        choices[c] = names[c];
    sf_ui_width(sf_ui_room() * 0.45f);
    sf_ui_choice("channel", &looking->channel, choices);
    sf_ui_tooltip("Colour: R, G and B as red, green and blue. One alone is grey.");
}

/* "3.1 to 7.2", or each channel's range when they differ. */
static void print_ranges(const struct sf_looking *looking, char *text, size_t room)
{
    const float(*ranges)[2] = looking->ranges;
    uint32_t count = looking->channels < 3 ? looking->channels : 3;
    size_t used = 0;
    bool differ = false;

    for (uint32_t c = 1; c < count; c++)
        differ |= memcmp(ranges[c], ranges[0], sizeof ranges[0]) != 0;
    if (!looking->automatic || looking->channel > 0 || !differ) {
        snprintf(text, room, "%.4g to %.4g", (double)looking->low, (double)looking->high);
        return;
    }
    for (uint32_t c = 0; c < count && used < room; c++) {
        int length = snprintf(text + used, room - used, "%s%c %.3g to %.3g", c > 0 ? "   " : "", CHANNEL_NAMES[c],
                              (double)ranges[c][0], (double)ranges[c][1]);
        used += length > 0 ? (size_t)length : 0;
    }
}

static void choose_range(struct sf_looking *looking)
{
    float range[2] = {looking->low, looking->high};
    char text[TEXT_BYTES];

    sf_ui_checkbox("automatic range", &looking->automatic);
    sf_ui_tooltip(
        "Black is the least value, white the greatest, with no gamma. R, G and B share one range when they are alike "
        "(none below 0, the greatest ones within 8 times); else each has its own. Values below 0 throughout (far "
        "depths) go by their size. Dark blue: no value (1e6 or more, where nothing is). Violet checks: not written.");
    sf_ui_same_line(0);
    sf_ui_checkbox("logarithmic", &looking->logarithmic);
    sf_ui_tooltip("Equal steps of brightness are equal ratios of values. With values at or below 0 it begins at the "
                  "smallest one above 0.");
    if (looking->automatic) {
        print_ranges(looking, text, sizeof text);
        sf_ui_text_color(sf_ui_dim, "%s", text);
        return;
    }
    sf_ui_width(sf_ui_room() * 0.75f);
    if (sf_ui_drag("range", range, 2, fmaxf(fabsf(range[1] - range[0]), 1e-6f) / 250, -1e30f, 1e30f, "%.4g")) {
        looking->low = range[0];
        looking->high = range[1];
    }
    sf_ui_tooltip("What becomes black and what becomes white; the first may be the greater one.");
}

static void draw_image(struct sf_view *view)
{
    struct sf_looking *looking = &view->looking;
    float scale = sf_looking_scale(looking, view->picture[2], view->picture[3]);

    choose_channel(looking);
    choose_range(looking);
    if (sf_ui_button("fit"))
        sf_looking_fit(looking);
    sf_ui_tooltip("The whole image again (double click in it). The wheel zooms, dragging moves it.");
    sf_ui_same_line(0);
    sf_ui_text_color(sf_ui_dim, "%.3g px a texel", (double)scale);
}

/* ---- a buffer ---- */

enum { AS_LIKELY, AS_FLOAT, AS_UINT, AS_HEX };

/* A number that people use as a float, or 0; else it is likelier whole. */
static bool looks_like_float(float number)
{
    return number == 0 || (fabsf(number) > 1e-12f && fabsf(number) < 1e12f);
}

/* With as many digits as fit into `width` px. */
static void print_word(uint32_t word, int as, float width, char *text, size_t room)
{
    float number;
    bool whole;
    int digits = 7;

    memcpy(&number, &word, sizeof number);
    if (as == AS_HEX) {
        snprintf(text, room, "%08" PRIx32, word);
        return;
    }
    whole = as == AS_UINT || (as == AS_LIKELY && !looks_like_float(number));
    snprintf(text, room, "%" PRIu32, word);
    if (whole && sf_ui_text_width(text) <= width)
        return;
    do
        snprintf(text, room, "%.*g", digits, whole ? (double)word : (double)number);
    while (--digits > 0 && sf_ui_text_width(text) > width);
}

static void draw_word_row(const struct sf_view *view, uint32_t row, uint32_t columns, float x, float y, float width)
{
    const struct sf_looking *looking = &view->looking;
    float step = (width - OFFSET_WIDTH * sf_ui_scale()) / (float)columns;
    char text[TEXT_BYTES];

    snprintf(text, sizeof text, "%" PRIu32, row * columns * 4);
    sf_ui_draw_text(x, y, sf_ui_dim, text);
    for (uint32_t c = 0; c < columns && row * columns + c < looking->word_count; c++) {
        print_word(looking->words[row * columns + c], view->words_as, step - 7 * sf_ui_scale(), text, sizeof text);
        sf_draw_text_right(x + width - (float)(columns - 1 - c) * step, y, sf_ui_plain, text);
    }
}

/* Everything that the word under the mouse can mean. */
static void explain_word(const struct sf_looking *looking, uint32_t index)
{
    uint32_t word = looking->words[index];
    int32_t whole;
    float number;

    memcpy(&whole, &word, sizeof whole);
    memcpy(&number, &word, sizeof number);
    sf_ui_tooltip("word %" PRIu32 ", byte %" PRIu32 "\nfloat %.9g\nuint %" PRIu32 "\nint %" PRId32 "\nhex %08" PRIx32,
                  index, index * 4, (double)number, word, whole, word);
}

/* The rows that can be seen of a place as high as all of them. */
static void draw_words(struct sf_view *view)
{
    const struct sf_looking *looking = &view->looking;
    uint32_t columns = sf_ui_room() > WIDE * sf_ui_scale() ? 8 : 4,
             rows = (looking->word_count + columns - 1) / columns;
    float line = floorf(18 * sf_ui_scale()), height = WORD_LINES * line, above[4], width, x, y, mouse_x, mouse_y;

    sf_ui_last_rectangle(above);
    if (sf_ui_child_begin("words", height)) {
        float top = above[1] + above[3], step;

        width = sf_ui_room() - 4 * sf_ui_scale();
        sf_ui_canvas("table", width, fmaxf((float)rows, 1) * line, &x, &y);
        sf_ui_mouse(&mouse_x, &mouse_y);
        for (uint32_t row = 0; row < rows; row++) {
            float at = y + (float)row * line;

            if (at > top - line && at < top + height + 2 * line)
                draw_word_row(view, row, columns, x, at, width);
        }
        step = (width - OFFSET_WIDTH * sf_ui_scale()) / (float)columns;
        if (sf_ui_last_hovered() && mouse_x > x + width - step * (float)columns && mouse_x < x + width) {
            uint32_t column = (uint32_t)((mouse_x - (x + width - step * (float)columns)) / step);
            uint32_t index = (uint32_t)fmaxf((mouse_y - y) / line, 0) * columns + column;

            if (index < looking->word_count)
                explain_word(looking, index);
        }
    }
    sf_ui_child_end();
}

static void draw_buffer(struct sf_view *view)
{
    static const char *const kinds[] = {"likely", "float", "uint", "hex", NULL};

    sf_ui_text("words as");
    sf_ui_same_line(0);
    sf_ui_width(sf_ui_room() * 0.45f);
    sf_ui_choice("##words", &view->words_as, kinds);
    sf_ui_tooltip("Likely: as a float when that gives a usual number, else as a whole one. Left of each row stands its "
                  "offset in bytes; at most the first 64 KiB are here.");
    draw_words(view);
}

/* ---- the panel ---- */

static void draw_facts(const struct sf_data_graph *graph, const struct sf_data_resource *resource)
{
    char size[TEXT_BYTES] = "", bytes[SF_BYTES_TEXT];

    if (resource->image)
        print_size(resource, size, sizeof size);
    sf_ui_text_color(sf_ui_accent, "%s", resource->name);
    sf_ui_text_color(sf_ui_dim, "%s%s%s%s%s, %s", resource->image ? resource->format : "buffer",
                     resource->image ? " " : "", size, resource->lifetime[0] ? ", " : "", resource->lifetime,
                     sf_bytes_text(resource->bytes, bytes));
    if (resource->first != SF_DATA_NONE)
        sf_ui_tooltip("Lives from %s to %s.", graph->passes[resource->first].name, graph->passes[resource->last].name);
}

void sf_panel_look(struct sf_view *view)
{
    const struct sf_data_graph *graph =
        sf_graph_data_frame(sf_graph_data_refresh(&view->graph, view->renderer, view->graph_version, &view->log));
    uint32_t looked;

    if (!graph) {
        sf_ui_text_color(sf_ui_dim, "there is no graph yet");
        return;
    }
    list_all(view, graph);
    if (!view->looking.name[0])
        return;
    sf_ui_separator();
    looked = sf_data_find(graph, view->looking.name);
    if (looked == SF_DATA_NONE)
        sf_ui_text_color(sf_ui_dim, "%s: this graph has none", view->looking.name);
    else
        draw_facts(graph, &graph->resources[looked]);
    if (view->looking.values)
        draw_image(view);
    else if (view->looking.words)
        draw_buffer(view);
    else if (looked != SF_DATA_NONE)
        sf_ui_text_color(sf_ui_dim, "comes with the next picture");
}

/* ---- over the picture ---- */

struct read_out {
    char lines[CHANNELS + 1][TEXT_BYTES];
    unsigned count;
    bool written;
    uint8_t rgb[3];
};

static struct read_out read_texel(const struct sf_view *view, uint32_t layers, uint32_t column, uint32_t row)
{
    const struct sf_looking *looking = &view->looking;
    const float *texel = looking->values + ((size_t)row * looking->width + column) * looking->channels;
    uint32_t high = layers > 0 ? looking->height / layers : looking->height;
    struct read_out read = {.count = 1};

    if (layers > 1 && high > 0)
        snprintf(read.lines[0], TEXT_BYTES, "%" PRIu32 ", %" PRIu32 "  layer %" PRIu32, column, row % high, row / high);
    else
        snprintf(read.lines[0], TEXT_BYTES, "%" PRIu32 ", %" PRIu32, column, row);
    for (uint32_t c = 0; c < looking->channels && c < CHANNELS; c++)
        read.written |= !isnan(texel[c]);
    if (!read.written) {
        snprintf(read.lines[read.count++], TEXT_BYTES, "not written");
        return read;
    }
    for (uint32_t c = 0; c < looking->channels && c < CHANNELS; c++)
        snprintf(read.lines[read.count++], TEXT_BYTES, "%c  %.7g%s", CHANNEL_NAMES[c], (double)texel[c],
                 fabsf(texel[c]) == SF_NO_DEPTH ? "  (nothing)" : "");
    sf_looking_color(looking, texel, read.rgb);
    return read;
}

/* Beside the mouse, on the side where there is room. */
static void draw_read_out(const struct sf_view *view, const struct read_out *read, float mouse_x, float mouse_y)
{
    float scale = sf_ui_scale(), line = floorf(17 * scale), pad = 7 * scale, swatch = 12 * scale, width = 0, height, x,
          y;

    for (unsigned i = 0; i < read->count; i++)
        width = fmaxf(width, sf_ui_text_width(read->lines[i]) + (i == 0 ? swatch + 10 * scale : 0));
    width += 2 * pad;
    height = (float)read->count * line + 2 * pad - 2 * scale;
    x = mouse_x + 18 * scale;
    y = mouse_y + 18 * scale;
    if (x + width > view->picture[0] + view->picture[2])
        x = mouse_x - 12 * scale - width;
    if (y + height > view->picture[1] + view->picture[3])
        y = mouse_y - 12 * scale - height;
    sf_ui_draw_rectangle(x, y, width, height, 0xe8151617, true);
    sf_ui_draw_rectangle(x, y, width, height, 0x30e8f4ff, false);
    for (unsigned i = 0; i < read->count; i++)
        sf_ui_draw_text(x + pad, y + pad + (float)i * line - scale, i == 0 || !read->written ? sf_ui_dim : sf_ui_plain,
                        read->lines[i]);
    x += width - pad - swatch;
    y += pad + scale;
    if (read->written)
        sf_ui_draw_rectangle(x, y, swatch, swatch,
                             0xff000000u | (uint32_t)read->rgb[2] << 16 | (uint32_t)read->rgb[1] << 8 | read->rgb[0],
                             true);
    sf_ui_draw_rectangle(x, y, swatch, swatch, 0x60e8f4ff, false);
}

/* A frame about the texel, when it is large enough to be seen. */
void sf_panel_look_mark(const struct sf_view *view, const struct sf_looking *looking, uint32_t column, uint32_t row)
{
    float scale = sf_looking_scale(looking, view->picture[2], view->picture[3]), x, y;

    if (scale < 4)
        return;
    sf_looking_spot(looking, view->picture[2], view->picture[3], column, row, &x, &y);
    x += view->picture[0] - scale / 2;
    y += view->picture[1] - scale / 2;
    sf_ui_draw_rectangle(x - 1, y - 1, scale + 2, scale + 2, 0xa0000000, false);
    sf_ui_draw_rectangle(x, y, scale, scale, sf_ui_accent, false);
}

/* What is looked at, so that nobody takes it for the picture. */
static void draw_caption(const struct sf_view *view, const struct sf_data_resource *resource)
{
    const struct sf_looking *looking = &view->looking;
    char ranges[TEXT_BYTES], text[3 * TEXT_BYTES];
    float scale = sf_ui_scale(), height = floorf(24 * scale), x = view->picture[0] + 10 * scale,
          y = view->picture[1] + view->picture[3] - height - 10 * scale;

    print_ranges(looking, ranges, sizeof ranges);
    snprintf(text, sizeof text, "%s   %" PRIu32 "x%" PRIu32 "%s%s   %s%s", looking->name, looking->width,
             looking->height, resource ? " " : "", resource ? resource->format : "", ranges,
             looking->logarithmic ? ", logarithmic" : "");
    sf_ui_draw_rectangle(x, y, sf_ui_text_width(text) + 16 * scale, height, 0xd8151617, true);
    sf_ui_draw_text(x + 8 * scale, y + 4 * scale, sf_ui_plain, text);
}

void sf_panel_look_move(const struct sf_view *view, struct sf_looking *looking, float x, float y, bool inside)
{
    float width = view->picture[2], height = view->picture[3], dx, dy;

    sf_ui_mouse_moved(&dx, &dy);
    if (view->hold == SF_HOLD_LOOKED && (dx != 0 || dy != 0))
        sf_looking_pan(looking, width, height, dx, dy);
    if (!inside)
        return;
    if (sf_ui_wheel() != 0)
        sf_looking_zoom(looking, width, height, x, y, sf_ui_wheel());
    if (sf_ui_mouse_double(0))
        sf_looking_fit(looking);
}

void sf_panel_looked(struct sf_view *view)
{
    const struct sf_data_graph *graph;
    const struct sf_data_resource *resource = NULL;
    uint32_t column, row, index;
    float x, y, mouse_x, mouse_y;
    bool inside;

    if (sf_view_looked(view) != &view->looking || !view->looking.values)
        return;
    graph = sf_graph_data_frame(sf_graph_data_refresh(&view->graph, view->renderer, view->graph_version, &view->log));
    index = graph ? sf_data_find(graph, view->looking.name) : SF_DATA_NONE;
    if (index != SF_DATA_NONE)
        resource = &graph->resources[index];
    sf_ui_mouse(&mouse_x, &mouse_y);
    x = mouse_x - view->picture[0];
    y = mouse_y - view->picture[1];
    inside = x >= 0 && y >= 0 && x < view->picture[2] && y < view->picture[3] && !sf_ui_takes_mouse();
    sf_panel_look_move(view, &view->looking, x, y, inside);
    sf_ui_draw_behind();
    sf_ui_draw_clip(view->picture[0], view->picture[1], view->picture[2], view->picture[3]);
    draw_caption(view, resource);
    if (inside && sf_looking_texel(&view->looking, view->picture[2], view->picture[3], x, y, &column, &row)) {
        struct read_out read = read_texel(view, resource ? resource->layers : 1, column, row);

        sf_panel_look_mark(view, &view->looking, column, row);
        draw_read_out(view, &read, mouse_x, mouse_y);
    }
    sf_ui_draw_unclip();
    sf_ui_draw_panel();
}
