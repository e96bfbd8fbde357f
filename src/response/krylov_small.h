/* What a component is in a krylov space, solved and judged at a frequency. */
#ifndef RITZ_RESPONSE_KRYLOV_SMALL_H
#define RITZ_RESPONSE_KRYLOV_SMALL_H

#include "response/krylov_space.h"

typedef struct ritz_krylov_small {
    ritz_poles poles; /* V'Z V q = V'B in coordinates of its own */
    ritz_poles dual;  /* its transpose; loads C', Cv', Ca' */
    ritz_dense T;     /* r x r: from those to coordinates of V */
    int64_t outputs, inputs, r;
    double _Complex *q, *p, *z; /* r x inputs, r x outputs, 3 of those */
} ritz_krylov_small;

/** Project; given ratios act on the modes alone, a M + b K on all. */
ritz_status ritz_krylov_small_new(const ritz_direct *direct,
                                  const ritz_krylov_space *space,
                                  ritz_krylov_small *out);

/** q and p of V at one frequency. @return RITZ_ERR_SINGULAR */
ritz_status ritz_krylov_small_solve(ritz_krylov_small *small, double hertz);

/**
 * y of the residual of input @p index, or of output @p index if @p dual, by the
 * q and p that were found last.
 */
void ritz_krylov_residual(const ritz_direct *direct,
                          const ritz_krylov_space *space,
                          const ritz_krylov_small *small, double hertz,
                          bool dual, int64_t index, double _Complex *y);

/** sqrt(y^H G y). */
double ritz_krylov_space_norm(const ritz_krylov_space *space,
                              const double _Complex *y);

void ritz_krylov_small_free(ritz_krylov_small *small);

#endif
