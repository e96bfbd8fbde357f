#include "chart/svg.h"

#include "chart/html.h"
#include "cli/cli_table.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

const char *const svg_colour[SVG_COLOURS] = {"#0072b2", "#c44e00", "#007a5a",
                                             "#a23b82", "#8a6d00", "#3f8fbf",
                                             "#5b5b5b", "#b2182b"};

/* How gnuplot begins words. */
static const char bare_words[] = "stroke=\"none\"";

static bool starts(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* Behind the next @p end; the end of the text if there is none. */
static const char *behind(const char *text, const char *end)
{
    const char *found = strstr(text, end);

    return found ? found + strlen(end) : text + strlen(text);
}

static void put_name(FILE *file, const char *title, const char *summary)
{
    fputs("<title>", file);
    html_text(file, title);
    fputs("</title>\n<desc>", file);
    html_text(file, summary);
    fputs("</desc>", file);
}

/* What a point is called when it is pointed at. */
static const char *put_tip(FILE *file, const char *text, int64_t num_tips,
                           char *const *tip)
{
    const char *number = strchr(text, '\'');
    long which = number ? strtol(number + 1, NULL, 10) : -1;

    fputs("<g class=\"mark\"><title>", file);
    if (which >= 0 && which < num_tips)
        html_text(file, tip[which]);
    fputs("</title>", file);
    return behind(text, "</title>");
}

/* Behind a group that holds nothing; or where it began. */
static const char *skip_empty(const char *text)
{
    const char *inside = behind(text, ">");

    return starts(inside, "\n</g>\n") ? inside + 6 : text;
}

/*
 * Words get a rim of paper, so that they can be read across lines and points;
 * those that are themselves the colour of paper stand on something dark.
 */
static const char *put_rim(FILE *file, const char *text)
{
    const char *end = text + strcspn(text, ">");
    const char *font = strstr(text, "font-family");
    const char *pale = strstr(text, "fill=\"rgb(255,255,255)\"");

    if (!font || font > end || (pale && pale < end))
        return text;
    fputs("stroke=\"" SVG_PAPER "\" stroke-width=\"3\" "
          "stroke-linejoin=\"round\" paint-order=\"stroke\"",
          file);
    return text + strlen(bare_words);
}

ritz_status svg_dress(const char *drawn, const char *title, const char *summary,
                      int64_t num_tips, char *const *tip, char **out)
{
    static const char pointed[] = "<g onmousemove=";
    ritz_status status = RITZ_OK;
    cli_table table = {0};
    bool named = false;
    const char *c = drawn;

    RITZ_TRY(cli_table_new(&table));
    while (*c) {
        const char *next = starts(c, "<g fill=")   ? skip_empty(c)
                           : starts(c, bare_words) ? put_rim(table.file, c)
                                                   : c;

        if (next > c) {
            c = next;
        } else if (starts(c, "<title>") && !named) {
            put_name(table.file, title, summary);
            named = true;
            c = behind(c, "</desc>");
        } else if (starts(c, "<title>")) {
            c = behind(c, "</title>"); /* of a line: no name of a point */
        } else if (starts(c, pointed)) {
            c = put_tip(table.file, c, num_tips, tip);
        } else {
            fputc(*c++, table.file);
        }
    }
    RITZ_FAIL_IF(ferror(table.file) || fflush(table.file) != 0, RITZ_ERR_MEMORY,
                 "no memory for a picture");
    *out = strdup(table.text);
    RITZ_FAIL_IF(!*out, RITZ_ERR_MEMORY, "no memory for a picture");
done:
    cli_table_free(&table);
    return status;
}

/* "--c3" of one of our colours; NULL of any other. */
static const char *variable(unsigned red, unsigned green, unsigned blue)
{
    static const struct {
        const char *colour, *name;
    } known[] = {
        {SVG_INK, "--ink"},     {SVG_MUTED, "--muted"}, {SVG_GRID, "--grid"},
        {SVG_PAPER, "--paper"}, {SVG_ALARM, "--alarm"}, {SVG_PALE, "--pale"},
        {"#000000", "--ink"},
    };
    static const char *const series[SVG_COLOURS] = {
        "--c1", "--c2", "--c3", "--c4", "--c5", "--c6", "--c7", "--c8"};
    char text[32];

    snprintf(text, sizeof text, "#%02x%02x%02x", red & 255, green & 255,
             blue & 255);
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strcmp(known[k].colour, text) == 0)
            return known[k].name;
    for (int k = 0; k < SVG_COLOURS; k++)
        if (strcmp(svg_colour[k], text) == 0)
            return series[k];
    return NULL;
}

