/*
 * The composite set, projected on each body. At a configuration the
 * coordinates of body c are q_c = P_c x with x modal, so that its columns are
 *
 *     P_c Phi_r                        rigid modes
 *     P_c Phi_f Lambda_f^-1 Phi_f' F   what all flexible modes answer to each
 *                                      force statically [LeeTsuha1992, eq. 37]
 *     P_c Phi_k                        kept modes, or
 *     P_c Phi_f W                      Krylov vectors [McDaniel2000, 3.2.3]
 *
 * over all configurations. The static answer of all flexible modes spans, with
 * the kept ones, what that of the truncated ones does. Augmented at component
 * level the second are instead, once for all angles, the body's own: see
 * statics.c.
 *
 * With M_c = L L' and Y = L' W, columns are taken in that order of right: rigid
 * modes, motions without mass and static answers whole, so that no tolerance
 * costs rigidity or static gain; then what is left of the kept modes, whose
 * singular values below the tolerance are dropped. V_c = L'^-1 U. What is
 * scaled to unit mass of the system, as modes are, is static answers of the
 * system and Krylov vectors; those of a body are scaled to its own.
 *
 * Where M_c is singular, M_c + K_c / lambda takes its place.
 */
#include "base/alloc.h"
#include "compare/compare_parts.h"
#include "compare/directions.h"

#include <cblas.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    RIGID = RITZ_GIVEN_RIGID,
    MASSLESS = RITZ_GIVEN_MASSLESS,
    STATIC = RITZ_GIVEN_STATIC,
    KEPT = RITZ_GIVEN_KEPT,
    GROUPS = RITZ_GIVEN
};

/*
 * Below this, relative to the largest, a direction is rounding. Rigid modes
 * hold flexible motion of eps |P|'|K||P| / lambda, 1e-11 measured on frames of
 * bars, while the least rigid motion of a body is of the order of its size over
 * its distance from the centre of the system. Answers of a body to forces that
 * depend on each other differ by its solver's eps cond(K).
 */
static const double tightest[GROUPS] = {1e-9, 1e-9, 1e-12, 1e-12};
static const double tightest_of_bodies = 1e-10;

typedef struct columns {
    ritz_dense group[GROUPS];
    ritz_range massless; /* columns of V without mass */
} columns;

/* W = [W, more]; `more` is freed. */
static ritz_status append(ritz_dense *more, ritz_dense *W)
{
    ritz_status status = RITZ_OK;
    int64_t n = more->nrow;
    int64_t before = W->val ? W->ncol : 0;
    ritz_dense both = {0};

    RITZ_TRY(ritz_dense_new(n, before + more->ncol, &both));
    if (n * before > 0)
        memcpy(both.val, W->val, (size_t)(n * before) * sizeof *both.val);
    if (n * more->ncol > 0)
        memcpy(ritz_dense_col(&both, before), more->val,
               (size_t)(n * more->ncol) * sizeof *both.val);
    ritz_dense_free(W);
    *W = both;
    both = (ritz_dense){0};
done:
    ritz_dense_free(more);
    ritz_dense_free(&both);
    return status;
}

static ritz_status identity(int64_t r, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(r, r, out));
    for (int64_t j = 0; j < r; j++)
        ritz_dense_col(out, j)[j] = 1.0;
    return RITZ_OK;
}

/* Columns of unit norm; those of none are left as they are. */
static void make_unit(ritz_dense *Y)
{
    for (int64_t j = 0; j < Y->ncol; j++) {
        double norm = cblas_dnrm2((int)Y->nrow, ritz_dense_col(Y, j), 1);

        if (norm > 0.0)
            cblas_dscal((int)Y->nrow, 1.0 / norm, ritz_dense_col(Y, j), 1);
    }
}

/*
 * Columns no longer than one: what has little mass is long where M-norms are
 * one, and its rounding would be a mass that it has not.
 */
static void make_small(ritz_dense *U)
{
    for (int64_t j = 0; j < U->ncol; j++) {
        double norm = cblas_dnrm2((int)U->nrow, ritz_dense_col(U, j), 1);

        if (norm > 1.0)
            cblas_dscal((int)U->nrow, 1.0 / norm, ritz_dense_col(U, j), 1);
    }
}

/* U: the groups in turn, each without what those before it span. */
static ritz_status choose_directions(const ritz_dense *L, const double *scale,
                                     columns *of, const ritz_plan *plan,
                                     ritz_dense *U)
{
    ritz_status status = RITZ_OK;
    bool own = plan->augment == RITZ_AUGMENT_COMPONENT;
    ritz_dense Y = {0}, more = {0};
    double largest = 0.0;

    RITZ_TRY(ritz_dense_new(L->nrow, 0, U));
    for (int g = 0; g < GROUPS; g++) {
        double least = tightest[g];

        if (g == KEPT)
            least = fmax(plan->tolerance, least);
        if (g == STATIC && own)
            least = tightest_of_bodies;
        RITZ_TRY(ritz_mass_transform(L, scale, &of->group[g], &Y));
        if (g == MASSLESS || (g == STATIC && own))
            make_unit(&Y);
        RITZ_TRY(ritz_dense_take_out(U, U, &Y));
        RITZ_TRY(ritz_dense_take_out(U, U, &Y)); /* twice is enough */
        RITZ_TRY(ritz_span_of(&Y, least, &largest, &more));
        if (g == MASSLESS) {
            of->massless = (ritz_range){U->ncol, U->ncol + more.ncol};
        }
        RITZ_TRY(append(&more, U));
        ritz_dense_free(&Y);
    }
done:
    ritz_dense_free(&Y);
    ritz_dense_free(&more);
    return status;
}

