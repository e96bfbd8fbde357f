#include "chart/html.h"

#include "base/text.h"

#include <stdarg.h>
#include <stddef.h>
#include <string.h>

static const char *find_entity(char c)
{
    static const struct {
        char letter;
        const char *entity;
    } known[] = {
        {'&', "&amp;"},  {'<', "&lt;"},   {'>', "&gt;"},
        {'"', "&quot;"}, {'\'', "&#39;"},
    };

    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (known[k].letter == c)
            return known[k].entity;
    return NULL;
}

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
    const char *escaped = find_entity(*text);

    if (!escaped)
        return html_letter(file, text);
    fputs(escaped, file);
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
