/* Inertia terms of simulators from inertia invariants. */
#include "model/inertia_terms.h"

#include "base/alloc.h"
#include "base/vector.h"
#include "model/equations.h"

#include <math.h>
#include <string.h>

/* The integrals that the terms of MBDyn and of SID consist of, about the origin
   of the frame. */
typedef struct moments {
    int64_t m;
    double mass, first[3], second[9]; /* int 1, int x, int x~ x~' */
    const ritz_dense *S;              /* 6 x m, rows 0 to 2 are S */
    ritz_dense h;                     /* 3 x m */
    ritz_dense N;                     /* 3 x 3m */
    const ritz_dense *P;              /* 3m x 3m, rows a m + j */
} moments;

static void moments_free(moments *of)
{
    ritz_dense_free(&of->h);
    ritz_dense_free(&of->N);
}

static double product_of(const moments *of, int a, int64_t j, int b, int64_t k)
{
    return ritz_dense_col(of->P, b * of->m + k)[a * of->m + j];
}

/* (u x v)_a, where P_bc = u_b v_c. */
static double turn_of(const double P[3][3], int a)
{
    return P[(a + 1) % 3][(a + 2) % 3] - P[(a + 2) % 3][(a + 1) % 3];
}

/* skew(v)_ab */
static double skew_of(const double *v, int a, int b)
{
    if (a == b)
        return 0.0;
    return (b + 1) % 3 == a ? v[3 - a - b] : -v[3 - a - b];
}

static void take_pair(const moments *of, int64_t j, int64_t k, double P[3][3])
{
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            P[a][b] = product_of(of, a, j, b, k);
}

/*
 * Rigid motions about the origin o from those about the basic one: a rotation
 * theta x (x - o) is theta x x and the translation o x theta,
 *
 *     R_o = R | I  o~ |
 *             | 0  I  |
 */
static ritz_status move_rigid(const double rigid[static 36], const double *o,
                              ritz_dense *out)
{
    RITZ_OWN(ritz_dense) A = {0}, X = {0};

    RITZ_CHECK(ritz_dense_new(6, 6, &A));
    memcpy(A.val, rigid, 36 * sizeof *rigid);
    RITZ_CHECK(ritz_dense_identity(6, &X));
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            ritz_dense_col(&X, 3 + b)[a] = skew_of(o, a, b);
    RITZ_CHECK(ritz_dense_congruence(&A, &X, out));
    ritz_dense_symmetrise(out);
    return RITZ_OK;
}

static ritz_status find_rigid(const ritz_invariants *of, const double *o,
                              moments *out)
{
    RITZ_OWN(ritz_dense) A = {0};
    ritz_inertia inertia = {0};

    RITZ_CHECK(move_rigid(of->rigid, o, &A));
    ritz_inertia_read(&A, &inertia);
    RITZ_REFUSE_IF(!inertia.known, RITZ_ERR_ARGUMENT, "the body has no mass");
    out->mass = inertia.mass;
    for (int a = 0; a < 3; a++) {
        out->first[a] = inertia.mass * inertia.centre[a];
        for (int b = 0; b < 3; b++)
            out->second[3 * a + b] = ritz_dense_col(&A, 3 + b)[3 + a];
    }
    return RITZ_OK;
}

/* h_k = h_k about the basic origin - o x S_k. */
static void find_momenta(const double *o, moments *of)
{
    for (int64_t k = 0; k < of->m; k++) {
        const double *momentum = ritz_dense_col(of->S, k);
        double *h = ritz_dense_col(&of->h, k);

        ritz_cross(o, momentum, h);
        for (int a = 0; a < 3; a++)
            h[a] = momentum[3 + a] - h[a];
    }
}

/*
 * N = int (x . u) I - u x' = tr(X) I - X' with X_ab = int x_a u_b about o. The
 * antisymmetric part of X' is taken from h (see the header), which gives
 *
 *     N = tr(X) I - (X + X') / 2 - h~ / 2
 */
static void find_first_order(const ritz_dense *position, const double *o,
                             moments *of)
{
    for (int64_t k = 0; k < of->m; k++) {
        const double *momentum = ritz_dense_col(of->S, k);
        const double *h = ritz_dense_col(&of->h, k);
        double X[3][3];

        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                X[a][b] = ritz_dense_col(position, b * of->m + k)[a] -
                          o[a] * momentum[b];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                ritz_dense_col(&of->N, 3 * k + b)[a] =
                    (a == b ? X[0][0] + X[1][1] + X[2][2] : 0.0) -
                    (X[a][b] + X[b][a] + skew_of(h, a, b)) / 2.0;
    }
}

