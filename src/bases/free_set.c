/*
 * Residual modes Psi: the static response to forces F of the modes that are
 * left out. With the kept modes Phi, Psi solves
 *
 *     K Psi = G,  G = F - M Phi Phi' F,    Phi' M Psi = 0
 *
 * and is found from one definite factor of A = K + s M, s > 0, that of the search
 * for modes where its shift suits, by
 *
 *     Psi <- A^-1 (G + s M Psi),
 *
 * which multiplies the error in each mode lambda that was left out by
 * s / (lambda + s). It starts with A^-1 G, which is A^-1 F without its part in
 * the kept modes: the responses A^-1 F are computed anyway, because they are
 * what the residual modes are compared with.
 * F' Psi = Psi' K Psi is the residual flexibility. Columns that are linearly
 * dependent in this matrix, or negligible relative to the flexibility of the
 * kept modes, are removed. With T = [Phi, Psi], T'KT and T'MT are block
 * diagonal, and the flexible static response to F at the loaded dofs is exact.
 */
#include "bases/free_set.h"

#include "base/alloc.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "linear/factor.h"
#include "linear/requested.h"
#include "linear/tall.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>

enum {
    MOST_SWEEPS = 60,
    SLOW_SWEEPS = 8,
    WORTHWHILE = 5000, /* rows from which several threads work on columns */
};

void ritz_free_set_free(ritz_free_set *set)
{
    ritz_pairs_free(&set->modes);
    ritz_dense_free(&set->F);
    ritz_dense_free(&set->Psi);
    RITZ_FREE(set->dof, set->keep);
}

/*
 * A shift below the lowest flexible mode makes the iteration contract fast and
 * A well conditioned. If that mode is not kept, its frequency is computed here;
 * if there is none, the shift follows from the magnitude of the matrices.
 *
 * *rate: what a sweep multiplies the error by at most, as modes that are left
 * out lie above the last one known; 1 if the shift is a guess.
 */
static ritz_status choose_shift(const ritz_component *component,
                                const ritz_pairs *modes, double *out,
                                double *rate)
{
    const ritz_span one = {.modes = 1};
    double K = ritz_sparse_max(&component->K);
    double M = ritz_sparse_max(&component->M);
    RITZ_OWN(ritz_pairs) first = {0};
    const ritz_pairs *known = modes;

    if (modes->Phi.ncol == modes->num_rigid) {
        RITZ_CHECK_IN(
            "first flexible mode",
            ritz_eigen_sparse(&component->K, &component->M, &one, &first));
        known = &first;
    }
    if (known->Phi.ncol > known->num_rigid) {
        *out = RITZ_SHIFT_OF_FIRST * known->lambda[known->num_rigid];
        *rate = *out / (known->lambda[known->Phi.ncol - 1] + *out);
    } else {
        *out = K > 0.0 && M > 0.0 ? RITZ_SHIFT_OF_SIZE * K / M : 1.0;
        *rate = 1.0;
    }
    return RITZ_OK;
}

/* share = Phi'F: for a unit force on a dof the row of Phi of that dof. */
static ritz_status find_shares(const ritz_free_set *set, const ritz_dense *Phi,
                               ritz_dense *share)
{
    const ritz_dense *F = &set->F;

    RITZ_CHECK(ritz_dense_new(Phi->ncol, F->ncol, share));
    for (int64_t j = 0; j < F->ncol; j++)
        for (int64_t k = 0; k < Phi->ncol; k++)
            ritz_dense_col(share, j)[k] =
                set->dof[j] >= 0 ? ritz_dense_col(Phi, k)[set->dof[j]]
                                 : ritz_dense_dot(Phi, k, F, j);
    return RITZ_OK;
}

/* most[j]: an upper bound of the kept flexible modes' static response to load
   j. */
