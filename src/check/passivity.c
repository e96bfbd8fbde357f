/*
 * Whether energy can come out of the interface, by the response from forces to
 * the velocities of what they act on,
 *
 *     G(i w) = diag((i w)^power) (C (i w I - A)^-1 B + D)
 */
#include "base/alloc.h"
#include "base/complex.h"
#include "base/search.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "check/check.h"
#include "linear/general.h"
#include "linear/resolvent.h"
#include "linear/search.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_sampler_new(const ritz_collocated *model, ritz_sampler *s)
{
    const ritz_dense none = {0};

    s->model = model;
    RITZ_CHECK(ritz_resolvent_new(&model->A, &none, &model->B, &model->C,
                                  &s->resolvent));
    RITZ_CHECK_NEW(s->H, model->B.ncol * model->B.ncol);
    return RITZ_OK;
}

const double _Complex *ritz_sampler_at(ritz_sampler *s, double w)
{
    const ritz_dense *D = &s->model->D;
    int64_t p = D->ncol;

    for (int64_t k = 0; k < p * p; k++)
        s->H[k] = D->val[k];
    if (!ritz_resolvent_add(&s->resolvent, ritz_complex(0.0, w),
                            RITZ_SAMPLER_POLE, s->H))
        return NULL;
    for (int64_t i = 0; i < p; i++)
        for (int64_t j = 0; j < p; j++) {
            double _Complex *h = &s->H[i + j * p];

            if (s->model->power[i] > 0)
                *h *= ritz_complex(0.0, w);
            else if (s->model->power[i] < 0)
                *h *= ritz_complex(0.0, -1.0 / w);
        }
    return s->H;
}

void ritz_sampler_free(ritz_sampler *s)
{
    ritz_resolvent_free(&s->resolvent);
    free(s->H);
}

/*
 * Whether force to velocity is positive real: energy only ever flows in,
 *
 *     (G(i w) + G(i w)^*) / 2 >= 0     for all w
 *
 * [AndersonVongpanitlerd1973]. It is evaluated at, around and between the
 * poles, then minimised around the lowest of these points, and evaluated where
 * the pencil below shows a change of sign that the grid may have missed.
 */

/* Distances from a pole at which a frequency is placed, in units of |Re s|
   or, where that is less, of |s| / 1000. */
static const double distances[] = {0.25, 1.0, 4.0};
enum { DESCENTS = 3, MOST_STATES = 200, PER_POLE = 9 };

/* The search for the least eigenvalue of (G + G^*) / 2. */
typedef struct descent {
    ritz_sampler sampler;
    int p;
    double _Complex *H;
    double *lambda;
    double scale; /* largest |G| so far */
    ritz_passivity found;
} descent;

static void descent_free(descent *s)
{
    ritz_sampler_free(&s->sampler);
    RITZ_FREE(s->H, s->lambda);
}

/* Sort positive frequencies, each once; returns how many are left. */
static int64_t sort_frequencies(int64_t count, double *w)
{
    int64_t kept = 0;

    qsort(w, (size_t)count, sizeof *w, ritz_ascending);
    for (int64_t k = 0; k < count; k++)
        if (w[k] > 0.0 &&
            (kept == 0 || w[k] > w[kept - 1] * (1.0 + RITZ_RANGE_ROUNDING)))
            w[kept++] = w[k];
    return kept;
}

ritz_status ritz_probe_grid(const ritz_dense *A, int64_t *count, double **out)
{
    RITZ_OWN(ritz_eigenvalues) poles = {0};
    RITZ_OWN_ARRAY double *w = NULL;
    int64_t n = 0;
    int64_t alone = 0;

    RITZ_CHECK(ritz_eigenvalues_of(A, &poles));
    RITZ_CHECK_NEW(w, 2 * (PER_POLE * poles.count + 2));
    for (int64_t k = 0; k < poles.count; k++) {
        double size = hypot(poles.re[k], poles.im[k]);
        double width = fmax(fabs(poles.re[k]), RITZ_LEAST_WIDTH * size);

        w[n++] = size;
        w[n++] = fabs(poles.im[k]);
        for (size_t i = 0; i < sizeof distances / sizeof *distances; i++) {
            w[n++] = fabs(poles.im[k]) - distances[i] * width;
            w[n++] = fabs(poles.im[k]) + distances[i] * width;
        }
    }
    n = sort_frequencies(n, w);
    if (n == 0)
        w[n++] = 1.0;
    w[n] = 0.1 * w[0]; /* below all, above all, and between adjacent ones */
    w[n + 1] = 10.0 * w[n - 1];
    alone = n;
    n += 2;
    for (int64_t k = 1; k < alone; k++)
        w[n++] = sqrt(w[k - 1] * w[k]);
    *count = sort_frequencies(n, w);
    RITZ_MOVE(*out, w);
    return RITZ_OK;
}

