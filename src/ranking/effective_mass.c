/*
 * Effective masses: with mass-normalised modes and rigid motions r_d of all of
 * the model, three translations and three rotations about the basic origin,
 *
 *     m_kd = (phi_k' M r_d)^2,    sum_k m_kd = r_d' M r_d
 *
 * over all modes of a supported model. They are the mass that acts through a
 * mode when the support is shaken. The value of a mode is its largest fraction,
 * max_d m_kd / r_d' M r_d.
 *
 * [Girard2008]
 */
#include "ranking/clusters.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"

#include <ritz/ranking.h>

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

/* The effective masses, from which two rankings are made. */

enum { RITZ_MASS_PARTS = 6 };

/* Effective masses in six directions as the parts of a ranking. */
static ritz_status fill_mass_parts(const ritz_rank_request *request,
                                   ritz_ranking *ranking)
{
    static const char *const direction[RITZ_MASS_PARTS] = {
        "x", "y", "z", "about x", "about y", "about z"};
    const ritz_dense *L = &request->momentum;

    RITZ_CHECK(ritz_ranking_parts(RITZ_MASS_PARTS, ranking));
    for (int64_t d = 0; d < RITZ_MASS_PARTS; d++) {
        RITZ_CHECK(ritz_name_copy(direction[d], ranking->part[d]));
        ranking->whole[d] = request->rigid[7 * d];
        for (int64_t k = 0; k < L->ncol; k++) {
            double l = ritz_dense_col(L, k)[d];

            ritz_dense_col(&ranking->parts, d)[k] = l * l;
        }
    }
    return RITZ_OK;
}

/* The largest fraction of mode k; the parts of a cluster are summed first. */
static double largest_fraction(const ritz_ranking *ranking, int64_t first,
                               int64_t last)
{
    double largest = 0.0;

    for (int64_t d = 0; d < ranking->num_parts; d++) {
        double sum = 0.0;

        for (int64_t k = first; k < last; k++)
            sum += ritz_dense_col(&ranking->parts, d)[k];
        if (ranking->whole[d] > 0.0)
            largest = fmax(largest, sum / ranking->whole[d]);
    }
    return largest;
}

static ritz_status rank_masses(const ritz_rank_request *request,
                               ritz_ranking *ranking)
{
    int64_t last = 0;
    double largest = 0.0;

    RITZ_CHECK(fill_mass_parts(request, ranking));
    for (int64_t first = 0; first < ranking->count; first = last) {
        last = ritz_cluster_end(ranking->count, ranking->cluster, first);
        for (int64_t k = first; k < last; k++)
            ranking->value[k] = largest_fraction(ranking, first, last);
        largest = fmax(largest, ranking->value[first]);
    }
    RITZ_REFUSE_IF(
        !(largest > RITZ_NO_MASS_SHARE), RITZ_ERR_ARGUMENT,
        "rigid modes carry all of the mass of a free model, flexible ones "
        "none: hold it, or take effective-interface-mass of fixed-interface "
        "modes");
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_effective_mass = {
    .name = "effective-mass",
    .summary = "largest share of the mass, in six rigid directions",
    .reference = "Girard2008",
    .needs = RITZ_RANK_MOMENTUM,
    .rank = rank_masses,
};

/*
 * Effective interface masses: of a component in fixed-interface modes and
 * constraint modes,
 *
 *     M = [M_s  P'; P  I],   P = Phi' M Psi,
 *
 * the effective mass of mode k for motion of the interface is P_k' P_k. All
 * modes of the full component together give M_s less the mass of the interface
 * dofs themselves. As interfaces mix translations and rotations, the value is
 * free of units,
 *
 *     s_k = trace(M_s^-1 P_k'P_k) / p = P_k M_s^-1 P_k' / p,    sum_k s_k <= 1
 *
 * p being the rank of M_s. If the interface moves as a rigid body, this is a
 * weighted sum of the effective masses of the component clamped there, which
 * are its parts.
 *
 * [KammerTriller1996]
 */

/*
 * X' X = M_s^-1 on the motions that have mass: with S = diag(M_s)^-1/2 and
 * S M_s S = V Lambda V', X = Lambda^-1/2 V' S.
 */
static ritz_status invert_mass(const ritz_dense *M_s, ritz_dense *X)
{
    int64_t p = M_s->nrow, r = 0;
    RITZ_OWN(ritz_dense) V = {0};
    RITZ_OWN_ARRAY double *scale = NULL, *lambda = NULL;

    RITZ_CHECK_NEW(scale, p);
    RITZ_CHECK_NEW(lambda, p);
    RITZ_CHECK(ritz_dense_copy(M_s, &V));
    for (int64_t i = 0; i < p; i++) {
        double m = ritz_dense_col(M_s, i)[i];

        scale[i] = m > 0.0 ? 1.0 / sqrt(m) : 0.0;
    }
    for (int64_t k = 0; k < p * p; k++)
        V.val[k] *= scale[k % p] * scale[k / p];
    RITZ_REFUSE_IF(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'L', (int)p, V.val,
                                 (int)p, lambda) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "the mass of the interface has no eigenvalues");
    while (r < p && !(lambda[r] > RITZ_NEGLIGIBLE * lambda[p - 1]))
        r++;
    RITZ_CHECK(ritz_dense_new(p - r, p, X));
    for (int64_t i = 0; i < p; i++)
        for (int64_t k = r; k < p; k++)
            ritz_dense_col(X, i)[k - r] =
                ritz_dense_col(&V, k)[i] * scale[i] / sqrt(lambda[k]);
    return RITZ_OK;
}

