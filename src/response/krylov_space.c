#include "response/krylov_space.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "model/modal.h"
#include "poles/poles.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Append the columns of `more` to A; the room is doubled when it is used up. */
static ritz_status append_columns(ritz_dense *A, int64_t *room,
                                  const ritz_dense *more)
{
    int64_t ncol = A->ncol + more->ncol;
    double *val = NULL;

    if (ncol > *room) {
        RITZ_CHECK_NEW(val, more->nrow * 2 * ncol);
        if (A->ncol > 0)
            memcpy(val, A->val, (size_t)(A->nrow * A->ncol) * sizeof *val);
        free(A->val);
        A->val = val;
        *room = 2 * ncol;
    }
    A->nrow = more->nrow;
    if (more->ncol > 0)
        memcpy(A->val + A->nrow * A->ncol, more->val,
               (size_t)(more->nrow * more->ncol) * sizeof *val);
    A->ncol = ncol;
    return RITZ_OK;
}

/*
 * Append columns of one kind to W, their modal part projected out, and A^-1 of
 * them to S.
 */
static ritz_status add_columns(ritz_krylov_space *s, ritz_krylov_kind kind,
                               int64_t first, ritz_dense *W)
{
    RITZ_OWN(ritz_dense) S = {0};

    if (W->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_take_out(s->MPhi, s->Phi, W));
    RITZ_CHECK(ritz_dense_copy(W, &S));
    RITZ_CHECK(ritz_factor_solve(s->F, &S));
    for (int64_t k = 0; k < W->ncol; k++) {
        RITZ_CHECK_ROOM(s->column, s->W.ncol + k, s->column_room);
        s->column[s->W.ncol + k] = (ritz_krylov_column){kind, first + k};
    }
    RITZ_CHECK(append_columns(&s->S, &s->S_room, &S));
    return append_columns(&s->W, &s->W_room, W);
}

static ritz_status add_loads(ritz_krylov_space *s)
{
    const ritz_io *io = &s->component->io;
    const struct {
        const ritz_dense *rows;
        ritz_krylov_kind kind;
    } seen[] = {{&io->C, RITZ_KRYLOV_C},
                {&io->Cv, RITZ_KRYLOV_CV},
                {&io->Ca, RITZ_KRYLOV_CA}};
    RITZ_OWN(ritz_dense) W = {0};

    RITZ_CHECK(ritz_dense_copy(&io->B, &W));
    RITZ_CHECK(add_columns(s, RITZ_KRYLOV_B, 0, &W));
    for (size_t k = 0; k < sizeof seen / sizeof *seen; k++) {
        if (ritz_dense_max(seen[k].rows) == 0.0)
            continue;
        ritz_dense_free(&W);
        RITZ_CHECK(ritz_general_transpose(seen[k].rows, &W));
        RITZ_CHECK(add_columns(s, seen[k].kind, 0, &W));
    }
    return RITZ_OK;
}

/* Append the matrix of one kind times the columns of V from `first` on. */
static ritz_status add_product(ritz_krylov_space *s, ritz_krylov_kind kind,
                               const ritz_sparse *A, int64_t first,
                               const ritz_dense *X)
{
    RITZ_OWN(ritz_dense) W = {0};

    if (!A->colptr || X->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_sparse_mul(A, X, &W));
    return add_columns(s, kind, first, &W);
}

/* Append the products of the damping matrices with columns of V. */
static ritz_status add_damping(ritz_krylov_space *s, int64_t first,
                               const ritz_dense *X)
{
    RITZ_CHECK(add_product(s, RITZ_KRYLOV_D, &s->component->D, first, X));
    RITZ_CHECK(add_product(s, RITZ_KRYLOV_DT, &s->DT, first, X));
    return add_product(s, RITZ_KRYLOV_K4, &s->component->K4, first, X);
}

static ritz_status form_gram(ritz_krylov_space *s)
{
    ritz_dense_free(&s->G);
    RITZ_CHECK(ritz_dense_mul_tn(&s->W, &s->S, &s->G));
    ritz_dense_symmetrise(&s->G);
    return RITZ_OK;
}

