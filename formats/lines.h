/* Text that is gone through line by line. */
#ifndef RITZ_FORMATS_LINES_H
#define RITZ_FORMATS_LINES_H

#include <stdbool.h>
#include <stdint.h>

/* Begin with `at` and `end`; a copy goes on from where it was made. */
typedef struct ritz_lines {
    const char *at, *end;
    const char *line, *line_end; /* taken last, without its '\n' */
    int64_t number;              /* of that line, from 1 */
} ritz_lines;

/** Take the next line. @return false at the end of the text */
bool ritz_lines_next(ritz_lines *text);

#endif
