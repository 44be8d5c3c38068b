/* The graphs as drawings, like the history of a repository: passes from top to bottom, beside them the lives of what they
 * read and write. */
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "graph_data.h"
#include "panel_draw.h"
#include "view.h"

enum { TIP_BYTES = 1536, LABEL_BYTES = 192 };
static const uint32_t IMAGE = 0xff66a0d9, BUFFER = 0xffc2a66f, OUTSIDE = 0xff7fb392; /* lives, by kind */
static const float TEXT_HEIGHT = 14;                                                 /* px at scale 1 */
static const float FAINT = 0.22f;                                                    /* what the mouse is not about */

/* A drawing, while it is drawn. */
struct sheet {
    struct sf_view *view;
    const struct sf_data_graph *graph;
    float x, y, width;             /* px of the place */
    float row, lane;               /* px: height of a pass, width of a life */
    float lanes_x, names_x;        /* px: middle of the first life; where names begin */
    float radius, most_ms;         /* of dots; of the longest pass */
    uint32_t over_pass, over_life; /* under the mouse: at most one of them */
};

/* ---- words ---- */

struct tip {
    char text[TIP_BYTES];
    size_t used;
};

static void SF_UI_PRINTF(2, 3) tell(struct tip *tip, const char *format, ...)
{
    va_list args;
    int length;

    va_start(args, format);
    length = vsnprintf(tip->text + tip->used, sizeof tip->text - tip->used, format, args);
    va_end(args);
    if (length > 0)
        tip->used += (size_t)length < sizeof tip->text - tip->used ? (size_t)length : sizeof tip->text - tip->used - 1;
}

static const struct sf_stats_pass *stats_of(const struct sheet *sheet, const char *pass)
{
    const struct sf_stats *stats = &sheet->view->stats;

    for (unsigned i = 0; i < stats->pass_count; i++)
        if (strncmp(stats->passes[i].name, pass, SF_STATS_NAME_BYTES - 1) == 0)
            return &stats->passes[i];
    return NULL;
}

/* "reads a, b" or nothing. */
static void tell_uses(struct tip *tip, const struct sheet *sheet, const struct sf_data_pass *pass, bool writes)
{
    unsigned count = 0;

    for (uint32_t u = pass->first_use; u < pass->first_use + pass->use_count; u++) {
        const struct sf_data_use *use = &sheet->graph->uses[u];

        if (writes ? use->writes : use->reads)
            tell(tip, "%s%s",
                 count++  ? ", "
                 : writes ? "\nwrites "
                          : "\nreads ",
                 sheet->graph->resources[use->resource].name);
    }
}

static void explain_pass(const struct sheet *sheet)
{
    const struct sf_data_pass *pass = &sheet->graph->passes[sheet->over_pass];
    const struct sf_stats_pass *stats = stats_of(sheet, pass->name);
    char bytes[SF_BYTES_TEXT];
    struct tip tip = {.used = 0};

    tell(&tip, "%s: %s, reads %s", pass->name, pass->kind, sf_bytes_text(pass->bytes_read, bytes));
    tell(&tip, ", writes %s", sf_bytes_text(pass->bytes_written, bytes));
    if (stats && stats->median > 0)
        tell(&tip, "\n%.3f ms (median), %.3f ms (last)", (double)stats->median, (double)stats->last);
    tell(&tip, "\n%" PRIu32 " barrier%s before it", pass->barriers, pass->barriers == 1 ? "" : "s");
    tell_uses(&tip, sheet, pass, false);
    tell_uses(&tip, sheet, pass, true);
    sf_ui_tooltip("%s", tip.text);
}

static bool can_be_looked_at(const struct sheet *sheet, const char *name)
{
    const struct sf_data_graph *frame = sf_graph_data_frame(sheet->view->graph);
    uint32_t resource = frame ? sf_data_find(frame, name) : SF_DATA_NONE;

    return resource != SF_DATA_NONE && frame->resources[resource].lookable;
}

