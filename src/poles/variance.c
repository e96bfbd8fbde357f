/*
 * H2 norm of a second-order model with dampers, and its derivatives with
 * respect to their c_j and k_j.
 *
 * With the modes Phi of the model for the present c and k, K Phi = M Phi
 * Lambda, beta = Phi'b for a damper and the states z = [S q; q']
 * (model/modal.h),
 *
 *     A = [0 S; -Lambda S^-1 -Delta],   Delta = Phi'D Phi + d(Lambda)
 *
 * where d(Lambda) are the rates of stated damping. Phi and S may be held fixed
 * while c and k change, since the norm does not depend on coordinates; then
 *
 *     d Delta / dc = beta beta',    d Lambda / dk = beta beta',
 *     d d(Lambda) / dk = L o beta beta',
 *     L_ij = (d_i - d_j) / (lambda_i - lambda_j),    L_ii = d'(lambda_i)
 *
 * [DaleckiiKrein1965]. For acceleration outputs, C changes by -Ca Phi times the
 * same derivatives. With both Gramians
 *
 *     A P + P A' + B B' = 0,    A'Q + Q A + C'C = 0,    J = tr(C P C'),
 *     dJ = 2 tr(P Q dA) + 2 tr(P C'dC)
 *
 * A filter of white noise w drives the inputs: u = C_f x_f, x_f' = A_f x_f +
 * B_f w.
 */
#include "poles/h2.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "gramians/modes.h"
#include "linear/general.h"
#include "linear/split.h"
#include "poles/poles.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* x' = A x + B w, y = C x; the first `states` of x are those of the model
   without filters. */
typedef struct first_order {
    int64_t states;
    ritz_dense A, B, C;
} first_order;

static void first_order_free(first_order *f)
{
    ritz_dense_free(&f->A);
    ritz_dense_free(&f->B);
    ritz_dense_free(&f->C);
}

/* --- Noise ---------------------------------------------------------------- */

static ritz_status check_noise(const ritz_disturbance *noise, const ritz_io *io)
{
    RITZ_REFUSE_IF(io->num_inputs == 0 || io->num_outputs == 0,
                   RITZ_ERR_ARGUMENT,
                   "the model has no %s: an H2 norm is from noise at inputs to "
                   "outputs",
                   io->num_inputs == 0 ? "inputs" : "outputs");
    RITZ_REFUSE_IF(
        !(noise->low_pass_hz >= 0.0) || !isfinite(noise->low_pass_hz) ||
            (noise->low_pass_hz > 0.0 &&
             (noise->order < 1 || noise->order > RITZ_LOW_PASS_MOST)),
        RITZ_ERR_ARGUMENT,
        "a low-pass of %g Hz and order %" PRId64
        " is none: the frequency is positive, and the order 1 to %d",
        noise->low_pass_hz, noise->order, RITZ_LOW_PASS_MOST);
    return RITZ_OK;
}

static int64_t filter_states(const ritz_disturbance *noise)
{
    return noise->low_pass_hz > 0.0 ? noise->order : 0;
}

/*
 * Put one filter at state `at` and below. With w = 2 pi f it is a cascade of
 * the factors w^2 / (s^2 + 2 sin((2 j + 1) pi / (2 n)) w s + w^2), j < n / 2,
 * and for odd n of w / (s + w). The first state of the last factor is the
 * filter's output.
 */
static void put_filter(const ritz_disturbance *noise, int64_t at, int64_t input,
                       first_order *f)
{
    double w = 2.0 * RITZ_PI * noise->low_pass_hz;
    int64_t n = noise->order, source = -1;

    for (int64_t j = 0; j < (n + 1) / 2; j++) {
        bool pair = 2 * j + 1 < n;
        int64_t driven = at + pair;

        if (pair) {
            ritz_dense_col(&f->A, at + 1)[at] = w;
            ritz_dense_col(&f->A, at)[at + 1] = -w;
            ritz_dense_col(&f->A, at + 1)[at + 1] =
                -2.0 * w *
                sin((double)(2 * j + 1) * RITZ_PI / (2.0 * (double)n));
        } else {
            ritz_dense_col(&f->A, at)[at] = -w;
        }
        if (source < 0)
            ritz_dense_col(&f->B, input)[driven] = w;
        else
            ritz_dense_col(&f->A, source)[driven] = w;
        source = at;
        at += pair ? 2 : 1;
    }
}

