/*
 * The library of a switched model, and the full model in its coordinates.
 *
 *     Phi = [library | rest],   Phi'M Phi = I
 *
 * The columns `rest` span the parts of the initial state and of impulses that
 * are orthogonal to the library. A library that is orthonormal in W = I has
 * columns V with M V = V diag(mu), as the condition of stability requires. Its
 * columns of Phi are V diag(mu)^(-1/2), which have the same projectors.
 */
#include "simulate/switched.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/orthonormal.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* What a library is made of. */
typedef struct library_work {
    const ritz_motion *full;
    const ritz_sparse *mass_matrix;
    const ritz_sparse *W; /* of the inner product; NULL: I */
    ritz_sparse M;        /* the mass of a dense model */
    ritz_effective mass;
    ritz_dense V, WV; /* n x columns, orthonormal in W */
    int64_t count;    /* number of columns of V */
    double *work, *product;
} library_work;

static void library_work_free(library_work *b)
{
    ritz_sparse_free(&b->M);
    ritz_effective_free(&b->mass);
    ritz_dense_free(&b->V);
    ritz_dense_free(&b->WV);
    RITZ_FREE(b->work, b->product);
}

static void multiply(const library_work *b, ritz_term term, const double *x,
                     double *y)
{
    memset(y, 0, (size_t)b->full->n * sizeof *y);
    ritz_motion_add(b->full, term, 1.0, x, y);
}

/* y = W x */
static void weigh(const library_work *b, const double *x, double *y)
{
    if (b->W)
        multiply(b, RITZ_MASS, x, y);
    else
        memcpy(y, x, (size_t)b->full->n * sizeof *y);
}

/*
 * Append to V the part of x that is orthogonal to V, by Gram-Schmidt, which is
 * done twice. A vector that depends on V adds nothing. x itself is only scaled
 * to the length 1 in W.
 */
static ritz_status append_vector(library_work *b, double *x, bool *taken)
{
    const int64_t n = b->full->n;
    double size = 0.0, rest = 0.0;

    *taken = false;
    weigh(b, x, b->product);
    size = ritz_motion_dot(n, x, b->product);
    RITZ_REFUSE_IF(size < 0.0, RITZ_ERR_SINGULAR, "M is not definite");
    if (!(size > 0.0))
        return RITZ_OK;
    for (int64_t i = 0; i < n; i++)
        b->work[i] = x[i] /= sqrt(size);
    for (int64_t j = 0; j < 2 * b->count; j++) {
        const int64_t k = j % b->count;
        const double part =
            ritz_motion_dot(n, ritz_dense_col(&b->WV, k), b->work);

        for (int64_t i = 0; i < n; i++)
            b->work[i] -= part * ritz_dense_col(&b->V, k)[i];
    }
    weigh(b, b->work, b->product);
    rest = ritz_motion_dot(n, b->work, b->product);
    if (!(rest > RITZ_DEPENDENT * RITZ_DEPENDENT) || b->count == n)
        return RITZ_OK;
    for (int64_t i = 0; i < n; i++) {
        ritz_dense_col(&b->V, b->count)[i] = b->work[i] / sqrt(rest);
        ritz_dense_col(&b->WV, b->count)[i] = b->product[i] / sqrt(rest);
    }
    b->count++;
    *taken = true;
    return RITZ_OK;
}

/* Coordinates V'W x of a candidate of length one. */
static void express_vector(const library_work *b, const double *x, double *out)
{
    for (int64_t k = 0; k < b->count; k++)
        out[k] = ritz_motion_dot(b->full->n, ritz_dense_col(&b->WV, k), x);
}

static ritz_status check_matrix(const ritz_motion *full, const ritz_dense *T)
{
    RITZ_REFUSE_IF(T->nrow != full->n, RITZ_ERR_ARGUMENT,
                   "a library of %" PRId64 " rows is of another model than "
                   "this one of %" PRId64,
                   T->nrow, full->n);
    for (int64_t k = 0; k < T->nrow * T->ncol; k++)
        RITZ_REFUSE_IF(!isfinite(T->val[k]), RITZ_ERR_ARGUMENT,
                       "a vector of the library is not finite");
    return RITZ_OK;
}

