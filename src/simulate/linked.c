/*
 * Unjoined bodies in their modes, and the constraints that join them.
 *
 * With the rows of C Phi divided by their scales, S^-1 C Phi = U Sigma V', the
 * rank r is the number of singular values above 1e-9 of the largest. In the
 * coordinates x = V'z, z being those of modes, the violation c are the first r,
 * and
 *
 *     lambda = S^-1 U_r Sigma_r^-1 mu
 *
 * satisfies (C Phi)'lambda = V_r mu with the least |S lambda|. Rows that nearly
 * depend on others cause no loss of digits, because no step solves with
 * C M^-1 C', whose condition number is the square of that of the rows.
 *
 * Neither do stiff penalties. In modes their stiffness k V_r V_r' is in every
 * entry of K, where k = 1e16 K leaves no digit of K. In x it is in r entries of
 * the diagonal, and c, of size f / k, has digits of its own.
 */
#include "simulate/constrained.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "model/modal.h"

#include <inttypes.h>
#include <math.h>

static ritz_status check_sizes(const ritz_unjoined *b)
{
    const int64_t n = b->n;

    RITZ_REFUSE_IF(n < 1, RITZ_ERR_ARGUMENT, "there is no body to join");
    RITZ_REFUSE_IF(
        b->K.nrow != n || b->K.ncol != n || b->M.nrow != n || b->M.ncol != n ||
            (b->D.val && (b->D.nrow != n || b->D.ncol != n)),
        RITZ_ERR_ARGUMENT, "K, M and D must be square, of order %" PRId64, n);
    RITZ_REFUSE_IF(b->C.nrow != b->num_rows || (b->C.val && b->C.ncol != n),
                   RITZ_ERR_ARGUMENT,
                   "constraints are %" PRId64 " rows of %" PRId64
                   " coordinates, not %" PRId64 " of %" PRId64,
                   b->num_rows, n, b->C.nrow, b->C.ncol);
    RITZ_REFUSE_IF(b->io.B.nrow != n || b->io.C.ncol != n, RITZ_ERR_ARGUMENT,
                   "inputs and outputs must have %" PRId64 " coordinates", n);
    for (int64_t k = 0; b->C.val && k < b->C.nrow * b->C.ncol; k++)
        RITZ_REFUSE_IF(!isfinite(b->C.val[k]), RITZ_ERR_ARGUMENT,
                       "a constraint has a coefficient that is not finite");
    return RITZ_OK;
}

static double row_norm(const ritz_dense *A, int64_t i)
{
    double sum = 0.0;

    for (int64_t j = 0; j < A->ncol; j++)
        sum += ritz_dense_col(A, j)[i] * ritz_dense_col(A, j)[i];
    return sqrt(sum);
}

/* The scale of each row: as given, or the length of the longest row. */
static ritz_status find_scales(const ritz_unjoined *b, const ritz_dense *G,
                               double **out)
{
    RITZ_OWN_ARRAY double *scale = NULL;
    double longest = 0.0;

    RITZ_CHECK_NEW(scale, G->nrow);
    for (int64_t i = 0; i < G->nrow; i++)
        longest = fmax(longest, row_norm(G, i));
    for (int64_t i = 0; i < G->nrow; i++) {
        scale[i] = b->scale ? b->scale[i] : longest;
        if (!(scale[i] > 0.0))
            scale[i] = 1.0;
    }
    RITZ_MOVE(*out, scale);
    return RITZ_OK;
}

/* x -= (q'x) q for each kept row q. It is done twice, because rounding of large
   parts is left after the first time. */
static void take_kept(const ritz_dense *kept, int64_t count, double *x)
{
    for (int pass = 0; pass < 2; pass++)
        for (int64_t k = 0; k < count; k++) {
            const double *q = ritz_dense_col(kept, k);
            const double part = ritz_motion_dot(kept->nrow, q, x);

            for (int64_t i = 0; i < kept->nrow; i++)
                x[i] -= part * q[i];
        }
}