ritz_status ritz_krylov_space_new(const ritz_direct *direct, double tau,
                                  ritz_krylov_space *out)
{
    const ritz_component *c = direct->component;
    RITZ_OWN(ritz_krylov_space)
    s = {.component = c,
         .tau = tau,
         .Phi = &direct->pairs.Phi,
         .MPhi = &direct->MPhi};

    RITZ_CHECK(ritz_sparse_add(1.0, &c->K, tau, &c->M, &s.A));
    RITZ_CHECK_IN("static solution", ritz_factor_spd(&s.A, &s.F));
    if (c->D.colptr && ritz_sparse_asymmetry(&c->D) > 0.0)
        RITZ_CHECK(ritz_sparse_transpose(&c->D, &s.DT));
    RITZ_CHECK(append_columns(&s.V, &s.V_room, s.Phi));
    RITZ_CHECK(add_loads(&s));
    RITZ_CHECK(add_damping(&s, 0, s.Phi));
    RITZ_CHECK(form_gram(&s));
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

/* x := x - X X'A x for the columns of X, and the norm of the result in A. */
static ritz_status orthogonalise_vector(const ritz_krylov_space *s,
                                        const ritz_dense *X, ritz_dense *x,
                                        double *length)
{
    RITZ_OWN(ritz_dense) Ax = {0}, part_of = {0}, part = {0};

    RITZ_CHECK(ritz_dense_take_out(s->Phi, s->MPhi, x));
    RITZ_CHECK(ritz_sparse_mul(&s->A, x, &Ax));
    RITZ_CHECK(ritz_dense_mul_tn(X, &Ax, &part_of));
    RITZ_CHECK(ritz_dense_mul(X, &part_of, &part));
    for (int64_t i = 0; i < x->nrow; i++)
        x->val[i] -= part.val[i];
    ritz_dense_free(&Ax);
    RITZ_CHECK(ritz_sparse_mul(&s->A, x, &Ax));
    *length = sqrt(fmax(ritz_dense_dot(x, 0, &Ax, 0), 0.0));
    return RITZ_OK;
}

/* Append one vector; orthogonalised twice, which is enough. */
static ritz_status add_vector(ritz_krylov_space *s, ritz_dense *x, bool *added)
{
    int64_t m = s->Phi->ncol;
    const ritz_dense none = {.nrow = x->nrow};
    ritz_dense X = ritz_dense_part(&s->V, m, s->V.ncol - m);
    double before = 0.0, length = 0.0;

    *added = false;
    if (s->V.ncol >= x->nrow)
        return RITZ_OK;
    RITZ_CHECK(orthogonalise_vector(s, &none, x, &before));
    for (int pass = 0; pass < 2; pass++) {
        RITZ_CHECK(orthogonalise_vector(s, &X, x, &length));
        if (!(length > RITZ_DEPENDENT * before) || !isfinite(length))
            return RITZ_OK;
    }
    for (int64_t i = 0; i < x->nrow; i++)
        x->val[i] /= length;
    RITZ_CHECK(append_columns(&s->V, &s->V_room, x));
    *added = true;
    return RITZ_OK;
}

ritz_status ritz_krylov_space_add(ritz_krylov_space *space, ritz_dense *X,
                                  int64_t *added)
{
    int64_t first = space->V.ncol;
    ritz_dense fresh = {0};

    for (int64_t k = 0; k < X->ncol; k++) {
        ritz_dense x = ritz_dense_part(X, k, 1);
        bool one = false;

        RITZ_CHECK(add_vector(space, &x, &one));
    }
    *added = space->V.ncol - first;
    fresh = ritz_dense_part(&space->V, first, *added);
    RITZ_CHECK(
        add_product(space, RITZ_KRYLOV_K, &space->component->K, first, &fresh));
    RITZ_CHECK(
        add_product(space, RITZ_KRYLOV_M, &space->component->M, first, &fresh));
    RITZ_CHECK(add_damping(space, first, &fresh));
    return form_gram(space);
}

void ritz_krylov_space_free(ritz_krylov_space *space)
{
    ritz_sparse_free(&space->A);
    ritz_factor_free(&space->F);
    ritz_sparse_free(&space->DT);
    ritz_dense_free(&space->V);
    ritz_dense_free(&space->W);
    ritz_dense_free(&space->S);
    ritz_dense_free(&space->G);
    free(space->column);
    *space = (ritz_krylov_space){0};
}

/* diag(leading, block). */
static ritz_status join_diagonal(int64_t m, const double *leading,
                                 const ritz_dense *block, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(m + block->nrow, m + block->ncol, out));
    for (int64_t k = 0; k < m; k++)
        ritz_dense_col(out, k)[k] = leading ? leading[k] : 1.0;
    ritz_dense_put(block, m, m, out);
    return RITZ_OK;
}

