/*
 * The transfer function whose zeros are sought, of a first-order model or of a
 * second-order one by its modes.
 *
 * Which modes a channel sums: a symmetric structure has modes that are not
 * observable at its middle, but rounding makes them so: with K and M perturbed
 * by few eps of their size, mode k has of mode j, to first order,
 *
 *     mixing_jk = few eps norm_jk / |lambda_j - lambda_k|
 *
 * so a product a'phi_k is known up to n eps |a|'|phi_k| of its own sum and the
 * mixing_jk |a'phi_j| of all others; likewise the damping between two modes,
 * up to mixing_jk |Delta_jj - Delta_kk|. norm_jk is the largest eigenvalue of
 * what LAPACK was given with both: ritz_eigen_dense solves again what is far
 * below.
 */
#include "poles/poles.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "linear/split.h"
#include "model/modal.h"

#include <float.h>
#include <math.h>

/* Modes of one channel as they are summed, c + s cv over s^2 + rate s +
   lambda; modes with equal poles are one row, their participation summed.
   The rounding error of each number is in `doubt_`. */
typedef struct channel_row {
    double lambda, rate, c, cv;
    double doubt_rate, doubt_c, doubt_cv;
} channel_row;

/* A mode's input, and its output as displacement, velocity, acceleration. */
enum { FORCE, DISPLACEMENT, VELOCITY, ACCELERATION, KINDS };

/* Rounding of what is projected on modes. */
typedef struct mode_rounding {
    const ritz_modal_model *modes;
    double highest, same; /* lambda: the largest, and how near equal ones are */
    double eps;           /* of the magnitudes in a product over all dofs */
    ritz_dense value, doubt; /* modes x KINDS: a'phi_k */
    ritz_dense most;         /* |Phi|'|D||Phi| */
} mode_rounding;

static void mode_rounding_free(mode_rounding *s)
{
    ritz_dense_free(&s->value);
    ritz_dense_free(&s->doubt);
    ritz_dense_free(&s->most);
}

static double mixing_of(const mode_rounding *s, int64_t j, int64_t k)
{
    double l_j = fabs(s->modes->lambda[j]), l_k = fabs(s->modes->lambda[k]);
    double norm = fmin(s->highest, fmax(l_j, l_k) / RITZ_EIGEN_FAR_BELOW);
    double gap = fabs(s->modes->lambda[j] - s->modes->lambda[k]);

    return RITZ_BACKWARD_ERROR * DBL_EPSILON * norm < gap
               ? RITZ_BACKWARD_ERROR * DBL_EPSILON * norm / gap
               : 1.0;
}

static mode_rounding rounding_of(const ritz_modal_model *modes)
{
    int64_t m = modes->count;
    double highest = m > 0 ? fabs(modes->lambda[m - 1]) : 0.0;

    return (mode_rounding){
        .modes = modes,
        .highest = highest,
        .same = (double)modes->num_dofs * DBL_EPSILON * highest,
        .eps = ((double)modes->num_dofs + RITZ_BACKWARD_ERROR) * DBL_EPSILON};
}

/* a'phi_k of all modes; of equal poles only the sum matters. */
static void project_rows(const mode_rounding *s, const double *a, double *value,
                         double *doubt)
{
    const double *lambda = s->modes->lambda;

    for (int64_t k = 0; k < s->modes->count; k++) {
        const double *phi = ritz_dense_col(&s->modes->Phi, k);

        for (int64_t i = 0; i < s->modes->num_dofs; i++) {
            value[k] += a[i] * phi[i];
            doubt[k] += s->eps * fabs(a[i] * phi[i]);
        }
    }
    for (int64_t k = 0; k < s->modes->count; k++)
        for (int64_t j = 0; j < s->modes->count; j++)
            if (fabs(lambda[j] - lambda[k]) > s->same)
                doubt[k] += mixing_of(s, j, k) * fabs(value[j]);
}

