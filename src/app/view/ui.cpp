/* ui.h over Dear ImGui 1.86: the project's one C++ file, the only one that sees ImGui. GLFW feeds it through ImGui's
 * own backend; what it draws becomes a struct sf_overlay, which the library's render graph draws. What can be done in
 * C is in ui_parts.c. Nothing here throws. */
#include "ui_parts.h"

#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <cmath>

static_assert(sizeof(ImDrawVert) == sizeof(sf_overlay_vertex) && sizeof(ImDrawIdx) == 2 && sizeof(ImWchar) == 2 &&
                  offsetof(ImDrawVert, pos) == 0 && offsetof(ImDrawVert, uv) == offsetof(sf_overlay_vertex, u) &&
                  offsetof(ImDrawVert, col) == offsetof(sf_overlay_vertex, color),
              "arrays are taken over whole");

struct sf_ui {
    GLFWwindow *window;
    float scale;
    int depth;   /* panels that are begun */
    bool behind; /* draw calls go behind all panels */
    bool keys;   /* keys_walk() when the frame began: Escape ends it within */
};
static sf_ui self; /* live while ImGui has a context */

/* ---- life ---- */

static void set_style(float scale)
{
    ImGuiStyle &style = ImGui::GetStyle();

    for (int i = 0; i < ImGuiCol_COUNT; i++)
        if (const uint32_t *color = sf_ui_parts_color(ImGui::GetStyleColorName(i)))
            style.Colors[i] = ImGui::ColorConvertU32ToFloat4(*color);
    style.WindowPadding = ImVec2(10, 9);
    style.FramePadding = ImVec2(7, 3);
    style.ItemSpacing = ImVec2(7, 5);
    style.WindowMinSize = ImVec2(8, 8);
    style.ScrollbarSize = 11;
    style.WindowRounding = style.PopupRounding = style.FrameRounding = style.TabRounding = style.ChildRounding = 4;
    style.ScrollbarRounding = style.GrabRounding = 3;
    style.ScaleAllSizes(scale);
}

/* Glyphs stand on whole px and a texel is a pixel, so that they stay as crisp as they were rasterised. */
static void add_font(ImFontAtlas *atlas, float scale)
{
    const char *file = sf_ui_parts_font();
    ImFontConfig config;

    atlas->Flags |= ImFontAtlasFlags_NoMouseCursors | ImFontAtlasFlags_NoBakedLines;
    atlas->SetTexID(&self);
    config.PixelSnapH = true;
    config.OversampleH = config.OversampleV = 1;
    if (file && atlas->AddFontFromFileTTF(file, std::round(14 * scale), &config, sf_ui_parts_glyphs))
        return;
    config.SizePixels = 13 * std::fmax(1.0f, std::round(scale));
    atlas->AddFontDefault(&config);
}

enum sf_status sf_ui_create(struct GLFWwindow *window, float scale, struct sf_ui **ui)
{
    *ui = nullptr;
    if (ImGui::GetCurrentContext() || !(scale > 0))
        return SF_ERROR_USAGE;
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    self = {window, scale, 0, false, false};
    io.IniFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    add_font(io.Fonts, scale);
    io.Fonts->Build();
    set_style(scale);
    io.KeyMap[ImGuiKey_Tab] = '\t', io.KeyMap[ImGuiKey_Enter] = '\n'; /* as fed; the backend has its own */
    io.KeyMap[ImGuiKey_Escape] = '\033', io.KeyMap[ImGuiKey_Backspace] = '\b', io.KeyMap[ImGuiKey_Space] = ' ';
    if (window)
        ImGui_ImplGlfw_InitForOther(window, true);
    *ui = &self;
    return SF_OK;
}

void sf_ui_destroy(struct sf_ui **ui)
{
    if (!ui || !*ui)
        return;
    if (self.window)
        ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    sf_ui_parts_end();
    *ui = nullptr;
}

/* A list is open, or controls are walked through by keys. */
static bool keys_walk()
{
    const ImGuiPopupFlags any = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;
    return ImGui::GetIO().NavVisible || ImGui::IsPopupOpen(nullptr, any);
}