static void bound_responses(const ritz_pairs *modes, const ritz_dense *share,
                            double *most)
{
    for (int64_t k = modes->num_rigid; k < modes->Phi.ncol; k++) {
        const double size =
            ritz_dense_col_max(&modes->Phi, k) / modes->lambda[k];

        for (int64_t j = 0; j < share->ncol; j++)
            most[j] = fmax(most[j], size * fabs(ritz_dense_col(share, j)[k]));
    }
}

/* The operands of what is done with each column of X. */
typedef struct column_work {
    double s;
    const ritz_dense *G, *Psi;
    ritz_dense *X;
    const double *least;
    double *change; /* of each column */
} column_work;

/* Threads for so many columns. */
static int threads_for(const ritz_dense *X)
{
    return ritz_team_ready(X->nrow < WORTHWHILE ? 1 : X->ncol);
}

/* x := g + s x */
static void add_loads(int thread, int64_t from, int64_t to, void *task)
{
    const column_work *t = task;
    const int64_t n = t->X->nrow;

    (void)thread;
    for (int64_t k = from * n; k < to * n; k++)
        t->X->val[k] = t->G->val[k] + t->s * t->X->val[k];
}

/* X := A^-1 (G + s M Psi), one step of the iteration. */
static ritz_status iterate_residual(ritz_factor *A, const ritz_sparse *M,
                                    double s, const ritz_dense *G,
                                    const ritz_dense *Psi, ritz_dense *X)
{
    RITZ_CHECK(ritz_tall_new(Psi->nrow, Psi->ncol, X));
    RITZ_CHECK(ritz_tall_weigh(M, Psi, X));
    ritz_team_over(threads_for(X), X->ncol, add_loads,
                   &(column_work){.s = s, .G = G, .X = X});
    return ritz_factor_solve(A, X);
}

static void measure_columns(int thread, int64_t from, int64_t to, void *task)
{
    const column_work *t = task;

    (void)thread;
    for (int64_t j = from; j < to; j++) {
        const double *now = ritz_dense_col(t->X, j);
        const double *before = ritz_dense_col(t->Psi, j);
        double moved = 0.0;
        double size = t->least[j];

        for (int64_t i = 0; i < t->X->nrow; i++) { /* fmax() is slower */
            const double step = fabs(now[i] - before[i]);

            moved = step <= moved ? moved : step; /* NaN stays */
            size = fabs(now[i]) > size ? fabs(now[i]) : size;
        }
        t->change[j] = size > 0.0 ? moved / size : 0.0;
    }
}

/*
 * The largest change of a column relative to its size, or relative to least[j]
 * if the column is smaller, where it is rounding.
 */
static ritz_status measure_change(const ritz_dense *Psi, ritz_dense *X,
                                  const double *least, double *out)
{
    RITZ_OWN_ARRAY double *change = NULL;

    RITZ_CHECK_NEW(change, X->ncol);
    ritz_team_over(
        threads_for(X), X->ncol, measure_columns,
        &(column_work){.Psi = Psi, .X = X, .least = least, .change = change});
    *out = 0.0;
    for (int64_t j = 0; j < X->ncol; j++)
        *out = change[j] <= *out ? *out : change[j]; /* NaN stays */
    return RITZ_OK;
}

/* A search for residual modes, with what each of its functions needs. */
typedef struct residual_task {
    const ritz_request *request;
    ritz_free_set *set;
    double *response; /* f_j' A^-1 f_j for each load */
    bool done;        /* Psi and response are found, with the factor of the
                         search for modes */
    int64_t *order;   /* of rows in that factor; NULL: not known */
} residual_task;

static void residual_task_free(residual_task *t)
{
    RITZ_FREE(t->response, t->order);
}

/*
 * X = A^-1 F, the responses f_j' A^-1 f_j, and least[j], the size of column j of Psi
 * below which it is rounding.
 */