static ritz_status project_channel(const ritz_modal_model *modes,
                                   const ritz_dense *D, const ritz_io *io,
                                   mode_rounding *s)
{
    int64_t m = modes->count;
    const double *a[KINDS] = {io->B.val, io->C.val, io->Cv.val, io->Ca.val};

    *s = rounding_of(modes);
    RITZ_CHECK(ritz_dense_new(m, KINDS, &s->value));
    RITZ_CHECK(ritz_dense_new(m, KINDS, &s->doubt));
    if (D->val)
        RITZ_CHECK(ritz_dense_terms(D, &modes->Phi, &s->most));
    else
        RITZ_CHECK(ritz_dense_new(m, m, &s->most));
    for (int kind = 0; kind < KINDS; kind++)
        project_rows(s, a[kind], ritz_dense_col(&s->value, kind),
                     ritz_dense_col(&s->doubt, kind));
    return RITZ_OK;
}

static bool is_coupled(const mode_rounding *s)
{
    const ritz_dense *Delta = &s->modes->Delta;

    for (int64_t j = 0; j < Delta->ncol; j++)
        for (int64_t i = 0; i < Delta->nrow; i++) {
            double gap =
                fabs(ritz_dense_col(Delta, i)[i] - ritz_dense_col(Delta, j)[j]);

            if (i != j && fabs(ritz_dense_col(Delta, j)[i]) >
                              mixing_of(s, i, j) * gap +
                                  s->eps * ritz_dense_col(&s->most, j)[i])
                return true;
        }
    return false;
}

/* (c - lambda ca) b, (cv - rate ca) b, and what rounding makes of them. */
static channel_row row_of(const mode_rounding *s, int64_t k)
{
    const ritz_modal_model *m = s->modes;
    double v[KINDS], d[KINDS], c = m->C.val[k], cv = m->Cv.val[k];
    double l = fabs(m->lambda[k]), rate = ritz_dense_col(&m->Delta, k)[k];
    double off = RITZ_BACKWARD_ERROR * DBL_EPSILON *
                 fmin(s->highest, l / RITZ_EIGEN_FAR_BELOW);
    double off_rate = s->eps * ritz_dense_col(&s->most, k)[k];

    for (int kind = 0; kind < KINDS; kind++) {
        v[kind] = ritz_dense_col(&s->value, kind)[k];
        d[kind] = ritz_dense_col(&s->doubt, kind)[k];
    }
    d[DISPLACEMENT] += l * d[ACCELERATION] + off * fabs(v[ACCELERATION]);
    d[VELOCITY] +=
        fabs(rate) * d[ACCELERATION] + off_rate * fabs(v[ACCELERATION]);
    return (channel_row){
        .lambda = m->lambda[k],
        .rate = rate,
        .c = c * v[FORCE],
        .cv = cv * v[FORCE],
        .doubt_rate = off_rate,
        .doubt_c = fabs(c) * d[FORCE] + fabs(v[FORCE]) * d[DISPLACEMENT],
        .doubt_cv = fabs(cv) * d[FORCE] + fabs(v[FORCE]) * d[VELOCITY]};
}

/* Rates follow lambda at most in proportion: 2 zeta w, a + b w^2. */
static bool is_same(const mode_rounding *s, const channel_row *a,
                    const channel_row *b)
{
    double size = fabs(a->rate) + fabs(b->rate);
    double l = fabs(a->lambda) + fabs(b->lambda);

    return b->lambda - a->lambda <= s->same &&
           fabs(a->rate - b->rate) <=
               size * (s->eps + (l > 0.0 ? s->same / l : 0.0)) + a->doubt_rate +
                   b->doubt_rate;
}