/* Index of the state that is the output of filter `input`. */
static int64_t filter_output(const ritz_disturbance *noise, int64_t first,
                             int64_t input)
{
    int64_t last = noise->order % 2 == 0 ? noise->order - 2 : noise->order - 1;

    return first + input * noise->order + last;
}

/*
 * Put the filters of all inputs in front of a model.
 *
 * @param[in] feed  feedthrough from inputs to outputs
 */
static ritz_status add_noise(const ritz_disturbance *noise,
                             const ritz_dense *feed, first_order *f)
{
    int64_t n = f->A.nrow, m = f->B.ncol, more = filter_states(noise);
    RITZ_OWN(first_order) all = {.states = n};

    f->states = n;
    RITZ_REFUSE_IF(
        more == 0 && feed->val && ritz_dense_max(feed) > 0.0, RITZ_ERR_ARGUMENT,
        "the H2 norm is infinite: an output follows an input at once, and so "
        "has all of its white noise; give a low-pass");
    if (more == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_new(n + m * more, n + m * more, &all.A));
    RITZ_CHECK(ritz_dense_new(n + m * more, m, &all.B));
    RITZ_CHECK(ritz_dense_new(f->C.nrow, n + m * more, &all.C));
    ritz_dense_put(&f->A, 0, 0, &all.A);
    ritz_dense_put(&f->C, 0, 0, &all.C);
    for (int64_t j = 0; j < m; j++) {
        const ritz_dense b = ritz_dense_part(&f->B, j, 1);
        int64_t from = filter_output(noise, n, j);

        put_filter(noise, n + j * more, j, &all);
        ritz_dense_put(&b, 0, from, &all.A);
        if (feed->val) {
            const ritz_dense d = ritz_dense_part(feed, j, 1);

            ritz_dense_put(&d, 0, from, &all.C);
        }
    }
    first_order_free(f);
    RITZ_MOVE(*f, all);
    return RITZ_OK;
}

/* --- Gramians ------------------------------------------------------------- */

/* Factors of both Gramians of the states left of the axis: P = (X F)(X F)', Q =
   (Y G)(Y G)'. */
typedef struct gramians {
    ritz_split split;
    ritz_dense B, C; /* in the coordinates of the split, scaled to unit norm */
    ritz_dense F, G;
    double size_B, size_C; /* norms that B and C were divided by */
} gramians;

static void gramians_free(gramians *g)
{
    ritz_split_free(&g->split);
    ritz_dense_free(&g->B);
    ritz_dense_free(&g->C);
    ritz_dense_free(&g->F);
    ritz_dense_free(&g->G);
}

/* A := A / |A|; returns |A|, or 1 if A is zero. */
static double divide_size(ritz_dense *A)
{
    double size = ritz_general_size(A);

    for (int64_t k = 0; k < A->nrow * A->ncol && size > 0.0; k++)
        A->val[k] /= size;
    return size > 0.0 ? size : 1.0;
}

/*
 * Whether poles that are not left of the axis are both controllable and
 * observable: some C T (W'A T)^k W'B, k = 0, 1, ..., is then not 0.
 */
