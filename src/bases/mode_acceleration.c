/*
 * Mode acceleration [CraigKurdila2006]: quantities y = S u are recovered from
 * the static response of the full model to all known forces, inertia forces
 * among them, instead of from T q. Let b be the dofs of the ports, whose
 * displacements (T q)_b are taken from the reduced model, i all other dofs, and
 * G = K_ii^-1 in rows and columns i and zero elsewhere. Then
 *
 *     u_i = K_ii^-1 (B f - M u'' - D u' - K_ib u_b)_i,   u = T q in M and D
 *     y = S u = S (I - G K) T q + S G B f - S G D T q' - S G M T q''
 *
 * The unknown forces at the ports act on b alone and do not appear.
 *
 * If i can move rigidly while b is at rest, by R = [0; R_i], then K_ii is
 * singular. G is then the elastic response of a free body (bases/elastic.h):
 * the loads are brought into equilibrium by inertia forces of R, and the
 * response is M-orthogonal to R. The missing rigid part does not matter to rows
 * with S R = 0, and other rows are refused.
 *
 * Tests compare it with static and harmonic responses of the full model, and
 * with the exact solution where T is square.
 */
#include "bases/elastic.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/basis.h>

#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Columns that are solved for at a time. */
enum { BLOCK = 64 };

/* A matrix of a quantity, as its offset in ritz_quantity. */
typedef size_t matrix_of;

enum {
    AT_Q = offsetof(ritz_quantity, Q),
    AT_A = offsetof(ritz_quantity, A),
    AT_V = offsetof(ritz_quantity, V),
    AT_F = offsetof(ritz_quantity, F),
    AT_H = offsetof(ritz_quantity, H),
};

static ritz_dense *matrix_at(ritz_quantity *quantity, matrix_of of)
{
    return (void *)((char *)quantity + of);
}

/* The static problem whose ports are held, and what it is solved for. */
typedef struct statics {
    const ritz_component *full; /* borrowed, as is the next */
    ritz_reduced *reduced;
    ritz_dofs inner;  /* i */
    ritz_sparse K, M; /* at i */
    ritz_elastic body;
    bool *wanted; /* of each quantity: whether it gets mode acceleration */
} statics;

static void statics_free(statics *s)
{
    ritz_elastic_free(&s->body);
    ritz_sparse_free(&s->K);
    ritz_sparse_free(&s->M);
    ritz_dofs_free(&s->inner);
    free(s->wanted);
}

/* X := G X. */
static ritz_status respond(const statics *s, ritz_dense *X)
{
    RITZ_OWN(ritz_dense) inner = {0};

    RITZ_CHECK(ritz_dense_rows(X, s->inner.count, s->inner.at, &inner));
    RITZ_CHECK(ritz_elastic_respond(&s->body, NULL, &inner));
    memset(X->val, 0, (size_t)(X->nrow * X->ncol) * sizeof *X->val);
    ritz_dense_spread(&inner, s->inner.at, X);
    return RITZ_OK;
}

/* Add sign S X to the columns of a matrix of each quantity, from `first` on. */
static ritz_status add_rows(const statics *s, const ritz_dense *X, double sign,
                            int64_t first, matrix_of of)
{
    for (int64_t k = 0; k < s->full->num_quantities; k++) {
        RITZ_OWN(ritz_dense) Y = {0};
        ritz_dense *to = matrix_at(&s->reduced->quantity[k], of);

        if (!s->wanted[k])
            continue;
        RITZ_CHECK(ritz_sparse_mul(&s->full->quantity[k].S, X, &Y));
        for (int64_t j = 0; j < Y.ncol; j++)
            for (int64_t i = 0; i < Y.nrow; i++)
                ritz_dense_col(to, first + j)[i] +=
                    sign * ritz_dense_col(&Y, j)[i];
    }
    return RITZ_OK;
}

/* Add sign S G C X to a matrix of each quantity, BLOCK columns at a time; C
   NULL is the identity. */