/* Modes with equal poles are summed. */
static int64_t sum_modes(const mode_rounding *s, channel_row *rows)
{
    int64_t count = 0;

    for (int64_t k = 0; k < s->modes->count; k++) {
        channel_row r = row_of(s, k);
        channel_row *last = count > 0 ? &rows[count - 1] : NULL;

        if (!last || !is_same(s, last, &r)) {
            rows[count++] = r;
            continue;
        }
        last->c += r.c;
        last->cv += r.cv;
        last->doubt_c += r.doubt_c;
        last->doubt_cv += r.doubt_cv;
    }
    return count;
}

/*
 * Modes that are controllable and observable beyond rounding: *count of them,
 * -1 if damping couples modes.
 *
 * @param[in] D   that Delta was projected from; {0}: none
 * @param[in] io  of one input and one output
 */
static ritz_status channel_rows(const ritz_modal_model *modes,
                                const ritz_dense *D, const ritz_io *io,
                                int64_t *count, channel_row **out)
{
    RITZ_OWN_ARRAY channel_row *rows = NULL;
    RITZ_OWN(mode_rounding) s = {0};
    int64_t summed = 0;

    RITZ_CHECK(project_channel(modes, D, io, &s));
    RITZ_CHECK_NEW(rows, modes->count);
    *count = is_coupled(&s) ? -1 : 0;
    summed = *count == 0 ? sum_modes(&s, rows) : 0;
    for (int64_t k = 0; k < summed; k++) {
        channel_row r = rows[k];

        r.c = fabs(r.c) <= r.doubt_c ? 0.0 : r.c;
        r.cv = fabs(r.cv) <= r.doubt_cv ? 0.0 : r.cv;
        if (r.c != 0.0 || r.cv != 0.0)
            rows[(*count)++] = r;
    }
    RITZ_MOVE(*out, rows);
    return RITZ_OK;
}

/*
 * Free rigid motions have no frequency, so any orthogonal basis of them are
 * modes. Without those that damping acts on,
 *
 *     q'' = B_r u,    y = C_r q + Cv_r q'
 *
 * is decoupled from the rest. Only range(B_r) is controllable, and only the
 * part of it that C_r and Cv_r do not map to 0 is observable. All else is a
 * pair of poles at 0 that zeros cancel; numerically they would cancel only up
 * to the square root of eps.
 */

/* Rigid motions by columns: a basis of those that count, so far. */
typedef struct sieve {
    const ritz_modal_model *modes;
    mode_rounding rounding;
    int64_t r;          /* rigid motions */
    ritz_dense loaded;  /* r x ., those that damping acts on */
    ritz_dense left;    /* r x ., those that it leaves free, and that count */
    double uncertainty; /* of any direction of `left` */
} sieve;

static void sieve_free(sieve *s)
{
    ritz_dense_free(&s->loaded);
    ritz_dense_free(&s->left);
}

/* range(A) and what is orthogonal to it, of values above @p least. */
static ritz_status split_range(const ritz_dense *A, double least,
                               ritz_dense *range, ritz_dense *rest,
                               double *smallest)
{
    RITZ_OWN(ritz_dense) U = {0}, V = {0};
    RITZ_OWN_ARRAY double *s = NULL;
    int64_t most = A->nrow < A->ncol ? A->nrow : A->ncol, rank = 0;

    RITZ_CHECK(ritz_general_svd(A, &U, &s, &V));
    while (rank < most && s[rank] > least)
        rank++;
    *smallest = rank > 0 ? s[rank - 1] : HUGE_VAL;
    RITZ_CHECK(ritz_dense_columns(&U, 0, rank, range));
    if (rest)
        RITZ_CHECK(ritz_dense_columns(&U, rank, A->nrow - rank, rest));
    return RITZ_OK;
}

/* Rounding error of Delta_ik and Delta_ki, i rigid: of the product itself,
   and of the flexible modes that rounding mixes into i. */
