/* A line of bulk data and its fields. */
#ifndef RITZ_FORMATS_CARDS_LINES_H
#define RITZ_FORMATS_CARDS_LINES_H

#include "formats/cards.h"
#include "formats/lines.h"

#include <ctype.h>

enum {
    RITZ_CARD_NAME = 8,  /* columns of the first field, letters of a marker */
    RITZ_CARD_DATA = 72, /* columns up to the tenth field */
    RITZ_CARD_COLUMNS = 80,
};

static inline bool ritz_card_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

static inline char ritz_card_upper(char c)
{
    return (char)toupper((unsigned char)c);
}

/** Leave out the blanks at both ends. */
void ritz_card_trim(const char **text, int64_t *length);

/** Leave out what stands behind a '$'. */
void ritz_card_uncomment(const char *line, int64_t *length);

/** True if a line begins with @p word, in capitals; *rest: the text behind. */
bool ritz_card_begins(const char *line, int64_t length, const char *word,
                      const char **rest);

/* Part of a line. */
typedef struct ritz_piece {
    const char *text;
    int64_t length;
} ritz_piece;

/* A line of whichever layout, taken apart; parts may point into `buffer`. */
typedef struct ritz_view {
    bool free;
    bool large;      /* '*' ends the name, or begins a continuation */
    bool continues;  /* it belongs to a card above */
    bool overfull;   /* there are more fields than `width` */
    ritz_piece name; /* without blanks around it */
    int64_t width;   /* fields of data: 8, or 4 large ones */
    ritz_piece field[8];
    ritz_piece marker; /* of the line that continues it */
    char buffer[RITZ_CARD_COLUMNS + 1];
} ritz_view;

void ritz_view_look(const ritz_line *line, ritz_view *out);

#endif
