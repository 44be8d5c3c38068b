/* The page: index.html with its pictures beside it, plot.svg and verify.json. It is XHTML as well as HTML, and asks nothing
 * of any network. */
#include "verify.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../console.h"
#include "../files.h"
#include "markup.h"
#include "plots.h"

enum { TEXT_ROOM = 512 };

static const char style[] =
    "body{margin:0;background:#f4f4f2;color:#222;font:15px/1.5 system-ui,sans-serif}"
    "main{max-width:1180px;margin:0 auto;padding:28px 24px 60px}"
    "h1{font-size:26px;margin:0 0 4px}h2{font-size:20px;margin:0}"
    "section{background:#fff;border:1px solid #deded8;border-radius:8px;padding:18px 22px;margin:22px 0}"
    ".sub{color:#666;margin:0 0 14px}a{color:#0b5c94;text-decoration:none}a:hover{text-decoration:underline}"
    "table{border-collapse:collapse;font-variant-numeric:tabular-nums;margin:10px 0}"
    "th,td{padding:3px 12px 3px 0;text-align:right;white-space:nowrap}th{color:#666;font-weight:600;"
    "border-bottom:1px solid #ccc}th:first-child,td:first-child{text-align:left}"
    "tr.sweep td:first-child{padding-left:16px;color:#555}td.miss{color:#b3261e;font-weight:600}"
    "td.pass{color:#1b6e37}.pictures{display:flex;flex-wrap:wrap;gap:14px;margin:14px 0 4px}"
    "figure{margin:0}figcaption{font-size:13px;color:#555}"
    ".pictures img{width:200px;height:auto;display:block;image-rendering:pixelated;border:1px solid #bbb}"
    ".note{background:#fff6dd;border-left:4px solid #e0a800;padding:6px 12px;margin:8px 0}"
    ".fault{background:#fde7e5;border-left:4px solid #b3261e;padding:6px 12px;margin:8px 0}"
    ".both{display:flex;flex-wrap:wrap;gap:8px 28px;align-items:flex-start}"
    ".both svg{flex:1 1 380px;min-width:0;max-width:720px}svg{max-width:100%;height:auto}";

/* ---- tables ---- */

static void put_cell(FILE *to, bool judged, bool missed, const char *format, double value)
{
    fprintf(to, judged ? missed ? "<td class=\"miss\">" : "<td class=\"pass\">" : "<td>");
    if (isfinite(value))
        fprintf(to, format, value);
    else
        fputs("&#8734;", to);
    fputs("</td>", to);
}

static void put_entry(FILE *to, const struct sf_verify_entry *entry)
{
    fprintf(to, "<tr%s><td>", entry->sweep > 0 ? " class=\"sweep\"" : "");
    sf_markup_text(to, entry->sweep > 0 ? entry->label : entry->method);
    fputs("</td>", to);
}

static void put_numbers(FILE *to, const struct sf_errors *errors, double ms)
{
    unsigned missed = sf_goals_missed(errors);

    if (errors->pixels == 0) {
        fputs("<td>&#8211;</td><td>&#8211;</td><td>&#8211;</td><td>&#8211;</td><td>&#8211;</td><td>&#8211;</td>", to);
    } else {
        put_cell(to, true, errors->transmittance_mean > sf_goals.transmittance_mean, "%.5f",
                 errors->transmittance_mean);
        put_cell(to, true, errors->transmittance_max > sf_goals.transmittance_max, "%.5f", errors->transmittance_max);
        put_cell(to, true, errors->alpha_max > sf_goals.transmittance_max, "%.5f", errors->alpha_max);
        put_cell(to, true, missed & SF_GOAL_MSE, "%.3g", errors->relative_mse);
        put_cell(to, false, false, "%+.2f&#8201;%%", 100 * errors->bias);
        put_cell(to, false, false, "%.3g", errors->p99);
    }
    if (ms > 0)
        put_cell(to, false, false, "%.2f", ms);
    else
        fputs("<td>&#8211;</td>", to);
}

static const char heads[] = "<th title=\"mean error of transmittance\">T mean</th>"
                            "<th title=\"largest error of transmittance\">T max</th>"
                            "<th title=\"largest error of 1 - alpha\">&#945; max</th>"
                            "<th title=\"sum (L-R)&#178; / sum R&#178;\">rel. MSE</th>"
                            "<th title=\"sum (L-R) / sum R\">bias</th>"
                            "<th title=\"99th percentile of |L-R| in smoke, over the RMS of R\">p99</th>"
                            "<th title=\"all passes of the picture, simulation apart\">ms</th>";

static void put_table(FILE *to, const struct sf_verify *verify, const struct sf_verify_case *result)
{
    fprintf(to, "<table><thead><tr><th>method</th>%s</tr></thead><tbody>\n", heads);
    for (size_t i = 0; i < verify->entry_count; i++) {
        put_entry(to, &verify->entries[i]);
        put_numbers(to, &result->rows[i].errors, result->rows[i].samples > 0 ? result->rows[i].ms : 0);
        fputs("</tr>\n", to);
    }
    fputs("</tbody></table>\n", to);
}

