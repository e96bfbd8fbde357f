/*
 * What one configuration gives to the composite set, in its modal coordinates:
 * rigid modes, static answers of the system, kept modes or Krylov vectors. See
 * composite.c for what becomes of them.
 */
#include "base/alloc.h"
#include "compare/compare_parts.h"

#include <math.h>

/* Scale the flexible part of x to unit norm; false if there is none. */
static bool normalise(const ritz_configuration *c, double *x)
{
    double norm = 0.0;

    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        norm = hypot(norm, x[k]);
    for (int64_t k = c->num_rigid; k < c->K.ncol && norm > 0.0; k++)
        x[k] /= norm;
    return norm > 0.0;
}

/* Modal coordinates of the static answer to input j. */
static bool answer_input(const ritz_configuration *c, int64_t j, double *x)
{
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        x[k] = ritz_dense_col(&c->io.B, j)[k] / c->lambda[k];
    return normalise(c, x);
}

/* The same to a force that does work where row i of an output reads. */
static bool answer_output(const ritz_configuration *c, const ritz_dense *C,
                          int64_t i, double *x)
{
    for (int64_t k = c->num_rigid; k < c->K.ncol; k++)
        x[k] = ritz_dense_col(C, k)[i] / c->lambda[k];
    return normalise(c, x);
}

/* Modal coordinates of the system's static answers. */
static ritz_status choose_answers(const ritz_scene *scene,
                                  const ritz_configuration *c,
                                  const ritz_plan *plan, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *const C[] = {&c->io.C, &c->io.Cv, &c->io.Ca};
    ritz_dense X = {0};
    int64_t m = 0;

    RITZ_TRY(ritz_dense_new(c->K.ncol, c->io.num_inputs + 3 * c->io.num_outputs,
                            &X));
    for (int64_t j = 0; j < c->io.num_inputs; j++)
        if (ritz_plan_attaches(scene, plan, j))
            m += answer_input(c, j, ritz_dense_col(&X, m));
    for (int kind = 0; kind < 3; kind++)
        for (int64_t i = 0; i < c->io.num_outputs; i++)
            if (plan->attached & RITZ_ATTACHED_OUTPUTS)
                m += answer_output(c, C[kind], i, ritz_dense_col(&X, m));
    RITZ_TRY(ritz_dense_columns(&X, 0, m, out));
done:
    ritz_dense_free(&X);
    return status;
}

/* Unit columns of some modes. */
static ritz_status choose_modes(int64_t e, int64_t count, int64_t first,
                                const int64_t *which, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(e, count, out));
    for (int64_t k = 0; k < count; k++)
        ritz_dense_col(out, k)[first + (which ? which[k] : k)] = 1.0;
    return RITZ_OK;
}

static ritz_status choose_krylov(const ritz_scene *scene,
                                 const ritz_configuration *c, ritz_dense *out)
{
    int64_t moments = 0;

    RITZ_CHECK(ritz_system_krylov(c, scene->select_vectors,
                                  scene->select_outputs, out, &moments));
    for (int64_t j = 0; j < out->ncol; j++)
        (void)normalise(c, ritz_dense_col(out, j));
    return RITZ_OK;
}

ritz_status ritz_composite_choose(const ritz_scene *scene,
                                  const ritz_configuration *configuration,
                                  const ritz_compare_row *row, int group,
                                  const ritz_plan *plan, ritz_dense *out)
{
    const ritz_configuration *c = configuration;
    int64_t e = c->K.ncol;

    if (group == RITZ_GIVEN_RIGID)
        return choose_modes(e, c->num_rigid, 0, NULL, out);
    if (group == RITZ_GIVEN_STATIC && plan->augment == RITZ_AUGMENT_SYSTEM)
        return choose_answers(scene, c, plan, out);
    if (group == RITZ_GIVEN_KEPT && scene->select == RITZ_SELECT_KRYLOV)
        return choose_krylov(scene, c, out);
    if (group == RITZ_GIVEN_KEPT)
        return choose_modes(e, row->num_kept, c->num_rigid, row->kept, out);
    return ritz_dense_new(e, 0, out);
}
