/*
 * The contributions of configurations to the composite set, in modal
 * coordinates: modes weighted by their value, static solutions, and all that
 * stage one has. Their order is described below.
 */
#include "compare/compare.h"

#include "assembly/assembly.h"
#include "base/alloc.h"
#include "base/tolerances.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>

/* The groups of contributions, which differ from those of composite.c. */
enum { GROUP_RIGID, GROUP_BAND, GROUP_STATIC, GROUP_REST };

/* A stage at all configurations, while directions are ordered. */
typedef struct ordering {
    const ritz_stage *stage; /* borrowed */
    double lambda;           /* of the end of the band */
    ritz_system system;
    ritz_givens givens;      /* contributions of each configuration */
    ritz_unit_forces forces; /* inputs, outputs and dampers */
    int64_t *force;
    ritz_plan plan;
} ordering;

static void ordering_free(ordering *g)
{
    ritz_givens_free(&g->givens);
    ritz_system_free(&g->system);
    ritz_unit_forces_free(&g->forces);
    free(g->force);
}

/* The value of each mode, relative to the largest of all. */
static ritz_status weigh_modes(ordering *g)
{
    double largest = 0.0;

    for (int64_t k = 0; k < g->givens.count; k++) {
        ritz_given *given = &g->givens.each[k];
        int64_t flexible = given->at->K.ncol - given->at->num_rigid;

        RITZ_CHECK_NEW(given->value, flexible);
        RITZ_CHECK(ritz_compare_values(g->stage->scene, given->at, given->value,
                                       NULL));
        for (int64_t j = 0; j < flexible; j++)
            largest = fmax(largest, given->value[j]);
    }
    for (int64_t k = 0; k < g->givens.count; k++) {
        const ritz_given *given = &g->givens.each[k];

        for (int64_t j = 0; j < given->at->K.ncol - given->at->num_rigid; j++)
            given->value[j] /= largest > 0.0 ? largest : 1.0;
    }
    return RITZ_OK;
}

/* Columns of flexible modes up to some lambda, scaled by the modes' values. */
static ritz_status choose_modes(const ritz_configuration *at, double highest,
                                const double *length, ritz_dense *out)
{
    int64_t count = 0;

    RITZ_CHECK(ritz_dense_new(at->K.ncol, at->K.ncol - at->num_rigid, out));
    for (int64_t k = at->num_rigid; k < at->K.ncol; k++)
        if (at->lambda[k] <= highest)
            ritz_dense_col(out, count++)[k] =
                length ? length[k - at->num_rigid] : 1.0;
    out->ncol = count;
    return RITZ_OK;
}

static ritz_status list_contributions(const ordering *g, ritz_given *to)
{
    const ritz_scene *scene = g->stage->scene;
    RITZ_OWN(ritz_dense) band = {0}, answers = {0};

    RITZ_CHECK(ritz_composite_choose(g->stage, to->at, NULL, RITZ_GIVEN_RIGID,
                                     &g->plan, &to->X[GROUP_RIGID]));
    RITZ_CHECK(ritz_composite_choose(g->stage, to->at, NULL, RITZ_GIVEN_STATIC,
                                     &g->plan, &answers));
    RITZ_CHECK(choose_modes(to->at, g->lambda, to->value, &band));
    RITZ_CHECK(choose_modes(to->at, HUGE_VAL, NULL, &to->X[GROUP_REST]));
    if (scene->augment != RITZ_AUGMENT_NONE) {
        RITZ_CHECK(ritz_dense_beside(&band, &answers, &to->X[GROUP_BAND]));
        return ritz_dense_new(band.nrow, 0, &to->X[GROUP_STATIC]);
    }
    RITZ_MOVE(to->X[GROUP_BAND], band);
    RITZ_MOVE(to->X[GROUP_STATIC], answers);
    return RITZ_OK;
}

static ritz_status plan_statics(ordering *g)
{
    g->plan = (ritz_plan){.augment = RITZ_AUGMENT_SYSTEM, .forces = &g->forces};
    RITZ_CHECK(ritz_unit_forces_of_channels(g->stage, &g->forces));
    RITZ_CHECK(ritz_unit_forces_select(
        &g->forces,
        RITZ_ATTACHED_INPUTS | RITZ_ATTACHED_OUTPUTS | RITZ_ATTACHED_DAMPERS,
        false, &g->plan.count, &g->force));
    g->plan.force = g->force;
    return RITZ_OK;
}