/* "rgb(  0, 114, 178)" or "#0072b2"; false: something else. */
static bool read_colour(const char *text, unsigned rgb[3])
{
    bool listed = starts(text, "rgb(");
    const char *at = text + (listed ? 4 : 1);

    if (!listed && (text[0] != '#' || strlen(text) != 7))
        return false;
    for (int k = 0; k < 3; k++) {
        char pair[] = {at[0], at[1], '\0'};
        char *end = NULL;

        rgb[k] = (unsigned)(listed ? strtoul(at, &end, 10)
                                   : strtoul(pair, &end, 16));
        if (end == at || end == pair)
            return false;
        at = listed ? end + (*end == ',') : at + 2;
    }
    return true;
}

/* What an attribute says, without its quotes: fill='rgb(0, 114, 178)'. */
static void put_value(FILE *file, const char *value, int length,
                      const char *prefix)
{
    const char *name = NULL;
    unsigned rgb[3] = {0};
    char text[64] = "";

    snprintf(text, sizeof text, "%.*s", length, value);
    if (read_colour(text, rgb))
        name = variable(rgb[0], rgb[1], rgb[2]);
    if (strcmp(text, "black") == 0)
        name = "--ink";
    if (name)
        fprintf(file, "var(%s)", name);
    else if (starts(text, "#gp"))
        fprintf(file, "#%s%.*s", prefix, length - 1, value + 1);
    else
        fprintf(file, "%.*s", length, value);
}

/* A tag from '<' to '>'; ids are prefixed, and colours named. */
static const char *put_tag(FILE *file, const char *tag, const char *prefix)
{
    while (*tag && *tag != '>') {
        char mark = *tag;
        const char *end =
            mark == '"' || mark == '\'' ? strchr(tag + 1, mark) : NULL;
        bool is_id = starts(tag, " id=");

        fputc(*tag++, file);
        if (end) {
            put_value(file, tag, (int)(end - tag), prefix);
            fputc(mark, file);
            tag = end + 1;
        } else if (is_id) {
            fprintf(file, "id=%c%s", tag[3], prefix);
            tag += 4;
            while (*tag && *tag != '"' && *tag != '\'')
                fputc(*tag++, file);
            if (*tag)
                fputc(*tag++, file);
        }
    }
    return tag;
}

/* Whether it would be illegible on a telephone, and is to be scrolled. */
static bool is_wide(const char *svg)
{
    const char *box = strstr(svg, "viewBox=\"0 0 ");

    return box && strtod(box + strlen("viewBox=\"0 0 "), NULL) > SVG_WIDE;
}

void svg_embed(FILE *file, const char *svg, const char *prefix)
{
    const char *c = strstr(svg, "<svg");
    bool named = false;

    if (!c)
        return;
    fprintf(file,
            "<svg class=\"picture%s\" role=\"img\" aria-labelledby=\"%st %sd\"",
            is_wide(c) ? " wide" : "", prefix, prefix);
    for (c += 4; *c;) {
        if (!named && starts(c, "<title>")) {
            fprintf(file, "<title id=\"%st\">", prefix);
            c += 7;
        } else if (!named && starts(c, "<desc>")) {
            fprintf(file, "<desc id=\"%sd\">", prefix);
            c += 6;
            named = true;
        } else if (*c == '<') {
            c = put_tag(file, c, prefix);
        } else {
            fputc(*c++, file);
        }
    }
}