static void explain_life(const struct sheet *sheet)
{
    const struct sf_data_graph *graph = sheet->graph;
    const struct sf_data_resource *life = &graph->resources[sheet->over_life];
    char bytes[SF_BYTES_TEXT];
    struct tip tip = {.used = 0};

    tell(&tip, "%s: ", life->name);
    if (life->image)
        tell(&tip, "image, %s, %" PRIu32 "x%" PRIu32, life->format, life->width, life->height);
    else
        tell(&tip, "buffer");
    if (life->layers > 1)
        tell(&tip, ", %" PRIu32 " layers", life->layers);
    tell(&tip, ", %s\n%s", sf_bytes_text(life->bytes, bytes), life->lifetime);
    tell(&tip, "%s%s", life->lifetime[0] ? "; from " : "from ", graph->passes[life->first].name);
    if (life->last != life->first)
        tell(&tip, " to %s", graph->passes[life->last].name);
    tell(&tip, "\n%" PRIu32 " barrier%s", life->barriers, life->barriers == 1 ? "" : "s");
    if (life->shares_with != SF_DATA_NONE)
        tell(&tip, "\nin memory that %s had", graph->resources[life->shares_with].name);
    if (can_be_looked_at(sheet, life->name))
        tell(&tip, "\nclick: look at it");
    sf_ui_tooltip("%s", tip.text);
}

/* ---- lives ---- */

static bool from_outside(const struct sf_data_resource *life)
{
    return life->lifetime[0] && strcmp(life->lifetime, "transient") != 0;
}

static float row_y(const struct sheet *sheet, uint32_t row)
{
    return sheet->y + ((float)row + 0.5f) * sheet->row;
}

static bool life_lit(const struct sheet *sheet, uint32_t resource)
{
    if (sheet->over_life != SF_DATA_NONE)
        return sheet->over_life == resource;
    return sheet->over_pass == SF_DATA_NONE ||
           sf_data_use_of(sheet->graph, &sheet->graph->passes[sheet->over_pass], resource);
}

static void draw_life(const struct sheet *sheet, uint32_t resource)
{
    const struct sf_data_resource *life = &sheet->graph->resources[resource];
    float scale = sf_ui_scale(), x, top, bottom;
    bool looked = strcmp(sheet->view->looking.name, life->name) == 0;
    uint32_t color;

    if (life->lane == SF_DATA_NONE)
        return;
    color = sf_color_faint(from_outside(life) ? OUTSIDE
                           : life->image      ? IMAGE
                                              : BUFFER,
                           life_lit(sheet, resource) ? 1 : FAINT);
    x = sheet->lanes_x + (float)life->lane * sheet->lane;
    top = row_y(sheet, life->first);
    bottom = row_y(sheet, life->last);
    if (from_outside(life)) { /* it was there before, or stays */
        top -= 0.4f * sheet->row;
        bottom += 0.4f * sheet->row;
    }
    sf_ui_draw_line(x, top, x, bottom, color, looked || sheet->over_life == resource ? 3 * scale : 1.5f * scale);
    for (uint32_t p = life->first; p <= life->last; p++) {
        const struct sf_data_use *use = sf_data_use_of(sheet->graph, &sheet->graph->passes[p], resource);

        if (!use)
            continue;
        if (!use->writes) { /* a ring, hollow also where the line is */
            sf_ui_draw_circle(x, row_y(sheet, p), sheet->radius, 0xff17191b, true);
            sf_ui_draw_circle(x, row_y(sheet, p), sheet->radius, color, false);
        } else {
            sf_ui_draw_circle(x, row_y(sheet, p), sheet->radius, color, true);
        }
    }
}

/* ---- passes ---- */

static bool pass_lit(const struct sheet *sheet, uint32_t pass)
{
    return sheet->over_life == SF_DATA_NONE ||
           sf_data_use_of(sheet->graph, &sheet->graph->passes[pass], sheet->over_life);
}