static ritz_status find_responses(const residual_task *t,
                                  const ritz_pairs *modes,
                                  const ritz_dense *share, ritz_factor *A,
                                  ritz_dense *X, double *least)
{
    const ritz_dense *F = &t->set->F;

    RITZ_CHECK(ritz_dense_copy(F, X));
    RITZ_CHECK(ritz_factor_solve(A, X));
    bound_responses(modes, share, least);
    for (int64_t j = 0; j < X->ncol; j++) {
        t->response[j] = ritz_dense_dot(F, j, X, j);
        least[j] = fmax(t->request->tolerance * least[j],
                        RITZ_FORCE_RELIEVED * ritz_dense_col_max(X, j));
    }
    return RITZ_OK;
}

/* G = F - M Phi Phi'F. Rounding leaves a part along M Phi, to which A^-1 G
   responds by kept modes, which are taken out of it. */
static ritz_status relieve_loads(const ritz_dense *F, const ritz_dense *MPhi,
                                 const ritz_dense *share, ritz_dense *G)
{
    RITZ_CHECK(ritz_dense_copy(F, G));
    if (MPhi->ncol > 0)
        ritz_tall_subtract(MPhi, share, G);
    return RITZ_OK;
}

/*
 * Psi and the responses, from the factor A of K + s M.
 *
 * A sweep leaves at most rate / (1 - rate) times the change that it made, in the
 * norm of K. Sweeps end where that is rounding, or where rounding has become
 * larger than what they gain: at the first change that has not halved, of which
 * the first ones do not count if the rate is not known.
 *
 * @param[in]  rate    as of choose_shift
 * @param[out] change  largest relative change of a column that a further sweep
 *                     would make, without its part in the modes: of modes that
 *                     are approximate such a part comes back in each sweep
 */
static ritz_status sweep_residual(const residual_task *t,
                                  const ritz_pairs *modes, ritz_factor *A,
                                  double s, double rate, double *change)
{
    const ritz_sparse *M = &t->request->component->M;
    const ritz_dense *F = &t->set->F, *Phi = &modes->Phi;
    const double settled = RITZ_SWEEPS_SETTLED * sqrt((double)M->nrow);
    const double left = rate < 0.5 ? rate / (1.0 - rate) : 1.0;
    const int slow = rate < 1.0 ? 0 : SLOW_SWEEPS;
    double best = HUGE_VAL;
    RITZ_OWN(ritz_dense) share = {0}, MPhi = {0}, G = {0}, Psi = {0};
    RITZ_OWN_ARRAY double *least = NULL;

    RITZ_CHECK_NEW(least, F->ncol);
    RITZ_CHECK(find_shares(t->set, Phi, &share));
    RITZ_CHECK(find_responses(t, modes, &share, A, &Psi, least));
    RITZ_CHECK(ritz_tall_new(Phi->nrow, Phi->ncol, &MPhi));
    RITZ_CHECK(ritz_tall_weigh(M, Phi, &MPhi));
    RITZ_CHECK(relieve_loads(F, &MPhi, &share, &G));
    RITZ_CHECK(ritz_tall_take_out(Phi, &MPhi, &Psi));
    for (int k = 0; k < MOST_SWEEPS; k++) {
        RITZ_OWN(ritz_dense) X = {0};

        RITZ_CHECK(iterate_residual(A, M, s, &G, &Psi, &X));
        RITZ_CHECK(ritz_tall_take_out(Phi, &MPhi, &X));
        RITZ_CHECK(measure_change(&Psi, &X, least, change));
        ritz_dense_replace(&Psi, &X);
        if (left * *change <= settled) {
            *change *= left;
            break;
        }
        if (k > slow && *change > 0.5 * best)
            break;
        best = fmin(best, *change);
    }
    ritz_dense_replace(&t->set->Psi, &Psi);
    return RITZ_OK;
}

