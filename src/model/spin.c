/*
 * Spin terms of a body from its inertia invariants. With P_(aj)(bk) =
 * int v_ja v_kb, X_a(bk) = int x_a v_kb, S_bk = int v_kb, n the axis and c a
 * point of it,
 *
 *     int v_j . (n x v_k)           = sum_ab N_ab P_(aj)(bk),     N = n~
 *     int v_j . (n x (n x v_k))     = sum_ab Q_ab P_(aj)(bk),     Q = n n' - I
 *     int v_j . (n x (n x (x - c))) = sum_ab Q_ab (X_a(bj) - c_a S_bj)
 *
 * The rotation itself is the rigid motion p = [-n x c; n], so that
 *
 *     int v_j . (n x (x - c)) = p'R'MT,     inertia = p'R'MR p
 *
 * follow from all of M. The tests compare all terms with point masses, with
 * beams of full order and with the closed forms of a rod.
 */
#include "model/spin.h"

#include "base/alloc.h"
#include "base/vector.h"
#include "linear/general.h"

#include <math.h>

/* sum_ab A_ab P_(aj)(bk) */
static ritz_status contract_product(const double A[3][3], const ritz_dense *P,
                                    ritz_dense *out)
{
    const int64_t r = P->ncol / 3;

    RITZ_CHECK(ritz_dense_new(r, r, out));
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int64_t k = 0; k < r && A[a][b] != 0.0; k++) {
                const double *from = ritz_dense_col(P, b * r + k) + a * r;
                double *to = ritz_dense_col(out, k);

                for (int64_t j = 0; j < r; j++)
                    to[j] += A[a][b] * from[j];
            }
    return RITZ_OK;
}

/* -sum_ab Q_ab (X_a(bj) - c_a S_bj) */
static void load_centrifugally(const double Q[3][3], const double c[3],
                               const ritz_invariants *of, double *load)
{
    const int64_t r = of->momentum.ncol;

    for (int64_t j = 0; j < r; j++)
        for (int b = 0; b < 3; b++) {
            const double *X = ritz_dense_col(&of->position, b * r + j);
            const double S = ritz_dense_col(&of->momentum, j)[b];

            for (int a = 0; a < 3; a++)
                load[j] -= Q[a][b] * (X[a] - c[a] * S);
        }
}

/* Euler load -p'R'MT, and p'R'MR p. */
static double load_by_turning(const double n[3], const double c[3],
                              const ritz_invariants *of, double *load)
{
    double p[6], sum = 0.0;

    ritz_cross(c, n, p);
    for (int a = 0; a < 3; a++)
        p[3 + a] = n[a];
    for (int64_t j = 0; j < of->momentum.ncol; j++)
        for (int a = 0; a < 6; a++)
            load[j] -= p[a] * ritz_dense_col(&of->momentum, j)[a];
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++)
            sum += p[a] * of->rigid[6 * a + b] * p[b];
    return sum;
}

ritz_status ritz_spin_terms_of(const ritz_invariants *invariants,
                               const double axis[static 3],
                               const double through[static 3],
                               ritz_spin_terms *out)
{
    const double *n = axis;
    const double twice[3][3] = {{0.0, -2.0 * n[2], 2.0 * n[1]},
                                {2.0 * n[2], 0.0, -2.0 * n[0]},
                                {-2.0 * n[1], 2.0 * n[0], 0.0}};
    RITZ_OWN(ritz_spin_terms) terms = {0};
    double Q[3][3];

    RITZ_REFUSE_IF(!invariants->momentum.val, RITZ_ERR_ARGUMENT,
                   "there are no inertia invariants, from which the terms of a "
                   "spin are made: grids need positions, and there may be %d "
                   "columns",
                   RITZ_INVARIANT_COLUMNS);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            Q[a][b] = n[a] * n[b] - (a == b ? 1.0 : 0.0);
    RITZ_CHECK(contract_product(twice, &invariants->product, &terms.G));
    RITZ_CHECK(contract_product(Q, &invariants->product, &terms.S));
    RITZ_CHECK(ritz_dense_new(invariants->momentum.ncol, 2, &terms.load));
    load_centrifugally(Q, through, invariants, terms.load.val);
    terms.inertia =
        load_by_turning(n, through, invariants, ritz_dense_col(&terms.load, 1));
    RITZ_MOVE(*out, terms);
    return RITZ_OK;
}

void ritz_spin_terms_keep(ritz_spin_model model, ritz_spin_terms *terms)
{
    if (model != RITZ_SPIN_CONSISTENT)
        ritz_dense_free(&terms->KG);
    if (model == RITZ_SPIN_RUTHLESS) {
        ritz_dense_free(&terms->G);
        ritz_dense_free(&terms->S);
    }
}

