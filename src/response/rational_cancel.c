/* What is cancelled: poles and, of small components, zeros. */
#include "response/rational.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/zeros.h>

#include <math.h>
#include <stdlib.h>

/* Poles are cancelled up to here, of the end. */
static const double cancelled_to = 1.5;
/* Of |s|: poles nearer than this are one. */
static const double same = 1e-9;

/* A pole that is there is added once more, and then not again: 0 is double, and
   what couples two equal modes a little is seen through both. */
static void add_pole(ritz_nodes *s, double _Complex pole)
{
    int64_t there = 0;

    for (int64_t k = 0; k < s->num_poles; k++)
        there += cabs(s->pole[k] - pole) <= same * cabs(pole);
    if (there < 2)
        s->pole[s->num_poles++] = pole;
}

/* A small component as a dense model, ratios in D as the modes have them. */
static ritz_status take_whole(ritz_nodes *s)
{
    ritz_status status = RITZ_OK;
    const ritz_direct *full = &s->full;
    ritz_dense *D = &s->whole.D;
    ritz_dense scaled = {0}, given = {0};

    RITZ_TRY(ritz_whole_new(full->component, &s->whole));
    s->whole.model.io = &full->component->io;
    s->small = true;
    if (!full->ratios)
        return RITZ_OK;
    RITZ_TRY(ritz_dense_copy(&full->MPhi, &scaled));
    for (int64_t k = 0; k < full->m; k++) {
        double w = sqrt(full->poles.lambda[k]);
        int64_t mode = k - full->poles.num_rigid;
        double rate =
            mode < 0 ? 0.0
                     : 2.0 * w * ritz_damping_of_mode(&full->damping, mode, w);

        for (int64_t i = 0; i < full->n; i++)
            ritz_dense_col(&scaled, k)[i] *= rate;
    }
    RITZ_TRY(ritz_dense_mul_nt(&scaled, &full->MPhi, &given));
    if (!D->val)
        RITZ_TRY(ritz_dense_new(full->n, full->n, D));
    for (int64_t i = 0; i < full->n * full->n; i++)
        D->val[i] += given.val[i];
done:
    ritz_dense_free(&scaled);
    ritz_dense_free(&given);
    return status;
}

/* What acts beside that model's D. */
static const ritz_damping *rest_of(const ritz_nodes *s)
{
    return s->full.ratios ? NULL : &s->full.damping;
}

/* Poles as the responder knows them; of a small coupled one by itself. */
static ritz_status list_poles(const ritz_nodes *s,
                              const ritz_responder *responder, int64_t *count,
                              double _Complex **out)
{
    ritz_status status = RITZ_OK;
    ritz_spectrum all = {0};
    double _Complex *found = NULL;

    if (!s->small || !s->full.poles.coupled)
        return ritz_responder_poles(responder, count, out);
    RITZ_TRY(ritz_spectrum_dense(&s->whole.model, rest_of(s), &all));
    RITZ_NEW(found, all.count + all.num_zero);
    for (int64_t k = 0; k < all.count; k++)
        found[k] = all.s[k];
    *count = all.count + all.num_zero;
    *out = found;
done:
    ritz_spectrum_free(&all);
    return status;
}

/*
 * Those that any channel shows, and their conjugates; with K4 their partners
 * below the axis, which are - s but for damping by D, and far enough away for
 * that to do.
 */
ritz_status ritz_nodes_find_poles(ritz_nodes *s,
                                  const ritz_responder *responder)
{
    ritz_status status = RITZ_OK;
    double most = 2.0 * RITZ_PI * cancelled_to * responder->to_hz;
    double _Complex *found = NULL;
    int64_t count = 0;

    if (s->full.n <= RITZ_WHOLE_DOFS)
        RITZ_TRY(take_whole(s));
    RITZ_TRY(list_poles(s, responder, &count, &found));
    RITZ_NEW(s->pole, 2 * count);
    for (int64_t k = 0; k < count; k++) {
        if (cabs(found[k]) > most)
            continue;
        add_pole(s, found[k]);
        if (cimag(found[k]) > 0.0)
            add_pole(s, s->mirror ? conj(found[k]) : -found[k]);
    }
done:
    free(found);
    return status;
}

ritz_status ritz_nodes_find_zeros(ritz_nodes *s)
{
    ritz_status status = RITZ_OK;
    int64_t inputs = s->full.component->io.num_inputs;
    double _Complex *z = NULL, *all = NULL;

    for (int64_t v = 0; v < s->values; v++) {
        int64_t count = 0, n = 0;

        status = ritz_zeros_dense(&s->whole.model, rest_of(s), v / inputs,
                                  v % inputs, &count, &z);
        if (status == RITZ_ERR_MEMORY)
            goto done;
        if (status != RITZ_OK) /* nothing passes, or they are not to be had */
            continue;
        RITZ_NEW(all, 2 * count);
        for (int64_t k = 0; k < count; k++)
            if (cabs(z[k]) <= cancelled_to * s->both.unit)
                all[n++] = z[k];
        RITZ_TRY(ritz_interpolant_cancel(&s->both, v, n, all));
        free(z);
        free(all);
        z = all = NULL;
    }
    status = RITZ_OK;
done:
    free(z);
    free(all);
    return status;
}
