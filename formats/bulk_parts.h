/* What the parts of the bulk data reader hand each other; private to them. */
#ifndef RITZ_FORMATS_BULK_PARTS_H
#define RITZ_FORMATS_BULK_PARTS_H

#include "formats/cards.h"
#include "model/ties.h"

#include <ritz/deck.h>

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
    bool by_grids;    /* CORD1: else CORD2 */
    int64_t grid[3];  /* by grids: ids of origin, z axis, x-z plane */
    int64_t base;     /* by points: the frame these are in */
    double point[9];  /* the points, row by row */
    int32_t progress; /* of resolving it */
    double origin[3]; /* basic frame, from here on */
    double axes[9];   /* row i is axis i */
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
    ritz_bulk_ranges points; /* SPOINT */
    ritz_bulk_ranges ranges[RITZ_BULK_SETS];
} ritz_bulk_cards;

/** Take a card into what was read. */
ritz_status ritz_bulk_take_grid(ritz_bulk_cards *all, const ritz_card *card);
ritz_status ritz_bulk_take_defaults(ritz_bulk_cards *all,
                                    const ritz_card *card);
ritz_status ritz_bulk_take_frame(ritz_bulk_cards *all, const ritz_card *card,
                                 int32_t kind, bool by_grids);

/** Take every card of the deck that says something of grids or sets. */
ritz_status ritz_bulk_take_cards(ritz_bulk_cards *all);

/** Sort grids and frames, once all cards are there; each id once. */
ritz_status ritz_bulk_settle_grids(ritz_bulk_cards *all);
ritz_status ritz_bulk_settle_frames(ritz_bulk_cards *all);

/** Find origin and axes of every frame. @cost O(n log n) */
ritz_status ritz_bulk_resolve_frames(ritz_bulk_cards *all);

/** Order of two int64_t, and of structs that begin with an id. */
int ritz_bulk_compare_ids(const void *left, const void *right);

/** Frame or grid by id; NULL if there is none. */
ritz_bulk_frame *ritz_bulk_find_frame(const ritz_bulk_cards *all, int64_t id);
const ritz_bulk_grid *ritz_bulk_find_grid(const ritz_bulk_cards *all,
                                          int64_t id);

/** Origin and axes of a frame by three points, which no line may hold. */
ritz_status ritz_bulk_orient(const ritz_bulk_cards *all,
                             const double A[static 3], const double B[static 3],
                             const double C[static 3], ritz_bulk_frame *frame);

/** Coordinates @p x of a resolved frame, NULL the basic one, as a position. */
void ritz_bulk_position(const ritz_bulk_frame *frame, const double x[static 3],
                        double out[static 3]);

/** Displacement axes of a frame at a position of the basic frame. */
void ritz_bulk_axes(const ritz_bulk_frame *frame,
                    const double position[static 3], double out[static 9]);

/** Positions and displacement frames of all grids. */
ritz_status ritz_bulk_place_grids(const ritz_bulk_cards *all, ritz_grids *out);

/** Whether a field is @p word, which is in capitals. */
bool ritz_bulk_is_word(const char *text, const char *word);

/** Directions "123" as digits; @return false if they are not distinct 0-6 */
bool ritz_bulk_mask(int64_t digits, uint8_t *out);

/** Append a range to a set. */
ritz_status ritz_bulk_add_range(ritz_bulk_ranges *list, ritz_bulk_range range);

/** The scalar points, ascending. */
ritz_status ritz_bulk_list_points(const ritz_bulk_cards *all, ritz_deck *out);

/**
 * The dofs of some ranges, sorted, each once.
 *
 * @param[in] built  its grids and points are there already
 */
ritz_status ritz_bulk_list_set(const ritz_bulk_cards *all,
                               const ritz_bulk_ranges *list,
                               const ritz_deck *built, int64_t *count,
                               ritz_dof **out);

/** Copy the sentence of the latest failure. */
ritz_status ritz_bulk_keep_sentence(char **out);

/** Which grids elements join. */
ritz_status ritz_bulk_list_elements(const ritz_bulk_cards *all, ritz_deck *out);

/** Whether a set of SPC or MPC cards acts. */
bool ritz_bulk_selects(const ritz_cards *cards, int64_t which, int64_t set);

/**
 * The equations of all constraint elements that act.
 *
 * @param[in,out] built  its grids and points are there already
 */
ritz_status ritz_bulk_list_equations(const ritz_bulk_cards *all,
                                     ritz_deck *built);

/* A constraint element as it becomes equations. */
typedef struct ritz_bulk_tying {
    const ritz_bulk_cards *all;
    const ritz_deck *built;
    const ritz_card *card;
    const char *name; /* "RBE2 600" */
    ritz_equations *out;
} ritz_bulk_tying;

/** Fail with file, line and the name of the element before the sentence. */
[[gnu::format(printf, 2, 3)]] ritz_status
ritz_bulk_tying_refuse(const ritz_bulk_tying *it, const char *format, ...);

/** The grid that field @p k names, as index; it must have a position. */
ritz_status ritz_bulk_tying_grid(const ritz_bulk_tying *it, int64_t k,
                                 int64_t *out);

/** Directions that field @p k lists; 0 of a blank or 0. */
ritz_status ritz_bulk_tying_mask(const ritz_bulk_tying *it, int64_t k,
                                 uint8_t *out);

/** Whether field @p k holds a number with a point. */
bool ritz_bulk_tying_is_real(const ritz_bulk_tying *it, int64_t k);

/** Pairs of grid and directions behind UM, to the end or a thermal field. */
ritz_status ritz_bulk_tying_pairs(const ritz_bulk_tying *it, int64_t k,
                                  ritz_ties *out);

/** The elements that are understood. */
ritz_status ritz_bulk_tie_mpc(const ritz_bulk_tying *it);
ritz_status ritz_bulk_tie_rbar(const ritz_bulk_tying *it);
ritz_status ritz_bulk_tie_rbe1(const ritz_bulk_tying *it);
ritz_status ritz_bulk_tie_rbe2(const ritz_bulk_tying *it);
ritz_status ritz_bulk_tie_rbe3(const ritz_bulk_tying *it);
ritz_status ritz_bulk_tie_rtrplt(const ritz_bulk_tying *it);

#endif
