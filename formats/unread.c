/*
 * Files of other programs that are recognised and not read. Each row says what
 * such a file is and how to turn it into one that is read; docs/import.md has
 * the commands.
 */
#include "formats/decimal.h"

#include <ritz/import.h>

#include <string.h>
#include <strings.h>

/* Number of lines that are examined; large matrices have more. */
enum { MOST_LINES = 1000 };

/* Take the next line that is not blank, and strip it of blanks. */
static bool next_line(ritz_lines *text)
{
    while (ritz_lines_next(text)) {
        text->line = ritz_decimal_skip(text->line, text->line_end);
        while (text->line_end > text->line &&
               (text->line_end[-1] == '\r' || text->line_end[-1] == ' '))
            text->line_end--;
        if (text->line < text->line_end)
            return true;
    }
    return false;
}

static ritz_lines lines_of(const char *bytes, int64_t size)
{
    return (ritz_lines){.at = bytes, .end = bytes + size};
}

/* Whether a text begins with one of these words, in any case. */
static bool begins(const char *at, const char *end, const char *const *word)
{
    for (; *word; word++) {
        size_t length = strlen(*word);

        if ((size_t)(end - at) >= length && strncasecmp(at, *word, length) == 0)
            return true;
    }
    return false;
}

/* "%MatrixMarket", or the same without a '%'. */
static bool has_short_banner(const char *bytes, int64_t size)
{
    static const char *const word[] = {"%MatrixMarket", "MatrixMarket", NULL};

    return begins(bytes, bytes + size, word);
}

/* Lines "node.direction". */
static bool is_calculix_dofs(const char *bytes, int64_t size)
{
    ritz_lines text = lines_of(bytes, size);
    int64_t node = 0, count = 0;

    for (; count < MOST_LINES && next_line(&text); count++) {
        const char *at = text.line;

        if (!ritz_decimal_scan_whole(&at, text.line_end, &node) || node < 1 ||
            text.line_end - at != 2 || at[0] != '.' || at[1] < '1' ||
            at[1] > '6')
            return false;
    }
    return count > 0;
}

/* The header is a record of 100 whole numbers. The first of them is the kind of
   file: 2 to 16, or 45. */
static bool is_ansys_binary(const char *bytes, int64_t size)
{
    const unsigned char *b = (const unsigned char *)bytes;

    if (size < 12)
        return false;
    if (b[0] == 100 && b[1] + b[2] + b[3] == 0)
        return b[9] + b[10] + b[11] == 0 &&
               ((b[8] >= 2 && b[8] <= 16) || b[8] == 45);
    return b[3] == 100 && b[0] + b[1] + b[2] == 0 && b[8] + b[9] + b[10] == 0 &&
           ((b[11] >= 2 && b[11] <= 16) || b[11] == 45);
}

static bool is_ansys_list(const char *bytes, int64_t size)
{
    static const char *const word[] = {"Node Number", "Element Number",
                                       "Knotennummer", "Elementnummer", NULL};
    ritz_lines text = lines_of(bytes, size);

    return next_line(&text) && begins(text.line, text.line_end, word);
}

const ritz_unread ritz_unread_formats[] = {
    {"a Matrix Market file whose first line does not begin with two '%'",
     "write '%%MatrixMarket' there", has_short_banner},
    {"a list of dofs of CalculiX", "it is for --dofs", is_calculix_dofs},
    {"a binary file of ANSYS", "let ANSYS export matrices as Matrix Market",
     is_ansys_binary},
    {"a list of ANSYS", "write the model by CDWRITE", is_ansys_list},
    {0},
};

const ritz_unread *ritz_unread_find(const char *bytes, int64_t size)
{
    for (const ritz_unread *row = ritz_unread_formats; row->name; row++)
        if (row->recognise(bytes, size))
            return row;
    return NULL;
}

ritz_status ritz_unread_refuse(const char *bytes, int64_t size)
{
    const ritz_unread *row = ritz_unread_find(bytes, size);

    RITZ_REFUSE_IF(row, RITZ_ERR_FORMAT,
                   "looks like %s, which is not read: %s, as docs/import.md "
                   "shows",
                   row->name, row->advice);
    return RITZ_OK;
}
