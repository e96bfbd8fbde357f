/* Decks of any format: recognised by content, then read by their format. */
#include "base/text.h"

#include "base/alloc.h"

#include <ritz/import.h>

#include <stdlib.h>

const ritz_deck_format *ritz_deck_recognise(const char *bytes, int64_t size)
{
    for (int k = 0; ritz_decks[k]; k++)
        if (ritz_decks[k]->recognise(bytes, size))
            return ritz_decks[k];
    return NULL;
}

ritz_status ritz_deck_parse(const char *path, const char *bytes, int64_t size,
                            const char *folder, ritz_deck *out)
{
    const ritz_deck_format *format = ritz_deck_recognise(bytes, size);
    RITZ_OWN(ritz_deck) deck = {0};

    RITZ_REFUSE_IF(!format, RITZ_ERR_FORMAT,
                   "'%s' is not a text file, as all decks are that Ritz knows",
                   path ? path : "the deck");
    RITZ_CHECK(format->parse(path, bytes, size, folder, &deck));
    deck.format = format;
    RITZ_MOVE(*out, deck);
    return RITZ_OK;
}

ritz_status ritz_deck_read(const char *path, ritz_deck *out)
{
    RITZ_OWN_ARRAY char *bytes = NULL;
    RITZ_OWN_ARRAY char *folder = NULL;
    int64_t size = 0;

    RITZ_CHECK(ritz_path_folder(path, &folder));
    RITZ_CHECK(ritz_bytes_read(path, &size, &bytes));
    return ritz_deck_parse(path, bytes, size, folder, out);
}

void ritz_deck_free(ritz_deck *deck)
{
    ritz_grids_free(&deck->grids);
    RITZ_FREE(deck->point, deck->dof, deck->fixed);
    for (int k = 0; k < RITZ_NUM_SETS; k++)
        free(deck->set[k]);
    free(deck->constraint);
    ritz_equations_free(&deck->equations);
    ritz_elements_free(&deck->elements);
    free(deck->imposed);
    *deck = (ritz_deck){0};
}
