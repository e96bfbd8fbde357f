/* Reads a text line by line, so that it need not fit into memory. */
#ifndef RITZ_FORMATS_HISTORY_LINES_H
#define RITZ_FORMATS_HISTORY_LINES_H

#include <ritz/base.h>

#include <stdio.h>

typedef struct history_lines {
    FILE *file; /* owned */
    char *text; /* the last line */
    size_t room;
    int64_t number; /* of that line, from 1 */
    const char
        *wanted; /* borrowed: a comment that begins so is kept; or NULL */
    char *kept;  /* it, the first; NULL: not seen */
} history_lines;

/**
 * Read the next line that is neither blank nor a comment of '#', and keep the
 * comment that is wanted if it comes before.
 *
 * @param[out] more  false at the end of the file
 * @return RITZ_ERR_FORMAT if the line contains a NUL; RITZ_ERR_FILE;
 *         RITZ_ERR_MEMORY
 */
ritz_status history_lines_next(history_lines *lines, bool *more);

/** The separator of a line's fields: ',' if the line contains one, else ' '. */
char history_lines_mark(const char *line);

/** Take the next field of *rest, without the blanks and quotes around it.
 * @return NULL if there is none */
char *history_lines_field(char **rest, char mark);

/** Read a finite number. @return RITZ_ERR_FORMAT, with the line's number in the
 * sentence */
ritz_status history_lines_real(const history_lines *lines, const char *field,
                               double *out);

void history_lines_free(history_lines *lines);

#endif
