/* What the panels that draw have in common. */
#ifndef SF_APP_VIEW_PANEL_DRAW_H
#define SF_APP_VIEW_PANEL_DRAW_H

#include <stdint.h>
#include "ui.h"

/* Lines of graphs and bars: what the device does, what the processor does. */
#define SF_COLOR_DEVICE 0xff66a0d9u
#define SF_COLOR_HOST   0xffc2a66fu
#define SF_COLOR_SHADE  0x12e8f4ffu /* behind rows and drawings */

/* The same colour with so much of its alpha: 0..1. */
static inline uint32_t sf_color_faint(uint32_t color, float alpha)
{
    return (color & 0xffffff) | (uint32_t)((float)(color >> 24) * alpha + 0.5f) << 24;
}

/* Text that ends at x. */
static inline void sf_draw_text_right(float x, float y, uint32_t color, const char *text)
{
    sf_ui_draw_text(x - sf_ui_text_width(text), y, color, text);
}

#endif
