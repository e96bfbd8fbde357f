/*
 * Block Krylov vectors. About each point sigma, with A = K - sigma M and the
 * load vectors F,
 *
 *     R_0 = A^-1 F,   R_j = A^-1 M Q_j,   Q_j+1 = independent part of R_j
 *
 * which is made orthonormal to all vectors of all points, in K or in M: the
 * Lanczos recurrence of [CraigSuKim1992, sec. 2] with full reorthogonalisation,
 * and with several points a rational Krylov sequence. Points take turns, a
 * block each. V spans A^-1 F, (A^-1 M) A^-1 F, ... of every point, so that its
 * Galerkin model keeps as many moments about that point as it has whole blocks
 * there, and twice as many where inputs and outputs are both among the forces.
 */
#include "bases/krylov.h"

#include "base/alloc.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "bases/space.h"
#include "linear/supernodal.h"
#include "linear/tall.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    WORTHWHILE = 5000, /* rows from which several threads sum columns */
};

int ritz_krylov_loads(const ritz_request *request, bool joined)
{
    const int usual =
        RITZ_LOADS_ATTACHED | RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS;

    if (request->choice.loads)
        return request->choice.loads;
    return usual | (joined ? RITZ_LOADS_DAMPERS : 0);
}

void ritz_krylov_points(const ritz_choice *choice, ritz_krylov *S)
{
    S->num_points = choice->num_shifts > 0 ? choice->num_shifts : 1;
    S->point[0] = (ritz_krylov_point){0};
    for (int64_t k = 0; k < choice->num_shifts; k++) {
        int64_t at = k;

        for (; at > 0 && S->point[at - 1].hertz > choice->shift_hz[k]; at--)
            S->point[at] = S->point[at - 1];
        S->point[at] = (ritz_krylov_point){.hertz = choice->shift_hz[k]};
    }
}

static ritz_status factor_point(const ritz_elastic *body,
                                ritz_krylov_point *point)
{
    RITZ_OWN(ritz_sparse) A = {0};
    ritz_status status = RITZ_OK;

    point->sigma = ritz_eigen_lambda(point->hertz);
    if (point->hertz == 0.0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_add(1.0, body->K, -point->sigma, body->M, &A));
    status = ritz_ldl_new(&A, NULL, &point->A);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                   "expansion point %g Hz is a natural frequency: move it",
                   point->hertz);
    return status;
}

/* v'Mv must be positive for every v. */
static ritz_status check_mass(const ritz_sparse *M)
{
    RITZ_OWN(ritz_factor) *L = NULL;
    ritz_status status = ritz_factor_spd(M, &L);

    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                   "mass is singular, so it gives no inner product: take "
                   "stiffness");
    return status;
}

ritz_status ritz_krylov_new(const ritz_elastic *body,
                            const ritz_request *request, ritz_krylov *out)
{
    const ritz_choice *choice = &request->choice;
    RITZ_OWN(ritz_krylov) S = {.body = body, .inner = choice->inner};

    RITZ_REFUSE_IF(
        request->modes < 0, RITZ_ERR_ARGUMENT,
        "Krylov vectors have no frequency: ask for a number of them by "
        "--modes");
    S.vectors = request->modes < body->K->nrow ? request->modes : body->K->nrow;
    if (S.inner == RITZ_INNER_MASS && body->M->nrow > 0)
        RITZ_CHECK(check_mass(body->M));
    ritz_krylov_points(choice, &S);
    for (int64_t k = 0; k < S.num_points; k++)
        RITZ_CHECK(factor_point(body, &S.point[k]));
    RITZ_CHECK(ritz_orthonormal_new(
        body->K->nrow, S.inner == RITZ_INNER_MASS ? body->M : body->K,
        request->tolerance, &S.set));
    S.set.expected = S.vectors;
    RITZ_MOVE(*out, S);
    return RITZ_OK;
}

void ritz_krylov_size(const ritz_sparse *A, const ritz_dense *X, double factor,
                      ritz_dense *size)
{
    for (int64_t k = 0; k < X->ncol; k++) {
        const double *x = ritz_dense_col(X, k);
        double *out = ritz_dense_col(size, k);

        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
                out[A->rowind[p]] += factor * fabs(A->val[p] * x[j]);
    }
}