/* Psi and the responses, with a factor made for them. */
static ritz_status find_residual(const residual_task *t)
{
    const ritz_component *component = t->request->component;
    double s = 0.0;
    double change = 0.0;
    double rate = 0.0;
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_factor) *L = NULL;

    RITZ_CHECK(choose_shift(component, &t->set->modes, &s, &rate));
    RITZ_CHECK(ritz_sparse_add(1.0, &component->K, s, &component->M, &A));
    RITZ_CHECK_IN("shifted stiffness",
                  ritz_factor_spd_ordered(&A, t->order, &L));
    RITZ_CHECK(sweep_residual(t, &t->set->modes, L, s, rate, &change));
    RITZ_REFUSE_IF(change > RITZ_SWEEPS_UNSETTLED, RITZ_ERR_CONVERGENCE,
                   "residual attachment modes still change by %.1e", change);
    return RITZ_OK;
}

/*
 * Psi and the responses with the factor of the search for modes, if its shift
 * suits. Each sweep multiplies the part of a mode that is left out by -sigma /
 * (lambda - sigma), which must be small; if -sigma itself is small, K - sigma M
 * of a free body is nearly singular, and digits are lost.
 */
static ritz_status borrow_factor(void *of, const ritz_pairs *found,
                                 int64_t count, ritz_factor *A, double sigma)
{
    residual_task *t = of;
    const int64_t rigid = found->num_rigid, all = found->Phi.ncol;
    const ritz_pairs kept = {.Phi = ritz_dense_part(&found->Phi, 0, count),
                             .lambda = found->lambda,
                             .num_rigid = rigid < count ? rigid : count};
    const double s = -sigma;
    double lowest = 0.0; /* eigenvalue that is left out, or a bound of it */
    double change = 0.0;

    t->done = false;
    if (A && !t->order && t->set->F.ncol > 0)
        RITZ_CHECK_COPY(t->order, ritz_factor_order(A), found->Phi.nrow);
    if (!A || rigid >= all || t->set->F.ncol == 0)
        return RITZ_OK;
    lowest = found->lambda[count < all ? count : all - 1];
    if (s < RITZ_SHIFT_LENT_LEAST * found->lambda[rigid] ||
        s > RITZ_SHIFT_LENT_MOST * lowest)
        return RITZ_OK;
    RITZ_CHECK(sweep_residual(t, &kept, A, s, s / (lowest + s), &change));
    t->done = change <= RITZ_SWEEPS_UNSETTLED;
    return RITZ_OK;
}

/* Flexibility f_j' Phi_f Lambda_f^-1 Phi_f' f_j of the kept modes, for load j;
   share = Phi'F. */
static double kept_flexibility(const ritz_pairs *modes, const ritz_dense *share,
                               int64_t j)
{
    double sum = 0.0;

    for (int64_t k = modes->num_rigid; k < modes->Phi.ncol; k++) {
        const double x = ritz_dense_col(share, j)[k];

        sum += x * x / modes->lambda[k];
    }
    return sum;
}

/* Psi_bb = S^-1 L L' S^-1, scaled to a unit diagonal by S. */
ritz_status ritz_residual_divide(const int64_t *b, ritz_dense *Psi)
{
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY double *scale = NULL;
    int n = (int)Psi->nrow;
    int p = (int)Psi->ncol;

    RITZ_CHECK_NEW(scale, p);
    RITZ_CHECK(ritz_dense_rows(Psi, p, b, &F));
    ritz_dense_symmetrise(&F);
    for (int64_t j = 0; j < p; j++)
        scale[j] = 1.0 / sqrt(ritz_dense_col(&F, j)[j]);
    for (int64_t j = 0; j < p; j++)
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&F, j)[i] *= scale[i] * scale[j];
    RITZ_REFUSE_IF(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', p, F.val, p) != 0,
                   RITZ_ERR_SINGULAR,
                   "residual flexibility of the attached dofs is singular: "
                   "keep fewer modes, or a larger --tolerance");
    for (int64_t j = 0; j < p; j++)
        cblas_dscal(n, scale[j], ritz_dense_col(Psi, j), 1);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                n, p, 1.0, F.val, p, Psi->val, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasNoTrans,
                CblasNonUnit, n, p, 1.0, F.val, p, Psi->val, n);
    for (int64_t j = 0; j < p; j++)
        cblas_dscal(n, scale[j], ritz_dense_col(Psi, j), 1);
    return RITZ_OK;
}