/* sum += P'A P; an empty sum or A is zero. */
static ritz_status add_congruence(const ritz_dense *A, bool symmetric,
                                  const ritz_dense *P, ritz_dense *sum)
{
    RITZ_OWN(ritz_dense) part = {0}, AP = {0};

    if (!A->val)
        return RITZ_OK;
    if (!sum->val)
        RITZ_CHECK(ritz_dense_new(P->ncol, P->ncol, sum));
    if (symmetric) {
        RITZ_CHECK(ritz_dense_congruence(A, P, &part));
    } else {
        RITZ_CHECK(ritz_dense_mul(A, P, &AP));
        RITZ_CHECK(ritz_dense_mul_tn(P, &AP, &part));
    }
    ritz_dense_add(1.0, &part, sum);
    return RITZ_OK;
}

ritz_status ritz_spin_terms_add(const ritz_spin_terms *body,
                                const ritz_dense *P, ritz_spin_terms *sum)
{
    RITZ_OWN(ritz_dense) load = {0};

    RITZ_CHECK(add_congruence(&body->G, false, P, &sum->G));
    RITZ_CHECK(add_congruence(&body->S, true, P, &sum->S));
    RITZ_CHECK(add_congruence(&body->KG, true, P, &sum->KG));
    RITZ_CHECK(ritz_dense_mul_tn(P, &body->load, &load));
    if (!sum->load.val)
        RITZ_CHECK(ritz_dense_new(P->ncol, 2, &sum->load));
    ritz_dense_add(1.0, &load, &sum->load);
    sum->inertia += body->inertia;
    return RITZ_OK;
}

/* Largest mu of A x = mu K x, K definite. */
static ritz_status largest_ratio(const ritz_dense *A, const ritz_dense *K,
                                 double *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    *out = 0.0;
    RITZ_CHECK(ritz_eigen_unchecked(A, K, &pairs));
    for (int64_t j = 0; j < pairs.Phi.ncol; j++)
        *out = fmax(*out, pairs.lambda[j]);
    return RITZ_OK;
}

/* W^2 up to which K + W^2 A is definite. */
static ritz_status definite_until(const ritz_dense *A, const ritz_dense *K,
                                  double *out)
{
    RITZ_OWN(ritz_dense) minus = {0};
    double mu = 0.0;

    *out = HUGE_VAL;
    if (!A->val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(A->nrow, A->ncol, &minus));
    ritz_dense_add(-1.0, A, &minus);
    RITZ_CHECK(largest_ratio(&minus, K, &mu));
    if (mu > 0.0)
        *out = 1.0 / mu;
    return RITZ_OK;
}

/* W^2 up to which W^2 (sign KG - d S) <= d K. */
static ritz_status bounded_until(const ritz_spin_terms *of, double sign,
                                 double d, const ritz_dense *K, double *out)
{
    RITZ_OWN(ritz_dense) A = {0};

    *out = HUGE_VAL;
    if (!of->KG.val)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(K->nrow, K->ncol, &A));
    ritz_dense_add(-sign / d, &of->KG, &A);
    if (of->S.val)
        ritz_dense_add(1.0, &of->S, &A);
    return definite_until(&A, K, out);
}

static ritz_status find_limits(const ritz_spin_terms *terms,
                               const ritz_dense *K, double error,
                               ritz_spin_limits *out)
{
    const double up = error * (2.0 + error), down = error * (2.0 - error);
    RITZ_OWN(ritz_dense) both = {0};
    double larger = 0.0, smaller = 0.0, stable = HUGE_VAL;

    if (terms->S.val || terms->KG.val)
        RITZ_CHECK(
            ritz_dense_copy(terms->S.val ? &terms->S : &terms->KG, &both));
    if (terms->S.val && terms->KG.val)
        ritz_dense_add(1.0, &terms->KG, &both);
    RITZ_CHECK(definite_until(&both, K, &stable));
    RITZ_CHECK(bounded_until(terms, 1.0, up, K, &larger));
    RITZ_CHECK(bounded_until(terms, -1.0, down, K, &smaller));
    out->stable = sqrt(stable);
    out->negligible = sqrt(fmin(larger, smaller));
    return RITZ_OK;
}

ritz_status ritz_spin_limits_of(const ritz_spin_terms *terms,
                                const ritz_dense *K, const ritz_dense *modes,
                                double error, ritz_spin_limits *out)
{
    RITZ_OWN(ritz_spin_terms) part = {0};
    RITZ_OWN(ritz_dense) K_part = {0};

    if (!modes)
        return find_limits(terms, K, error, out);
    RITZ_CHECK(ritz_spin_terms_add(terms, modes, &part));
    RITZ_CHECK(ritz_dense_congruence(K, modes, &K_part));
    return find_limits(&part, &K_part, error, out);
}

void ritz_spin_terms_free(ritz_spin_terms *terms)
{
    ritz_dense_free(&terms->G);
    ritz_dense_free(&terms->S);
    ritz_dense_free(&terms->KG);
    ritz_dense_free(&terms->load);
    *terms = (ritz_spin_terms){0};
}
