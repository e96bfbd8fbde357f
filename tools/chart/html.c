#include "chart/html.h"

#include "base/letter.h"

#include <stdarg.h>
#include <string.h>

static const char *entity(char c)
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

void html_text(FILE *file, const char *text)
{
    while (*text) {
        const char *escaped = entity(*text);

        if (escaped)
            fputs(escaped, file);
        text += escaped ? 1 : html_letter(file, text);
    }
}

void html_print(FILE *file, const char *format, ...)
{
    char text[2001];
    va_list args;

    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    html_text(file, text);
}

void html_line(FILE *file, const char *text)
{
    while (*text)
        text += html_letter(file, text);
}
