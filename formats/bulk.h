/* Bulk data between its cards and the deck: private to the reader. */
#ifndef RITZ_FORMATS_BULK_H
#define RITZ_FORMATS_BULK_H

#include "formats/cards.h"
#include "model/equations.h"

#include <ritz/import.h>

/* GRID as it is written. */
typedef struct ritz_bulk_grid {
    int64_t id, line;
    int64_t cp, cd; /* frames by id; -2 blank */
    int64_t spc;    /* directions as digits, 0 none; -2 blank */
    double x[3];
} ritz_bulk_grid;

enum { RITZ_BULK_BLANK = -2 };

enum { RITZ_RECTANGULAR, RITZ_CYLINDRICAL, RITZ_SPHERICAL };

/* CORD1R to CORD2S as written, then as resolved. */
typedef struct ritz_bulk_frame {
    int64_t id, line;
    int32_t kind;
    int64_t grid[3];  /* CORD1: ids of origin, z axis, x-z plane; CORD2: 0 */
    int64_t base[3];  /* frame in which each of these points is given */
    double point[9];  /* the points, row by row */
    int32_t progress; /* of resolving it */
    double origin[3]; /* basic frame, from here on */
    double axes[9];   /* row i is axis i */
    int64_t row;      /* of these among the axes of the grids; 0: not yet */
} ritz_bulk_frame;

/* Grids from..to have these directions in a set; one grid if from == to. */
typedef struct ritz_bulk_range {
    int64_t from, to;
    int64_t set;  /* SPC set, 0 where there are none */
    int64_t line; /* in the deck */
    uint8_t mask; /* bit c: direction c; bit 0: scalar points */
    bool imposed; /* SPC: a motion that is not zero */
    bool each;    /* explicitly named: THRU covers what there is */
} ritz_bulk_range;

typedef struct ritz_bulk_ranges {
    int64_t count, room;
    ritz_bulk_range *range;
} ritz_bulk_ranges;

/* A combination of sets, SPCADD or MPCADD. */
typedef struct ritz_bulk_sum {
    int64_t set, member;
    int64_t which; /* RITZ_SELECT_SPC or RITZ_SELECT_MPC */
} ritz_bulk_sum;

/* A card that eliminates dofs. */
typedef struct ritz_bulk_constraint {
    char name[RITZ_CARD_NAME_SIZE];
    int64_t id;
    bool is_set;   /* MPC: acts if the case control selects it */
    int64_t entry; /* of the deck */
} ritz_bulk_constraint;

enum { RITZ_BULK_SPC = 3, RITZ_BULK_SETS = 4 }; /* after RITZ_SET_A, B, Q */

/* Everything that the cards say, before it is put together. */
typedef struct ritz_bulk_cards {
    ritz_cards cards;
    int64_t num_grids, grids_room;
    ritz_bulk_grid *grid; /* sorted by id, each once, once settled */
    int64_t num_frames, frames_room;
    ritz_bulk_frame *frame;  /* the same */
    ritz_bulk_grid defaults; /* GRDSET; line -1: there is none */
    int64_t num_sums, sums_room;
    ritz_bulk_sum *sum;
    int64_t num_constraints, constraints_room;
    ritz_bulk_constraint *constraint;
    ritz_bulk_ranges points;   /* SPOINT */
    ritz_bulk_ranges external; /* EXTRN, in its order */
    ritz_bulk_ranges ranges[RITZ_BULK_SETS];
} ritz_bulk_cards;

/** Take a card into what was read; @p how: the kind of a frame. */
ritz_status ritz_bulk_take_grid(ritz_bulk_cards *all, const ritz_card *card,
                                int32_t how);
ritz_status ritz_bulk_take_defaults(ritz_bulk_cards *all, const ritz_card *card,
                                    int32_t how);
ritz_status ritz_bulk_take_by_grids(ritz_bulk_cards *all, const ritz_card *card,
                                    int32_t how);
ritz_status ritz_bulk_take_by_points(ritz_bulk_cards *all,
                                     const ritz_card *card, int32_t how);

ritz_status ritz_bulk_take_external(ritz_bulk_cards *all, const ritz_card *card,
                                    int32_t how);

const ritz_bulk_grid *ritz_bulk_find_grid(const ritz_bulk_cards *all,
                                          int64_t id);

/** Settle and place all grids and frames, once all cards are there; each id
 * counts once. @cost O(n log n) */
ritz_status ritz_bulk_place_grids(ritz_bulk_cards *all, ritz_grids *out);

/** List the rows that EXTRN names. @param[in,out] out  its grids and points are
 * complete */
ritz_status ritz_bulk_list_external(const ritz_bulk_cards *all, ritz_deck *out);

/**
 * The equations of all constraint elements that act.
 *
 * @param[in,out] built  its grids, points and names of constraints are there
 */
ritz_status ritz_bulk_list_equations(const ritz_bulk_cards *all,
                                     ritz_deck *built);

#endif