/* Find the rows that depend on those before them, in their order. */
static ritz_status name_redundant(const ritz_dense *scaled, ritz_linked *j)
{
    RITZ_OWN(ritz_dense) rows = {0}, kept = {0};
    int64_t count = 0;

    RITZ_CHECK_NEW(j->redundant, scaled->nrow);
    RITZ_CHECK(ritz_general_transpose(scaled, &rows));
    RITZ_CHECK(ritz_dense_new(scaled->ncol, scaled->nrow, &kept));
    for (int64_t i = 0; i < rows.ncol; i++) {
        double *x = ritz_dense_col(&rows, i);
        double *to = ritz_dense_col(&kept, count);
        double left = 0.0;

        take_kept(&kept, count, x);
        left = sqrt(ritz_motion_dot(rows.nrow, x, x));
        if (left <= RITZ_RANK_LOSS || count == j->rank) {
            j->redundant[j->num_redundant++] = i;
            continue;
        }
        for (int64_t k = 0; k < rows.nrow; k++)
            to[k] = x[k] / left;
        count++;
    }
    return RITZ_OK;
}

/* L and V, from the singular value decomposition of the scaled rows. */
static ritz_status decompose_rows(const ritz_unjoined *b, ritz_linked *j,
                                  ritz_dense *V)
{
    const int64_t least = j->num_rows < b->n ? j->num_rows : j->G.ncol;
    RITZ_OWN_ARRAY double *scale = NULL, *sigma = NULL;
    RITZ_OWN(ritz_dense) scaled = {0}, U = {0};

    if (j->num_rows == 0)
        return ritz_dense_identity(b->n, V);
    RITZ_CHECK(find_scales(b, &j->G, &scale));
    RITZ_CHECK(ritz_dense_copy(&j->G, &scaled));
    for (int64_t k = 0; k < scaled.ncol; k++)
        for (int64_t i = 0; i < scaled.nrow; i++)
            ritz_dense_col(&scaled, k)[i] /= scale[i];
    RITZ_CHECK_IN("constraints", ritz_general_svd(&scaled, &U, &sigma, V));
    while (j->rank < least && sigma[j->rank] > RITZ_RANK_LOSS * sigma[0])
        j->rank++;
    RITZ_CHECK(ritz_dense_new(j->num_rows, j->rank, &j->L));
    for (int64_t k = 0; k < j->rank; k++)
        for (int64_t i = 0; i < j->num_rows; i++)
            ritz_dense_col(&j->L, k)[i] =
                ritz_dense_col(&U, k)[i] / (sigma[k] * scale[i]);
    return name_redundant(&scaled, j);
}

/* V'Lambda V, and the first rows of V'Lambda^(1/2) V. */
static ritz_status turn_stiffness(const double *lambda, const ritz_dense *V,
                                  ritz_linked *j)
{
    const ritz_dense V_r = ritz_dense_part(V, 0, j->rank);
    RITZ_OWN_ARRAY double *root = NULL;
    RITZ_OWN(ritz_dense) Lambda = {0}, part = {0};

    RITZ_CHECK_NEW(root, V->nrow);
    RITZ_CHECK(ritz_dense_new(V->nrow, V->nrow, &Lambda));
    for (int64_t k = 0; k < V->nrow; k++) {
        root[k] = sqrt(fabs(lambda[k]));
        ritz_dense_col(&Lambda, k)[k] = lambda[k];
        j->unjoined = fmax(j->unjoined, lambda[k]);
    }
    RITZ_CHECK(ritz_dense_congruence(&Lambda, V, &j->motion.K));
    RITZ_CHECK(ritz_dense_copy(V, &part));
    ritz_dense_scale_rows(root, &part);
    return ritz_dense_mul_tn(&V_r, &part, &j->peak);
}

