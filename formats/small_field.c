/*
 * Writes cards in the small-field format [MSC2022]: a name and eight fields,
 * all of eight columns; continuation lines begin with a blank field.
 */
#include "formats/small_field.h"

#include <inttypes.h>

enum { FIELDS = 8 };

ritz_small_card ritz_small_begin(FILE *file, const char *name)
{
    fprintf(file, "%-8s", name);
    return (ritz_small_card){.file = file};
}

void ritz_small_text(ritz_small_card *card, const char *text)
{
    if (card->fields == FIELDS)
        fprintf(card->file, "\n%8s", "");
    card->fields = card->fields % FIELDS + 1;
    fprintf(card->file, "%8s", text);
}

void ritz_small_id(ritz_small_card *card, int64_t id)
{
    char text[32];

    snprintf(text, sizeof text, "%" PRId64, id);
    ritz_small_text(card, text);
}

void ritz_small_skip(ritz_small_card *card)
{
    while (card->fields < FIELDS)
        ritz_small_text(card, "");
}

void ritz_small_range(ritz_small_card *card, int64_t first, int64_t count)
{
    ritz_small_id(card, first);
    if (count < 2)
        return;
    ritz_small_text(card, "THRU");
    ritz_small_id(card, first + count - 1);
}

void ritz_small_end(const ritz_small_card *card)
{
    fputc('\n', card->file);
}
