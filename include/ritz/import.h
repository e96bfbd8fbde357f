/* From foreign files to a component: what ritz-import does. */
#ifndef RITZ_IMPORT_H
#define RITZ_IMPORT_H

#include <ritz/component.h>
#include <ritz/foreign.h>
#include <ritz/state_space.h>

#pragma GCC visibility push(default)

/* Texts as the options of ritz-import take them; NULL or count 0: not given. */
typedef struct ritz_import_request {
    const char *stiffness, *mass, *damping, *structural_damping;
    int64_t num_loads;
    const char *const *load; /* "F@LOAD" */
    const char *bulk;        /* file of a deck, see deck.h */
    const char *dofs;        /* file of `GRID COMP` rows */
    int64_t num_ports;
    const char *const *port; /* "NAME=GRIDS[:COMPS]" */
    int64_t num_rigid_ports, num_averaged_ports;
    const char *const *rigid_port; /* "NAME=GRIDS[:COMPS]": a new grid that */
    const char *const *averaged_port; /* these follow, or that follows them */
    int64_t num_inputs;
    const char *const *input; /* "NAME=GRID:COMP[*SCALE]" */
    int64_t num_outputs;
    const char *const *output; /* "NAME=GRID:COMP[/vel|/acc][@LIMIT]" */
    int64_t num_dampers;
    const char *const *damper; /* "NAME=GRID:COMP[,GRID:COMP]*C[*K]" */
    const char *units;
    bool symmetrise;
    ritz_file_sums *sums; /* gets the files of matrices; NULL: not asked */
} ritz_import_request;

/* A grid that was made for a port. */
typedef struct ritz_import_grid {
    char port[RITZ_NAME_SIZE];
    int64_t id;
    int64_t num_tied; /* dofs that it is tied to */
} ritz_import_grid;

/* What an import did beyond reading, for the user. */
typedef struct ritz_import_report {
    int64_t num_removed; /* rows empty in K and M */
    ritz_dof *removed;
    int64_t num_fixed; /* rows taken out as the deck fixes them: u = 0 */
    ritz_dof *fixed;
    int64_t num_massless;     /* rows empty in M only: kept */
    int64_t num_floating;     /* rows empty in K only: kept */
    char map[RITZ_NAME_SIZE]; /* where the dofs come from: "file", "--dofs",
                                 "grids ascending", "A-set",
                                 "grids less SPCs", "grids less dependents",
                                 "grids less SPCs and dependents" */
    int64_t num_constraints;  /* elements that make dofs depend on others */
    char (*constraint)[RITZ_NAME_SIZE]; /* "RBE2 600" */
    int64_t num_eliminated; /* dofs that depend, of rows in the matrices */
    int64_t num_recovered;  /* that follow from the component's dofs */
    int64_t num_lost;       /* that follow from dofs that it has not */
    char *unknown; /* why constraints are not recovered from; NULL: they are */
    int64_t num_hidden; /* elements that no picture shows: their grids are not
                           understood, or not there */
    int64_t num_grids;
    ritz_import_grid *grid; /* made for ports */
} ritz_import_report;

/**
 * Read, name the rows, remove rows empty in both K and M, place grids, set up
 * ports, inputs and outputs, and settle the component.
 *
 * Rows are named by, in this order: --dofs; the map in the file (DMIG); the
 * deck, if its dofs (of NASTRAN six for each grid, ascending, one for scalar
 * points) or its a-set, or its dofs without supports, fit the size; without a
 * deck a size that is a multiple of six: grids 1..n/6. A size that does not fit
 * is refused. Matrices that name their rows may hold different ones: the
 * component has all of them.
 *
 * Whatever names them, rows that the deck fixes (ritz_deck.fixed) are taken
 * out. Constraint elements (ritz_deck.equations) are applied if the matrices
 * have rows of their dependent dofs, u = G u_n and K_nn = G'KG; otherwise they
 * have been eliminated already. In both cases the dependent dofs go to the
 * component's recovery.
 *
 * A rigid port and an averaged one make a grid of six dofs at the mean position
 * of theirs, along basic axes. The dofs of a rigid port follow it as a rigid
 * body. An averaged port is their average without weights, and to keep it six
 * of them depend on it and the others.
 *
 * Inputs and outputs act along basic axes. Positions are known from the deck
 * alone, but a single grid without a deck lies at the origin.
 *
 * @return RITZ_ERR_ARGUMENT, RITZ_ERR_FORMAT, RITZ_ERR_FILE; a constraint
 *         element that is not understood, or contradicts another, an SPC or the
 *         a-set, is refused by name if the matrices have its dofs
 */
ritz_status ritz_import(const ritz_import_request *request, ritz_component *out,
                        ritz_import_report *report);

/* A state space out of files, as the options have it; NULL: not given. */
typedef struct ritz_import_space_request {
    const char *matrices; /* "A=F,B=F,C=F[,D=F][,E=F]" or "FILE[:NAME]" */
    const char *inputs;   /* "NAME,NAME"; u1, u2, ... */
    const char *outputs;  /* "NAME[@LIMIT],NAME"; y1, y2, ... */
    const char *units;
    ritz_file_sums *sums; /* gets the files of matrices; NULL: not asked */
} ritz_import_space_request;

/**
 * Read A, B and C, and D and E if they are given, as dense matrices.
 *
 * @return RITZ_ERR_ARGUMENT if one is missing, or there are more than
 *         2 RITZ_STATE_DOFS states, inputs or outputs; RITZ_ERR_FORMAT if sizes
 *         disagree, one is complex or not finite, or E is singular
 */
ritz_status ritz_import_state_space(const ritz_import_space_request *request,
                                    ritz_state_space *out);

/**
 * The next file of such `matrices`, as "FILE[:NAME]", into room for as many
 * letters as there are. @return false behind the last
 */
bool ritz_import_space_next(const char **at, char *out);

void ritz_import_report_free(ritz_import_report *report);

#pragma GCC visibility pop

#endif