static ritz_status add_response(const statics *s, const ritz_sparse *C,
                                const ritz_dense *X, double sign, matrix_of of)
{
    for (int64_t j = 0; j < X->ncol; j += BLOCK) {
        int64_t count = X->ncol - j < BLOCK ? X->ncol - j : BLOCK;
        RITZ_OWN(ritz_dense) some = {0}, load = {0};

        ritz_monitor_step("mode acceleration", j, X->ncol);
        RITZ_CHECK(ritz_dense_columns(X, j, count, &some));
        if (C)
            RITZ_CHECK(ritz_sparse_mul(C, &some, &load));
        else
            RITZ_MOVE(load, some);
        RITZ_CHECK(respond(s, &load));
        RITZ_CHECK(add_rows(s, &load, sign, j, of));
    }
    return RITZ_OK;
}

/* Begin with Q = S T and all other matrices zero. */
static ritz_status make_room(const statics *s)
{
    const ritz_component *full = s->full;

    for (int64_t k = 0; k < full->num_quantities; k++) {
        ritz_quantity *q = &s->reduced->quantity[k];
        const int64_t r = q->ST.ncol;

        if (!s->wanted[k])
            continue;
        RITZ_CHECK(ritz_dense_copy(&q->ST, &q->Q));
        RITZ_CHECK(ritz_dense_new(q->count, r, &q->A));
        if (full->D.colptr)
            RITZ_CHECK(ritz_dense_new(q->count, r, &q->V));
        if (full->io.num_inputs > 0)
            RITZ_CHECK(ritz_dense_new(q->count, full->io.num_inputs, &q->F));
        if (full->dampers.count > 0)
            RITZ_CHECK(ritz_dense_new(q->count, full->dampers.count, &q->H));
    }
    return RITZ_OK;
}

/* Columns of kind massless have neither mass nor damping in the model. */
static void clear_massless(const ritz_columns *columns, ritz_dense *A)
{
    for (int64_t j = 0; A->val && j < A->ncol; j++)
        if (columns->kind[j] == RITZ_COLUMN_MASSLESS)
            memset(ritz_dense_col(A, j), 0, (size_t)A->nrow * sizeof *A->val);
}

static ritz_status fill(const statics *s, const ritz_dense *T)
{
    const ritz_component *full = s->full;

    RITZ_CHECK(make_room(s));
    RITZ_CHECK(add_response(s, &full->K, T, -1.0, AT_Q));
    RITZ_CHECK(add_response(s, &full->M, T, -1.0, AT_A));
    if (full->D.colptr)
        RITZ_CHECK(add_response(s, &full->D, T, -1.0, AT_V));
    if (full->io.num_inputs > 0)
        RITZ_CHECK(add_response(s, NULL, &full->io.B, 1.0, AT_F));
    if (full->dampers.count > 0)
        RITZ_CHECK(add_response(s, NULL, &full->dampers.B, 1.0, AT_H));
    for (int64_t k = 0; k < full->num_quantities; k++) {
        clear_massless(&s->reduced->columns, &s->reduced->quantity[k].A);
        clear_massless(&s->reduced->columns, &s->reduced->quantity[k].V);
    }
    return RITZ_OK;
}

/* Factor K at all dofs but those of the ports. */
static ritz_status find_statics(const char *ports, statics *s)
{
    const ritz_component *full = s->full;
    RITZ_OWN(ritz_dofs) held = {0};
    const ritz_dofs *in = &s->inner;

    RITZ_CHECK(ritz_component_attached(full, ports, &held));
    RITZ_CHECK(ritz_dofs_complement(&held, full->num_dofs, &s->inner));
    RITZ_CHECK(ritz_sparse_extract(&full->K, in->count, in->at, in->count,
                                   in->at, &s->K));
    RITZ_CHECK(ritz_sparse_extract(&full->M, in->count, in->at, in->count,
                                   in->at, &s->M));
    return ritz_elastic_new(&s->K, &s->M, NULL, &s->body);
}