static ritz_status transmits_rest(const first_order *f, const ritz_split *split,
                                  bool *out)
{
    int64_t a = split->T.ncol;
    RITZ_OWN(ritz_dense) A = {0}, CT = {0}, WB = {0};
    double size = 1.0;

    RITZ_CHECK(ritz_dense_mul(&f->A, &split->T, &A));
    RITZ_CHECK(ritz_dense_mul_tn(&split->W, &A, &CT));
    ritz_dense_replace(&A, &CT);
    RITZ_CHECK(ritz_dense_mul(&f->C, &split->T, &CT));
    RITZ_CHECK(ritz_dense_mul_tn(&split->W, &f->B, &WB));
    size = ritz_general_size(&f->C) * ritz_general_size(&split->T) *
           ritz_general_size(&split->W) * ritz_general_size(&f->B);
    for (int64_t k = 0; k < a && !*out; k++) {
        RITZ_OWN(ritz_dense) markov = {0};

        RITZ_CHECK(ritz_dense_mul(&CT, &WB, &markov));
        *out = ritz_dense_max(&markov) > RITZ_UNOBSERVED * size;
        RITZ_CHECK(ritz_dense_times(&A, &CT));
        size *= fmax(ritz_general_size(&A), RITZ_LEAST_SCALE);
    }
    return RITZ_OK;
}

/* Factors of the controllability Gramian and, if @p both, of the observability
   Gramian. */
static ritz_status find_gramians(const first_order *f, bool both, gramians *g,
                                 ritz_variance *out)
{
    RITZ_OWN(ritz_dense) E = {0}, Ct = {0}, CF = {0};
    bool transmits = false;

    RITZ_CHECK(ritz_split_new(&f->A, &E, &g->split));
    out->states = f->A.nrow;
    if (g->split.T.ncol > 0)
        RITZ_CHECK(transmits_rest(f, &g->split, &transmits));
    out->finite = !transmits;
    out->unstable = transmits ? g->split.T.ncol : 0;
    out->square = HUGE_VAL;
    if (transmits)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul_tn(&g->split.Y, &f->B, &g->B));
    RITZ_CHECK(ritz_dense_mul(&f->C, &g->split.X, &g->C));
    g->size_B = divide_size(&g->B);
    g->size_C = divide_size(&g->C);
    RITZ_CHECK(
        ritz_general_hammarling(&g->split.S, &g->split.P, false, &g->B, &g->F));
    RITZ_CHECK(ritz_dense_mul(&g->C, &g->F, &CF));
    out->square = pow(g->size_B * g->size_C * ritz_general_size(&CF), 2.0);
    if (!both)
        return RITZ_OK;
    RITZ_CHECK(ritz_general_transpose(&g->C, &Ct));
    return ritz_general_hammarling(&g->split.S, &g->split.P, true, &Ct, &g->G);
}

/* PQ = P Q and PC = P C' in the states of the model, with the scales of B and
   C. */
static ritz_status multiply_gramians(const gramians *g, ritz_dense *PQ,
                                     ritz_dense *PC)
{
    double scale = g->size_B * g->size_B * g->size_C;
    RITZ_OWN(ritz_dense) XF = {0}, YG = {0}, FG = {0}, left = {0}, FC = {0};

    RITZ_CHECK(ritz_dense_mul(&g->split.X, &g->F, &XF));
    RITZ_CHECK(ritz_dense_mul(&g->split.Y, &g->G, &YG));
    RITZ_CHECK(ritz_dense_mul_tn(&g->F, &g->G, &FG)); /* Y'X = I */
    RITZ_CHECK(ritz_dense_mul(&XF, &FG, &left));
    RITZ_CHECK(ritz_dense_mul_nt(&left, &YG, PQ));
    RITZ_CHECK(ritz_dense_mul(&g->C, &g->F, &FC));
    RITZ_CHECK(ritz_dense_mul_nt(&XF, &FC, PC));
    for (int64_t k = 0; k < PQ->nrow * PQ->ncol; k++)
        PQ->val[k] *= scale * g->size_C;
    for (int64_t k = 0; k < PC->nrow * PC->ncol; k++)
        PC->val[k] *= scale;
    return RITZ_OK;
}

/* --- The model in its modes ----------------------------------------------- */