void sf_ui_begin(struct sf_ui *)
{
    ImGuiIO &io = ImGui::GetIO();
    const ImVec2 &scale = io.DisplayFramebufferScale; /* the backend's: px for one of the window's units */

    if (self.window)
        ImGui_ImplGlfw_NewFrame();
    io.MousePos = ImVec2(std::fmax(io.MousePos.x * scale.x, -1e6f), std::fmax(io.MousePos.y * scale.y, -1e6f));
    io.DisplaySize = ImVec2(std::round(io.DisplaySize.x * scale.x), std::round(io.DisplaySize.y * scale.y));
    io.DisplayFramebufferScale = ImVec2(1, 1);
    io.DeltaTime = std::fmax(io.DeltaTime, 1e-6f);
    self = {self.window, self.scale, 0, false, keys_walk()};
    const bool walk = self.keys || io.WantTextInput || io.KeyCtrl; /* else arrows, Tab and Space are the picture's */
    io.ConfigFlags = walk ? ImGuiConfigFlags_NavEnableKeyboard : 0;
    io.KeysDown[io.KeyMap[ImGuiKey_Tab]] &= walk;
    ImGui::NewFrame();
    sf_ui_parts_begin(io.MouseDelta.x != 0 || io.MouseDelta.y != 0 || ImGui::IsAnyMouseDown());
}

void sf_ui_end(struct sf_ui *, struct sf_overlay *overlay)
{
    ImGui::Render();
    const ImDrawData *data = ImGui::GetDrawData();
    sf_ui_mesh_clear(data->DisplaySize.x, data->DisplaySize.y);
    for (int n = 0; n < data->CmdListsCount; n++) {
        const ImDrawList *list = data->CmdLists[n];

        for (const ImDrawCmd &command : list->CmdBuffer)
            if (!command.UserCallback)
                sf_ui_mesh_batch(&command.ClipRect.x, list->IdxBuffer.Data + command.IdxOffset, command.ElemCount,
                                 command.VtxOffset);
        sf_ui_mesh_vertices(list->VtxBuffer.Data, (uint32_t)list->VtxBuffer.Size);
    }
    sf_ui_mesh_overlay(overlay);
    if (!self.window) /* what was fed is let go */
        for (bool &down : ImGui::GetIO().KeysDown)
            down = false;
}

/* ---- panels ---- */

bool sf_ui_panel_begin(const char *title, float x, float y, float width, float height, unsigned flags, bool *open)
{
    /* clang-format off */
    enum { STILL = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse };
    enum { DEAF = ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoScrollbar };
    static const unsigned meanings[][2] = {
        {SF_UI_FIXED, STILL | ImGuiWindowFlags_NoBringToFrontOnFocus}, {SF_UI_SHADE, STILL}, {SF_UI_QUIET, DEAF},
        {SF_UI_CLEAR, DEAF | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoTitleBar},
        {SF_UI_UNTITLED, ImGuiWindowFlags_NoTitleBar}, {SF_UI_BOX, STILL | ImGuiWindowFlags_AlwaysAutoResize}};
    /* clang-format on */
    const bool solid = flags & SF_UI_SOLID, box = flags & SF_UI_BOX;
    const int when = flags & (SF_UI_FIXED | SF_UI_SHADE | SF_UI_BOX) ? ImGuiCond_Always : ImGuiCond_FirstUseEver;
    unsigned window = 0;

    for (const auto &meaning : meanings)
        window |= flags & meaning[0] ? meaning[1] : 0;
    ImGui::SetNextWindowPos(ImVec2(x, y), when, box ? ImVec2(0.5f, 0.5f) : ImVec2());
    if (box)
        ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(width, height));
    else
        ImGui::SetNextWindowSize(ImVec2(width, height), height > 0 ? when : ImGuiCond_Always);
    if (solid)
        ImGui::SetNextWindowBgAlpha(flags & SF_UI_SHADE ? 0.55f : 1.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, solid ? 0 : ImGui::GetStyle().WindowRounding);
    self.depth++;
    const bool shown = ImGui::Begin(title, open, (ImGuiWindowFlags)window);
    ImGui::PopStyleVar();
    return shown;
}