/* V of one body from the columns that all configurations gave it. */
static ritz_status orthonormalise(const ritz_reduced *body, const double *scale,
                                  columns *of, const ritz_plan *plan,
                                  ritz_dense *V)
{
    ritz_status status = RITZ_OK;
    int64_t r = body->M.ncol;
    ritz_dense L = {0}, U = {0};
    bool mixed = false;

    RITZ_TRY(ritz_mass_factor(body, scale, &L, &mixed));
    RITZ_TRY(choose_directions(&L, scale, of, plan, &U));
    if (U.ncol == r) { /* nothing to remove: leave the body as it is */
        of->massless = (ritz_range){0, 0};
        RITZ_TRY(identity(r, V));
        goto done;
    }
    if (U.ncol > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, (int)r, (int)U.ncol, 1.0, L.val, (int)r,
                    U.val, (int)r);
    if (mixed)
        make_small(&U);
    for (int64_t j = 0; j < U.ncol; j++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(&U, j)[i] *= scale[i];
    *V = U;
    U = (ritz_dense){0};
done:
    ritz_dense_free(&L);
    ritz_dense_free(&U);
    return status;
}

/* Whether configuration k of the scene adds to the composite set. */
static bool counts(const ritz_scene *scene, int64_t k)
{
    for (int64_t j = 0; j < scene->num_reference; j++)
        if (scene->reference[j] == k)
            return true;
    return scene->num_reference == 0;
}

/* Append what one configuration gives to every body; count its vectors. */
static ritz_status collect(const ritz_rows *rows, int64_t k,
                           const ritz_plan *plan, columns *of, int64_t *count)
{
    ritz_status status = RITZ_OK;
    const ritz_stage *stage = rows->stage;
    const ritz_configuration *c = ritz_rows_first(rows, k);
    ritz_dense X = {0}, more = {0};

    for (int g = 0; g < GROUPS; g++) {
        RITZ_TRY(
            ritz_composite_choose(stage->scene, c, &rows->row[k], g, plan, &X));
        *count += X.ncol;
        for (int64_t b = 0; b < stage->count; b++) {
            RITZ_TRY(ritz_dense_mul(&c->P[b], &X, &more));
            RITZ_TRY(append(&more, &of[b].group[g]));
        }
        ritz_dense_free(&X);
    }
done:
    ritz_dense_free(&X);
    ritz_dense_free(&more);
    return status;
}

/* Append what each body has of its own, once for all configurations. */
static ritz_status collect_own(const ritz_stage *stage, const double *scale,
                               const ritz_plan *plan, columns *of,
                               int64_t *count)
{
    ritz_status status = RITZ_OK;
    ritz_statics own = {0};

    for (int64_t b = 0; b < stage->count && plan->augment != RITZ_AUGMENT_NONE;
         b++) {
        const ritz_scene_component *item = &stage->scene->component[b];

        RITZ_TRY_IN(item->name,
                    ritz_body_massless(&stage->body[b], scale + stage->first[b],
                                       &own.massless));
        RITZ_TRY(append(&own.massless, &of[b].group[MASSLESS]));
        if (plan->augment != RITZ_AUGMENT_COMPONENT)
            continue;
        RITZ_TRY_IN(item->name, ritz_body_statics(stage, b, plan, &own));
        *count += own.answers.ncol;
        RITZ_TRY(append(&own.rigid, &of[b].group[RIGID]));
        RITZ_TRY(append(&own.answers, &of[b].group[STATIC]));
    }
done:
    ritz_statics_free(&own);
    return status;
}

ritz_status ritz_compare_composite(const ritz_rows *rows, const ritz_plan *plan,
                                   ritz_dense *V, ritz_range *massless,
                                   int64_t *count)
{
    ritz_status status = RITZ_OK;
    const ritz_stage *stage = rows->stage;
    const ritz_scene *scene = stage->scene;
    columns *of = NULL;
    double *scale = NULL;

    *count = 0;
    RITZ_NEW(of, stage->count);
    RITZ_NEW(scale, stage->num_coordinates);
    ritz_stage_scale(stage, scale);
    for (int64_t k = 0; k < rows->listed->num_configurations; k++)
        if (counts(scene, k))
            RITZ_TRY(collect(rows, k, plan, of, count));
    RITZ_TRY(collect_own(stage, scale, plan, of, count));
    for (int64_t c = 0; c < stage->count; c++) {
        RITZ_TRY_IN(scene->component[c].name,
                    orthonormalise(&stage->body[c], scale + stage->first[c],
                                   &of[c], plan, &V[c]));
        massless[c] = of[c].massless;
    }
done:
    for (int64_t c = 0; of && c < stage->count; c++)
        for (int g = 0; g < GROUPS; g++)
            ritz_dense_free(&of[c].group[g]);
    free(of);
    free(scale);
    return status;
}