/* All candidates, side by side. */
static ritz_status gather(const ritz_switched *switched,
                          const ritz_motion *full, ritz_dense *out)
{
    int64_t count = 0, at = 0;

    for (int64_t k = 0; k < switched->num_libraries; k++) {
        RITZ_CHECK(check_matrix(full, &switched->library[k]));
        count += switched->library[k].ncol;
    }
    RITZ_REFUSE_IF(count == 0, RITZ_ERR_ARGUMENT, "the library is empty");
    RITZ_CHECK(ritz_dense_new(full->n, count, out));
    for (int64_t k = 0; k < switched->num_libraries; k++) {
        ritz_dense_put(&switched->library[k], 0, at, out);
        at += switched->library[k].ncol;
    }
    return RITZ_OK;
}

/* V, and the coordinates of the candidates in it. */
static ritz_status take_candidates(const ritz_switched *switched,
                                   ritz_dense *all, library_work *b,
                                   ritz_library *out)
{
    const int64_t given = all->ncol;
    bool taken = false;

    for (int64_t k = 0; k < given; k++)
        RITZ_CHECK(append_vector(b, ritz_dense_col(all, k), &taken));
    RITZ_REFUSE_IF(b->count == 0, RITZ_ERR_ARGUMENT,
                   "the library has no vector that is not zero");
    out->span = b->count;
    out->redundant = switched->redundant;
    out->share_of_library = switched->share_of_library;
    if (!switched->redundant) {
        out->num_vectors = out->span;
        return ritz_dense_identity(out->span, &out->vector);
    }
    RITZ_CHECK(ritz_dense_new(out->span, given, &out->vector));
    out->num_vectors = given;
    for (int64_t k = 0; k < given; k++)
        express_vector(b, ritz_dense_col(all, k),
                       ritz_dense_col(&out->vector, k));
    return RITZ_OK;
}

/* Append the parts of initial values and impulses outside the library. */
static ritz_status take_rest(const ritz_simulation_request *request,
                             library_work *b)
{
    const int64_t n = b->full->n;
    const double *const starts[] = {request->x0, request->v0};
    RITZ_OWN(ritz_dense) x = {0};
    bool taken = false;

    RITZ_CHECK(ritz_dense_new(n, 1, &x));
    for (int k = 0; k < 2; k++) {
        if (!starts[k])
            continue;
        memcpy(x.val, starts[k], (size_t)n * sizeof *x.val);
        RITZ_CHECK(append_vector(b, x.val, &taken));
    }
    for (int64_t j = 0; request->signal && j < b->full->push.ncol; j++) {
        if (request->signal[j].kind != RITZ_SIGNAL_IMPULSE)
            continue;
        memcpy(x.val, ritz_dense_col(&b->full->push, j),
               (size_t)n * sizeof *x.val);
        RITZ_CHECK(append_vector(b, x.val, &taken));
    }
    return RITZ_OK;
}

/* Replace a column v of V, with M v = mu v, by v / sqrt(mu); refuse a column
   that is no eigenvector of M. */
static ritz_status scale_vector(library_work *b, int64_t k, double *scale)
{
    const int64_t n = b->full->n;
    double *v = ritz_dense_col(&b->V, k), *Mv = ritz_dense_col(&b->WV, k);
    double mu = 0.0, off = 0.0;

    multiply(b, RITZ_MASS, v, Mv);
    mu = ritz_motion_dot(n, v, Mv);
    RITZ_REFUSE_IF(!(mu > 0.0), RITZ_ERR_SINGULAR, "M is not definite");
    for (int64_t i = 0; i < n; i++)
        off = fmax(off, fabs(Mv[i] - mu * v[i]));
    RITZ_REFUSE_IF(
        off > RITZ_COMMUTES * mu, RITZ_ERR_ARGUMENT,
        "vectors that are orthonormal in the Euclidean inner product "
        "have a common Lyapunov function only if each is an "
        "eigenvector of M: vector %" PRId64 " is off by %.1e, use "
        "the inner product of the mass",
        k + 1, off / mu);
    *scale = 1.0 / sqrt(mu);
    for (int64_t i = 0; i < n; i++) {
        v[i] *= *scale;
        Mv[i] *= *scale;
    }
    return RITZ_OK;
}

/* Replace V by Phi, which is orthonormal in M for both W. */
static ritz_status scale_frame(library_work *b, ritz_library *out)
{
    RITZ_CHECK_NEW(out->scale, b->V.ncol);
    for (int64_t k = 0; k < b->V.ncol; k++)
        out->scale[k] = 1.0;
    for (int64_t k = 0; !b->W && k < b->count; k++)
        RITZ_CHECK(scale_vector(b, k, &out->scale[k]));
    b->W = b->mass_matrix;
    return RITZ_OK;
}