/*
 * Psi := Psi - G Psi_b for all loads that are not of the interface, with G from
 * the kept columns of the interface: Psi becomes K-orthogonal to those columns,
 * and zero at the attached dofs.
 */
static ritz_status clear_interface(ritz_free_set *set)
{
    ritz_dense beside = ritz_dense_part(&set->Psi, set->interface,
                                        set->Psi.ncol - set->interface);
    RITZ_OWN(ritz_dense) G = {0};
    RITZ_OWN_ARRAY int64_t *at = NULL, *row = NULL;
    int64_t count = 0;

    if (set->held == 0 || beside.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK_NEW(at, set->held);
    RITZ_CHECK_NEW(row, set->held);
    for (int64_t j = 0; j < set->interface; j++)
        if (set->keep[j]) {
            at[count] = j;
            row[count++] = set->dof[j];
        }
    RITZ_CHECK(ritz_dense_pick(&set->Psi, count, at, &G));
    RITZ_CHECK(ritz_residual_divide(row, &G));
    for (int pass = 0; pass < 2; pass++) {
        RITZ_OWN(ritz_dense) Psi_b = {0}, part = {0};

        RITZ_CHECK(ritz_dense_rows(&beside, count, row, &Psi_b));
        RITZ_CHECK(ritz_dense_mul(&G, &Psi_b, &part));
        ritz_dense_add(-1.0, &part, &beside);
    }
    for (int64_t j = 0; j < beside.ncol; j++)
        for (int64_t k = 0; k < count; k++)
            ritz_dense_col(&beside, j)[row[k]] = 0.0;
    return RITZ_OK;
}

/* Choose the residual modes that are kept, first for the interface and then for
   the other loads. */
static ritz_status choose_independent(const double *response, double tolerance,
                                      ritz_free_set *set)
{
    const int64_t a = set->interface, b = set->Psi.ncol - a;
    const ritz_dense F_a = ritz_dense_part(&set->F, 0, a);
    const ritz_dense F_b = ritz_dense_part(&set->F, a, b);
    const ritz_dense Psi_a = ritz_dense_part(&set->Psi, 0, a);
    const ritz_dense Psi_b = ritz_dense_part(&set->Psi, a, b);
    RITZ_OWN_ARRAY double *least = NULL;
    RITZ_OWN(ritz_dense) share = {0};

    RITZ_CHECK_NEW(least, a + b);
    RITZ_CHECK(find_shares(set, &set->modes.Phi, &share));
    for (int64_t j = 0; j < a + b; j++) {
        const double own = ritz_dense_dot(&set->F, j, &set->Psi, j);
        const double kept = kept_flexibility(&set->modes, &share, j);

        least[j] =
            fmax(tolerance * (own + kept), RITZ_FORCE_RELIEVED * response[j]);
    }
    RITZ_CHECK(ritz_statics_choose(&F_a, &Psi_a, least, tolerance, set->keep,
                                   &set->held));
    RITZ_CHECK(clear_interface(set));
    RITZ_CHECK(ritz_statics_choose(&F_b, &Psi_b, least + a, tolerance,
                                   set->keep + a, &set->kept));
    set->kept += set->held;
    return RITZ_OK;
}

/* The loads whose residual modes are wanted, and room for what is known of
   each. */
static ritz_status collect_loads(residual_task *t)
{
    ritz_free_set *set = t->set;

    if (ritz_loads_count(t->request, set->loads) == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_loads_collect(t->request, set->loads, &set->F, &set->dof));
    RITZ_CHECK_NEW(set->keep, set->F.ncol);
    RITZ_CHECK_NEW(t->response, set->F.ncol);
    return RITZ_OK;
}

/* Residual modes of the loads, M- and K-orthogonal to the modes of the set;
   none without loads. */
static ritz_status find_statics(const residual_task *t)
{
    if (t->set->F.ncol == 0)
        return RITZ_OK;
    if (!t->done)
        RITZ_CHECK(find_residual(t));
    return choose_independent(t->response, t->request->tolerance, t->set);
}

/* The modes that the request asks for: copies of known modes if the next one
   above them is known too, so that no cluster is cut; otherwise they are
   computed. */
static ritz_status find_modes(const ritz_request *request,
                              const ritz_factor_use *use, ritz_pairs *out)
{
    const ritz_component *component = request->component;
    const ritz_span span = ritz_request_span(request);
    const ritz_pairs *known = request->known;
    const int64_t end =
        known && span.modes >= 0 ? ritz_pairs_wanted(known, &span, 0.0) : 0;

    if (known && span.modes >= 0 && end < known->Phi.ncol)
        return ritz_pairs_copy(known, end, out);
    return ritz_lowest_modes("free-interface modes", "K", &component->K,
                             &component->M, &span, use, out);
}

ritz_status ritz_free_set_new(const ritz_request *request, int loads,
                              bool joined, ritz_free_set *out)
{
    RITZ_OWN(ritz_free_set)
    set = {.loads = loads, .interface = joined ? request->attached.count : 0};
    RITZ_OWN(residual_task) task = {.request = request, .set = &set};
    const ritz_factor_use use = {borrow_factor, &task};
    RITZ_OWN(ritz_dofs) rest = {0};

    /* refuses attached dofs that are out of range or repeated */
    RITZ_CHECK(ritz_dofs_complement(&request->attached,
                                    request->component->num_dofs, &rest));
    RITZ_CHECK(collect_loads(&task));
    RITZ_CHECK(find_modes(request, &use, &set.modes));
    RITZ_CHECK(find_statics(&task));
    RITZ_MOVE(*out, set);
    return RITZ_OK;
}

ritz_status ritz_free_set_join(const ritz_request *request,
                               const ritz_free_set *set, ritz_column_kind kind,
                               ritz_basis *out)
{
    const int64_t a = set->interface;
    int64_t k = set->modes.Phi.ncol;

    RITZ_CHECK(ritz_basis_of_modes(&set->modes, set->kept, out));
    for (int64_t j = 0; j < set->Psi.ncol; j++) {
        const ritz_dense column = ritz_dense_part(&set->Psi, j, 1);

        if (!set->keep[j])
            continue;
        out->columns.kind[k] = j < a ? kind : RITZ_COLUMN_STATIC;
        out->columns.dof[k] = set->dof[j];
        ritz_dense_put(&column, 0, k++, &out->T);
    }
    if (set->Psi.ncol > 0) {
        ritz_remark_left_out(request, set->loads, 0, a, set->keep, kind, out);
        ritz_remark_left_out(request, set->loads, a, set->Psi.ncol - a,
                             set->keep + a, RITZ_COLUMN_STATIC, out);
    }
    ritz_remark_dampers(request, set->loads, out);
    return RITZ_OK;
}

ritz_status ritz_free_set_beside(const ritz_request *request, int loads,
                                 ritz_pairs *modes, ritz_basis *out)
{
    RITZ_OWN(ritz_free_set) set = {.loads = loads};
    RITZ_OWN(residual_task) task = {.request = request, .set = &set};

    RITZ_MOVE(set.modes, *modes);
    RITZ_CHECK(collect_loads(&task));
    RITZ_CHECK(find_statics(&task));
    return ritz_free_set_join(request, &set, RITZ_COLUMN_STATIC, out);
}
