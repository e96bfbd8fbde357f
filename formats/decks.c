/* The table of decks. NASTRAN stays last: it takes any text. */
#include <ritz/import.h>

const ritz_deck_format *const ritz_decks[] = {
    &ritz_deck_cdb,
    &ritz_deck_inp,
    &ritz_deck_nastran,
    NULL,
};