/* The motion in x = V'z. An impulse does not change c'. */
static ritz_status turn_motion(const ritz_dense *V, ritz_modal_model *modes,
                               ritz_linked *j)
{
    ritz_motion *m = &j->motion;

    m->form = RITZ_FORM_DENSE;
    m->energies = true;
    m->n = m->original = V->nrow;
    RITZ_CHECK(turn_stiffness(modes->lambda, V, j));
    RITZ_CHECK(ritz_dense_project(&modes->Delta, V, &m->D));
    RITZ_CHECK(ritz_dense_mul_tn(V, &modes->B, &m->B));
    RITZ_CHECK(ritz_dense_copy(&m->B, &m->push));
    for (int64_t k = 0; k < m->push.ncol; k++)
        for (int64_t i = 0; i < j->rank; i++)
            ritz_dense_col(&m->push, k)[i] = 0.0;
    RITZ_CHECK(ritz_dense_mul(&modes->C, V, &m->C));
    RITZ_CHECK(ritz_dense_mul(&modes->Cv, V, &m->Cv));
    RITZ_MOVE(m->feed, modes->feed);
    return ritz_dense_mul(&modes->MPhi, V, &j->to);
}

static ritz_status turn_rows(const ritz_dense *V, const ritz_dense *Ca,
                             ritz_linked *j)
{
    const ritz_dense V_r = ritz_dense_part(V, 0, j->rank);
    RITZ_OWN(ritz_dense) G = {0};

    RITZ_CHECK(ritz_dense_mul(&j->G, V, &G));
    ritz_dense_replace(&j->G, &G);
    return ritz_dense_mul(Ca, &V_r, &j->reach);
}

/* Highest eigenvalue of the joined bodies. */
static ritz_status find_highest(ritz_linked *j)
{
    static const ritz_stabiliser exact = {.multipliers = true};

    return ritz_stabilised_highest(j, &exact, &j->highest);
}

ritz_status ritz_linked_new(const ritz_unjoined *bodies, ritz_linked *out)
{
    static const ritz_damping none = {0};
    const ritz_structure s = {bodies->K, bodies->M, bodies->D}; /* borrowed */
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_linked) j = {.num_rows = bodies->num_rows};
    RITZ_OWN(ritz_dense) V = {0};

    RITZ_CHECK(check_sizes(bodies));
    RITZ_CHECK_IN("unjoined bodies",
                  ritz_modal_model_new(&s, &bodies->io, &none, &modes));
    RITZ_REFUSE_IF(modes.count < bodies->n, RITZ_ERR_ARGUMENT,
                   "%" PRId64 " motions of the unjoined bodies have no mass: "
                   "constraints act on accelerations, give them some",
                   bodies->n - modes.count);
    if (bodies->num_rows > 0)
        RITZ_CHECK(ritz_dense_mul(&bodies->C, &modes.Phi, &j.G));
    else
        RITZ_CHECK(ritz_dense_new(0, bodies->n, &j.G));
    RITZ_CHECK(decompose_rows(bodies, &j, &V));
    RITZ_CHECK(turn_rows(&V, &modes.Ca, &j));
    RITZ_CHECK(turn_motion(&V, &modes, &j));
    RITZ_CHECK(find_highest(&j));
    RITZ_MOVE(*out, j);
    return RITZ_OK;
}

void ritz_linked_free(ritz_linked *joined)
{
    ritz_motion_free(&joined->motion);
    ritz_dense_free(&joined->to);
    ritz_dense_free(&joined->G);
    ritz_dense_free(&joined->L);
    ritz_dense_free(&joined->reach);
    ritz_dense_free(&joined->peak);
    RITZ_FREE(joined->redundant);
    *joined = (ritz_linked){0};
}

void ritz_unjoined_free(ritz_unjoined *bodies)
{
    ritz_dense_free(&bodies->K);
    ritz_dense_free(&bodies->M);
    ritz_dense_free(&bodies->D);
    ritz_dense_free(&bodies->C);
    ritz_dense_free(&bodies->P);
    ritz_io_free(&bodies->io);
    RITZ_FREE(bodies->scale, bodies->row);
    *bodies = (ritz_unjoined){0};
}
