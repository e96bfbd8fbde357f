#include "formats/normal_body.h"
#include "base/alloc.h"
#include "formats/floating_report.h"

#include <stdlib.h>

void ritz_normal_body_free(ritz_normal_body *body)
{
    ritz_floating_free(&body->floating);
    free(body->hertz);
    free(body->K);
    ritz_dense_free(&body->U);
    ritz_dense_free(&body->D);
    ritz_dense_free(&body->shape);
    ritz_dense_free(&body->turn);
    ritz_invariants_free(&body->invariants);
    *body = (ritz_normal_body){0};
}

/* With the eigenvectors S of (K, M), S'M S = I, modes become Psi S and damping
   S'D S. */
static ritz_status turn_modes(const ritz_pairs *pairs, ritz_normal_body *b)
{
    const ritz_floating *f = &b->floating;
    const ritz_dense *S = &pairs->Phi;

    b->num_modes = S->ncol;
    RITZ_CHECK_COPY(b->K, pairs->lambda, S->ncol);
    RITZ_CHECK_NEW(b->hertz, S->ncol);
    for (int64_t k = 0; k < S->ncol; k++)
        b->hertz[k] = ritz_eigen_hertz(b->K[k]);
    RITZ_CHECK(ritz_dense_mul(&f->U, S, &b->U));
    RITZ_CHECK(ritz_dense_mul(&f->shape, S, &b->shape));
    if (f->turn.val)
        RITZ_CHECK(ritz_dense_mul(&f->turn, S, &b->turn));
    if (f->D.val)
        RITZ_CHECK(ritz_dense_project(&f->D, S, &b->D));
    return ritz_invariants_project(&f->invariants, S, &b->invariants);
}

ritz_status ritz_normal_body_of(const ritz_reduced *reduced,
                                const ritz_floating_request *request,
                                ritz_normal_body *out)
{
    RITZ_OWN(ritz_normal_body) b = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    if (request->reference)
        RITZ_CHECK(ritz_floating_of(reduced, request, &b.floating));
    else
        RITZ_CHECK(ritz_floating_usual(reduced, request->frame, &b.floating));
    RITZ_CHECK(ritz_eigen_dense(&b.floating.K, &b.floating.M, &pairs));
    RITZ_CHECK(turn_modes(&pairs, &b));
    RITZ_MOVE(*out, b);
    return RITZ_OK;
}

ritz_status ritz_normal_body_say(const ritz_reduced *reduced,
                                 const ritz_normal_body *body,
                                 ritz_export_report *report)
{
    const int64_t lost = body->floating.K.ncol - body->num_modes;

    RITZ_CHECK(ritz_floating_say(&body->floating, report));
    if (lost > 0)
        RITZ_CHECK(ritz_export_say(
            report, "%lld of them have no mass in the frame and are left out",
            (long long)lost));
    RITZ_CHECK(ritz_export_say(
        report,
        "%lld eigenvectors of these, with the frame held, are written, "
        "scaled to unit modal mass",
        (long long)body->num_modes));
    return ritz_floating_say_damping(reduced, &body->floating, report);
}