static void put_summary(FILE *to, const struct sf_verify *verify)
{
    fprintf(to,
            "<table><thead><tr><th>worst of %zu</th>%s<th title=\"geometric mean of all\">typical MSE</th>"
            "<th>scenes that pass</th></tr></thead><tbody>\n",
            verify->case_count, heads);
    for (size_t i = 0; i < verify->entry_count; i++) {
        struct sf_verify_summary s;

        sf_verify_summarise(verify, i, &s);
        const struct sf_errors worst = {.transmittance_mean = s.transmittance_mean,
                                        .transmittance_max = s.transmittance_max,
                                        .alpha_max = s.alpha_max,
                                        .relative_mse = s.relative_mse,
                                        .bias = s.bias,
                                        .p99 = s.p99,
                                        .pixels = s.rows};
        put_entry(to, &verify->entries[i]);
        put_numbers(to, &worst, s.ms);
        put_cell(to, false, false, "%.3g", s.typical_mse);
        fprintf(to, "<td class=\"%s\">%zu of %zu</td></tr>\n", s.missed ? "miss" : "pass",
                verify->case_count - s.missed, verify->case_count);
    }
    fputs("</tbody></table>\n", to);
}

/* Scenes down, methods across: the relative MSE, and the way to the scene's part of the page. */
static void put_matrix(FILE *to, const struct sf_verify *verify)
{
    fputs("<table><thead><tr><th>rel. MSE</th>", to);
    for (size_t i = 0; i < verify->entry_count; i++) {
        if (verify->entries[i].sweep > 0)
            continue;
        fputs("<th>", to);
        sf_markup_text(to, verify->entries[i].method);
        fputs("</th>", to);
    }
    fputs("</tr></thead><tbody>\n", to);
    for (size_t c = 0; c < verify->case_count; c++) {
        const struct sf_verify_case *result = &verify->cases[c];

        fprintf(to, "<tr><td><a href=\"#%s\">", result->base);
        sf_markup_text(to, result->name);
        fprintf(to, ", frame %u</a></td>", result->frame);
        for (size_t i = 0; i < verify->entry_count; i++)
            if (verify->entries[i].sweep == 0)
                put_cell(to, true, sf_goals_missed(&result->rows[i].errors) != 0, "%.3g",
                         result->rows[i].errors.relative_mse);
        fputs("</tr>\n", to);
    }
    fputs("</tbody></table>\n", to);
}

/* ---- pictures ---- */

static void put_picture(FILE *to, const struct sf_verify_case *result, const char *method, bool difference)
{
    char name[192];

    sf_verify_picture_name(result, method, difference, name, sizeof name);
    fprintf(to, "<figure><img src=\"%s\" alt=\"\"/><figcaption>", name);
    sf_markup_text(to, method ? method : "reference");
    fprintf(to, "%s</figcaption></figure>\n", difference ? " &#8722; reference" : "");
}

/* The colours of the differences with their numbers. */
static void put_scale(FILE *to, double scale)
{
    enum { CELLS = 64, WIDTH = 420 };

    fprintf(to,
            "<svg viewBox=\"0 0 %d 44\" width=\"%d\" height=\"44\" font-family=\"sans-serif\" font-size=\"11\" "
            "fill=\"#444444\">\n",
            WIDTH + 80, WIDTH + 80);
    for (int i = 0; i < CELLS; i++) {
        double rgb[3];

        sf_verify_heat(2 * (i + 0.5) / CELLS - 1, rgb);
        fprintf(to, "<rect x=\"%.2f\" y=\"4\" width=\"%.2f\" height=\"14\" fill=\"#%02x%02x%02x\"/>\n",
                40 + (double)WIDTH * i / CELLS, (double)WIDTH / CELLS + 0.2, (unsigned)(rgb[0] * 255 + 0.5),
                (unsigned)(rgb[1] * 255 + 0.5), (unsigned)(rgb[2] * 255 + 0.5));
    }
    fprintf(to, "<rect x=\"40\" y=\"4\" width=\"%d\" height=\"14\" fill=\"none\" stroke=\"#888888\"/>\n", WIDTH);
    for (int i = -2; i <= 2; i++)
        fprintf(to, "<text x=\"%d\" y=\"33\" text-anchor=\"middle\">%s%g</text>\n", 40 + WIDTH * (i + 2) / 4,
                i > 0 ? "+" : "", scale * i / 2);
    fputs("</svg><div class=\"sub\">W/(m&#178; sr), brightness of the difference: blue is too dark, red too "
          "bright</div>\n",
          to);
}

static void put_faults(FILE *to, const struct sf_verify *verify, const struct sf_verify_case *result)
{
    for (size_t i = 0; i < verify->entry_count; i++) {
        const struct sf_verify_fault *fault = &result->rows[i].fault;
        char name[128];

        if (!fault->found)
            continue;
        sf_verify_entry_text(&verify->entries[i], name, sizeof name);
        fputs("<p class=\"fault\">", to);
        sf_markup_text(to, name);
        fprintf(to, ": %g in pixel (%u, %u) of ", (double)fault->value, fault->x, fault->y);
        sf_markup_text(to, fault->image);
        fputs(", made by ", to);
        sf_markup_text(to, fault->pass);
        fputs(fault->others[0] ? " or " : "", to);
        sf_markup_text(to, fault->others);
        fputs("</p>\n", to);
    }
}