typedef struct modal_form {
    ritz_modal_model modes;
    int64_t first;    /* number of leading modes that are decoupled rigid ones,
                         which are left out */
    ritz_dense beta;  /* m x dampers */
    ritz_dense CaPhi; /* outputs x m, divided by limits */
    first_order f;
} modal_form;

static void modal_form_free(modal_form *form)
{
    ritz_modal_model_free(&form->modes);
    ritz_dense_free(&form->beta);
    ritz_dense_free(&form->CaPhi);
    first_order_free(&form->f);
}

static ritz_status install_plant(const ritz_plant *plant, ritz_structure *out)
{
    RITZ_OWN(ritz_dampers) dampers = {0};

    RITZ_CHECK(ritz_dense_copy(&plant->base.K, &out->K));
    RITZ_CHECK(ritz_dense_copy(&plant->base.M, &out->M));
    if (plant->base.D.val)
        RITZ_CHECK(ritz_dense_copy(&plant->base.D, &out->D));
    RITZ_CHECK(ritz_dampers_copy(&plant->dampers, &dampers));
    return ritz_dampers_install(&dampers, &out->K, &out->D);
}

/* Whether the first `count` modes are controllable and observable, taken
   together. */
static bool transmits_rigid(const ritz_modal_model *modes, int64_t count)
{
    const ritz_dense *const C[] = {&modes->C, &modes->Cv};

    for (int half = 0; half < 2; half++)
        for (int64_t i = 0; i < modes->C.nrow; i++)
            for (int64_t j = 0; j < modes->B.ncol; j++) {
                double sum = 0.0, most = 0.0;

                for (int64_t k = 0; k < modes->count; k++) {
                    double part = ritz_dense_col(C[half], k)[i] *
                                  ritz_dense_col(&modes->B, j)[k];

                    sum += k < count ? part : 0.0;
                    most += fabs(part);
                }
                if (fabs(sum) > RITZ_UNOBSERVED * most)
                    return true;
            }
    return false;
}

/* Refuse derivatives for a damper that acts on dofs without mass. */
static ritz_status refuse_massless(const ritz_plant *plant,
                                   const modal_form *form)
{
    RITZ_OWN(ritz_dense) rest = {0};

    if (form->modes.count == form->modes.num_dofs)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(&plant->dampers.B, &rest));
    RITZ_CHECK(ritz_dense_take_out(&form->modes.MPhi, &form->modes.Phi, &rest));
    for (int64_t j = 0; j < rest.ncol; j++)
        RITZ_REFUSE_IF(ritz_dense_col_max(&rest, j) >
                           RITZ_MASSLESS_SHARE *
                               ritz_dense_col_max(&plant->dampers.B, j),
                       RITZ_ERR_ARGUMENT,
                       "damper '%s' moves dofs without mass: condense them "
                       "first",
                       plant->dampers.name[j]);
    return RITZ_OK;
}

/* @param[out] infinite  a rigid motion that is left out is controllable and
                         observable */
static ritz_status modal_form_new(const ritz_plant *plant, modal_form *form,
                                  bool *infinite)
{
    RITZ_OWN(ritz_structure) model = {0};
    ritz_modal_model *modes = &form->modes;
    ritz_modal_layout layout = {0};

    RITZ_CHECK(install_plant(plant, &model));
    RITZ_CHECK(
        ritz_modal_model_new(&model, &plant->io, &plant->damping, modes));
    form->first = ritz_modal_decoupled(modes);
    *infinite = transmits_rigid(modes, form->first);
    layout.first = layout.position = form->first;
    RITZ_CHECK(
        ritz_modal_states(modes, &layout, &form->f.A, &form->f.B, &form->f.C));
    ritz_outputs_weigh(plant->io.limit, &form->f.C);
    ritz_outputs_weigh(plant->io.limit, &modes->feed);
    RITZ_CHECK(add_noise(&plant->noise, &modes->feed, &form->f));
    if (plant->dampers.count > 0)
        RITZ_CHECK(
            ritz_dense_mul_tn(&modes->Phi, &plant->dampers.B, &form->beta));
    RITZ_CHECK(ritz_dense_mul(&plant->io.Ca, &modes->Phi, &form->CaPhi));
    ritz_outputs_weigh(plant->io.limit, &form->CaPhi);
    return RITZ_OK;
}

