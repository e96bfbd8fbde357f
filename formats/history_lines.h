/* Lines of a text that is read while it is worked on. */
#ifndef RITZ_FORMATS_HISTORY_LINES_H
#define RITZ_FORMATS_HISTORY_LINES_H

#include <ritz/base.h>

#include <stdio.h>

typedef struct history_lines {
    FILE *file; /* owned */
    char *text; /* the last line, without its end */
    size_t room;
    int64_t number; /* of that line, from 1 */
} history_lines;

/**
 * Read the next line that is neither blank nor a comment of '#'.
 *
 * @param[out] more  false at the end of the file
 * @return RITZ_ERR_FORMAT if it holds a NUL; RITZ_ERR_FILE; RITZ_ERR_MEMORY
 */
ritz_status history_lines_next(history_lines *lines, bool *more);

/** What divides the fields of a line: ',' if it has one, else ' '. */
char history_lines_mark(const char *line);

/** Cut off the next field, without blanks and quotes around it. NULL: there is
 * none. */
char *history_lines_field(char **rest, char mark);

/** Read a finite number. @return RITZ_ERR_FORMAT with the line */
ritz_status history_lines_real(const history_lines *lines, const char *field,
                               double *out);

void history_lines_free(history_lines *lines);

#endif