/* Largest |S R| / (|S||R|) of a row and a rigid motion. */
static ritz_status measure_rigid(const statics *s, const ritz_sparse *S,
                                 int64_t *row, double *most)
{
    RITZ_OWN(ritz_dense) R = {0}, SR = {0}, size = {0};
    RITZ_OWN(ritz_sparse) weight = {0};

    *most = 0.0;
    RITZ_CHECK(ritz_dense_new(S->ncol, s->body.Phi.ncol, &R));
    ritz_dense_spread(&s->body.Phi, s->inner.at, &R);
    RITZ_CHECK(ritz_sparse_mul(S, &R, &SR));
    RITZ_CHECK(ritz_sparse_copy(S, &weight));
    for (int64_t p = 0; p < S->colptr[S->ncol]; p++)
        weight.val[p] = fabs(S->val[p]);
    for (int64_t p = 0; p < R.nrow * R.ncol; p++)
        R.val[p] = fabs(R.val[p]);
    RITZ_CHECK(ritz_sparse_mul(&weight, &R, &size));
    for (int64_t j = 0; j < SR.ncol; j++)
        for (int64_t i = 0; i < SR.nrow; i++) {
            double part = ritz_dense_col(&size, j)[i];

            part = part > 0.0 ? fabs(ritz_dense_col(&SR, j)[i]) / part : 0.0;
            if (part > *most) {
                *most = part;
                *row = i;
            }
        }
    return RITZ_OK;
}

/* Whether mode acceleration recovers a quantity, and why not if it does not. */
static ritz_status accept_quantity(const statics *s, int64_t k,
                                   ritz_mode_accelerations *out)
{
    const ritz_quantity *q = &s->full->quantity[k];
    char name[RITZ_QUANTITY_NAME_SIZE];
    double most = 0.0;
    int64_t row = 0;

    if (strcmp(q->kind, "acceleration") == 0) {
        snprintf(out->reason, sizeof out->reason,
                 "'%s' is of kind acceleration, which no static solution "
                 "corrects",
                 q->name);
        return RITZ_OK;
    }
    RITZ_CHECK(measure_rigid(s, &q->S, &row, &most));
    if (most > RITZ_RIGID_ROW) {
        snprintf(out->reason, sizeof out->reason,
                 "%s of '%s' follows rigid motion, by %.1e of its terms, and "
                 "the ports leave that free: a static solution tells "
                 "deformation alone",
                 ritz_quantity_name(&s->full->quantity[k], row, name), q->name,
                 most);
        return RITZ_OK;
    }
    out->rigid = fmax(out->rigid, most);
    out->count++;
    s->wanted[k] = true;
    return RITZ_OK;
}

ritz_status ritz_mode_acceleration(const ritz_component *component,
                                   const ritz_dense *T, const char *ports,
                                   ritz_reduced *reduced,
                                   ritz_mode_accelerations *out)
{
    RITZ_OWN(statics) s = {.full = component, .reduced = reduced};
    ritz_mode_accelerations done = {0};

    RITZ_REFUSE_IF(component->num_quantities == 0, RITZ_ERR_ARGUMENT,
                   "there are no rows to recover: import with --recovery");
    RITZ_REFUSE_IF(T->nrow != component->num_dofs ||
                       T->ncol != reduced->K.ncol ||
                       reduced->num_quantities != component->num_quantities,
                   RITZ_ERR_ARGUMENT,
                   "the reduced component is not of this component and basis");
    RITZ_CHECK_NEW(s.wanted, component->num_quantities);
    RITZ_CHECK_IN("mode acceleration", find_statics(ports, &s));
    done.motions = s.body.Phi.ncol;
    for (int64_t k = 0; k < component->num_quantities; k++)
        RITZ_CHECK(accept_quantity(&s, k, &done));
    if (done.count > 0)
        RITZ_CHECK_IN("mode acceleration", fill(&s, T));
    *out = done;
    return RITZ_OK;
}
