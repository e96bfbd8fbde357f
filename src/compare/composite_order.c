/*
 * The composite set of all configurations, its directions in order. With P_c
 * the rows of body c at a configuration, a body is given
 *
 *     P_c Phi_r                        rigid modes, always there; and then
 *     P_c Phi_k v_k                    modes up to the end of the band, v_k the
 *                                      value of mode k in the ranking over the
 *                                      largest at any configuration, or 1,
 *     P_c Phi_f Lambda_f^-1 Phi_f' F   static answers to inputs, and to forces
 *                                      where outputs read,
 *     P_c Phi_f                        all flexible modes of stage one
 *
 * in groups, each without what those before it span. Within a group directions
 * stand in the order of their singular values in the inner product
 *
 *     E_c = M_c + K_c / lambda,        lambda of the end of the band,
 *
 * since a system has to make up for what a direction had: by energy the few
 * that let bodies follow each other at a joint come before many that move more
 * and store little. In M_c alone the spacecraft of the demo takes 28 columns
 * for a response within 1e-2, in E_c 23 (measured).
 *
 * composite.c, which keeps modes exactly, has the rest of the theory
 * [LeeTsuha1992].
 */
#include "assembly/dual.h"
#include "base/alloc.h"
#include "compare/composite_given.h"
#include "compare/directions.h"

#include <math.h>
#include <stdlib.h>

/* Relative to the largest singular value: below it a direction is rounding. */
static const double least = 1e-9;

/* A direction of a body, while they are put in order. */
typedef struct direction {
    int group;
    double value;
    int64_t body;
} direction;

/*
 * Independent rigid motions of a body: by mass, since by energy what rounding
 * leaves of stiffness in them would count.
 */
static ritz_status rigid_motions(const ritz_givens *g, int64_t body,
                                 ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const double *scale = g->scale + g->stage->first[body];
    ritz_dense W = {0}, L = {0}, Y = {0};
    double largest = 0.0;
    bool mixed = false;

    RITZ_TRY(ritz_givens_gather(g, body, RITZ_GROUP_RIGID, &W));
    RITZ_TRY(ritz_mass_factor(&g->stage->body[body], scale, &L, &mixed));
    RITZ_TRY(ritz_mass_transform(&L, scale, &W, &Y));
    RITZ_TRY(ritz_span_of(&Y, least, &largest, out));
    ritz_mass_return(&L, scale, out);
done:
    ritz_dense_free(&W);
    ritz_dense_free(&L);
    ritz_dense_free(&Y);
    return status;
}

/* A body while its directions are found, in coordinates in which E = L L' has a
   diagonal of ones. */
typedef struct frame {
    int64_t body;
    double *scale;
    ritz_dense L;
    ritz_dense U;   /* found so far, L' U orthonormal */
    double largest; /* singular value of all groups */
    double *value;  /* of the directions of a group */
} frame;

static ritz_status start(const ritz_givens *g, frame *f)
{
    ritz_status status = RITZ_OK;
    const ritz_reduced *body = &g->stage->body[f->body];
    ritz_dense R = {0}, Y = {0};
    double largest = 0.0;

    RITZ_NEW(f->scale, body->K.ncol);
    RITZ_NEW(f->value, body->K.ncol);
    for (int64_t j = 0; j < body->K.ncol; j++) {
        double e = ritz_dense_col(&body->M, j)[j] +
                   ritz_dense_col(&body->K, j)[j] / g->lambda;

        f->scale[j] = e > 0.0 ? 1.0 / sqrt(e) : 1.0;
    }
    RITZ_TRY(ritz_mixed_factor(body, f->scale, g->lambda, &f->L));
    RITZ_TRY(rigid_motions(g, f->body, &R));
    RITZ_TRY(ritz_mass_transform(&f->L, f->scale, &R, &Y));
    RITZ_TRY(ritz_span_of(&Y, least, &largest, &f->U));
done:
    ritz_dense_free(&R);
    ritz_dense_free(&Y);
    return status;
}