static ritz_status find_moments(const ritz_invariants *of, const ritz_dense *M,
                                const double *o, moments *out)
{
    const int64_t m = of->momentum.ncol;

    RITZ_REFUSE_IF(!of->momentum.val, RITZ_ERR_ARGUMENT,
                   "there are no invariants of inertia, which are kept of at "
                   "most %d columns",
                   (int)RITZ_INVARIANT_COLUMNS);
    RITZ_REFUSE_IF(M->nrow != m || M->ncol != m, RITZ_ERR_ARGUMENT,
                   "invariants of %lld modes and a mass matrix of %lld rows",
                   (long long)m, (long long)M->nrow);
    out->m = m;
    out->S = &of->momentum;
    out->P = &of->product;
    RITZ_CHECK(find_rigid(of, o, out));
    RITZ_CHECK(ritz_dense_new(3, m, &out->h));
    RITZ_CHECK(ritz_dense_new(3, 3 * m, &out->N));
    find_momenta(o, out);
    find_first_order(&of->position, o, out);
    return RITZ_OK;
}

/* N_jk(a, b) = tr(P_jk) I - P_jk(b, a) */
static double second_order(const double P[3][3], int a, int b)
{
    return (a == b ? P[0][0] + P[1][1] + P[2][2] : 0.0) - P[b][a];
}

/* ---- MBDyn -------------------------------------------------------------- */

static void put_mbdyn_pairs(const moments *of, ritz_mbdyn_terms *t)
{
    for (int64_t j = 0; j < of->m; j++)
        for (int64_t k = 0; k < of->m; k++) {
            const int64_t jk = j * of->m + k;
            double P[3][3];

            take_pair(of, j, k, P);
            for (int a = 0; a < 3; a++) {
                ritz_dense_col(&t->I5, jk)[a] = turn_of(P, a);
                for (int b = 0; b < 3; b++)
                    ritz_dense_col(&t->I9, 3 * jk + b)[a] =
                        -second_order(P, a, b);
            }
        }
}

ritz_status ritz_mbdyn_terms_of(const ritz_invariants *invariants,
                                const ritz_dense *M,
                                const double origin[static 3],
                                ritz_mbdyn_terms *out)
{
    RITZ_OWN(moments) of = {0};
    RITZ_OWN(ritz_mbdyn_terms) t = {0};

    RITZ_CHECK(find_moments(invariants, M, origin, &of));
    t.I1 = of.mass;
    memcpy(t.I2, of.first, sizeof t.I2);
    memcpy(t.I7, of.second, sizeof t.I7);
    RITZ_CHECK(ritz_dense_block(of.S, 0, 3, 0, of.m, &t.I3));
    RITZ_CHECK(ritz_dense_new(3, of.m * of.m, &t.I5));
    RITZ_CHECK(ritz_dense_copy(M, &t.I6));
    RITZ_CHECK(ritz_dense_new(3, 3 * of.m * of.m, &t.I9));
    put_mbdyn_pairs(&of, &t);
    RITZ_MOVE(t.I4, of.h);
    RITZ_MOVE(t.I8, of.N);
    RITZ_MOVE(*out, t);
    return RITZ_OK;
}

void ritz_mbdyn_terms_free(ritz_mbdyn_terms *terms)
{
    ritz_dense_free(&terms->I3);
    ritz_dense_free(&terms->I4);
    ritz_dense_free(&terms->I5);
    ritz_dense_free(&terms->I6);
    ritz_dense_free(&terms->I8);
    ritz_dense_free(&terms->I9);
    *terms = (ritz_mbdyn_terms){0};
}

/* ---- SID ---------------------------------------------------------------- */

