/* From foreign files to a component: what ritz-import does. */
#ifndef RITZ_IMPORT_H
#define RITZ_IMPORT_H

#include <ritz/component.h>

/* Texts as the options of ritz-import take them; NULL or count 0: not given. */
typedef struct ritz_import_request {
    const char *stiffness, *mass, *damping, *structural_damping;
    int64_t num_loads;
    const char *const *load; /* "F@LOAD" */
    const char *bulk;
    const char *dofs; /* file of `GRID COMP` rows */
    int64_t num_ports;
    const char *const *port; /* "NAME=GRIDS[:COMPS]" */
    int64_t num_inputs;
    const char *const *input; /* "NAME=GRID:COMP[*SCALE]" */
    int64_t num_outputs;
    const char *const *output; /* "NAME=GRID:COMP[/vel|/acc][@LIMIT]" */
    const char *units;
    bool symmetrise;
} ritz_import_request;

/* What was done that a user should know. */
typedef struct ritz_import_report {
    int64_t num_removed; /* rows empty in K and M */
    ritz_dof *removed;
    int64_t num_fixed; /* rows taken out as the deck fixes them: u = 0 */
    ritz_dof *fixed;
    int64_t num_massless;     /* rows empty in M only: kept */
    int64_t num_floating;     /* rows empty in K only: kept */
    char map[RITZ_NAME_SIZE]; /* where the dofs come from: "file", "--dofs",
                                 "grids ascending", "A-set",
                                 "grids less SPCs" */
} ritz_import_report;

/**
 * Read, name the rows, remove rows empty in both K and M, place grids, set up
 * ports, inputs and outputs, and settle the component.
 *
 * Rows are named by, in this order: --dofs; the map in the file (DMIG); the
 * deck, if its grids (six rows each, ascending, scalar points one) or its
 * a-set, or grids less its SPCs, fit the size; without a deck a size that is a
 * multiple of six: grids 1..n/6. A size that does not fit is refused. Matrices
 * that name their rows may hold different ones: the component has all of them.
 *
 * Whatever names them, rows that the deck fixes (ritz_bulk.fixed) are taken
 * out. Constraint elements are accepted only with matrices smaller than all of
 * the deck's dofs, by its a-set, --dofs or the map in the file: there they
 * have been eliminated already.
 *
 * Inputs and outputs act along basic axes. Positions are known from the deck
 * alone, but a single grid without a deck lies at the origin.
 *
 * @return RITZ_ERR_ARGUMENT, RITZ_ERR_FORMAT, RITZ_ERR_FILE; a deck whose MPC
 *         or rigid elements eliminate dofs that the matrices still have is
 *         refused by name
 */
ritz_status ritz_import(const ritz_import_request *request, ritz_component *out,
                        ritz_import_report *report);

void ritz_import_report_free(ritz_import_report *report);

#endif