/* Least eigenvalue over |G| at w; 1 where there is no response. */
static double meet_at(descent *s, double w)
{
    const double _Complex *G = ritz_sampler_at(&s->sampler, w);
    double size = 0.0;
    double value = 1.0;
    int p = s->p;

    for (int64_t k = 0; G && k < (int64_t)p * p; k++)
        size = hypot(size, cabs(G[k]));
    if (!G || !isfinite(size) || size == 0.0)
        return 1.0;
    s->scale = fmax(s->scale, size);
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            s->H[i + j * p] = 0.5 * (G[i + j * p] + conj(G[j + i * p]));
    if (LAPACKE_zheev(LAPACK_COL_MAJOR, 'V', 'L', p, s->H, p, s->lambda) != 0)
        return 1.0;
    value = s->lambda[0] / size;
    if (value < s->found.value) {
        s->found.value = value;
        s->found.hertz = w / (2.0 * RITZ_PI);
        s->found.port = 0;
        for (int64_t i = 1; i < p; i++)
            if (cabs(s->H[i]) > cabs(s->H[s->found.port]))
                s->found.port = i;
    }
    return value;
}

static ritz_status ease_at(void *state, double w, double *value)
{
    *value = -meet_at(state, w);
    return RITZ_OK;
}

/* Golden section for the least value between two points. */
static ritz_status descend_between(descent *s, double low, double high)
{
    const ritz_curve curve = {ease_at, s};
    double most = 0.0;

    return ritz_curve_between(&curve, RITZ_PEAK_PLACED, &low, &high, &most);
}

/* Around the lowest points of the grid, up to the adjacent points. */
static ritz_status descend_all(descent *s, int64_t count, const double *w,
                               double *value)
{
    for (int turn = 0; turn < DESCENTS; turn++) {
        int64_t at = 0;

        for (int64_t k = 1; k < count; k++)
            if (value[k] < value[at])
                at = k;
        if (value[at] >= 1.0)
            return RITZ_OK;
        RITZ_CHECK(descend_between(s, at > 0 ? w[at - 1] : 0.5 * w[at],
                                   at + 1 < count ? w[at + 1] : 2.0 * w[at]));
        for (int64_t k = at > 0 ? at - 1 : 0; k <= at + 1 && k < count; k++)
            value[k] = 1.0;
    }
    return RITZ_OK;
}

/* At the crossings, and between each two of them. */
static ritz_status meet_crossings(descent *s, const ritz_collocated *model)
{
    RITZ_OWN_ARRAY double *w = NULL;
    int64_t count = 0;

    if (model->A.nrow > MOST_STATES || s->scale == 0.0)
        return RITZ_OK;
    RITZ_CHECK(
        ritz_passivity_crossings(model, RITZ_PASSIVE * s->scale, &count, &w));
    for (int64_t k = 0; k < count; k++) {
        meet_at(s, w[k]);
        meet_at(s, k > 0 ? sqrt(w[k - 1] * w[k]) : 0.5 * w[k]);
        if (k + 1 == count)
            meet_at(s, 2.0 * w[k]);
    }
    return RITZ_OK;
}

