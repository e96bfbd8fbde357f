/*
 * All modes of a dense second-order model, its damping and what drives it and
 * is seen of it, in modal coordinates:
 *
 *     q'' + Delta q' + Lambda q = B u,    y = C q + Cv q' + feed u
 */
#ifndef RITZ_MODEL_FIRST_ORDER_H
#define RITZ_MODEL_FIRST_ORDER_H

#include <ritz/component.h>
#include <ritz/damping.h>
#include <ritz/reduced.h>

/* K, M and D with dampers installed; D {0}: none. */
typedef struct ritz_structure {
    ritz_dense K, M, D;
} ritz_structure;

/** @return RITZ_ERR_ARGUMENT if it is too large or has structural damping */
ritz_status ritz_structure_of_component(const ritz_component *component,
                                        ritz_structure *out);
ritz_status ritz_structure_of_reduced(const ritz_reduced *reduced,
                                      ritz_structure *out);
void ritz_structure_free(ritz_structure *model);

typedef struct ritz_first_order {
    int64_t num_dofs, count; /* n, m: modes that have mass, rigid ones first */
    int64_t num_rigid;
    ritz_dense Phi, MPhi; /* n x m */
    double *lambda;       /* m, 0 where rigid  [rad^2/s^2] */
    ritz_dense Delta;     /* m x m, all damping */
    ritz_dense B;         /* m x inputs */
    ritz_dense C, Cv;     /* outputs x m, accelerations written out */
    ritz_dense feed;      /* outputs x inputs */
} ritz_first_order;

/**
 * With neither inputs nor outputs it is made for its poles alone, and what
 * damps massless dofs is left out.
 *
 * @return RITZ_ERR_ARGUMENT if a massless dof is damped, or driven and seen by
 *         its velocity or acceleration; RITZ_ERR_SINGULAR if K + M is
 */
ritz_status ritz_first_order_new(const ritz_structure *model, const ritz_io *io,
                                 const ritz_damping *damping,
                                 ritz_first_order *out);

/**
 * The last steps of that, with modes found otherwise, which may be some of all:
 * @p damping goes into Delta ({0}: no other), and what drives and is seen is
 * projected. What massless dofs answer is left out.
 *
 * @param[in,out] modes  with Phi, lambda, Delta and counts
 */
ritz_status ritz_first_order_drive(const ritz_io *io,
                                   const ritz_damping *damping,
                                   ritz_first_order *modes);

void ritz_first_order_free(ritz_first_order *model);

#endif