/* size += |M Phi| |Phi' G|: the forces that P removes. */
static ritz_status add_rigid_size(const ritz_elastic *E, const ritz_dense *G,
                                  ritz_dense *size)
{
    RITZ_OWN(ritz_dense) part = {0};

    if (E->Phi.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul_tn(&E->Phi, G, &part));
    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t k = 0; k < part.nrow; k++)
            for (int64_t i = 0; i < G->nrow; i++)
                ritz_dense_col(size, j)[i] +=
                    fabs(ritz_dense_col(&E->MPhi, k)[i] *
                         ritz_dense_col(&part, j)[k]);
    return RITZ_OK;
}

/* Responses X to the forces G, which are sums of terms of magnitude `size`;
   {0}: of one term each. */
typedef struct responses {
    const ritz_dense *G, *size;
    ritz_dense *X;
} responses;

/* Columns of X whose forces cancel are rounding: they become zero. */
static void clear_rounding(int thread, int64_t from, int64_t to, void *task)
{
    const responses *t = task;
    const int64_t n = t->X->nrow;

    (void)thread;
    for (int64_t j = from; j < to; j++) {
        const double *g = ritz_dense_col(t->G, j);
        const double *all = t->size->val ? ritz_dense_col(t->size, j) : g;
        double *x = ritz_dense_col(t->X, j);
        double left = 0.0;
        double before = 0.0;

        for (int64_t i = 0; i < n; i++) {
            left += fabs(g[i] * x[i]);
            before += fabs(all[i] * x[i]);
        }
        if (!(left > RITZ_FORCE_RELIEVED * before) && n > 0)
            memset(x, 0, (size_t)n * sizeof *x);
    }
}

static void clear_responses(const ritz_dense *G, const ritz_dense *size,
                            ritz_dense *X)
{
    const int64_t columns = X->nrow < WORTHWHILE ? 1 : X->ncol;

    ritz_team_over(ritz_team_ready(columns), X->ncol, clear_rounding,
                   &(responses){G, size, X});
}

ritz_status ritz_krylov_respond(const ritz_krylov *S,
                                const ritz_krylov_point *point,
                                const ritz_forces *forces, ritz_dense *R)
{
    const bool free = S->body->Phi.ncol > 0;
    RITZ_OWN(ritz_dense) PG = {0}, size = {0}, X = {0};

    RITZ_CHECK(ritz_dense_copy(&forces->G, &X));
    if (free) {
        RITZ_CHECK(forces->size.val ? ritz_dense_copy(&forces->size, &size)
                                    : ritz_dense_abs(&forces->G, &size));
        RITZ_CHECK(add_rigid_size(S->body, &forces->G, &size));
        RITZ_CHECK(ritz_elastic_relieve(S->body, &X));
        RITZ_CHECK(ritz_dense_copy(&X, &PG));
    }
    RITZ_CHECK(ritz_elastic_respond(S->body, point->A, &X));
    clear_responses(free ? &PG : &forces->G, free ? &size : &forces->size, &X);
    RITZ_MOVE(*R, X);
    return RITZ_OK;
}

/* Append the responses at a point to columns of F from `first` on. They are
   found for as many columns at a time as a solve takes, so that little else is
   held. @param[in] last  F is needed no more, and is overwritten */
static ritz_status append_loads(ritz_krylov *S, const ritz_krylov_point *point,
                                const ritz_dense *F, int64_t first, bool last,
                                int64_t most, bool *taken)
{
    const int64_t all = F->ncol - first;
    RITZ_OWN(ritz_dense) own = {0};
    ritz_dense R = {0};

    if (!last)
        RITZ_CHECK(ritz_tall_new(F->nrow, all, &own));
    R = last ? ritz_dense_part(F, first, all) : own;
    for (int64_t j = 0; j < all; j += RITZ_SOLVE_WIDTH) {
        const int64_t left = all - j;
        RITZ_OWN(ritz_forces) forces = {0};
        RITZ_OWN(ritz_dense) X = {0};

        RITZ_CHECK(ritz_dense_columns(
            F, first + j, left < RITZ_SOLVE_WIDTH ? left : RITZ_SOLVE_WIDTH,
            &forces.G));
        RITZ_CHECK(ritz_krylov_respond(S, point, &forces, &X));
        ritz_dense_put(&X, 0, j, &R);
    }
    return ritz_orthonormal_append(&S->set, &R, most, taken);
}