ritz_status ritz_passivity_of(const ritz_collocated *model, ritz_passivity *out)
{
    RITZ_OWN(descent) s = {.p = (int)model->B.ncol, .found = {.value = 1.0}};
    RITZ_OWN_ARRAY double *w = NULL, *value = NULL;
    int64_t count = 0;

    RITZ_CHECK(ritz_sampler_new(model, &s.sampler));
    RITZ_CHECK_NEW(s.H, (int64_t)s.p * s.p);
    RITZ_CHECK_NEW(s.lambda, s.p);
    RITZ_CHECK(ritz_probe_grid(&model->A, &count, &w));
    RITZ_CHECK_NEW(value, count);
    for (int64_t k = 0; k < count; k++)
        value[k] = meet_at(&s, w[k]);
    RITZ_CHECK(descend_all(&s, count, w, value));
    RITZ_CHECK(meet_crossings(&s, model));
    *out = s.found;
    return RITZ_OK;
}

/*
 * Where on the axis G + G^* may become singular [Boyd1989]: eigenvalues of
 *
 *     [ A  0   B      ]     [ I 0 0 ]
 *     [ 0 -A' -C'     ] - s [ 0 I 0 ]
 *     [ C  B'  D + D' ]     [ 0 0 0 ]
 */

/* Outputs as velocities: C A and C B of displacements. */
static ritz_status take_velocities(const ritz_collocated *model, ritz_dense *C,
                                   ritz_dense *D)
{
    RITZ_OWN(ritz_dense) CA = {0}, CB = {0};

    RITZ_CHECK(ritz_dense_mul(&model->C, &model->A, &CA));
    RITZ_CHECK(ritz_dense_mul(&model->C, &model->B, &CB));
    for (int64_t i = 0; i < CA.nrow; i++) {
        if (model->power[i] == 1)
            continue;
        for (int64_t j = 0; j < CA.ncol; j++)
            ritz_dense_col(&CA, j)[i] = ritz_dense_col(&model->C, j)[i];
        for (int64_t j = 0; j < CB.ncol; j++)
            ritz_dense_col(&CB, j)[i] = ritz_dense_col(&model->D, j)[i];
    }
    RITZ_MOVE(*C, CA);
    RITZ_MOVE(*D, CB);
    return RITZ_OK;
}

static ritz_status build_pencil(const ritz_collocated *model, double slack,
                                ritz_dense *P, ritz_dense *Q)
{
    const ritz_dense *A = &model->A, *B = &model->B;
    int64_t n = A->nrow, p = B->ncol, all = 2 * n + p;
    RITZ_OWN(ritz_dense) C = {0}, D = {0};

    RITZ_CHECK(take_velocities(model, &C, &D));
    RITZ_CHECK(ritz_dense_new(all, all, P));
    RITZ_CHECK(ritz_dense_new(all, all, Q));
    for (int64_t j = 0; j < 2 * n; j++)
        ritz_dense_col(Q, j)[j] = 1.0;
    ritz_general_place(1.0, A, false, 0, 0, P);
    ritz_general_place(-1.0, A, true, n, n, P);
    ritz_general_place(1.0, B, false, 0, 2 * n, P);
    ritz_general_place(-1.0, &C, true, n, 2 * n, P);
    ritz_general_place(1.0, &C, false, 2 * n, 0, P);
    ritz_general_place(1.0, B, true, 2 * n, n, P);
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(P, 2 * n + j)[2 * n + i] =
                ritz_dense_col(&D, j)[i] + ritz_dense_col(&D, i)[j] +
                (i == j ? 2.0 * slack : 0.0);
    return RITZ_OK;
}

