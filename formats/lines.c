#include "formats/lines.h"

#include <string.h>

bool ritz_lines_next(ritz_lines *text)
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