/*
 * Append the responses to the inertia forces M Q of the last block of a point,
 * for as many columns at a time as a solve takes, until there are enough: of a
 * block that is cut, which is the last one, no more responses are found than
 * that takes. Each sixteen columns of Q begin with the most independent ones.
 */
static ritz_status append_inertia(ritz_krylov *S, ritz_krylov_point *point,
                                  int64_t most)
{
    const int64_t before = S->set.count;
    int64_t j = 0;

    S->set.left = 0;
    while (j < point->count && S->set.left == 0 &&
           S->set.count - before < most) {
        const int64_t left = point->count - j;
        const ritz_dense Q =
            ritz_dense_part(&S->set.V, point->first + j,
                            left < RITZ_SOLVE_WIDTH ? left : RITZ_SOLVE_WIDTH);
        RITZ_OWN(ritz_forces) forces = {0};
        RITZ_OWN(ritz_dense) R = {0};

        RITZ_CHECK(
            ritz_sparse_mul_sizes(S->body->M, &Q, &forces.G, &forces.size));
        RITZ_CHECK(ritz_krylov_respond(S, point, &forces, &R));
        j += R.ncol;
        RITZ_CHECK(ritz_orthonormal_append(
            &S->set, &R, most - (S->set.count - before), NULL));
    }
    point->cut = S->set.left > 0 || j < point->count;
    return RITZ_OK;
}

/*
 * The static response to the forces F becomes the first columns of V, in
 * addition to the requested vectors; taken[j] is false where it depends on
 * others.
 */
static ritz_status seed_vectors(ritz_krylov *S, const ritz_dense *F,
                                bool *taken)
{
    const ritz_krylov_point at_rest = {0};

    RITZ_CHECK(append_loads(S, &at_rest, F, 0, false, F->ncol, taken));
    S->seeds = S->set.count;
    S->set.expected += S->seeds;
    return RITZ_OK;
}

/*
 * The next block of a point: with F the first, which at 0 Hz includes the
 * seeds, else that of the inertia forces of the last one.
 */
static ritz_status advance_point(ritz_krylov *S, const ritz_dense *F,
                                 int64_t seeded, ritz_krylov_point *point)
{
    const int64_t first = point->A ? 0 : seeded;
    const bool last = first == seeded && point == &S->point[S->num_points - 1];
    const int64_t before = S->set.count;
    const int64_t most = S->vectors + S->seeds - before;

    if (F)
        RITZ_CHECK(append_loads(S, point, F, first, last, most, NULL));
    else
        RITZ_CHECK(append_inertia(S, point, most));
    if (F)
        point->cut = S->set.left > 0;
    point->first = F && !point->A && before == S->seeds ? 0 : before;
    point->count = S->set.count - point->first;
    point->ended = point->count == 0;
    point->whole += !point->ended && !point->cut;
    return RITZ_OK;
}

ritz_status ritz_krylov_run(ritz_krylov *S, ritz_dense *F, int64_t seeded)
{
    const int64_t full = S->vectors + S->seeds;
    bool moving = true;

    for (int64_t block = 0; moving && S->set.count < full; block++) {
        moving = false;
        for (int64_t k = 0; k < S->num_points && S->set.count < full; k++) {
            ritz_krylov_point *point = &S->point[k];

            if (point->ended)
                continue;
            RITZ_CHECK(advance_point(S, block == 0 ? F : NULL, seeded, point));
            moving = moving || !point->ended;
        }
    }
    return RITZ_OK;
}

void ritz_forces_free(ritz_forces *forces)
{
    ritz_dense_free(&forces->G);
    ritz_dense_free(&forces->size);
}

void ritz_krylov_free(ritz_krylov *S)
{
    for (int64_t k = 0; k < S->num_points; k++)
        ritz_ldl_free(&S->point[k].A);
    ritz_orthonormal_free(&S->set);
    *S = (ritz_krylov){0};
}