/* What a group adds to U, no more than there are directions at all. */
static ritz_status add_group(const ritz_givens *g, int group, frame *f)
{
    ritz_status status = RITZ_OK;
    ritz_dense W = {0}, Y = {0}, more = {0}, both = {0};

    RITZ_TRY(ritz_givens_gather(g, f->body, group, &W));
    RITZ_TRY(ritz_mass_transform(&f->L, f->scale, &W, &Y));
    RITZ_TRY(ritz_dense_take_out(&f->U, &f->U, &Y));
    RITZ_TRY(ritz_dense_take_out(&f->U, &f->U, &Y)); /* twice is enough */
    RITZ_TRY(ritz_span_values(&Y, least, &f->largest, f->value, &more));
    if (more.ncol > f->U.nrow - f->U.ncol)
        more.ncol = f->U.nrow - f->U.ncol;
    RITZ_TRY(ritz_dense_beside(&f->U, &more, &both));
    ritz_dense_free(&f->U);
    f->U = both;
    both = (ritz_dense){0};
done:
    ritz_dense_free(&W);
    ritz_dense_free(&Y);
    ritz_dense_free(&more);
    ritz_dense_free(&both);
    return status;
}

/* V of one body; its directions join those of all others. */
static ritz_status order_body(const ritz_givens *g, int64_t body,
                              ritz_composite *out, direction *all)
{
    ritz_status status = RITZ_OK;
    frame f = {.body = body};

    RITZ_TRY(start(g, &f));
    out->rigid[body] = f.U.ncol;
    for (int group = RITZ_GROUP_BAND; group < RITZ_GROUPS; group++) {
        int64_t before = f.U.ncol;

        RITZ_TRY(add_group(g, group, &f));
        for (int64_t j = before; j < f.U.ncol; j++)
            all[out->num_steps++] =
                (direction){/* a body must move */
                            .group = j == 0 ? RITZ_GROUP_RIGID : group,
                            .value = f.value[j - before],
                            .body = body};
    }
    ritz_mass_return(&f.L, f.scale, &f.U);
    out->V[body] = f.U;
    f.U = (ritz_dense){0};
done:
    ritz_dense_free(&f.L);
    ritz_dense_free(&f.U);
    free(f.scale);
    free(f.value);
    return ritz_context(status, g->stage->scene->component[body].name);
}

static int by_right(const void *left, const void *right)
{
    const direction *a = left;
    const direction *b = right;

    if (a->group != b->group)
        return a->group - b->group;
    if (a->value > b->value || a->value < b->value)
        return (a->value < b->value) - (a->value > b->value);
    return (a->body > b->body) - (a->body < b->body);
}

static ritz_status order_bodies(const ritz_givens *g, ritz_composite *out)
{
    ritz_status status = RITZ_OK;
    const ritz_stage *stage = g->stage;
    direction *all = NULL;

    out->num_bodies = stage->count;
    RITZ_NEW(out->V, stage->count);
    RITZ_NEW(out->rigid, stage->count);
    RITZ_NEW(out->step, stage->num_coordinates);
    RITZ_NEW(all, stage->num_coordinates);
    for (int64_t c = 0; c < stage->count; c++)
        RITZ_TRY(order_body(g, c, out, all));
    qsort(all, (size_t)out->num_steps, sizeof *all, by_right);
    for (int64_t k = 0; k < out->num_steps; k++)
        out->step[k] = all[k].body;
done:
    free(all);
    return status;
}

ritz_status ritz_composite_new(const ritz_stage *stage, ritz_composite *out)
{
    ritz_status status = RITZ_OK;
    ritz_givens givens = {0};
    ritz_composite made = {0};

    RITZ_TRY(ritz_dual_refuse(stage));
    RITZ_TRY(ritz_givens_new(stage, &givens));
    RITZ_TRY_IN("composite modes", order_bodies(&givens, &made));
    *out = made;
    made = (ritz_composite){0};
done:
    ritz_givens_free(&givens);
    ritz_composite_free(&made);
    return status;
}

void ritz_composite_free(ritz_composite *composite)
{
    for (int64_t c = 0; composite->V && c < composite->num_bodies; c++)
        ritz_dense_free(&composite->V[c]);
    free(composite->V);
    free(composite->rigid);
    free(composite->step);
    *composite = (ritz_composite){0};
}
