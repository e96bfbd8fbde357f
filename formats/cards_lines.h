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

/* A fixed line with its tabs expanded, or a free line as it is. */
typedef struct ritz_view {
    bool free;
    bool large;     /* '*' ends the name, or begins a continuation */
    bool continues; /* it belongs to a card above */
    int64_t length;
    const char *text; /* buffer, or the line itself */
    char buffer[RITZ_CARD_COLUMNS + 1];
} ritz_view;

void ritz_view_look(const ritz_line *line, ritz_view *out);

/** First field of a line, without blanks around it. */
void ritz_view_name(const ritz_view *line, const char **text, int64_t *length);

/** Item @p k of a free line, parted by commas; false if there is none. */
bool ritz_view_item(const ritz_view *line, int64_t k, const char **text,
                    int64_t *length);

/** True if a free item is a marker, +C1 or *, rather than a number. */
bool ritz_view_is_marker(const char *text, int64_t length);

/**
 * Items of a free line that are data: up to the ninth, or to a marker that
 * ends the line before.
 *
 * @param[out] mark  the item of the marker, 0 if there is none
 */
int64_t ritz_view_items(const ritz_view *line, int64_t *mark);

#endif
