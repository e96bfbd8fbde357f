/* Cards with fields of eight columns, for writers of bulk data. */
#ifndef RITZ_FORMATS_SMALL_FIELD_H
#define RITZ_FORMATS_SMALL_FIELD_H

#include <stdint.h>
#include <stdio.h>

/* A card that is being written. After eight fields the next one begins a
 * continuation line. */
typedef struct ritz_small_card {
    FILE *file;
    int fields; /* in the present line */
} ritz_small_card;

/** Begin a card with its name. */
ritz_small_card ritz_small_begin(FILE *file, const char *name);

/** Put a field of at most eight letters, or a number of at most eight figures.
 */
void ritz_small_text(ritz_small_card *card, const char *text);
void ritz_small_id(ritz_small_card *card, int64_t id);

/** Leave the rest of the line blank. */
void ritz_small_skip(ritz_small_card *card);

/** Put "FIRST THRU LAST", or FIRST alone if @p count is 1. */
void ritz_small_range(ritz_small_card *card, int64_t first, int64_t count);

void ritz_small_end(const ritz_small_card *card);

#endif