static ritz_status rank_interface_masses(const ritz_rank_request *request,
                                         ritz_ranking *ranking)
{
    RITZ_OWN(ritz_dense) X = {0}, Y = {0};

    RITZ_CHECK(invert_mass(&request->interface, &X));
    RITZ_CHECK(ritz_dense_mul(&X, &request->coupling, &Y));
    for (int64_t k = 0; k < Y.ncol; k++)
        for (int64_t i = 0; i < Y.nrow; i++)
            ranking->value[k] += ritz_dense_col(&Y, k)[i] *
                                 ritz_dense_col(&Y, k)[i] / (double)Y.nrow;
    if (request->momentum.val)
        RITZ_CHECK(fill_mass_parts(request, ranking));
    ranking->total = 0.0;
    for (int64_t k = 0; k < Y.ncol; k++)
        ranking->total += ranking->value[k];
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_effective_interface_mass = {
    .name = "effective-interface-mass",
    .summary = "share of fixed-interface modes in the interface's mass",
    .reference = "KammerTriller1996",
    .needs = RITZ_RANK_INTERFACE,
    .sums = true,
    .rank = rank_interface_masses,
};

/*
 * Modal participation: how strongly inputs excite a mode. With mass-normalised
 * modes
 *
 *     q_k'' + 2 zeta w q_k' + w^2 q_k = b_k u
 *
 * b_kj is the factor of mode k from input j, and the value |b_k|_2. For a
 * cluster, whose modes are an arbitrary basis of one space, it is the largest
 * singular value of its rows, and the part of an input is their norm.
 *
 * [Girard2008]
 */

static void fill_parts(const ritz_dense *B, int64_t first, int64_t last,
                       ritz_dense *parts)
{
    for (int64_t j = 0; j < B->ncol; j++) {
        const double *b = ritz_dense_col(B, j);
        double norm = 0.0;

        for (int64_t k = first; k < last; k++)
            norm = hypot(norm, b[k]);
        for (int64_t k = first; k < last; k++)
            ritz_dense_col(parts, j)[k] = norm;
    }
}

static ritz_status rank_participation(const ritz_rank_request *request,
                                      ritz_ranking *ranking)
{
    const ritz_dense *B = &request->modal.B;
    int64_t last = 0;

    RITZ_CHECK(ritz_ranking_parts(B->ncol, ranking));
    for (int64_t j = 0; j < B->ncol; j++) {
        ritz_ranking_name_part(request->input, "u", j, ranking->part[j]);
        ranking->whole[j] = nan("");
    }
    for (int64_t first = 0; first < ranking->count; first = last) {
        RITZ_OWN(ritz_dense) rows = {0};

        last = ritz_cluster_end(ranking->count, ranking->cluster, first);
        RITZ_CHECK(ritz_dense_block(B, first, last - first, 0, B->ncol, &rows));
        RITZ_CHECK(ritz_general_norm(&rows, &ranking->value[first]));
        for (int64_t k = first + 1; k < last; k++)
            ranking->value[k] = ranking->value[first];
        fill_parts(B, first, last, &ranking->parts);
    }
    return RITZ_OK;
}

const ritz_ranker ritz_ranker_participation = {
    .name = "participation",
    .summary = "how strongly inputs excite each mode (or cluster)",
    .reference = "Girard2008",
    .needs = RITZ_RANK_INPUTS,
    .rank = rank_participation,
};