ritz_status ritz_passivity_crossings(const ritz_collocated *model, double slack,
                                     int64_t *count, double **out)
{
    RITZ_OWN(ritz_dense) P = {0}, Q = {0};
    RITZ_OWN_ARRAY double *re = NULL, *im = NULL, *beta = NULL, *w = NULL;
    int all = 0;
    int64_t found = 0;

    *count = 0;
    for (int64_t i = 0; i < model->B.ncol; i++)
        if (model->power[i] < 0) /* an integrator is on the axis itself */
            return RITZ_OK;
    RITZ_CHECK(build_pencil(model, slack, &P, &Q));
    all = (int)P.nrow;
    RITZ_CHECK_NEW(re, all);
    RITZ_CHECK_NEW(im, all);
    RITZ_CHECK_NEW(beta, all);
    RITZ_CHECK_NEW(w, all);
    RITZ_REFUSE_IF(LAPACKE_dggev(LAPACK_COL_MAJOR, 'N', 'N', all, P.val, all,
                                 Q.val, all, re, im, beta, NULL, 1, NULL,
                                 1) != 0,
                   RITZ_ERR_CONVERGENCE,
                   "eigenvalues of a Hamiltonian pencil were not found");
    for (int64_t k = 0; k < all; k++)
        if (beta[k] > 0.0 && im[k] > 0.0 &&
            fabs(re[k]) <= RITZ_PENCIL_ON_AXIS * im[k] &&
            isfinite(im[k] / beta[k]))
            w[found++] = im[k] / beta[k];
    *count = sort_frequencies(found, w);
    RITZ_MOVE(*out, w);
    return RITZ_OK;
}

/*
 * Pairs of an input and an output of one name in a state space: a force, and
 * the displacement, velocity or acceleration of where it acts.
 */

/* Some inputs and outputs of a model with D, in their order. */
static ritz_status pick_pairs(const ritz_dense *A, const ritz_dense *B,
                              const ritz_dense *C, const ritz_dense *D,
                              const ritz_dofs at[2], ritz_collocated *out)
{
    RITZ_OWN(ritz_dense) rows = {0};

    RITZ_CHECK(ritz_dense_copy(A, &out->A));
    RITZ_CHECK(ritz_dense_pick(B, at[0].count, at[0].at, &out->B));
    RITZ_CHECK(ritz_dense_rows(C, at[1].count, at[1].at, &out->C));
    RITZ_CHECK(ritz_dense_rows(D, at[1].count, at[1].at, &rows));
    RITZ_CHECK(ritz_dense_pick(&rows, at[0].count, at[0].at, &out->D));
    RITZ_CHECK_NEW(out->power, at[0].count);
    RITZ_CHECK_NEW(out->name, at[0].count);
    return RITZ_OK;
}

static ritz_status take_pairs(const ritz_state_space *model,
                              ritz_collocated *out)
{
    const ritz_names outputs = {.count = model->num_outputs,
                                .first = (const char *)model->output,
                                .stride = sizeof *model->output};
    RITZ_OWN_ARRAY int64_t *in = NULL, *to = NULL;
    int64_t p = 0;

    RITZ_CHECK_NEW(in, model->num_inputs);
    RITZ_CHECK_NEW(to, model->num_inputs);
    for (int64_t j = 0; j < model->num_inputs; j++) {
        to[p] = ritz_names_index(&outputs, model->input[j]);
        in[p] = j;
        p += to[p] >= 0;
    }
    RITZ_CHECK(pick_pairs(&model->A, &model->B, &model->C, &model->D,
                          (ritz_dofs[2]){{p, in}, {p, to}}, out));
    for (int64_t j = 0; j < p; j++)
        memcpy(out->name[j], model->input[in[j]], sizeof *out->name);
    if (model->E.val) {
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &out->A));
        RITZ_CHECK_IN("E", ritz_general_solve(&model->E, false, &out->B));
    }
    return RITZ_OK;
}

/* Take output i for the quantity that violates passivity least, a
   displacement if equal. */
static ritz_status guess_quantity(const ritz_collocated *all, int64_t i)
{
    static const int powers[] = {1, 0, -1};
    const ritz_dofs at[2] = {{1, &i}, {1, &i}};
    RITZ_OWN(ritz_collocated) one = {0};
    double best = -HUGE_VAL;

    RITZ_CHECK(pick_pairs(&all->A, &all->B, &all->C, &all->D, at, &one));
    for (size_t k = 0; k < sizeof powers / sizeof *powers; k++) {
        ritz_passivity found = {0};

        *one.power = powers[k];
        RITZ_CHECK(ritz_passivity_of(&one, &found));
        if (found.value > best + RITZ_PASSIVE) {
            best = found.value;
            all->power[i] = powers[k];
        }
    }
    return RITZ_OK;
}

