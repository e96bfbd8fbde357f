/*
 * The composite mode set, projected on each body. At a configuration the
 * coordinates of body c are q_c = P_c x with x modal, so that its columns are
 *
 *     P_c Phi_r                        rigid modes
 *     P_c Phi_k                        kept modes
 *     P_c Phi_f Lambda_f^-1 Phi_f' B   what all flexible modes answer to each
 *                                      input statically [LeeTsuha1992, eq. 37]
 *
 * over all configurations. The static answer of all flexible modes spans, with
 * the kept ones, what that of the truncated ones does. With M_c = L L' and
 * Y = L' W, columns are taken in that order of right: rigid modes and static
 * answers whole, so that no tolerance costs rigidity or static gain; then what
 * is left of the kept modes, whose singular values below the scene's tolerance
 * are dropped. V_c = L'^-1 U. Static answers are scaled to unit mass of the
 * system, as modes are.
 */
#include "base/alloc.h"
#include "synthesis/compare_parts.h"
#include "synthesis/directions.h"

#include <cblas.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What all configurations give to one body, r_c rows. */
enum { RIGID, STATIC, KEPT, GROUPS };

/*
 * Below this, relative to the largest, a direction is rounding. Rigid modes
 * hold flexible motion of eps |P|'|K||P| / lambda, 1e-11 measured on frames of
 * bars, while the least rigid motion of a body is of the order of its size over
 * its distance from the centre of the system.
 */
static const double tightest[GROUPS] = {1e-9, 1e-12, 1e-12};

typedef struct columns {
    ritz_dense group[GROUPS];
} columns;

/* Modal coordinates of the static answer to input j, of unit norm. */
static bool answer(const ritz_configuration *c, int64_t j, double *x)
{
    double norm = 0.0;

    for (int64_t k = c->num_rigid; k < c->K.ncol; k++) {
        x[k] = ritz_dense_col(&c->io.B, j)[k] / c->lambda[k];
        norm += x[k] * x[k];
    }
    for (int64_t k = 0; k < c->K.ncol && norm > 0.0; k++)
        x[k] /= sqrt(norm);
    return norm > 0.0;
}

/* Modal coordinates of what a configuration gives to one group. */
static ritz_status choose(const ritz_configuration *c,
                          const ritz_compare_row *row, int group,
                          ritz_augment augment, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const int64_t most[GROUPS] = {
        [RIGID] = c->num_rigid,
        [STATIC] = augment == RITZ_AUGMENT_SYSTEM ? c->io.num_inputs : 0,
        [KEPT] = row->num_kept,
    };
    ritz_dense X = {0};
    int64_t m = 0;

    RITZ_TRY(ritz_dense_new(c->K.ncol, most[group], &X));
    for (int64_t k = 0; k < most[group]; k++) {
        int64_t mode = group == RIGID ? k : c->num_rigid;

        if (group == STATIC) {
            m += answer(c, k, ritz_dense_col(&X, m));
            continue;
        }
        ritz_dense_col(&X, m++)[group == KEPT ? mode + row->kept[k] : mode] =
            1.0;
    }
    RITZ_TRY(ritz_dense_columns(&X, 0, m, out));
done:
    ritz_dense_free(&X);
    return status;
}

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
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dense_new(r, r, out));
    for (int64_t j = 0; j < r; j++)
        ritz_dense_col(out, j)[j] = 1.0;
done:
    return status;
}

/* U: the groups in turn, each without what those before it span. */
static ritz_status choose_directions(const ritz_dense *L, const double *scale,
                                     const columns *of, double tolerance,
                                     ritz_dense *U)
{
    ritz_status status = RITZ_OK;
    ritz_dense Y = {0}, more = {0};
    double largest = 0.0;

    RITZ_TRY(ritz_dense_new(L->nrow, 0, U));
    for (int g = 0; g < GROUPS; g++) {
        double least = g == KEPT ? fmax(tolerance, tightest[g]) : tightest[g];

        RITZ_TRY(ritz_mass_transform(L, scale, &of->group[g], &Y));
        RITZ_TRY(ritz_take_out(U, &Y));
        RITZ_TRY(ritz_span(&Y, least, &largest, &more));
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
                                  const columns *of, double tolerance,
                                  ritz_dense *V)
{
    ritz_status status = RITZ_OK;
    int64_t r = body->M.ncol;
    ritz_dense L = {0}, U = {0};

    RITZ_TRY(ritz_mass_factor(body, scale, &L));
    RITZ_TRY(choose_directions(&L, scale, of, tolerance, &U));
    if (U.ncol == r) { /* nothing to remove: leave the body as it is */
        RITZ_TRY(identity(r, V));
        goto done;
    }
    if (U.ncol > 0)
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasTrans,
                    CblasNonUnit, (int)r, (int)U.ncol, 1.0, L.val, (int)r,
                    U.val, (int)r);
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
static ritz_status collect(const ritz_stage *stage, const ritz_configuration *c,
                           const ritz_compare_row *row, columns *of,
                           int64_t *count)
{
    ritz_status status = RITZ_OK;
    ritz_dense X = {0}, more = {0};

    for (int g = 0; g < GROUPS; g++) {
        RITZ_TRY(choose(c, row, g, stage->scene->augment, &X));
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

ritz_status ritz_compare_composite(const ritz_stage *stage,
                                   const ritz_system *system,
                                   const ritz_compare_row *row, ritz_dense *V,
                                   int64_t *count)
{
    ritz_status status = RITZ_OK;
    const ritz_scene *scene = stage->scene;
    columns *of = NULL;
    double *scale = NULL;

    *count = 0;
    RITZ_NEW(of, stage->count);
    RITZ_NEW(scale, stage->num_coordinates);
    ritz_stage_scale(stage, scale);
    for (int64_t k = 0; k < system->num_configurations; k++)
        if (counts(scene, k))
            RITZ_TRY(
                collect(stage, &system->configuration[k], &row[k], of, count));
    for (int64_t c = 0; c < stage->count; c++)
        RITZ_TRY_IN(scene->component[c].name,
                    orthonormalise(&stage->body[c], scale + stage->first[c],
                                   &of[c], scene->composite_tolerance, &V[c]));
done:
    for (int64_t c = 0; of && c < stage->count; c++)
        for (int g = 0; g < GROUPS; g++)
            ritz_dense_free(&of[c].group[g]);
    free(of);
    free(scale);
    return status;
}