static ritz_status measure_orthonormality(const ritz_krylov *S, double *worst,
                                          double *bound)
{
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    const ritz_dense WV = ritz_dense_part(&S->set.WV, 0, S->set.count);
    RITZ_OWN(ritz_dense) G = {0};

    RITZ_CHECK(ritz_tall_inner(&V, &WV, &G));
    for (int64_t j = 0; j < G.ncol; j++)
        ritz_dense_col(&G, j)[j] -= 1.0;
    *worst = ritz_dense_max(&G);
    *bound = RITZ_SUMMED_ROUNDING * DBL_EPSILON * S->set.terms;
    return RITZ_OK;
}

ritz_status ritz_krylov_sign(const ritz_krylov *S, int64_t wanted,
                             ritz_basis *basis)
{
    int64_t found = S->set.count - S->seeds;
    double worst = 0.0;
    double bound = 0.0;

    RITZ_CHECK(measure_orthonormality(S, &worst, &bound));
    snprintf(basis->origin.engine, sizeof basis->origin.engine, "CHOLMOD%s",
             S->point[S->num_points - 1].A ? " + MUMPS" : "");
    if (found < wanted)
        ritz_remark_add(basis, "; ",
                        "%" PRId64 " vectors and not %" PRId64
                        ", nothing new is left",
                        found, wanted);
    for (int64_t k = 0; k < S->num_points; k++)
        ritz_remark_add(basis, k > 0 ? ", " : "; ",
                        "%" PRId64 " whole block(s) about %g Hz",
                        S->point[k].whole, S->point[k].hertz);
    ritz_remark_add(basis, "; ", "|V'%sV - I| is %.1e, %s %.1e",
                    S->inner == RITZ_INNER_MASS ? "M" : "K", worst,
                    worst <= bound ? "within" : "beyond", bound);
    return RITZ_OK;
}

ritz_status ritz_krylov_join(const ritz_krylov *S, ritz_basis *out)
{
    const ritz_dense *Phi = &S->body->Phi;
    const ritz_dense V = ritz_dense_part(&S->set.V, 0, S->set.count);
    int64_t r = Phi->ncol;

    RITZ_REFUSE_IF(r + V.ncol == 0, RITZ_ERR_ARGUMENT,
                   "the basis would have no vectors");
    RITZ_CHECK(ritz_basis_new(S->body->K->nrow, r + V.ncol, out));
    ritz_dense_put(Phi, 0, 0, &out->T);
    ritz_dense_put(&V, 0, r, &out->T);
    for (int64_t j = 0; j < r + V.ncol; j++)
        out->columns.kind[j] = RITZ_COLUMN_KRYLOV;
    for (int64_t j = 0; j < r; j++) {
        ritz_columns_label_rigid(j, &out->columns);
        out->columns.residual[j] = S->body->residual[j];
    }
    return RITZ_OK;
}

/*
 * Krylov reduction: rigid modes and block Krylov vectors as above, with inputs
 * B and outputs C among the loads F [McDaniel2000, sec. 3.2.3]. About 0 Hz a
 * free body has moments of its elastic part: rigid modes are decoupled first.
 *
 * tests/unit/bases/test_krylov.c holds the code to the published example of
 * [McDaniel2000], to moments about 0 Hz and elsewhere, and to the block
 * tridiagonal V'MV that full reorthogonalisation must leave.
 */

/*
 * Free-interface Krylov component modes: rigid modes, the elastic static
 * response to unit forces F_a at the attached dofs, and the block Krylov
 * vectors that follow from them [CraigHale1988; CraigSuKim1992, sec. 4],
 *
 *     T = [Phi_r, X_a, V],   X_a = P' S P F_a,
 *     span [X_a, V] = span of (A^-1 M)^j A^-1 F,   F = [F_a, other loads]
 *
 * X_a are the inertia-relief attachment modes; V is K-orthogonal to them. The
 * method relates to residual flexibility with free modes [Rubin1975] as
 * fixed-interface Krylov vectors do to Craig and Bampton's. The elastic moments
 * about 0 Hz between attached dofs are kept, two for each whole block.
 */

/*
 * Replace the Krylov columns of the seeds by the static responses to F_a
 * themselves.
 */