static double doubt_of_damping(const sieve *s, const ritz_dense *most,
                               int64_t i, int64_t k)
{
    const ritz_dense *Delta = &s->modes->Delta;
    double sum = (double)s->modes->num_dofs * DBL_EPSILON *
                 (ritz_dense_col(most, k)[i] + ritz_dense_col(most, i)[k]);

    for (int64_t j = s->r; j < s->modes->count; j++)
        sum +=
            mixing_of(&s->rounding, j, i) * (fabs(ritz_dense_col(Delta, k)[j]) +
                                             fabs(ritz_dense_col(Delta, j)[k]));
    return sum;
}

/* Split rigid motions into damped and undamped: rows and columns of Delta
   are compared with their rounding error. */
static ritz_status split_damped(const ritz_dense *D, sieve *s)
{
    const ritz_modal_model *f = s->modes;
    int64_t m = f->count;
    double noise = 0.0, smallest = 0.0;
    RITZ_OWN(ritz_dense) G = {0}, most = {0};

    RITZ_CHECK(ritz_dense_new(s->r, 2 * m, &G));
    if (D->val)
        RITZ_CHECK(ritz_dense_terms(D, &f->Phi, &most));
    else
        RITZ_CHECK(ritz_dense_new(m, m, &most));
    for (int64_t i = 0; i < s->r; i++)
        for (int64_t k = 0; k < m; k++) {
            ritz_dense_col(&G, k)[i] = ritz_dense_col(&f->Delta, k)[i];
            ritz_dense_col(&G, m + k)[i] = ritz_dense_col(&f->Delta, i)[k];
            noise = hypot(noise, doubt_of_damping(s, &most, i, k));
        }
    return split_range(&G, noise, &s->loaded, &s->left, &smallest);
}

/* A column of rigid participations a'phi_k over its own doubt: each is known up
   to 1. */
static ritz_status weigh_rigid(const sieve *s, const double *a, double *out)
{
    RITZ_OWN_ARRAY double *value = NULL, *doubt = NULL;
    double size = 0.0, unsure = 0.0;

    RITZ_CHECK_NEW(value, s->modes->count);
    RITZ_CHECK_NEW(doubt, s->modes->count);
    project_rows(&s->rounding, a, value, doubt);
    for (int64_t k = 0; k < s->r; k++) {
        size = hypot(size, value[k]);
        unsure = hypot(unsure, doubt[k]);
    }
    unsure += s->uncertainty * size;
    for (int64_t k = 0; k < s->r && unsure > 0.0; k++)
        out[k] = value[k] / unsure;
    return RITZ_OK;
}

/* Restrict `left` to what some loads or outputs, columns of A, reach. */
static ritz_status keep_reached(const ritz_dense *A, sieve *s)
{
    double least = sqrt((double)A->ncol), smallest = 0.0;
    RITZ_OWN(ritz_dense) rigid = {0}, within = {0}, range = {0}, kept = {0};

    RITZ_CHECK(ritz_dense_new(s->r, A->ncol, &rigid));
    for (int64_t j = 0; j < A->ncol; j++)
        RITZ_CHECK(
            weigh_rigid(s, ritz_dense_col(A, j), ritz_dense_col(&rigid, j)));
    RITZ_CHECK(ritz_dense_mul_tn(&s->left, &rigid, &within));
    RITZ_CHECK(split_range(&within, least, &range, NULL, &smallest));
    RITZ_CHECK(ritz_dense_mul(&s->left, &range, &kept));
    s->uncertainty += least / smallest;
    ritz_dense_replace(&s->left, &kept);
    return RITZ_OK;
}

/* [L N 0; 0 0 I] */
static ritz_status basis_of(const sieve *s, ritz_dense *out)
{
    const ritz_dense *part[] = {&s->loaded, &s->left};
    int64_t m = s->modes->count, at = 0;
    ritz_dense T = {0};

    RITZ_CHECK(ritz_dense_new(m, s->loaded.ncol + s->left.ncol + m - s->r, &T));
    for (int k = 0; k < 2; k++) {
        ritz_dense_put(part[k], 0, at, &T);
        at += part[k]->ncol;
    }
    for (int64_t k = s->r; k < m; k++)
        ritz_dense_col(&T, at++)[k] = 1.0;
    *out = T;
    return RITZ_OK;
}