/* Modes keep their own eigenvalues, so that resonances lose no digits. */
static ritz_status project_block(const ritz_direct *direct,
                                 const ritz_krylov_space *space,
                                 ritz_reduced *out, ritz_dense *K_x,
                                 ritz_dense *M_x)
{
    const ritz_component *c = space->component;
    int64_t m = direct->m;
    const ritz_dense X = ritz_dense_part(&space->V, m, space->V.ncol - m);

    RITZ_CHECK(ritz_sparse_condense(&c->K, &X, K_x));
    RITZ_CHECK(ritz_sparse_condense(&c->M, &X, M_x));
    RITZ_CHECK(join_diagonal(m, direct->poles.lambda, K_x, &out->K));
    RITZ_CHECK(join_diagonal(m, NULL, M_x, &out->M));
    RITZ_CHECK(ritz_sparse_project(&c->D, &space->V, &out->D));
    RITZ_CHECK(ritz_sparse_project(&c->K4, &space->V, &out->K4));
    return ritz_io_project(&c->io, &space->V, &out->io);
}

/*
 * Eigenpairs of the projected component: its modes unchanged, and those of
 * (K_x, M_x).
 */
static ritz_status solve_pairs(const ritz_direct *direct, const ritz_dense *K_x,
                               const ritz_dense *M_x, ritz_pairs *out)
{
    RITZ_OWN(ritz_pairs) rest = {0};
    int64_t m = direct->m;

    if (K_x->ncol > 0)
        RITZ_CHECK(ritz_eigen_dense(K_x, M_x, &rest));
    out->num_rigid = direct->poles.num_rigid;
    RITZ_CHECK_NEW(out->lambda, m + K_x->ncol);
    memcpy(out->lambda, direct->poles.lambda, (size_t)m * sizeof *out->lambda);
    for (int64_t k = 0; k < rest.Phi.ncol; k++)
        out->lambda[m + k] = rest.lambda[k];
    return join_diagonal(m, NULL, &rest.Phi, &out->Phi);
}

/* Damping ratios belong to modes: the other coordinates lose theirs. */
static void remove_ratios(const ritz_direct *direct, ritz_poles *poles)
{
    for (int64_t k = direct->m; direct->ratios && k < poles->count; k++) {
        double given = ritz_modal_rate(&direct->damping, k - poles->num_rigid,
                                       poles->lambda[k]);

        poles->rate[k] -= given;
        if (poles->D.val)
            ritz_dense_col(&poles->D, k)[k] -= given;
    }
}

/* [C' Cv' Ca'], the load vectors of the transposed system. */
static ritz_status stack_outputs(const ritz_io *io, ritz_dense *out)
{
    const ritz_dense *const rows[] = {&io->C, &io->Cv, &io->Ca};
    int64_t p = io->num_outputs;

    RITZ_CHECK(ritz_dense_new(io->C.ncol, 3 * p, out));
    for (int k = 0; k < 3; k++)
        for (int64_t j = 0; j < out->nrow; j++)
            for (int64_t i = 0; i < p; i++)
                ritz_dense_col(out, k * p + i)[j] =
                    ritz_dense_col(rows[k], j)[i];
    return RITZ_OK;
}

ritz_status ritz_krylov_small_new(const ritz_direct *direct,
                                  const ritz_krylov_space *space,
                                  ritz_krylov_small *out)
{
    const ritz_io *io = &space->component->io;
    int64_t r = space->V.ncol, p = io->num_outputs, m = io->num_inputs;
    RITZ_OWN(ritz_krylov_small) small = {0};
    RITZ_OWN(ritz_dense) K_x = {0}, M_x = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    RITZ_OWN(ritz_reduced) a = {0}; /* in coordinates of V */
    const ritz_second_order model = ritz_model_of_reduced(&a, NULL).dense;

    RITZ_CHECK(project_block(direct, space, &a, &K_x, &M_x));
    RITZ_CHECK(solve_pairs(direct, &K_x, &M_x, &pairs));
    RITZ_CHECK(ritz_poles_of_pairs(&model, &direct->damping, true, &pairs,
                                   &small.poles));
    remove_ratios(direct, &small.poles);
    RITZ_CHECK(stack_outputs(&small.poles.io, &small.outputs_of));
    RITZ_MOVE(small.T, pairs.Phi);
    RITZ_CHECK_NEW(small.x, r * (m + p));
    RITZ_CHECK_NEW(small.z, r * (3 * p + m));
    RITZ_MOVE(*out, small);
    return RITZ_OK;
}

