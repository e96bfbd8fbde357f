/*
 * Damping ratios of the modes above those of `pairs`, for components with too
 * many modes to compute. The rates d of these modes change a response by
 *
 *     sum_k -i w d_k / (z_k (z_k + i w d_k)) c phi_k phi_k'b,
 *
 * which has the form c f(A) b with A = M^-1 K in the space of the modes above,
 * and an f that falls like lambda^(-3/2). Instead of modes, the Ritz pairs of A
 * are used in the rational Krylov space of all loads and outputs,
 *
 *     V = [V_1, V_2, ...],
 *     V_j = [S_j W, S_j M S_j W, ..., (S_j M)^(R-1) S_j W],
 *     S_j = (K + t_j M)^-1,   W = (I - M Phi Phi') [B, C', Cv', Ca'].
 *
 * The poles -t_j are spread evenly in log(t) from the first eigenvalue to the
 * largest. Each of them then reduces the error by a constant factor, as in
 * rational approximations of the square root, and by the square of that because
 * the space contains both b and c. A factor costs far more than solves with it,
 * so each pole gives R blocks. R is as large as the limit on the columns of V
 * allows if all levels are needed; it is 1 where W has many columns. Each level
 * halves the distances between the poles. The difference between two levels is
 * the error of the former, and is reported as that of the latter.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/orthonormal.h"
#include "model/modal.h"
#include "poles/poles.h"

#include <ritz/base.h>

#include <complex.h>
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Level 0 has poles at both ends; each level adds poles half way between those
   that exist, so that the last one makes them 2^(LEVELS - 1) + 1 =
   MOST_POLES. */
enum { LEVELS = 6, MOST_POLES = 33, MOST_COLUMNS = 800, SAMPLES = 6 };

/* Index of a mode beyond a list of ratios, which has the last ratio of the
   list. */
enum { BEYOND_LISTED = RITZ_MOST_RATIOS };

typedef struct ratio_space {
    const ritz_component *component;
    const ritz_damping *damping;
    const ritz_pairs *pairs;
    ritz_dense MPhi;
    ritz_dense loads;      /* W, without zero columns */
    ritz_sparse A;         /* K + low M, in which V is orthonormal */
    ritz_orthonormal set;  /* V */
    double low, high;      /* range of t_j */
    ritz_io modes;         /* inputs and outputs of the known modes */
    double hertz[SAMPLES]; /* frequencies at which levels are compared */
    int64_t values;
    double _Complex *H, *last; /* SAMPLES x values: changes by ratios at this
                                  and the former level */
    double *scale;             /* values: magnitude that errors of each channel
                                  are relative to */
} ratio_space;

static void ratio_space_free(ratio_space *s)
{
    ritz_dense_free(&s->MPhi);
    ritz_dense_free(&s->loads);
    ritz_orthonormal_free(&s->set);
    ritz_sparse_free(&s->A);
    ritz_io_free(&s->modes);
    RITZ_FREE(s->H, s->last, s->scale);
}

/* Append the columns of X to the loads, without their part in the known modes,
   unless all are zero. */
static ritz_status add_loads(const ratio_space *s, const ritz_dense *X,
                             ritz_dense *loads)
{
    RITZ_OWN(ritz_dense) part = {0}, both = {0};

    if (ritz_dense_max(X) == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(X, &part));
    RITZ_CHECK(ritz_dense_take_out(&s->MPhi, &s->pairs->Phi, &part));
    RITZ_CHECK(ritz_dense_beside(loads, &part, &both));
    ritz_dense_free(loads);
    RITZ_MOVE(*loads, both);
    return RITZ_OK;
}

static ritz_status gather_loads(ratio_space *s)
{
    const ritz_io *io = &s->component->io;
    const ritz_dense *const rows[] = {&io->C, &io->Cv, &io->Ca};

    RITZ_CHECK(ritz_sparse_mul(&s->component->M, &s->pairs->Phi, &s->MPhi));
    RITZ_CHECK(ritz_dense_new(s->component->num_dofs, 0, &s->loads));
    RITZ_CHECK(add_loads(s, &io->B, &s->loads));
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_dense) columns = {0};

        RITZ_CHECK(ritz_general_transpose(rows[k], &columns));
        RITZ_CHECK(add_loads(s, &columns, &s->loads));
    }
    return RITZ_OK;
}

