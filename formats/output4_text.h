/* OUTPUT4 as text: what its headers and its columns have in common. */
#ifndef RITZ_FORMATS_OUTPUT4_TEXT_H
#define RITZ_FORMATS_OUTPUT4_TEXT_H

#include "formats/lines.h"
#include "formats/output4.h"

typedef struct ritz_output4_text {
    ritz_lines lines;
    int64_t per_line, width, digits; /* of nEw.d */
    char format[24];                 /* the same as written */
} ritz_output4_text;

/** Take a line, less its '\r'; false at the end of the file. */
bool ritz_output4_take_line(ritz_output4_text *t);

/** Take lines until one is not blank. */
bool ritz_output4_take_filled_line(ritz_output4_text *t);

/** @p count integers of the line: words, or else fields of 8 or of 16. */
bool ritz_output4_take_integers(const ritz_output4_text *t, int64_t count,
                                int64_t *out);

/** The line as a header of a matrix, and the nEw.d that it states. */
bool ritz_output4_take_header(ritz_output4_text *t, ritz_output4_header *out);

#endif