/* Row and column of the six entries of a symmetric tensor, xx yy zz first. */
static const int in_J[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
static const int in_W[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};

/* o(N): the coefficient of w_a w_b in -w'N w. */
static double centrifugal(const double N[3][3], int c)
{
    const int a = in_W[c][0];
    const int b = in_W[c][1];

    return a == b ? -N[a][a] : -(N[a][b] + N[b][a]);
}

static ritz_status new_taylor(int64_t nrow, int64_t ncol, int64_t m,
                              ritz_taylor *out)
{
    RITZ_CHECK(ritz_dense_new(nrow, ncol, &out->m0));
    return m == 0 ? RITZ_OK : ritz_dense_new(nrow, ncol * m, &out->m1);
}

static ritz_status new_sid(int64_t m, ritz_sid_terms *t)
{
    RITZ_CHECK(new_taylor(3, 1, m, &t->mdCM));
    RITZ_CHECK(new_taylor(6, 1, m, &t->J));
    RITZ_CHECK(new_taylor(m, 3, 0, &t->Ct));
    RITZ_CHECK(new_taylor(m, 3, m, &t->Cr));
    RITZ_CHECK(new_taylor(3, 3 * m, m, &t->Gr));
    RITZ_CHECK(new_taylor(m, 3 * m, 0, &t->Ge));
    return new_taylor(m, 6, m, &t->Oe);
}

/* Terms of no mode and of one mode. */
static void put_sid_modes(const moments *of, ritz_sid_terms *t)
{
    for (int a = 0; a < 3; a++)
        t->mdCM.m0.val[a] = of->first[a];
    for (int c = 0; c < 6; c++)
        t->J.m0.val[c] = of->second[3 * in_J[c][0] + in_J[c][1]];
    for (int64_t k = 0; k < of->m; k++) {
        double N[3][3];

        for (int a = 0; a < 3; a++) {
            const double S = ritz_dense_col(of->S, k)[a];

            ritz_dense_col(&t->mdCM.m1, k)[a] = S;
            ritz_dense_col(&t->Ct.m0, a)[k] = S;
            ritz_dense_col(&t->Cr.m0, a)[k] = ritz_dense_col(&of->h, k)[a];
            for (int b = 0; b < 3; b++) {
                N[a][b] = ritz_dense_col(&of->N, 3 * k + b)[a];
                ritz_dense_col(&t->Gr.m0, 3 * k + b)[a] = 2.0 * N[a][b];
            }
        }
        for (int c = 0; c < 6; c++) {
            ritz_dense_col(&t->J.m1, k)[c] =
                N[in_J[c][0]][in_J[c][1]] + N[in_J[c][1]][in_J[c][0]];
            ritz_dense_col(&t->Oe.m0, c)[k] = centrifugal(N, c);
        }
    }
}

/* Terms of two modes: the coefficient of q_k in row or block l. */
static void put_sid_pair(const moments *of, int64_t k, int64_t l,
                         ritz_sid_terms *t)
{
    double P[3][3], N[3][3];

    take_pair(of, k, l, P);
    for (int a = 0; a < 3; a++) {
        const double turn = turn_of(P, a);

        ritz_dense_col(&t->Cr.m1, 3 * k + a)[l] = turn;
        ritz_dense_col(&t->Ge.m0, 3 * k + a)[l] = 2.0 * turn;
        for (int b = 0; b < 3; b++) {
            N[a][b] = second_order(P, a, b);
            ritz_dense_col(&t->Gr.m1, 3 * (k * of->m + l) + b)[a] =
                2.0 * N[a][b];
        }
    }
    for (int c = 0; c < 6; c++)
        ritz_dense_col(&t->Oe.m1, 6 * k + c)[l] = centrifugal(N, c);
}

ritz_status ritz_sid_terms_of(const ritz_invariants *invariants,
                              const ritz_dense *M,
                              const double origin[static 3],
                              ritz_sid_terms *out)
{
    RITZ_OWN(moments) of = {0};
    RITZ_OWN(ritz_sid_terms) t = {0};

    RITZ_CHECK(find_moments(invariants, M, origin, &of));
    t.mass = of.mass;
    RITZ_CHECK(new_sid(of.m, &t));
    RITZ_CHECK(ritz_dense_copy(M, &t.Me.m0));
    put_sid_modes(&of, &t);
    for (int64_t k = 0; k < of.m; k++)
        for (int64_t l = 0; l < of.m; l++)
            put_sid_pair(&of, k, l, &t);
    RITZ_MOVE(*out, t);
    return RITZ_OK;
}

void ritz_sid_terms_free(ritz_sid_terms *terms)
{
    enum { MEMBERS = 8 };
    ritz_taylor *const all[MEMBERS] = {&terms->mdCM, &terms->J,  &terms->Ct,
                                       &terms->Cr,   &terms->Me, &terms->Gr,
                                       &terms->Ge,   &terms->Oe};

    for (int k = 0; k < MEMBERS; k++) {
        ritz_dense_free(&all[k]->m0);
        ritz_dense_free(&all[k]->m1);
    }
    *terms = (ritz_sid_terms){0};
}

/* ---- lost kinetic energy ------------------------------------------------ */

/* M - sum_a P_aa */
static ritz_status find_missing(const ritz_invariants *of, const ritz_dense *M,
                                ritz_dense *out)
{
    const int64_t m = M->ncol;

    RITZ_CHECK(ritz_dense_copy(M, out));
    for (int a = 0; a < 3; a++)
        for (int64_t k = 0; k < m; k++)
            for (int64_t j = 0; j < m; j++)
                ritz_dense_col(out, k)[j] -=
                    ritz_dense_col(&of->product, a * m + k)[a * m + j];
    return RITZ_OK;
}

ritz_status ritz_inertia_loss_of(const ritz_invariants *invariants,
                                 const ritz_dense *K, const ritz_dense *M,
                                 ritz_inertia_loss *out)
{
    RITZ_OWN(ritz_dense) missing = {0}, lost = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    const ritz_dense *Phi = &pairs.Phi;

    *out = (ritz_inertia_loss){0};
    RITZ_REFUSE_IF(!invariants->momentum.val ||
                       M->ncol != invariants->momentum.ncol,
                   RITZ_ERR_ARGUMENT,
                   "invariants of %lld modes and a mass matrix of %lld rows",
                   (long long)invariants->momentum.ncol, (long long)M->nrow);
    RITZ_CHECK(find_missing(invariants, M, &missing));
    RITZ_CHECK(ritz_eigen_dense(K, M, &pairs));
    RITZ_CHECK(ritz_dense_mul(&missing, Phi, &lost));
    for (int64_t k = 0; k < Phi->ncol; k++) { /* phi'M phi = 1 */
        const double loss = fabs(ritz_dense_dot(Phi, k, &lost, k));

        if (loss > out->value)
            *out = (ritz_inertia_loss){loss, k};
    }
    return RITZ_OK;
}