/*
 * Range of t_j: from the last known eigenvalue to the largest one, estimated as
 * twice the largest K_jj / M_jj.
 */
static void place_ends(double out_hz, ratio_space *s)
{
    const ritz_component *c = s->component;
    const int64_t m = s->pairs->Phi.ncol;

    s->low = m > s->pairs->num_rigid ? s->pairs->lambda[m - 1]
                                     : ritz_eigen_lambda(out_hz);
    s->high = s->low;
    for (int64_t j = 0; j < c->num_dofs; j++) {
        double mass = ritz_sparse_diagonal(&c->M, j);

        if (mass > 0.0)
            s->high =
                fmax(s->high, 2.0 * ritz_sparse_diagonal(&c->K, j) / mass);
    }
    s->high = fmin(s->high, s->low / RITZ_RATIO_REACH);
}

/* Response of the known modes, which errors are relative to. */
static void respond_modes(const ratio_space *s, double hertz,
                          double _Complex *H)
{
    const ritz_io *io = &s->modes;
    const double w2 = ritz_eigen_lambda(hertz);
    const double w = sqrt(w2);

    for (int64_t k = 0; k < s->pairs->Phi.ncol; k++) {
        double lambda = s->pairs->lambda[k];
        int64_t flexible = k - s->pairs->num_rigid;
        double _Complex z = ritz_complex(
            lambda - w2, w * ritz_modal_rate(s->damping, flexible, lambda));

        for (int64_t i = 0; i < io->num_outputs; i++) {
            double _Complex c =
                ritz_complex(ritz_dense_col(&io->C, k)[i] -
                                 w2 * ritz_dense_col(&io->Ca, k)[i],
                             w * ritz_dense_col(&io->Cv, k)[i]);

            for (int64_t j = 0; cabs(z) > 0.0 && j < io->num_inputs; j++)
                H[i * io->num_inputs + j] +=
                    c / z * ritz_dense_col(&io->B, j)[k];
        }
    }
}

/*
 * Largest |H| of each channel in the upper half of the range, a lower bound of
 * the channel's largest |H|. The range ends at a third of the frequency up to
 * which modes are known.
 */
static ritz_status find_scales(double out_hz, const ritz_residual *r,
                               ratio_space *s)
{
    const ritz_io *io = &s->component->io;
    const double to_hz = out_hz / 3.0;
    RITZ_OWN_ARRAY double _Complex *H = NULL;

    s->values = io->num_outputs * io->num_inputs;
    RITZ_CHECK(ritz_io_project(io, &s->pairs->Phi, &s->modes));
    RITZ_CHECK_NEW(s->H, SAMPLES * s->values);
    RITZ_CHECK_NEW(s->last, SAMPLES * s->values);
    RITZ_CHECK_NEW(s->scale, s->values);
    RITZ_CHECK_NEW(H, s->values);
    for (int k = 0; k < SAMPLES; k++) {
        s->hertz[k] = to_hz * (0.5 + 0.5 * (k + 1) / SAMPLES);
        memset(H, 0, (size_t)s->values * sizeof *H);
        respond_modes(s, s->hertz[k], H);
        ritz_residual_add(r, s->hertz[k], H);
        for (int64_t v = 0; v < s->values; v++)
            s->scale[v] = fmax(s->scale[v], cabs(H[v]));
    }
    ritz_channel_scales(io->num_outputs, io->num_inputs, s->scale, s->scale);
    return RITZ_OK;
}

/* R, the number of blocks of each pole. It is 1 if ratios are given by bands:
   f then jumps at their edges, and what matters is the number of poles, near
   which Ritz values lie. */
static int64_t count_blocks(const ratio_space *s)
{
    const int64_t room = MOST_COLUMNS / (MOST_POLES * s->loads.ncol);

    return room > 1 && s->damping->kind != RITZ_DAMPING_BANDS ? room : 1;
}

