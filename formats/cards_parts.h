/* What the parts of the card reader hand each other; private to them. */
#ifndef RITZ_FORMATS_CARDS_PARTS_H
#define RITZ_FORMATS_CARDS_PARTS_H

#include "formats/cards.h"
#include "formats/lines.h"

#include <ctype.h>

enum {
    RITZ_CARD_NAME = 8,  /* columns of the first field, letters of a marker */
    RITZ_CARD_DATA = 72, /* columns up to the tenth field */
    RITZ_CARD_COLUMNS = 80,
};

/* ---- letters ------------------------------------------------------------ */

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

/** Whether a line begins with @p word, capitals; *rest: what follows it. */
bool ritz_card_begins(const char *line, int64_t length, const char *word,
                      const char **rest);

/* ---- a line ------------------------------------------------------------- */

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

/** Whether a free item is a marker, +C1 or *, rather than a number. */
bool ritz_view_is_marker(const char *text, int64_t length);

/**
 * Items of a free line that are data: up to the ninth, or to a marker that
 * ends the line before.
 *
 * @param[out] mark  the item of the marker, 0 if there is none
 */
int64_t ritz_view_items(const ritz_view *line, int64_t *mark);

/* ---- the deck ----------------------------------------------------------- */

enum { RITZ_CARDS_DEEPEST = 16 };

/* A file that is being gone through. */
typedef struct ritz_source {
    ritz_lines text;
    int64_t file;
    char *folder; /* to which its INCLUDEs are relative; NULL: not followed */
} ritz_source;

/* The file on top, below it those whose INCLUDE led there. */
typedef struct ritz_scanner {
    ritz_cards *cards;
    bool ended; /* by ENDDATA */
    int depth;
    ritz_source open[RITZ_CARDS_DEEPEST + 1];
} ritz_scanner;

/** Follow an INCLUDE; @p rest is what stands behind the word. */
ritz_status ritz_scanner_include(ritz_scanner *scan, const char *rest);

/**
 * Go to where bulk data begin: behind BEGIN BULK, behind any other BEGIN if
 * CEND came before it, at the start where there is neither; keep the sets that
 * the case control selects.
 */
ritz_status ritz_cards_skip_control(const char *path, ritz_lines *text,
                                    ritz_cards *cards);

/** Append a file; @p text becomes the deck's, unless the call fails. */
ritz_status ritz_cards_add_file(ritz_cards *cards, const char *path,
                                char *text);

/** Keep the lines of a file, and of what it includes, up to ENDDATA. */
ritz_status ritz_cards_scan(const char *path, const char *folder,
                            ritz_lines text, ritz_cards *cards);

/** Find the cards; give every continuation to the line that it continues. */
ritz_status ritz_cards_join(ritz_cards *cards);

#endif
