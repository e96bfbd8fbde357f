/*
 * The cards of a NASTRAN deck, whatever is written on them: one tokenizer for
 * all that reads bulk data.
 *
 * A deck is scanned once into lines that know their card; a card is taken apart
 * only when it is asked for, so the elements of a large model cost a glance.
 */
#ifndef RITZ_FORMATS_CARDS_H
#define RITZ_FORMATS_CARDS_H

#include "base/alloc.h"

#include "formats/decimal.h"
#include "formats/deck_files.h"

#include <ritz/base.h>

#include <ctype.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
    RITZ_CARD_NAME_SIZE = 12,  /* a name has up to 8 letters */
    RITZ_CARD_FIELD_SIZE = 36, /* a free field may be wider than 16 */
};

/* A line of bulk data that is neither blank nor a comment. */
typedef struct ritz_line {
    const char *text; /* in a ritz_deck_file, without comment and line end */
    int32_t length;
    int32_t file;   /* index of the ritz_deck_file */
    int64_t number; /* from 1 */
    int64_t next;   /* the line that continues it, -1 if none does */
} ritz_line;

/* Where a card is and what it is called, "GRID" for GRID*. */
typedef struct ritz_entry {
    char name[RITZ_CARD_NAME_SIZE]; /* capitals */
    int64_t line;
} ritz_entry;

typedef struct ritz_cards {
    ritz_deck_files files;
    int64_t num_lines;
    int64_t num_entries;
    int64_t lines_room, entries_room;
    ritz_line *line;
    ritz_entry *entry;   /* in the order of the file */
    int64_t num_skipped; /* INCLUDE lines, where these are not followed */
    int64_t num_selected[2];
    int64_t selected_room[2];
    int64_t *selected[2]; /* sets of SPC and of MPC in the case control */
} ritz_cards;

enum { RITZ_SELECT_SPC, RITZ_SELECT_MPC };

typedef struct ritz_field {
    char text[RITZ_CARD_FIELD_SIZE]; /* without blanks around it */
    int64_t line;                    /* index in the deck */
} ritz_field;

/* A card taken apart; {0} at first, and reused from card to card. */
typedef struct ritz_card {
    const ritz_cards *cards;
    const ritz_entry *entry;
    int64_t count; /* up to the last field that is not blank */
    int64_t room;
    ritz_field *field; /* fields 2 to 9 of the first line, then of the next */
} ritz_card;

/**
 * Scan a deck: leave out executive and case control, comments and what follows
 * ENDDATA; follow INCLUDE; give every continuation to its card.
 *
 * A continuation belongs to the line above it if both markers are blank or one
 * of them is, or if they are equal; else to the line anywhere in the deck whose
 * tenth field has its marker.
 *
 * @param[in] path    for messages; NULL: they begin with the line
 * @param[in] text    borrowed as long as the deck lives
 * @param[in] folder  to which INCLUDE is relative; NULL: it is counted only
 * @return RITZ_ERR_FORMAT if a continuation has no card, or as
 *         ritz_deck_include(); RITZ_ERR_FILE as that
 * @cost   O(size), and O(n log n) in continuations that are out of order
 */
ritz_status ritz_cards_parse(const char *path, const char *text, int64_t size,
                             const char *folder, ritz_cards *out);

/** Split card @p k into fields. @return RITZ_ERR_FORMAT, naming the line */
ritz_status ritz_card_take(const ritz_cards *cards, int64_t k, ritz_card *card);

/** Field @p k of a card, from 0; "" after its end. */
const char *ritz_card_text(const ritz_card *card, int64_t k);

/** Field @p k as a number; @p blank if the field is blank. */
ritz_status ritz_card_whole(const ritz_card *card, int64_t k, int64_t blank,
                            int64_t *out);
ritz_status ritz_card_real(const ritz_card *card, int64_t k, double blank,
                           double *out);

/** Field @p k as a positive whole number. */
ritz_status ritz_card_id(const ritz_card *card, int64_t k, int64_t *out);

/** Numbers as NASTRAN writes them: 1.5D+3, 1.5+3, .5, -1.-3. */
bool ritz_card_number(const char *text, double *out);

/** Significant digits that a number is written with; 0 for a zero. */
int64_t ritz_card_digits(const char *text);

/** Fail as ritz_deck_refuse(), about a line of the deck. */
[[gnu::format(printf, 3, 4)]] ritz_status
ritz_cards_refuse(const ritz_cards *cards, int64_t line, const char *format,
                  ...);

/** Fail about field @p k of a card. */
ritz_status ritz_card_refuse(const ritz_card *card, int64_t k,
                             const char *wanted);

void ritz_card_free(ritz_card *card);
void ritz_cards_free(ritz_cards *cards);

/** For bsearch in tables whose rows begin with a name. */
int ritz_cards_compare_name(const void *name, const void *row);

/** True if a set of SPC or MPC cards acts; the selected sets are sorted. */
bool ritz_cards_select(const ritz_cards *cards, int64_t which, int64_t set);

/** Directions "123" as digits; @return false if they are not distinct 0-6 */
bool ritz_card_mask(int64_t digits, uint8_t *out);

/** Field @p k as directions: bit c, or bit 0 alone of a blank or 0. */
ritz_status ritz_card_directions(const ritz_card *card, int64_t k,
                                 uint8_t *out);

/* ---- lines, before they are cards ---------------------------------------- */

enum {
    RITZ_CARD_NAME = 8,  /* columns of the first field, letters of a marker */
    RITZ_CARD_DATA = 72, /* columns up to the tenth field */
    RITZ_CARD_COLUMNS = 80,
};

static inline bool ritz_card_is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r' && c != '\n');
}

static inline char ritz_card_upper(char c)
{
    return (char)toupper((unsigned char)c);
}

/* Part of a line. */
typedef struct ritz_piece {
    const char *text;
    int64_t length;
} ritz_piece;

/** The same without the blanks at both ends. */
ritz_piece ritz_piece_trim(ritz_piece piece);

/** Leave out what stands behind a '$'. */
void ritz_card_uncomment(const char *line, int64_t *length);

/** True if a line begins with @p word, in capitals; *rest: the text behind. */
bool ritz_card_begins(const char *line, int64_t length, const char *word,
                      const char **rest);

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