/* X := S X without its part in the known modes. Append the part of it that V
   does not contain to V, as far as there is room. */
static ritz_status append_block(ratio_space *s, ritz_factor *S, ritz_dense *X)
{
    RITZ_CHECK(ritz_factor_solve(S, X));
    for (int pass = 0; pass < 2; pass++)
        RITZ_CHECK(ritz_dense_take_out(&s->pairs->Phi, &s->MPhi, X));
    return ritz_orthonormal_append(&s->set, X, MOST_COLUMNS - s->set.count,
                                   NULL);
}

/* Append the blocks of one pole, each made from the columns that the block
   before added to V. */
static ritz_status add_pole(ratio_space *s, double t)
{
    const ritz_component *c = s->component;
    const int64_t blocks = count_blocks(s);
    RITZ_OWN(ritz_factor) *S = NULL;
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_dense) X = {0};

    if (s->set.count >= MOST_COLUMNS)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_add(1.0, &c->K, t, &c->M, &A));
    RITZ_CHECK_IN("modes above the band", ritz_factor_spd(&A, &S));
    RITZ_CHECK(ritz_dense_copy(&s->loads, &X));
    for (int64_t k = 0; k < blocks && X.ncol > 0; k++) {
        const int64_t before = s->set.count;
        ritz_dense last = {0}; /* borrowed */

        RITZ_CHECK(append_block(s, S, &X));
        last = ritz_dense_part(&s->set.V, before, s->set.count - before);
        ritz_dense_free(&X);
        RITZ_CHECK(ritz_sparse_mul(&c->M, &last, &X));
    }
    return RITZ_OK;
}

/* Add the poles of one level, spread evenly in log(t). */
static ritz_status add_level(ratio_space *s, int level)
{
    const double reach = log(s->high / s->low);
    const int parts = 1 << level;

    if (level == 0)
        RITZ_CHECK(add_pole(s, s->low));
    for (int k = 1; k <= parts; k += 2)
        RITZ_CHECK(add_pole(s, s->low * exp(reach * k / parts)));
    return RITZ_OK;
}

/*
 * Ritz pairs lambda = 1 / kappa - low, X = V y, from V'MV y = kappa y with V'(K
 * + low M)V = I. Motions without mass, kappa = 0, are left out.
 */
static ritz_status find_pairs(const ratio_space *s, ritz_dense *X,
                              double **lambda)
{
    RITZ_OWN(ritz_dense) V = {0}, MV = {0}, G = {0}, Y = {0};
    RITZ_OWN_ARRAY double *kappa = NULL;
    int64_t first = 0;

    RITZ_CHECK(ritz_dense_columns(&s->set.V, 0, s->set.count, &V));
    RITZ_CHECK(ritz_sparse_mul(&s->component->M, &V, &MV));
    RITZ_CHECK(ritz_dense_mul_tn(&V, &MV, &G));
    ritz_dense_symmetrise(&G);
    RITZ_CHECK_NEW(kappa, G.ncol);
    RITZ_REFUSE_IF(G.ncol > 0 &&
                       LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', (int)G.ncol,
                                      G.val, (int)G.ncol, kappa) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "Ritz values of the modes above the band were not found");
    while (first < G.ncol &&
           kappa[first] <= RITZ_RATIO_REACH * kappa[G.ncol - 1])
        first++;
    RITZ_CHECK(ritz_dense_columns(&G, first, G.ncol - first, &Y));
    RITZ_CHECK_NEW(*lambda, Y.ncol);
    for (int64_t k = 0; k < Y.ncol; k++) {
        double found = kappa[first + k];

        (*lambda)[k] = 1.0 / found - s->low;
        for (int64_t i = 0; i < Y.nrow; i++)
            ritz_dense_col(&Y, k)[i] /= sqrt(found);
    }
    return ritz_dense_mul(&V, &Y, X);
}

