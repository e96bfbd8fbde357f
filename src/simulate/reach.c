/* The largest value that a motion could give each output: see ritz_reach. */
#include "simulate/motion.h"

#include "base/alloc.h"

#include <math.h>
#include <string.h>

enum { BY_PLACE, BY_RATE, BY_ACCELERATION, BY_STRAIN, WAYS };

/* Diagonal entry j of M or K. */
static double diagonal_at(ritz_model s, bool mass, int64_t j)
{
    if (s.kind == RITZ_MODEL_COMPONENT)
        return ritz_sparse_diagonal(mass ? &s.component->M : &s.component->K,
                                    j);
    return ritz_dense_col(mass ? s.dense.M : s.dense.K, j)[j];
}

/* weight^2 += c^2 / by */
static void add_weight(const ritz_dense *C, int64_t j, int64_t i, double by,
                       double *weight)
{
    if (C->val && by > 0.0)
        *weight = hypot(*weight, ritz_dense_col(C, j)[i] / sqrt(by));
}

static void weigh_outputs(ritz_model s, ritz_reach *reach)
{
    const ritz_io io = ritz_model_io(s);
    int64_t n = ritz_model_order(s);

    for (int64_t j = 0; j < n; j++) {
        double m = diagonal_at(s, true, j);
        double k = m > 0.0 ? 0.0 : diagonal_at(s, false, j);

        for (int64_t i = 0; i < reach->count; i++) {
            double *weight = reach->weight + i * WAYS;

            add_weight(&io.C, j, i, m, &weight[BY_PLACE]);
            add_weight(&io.Cv, j, i, m, &weight[BY_RATE]);
            add_weight(&io.Ca, j, i, m, &weight[BY_ACCELERATION]);
            add_weight(&io.C, j, i, k, &weight[BY_STRAIN]);
        }
    }
}

ritz_status ritz_reach_new(ritz_model subject, const ritz_motion *motion,
                           ritz_reach *out)
{
    RITZ_OWN(ritz_reach) reach = {.count = motion->feed.nrow};

    RITZ_CHECK_NEW(reach.size, reach.count);
    if (subject.kind != RITZ_MODEL_STATES) {
        RITZ_CHECK_NEW(reach.weight, WAYS * reach.count);
        RITZ_CHECK_NEW(reach.last, motion->n);
        RITZ_CHECK_NEW(reach.work, motion->n);
        weigh_outputs(subject, &reach);
    }
    RITZ_MOVE(*out, reach);
    return RITZ_OK;
}

/* sqrt(x'M x) */
static double norm_of(const ritz_motion *motion, const double *x, double *work)
{
    if (motion->form == RITZ_FORM_MODAL)
        return sqrt(ritz_motion_dot(motion->n, x, x));
    memset(work, 0, (size_t)motion->n * sizeof *work);
    ritz_motion_add(motion, RITZ_MASS, 1.0, x, work);
    return sqrt(fmax(ritz_motion_dot(motion->n, x, work), 0.0));
}

static void note_states(ritz_reach *reach, const ritz_march *march)
{
    const ritz_dense *C = &march->motion->C;

    for (int64_t i = 0; i < reach->count; i++) {
        double sum = 0.0;

        for (int64_t j = 0; j < C->ncol; j++)
            sum += fabs(ritz_dense_col(C, j)[i] * march->x[j]);
        reach->size[i] = fmax(reach->size[i], sum);
    }
}

/* Norm of x'', from the difference of two velocities; 0 at the start. */
static double acceleration_of(ritz_reach *reach, const ritz_march *march,
                              double seconds)
{
    double by = seconds - reach->seconds;
    double size = 0.0;

    for (int64_t k = 0; k < march->motion->n; k++)
        reach->last[k] = march->v[k] - reach->last[k];
    if (by > 0.0)
        size = norm_of(march->motion, reach->last, reach->work) / by;
    memcpy(reach->last, march->v, (size_t)march->motion->n * sizeof(double));
    reach->seconds = seconds;
    return size;
}

void ritz_reach_note(ritz_reach *reach, const ritz_march *march, double seconds)
{
    double size[WAYS] = {0.0};
    double kinetic = 0.0, potential = 0.0;

    if (!reach->weight) {
        note_states(reach, march);
        return;
    }
    ritz_march_energy(march, &kinetic, &potential);
    size[BY_PLACE] = norm_of(march->motion, march->x, reach->work);
    size[BY_RATE] = sqrt(2.0 * fmax(kinetic, 0.0));
    size[BY_ACCELERATION] = acceleration_of(reach, march, seconds);
    size[BY_STRAIN] = sqrt(2.0 * fmax(potential, 0.0));
    for (int64_t i = 0; i < reach->count; i++) {
        double sum = 0.0;

        for (int k = 0; k < WAYS; k++)
            sum += reach->weight[i * WAYS + k] * size[k];
        reach->size[i] = fmax(reach->size[i], sum);
    }
}

void ritz_reach_free(ritz_reach *reach)
{
    RITZ_FREE(reach->weight, reach->size, reach->last, reach->work);
    *reach = (ritz_reach){0};
}
