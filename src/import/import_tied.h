/* Parts of ports that get a grid of their own. Not for users. */
#ifndef RITZ_IMPORT_IMPORT_TIED_H
#define RITZ_IMPORT_IMPORT_TIED_H

#include "import/import.h"
#include "model/ties.h"

/* A port while it is tied. */
typedef struct ritz_tied {
    const char *text;
    bool rigid;
    const ritz_import_request *request;
    ritz_deck *deck;
    ritz_tying *tying;
    ritz_port port;
    bool *held; /* dofs of all names that ports hold */
    ritz_ties over;
    int64_t id;           /* of the new grid */
    ritz_average average; /* of its dofs */
} ritz_tied;

/** What follows in the equations is of this port. */
ritz_status ritz_tied_cite(const ritz_tied *it);

/** Say that @p open motions are left open. */
ritz_status ritz_tied_refuse(int64_t open);

/**
 * Make six of the port's dofs depend on its grid and the others.
 *
 * @param[in] turned  G' of what was solved before the grid was added
 */
ritz_status ritz_tied_average(const ritz_tied *it, const ritz_sparse *turned);

#endif