/* Assemble all configurations and list the contributions of each. */
static ritz_status assemble_ordering(const ritz_stage *stage, ordering *g)
{
    g->stage = stage;
    g->lambda = ritz_eigen_lambda(stage->scene->band_hz[1]);
    RITZ_REFUSE_IF(!(g->lambda > 0.0), RITZ_ERR_ARGUMENT,
                   "the scene has no band: which modes are to be kept");
    RITZ_CHECK_IN("stage 1", ritz_assemble(stage, NULL, &g->system));
    RITZ_CHECK_NEW(g->givens.each, g->system.num_configurations);
    g->givens.count = g->system.num_configurations;
    for (int64_t k = 0; k < g->givens.count; k++)
        g->givens.each[k].at = &g->system.configuration[k];
    RITZ_CHECK_IN("selection", weigh_modes(g));
    RITZ_CHECK(plan_statics(g));
    for (int64_t k = 0; k < g->givens.count; k++)
        RITZ_CHECK(list_contributions(g, &g->givens.each[k]));
    return RITZ_OK;
}

/*
 * The composite set of all configurations, its directions in order. With P_c
 * the rows of body c at a configuration, a body receives
 *
 *     P_c Phi_r                        rigid modes, always there; and then
 *     P_c Phi_k v_k                    modes up to the end of the band, v_k the
 *                                      value of mode k in the ranking over the
 *                                      largest at any configuration, or 1,
 *     P_c Phi_f Lambda_f^-1 Phi_f' F   static solutions for inputs and forces
 *                                      where outputs measure and dampers act,
 *     P_c Phi_f                        all flexible modes of stage one
 *
 * in groups, each orthogonal to those before it. Within a group directions are
 * in the order of their singular values in the inner product
 *
 *     E_c = M_c + K_c / lambda,        lambda of the end of the band,
 *
 * since the system has to store the energy of a direction that is left out
 * elsewhere: by energy the few directions that make bodies compatible at a
 * joint precede many with larger motion and little energy. In M_c alone the
 * spacecraft of the demo takes 28 columns for a response within 1e-2, in E_c 23
 * (measured).
 *
 * The rest of the theory is in composite.c, which keeps modes exactly
 * [LeeTsuha1992].
 */

/* A direction of a body, while directions are sorted. */
typedef struct direction {
    int group;
    double value;
    int64_t body;
} direction;

/*
 * Independent rigid motions of a body, by mass: by energy, stiffness that is
 * rounding would count.
 */
static ritz_status rigid_motions(const ordering *g, int64_t body,
                                 ritz_dense *out)
{
    const double *scale = g->stage->scale + g->stage->first[body];
    RITZ_OWN(ritz_dense) W = {0}, L = {0}, Y = {0};
    double largest = 0.0;
    bool mixed = false;

    RITZ_CHECK(ritz_givens_gather(&g->givens, g->stage, body, GROUP_RIGID, &W));
    RITZ_CHECK(ritz_mass_factor(&g->stage->body[body], scale, &L, &mixed));
    RITZ_CHECK(ritz_mass_transform(&L, scale, &W, &Y));
    RITZ_CHECK(ritz_span_of(&Y, RITZ_RANK_LOSS, &largest, NULL, out));
    ritz_mass_return(&L, scale, false, out);
    return RITZ_OK;
}

/*
 * A body while its directions are found, in coordinates that make the diagonal
 * of E = L L' one.
 */
typedef struct frame {
    int64_t body;
    double *scale;
    ritz_dense L;
    ritz_dense U;   /* found so far, L' U orthonormal */
    double largest; /* singular value of all groups */
    double *value;  /* of the directions of a group */
} frame;

static void frame_free(frame *f)
{
    free(f->scale);
    ritz_dense_free(&f->L);
    ritz_dense_free(&f->U);
    free(f->value);
}