/* d(lambda_i), the rate of stated damping. */
static double rate_of(const ritz_plant *plant, const ritz_modal_model *modes,
                      int64_t i)
{
    return ritz_modal_rate(&plant->damping, i - modes->num_rigid,
                           modes->lambda[i]);
}

/* L_ij. A damping ratio gives d = 2 zeta sqrt(lambda) and d' = zeta /
   sqrt(lambda). */
static double divided_rate(const ritz_plant *plant,
                           const ritz_modal_model *modes, int64_t i, int64_t j)
{
    double a = modes->lambda[i], b = modes->lambda[j];
    double mean = 0.5 * (a + b);

    if (plant->damping.kind == RITZ_DAMPING_NONE)
        return 0.0;
    if (ritz_damping_is_rayleigh(&plant->damping))
        return plant->damping.b;
    if (fabs(a - b) > RITZ_CLUSTER_GAP * mean)
        return (rate_of(plant, modes, i) - rate_of(plant, modes, j)) / (a - b);
    return mean > 0.0
               ? 0.25 * (rate_of(plant, modes, i) + rate_of(plant, modes, j)) /
                     mean
               : 0.0;
}

/*
 * -2 beta_i beta_j (PQ(from, m + i) + (PC Ca)(from, i)): derivative of J by a
 * coefficient of beta_i beta_j in row m + i, column `from` of A.
 */
static double sum_derivative(const modal_form *form, const ritz_dense *PQ,
                             const ritz_dense *PCCa, int64_t damper, int64_t i,
                             int64_t j, int64_t from)
{
    const double *beta = ritz_dense_col(&form->beta, damper);
    int64_t m = form->modes.count - form->first;

    return -2.0 * beta[form->first + i] * beta[form->first + j] *
           (ritz_dense_col(PQ, m + i)[from] + ritz_dense_col(PCCa, i)[from]);
}

static ritz_status find_derivatives(const ritz_plant *plant,
                                    const modal_form *form, const gramians *g,
                                    ritz_variance *out)
{
    const ritz_modal_model *modes = &form->modes;
    int64_t first = form->first, m = modes->count - first;
    const ritz_dense Ca = ritz_dense_part(&form->CaPhi, first, m);
    RITZ_OWN(ritz_dense) PQ = {0}, PC = {0}, PCCa = {0};

    RITZ_CHECK(multiply_gramians(g, &PQ, &PC));
    RITZ_CHECK(ritz_dense_mul(&PC, &Ca, &PCCa));
    for (int64_t d = 0; d < plant->dampers.count; d++) {
        out->by_c[d] = out->by_k[d] = 0.0;
        for (int64_t j = 0; j < m; j++)
            for (int64_t i = 0; i < m; i++) {
                double of_rate =
                    sum_derivative(form, &PQ, &PCCa, d, i, j, m + j);

                out->by_c[d] += of_rate;
                out->by_k[d] +=
                    of_rate * divided_rate(plant, modes, first + i, first + j) +
                    sum_derivative(form, &PQ, &PCCa, d, i, j, j) /
                        ritz_modal_scale(modes->lambda[first + j]);
            }
    }
    return RITZ_OK;
}

ritz_status ritz_variance_of(const ritz_plant *plant, ritz_variance *out)
{
    RITZ_OWN(modal_form) form = {0};
    RITZ_OWN(gramians) g = {0};
    bool infinite = false;

    RITZ_CHECK(check_noise(&plant->noise, &plant->io));
    RITZ_CHECK(modal_form_new(plant, &form, &infinite));
    if (out->by_c)
        RITZ_CHECK(refuse_massless(plant, &form));
    out->finite = false;
    out->square = HUGE_VAL;
    out->unstable = 2 * form.first;
    out->states = form.f.A.nrow + 2 * form.first;
    if (infinite)
        return RITZ_OK;
    RITZ_CHECK(find_gramians(&form.f, out->by_c, &g, out));
    return out->finite && out->by_c ? find_derivatives(plant, &form, &g, out)
                                    : RITZ_OK;
}