/* [Phi, -M^-1 K Phi, -M^-1 D Phi, M^-1 B] */
static ritz_status fill_terms(library_work *b, const ritz_library *library,
                              ritz_dense *out)
{
    const int64_t n = library->n, rows = b->full->n;
    const ritz_dense *Phi = &library->Phi;

    RITZ_CHECK(ritz_dense_new(rows, 3 * n + b->full->B.ncol, out));
    ritz_dense_put(Phi, 0, 0, out);
    for (int64_t j = 0; j < n; j++) {
        const double *phi = ritz_dense_col(Phi, j);

        ritz_motion_add(b->full, RITZ_STIFFNESS, -1.0, phi,
                        ritz_dense_col(out, n + j));
        ritz_motion_add(b->full, RITZ_DAMPING, -1.0, phi,
                        ritz_dense_col(out, 2 * n + j));
    }
    ritz_dense_put(&b->full->B, 0, 3 * n, out);
    return RITZ_OK;
}

/* Phi'K Phi, Phi'D Phi and Phi'B, from `terms` before M^-1 is applied. */
static ritz_status project_model(const ritz_dense *terms, ritz_library *out)
{
    const int64_t n = out->n;
    RITZ_OWN(ritz_dense) all = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&out->Phi, terms, &all));
    RITZ_CHECK(ritz_dense_block(&all, 0, n, n, n, &out->K));
    RITZ_CHECK(ritz_dense_block(&all, 0, n, 2 * n, n, &out->D));
    RITZ_CHECK(
        ritz_dense_block(&all, 0, n, 3 * n, terms->ncol - 3 * n, &out->B));
    for (int64_t k = 0; k < n * n; k++) {
        out->K.val[k] = -out->K.val[k];
        out->D.val[k] = -out->D.val[k];
    }
    ritz_dense_symmetrise(&out->K);
    return RITZ_OK;
}

/* The terms of R in an orthonormal basis that spans all of them. */
static ritz_status express_terms(const library_work *b, const ritz_sparse *W,
                                 ritz_dense *terms, ritz_library *out)
{
    const int64_t n = out->n, inputs = terms->ncol - 3 * n;
    RITZ_OWN(ritz_orthonormal) set = {0};
    RITZ_OWN(ritz_dense) at = {0};

    RITZ_CHECK(ritz_orthonormal_new(b->full->n, W, RITZ_DEPENDENT, &set));
    RITZ_CHECK(ritz_orthonormal_express(&set, terms, terms->ncol, &at));
    RITZ_CHECK(ritz_dense_columns(&at, 0, n, &out->S_x));
    RITZ_CHECK(ritz_dense_columns(&at, n, n, &out->S_k));
    RITZ_CHECK(ritz_dense_columns(&at, 2 * n, n, &out->S_d));
    return ritz_dense_columns(&at, 3 * n, inputs, &out->S_b);
}

/* Remove rounding from K and D, which are diagonal for modes: it would couple
   the modes. */
static void drop_rounding(ritz_dense *A)
{
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++) {
            const double both =
                fabs(ritz_dense_col(A, i)[i]) * fabs(ritz_dense_col(A, j)[j]);

            if (i != j &&
                fabs(ritz_dense_col(A, j)[i]) <= RITZ_COMMUTES * sqrt(both))
                ritz_dense_col(A, j)[i] = 0.0;
        }
}

/* Share of the initial state outside the library: the larger of x and v. */
static void find_outside(const ritz_simulation_request *request,
                         library_work *b, ritz_library *out)
{
    const double *const starts[] = {request->x0, request->v0};
    const int64_t n = b->full->n;

    for (int k = 0; k < 2; k++) {
        double whole = 0.0, part = 0.0;

        if (!starts[k])
            continue;
        multiply(b, RITZ_MASS, starts[k], b->work);
        whole = ritz_motion_dot(n, starts[k], b->work);
        for (int64_t j = 0; j < out->span; j++) {
            const double c =
                ritz_motion_dot(n, ritz_dense_col(&out->Phi, j), b->work);

            part += c * c;
        }
        if (whole > 0.0)
            out->outside =
                fmax(out->outside, sqrt(fmax(0.0, 1.0 - part / whole)));
    }
}

