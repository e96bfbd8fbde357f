/* A body for Exudyn: what lies between a reduced component and its file. */
#ifndef RITZ_FORMATS_EXUDYN_H
#define RITZ_FORMATS_EXUDYN_H

#include "model/floating.h"

#include <ritz/export.h>

/* The arrays of Exudyn's file that are made from the invariants. */
typedef struct exudyn_terms {
    ritz_dense inertiaLocal;       /* 3 x 3, about the frame's origin */
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
    ritz_floating floating;
    exudyn_terms terms;
} exudyn_body;

/** Make the contents of the file. @return as ritz_floating_of */
ritz_status exudyn_body_of(const ritz_reduced *reduced,
                           const ritz_floating_request *request,
                           exudyn_body *out);

/** Report the frame, the motions left to it, and the losses. */
ritz_status exudyn_body_say(const exudyn_body *b, ritz_export_report *report);
void exudyn_body_free(exudyn_body *b);

#endif