/* Store the Ritz pairs of this level and their rates in the residual. */
static ritz_status take_rates(const ratio_space *s, ritz_residual *r)
{
    RITZ_OWN(ritz_dense) X = {0};

    RITZ_FREE(r->lambda, r->rate);
    r->lambda = r->rate = NULL;
    ritz_io_free(&r->modes);
    RITZ_CHECK(find_pairs(s, &X, &r->lambda));
    r->num_damped = X.ncol;
    RITZ_CHECK_NEW(r->rate, r->num_damped);
    for (int64_t k = 0; k < r->num_damped; k++)
        r->rate[k] = ritz_modal_rate(s->damping, BEYOND_LISTED, r->lambda[k]);
    return ritz_io_project(&s->component->io, &X, &r->modes);
}

static void respond_rates(const ratio_space *s, const ritz_residual *r,
                          double _Complex *H)
{
    memset(H, 0, (size_t)(SAMPLES * s->values) * sizeof *H);
    for (int k = 0; k < SAMPLES; k++)
        ritz_residual_add_ratios(r, s->hertz[k], H + k * s->values);
}

/* Largest difference between the responses of two levels, relative to the scale
   of each channel. */
static double compare_levels(const ratio_space *s)
{
    double worst = 0.0;

    for (int64_t e = 0; e < SAMPLES * s->values; e++) {
        double change = cabs(s->H[e] - s->last[e]);

        if (change > 0.0)
            worst = fmax(worst, change / s->scale[e % s->values]);
    }
    return worst;
}

/*
 * Uncertainty because a list has ratios for modes that are not known: which
 * Ritz vectors they belong to is not known. It is the difference between all
 * Ritz vectors with the largest of these ratios and all with the smallest.
 */
static double spread_of_list(ratio_space *s, ritz_residual *r)
{
    const ritz_damping *damping = s->damping;
    const int64_t first = s->pairs->Phi.ncol - s->pairs->num_rigid;
    const double last = damping->ratio[damping->count - 1];
    double least = last, most = last;

    for (int64_t k = first; k < damping->count; k++) {
        least = fmin(least, damping->ratio[k]);
        most = fmax(most, damping->ratio[k]);
    }
    if (!(most > least))
        return 0.0;
    for (int64_t k = 0; k < r->num_damped; k++)
        r->rate[k] = 2.0 * least * sqrt(r->lambda[k]);
    respond_rates(s, r, s->last);
    for (int64_t k = 0; k < r->num_damped; k++)
        r->rate[k] = 2.0 * most * sqrt(r->lambda[k]);
    respond_rates(s, r, s->H);
    for (int64_t k = 0; k < r->num_damped; k++)
        r->rate[k] = 2.0 * last * sqrt(r->lambda[k]);
    return compare_levels(s);
}

/* An empty space, and the scales for comparisons between levels. */
static ritz_status begin_space(double out_hz, const ritz_residual *r,
                               ratio_space *s)
{
    const ritz_component *c = s->component;

    place_ends(out_hz, s);
    RITZ_CHECK(ritz_sparse_add(1.0, &c->K, s->low, &c->M, &s->A));
    RITZ_CHECK(ritz_orthonormal_new(c->num_dofs, &s->A, RITZ_RATIO_INDEPENDENT,
                                    &s->set));
    return find_scales(out_hz, r, s);
}

ritz_status ritz_ratio_space(const ritz_component *component,
                             const ritz_damping *damping,
                             const ritz_pairs *pairs, double out_hz,
                             ritz_residual *r)
{
    RITZ_OWN(ratio_space)
    s = {.component = component, .damping = damping, .pairs = pairs};

    RITZ_CHECK(gather_loads(&s));
    if (s.loads.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(begin_space(out_hz, r, &s));
    for (int level = 0; level < LEVELS; level++) {
        RITZ_CHECK(add_level(&s, level));
        RITZ_CHECK(take_rates(&s, r));
        memcpy(s.last, s.H, (size_t)(SAMPLES * s.values) * sizeof *s.H);
        respond_rates(&s, r, s.H);
        r->uncertain = compare_levels(&s);
        ritz_monitor_step("ratios of modes above", s.set.count, 0);
        if (level > 0 && r->uncertain <= RITZ_RATIO_SETTLED)
            break;
    }
    if (damping->kind == RITZ_DAMPING_MODES)
        r->uncertain += spread_of_list(&s, r);
    return RITZ_OK;
}