static void draw_pass(const struct sheet *sheet, uint32_t index)
{
    const struct sf_data_pass *pass = &sheet->graph->passes[index];
    const struct sf_stats_pass *stats = stats_of(sheet, pass->name);
    float scale = sf_ui_scale(), y = sheet->y + (float)index * sheet->row, right = sheet->x + sheet->width;
    float room = right - sheet->names_x, text_y = y + (sheet->row - TEXT_HEIGHT * scale) / 2, number = 0;
    bool lit = pass_lit(sheet, index);
    char ms[LABEL_BYTES];

    if (sheet->over_pass == index)
        sf_ui_draw_rectangle(sheet->x, y, sheet->width, sheet->row, SF_COLOR_SHADE, true);
    if (stats && stats->median > 0) {
        if (sheet->most_ms > 0)
            sf_ui_draw_rectangle(sheet->names_x - 3 * scale, y + scale,
                                 fmaxf(room * stats->median / sheet->most_ms, scale) + 3 * scale,
                                 sheet->row - 2 * scale, sf_color_faint(SF_COLOR_DEVICE, lit ? 0.24f : 0.1f), true);
        snprintf(ms, sizeof ms, "%.2f", (double)stats->median);
        sf_draw_text_right(right - 2 * scale, text_y, lit ? sf_ui_dim : sf_color_faint(sf_ui_dim, 0.5f), ms);
        number = sf_ui_text_width(ms) + 8 * scale;
    }
    sf_ui_draw_clip(sheet->names_x, y, fmaxf(room - number, 1), sheet->row);
    sf_ui_draw_text(sheet->names_x, text_y, lit ? sf_ui_plain : sf_color_faint(sf_ui_dim, 0.6f), pass->name);
    sf_ui_draw_unclip();
}

/* ---- the mouse ---- */

static uint32_t life_at(const struct sheet *sheet, float x, uint32_t row)
{
    float lane = (x - sheet->lanes_x) / sheet->lane + 0.5f;

    for (uint32_t r = 0; r < sheet->graph->resource_count && lane >= 0; r++) {
        const struct sf_data_resource *life = &sheet->graph->resources[r];

        if (life->lane == (uint32_t)lane && life->first <= row && row <= life->last)
            return r;
    }
    return SF_DATA_NONE;
}

static void find_hovered(struct sheet *sheet)
{
    float x, y;
    uint32_t row;

    sheet->over_pass = sheet->over_life = SF_DATA_NONE;
    sf_ui_mouse(&x, &y);
    if (!sf_ui_last_hovered() || y < sheet->y)
        return;
    row = (uint32_t)((y - sheet->y) / sheet->row);
    if (row >= sheet->graph->pass_count)
        return;
    sheet->over_life = x < sheet->names_x - 3 * sf_ui_scale() ? life_at(sheet, x, row) : SF_DATA_NONE;
    if (sheet->over_life == SF_DATA_NONE)
        sheet->over_pass = row;
}

/* ---- a graph ---- */

static void draw_graph(struct sf_view *view, const struct sf_data_graph *graph)
{
    struct sheet sheet = {.view = view, .graph = graph, .width = sf_ui_room()};
    float scale = sf_ui_scale(), lanes = fmaxf((float)graph->lane_count, 1);

    sheet.row = floorf(20 * scale);
    sheet.lane = fmaxf(fminf(11 * scale, 0.46f * sheet.width / lanes), 5 * scale);
    sheet.radius = fminf(3.5f * scale, sheet.lane * 0.45f);
    sf_ui_canvas(graph->name, sheet.width, fmaxf((float)graph->pass_count, 1) * sheet.row, &sheet.x, &sheet.y);
    sheet.lanes_x = sheet.x + sheet.lane / 2 + scale;
    sheet.names_x = sheet.lanes_x + (lanes - 0.5f) * sheet.lane + 8 * scale;
    for (uint32_t p = 0; p < graph->pass_count; p++) {
        const struct sf_stats_pass *stats = stats_of(&sheet, graph->passes[p].name);
        sheet.most_ms = stats ? fmaxf(sheet.most_ms, stats->median) : sheet.most_ms;
    }
    find_hovered(&sheet);
    for (uint32_t p = 0; p < graph->pass_count; p++)
        draw_pass(&sheet, p);
    for (uint32_t r = 0; r < graph->resource_count; r++)
        draw_life(&sheet, r);
    if (sheet.over_life != SF_DATA_NONE) {
        const char *name = graph->resources[sheet.over_life].name;

        explain_life(&sheet);
        if (sf_ui_mouse_clicked(0) && can_be_looked_at(&sheet, name))
            sf_view_look(view, strcmp(view->looking.name, name) == 0 ? "" : name);
    } else if (sheet.over_pass != SF_DATA_NONE) {
        explain_pass(&sheet);
    }
}

