/* Text that is gone through line by line. */
#ifndef RITZ_FORMATS_LINES_H
#define RITZ_FORMATS_LINES_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* Begin with `at` and `end`; a copy goes on from where it was made. */
typedef struct ritz_lines {
    const char *at, *end;
    const char *line, *line_end; /* taken last, without its '\n' */
    int64_t number;              /* of that line, from 1 */
} ritz_lines;

/** Take the next line. @return false at the end of the text */
static inline bool ritz_lines_next(ritz_lines *text)
{
    const char *stop = NULL;

    if (text->at >= text->end)
        return false;
    stop = memchr(text->at, '\n', (size_t)(text->end - text->at));
    text->line = text->at;
    text->line_end = stop ? stop : text->end;
    text->at = stop ? stop + 1 : text->end;
    text->number++;
    return true;
}

/** Letters of a text that a message quotes: all, but at most 79. */
static inline int ritz_lines_quoted(const char *text, const char *end)
{
    return end - text < 80 ? (int)(end - text) : 79;
}

#endif