static void put_svg(FILE *to, char *svg)
{
    if (svg)
        fputs(svg, to);
    free(svg);
}

static void put_case(FILE *to, const struct sf_verify *verify, const struct sf_verify_case *result)
{
    bool compared = result->rows[0].errors.pixels + result->rows[0].errors.not_finite > 0;

    fprintf(to, "<section id=\"%s\"><h2>", result->base);
    sf_markup_text(to, result->name);
    fprintf(to, "</h2><p class=\"sub\">frame %u, %u particle%s; ", result->frame, result->live,
            result->live == 1 ? "" : "s");
    sf_markup_text(to, result->path);
    fputs("</p>\n", to);
    put_faults(to, verify, result);
    if (compared) {
        fputs("<div class=\"pictures\">\n", to);
        put_picture(to, result, NULL, false);
        for (size_t i = 0; i < verify->entry_count; i++) {
            if (verify->entries[i].sweep > 0)
                continue;
            put_picture(to, result, verify->entries[i].method, false);
            put_picture(to, result, verify->entries[i].method, true);
        }
        fputs("</div>\n", to);
        put_scale(to, result->scale);
    }
    fputs("<div class=\"both\">\n", to);
    put_table(to, verify, result);
    put_svg(to, sf_verify_plot_case(verify, result));
    fputs("</div></section>\n", to);
}

/* ---- the whole ---- */

static void put_head(FILE *to, const struct sf_verify *verify, bool finished)
{
    const struct sf_arguments *arguments = verify->arguments;

    fputs("<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\"><head><meta "
          "charset=\"utf-8\"/>" SF_VERIFY_MARK "<title>sfumato verify</title>\n<style>",
          to);
    fputs(style, to);
    fputs("</style></head><body><main>\n<h1>How wrong, and how fast</h1>\n<p class=\"sub\">sfumato " SF_VERSION ", ",
          to);
    sf_markup_text(to, verify->info.name);
    fputs(", ", to);
    sf_markup_text(to, verify->info.driver);
    fprintf(to, "; %u&#215;%u against the reference to %g", arguments->size.width, arguments->size.height,
            arguments->tolerance.value);
    if (arguments->repeats > 0)
        fprintf(to, "; times at %u&#215;%u, medians", arguments->time_size.width, arguments->time_size.height);
    fputs("</p>\n", to);
    if (!finished)
        fprintf(to, "<p class=\"note\">Not complete: %zu of %zu scenes so far.</p>\n", verify->case_count,
                verify->case_total);
}

static void put_page(FILE *to, const struct sf_verify *verify, bool finished)
{
    char note[TEXT_ROOM];

    put_head(to, verify, finished);
    if (verify->case_count > 0) {
        fputs("<section>", to);
        if (verify->case_count > 1)
            put_summary(to, verify);
        fputs("<div class=\"both\">\n", to);
        put_matrix(to, verify);
        if (verify->case_count > 1)
            put_svg(to, sf_verify_plot_all(verify));
        fputs("</div>\n", to);
        fprintf(to,
                "<p class=\"sub\">Goals: T mean at most %g, T max and &#945; max at most %g, relative MSE at most "
                "%g. L is the method's radiance of the smoke alone, R the reference's.</p>\n",
                sf_goals.transmittance_mean, sf_goals.transmittance_max, sf_goals.relative_mse);
        for (size_t i = 0; sf_verify_note(verify, i, note, sizeof note); i++) {
            fputs("<p class=\"note\">", to);
            sf_markup_text(to, note);
            fputs("</p>\n", to);
        }
        fputs("</section>\n", to);
    }
    for (size_t i = 0; i < verify->case_count; i++)
        put_case(to, verify, &verify->cases[i]);
    fputs("</main></body></html>\n", to);
}

/* Takes over `text`; NULL is a lack of memory. */
static enum sf_status write_text(const struct sf_verify *verify, const char *name, char *text)
{
    char *path = text ? sf_verify_folder_path(verify, name) : NULL;
    enum sf_status status =
        path ? sf_report_write(path, text, strlen(text)) : sf_console_fail(SF_ERROR_MEMORY, "%s: out of memory", name);

    free(path);
    free(text);
    return status;
}

enum sf_status sf_verify_write_page(const struct sf_verify *verify, bool finished)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *to = open_memstream(&text, &bytes);
    enum sf_status status;

    if (to) {
        put_page(to, verify, finished);
        if (fclose(to) != 0) {
            free(text);
            text = NULL;
        }
    }
    status = write_text(verify, "index.html", text);
    if (!status && verify->case_count > 0)
        status = write_text(verify, "plot.svg", sf_verify_plot_all(verify));
    if (!status && verify->case_count > 0)
        status = write_text(verify, "verify.json", sf_verify_json(verify));
    return status;
}