ritz_status ritz_plant_norm(const ritz_plant *plant, double *out)
{
    ritz_variance variance = {0};

    RITZ_CHECK(ritz_variance_of(plant, &variance));
    *out = sqrt(variance.square);
    return RITZ_OK;
}

ritz_status ritz_refuse_infinite(const ritz_variance *variance)
{
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the H2 norm is infinite: of %" PRId64 " poles %" PRId64
                     " are not left of the imaginary axis, are driven and "
                     "observed",
                     variance->states, variance->unstable);
}

/* --- Models --------------------------------------------------------------- */

ritz_status ritz_plant_new(ritz_model model, const ritz_disturbance *noise,
                           ritz_plant *out)
{
    const ritz_second_order *m = &model.dense;
    const ritz_io io = ritz_model_io(model);
    RITZ_OWN(ritz_plant) plant = {.noise = *noise};
    RITZ_OWN(ritz_reduced) whole = {0};
    ritz_second_order view = {0};
    RITZ_OWN(ritz_dense) one = {0};

    if (model.kind == RITZ_MODEL_COMPONENT) {
        RITZ_CHECK(ritz_whole_new(model.component, &whole));
        view =
            (ritz_second_order){&whole.K, &whole.M, &whole.D, &whole.K4, NULL};
        m = &view;
    }
    RITZ_CHECK(ritz_structure_refuse(m->K4 && m->K4->val));
    RITZ_CHECK(ritz_dense_copy(m->K, &plant.base.K));
    RITZ_CHECK(ritz_dense_copy(m->M, &plant.base.M));
    if (m->D && m->D->val)
        RITZ_CHECK(ritz_dense_copy(m->D, &plant.base.D));
    RITZ_CHECK(ritz_dense_identity(plant.base.K.nrow, &one));
    RITZ_CHECK(ritz_io_project(&io, &one, &plant.io));
    if (model.damping)
        plant.damping = *model.damping;
    if (model.kind == RITZ_MODEL_COMPONENT)
        RITZ_CHECK(
            ritz_dampers_copy(&model.component->dampers, &plant.dampers));
    else if (model.dampers)
        RITZ_CHECK(ritz_dampers_copy(model.dampers, &plant.dampers));
    RITZ_MOVE(*out, plant);
    return RITZ_OK;
}

void ritz_plant_free(ritz_plant *plant)
{
    ritz_structure_free(&plant->base);
    ritz_io_free(&plant->io);
    ritz_dampers_free(&plant->dampers);
    *plant = (ritz_plant){0};
}

ritz_status ritz_variance_of_states(const ritz_state_space *model,
                                    const ritz_disturbance *noise,
                                    ritz_variance *out)
{
    const ritz_io io = ritz_model_io(ritz_model_of_states(model));
    RITZ_OWN(first_order) f = {0};
    RITZ_OWN(gramians) g = {0};
    RITZ_OWN(ritz_dense) feed = {0};
    RITZ_OWN(ritz_state_space) made = {0};

    RITZ_CHECK(check_noise(noise, &io));
    RITZ_CHECK(ritz_state_space_check(model));
    RITZ_CHECK(ritz_state_space_dense(model, &made, &model));
    RITZ_CHECK(ritz_split_scaled(&model->A, &model->E, &model->B, &model->C,
                                 &f.A, &f.B, &f.C));
    RITZ_CHECK(ritz_dense_copy(&model->D, &feed));
    ritz_outputs_weigh(io.limit, &f.C);
    ritz_outputs_weigh(io.limit, &feed);
    RITZ_CHECK(add_noise(noise, &feed, &f));
    return find_gramians(&f, false, &g, out);
}
