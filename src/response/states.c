/*
 * Response of a model in first-order form,
 *
 *     H = C (i w I - A)^-1 B + D,
 *
 * by SLICOT TB05AD: A is scaled and brought to Hessenberg form once, and each
 * point then costs n^2 operations.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/split.h"
#include "response/responder.h"

#include <ritz/model.h>

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The Fortran name; character arguments bring their lengths at the end. */
void tb05ad_(/* NOLINT: its name */ const char *baleig, const char *inita,
             const int *n, const int *m, const int *p,
             const double _Complex *freq, double *A, const int *lda, double *B,
             const int *ldb, double *C, const int *ldc, double *rcond,
             double _Complex *G, const int *ldg, double *re, double *im,
             double _Complex *hinvb, const int *ldhinv, int *iwork,
             double *work, const int *ldwork, double _Complex *zwork,
             const int *lzwork, int *info, size_t baleig_length,
             size_t inita_length);

/*
 * The model in the form that SLICOT keeps between points, and its work space.
 */
typedef struct state_responder {
    ritz_poles poles;
    const ritz_state_space *model; /* borrowed; or `made` */
    ritz_state_space made;         /* dense copy of a sparse model */
    int n, m, p;
    bool begun;
    ritz_dense A, B, C;
    int *iwork;
    double *re, *im, *work;
    double _Complex *G, *X, *zwork; /* p x m; n x m */
    int room, zroom;
} state_responder;

static int at_least_one(int n)
{
    return n > 1 ? n : 1;
}

static ritz_status start_hessenberg(state_responder *h)
{
    const ritz_state_space *model = h->model;
    int n = (int)model->A.nrow;

    h->n = n;
    h->m = (int)model->num_inputs;
    h->p = (int)model->num_outputs;
    h->room = at_least_one(3 * n + (n > h->m ? n : h->m) + h->p);
    h->zroom = at_least_one(n * n + 2 * n);
    RITZ_CHECK(ritz_split_scaled(&model->A, &model->E, &model->B, &model->C,
                                 &h->A, &h->B, &h->C));
    RITZ_CHECK_NEW(h->iwork, n + 1);
    RITZ_CHECK_NEW(h->re, n + 1);
    RITZ_CHECK_NEW(h->im, n + 1);
    RITZ_CHECK_NEW(h->work, h->room);
    RITZ_CHECK_NEW(h->G, (int64_t)h->p * h->m);
    RITZ_CHECK_NEW(h->X, (int64_t)n * h->m);
    RITZ_CHECK_NEW(h->zwork, h->zroom);
    return RITZ_OK;
}

static void free_states(void *state)
{
    state_responder *h = state;

    ritz_poles_free(&h->poles);
    ritz_state_space_free(&h->made);
    ritz_dense_free(&h->A);
    ritz_dense_free(&h->B);
    ritz_dense_free(&h->C);
    RITZ_FREE(h->iwork, h->re, h->im, h->work, h->G, h->X, h->zwork);
}

static ritz_status solve_hessenberg(state_responder *h, double hertz)
{
    const double _Complex s = ritz_complex(0.0, 2.0 * RITZ_PI * hertz);
    int ldn = at_least_one(h->n);
    int ldp = at_least_one(h->p);
    double rcond = 0.0;
    int info = 0;

    tb05ad_("C", h->begun ? "H" : "G", &h->n, &h->m, &h->p, &s, h->A.val, &ldn,
            h->B.val, &ldn, h->C.val, &ldp, &rcond, h->G, &ldp, h->re, h->im,
            h->X, &ldn, h->iwork, h->work, &h->room, h->zwork, &h->zroom, &info,
            1, 1);
    h->begun = true;
    RITZ_REFUSE_IF(
        info == 2, RITZ_ERR_SINGULAR,
        "%.9g Hz is the frequency of a pole: an undamped mode, or at "
        "0 Hz a rigid-body motion",
        hertz);
    RITZ_REFUSE_IF(info != 0, RITZ_ERR_CONVERGENCE,
                   "the poles were not found, SLICOT says %d", info);
    return RITZ_OK;
}

/* Poles with Im s >= 0 as modes, for a grid that is refined around them. */
static ritz_status find_poles(const ritz_state_space *model, ritz_poles *out)
{
    int64_t count = 0;
    RITZ_OWN_ARRAY double _Complex *s = NULL;
    ritz_io io; /* borrowed */

    RITZ_CHECK(ritz_state_space_poles(model, &count, &s));
    RITZ_CHECK_NEW(out->lambda, count);
    RITZ_CHECK_NEW(out->rate, count);
    for (int64_t k = 0; k < count; k++) {
        if (cimag(s[k]) < 0.0)
            continue;
        out->lambda[out->count] = pow(cabs(s[k]), 2.0);
        out->rate[out->count++] = fmax(-2.0 * creal(s[k]), 0.0);
    }
    io = ritz_model_io(ritz_model_of_states(model));
    return ritz_poles_name(&io, out);
}

static ritz_status states_at(void *state, double hertz, double _Complex *H)
{
    state_responder *h = state;

    RITZ_CHECK(solve_hessenberg(h, hertz));
    for (int i = 0; i < h->p; i++)
        for (int j = 0; j < h->m; j++)
            H[i * h->m + j] =
                h->G[i + j * h->p] + ritz_dense_col(&h->model->D, j)[i];
    return RITZ_OK;
}

static ritz_status make_states(const ritz_response_request *request,
                               ritz_responder *out)
{
    state_responder *s = NULL;

    RITZ_CHECK_NEW(s, 1);
    out->state = s;
    out->free = free_states;
    out->poles = &s->poles;
    out->at = states_at;
    RITZ_CHECK(
        ritz_state_space_dense(request->model.states, &s->made, &s->model));
    memcpy(out->damping, s->model->damping, sizeof out->damping);
    RITZ_CHECK(find_poles(s->model, &s->poles));
    return start_hessenberg(s);
}

const ritz_response_engine ritz_response_engine_states = {
    .name = "states",
    .summary = "of a state space, by its Hessenberg form",
    .reference = "KenneyStubberudLaub1992",
    .when = "state spaces",
    .cost = "O(n^3), then O(n^2) a point and input",
    .holds = "exact to rounding",
    .fails = "a point on a pole is refused",
    .takes = RITZ_MODEL_STATES,
    .make = make_states,
};