static ritz_status start_body(const ordering *g, frame *f)
{
    const ritz_reduced *body = &g->stage->body[f->body];
    RITZ_OWN(ritz_dense) R = {0}, Y = {0};
    double largest = 0.0;

    RITZ_CHECK_NEW(f->scale, body->K.ncol);
    RITZ_CHECK_NEW(f->value, body->K.ncol);
    for (int64_t j = 0; j < body->K.ncol; j++) {
        double e = ritz_dense_col(&body->M, j)[j] +
                   ritz_dense_col(&body->K, j)[j] / g->lambda;

        f->scale[j] = e > 0.0 ? 1.0 / sqrt(e) : 1.0;
    }
    RITZ_CHECK(ritz_mixed_factor(body, f->scale, g->lambda, &f->L));
    RITZ_CHECK(rigid_motions(g, f->body, &R));
    RITZ_CHECK(ritz_mass_transform(&f->L, f->scale, &R, &Y));
    return ritz_span_of(&Y, RITZ_RANK_LOSS, &largest, NULL, &f->U);
}

/*
 * Append the independent part of a group to U, up to the number of coordinates.
 */
static ritz_status add_group(const ordering *g, int group, frame *f)
{
    RITZ_OWN(ritz_dense) W = {0}, Y = {0};

    RITZ_CHECK(ritz_givens_gather(&g->givens, g->stage, f->body, group, &W));
    RITZ_CHECK(ritz_mass_transform(&f->L, f->scale, &W, &Y));
    return ritz_span_append(&Y, RITZ_RANK_LOSS, &f->largest, f->value, &f->U);
}

/* V of one body; its directions join those of all others in the list. */
static ritz_status order_body(const ordering *g, int64_t body,
                              ritz_composite *out, direction *all)
{
    RITZ_OWN(frame) f = {.body = body};

    RITZ_CHECK(start_body(g, &f));
    out->rigid[body] = f.U.ncol;
    for (int group = GROUP_BAND; group <= GROUP_REST; group++) {
        int64_t before = f.U.ncol;

        RITZ_CHECK(add_group(g, group, &f));
        for (int64_t j = before; j < f.U.ncol; j++)
            all[out->num_steps++] =
                (direction){/* a body must move */
                            .group = j == 0 ? GROUP_RIGID : group,
                            .value = f.value[j - before],
                            .body = body};
    }
    ritz_mass_return(&f.L, f.scale, false, &f.U);
    RITZ_MOVE(out->V[body], f.U);
    return RITZ_OK;
}

static int compare_right(const void *left, const void *right)
{
    const direction *a = left;
    const direction *b = right;

    if (a->group != b->group)
        return a->group - b->group;
    if (a->value > b->value || a->value < b->value)
        return (a->value < b->value) - (a->value > b->value);
    return (a->body > b->body) - (a->body < b->body);
}

static ritz_status order_bodies(const ordering *g, ritz_composite *out)
{
    const ritz_stage *stage = g->stage;
    RITZ_OWN_ARRAY direction *all = NULL;

    out->num_bodies = stage->count;
    RITZ_CHECK_NEW(out->V, stage->count);
    RITZ_CHECK_NEW(out->rigid, stage->count);
    RITZ_CHECK_NEW(out->step, stage->num_coordinates);
    RITZ_CHECK_NEW(all, stage->num_coordinates);
    for (int64_t c = 0; c < stage->count; c++)
        RITZ_CHECK_IN(stage->scene->component[c].name,
                      order_body(g, c, out, all));
    qsort(all, (size_t)out->num_steps, sizeof *all, compare_right);
    for (int64_t k = 0; k < out->num_steps; k++)
        out->step[k] = all[k].body;
    return RITZ_OK;
}

ritz_status ritz_composite_new(const ritz_stage *stage, ritz_composite *out)
{
    RITZ_OWN(ordering) g = {0};
    RITZ_OWN(ritz_composite) made = {0};

    RITZ_CHECK(ritz_spin_refuse(stage->scene));
    RITZ_CHECK(ritz_dual_refuse(stage));
    RITZ_CHECK(assemble_ordering(stage, &g));
    RITZ_CHECK_IN("composite modes", order_bodies(&g, &made));
    RITZ_MOVE(*out, made);
    return RITZ_OK;
}

void ritz_composite_free(ritz_composite *composite)
{
    RITZ_FREE_EACH(ritz_dense, composite->num_bodies, composite->V);
    RITZ_FREE(composite->rigid, composite->step);
    *composite = (ritz_composite){0};
}
