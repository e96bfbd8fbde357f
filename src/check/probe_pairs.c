/*
 * Pairs of an input and an output of one name in a state space: a force, and
 * the displacement, velocity or acceleration of where it acts.
 */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "linear/general.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Passivity that is met better by less than this is met as well. */
static const double rounding = 1e-9;

static int64_t output_of(const ritz_state_space *model, int64_t input)
{
    for (int64_t i = 0; i < model->num_outputs; i++)
        if (strcmp(model->output[i], model->input[input]) == 0)
            return i;
    return -1;
}

static ritz_status take_pairs(const ritz_state_space *model,
                              ritz_collocated *out)
{
    ritz_status status = RITZ_OK;
    int64_t n = model->A.nrow;
    int64_t *in = NULL, *seen = NULL;
    int64_t p = 0;

    RITZ_NEW(in, model->num_inputs);
    RITZ_NEW(seen, model->num_inputs);
    for (int64_t j = 0; j < model->num_inputs; j++) {
        seen[p] = output_of(model, j);
        in[p] = j;
        p += seen[p] >= 0;
    }
    RITZ_TRY(ritz_dense_copy(&model->A, &out->A));
    RITZ_TRY(ritz_dense_new(n, p, &out->B));
    RITZ_TRY(ritz_dense_new(p, n, &out->C));
    RITZ_TRY(ritz_dense_new(p, p, &out->D));
    RITZ_NEW(out->power, p);
    RITZ_NEW(out->name, p);
    for (int64_t j = 0; j < p; j++) {
        memcpy(ritz_dense_col(&out->B, j), ritz_dense_col(&model->B, in[j]),
               (size_t)n * sizeof *out->B.val);
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&out->C, i)[j] =
                ritz_dense_col(&model->C, i)[seen[j]];
        for (int64_t i = 0; i < p; i++)
            ritz_dense_col(&out->D, j)[i] =
                ritz_dense_col(&model->D, in[j])[seen[i]];
        memcpy(out->name[j], model->input[in[j]], sizeof *out->name);
    }
    if (model->E.val) {
        RITZ_TRY_IN("E", ritz_general_solve(&model->E, false, &out->A));
        RITZ_TRY_IN("E", ritz_general_solve(&model->E, false, &out->B));
    }
done:
    free(in);
    free(seen);
    return status;
}

/* One pair as a model of its own. */
static ritz_status alone(const ritz_collocated *all, int64_t i, int *power,
                         ritz_collocated *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense row = {0};

    out->A = all->A; /* borrowed, as power is */
    out->power = power;
    RITZ_TRY(ritz_dense_columns(&all->B, i, 1, &out->B));
    RITZ_TRY(ritz_dense_rows(&all->C, 1, &i, &out->C));
    RITZ_TRY(ritz_dense_rows(&all->D, 1, &i, &row));
    RITZ_TRY(ritz_dense_columns(&row, i, 1, &out->D));
done:
    ritz_dense_free(&row);
    return status;
}

/* What output i is: what breaks passivity least; of equals a displacement. */
static ritz_status guess(const ritz_collocated *all, int64_t i)
{
    ritz_status status = RITZ_OK;
    static const int powers[] = {1, 0, -1};
    double best = -HUGE_VAL;

    for (size_t k = 0; k < sizeof powers / sizeof *powers; k++) {
        ritz_collocated one = {0};
        ritz_passivity found = {0};
        int power = powers[k];

        status = alone(all, i, &power, &one);
        if (status == RITZ_OK)
            status = ritz_passivity_of(&one, &found);
        one.A = (ritz_dense){0};
        one.power = NULL;
        ritz_collocated_free(&one);
        RITZ_TRY(status);
        if (found.value > best + rounding) {
            best = found.value;
            all->power[i] = power;
        }
    }
done:
    return status;
}

ritz_status ritz_collocated_of_space(const ritz_state_space *model,
                                     ritz_collocated *out)
{
    ritz_status status = RITZ_OK;
    ritz_collocated pairs = {0};

    RITZ_TRY(take_pairs(model, &pairs));
    for (int64_t i = 0; i < pairs.B.ncol; i++)
        RITZ_TRY(guess(&pairs, i));
    *out = pairs;
    pairs = (ritz_collocated){0};
done:
    ritz_collocated_free(&pairs);
    return status;
}
