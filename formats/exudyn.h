/* A body for Exudyn: what lies between a reduced component and its file. */
#ifndef RITZ_FORMATS_EXUDYN_H
#define RITZ_FORMATS_EXUDYN_H

#include "model/equations.h"

#include <ritz/export.h>

/* The flexible modes of a body, Psi = T V, and how they move. */
typedef struct exudyn_modes {
    ritz_dense V;                 /* r x m */
    ritz_dense K, M;              /* m x m */
    int64_t num_rigid;            /* motions left to the frame */
    bool kept;                    /* columns of the basis as they are */
    double lowest_hz, highest_hz; /* of (K, M) */
} exudyn_modes;

/* The arrays of Exudyn's file that are made from the invariants. */
typedef struct exudyn_terms {
    ritz_dense inertiaLocal;       /* 3 x 3, about the basic origin */
    ritz_dense Mtt;                /* 3 x 3 */
    ritz_dense chiUtilde;          /* 3 x 3 */
    ritz_dense mPsiTildePsi;       /* 3m x m */
    ritz_dense mPsiTildePsiTilde;  /* 3m x 3m */
    ritz_dense mPhitTPsi;          /* 3 x m */
    ritz_dense mPhitTPsiTilde;     /* 3 x 3m */
    ritz_dense mXRefTildePsi;      /* 3 x m */
    ritz_dense mXRefTildePsiTilde; /* 3 x 3m */
} exudyn_terms;

/** @param[in] invariants  of the m modes themselves */
ritz_status exudyn_terms_of(const ritz_invariants *invariants,
                            const ritz_inertia *inertia, exudyn_terms *out);
void exudyn_terms_free(exudyn_terms *terms);

/* The contents of the file. */
typedef struct exudyn_body {
    int64_t num_dofs; /* of the component, and recovered ones behind them */
    ritz_dof *dof;
    ritz_dense T;         /* their motion */
    ritz_nodes nodes;     /* grids borrowed from the reduced component */
    double *xRef;         /* 3 a node */
    ritz_dense modeBasis; /* 3 rows a node, along basic axes */
    exudyn_modes modes;
    exudyn_terms terms;
    ritz_invariants invariants; /* of the modes */
    int64_t num_rotating;       /* grids with rotations */
} exudyn_body;

/**
 * @return RITZ_ERR_ARGUMENT if it holds no basis, positions, mass or
 *         invariants, has scalar points, or is not a flexible body
 */
ritz_status exudyn_body_of(const ritz_reduced *reduced, exudyn_body *out);

/** Report the motions left to the moving frame, and the losses. */
ritz_status exudyn_body_say(const ritz_reduced *reduced, const exudyn_body *b,
                            ritz_export_report *report);
void exudyn_body_free(exudyn_body *b);

#endif