/* From here on functions of a line or two that pass ui.h's words on to ImGui. */
/* clang-format off */
static ImGuiIO &io() { return ImGui::GetIO(); }
static ImDrawList *target()
{ return self.behind || self.depth == 0 ? ImGui::GetBackgroundDrawList() : ImGui::GetWindowDrawList(); }
void sf_ui_font(const struct sf_ui *, const uint8_t **coverage, uint32_t *width, uint32_t *height)
{ io().Fonts->GetTexDataAsAlpha8((unsigned char **)coverage, (int *)width, (int *)height); }
void sf_ui_panel_end(void) { ImGui::End(); self.depth--; }
bool sf_ui_child_begin(const char *name, float height) { return ImGui::BeginChild(name, ImVec2(0, height)); }
void sf_ui_child_end(void) { ImGui::EndChild(); }
bool sf_ui_tabs_begin(const char *name) { return ImGui::BeginTabBar(name, ImGuiTabBarFlags_NoTooltip); }
bool sf_ui_raw_tab(const char *label, bool choose)
{ return ImGui::BeginTabItem(label, nullptr, choose ? ImGuiTabItemFlags_SetSelected : 0); }
void sf_ui_tab_end(void) { ImGui::EndTabItem(); }
void sf_ui_tabs_end(void) { ImGui::EndTabBar(); }
bool sf_ui_section(const char *label, bool open)
{ return ImGui::CollapsingHeader(label, open ? ImGuiTreeNodeFlags_DefaultOpen : 0); }
bool sf_ui_raw_panel_clicked(void) { return ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0); }

/* ---- lines ---- */
float sf_ui_line(void) { return ImGui::GetFrameHeightWithSpacing(); }
float sf_ui_scale(void) { return self.scale; }
float sf_ui_room(void) { return ImGui::GetContentRegionAvail().x; }
void sf_ui_same_line(float x) { ImGui::SameLine(x); }
void sf_ui_separator(void) { ImGui::Separator(); }
void sf_ui_space(float height) { ImGui::Dummy(ImVec2(0, height)); }
void sf_ui_width(float width) { ImGui::SetNextItemWidth(width); }
void sf_ui_id_push(const char *id) { ImGui::PushID(id); }
void sf_ui_id_pop(void) { ImGui::PopID(); }
void sf_ui_disable(bool disabled) { ImGui::BeginDisabled(disabled); }
void sf_ui_enable(void) { ImGui::EndDisabled(); }

/* ---- words ---- */
void sf_ui_raw_words(uint32_t color, float wrap, const char *text)
{
    if (wrap < 0)
        ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::PushTextWrapPos(wrap);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}
void sf_ui_raw_tooltip(const char *text, float wrap)
{ ImGui::BeginTooltip(); sf_ui_raw_words(sf_ui_plain, wrap, text); ImGui::EndTooltip(); }

/* ---- controls ---- */
enum { CLAMP = ImGuiSliderFlags_AlwaysClamp, CURVED = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic };
bool sf_ui_button(const char *label) { return ImGui::Button(label); }
bool sf_ui_small_button(const char *label) { return ImGui::SmallButton(label); }
bool sf_ui_selectable(const char *label, bool selected) { return ImGui::Selectable(label, selected); }
bool sf_ui_checkbox(const char *label, bool *value) { return ImGui::Checkbox(label, value); }
bool sf_ui_slider(const char *label, float *value, float min, float max, const char *format, bool logarithmic)
{ return ImGui::SliderFloat(label, value, min, max, format, logarithmic ? CURVED : CLAMP); }
bool sf_ui_slider_int(const char *label, int *value, int min, int max, bool logarithmic)
{ return ImGui::SliderInt(label, value, min, max, "%d", logarithmic ? CURVED : CLAMP); }
bool sf_ui_drag(const char *label, float *values, unsigned count, float speed, float min, float max, const char *format)
{ return ImGui::DragScalarN(label, ImGuiDataType_Float, values, (int)count, speed, &min, &max, format, CLAMP); }
bool sf_ui_color(const char *label, float rgb[3], bool hdr)
{ return ImGui::ColorEdit3(label, rgb, ImGuiColorEditFlags_Float | (hdr ? ImGuiColorEditFlags_HDR : 0)); }
void sf_ui_raw_choice(const char *label, int *value, const char *const *choices, int count)
{ ImGui::Combo(label, value, choices, count, 20); }
unsigned sf_ui_raw_field(const char *label, const char *hint, char *text, unsigned room, bool whole)
{
    const int flags = whole ? ImGuiInputTextFlags_EnterReturnsTrue : ImGuiInputTextFlags_AutoSelectAll;
    return ImGui::InputTextWithHint(label, hint, text, room, flags) * SF_UI_FIELD_CHANGED +
           ImGui::IsItemActive() * SF_UI_FIELD_ACTIVE + ImGui::IsItemDeactivatedAfterEdit() * SF_UI_FIELD_LEFT;
}
unsigned sf_ui_raw_id(const char *label) { return ImGui::GetID(label); }
void sf_ui_raw_focus(void) { ImGui::SetKeyboardFocusHere(); }
void sf_ui_progress(float part, const char *text) { ImGui::ProgressBar(part, ImVec2(0, 0), text); }
void sf_ui_plot(const char *label, const float *values, unsigned count, unsigned first, float min, float max,
                float height)
{ ImGui::PlotLines(label, values, (int)count, (int)first, nullptr, min, max, ImVec2(0, height)); }
void sf_ui_last_rectangle(float rectangle[4])
{
    const ImVec2 low = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
    rectangle[0] = low.x, rectangle[1] = low.y, rectangle[2] = size.x, rectangle[3] = size.y;
}
bool sf_ui_last_hovered(void) { return ImGui::IsItemHovered(); }
bool sf_ui_last_active(void) { return ImGui::IsItemActive(); }
bool sf_ui_raw_hovered(void) { return ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled); }

