/*
 * Exudyn's constant matrices from inertia invariants. With skew(v) w = v x w,
 * x a node's place, psi_k its motion in mode k, and sums over all pairs of
 * nodes with their mass m, block k of columns (or of rows) is
 *
 *     mPsiTildePsi        skew(psi_k)' m psi_l   =  psi_l x psi_k
 *     mPsiTildePsiTilde   skew(psi_k)' m skew(psi_l)
 *                                     =  (psi_k . psi_l) I - psi_l psi_k'
 *     mXRefTildePsi       skew(x)' m psi_l       =  -(x x psi_l)
 *     mXRefTildePsiTilde  skew(x)' m skew(psi_l) =  (x . psi_l) I - psi_l x'
 *     mPhitTPsi           m psi_l
 *     mPhitTPsiTilde      m skew(psi_l)
 *
 * [ZwolferGerstmayr2021]. Of a body whose grids rotate, what does not change
 * with deformation is taken from all of M: mass, inertia, and the momenta
 * R'M Psi. The equations of motion keep momentum only if the other terms agree
 * with these: m skew(psi_l) must be skew of the linear momentum S_l, and of
 * (x . psi) I - psi x' the antisymmetric part must belong to the angular
 * momentum C_l; so they are set. For solids both are identities.
 */
#include "formats/exudyn.h"

/* The permutation symbol e_abc. */
static double permutation(int a, int b, int c)
{
    return (a - b) * (b - c) * (c - a) / 2.0;
}

/* skew(v)_ab = -e_abc v_c, put at column `col`. */
static void put_skew(const double *v, int64_t col, ritz_dense *out)
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            double sum = 0.0;

            for (int c = 0; c < 3; c++)
                sum -= permutation(a, b, c) * v[c];
            ritz_dense_col(out, col + b)[a] = sum;
        }
}

static void put_rigid(const ritz_invariants *of, const ritz_inertia *inertia,
                      exudyn_terms *t)
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            ritz_dense_col(&t->Mtt, b)[a] = of->rigid[a + 6 * b];
            ritz_dense_col(&t->inertiaLocal, b)[a] =
                of->rigid[a + 3 + 6 * (b + 3)];
        }
    put_skew(inertia->centre, 0, &t->chiUtilde);
}

static void put_momenta(const ritz_invariants *of, exudyn_terms *t)
{
    for (int64_t l = 0; l < of->momentum.ncol; l++) {
        const double *momentum = ritz_dense_col(&of->momentum, l);

        for (int a = 0; a < 3; a++) {
            ritz_dense_col(&t->mPhitTPsi, l)[a] = momentum[a];
            ritz_dense_col(&t->mXRefTildePsi, l)[a] = -momentum[3 + a];
        }
        put_skew(momentum, 3 * l, &t->mPhitTPsiTilde);
    }
}

/* (x . psi_l) I - sym(psi_l x') - skew(C_l) / 2 */
static void put_first_order(const ritz_invariants *of, exudyn_terms *t)
{
    int64_t m = of->momentum.ncol;

    for (int64_t l = 0; l < m; l++) {
        double *C = ritz_dense_col(&of->momentum, l) + 3;
        double trace = 0.0;

        put_skew(C, 3 * l, &t->mXRefTildePsiTilde);
        for (int a = 0; a < 3; a++)
            trace += ritz_dense_col(&of->position, a * m + l)[a];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                double *at =
                    &ritz_dense_col(&t->mXRefTildePsiTilde, 3 * l + b)[a];
                double x_psi = ritz_dense_col(&of->position, b * m + l)[a] +
                               ritz_dense_col(&of->position, a * m + l)[b];

                *at = (a == b ? trace : 0.0) - (x_psi + *at) / 2.0;
            }
    }
}

/* mPsiTildePsi and mPsiTildePsiTilde of one pair of modes. */
static void put_pair(const ritz_dense *product, int64_t m, int64_t k, int64_t l,
                     exudyn_terms *t)
{
    double P[3][3]; /* psi_k, axis a, times psi_l, axis b */

    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            P[a][b] = ritz_dense_col(product, b * m + l)[a * m + k];
    for (int b = 0; b < 3; b++) {
        int c = (b + 1) % 3;
        int d = (b + 2) % 3;

        ritz_dense_col(&t->mPsiTildePsi, l)[3 * k + b] = P[d][c] - P[c][d];
        for (int f = 0; f < 3; f++)
            ritz_dense_col(&t->mPsiTildePsiTilde, 3 * l + f)[3 * k + b] =
                (b == f ? P[0][0] + P[1][1] + P[2][2] : 0.0) - P[f][b];
    }
}

ritz_status exudyn_terms_of(const ritz_invariants *invariants,
                            const ritz_inertia *inertia, exudyn_terms *out)
{
    ritz_status status = RITZ_OK;
    int64_t m = invariants->momentum.ncol;
    exudyn_terms t = {0};

    RITZ_TRY(ritz_dense_new(3, 3, &t.inertiaLocal));
    RITZ_TRY(ritz_dense_new(3, 3, &t.Mtt));
    RITZ_TRY(ritz_dense_new(3, 3, &t.chiUtilde));
    RITZ_TRY(ritz_dense_new(3 * m, m, &t.mPsiTildePsi));
    RITZ_TRY(ritz_dense_new(3 * m, 3 * m, &t.mPsiTildePsiTilde));
    RITZ_TRY(ritz_dense_new(3, m, &t.mPhitTPsi));
    RITZ_TRY(ritz_dense_new(3, 3 * m, &t.mPhitTPsiTilde));
    RITZ_TRY(ritz_dense_new(3, m, &t.mXRefTildePsi));
    RITZ_TRY(ritz_dense_new(3, 3 * m, &t.mXRefTildePsiTilde));
    put_rigid(invariants, inertia, &t);
    put_momenta(invariants, &t);
    put_first_order(invariants, &t);
    for (int64_t l = 0; l < m; l++)
        for (int64_t k = 0; k < m; k++)
            put_pair(&invariants->product, m, k, l, &t);
    *out = t;
    t = (exudyn_terms){0};
done:
    exudyn_terms_free(&t);
    return status;
}

void exudyn_terms_free(exudyn_terms *terms)
{
    ritz_dense_free(&terms->inertiaLocal);
    ritz_dense_free(&terms->Mtt);
    ritz_dense_free(&terms->chiUtilde);
    ritz_dense_free(&terms->mPsiTildePsi);
    ritz_dense_free(&terms->mPsiTildePsiTilde);
    ritz_dense_free(&terms->mPhitTPsi);
    ritz_dense_free(&terms->mPhitTPsiTilde);
    ritz_dense_free(&terms->mXRefTildePsi);
    ritz_dense_free(&terms->mXRefTildePsiTilde);
    *terms = (exudyn_terms){0};
}