/* out = T z, columns of complex numbers. */
static void transform_back(const ritz_dense *T, int64_t columns,
                           const double _Complex *z, double _Complex *out)
{
    int64_t r = T->nrow;

    for (int64_t j = 0; j < columns; j++) {
        for (int64_t i = 0; i < r; i++)
            out[i + j * r] = 0.0;
        for (int64_t k = 0; k < T->ncol; k++) {
            const double *t = ritz_dense_col(T, k);

            for (int64_t i = 0; i < r; i++)
                out[i + j * r] += t[i] * z[k + j * T->ncol];
        }
    }
}

ritz_status ritz_krylov_small_solve(ritz_krylov_small *small, double hertz)
{
    double w = 2.0 * RITZ_PI * hertz;
    const ritz_io *io = &small->poles.io;
    int64_t rp = small->T.nrow * io->num_outputs;
    double _Complex *z = small->z;

    RITZ_CHECK(
        ritz_poles_solve(&small->poles, false, &small->poles.io.B, hertz, z));
    transform_back(&small->T, io->num_inputs, z, small->x);
    RITZ_CHECK(
        ritz_poles_solve(&small->poles, true, &small->outputs_of, hertz, z));
    for (int64_t k = 0; k < rp; k++)
        z[k] += ritz_complex(0.0, w) * z[rp + k] - w * w * z[2 * rp + k];
    transform_back(&small->T, io->num_outputs, z,
                   small->x + small->T.nrow * io->num_inputs);
    return RITZ_OK;
}

/*
 * Coefficients of the columns of W by kind: of output rows in the residual of
 * c, of each matrix in Z.
 */
static void set_coefficients(const ritz_direct *direct,
                             const ritz_krylov_space *space, double w,
                             bool dual, double _Complex *f)
{
    const double _Complex iw = ritz_complex(0.0, w);

    f[RITZ_KRYLOV_B] = dual ? 0.0 : 1.0;
    f[RITZ_KRYLOV_C] = dual ? 1.0 : 0.0;
    f[RITZ_KRYLOV_CV] = dual ? iw : 0.0;
    f[RITZ_KRYLOV_CA] = dual ? -w * w : 0.0;
    f[RITZ_KRYLOV_K] = -(1.0 + direct->b * iw);
    f[RITZ_KRYLOV_M] = w * w - direct->a * iw;
    f[RITZ_KRYLOV_D] = dual && space->DT.colptr ? 0.0 : -iw;
    f[RITZ_KRYLOV_DT] = dual ? -iw : 0.0;
    f[RITZ_KRYLOV_K4] = ritz_complex(0.0, -1.0);
}

void ritz_krylov_residual(const ritz_direct *direct,
                          const ritz_krylov_space *space,
                          const ritz_krylov_small *small, double hertz,
                          int64_t index, double _Complex *y)
{
    const double _Complex *x = small->x + index * small->T.nrow;
    const bool dual = index >= direct->inputs;
    int64_t own = dual ? index - direct->inputs : index;
    double _Complex f[RITZ_KRYLOV_K4 + 1];

    set_coefficients(direct, space, 2.0 * RITZ_PI * hertz, dual, f);
    for (int64_t k = 0; k < space->W.ncol; k++) {
        ritz_krylov_column c = space->column[k];

        if (c.kind <= RITZ_KRYLOV_CA)
            y[k] = c.index == own ? f[c.kind] : 0.0;
        else
            y[k] = f[c.kind] * x[c.index];
    }
}

double ritz_krylov_space_norm(const ritz_krylov_space *space,
                              const double _Complex *y)
{
    double sum = 0.0;
    int64_t n = space->G.ncol;

    for (int64_t j = 0; j < n; j++) {
        const double *g = ritz_dense_col(&space->G, j);
        double _Complex part = 0.0;

        if (y[j] == 0.0)
            continue;
        for (int64_t i = 0; i < n; i++)
            part += g[i] * y[i];
        sum += creal(part) * creal(y[j]) + cimag(part) * cimag(y[j]);
    }
    return sqrt(fmax(sum, 0.0));
}

void ritz_krylov_small_free(ritz_krylov_small *small)
{
    ritz_poles_free(&small->poles);
    ritz_dense_free(&small->outputs_of);
    ritz_dense_free(&small->T);
    RITZ_FREE(small->x, small->z);
    *small = (ritz_krylov_small){0};
}