/* ---- drawing ---- */
void sf_ui_raw_place(float *x, float *y) { *x = ImGui::GetCursorScreenPos().x; *y = ImGui::GetCursorScreenPos().y; }
void sf_ui_raw_canvas(const char *name, float width, float height)
{ ImGui::InvisibleButton(name, ImVec2(width, height)); }
void sf_ui_draw_behind(void) { self.behind = true; } void sf_ui_draw_panel(void) { self.behind = false; }
void sf_ui_draw_clip(float x, float y, float width, float height)
{ target()->PushClipRect(ImVec2(x, y), ImVec2(x + width, y + height), true); }
void sf_ui_draw_unclip(void) { target()->PopClipRect(); }
void sf_ui_draw_line(float x0, float y0, float x1, float y1, uint32_t color, float thickness)
{ target()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color, thickness); }
void sf_ui_draw_rectangle(float x, float y, float width, float height, uint32_t color, bool filled)
{
    const ImVec2 low(x, y), high(x + width, y + height);
    filled ? target()->AddRectFilled(low, high, color) : target()->AddRect(low, high, color, 0, 0, self.scale);
}
void sf_ui_draw_circle(float x, float y, float radius, uint32_t color, bool filled)
{
    filled ? target()->AddCircleFilled(ImVec2(x, y), radius, color)
           : target()->AddCircle(ImVec2(x, y), radius, color, 0, self.scale);
}
void sf_ui_draw_text(float x, float y, uint32_t color, const char *text)
{ target()->AddText(ImVec2(x, y), color, text); }
float sf_ui_text_width(const char *text) { return ImGui::CalcTextSize(text).x; }

/* ---- the mouse and keys ---- */
bool sf_ui_takes_mouse(void) { return io().WantCaptureMouse; }
bool sf_ui_takes_keys(void) { return io().WantTextInput || self.keys || keys_walk() || sf_ui_parts_used_keys(); }
bool sf_ui_raw_escape(bool free)
{ return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false) && !(free && sf_ui_takes_keys()); }
void sf_ui_mouse(float *x, float *y) { *x = io().MousePos.x; *y = io().MousePos.y; }
void sf_ui_mouse_moved(float *dx, float *dy) { *dx = io().MouseDelta.x; *dy = io().MouseDelta.y; }
float sf_ui_wheel(void) { return io().MouseWheel; }
bool sf_ui_mouse_down(int button) { return ImGui::IsMouseDown(button); }
bool sf_ui_mouse_clicked(int button) { return ImGui::IsMouseClicked(button); }
bool sf_ui_mouse_double(int button) { return ImGui::IsMouseDoubleClicked(button); }
void sf_ui_mouse_sideways(void) { ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW); }
void sf_ui_raw_size(float size[2]) { size[0] = io().DisplaySize.x; size[1] = io().DisplaySize.y; }
void sf_ui_feed_size(uint32_t width, uint32_t height) { io().DisplaySize = ImVec2((float)width, (float)height); }
void sf_ui_feed_mouse(float x, float y, bool down) { io().MousePos = ImVec2(x, y); io().MouseDown[0] = down; }
void sf_ui_feed_key(int key, bool down, bool control, bool shift)
{ io().KeysDown[key] = down; io().KeyCtrl = control; io().KeyShift = shift; }
void sf_ui_feed_text(const char *text)
{
    io().AddInputCharactersUTF8(text);
    for (; *text; text++) if (*text > 0 && *text < ' ') io().KeysDown[(int)*text] = true;
}
/* clang-format on */
