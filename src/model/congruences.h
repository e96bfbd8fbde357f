/*
 * What a reduced component needs of the matrices of a component: T'KT and the
 * like. All but `fastest` are sums over entries of the matrices: processes that
 * hold some of the entries each find them for these, and add.
 */
#ifndef RITZ_MODEL_CONGRUENCES_H
#define RITZ_MODEL_CONGRUENCES_H

#include <ritz/model.h>

/* The largest K_jj / M_jj of coordinates with mass. */
typedef struct ritz_fastest {
    double ratio;  /* 0: none has mass */
    bool massless; /* whether a coordinate has no mass */
} ritz_fastest;

/** Take a coordinate with K_jj = @p k and M_jj = @p m into account. */
void ritz_fastest_add(double k, double m, ritz_fastest *fastest);

/** Whether columns of a kind are rigid-body motions, or combine to some. */
bool ritz_may_be_rigid(ritz_column_kind kind);

typedef struct ritz_congruences {
    ritz_dense K, M, D, K4; /* r x r, T'KT and so on; {0} of an absent matrix */
    int64_t num_loads;
    ritz_reduced_load *load; /* T'KG T of each load */
    /* r x r, |T|'|K||T| in rows and columns that may be rigid, else 0: rounding
       errors of T'KT are some eps times this */
    ritz_dense K_terms, K4_terms;
    ritz_dense rigid;           /* 6 x 6, R'MR of rigid motions R; {0}: there is
                                   no grid */
    ritz_invariants invariants; /* with zeros for massless columns of T */
    ritz_fastest fastest;       /* of all dofs; a maximum, not a sum */
} ritz_congruences;

/**
 * Compute all members but `fastest`.
 *
 * @param[in]  component  its matrices, dofs and grids are read
 * @param[in]  kind       r kinds of the columns of T
 * @param[in]  T          n x r
 * @param[in]  twofold    whether K T is summed with twice the digits
 * @return RITZ_ERR_ARGUMENT if the sizes disagree; RITZ_ERR_MEMORY
 * @cost   O(r nnz + n r^2)
 */
ritz_status ritz_congruences_of(const ritz_component *component,
                                const ritz_column_kind *kind,
                                const ritz_dense *T, bool twofold,
                                ritz_congruences *out);

/**
 * Whether K T must be summed with twice the digits: columns of T depend on each
 * other to six digits or more.
 *
 * @param[in] G  r x r, T'T; {0} if T has no columns
 * @return RITZ_ERR_MEMORY
 */
ritz_status ritz_congruences_twofold(const ritz_dense *G, bool *out);

/**
 * Make the reduced component of a basis from its congruences. The matrices of
 * the component are not read.
 *
 * @param[in,out] sums  of the whole matrices; they are moved to @p out
 * @return as ritz_reduce()
 */
ritz_status ritz_congruences_reduce(const ritz_component *component,
                                    const ritz_basis *basis,
                                    ritz_congruences *sums, ritz_reduced *out);

void ritz_congruences_free(ritz_congruences *sums);

#endif
