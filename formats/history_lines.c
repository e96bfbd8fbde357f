#include "formats/history_lines.h"

#include "base/alloc.h"
#include "base/text.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char blanks[] = " \t\r\n";

static ritz_status keep_comment(history_lines *lines)
{
    if (!lines->wanted || lines->kept ||
        strncmp(lines->text, lines->wanted, strlen(lines->wanted)) != 0)
        return RITZ_OK;
    RITZ_CHECK_COPY(lines->kept, lines->text, (int64_t)strlen(lines->text) + 1);
    return RITZ_OK;
}

ritz_status history_lines_next(history_lines *lines, bool *more)
{
    *more = true;
    while (true) {
        ssize_t length = 0;

        errno = 0;
        length = getline(&lines->text, &lines->room, lines->file);
        if (length < 0) {
            RITZ_REFUSE_IF(errno == ENOMEM, RITZ_ERR_MEMORY,
                           "no memory for a line");
            RITZ_REFUSE_IF(ferror(lines->file), RITZ_ERR_FILE,
                           "cannot be read: %s", strerror(errno));
            *more = false;
            return RITZ_OK;
        }
        lines->number++;
        RITZ_REFUSE_IF(strlen(lines->text) != (size_t)length, RITZ_ERR_FORMAT,
                       "line %" PRId64 " holds a NUL: it is no text",
                       lines->number);
        length = (ssize_t)strspn(lines->text, blanks);
        if (lines->text[length] && lines->text[length] != '#')
            return RITZ_OK;
        RITZ_CHECK(keep_comment(lines));
    }
}

/* Replace the quotes around a field by blanks. @return the end of the field */
static char *close_quotes(char *field)
{
    char *end = strchr(field + 1, '"');

    *field = ' ';
    if (end)
        *end = ' ';
    return end ? end + 1 : field + strlen(field);
}

char history_lines_mark(const char *line)
{
    return strchr(line, ',') ? ',' : ' ';
}

char *history_lines_field(char **rest, char mark)
{
    const bool commas = mark == ',';
    char *field = *rest;
    char *end = NULL;

    if (!field)
        return NULL;
    field += strspn(field, blanks);
    end = *field == '"' ? close_quotes(field) : field;
    end += strcspn(end, commas ? "," : blanks);
    *rest = *end ? end + 1 : NULL;
    if (!commas && *rest && !(*rest)[strspn(*rest, blanks)])
        *rest = NULL; /* nothing but blanks follows */
    *end = '\0';
    field += strspn(field, blanks);
    end = field + strlen(field);
    while (end > field && strchr(blanks, end[-1]))
        *--end = '\0';
    return field;
}

ritz_status history_lines_real(const history_lines *lines, const char *field,
                               double *out)
{
    char text[RITZ_SHORT_SIZE];

    RITZ_REFUSE_IF(!ritz_text_real(field, out), RITZ_ERR_FORMAT,
                   "line %" PRId64 ": '%s' is no finite number", lines->number,
                   ritz_text_short(field, text));
    return RITZ_OK;
}

void history_lines_free(history_lines *lines)
{
    if (lines->file)
        fclose(lines->file);
    RITZ_FREE(lines->text, lines->kept);
    *lines = (history_lines){0};
}