static void draw_memory(const struct sf_data_graph *graph)
{
    char transient[SF_BYTES_TEXT], without[SF_BYTES_TEXT];

    if (graph->transient > 0) {
        sf_ui_text_color(sf_ui_dim, "%s between passes; %s if nothing shared it",
                         sf_bytes_text(graph->transient, transient), sf_bytes_text(graph->without_sharing, without));
        sf_ui_tooltip("Transient images and buffers whose lives do not overlap share memory.");
    }
    if (graph->culled > 0)
        sf_ui_text_color(sf_ui_dim, "%" PRIu32 " passes left out, nothing needs them", graph->culled);
}

/* ---- the panel ---- */

static void draw_legend(void)
{
    static const struct {
        const char *name;
        const uint32_t *color;
        bool filled;
    } marks[] = {{"image", &IMAGE, true},
                 {"buffer", &BUFFER, true},
                 {"outlives the graph", &OUTSIDE, true},
                 {"write", &sf_ui_dim, true},
                 {"read", &sf_ui_dim, false}};
    float scale = sf_ui_scale(), x, y;

    sf_ui_canvas("legend", sf_ui_room(), 18 * scale, &x, &y);
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        sf_ui_draw_circle(x + 5 * scale, y + 9 * scale, 3.5f * scale, *marks[i].color, marks[i].filled);
        sf_ui_draw_text(x + 12 * scale, y + scale, sf_ui_dim, marks[i].name);
        x += sf_ui_text_width(marks[i].name) + 20 * scale;
    }
}

/* What people call it. */
static const char *title_of(const char *graph)
{
    static const char *const titles[][2] = {
        {"sim", "a step of the simulation"}, {"shadow", "the solids' shadow map"}, {"frame", "the picture"}};

    for (size_t i = 0; i < sizeof titles / sizeof *titles; i++)
        if (strcmp(graph, titles[i][0]) == 0)
            return titles[i][1];
    return graph;
}

void sf_panel_graph(struct sf_view *view)
{
    const struct sf_graph_data *data =
        sf_graph_data_refresh(&view->graph, view->renderer, view->graph_version, &view->log);
    uint64_t used = 0, budget = 0;
    char label[LABEL_BYTES], used_text[SF_BYTES_TEXT], budget_text[SF_BYTES_TEXT];

    if (!data || data->graph_count == 0) {
        sf_ui_text_color(sf_ui_dim, "there is no graph yet");
        return;
    }
    draw_legend();
    for (uint32_t g = 0; g < data->graph_count; g++) {
        const struct sf_data_graph *graph = &data->graphs[g];

        snprintf(label, sizeof label, "%s: %" PRIu32 " passes##%s", title_of(graph->name), graph->pass_count,
                 graph->name);
        if (!sf_ui_section(label, graph == sf_graph_data_frame(data)))
            continue;
        draw_graph(view, graph);
        draw_memory(graph);
    }
    sf_ui_separator();
    sf_device_memory(view->device, &used, &budget);
    sf_ui_text_color(sf_ui_dim, "device memory: %s of %s", sf_bytes_text(used, used_text),
                     sf_bytes_text(budget, budget_text));
    sf_ui_tooltip("Used by this program, and what it may use.");
}