static ritz_status restore_attachment(const ritz_request *request,
                                      const ritz_krylov *S,
                                      const ritz_dense *F_a, const bool *taken,
                                      ritz_basis *basis)
{
    RITZ_OWN(ritz_dense) X = {0};
    int64_t at = S->body->Phi.ncol;

    RITZ_CHECK(ritz_dense_copy(F_a, &X));
    RITZ_CHECK(ritz_elastic_respond(S->body, NULL, &X));
    for (int64_t j = 0; j < X.ncol; j++) {
        const ritz_dense x = ritz_dense_part(&X, j, 1);

        if (!taken[j])
            continue;
        basis->columns.kind[at] = RITZ_COLUMN_ATTACHMENT;
        basis->columns.dof[at] = request->attached.at[j];
        ritz_dense_put(&x, 0, at++, &basis->T);
    }
    if (S->seeds < F_a->ncol)
        ritz_remark_add(basis, "; ",
                        "%" PRId64 " attachment mode(s) left out, dependent or "
                        "nothing but rigid",
                        F_a->ncol - S->seeds);
    return RITZ_OK;
}

/* With @p attached, X_a come first, and F_a is the first part of F. */
static ritz_status make_vectors(const ritz_request *request, bool attached,
                                ritz_basis *out)
{
    const ritz_component *component = request->component;
    int loads = ritz_krylov_loads(request, attached);
    int64_t seeds = attached ? request->attached.count : 0;
    RITZ_OWN(ritz_dense) F = {0};
    RITZ_OWN_ARRAY int64_t *dof = NULL;
    RITZ_OWN_ARRAY bool *taken = NULL;
    RITZ_OWN(ritz_elastic) body = {0};
    RITZ_OWN(ritz_krylov) S = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_dense F_a = {0};

    RITZ_CHECK(ritz_loads_collect(
        request, loads | (attached ? RITZ_LOADS_ATTACHED : 0), &F, &dof));
    F_a = ritz_dense_part(&F, 0, seeds);
    RITZ_CHECK_NEW(taken, seeds);
    RITZ_CHECK(
        ritz_elastic_new(&component->K, &component->M, request->known, &body));
    RITZ_CHECK(ritz_krylov_new(&body, request, &S));
    if (attached)
        RITZ_CHECK(seed_vectors(&S, &F_a, taken));
    RITZ_CHECK(ritz_krylov_run(&S, &F, seeds));
    RITZ_CHECK(ritz_krylov_join(&S, &basis));
    if (attached)
        RITZ_CHECK(restore_attachment(request, &S, &F_a, taken, &basis));
    RITZ_CHECK(ritz_krylov_sign(&S, request->modes, &basis));
    ritz_remark_dampers(request, loads, &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

static ritz_status make_krylov(const ritz_request *request, ritz_basis *out)
{
    if (request->space)
        return ritz_krylov_of_space(request, out);
    RITZ_REFUSE_IF(request->choice.given & RITZ_USES_SIDES &&
                       !request->choice.one_sided,
                   RITZ_ERR_ARGUMENT,
                   "one set of vectors serves both sides of a component: only "
                   "a state space has a choice of sides");
    return make_vectors(request, false, out);
}

const ritz_method ritz_method_krylov = {
    .name = "krylov",
    .summary = "rigid modes and block Krylov vectors of the loads",
    .reference = "CraigSuKim1992",
    .when = "few inputs and outputs, a response over a band",
    .cost = "a factor a point, a solve a vector, no eigenvalues but rigid ones",
    .holds = "moments of the response at each point; static gain at 0 Hz",
    .fails = "interfaces with many dofs: a block is as wide as they are many",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_SHIFTS |
            RITZ_USES_LOADS | RITZ_USES_INNER | RITZ_USES_SIDES |
            RITZ_USES_SPACE,
    .nested = true,
    .make = make_krylov,
};

static ritz_status make_krylov_free(const ritz_request *request,
                                    ritz_basis *out)
{
    return make_vectors(request, true, out);
}

const ritz_method ritz_method_krylov_cms_free = {
    .name = "krylov-cms-free",
    .summary = "rigid, attachment and free-interface block Krylov vectors",
    .reference = "CraigHale1988",
    .when = "as macneal-rubin, without flexible eigenvalues",
    .cost = "a factor, one solve a vector, two an attached dof",
    .holds = "flexible static gain and moments at the attached dofs",
    .fails = "upper modes of the band: less exact than with normal modes",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_SHIFTS |
            RITZ_USES_LOADS | RITZ_USES_INNER,
    .keeps_interface = true,
    .nested = true,
    .make = make_krylov_free,
};
