#include "chart/svg.h"

#include "chart/html.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

const svg_colour svg_colours[] = {
    {"c1", "#0072b2"},    {"c2", "#c44e00"},   {"c3", "#007a5a"},
    {"c4", "#a23b82"},    {"c5", "#8a6d00"},   {"c6", "#3f8fbf"},
    {"c7", "#5b5b5b"},    {"c8", "#b2182b"},   {"ink", "#1b1f24"},
    {"muted", "#5a6270"}, {"grid", "#d9dee5"}, {"paper", "#ffffff"},
    {"alarm", "#b00020"}, {"pale", "#9fb0c3"}, {NULL, NULL},
};

const char *svg_series(int64_t series)
{
    return svg_colours[series % SVG_SERIES].name;
}

static bool starts_with(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* Behind the next @p end; the end of the text if there is none. */
static const char *skip_past(const char *text, const char *end)
{
    const char *found = strstr(text, end);

    return found ? found + strlen(end) : text + strlen(text);
}

static const char pointed[] =
    "<g onmousemove=\"gnuplot_svg.showHypertext(evt,'";

/*
 * A label of hypertext. picture_tip wrote it as markup; gnuplot has escaped '&'
 * once more and written ends of lines as "\n".
 */
static const char *copy_tip(FILE *file, const char *c)
{
    const char *end = strstr(c, "')\" onmouseout=");

    fputs("<g class=\"mark\"><title>", file);
    for (c += strlen(pointed); end && c < end;) {
        bool line = starts_with(c, "\\n"), amp = starts_with(c, "&amp;");

        fputc(line ? '\n' : *c, file);
        c += line ? 2 : amp ? 5 : 1;
    }
    fputs("</title>", file);
    return skip_past(c, "</title>");
}

/* Name of the page for a colour, "rgb(  0, 114, 178)", "#0072b2" or "black";
   NULL: it has none. */
static const char *name_colour(const char *text)
{
    unsigned long rgb = 0;
    char *end = NULL;
    char value[32];

    if (starts_with(text, "rgb("))
        for (const char *c = text + 3; *c == '(' || *c == ','; c = end)
            rgb = rgb << 8 | (strtoul(c + 1, &end, 10) & 255);
    else if (text[0] == '#' && strspn(text + 1, "0123456789abcdefABCDEF") == 6)
        rgb = strtoul(text + 1, NULL, 16);
    else if (strcmp(text, "black") != 0)
        return NULL;
    snprintf(value, sizeof value, "#%06lx", rgb);
    for (const svg_colour *k = svg_colours; k->name; k++)
        if (strcmp(k->value, value) == 0)
            return k->name;
    return rgb == 0 ? "ink" : NULL;
}

/* A value of an attribute; ids and references to them get the prefix. */
static void copy_value(FILE *file, const char *value, size_t length,
                       const char *prefix, bool is_id)
{
    char text[40] = "";
    const char *colour = NULL;

    if (length < sizeof text) {
        memcpy(text, value, length);
        colour = name_colour(text);
    }
    if (colour)
        fprintf(file, "var(--%s)", colour);
    else if (is_id)
        fprintf(file, "%s%.*s", prefix, (int)length, value);
    else if (starts_with(value, "#gp"))
        fprintf(file, "#%s%.*s", prefix, (int)length - 1, value + 1);
    else
        fprintf(file, "%.*s", (int)length, value);
}

/* A tag from '<' to '>'. */
static const char *copy_tag(FILE *file, const char *tag, const char *prefix)
{
    const char *begin = tag;

    while (*tag && *tag != '>') {
        const char *end =
            *tag == '"' || *tag == '\'' ? strchr(tag + 1, *tag) : NULL;

        if (end) {
            fputc(*tag, file);
            copy_value(file, tag + 1, (size_t)(end - tag - 1), prefix,
                       tag - begin > 4 && starts_with(tag - 4, " id="));
            tag = end;
        }
        fputc(*tag++, file);
    }
    return tag;
}

/* "<title>" or "<desc>", whose id ends in that letter. */
static void put_name(FILE *file, const char *tag, char letter,
                     const char *prefix, const char *text)
{
    if (prefix)
        fprintf(file, "<%s id=\"%s%c\">", tag, prefix, letter);
    else
        fprintf(file, "<%s>", tag);
    html_text(file, text);
    fprintf(file, "</%s>\n", tag);
}

void svg_copy(FILE *file, const char *drawn, const svg_names *names)
{
    const char *prefix = names->prefix, *c = drawn;
    bool named = false;

    if (prefix) {
        c = skip_past(drawn, "<svg");
        fprintf(file,
                "<svg class=\"picture\" role=\"img\" "
                "aria-labelledby=\"%st %sd\"",
                prefix, prefix);
    }
    while (*c) {
        if (starts_with(c, "<title>") && !named) {
            put_name(file, "title", 't', prefix, names->title);
            put_name(file, "desc", 'd', prefix, names->summary);
            named = true;
            c = skip_past(c, "</desc>");
        } else if (starts_with(c, "<title>")) {
            c = skip_past(c, "</title>"); /* of a plot, of no mark */
        } else if (starts_with(c, pointed)) {
            c = copy_tip(file, c);
        } else if (prefix && *c == '<') {
            c = copy_tag(file, c, prefix);
        } else {
            fputc(*c++, file);
        }
    }
}