/* Delta of what is left free is zero, not rounding. */
static void set_free(const sieve *s, ritz_modal_model *f)
{
    for (int64_t k = s->loaded.ncol; k < f->num_rigid; k++)
        for (int64_t i = 0; i < f->count; i++) {
            ritz_dense_col(&f->Delta, k)[i] = 0.0;
            ritz_dense_col(&f->Delta, i)[k] = 0.0;
        }
}

static ritz_status change_basis(const sieve *s, ritz_modal_model *out)
{
    const ritz_modal_model *f = s->modes;
    RITZ_OWN(ritz_modal_model) made = {.num_dofs = f->num_dofs};
    RITZ_OWN(ritz_dense) T = {0};

    RITZ_CHECK(basis_of(s, &T));
    made.count = T.ncol;
    made.num_rigid = T.ncol - (f->count - s->r);
    RITZ_CHECK_NEW(made.lambda, made.count);
    for (int64_t k = made.num_rigid; k < made.count; k++)
        made.lambda[k] = f->lambda[k - made.num_rigid + s->r];
    RITZ_CHECK(ritz_dense_mul(&f->Phi, &T, &made.Phi));
    RITZ_CHECK(ritz_dense_mul(&f->MPhi, &T, &made.MPhi));
    RITZ_CHECK(ritz_dense_project(&f->Delta, &T, &made.Delta));
    RITZ_CHECK(ritz_dense_mul_tn(&T, &f->B, &made.B));
    RITZ_CHECK(ritz_dense_mul(&f->C, &T, &made.C));
    RITZ_CHECK(ritz_dense_mul(&f->Cv, &T, &made.Cv));
    RITZ_CHECK(ritz_dense_copy(&f->feed, &made.feed));
    set_free(s, &made);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/*
 * The model without the free rigid motions that are not controllable or not
 * observable.
 */
static ritz_status drop_free_motions(const ritz_modal_model *modes,
                                     const ritz_dense *D, const ritz_io *io,
                                     ritz_modal_model *out)
{
    RITZ_OWN(sieve)
    s = {.modes = modes, .rounding = rounding_of(modes), .r = modes->num_rigid};
    RITZ_OWN(ritz_dense) C = {0}, Cv = {0}, seen = {0};

    if (s.r > 0) {
        RITZ_CHECK(split_damped(D, &s));
        RITZ_CHECK(keep_reached(&io->B, &s));
        RITZ_CHECK(ritz_general_transpose(&io->C, &C));
        RITZ_CHECK(ritz_general_transpose(&io->Cv, &Cv));
        RITZ_CHECK(ritz_dense_beside(&C, &Cv, &seen));
        RITZ_CHECK(keep_reached(&seen, &s));
    }
    return change_basis(&s, out);
}

/* Whether there is such a channel, or all at once can be asked for. */
static ritz_status channel_check(int64_t outputs, int64_t inputs,
                                 int64_t output, int64_t input)
{
    if (output == RITZ_ALL_CHANNELS && input == RITZ_ALL_CHANNELS) {
        RITZ_REFUSE_IF(
            outputs != inputs || outputs == 0, RITZ_ERR_ARGUMENT,
            "zeros of all channels at once are of as many outputs as "
            "inputs, not of %lld and %lld",
            (long long)outputs, (long long)inputs);
        return RITZ_OK;
    }
    RITZ_REFUSE_IF(output < 0 || output >= outputs, RITZ_ERR_ARGUMENT,
                   "there is no output %lld, there are %lld",
                   (long long)output + 1, (long long)outputs);
    RITZ_REFUSE_IF(input < 0 || input >= inputs, RITZ_ERR_ARGUMENT,
                   "there is no input %lld, there are %lld",
                   (long long)input + 1, (long long)inputs);
    return RITZ_OK;
}

ritz_status ritz_channel_states(const ritz_state_space *model, int64_t output,
                                int64_t input, ritz_channel *out)
{
    RITZ_OWN(ritz_channel) all = {0}, made = {0};
    RITZ_OWN(ritz_state_space) dense = {0};

    RITZ_CHECK(ritz_state_space_dense(model, &dense, &model));
    RITZ_CHECK(
        channel_check(model->num_outputs, model->num_inputs, output, input));
    RITZ_CHECK(ritz_split_scaled(&model->A, &model->E, &model->B, &model->C,
                                 &all.A, &all.B, &all.C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &all.D));
    if (output == RITZ_ALL_CHANNELS) {
        RITZ_MOVE(*out, all);
        return RITZ_OK;
    }
    RITZ_CHECK(ritz_dense_columns(&all.B, input, 1, &made.B));
    RITZ_CHECK(ritz_dense_rows(&all.C, 1, &output, &made.C));
    RITZ_CHECK(ritz_dense_new(1, 1, &made.D));
    made.D.val[0] = ritz_dense_col(&all.D, input)[output];
    RITZ_MOVE(made.A, all.A);
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

/* A = -Lambda, or blocks of two. */
static ritz_status fill_decoupled(int64_t m, const channel_row *rows,
                                  double feed, ritz_channel *out)
{
    bool squared = true;
    int64_t n = m;

    for (int64_t k = 0; k < m; k++)
        squared = squared && rows[k].rate == 0.0 && rows[k].cv == 0.0;
    n = squared ? m : 2 * m;
    out->squared = squared;
    out->blocks = !squared;
    RITZ_CHECK(ritz_dense_new(n, n, &out->A));
    RITZ_CHECK(ritz_dense_new(n, 1, &out->B));
    RITZ_CHECK(ritz_dense_new(1, n, &out->C));
    RITZ_CHECK(ritz_dense_new(1, 1, &out->D));
    out->D.val[0] = feed;
    for (int64_t k = 0; k < m; k++) {
        const channel_row *r = &rows[k];
        double w = ritz_modal_scale(r->lambda);

        out->B.val[n - m + k] = 1.0;
        out->C.val[k] = squared ? r->c : r->c / w;
        if (squared) {
            ritz_dense_col(&out->A, k)[k] = -r->lambda;
            continue;
        }
        out->C.val[m + k] = r->cv;
        ritz_dense_col(&out->A, m + k)[k] = w;
        ritz_dense_col(&out->A, k)[m + k] = -r->lambda / w;
        ritz_dense_col(&out->A, m + k)[m + k] = -r->rate;
    }
    return RITZ_OK;
}

/* x'' = A x + B u of an undamped model, several outputs and inputs. */
static ritz_status channel_of_undamped(const ritz_modal_model *f,
                                       ritz_channel *out)
{
    out->squared = true;
    RITZ_CHECK(ritz_dense_new(f->count, f->count, &out->A));
    for (int64_t k = 0; k < f->count; k++)
        ritz_dense_col(&out->A, k)[k] = -f->lambda[k];
    RITZ_CHECK(ritz_dense_copy(&f->B, &out->B));
    RITZ_CHECK(ritz_dense_copy(&f->C, &out->C));
    return ritz_dense_copy(&f->feed, &out->D);
}

/* @param[in] single  whether @p io is of one input and one output */
static ritz_status channel_of_modes(const ritz_modal_model *modes,
                                    const ritz_dense *D, const ritz_io *io,
                                    bool single, ritz_channel *out)
{
    RITZ_OWN_ARRAY channel_row *rows = NULL;
    RITZ_OWN(ritz_modal_model) moved = {0};
    int64_t count = -1;

    if (single)
        RITZ_CHECK(channel_rows(modes, D, io, &count, &rows));
    if (count >= 0)
        return fill_decoupled(count, rows, modes->feed.val[0], out);
    RITZ_CHECK(drop_free_motions(modes, D, io, &moved));
    if (ritz_dense_max(&moved.Delta) == 0.0 && ritz_dense_max(&moved.Cv) == 0.0)
        return channel_of_undamped(&moved, out);
    RITZ_CHECK(ritz_modal_states(&moved, &(ritz_modal_layout){0}, &out->A,
                                 &out->B, &out->C));
    return ritz_dense_copy(&moved.feed, &out->D);
}

/*
 * A channel of a second-order model. An output that is a derivative as a whole
 * is taken without it.
 */

/* One channel as an io of its own, or all of it. */
static ritz_status take_channel(const ritz_io *io, int64_t output,
                                int64_t input, ritz_io *out)
{
    const bool all = output == RITZ_ALL_CHANNELS;
    ritz_dense *parts[] = {&out->C, &out->Cv, &out->Ca};
    const ritz_dense *from[] = {&io->C, &io->Cv, &io->Ca};

    RITZ_CHECK(ritz_io_new(0, all ? io->num_inputs : 1,
                           all ? io->num_outputs : 1, out));
    ritz_dense_free(&out->B);
    RITZ_CHECK(
        ritz_dense_columns(&io->B, all ? 0 : input, out->num_inputs, &out->B));
    for (int k = 0; k < 3; k++) {
        ritz_dense_free(parts[k]);
        RITZ_CHECK(all ? ritz_dense_copy(from[k], parts[k])
                       : ritz_dense_rows(from[k], 1, &output, parts[k]));
    }
    return RITZ_OK;
}

/* An output that is a velocity alone, or an acceleration alone, is replaced
   by the displacement; the number of derivatives taken away. */
static int64_t integrate_outputs(ritz_io *io)
{
    ritz_dense *kind[] = {&io->C, &io->Cv, &io->Ca};
    ritz_dense kept = {0};
    int64_t only = -1;
    int kinds = 0;

    for (int k = 0; k < 3; k++)
        if (ritz_dense_max(kind[k]) > 0.0) {
            only = k;
            kinds++;
        }
    if (kinds != 1 || only == 0)
        return 0;
    kept = *kind[only];
    *kind[only] = io->C;
    io->C = kept;
    return only;
}

ritz_status ritz_channel_dense(const ritz_second_order *model,
                               const ritz_damping *damping, int64_t output,
                               int64_t input, ritz_channel *out)
{
    static const ritz_damping none = {0};
    ritz_structure structure = {*model->K, *model->M, {0}};
    RITZ_OWN(ritz_modal_model) modes = {0};
    RITZ_OWN(ritz_channel) made = {0};
    RITZ_OWN(ritz_io) io = {0};
    bool single = output != RITZ_ALL_CHANNELS;

    RITZ_CHECK(channel_check(model->io->num_outputs, model->io->num_inputs,
                             output, input));
    RITZ_REFUSE_IF(model->K4 && model->K4->val, RITZ_ERR_ARGUMENT,
                   "structural damping is of harmonic motion and has no zeros, "
                   "give it as a modal ratio");
    if (model->D)
        structure.D = *model->D;
    RITZ_CHECK(take_channel(model->io, output, input, &io));
    if (single)
        made.derivative = integrate_outputs(&io);
    RITZ_CHECK(ritz_modal_model_new(&structure, &io, damping ? damping : &none,
                                    &modes));
    RITZ_CHECK(channel_of_modes(&modes, &structure.D, &io, single, &made));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

void ritz_channel_free(ritz_channel *channel)
{
    ritz_dense_free(&channel->A);
    ritz_dense_free(&channel->B);
    ritz_dense_free(&channel->C);
    ritz_dense_free(&channel->D);
    *channel = (ritz_channel){0};
}
