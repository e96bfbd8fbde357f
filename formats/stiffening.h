/*
 * Geometric stiffness as terms of a body in a moving frame: which load stands
 * for which term.
 *
 *     spin_ab     KG per product w_a w_b of the frame's angular velocity
 *     turn_a      KG per angular acceleration of the frame
 *     accel_a     KG per acceleration of the frame, less gravity
 *     force_a@G   KG per force on grid G
 *     moment_a@G  KG per moment on grid G
 *
 * along its axes, which are the basic ones. Those of the first three are loads
 * by inertia: accel_x is of -rho e_x.
 */
#ifndef RITZ_FORMATS_STIFFENING_H
#define RITZ_FORMATS_STIFFENING_H

#include "model/floating.h"

#include <ritz/export.h>

enum {
    RITZ_SPIN = 0, /* xx yy zz xy yz xz */
    RITZ_TURN = 6, /* x y z, as those that follow */
    RITZ_ACCEL = 9,
    RITZ_FORCE = 12,
    RITZ_MOMENT = 15,
    RITZ_STIFFENING_KINDS = 18
};

typedef struct ritz_stiffening_term {
    int kind;      /* RITZ_SPIN and so on, plus the axis */
    int64_t grid;  /* of a force or moment; else 0 */
    int64_t load;  /* of the reduced component */
    ritz_dense K0; /* m x m, KG in the modes */
} ritz_stiffening_term;

typedef struct ritz_stiffening_terms {
    int64_t count;
    ritz_stiffening_term *term;
    int64_t num_grids;
    int64_t *grid; /* of forces and moments, in the order of their first one */
} ritz_stiffening_terms;

/**
 * @param[in]  text  "spin_zz=LOAD,force_x@13=LOAD,accel_x", a term alone is that
 *                   of a load of its name; NULL: no terms
 * @param[in]  U     r x m, coordinates of the reduced component of each mode
 * @return RITZ_ERR_ARGUMENT if there is no such term, load or grid, a term is
 *         named twice, or spin is about another point than the basic origin
 */
ritz_status ritz_stiffening_terms_of(const ritz_reduced *reduced,
                                     const ritz_floating *body,
                                     const ritz_dense *U, const char *text,
                                     ritz_stiffening_terms *out);

/** "force_x@13" */
void ritz_stiffening_name(const ritz_stiffening_term *term,
                          char out[RITZ_NAME_SIZE]);

/** Each term and its load, and the loads that are left out. */
ritz_status ritz_stiffening_terms_say(const ritz_reduced *reduced,
                                      const ritz_stiffening_terms *stiffening,
                                      ritz_export_report *report);

void ritz_stiffening_terms_free(ritz_stiffening_terms *stiffening);

#endif