static ritz_status begin_work(const ritz_switched *switched,
                              const ritz_motion *full, int64_t most,
                              library_work *b)
{
    b->full = full;
    RITZ_REFUSE_IF(
        full->to.val, RITZ_ERR_SINGULAR,
        "motions without mass cannot be switched: condense them first");
    for (int64_t k = 0; full->massless && k < full->n; k++)
        RITZ_REFUSE_IF(
            full->massless[k], RITZ_ERR_SINGULAR,
            "dofs without mass cannot be switched: condense them first");
    RITZ_CHECK_IN("M",
                  ritz_effective_new(full, 1.0, 0.0, 0.0, false, &b->mass));
    if (full->form != RITZ_FORM_SPARSE)
        RITZ_CHECK(ritz_sparse_from_dense(&full->M, &b->M));
    b->mass_matrix = full->form == RITZ_FORM_SPARSE ? &full->sM : &b->M;
    b->W = switched->inner == RITZ_SWITCH_MASS ? b->mass_matrix : NULL;
    RITZ_CHECK(ritz_dense_new(full->n, most, &b->V));
    RITZ_CHECK(ritz_dense_new(full->n, most, &b->WV));
    RITZ_CHECK_NEW(b->work, full->n);
    RITZ_CHECK_NEW(b->product, full->n);
    return RITZ_OK;
}

ritz_status ritz_library_new(const ritz_simulation_request *request,
                             const ritz_switched *switched,
                             const ritz_motion *full, ritz_library *out)
{
    const int64_t inputs = full->B.ncol;
    RITZ_OWN(library_work) b = {0};
    RITZ_OWN(ritz_library) library = {0};
    RITZ_OWN(ritz_dense) all = {0}, terms = {0};
    const ritz_sparse *W = NULL;
    int64_t room = 0;

    RITZ_CHECK(gather(switched, full, &all));
    room = all.ncol < full->n ? all.ncol : full->n;
    RITZ_CHECK(begin_work(switched, full, room + 2 + inputs, &b));
    W = b.W;
    RITZ_CHECK(take_candidates(switched, &all, &b, &library));
    RITZ_CHECK(scale_frame(&b, &library));
    if (switched->jump == RITZ_SWITCH_OFFSET)
        RITZ_CHECK(take_rest(request, &b));
    library.n = b.count;
    RITZ_CHECK(ritz_dense_columns(&b.V, 0, library.n, &library.Phi));
    RITZ_CHECK(ritz_dense_columns(&b.WV, 0, library.n, &library.MPhi));
    if (switched->jump == RITZ_SWITCH_PROJECT)
        find_outside(request, &b, &library);
    RITZ_CHECK(fill_terms(&b, &library, &terms));
    RITZ_CHECK(project_model(&terms, &library));
    RITZ_CHECK(ritz_effective_solve(&b.mass, terms.ncol - library.n,
                                    ritz_dense_col(&terms, library.n)));
    RITZ_CHECK(express_terms(&b, W, &terms, &library));
    drop_rounding(&library.K);
    drop_rounding(&library.D);
    RITZ_MOVE(*out, library);
    return RITZ_OK;
}

void ritz_library_free(ritz_library *library)
{
    enum { MATRICES = 10 };
    ritz_dense *const all[MATRICES] = {
        &library->Phi, &library->MPhi, &library->vector, &library->K,
        &library->D,   &library->B,    &library->S_x,    &library->S_k,
        &library->S_d, &library->S_b};

    for (int k = 0; k < MATRICES; k++)
        ritz_dense_free(all[k]);
    RITZ_FREE(library->scale);
    *library = (ritz_library){0};
}

ritz_status ritz_library_columns(const ritz_library *library,
                                 const double *present, ritz_dense *U)
{
    const int64_t n = library->span;
    RITZ_OWN(ritz_dense) found = {0};
    int64_t count = 0;

    RITZ_CHECK(ritz_dense_new(n, n, &found));
    for (int64_t k = 0; k < library->num_vectors && count < n; k++) {
        double *u = ritz_dense_col(&found, count);

        if (present[k] == 0.0)
            continue;
        memcpy(u, ritz_dense_col(&library->vector, k), (size_t)n * sizeof *u);
        for (int64_t j = 0; library->redundant && j < 2 * count; j++) {
            const double *other = ritz_dense_col(&found, j % count);
            const double part = ritz_motion_dot(n, other, u);

            for (int64_t i = 0; i < n; i++)
                u[i] -= part * other[i];
        }
        const double size = sqrt(ritz_motion_dot(n, u, u));

        if (size <= RITZ_SWITCH_NEW)
            continue;
        for (int64_t i = 0; i < n; i++)
            u[i] /= size;
        count++;
    }
    return ritz_dense_columns(&found, 0, count, U);
}
