#include "chart/markup.h"

#include "base/text.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* --- text ----------------------------------------------------------------- */

int html_letter(FILE *file, const char *text)
{
    int length = ritz_letter_length(text);

    if (length == 0) {
        fputc((unsigned char)*text < 128 ? ' ' : '?', file);
        return 1;
    }
    fprintf(file, "%.*s", length, text);
    return length;
}

int html_symbol(FILE *file, const char *text)
{
    static const char special[] = "&<>\"'";
    static const char *const entity[] = {"&amp;", "&lt;", "&gt;", "&quot;",
                                         "&#39;"};
    const char *found = *text ? strchr(special, *text) : NULL;

    if (!found)
        return html_letter(file, text);
    fputs(entity[found - special], file);
    return 1;
}

void html_text(FILE *file, const char *text)
{
    while (*text)
        text += html_symbol(file, text);
}

void html_line(FILE *file, const char *text)
{
    while (*text)
        text += html_letter(file, text);
}

/* One argument, as the conversion that ends with this letter asks. */
static void put_argument(FILE *file, char letter, int precision, va_list *args)
{
    if (letter == 's')
        html_text(file, va_arg(*args, const char *));
    else if (letter == 'd')
        fprintf(file, "%ld", va_arg(*args, long));
    else
        fprintf(file, "%.*g", precision, va_arg(*args, double));
}

void html_print(FILE *file, const char *format, ...)
{
    va_list args;

    va_start(args, format);
    for (const char *c = format; *c; c++) {
        int precision = 6;

        if (*c != '%' || *++c == '%') {
            fputc(*c, file);
            continue;
        }
        if (*c == '.') {
            precision = c[1] - '0';
            c += 2;
        }
        c += strspn(c, "l");
        put_argument(file, *c, precision, &args);
    }
    va_end(args);
}

/* --- pictures ------------------------------------------------------------- */

const svg_colour svg_colours[] = {
    {"c1", 0x0072b2},    {"c2", 0xc44e00},   {"c3", 0x007a5a},
    {"c4", 0xa23b82},    {"c5", 0x8a6d00},   {"c6", 0x3f8fbf},
    {"c7", 0x5b5b5b},    {"c8", 0xb2182b},   {"ink", 0x1b1f24},
    {"muted", 0x5a6270}, {"grid", 0xd9dee5}, {"paper", 0xffffff},
    {"alarm", 0xb00020}, {"pale", 0x9fb0c3}, {NULL, 0},
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

    if (starts_with(text, "rgb("))
        for (const char *c = text + 3; *c == '(' || *c == ','; c = end)
            rgb = rgb << 8 | (strtoul(c + 1, &end, 10) & 255);
    else if (text[0] == '#' && strspn(text + 1, "0123456789abcdefABCDEF") == 6)
        rgb = strtoul(text + 1, NULL, 16);
    else if (strcmp(text, "black") != 0)
        return NULL;
    for (const svg_colour *k = svg_colours; k->name; k++)
        if (k->rgb == rgb)
            return k->name;
    return rgb == 0 ? "ink" : NULL;
}

/* A value of an attribute; ids and references to them get the prefix. */
static void copy_value(FILE *file, const char *value, size_t length,
                       const char *prefix, bool is_id)
{
    char text[40] = "";
    const bool refers = starts_with(value, "#gp");
    const char *colour = NULL;

    if (length < sizeof text) {
        memcpy(text, value, length);
        colour = name_colour(text);
    }
    if (colour)
        fprintf(file, "var(--%s)", colour);
    else
        fprintf(file, "%s%s%.*s", refers ? "#" : "",
                refers || is_id ? prefix : "", (int)length - refers,
                value + refers);
}

/* Copy a tag to its end; with a prefix, its values become those of the page. */
static const char *copy_tag(FILE *file, const char *tag, const char *prefix)
{
    const char *begin = tag;

    while (*tag && *tag != '>') {
        const char *end = prefix && (*tag == '"' || *tag == '\'')
                              ? strchr(tag + 1, *tag)
                              : NULL;

        if (end) {
            fputc(*tag, file);
            copy_value(file, tag + 1, (size_t)(end - tag - 1), prefix,
                       tag - begin > 4 && starts_with(tag - 4, " id="));
            tag = end;
        }
        fputc(*tag++, file);
    }
    if (*tag)
        fputc(*tag++, file);
    return tag;
}

/* Copy a letter between tags. gnuplot does not escape '>', which is forbidden
   after "]]", nor '&' before "#x", which would make a character reference. */
static const char *copy_letter(FILE *file, const char *c)
{
    if (*c == '>')
        fputs("&gt;", file);
    else if (starts_with(c, "&#x"))
        fputs("&amp;", file);
    else
        fputc(*c, file);
    return c + 1;
}

/* On a page both have ids, by which the picture is called. */
static void put_names(FILE *file, const char *title, const char *summary,
                      const char *prefix)
{
    if (prefix)
        html_print(file,
                   "<title id=\"%st\">%s</title>\n<desc id=\"%sd\">%s</desc>\n",
                   prefix, title, prefix, summary);
    else
        html_print(file, "<title>%s</title>\n<desc>%s</desc>\n", title,
                   summary);
}

void svg_copy(FILE *file, const char *drawn, const char *title,
              const char *summary, const char *prefix)
{
    const char *c = drawn;
    bool named = false;

    if (prefix) {
        c = skip_past(drawn, "<svg");
        fprintf(file,
                "<svg class=\"picture\" role=\"img\" "
                "aria-labelledby=\"%st %sd\"",
                prefix, prefix);
        c = copy_tag(file, c, NULL);
    }
    while (*c) {
        if (starts_with(c, "<title>") && !named) {
            put_names(file, title, summary, prefix);
            named = true;
            c = skip_past(c, "</desc>");
        } else if (starts_with(c, "<title>")) {
            c = skip_past(c, "</title>"); /* of a plot, of no mark */
        } else if (starts_with(c, pointed)) {
            c = copy_tip(file, c);
        } else if (*c == '<') {
            c = copy_tag(file, c, prefix);
        } else {
            c = copy_letter(file, c);
        }
    }
}