ritz_status ritz_collocated_of_space(const ritz_state_space *model,
                                     ritz_collocated *out)
{
    RITZ_OWN(ritz_collocated) pairs = {0};

    RITZ_CHECK(take_pairs(model, &pairs));
    for (int64_t i = 0; i < pairs.B.ncol; i++)
        RITZ_CHECK(guess_quantity(&pairs, i));
    RITZ_MOVE(*out, pairs);
    return RITZ_OK;
}

/* Whether energy can come out of the interface, and where it does. */

/* Add B, C and D to A: from interface forces to interface velocities. */
static ritz_status take_rows(const ritz_checker *it, ritz_collocated *pairs)
{
    const ritz_modal_model *modes = &it->modes;
    int64_t m = modes->count, first = m - modes->num_rigid;
    RITZ_OWN(ritz_dense) LPhi = {0};
    int64_t p = 0;

    RITZ_CHECK(ritz_dense_mul(&it->L, &modes->Phi, &LPhi));
    RITZ_CHECK(ritz_dense_new(first + m, LPhi.nrow, &pairs->B));
    RITZ_CHECK_NEW(pairs->name, LPhi.nrow);
    for (int64_t i = 0; i < LPhi.nrow; i++) {
        double size = 0.0;

        for (int64_t j = 0; j < m; j++)
            size = hypot(size, ritz_dense_col(&LPhi, j)[i]);
        if (size == 0.0) /* a motion without mass stores energy only */
            continue;
        for (int64_t j = 0; j < m; j++)
            ritz_dense_col(&pairs->B, p)[first + j] =
                ritz_dense_col(&LPhi, j)[i] / size;
        memcpy(pairs->name[p++], it->row[i], sizeof *pairs->name);
    }
    pairs->B.ncol = p;
    RITZ_CHECK_NEW(pairs->power, p);
    RITZ_CHECK(ritz_general_transpose(&pairs->B, &pairs->C));
    return ritz_dense_new(p, p, &pairs->D);
}

void ritz_collocated_free(ritz_collocated *model)
{
    ritz_dense_free(&model->A);
    ritz_dense_free(&model->B);
    ritz_dense_free(&model->C);
    ritz_dense_free(&model->D);
    RITZ_FREE(model->power, model->name);
    *model = (ritz_collocated){0};
}

/* "tip (displacement), root (velocity)": the assumed quantities of pairs. */
static void name_pairs(const ritz_collocated *pairs,
                       char where[RITZ_WHERE_SIZE])
{
    static const char *const quantity[] = {"acceleration", "velocity",
                                           "displacement"};

    where[0] = '\0';
    for (int64_t i = 0; i < pairs->B.ncol; i++) {
        char text[RITZ_WHERE_SIZE];

        snprintf(text, sizeof text, "%s (%s)", pairs->name[i],
                 quantity[pairs->power[i] + 1]);
        ritz_checker_list(where, text);
    }
}

ritz_status ritz_check_passivity(ritz_checker *it)
{
    static const char name[] = "passivity";
    ritz_collocated *pairs = &it->pairs;
    ritz_passivity found = {0};
    char where[RITZ_WHERE_SIZE] = "";

    if (ritz_checker_settled(it, name,
                             "M, K and D are semidefinite, and forces act "
                             "where velocities are met"))
        return RITZ_OK;
    if (it->reduced)
        RITZ_CHECK(take_rows(it, pairs));
    RITZ_CHECK(ritz_passivity_of(pairs, &found));
    if (found.value >= -RITZ_PASSIVE) {
        if (it->space)
            name_pairs(pairs, where);
        ritz_checker_say(it, name, found.value, -RITZ_PASSIVE, RITZ_PASS, where,
                         "no energy comes out at any frequency met");
        return RITZ_OK;
    }
    snprintf(where, sizeof where, "%.6g Hz, %s", found.hertz,
             pairs->name[found.port]);
    ritz_checker_say(it, name, found.value, -RITZ_PASSIVE, RITZ_WARN, where,
                     "energy comes out of the interface: with some passive "
                     "neighbour it can be unstable");
    return RITZ_OK;
}
