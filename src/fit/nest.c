/*
 * A component's columns in the order in which they matter, and what every
 * prefix of them comes to. A scene's are in nest_scene.c.
 */
#include "fit/fit_parts.h"
#include "fit/order.h"

#include "base/alloc.h"

#include <ritz/monitor.h>
#include <ritz/nested.h>

#include <stdlib.h>

/* Entries of T above which columns stay in the order they were made in. */
static const int64_t most_entries = 4000000;

/* What is being put in order. */
typedef struct nesting {
    const ritz_fitter *fitter;
    const ritz_reduced *whole;
} nesting;

/* How far a model of these columns is off; infinite if it is none. */
static ritz_status excess_of(void *context, int64_t count,
                             const int64_t *column, double most, double *out)
{
    ritz_status status = RITZ_OK;
    const nesting *n = context;
    const ritz_verify_request *limits = &n->fitter->request.tolerance;
    ritz_fit_candidate judged = {0};
    ritz_reduced part = {0};

    (void)most; /* one measurement gives it all */
    RITZ_TRY(ritz_reduced_nest(n->whole, count, column, 1, &part));
    RITZ_TRY(ritz_reduced_install(&part));
    RITZ_TRY(ritz_reference_measure(n->fitter->place[0].reference, &part,
                                    limits, 0, &judged.errors));
    ritz_fit_judge(limits, &judged);
done:
    status = ritz_fit_refuse(status, &judged);
    *out = judged.excess;
    ritz_reduced_free(&part);
    ritz_fit_candidate_free(&judged);
    return status;
}

/* What every prefix comes to. */
static ritz_status note_errors(const ritz_fitter *fitter, ritz_reduced *nested)
{
    ritz_status status = RITZ_OK;
    ritz_reduced part = {0};
    ritz_measures found = {0};

    for (int64_t r = nested->nested.smallest; r <= nested->K.ncol; r++) {
        ritz_monitor_step("errors of prefixes", r, nested->K.ncol);
        RITZ_TRY(ritz_reduced_prefix(nested, r, &part));
        RITZ_TRY(ritz_reduced_install(&part));
        status = ritz_reference_measure(
            fitter->place[0].reference, &part, &fitter->request.tolerance,
            RITZ_AT_OTHER_POLES | RITZ_AT_RANDOM, &found);
        if (status == RITZ_ERR_MEMORY)
            goto done;
        for (int64_t k = 0; status == RITZ_OK && k < found.count; k++)
            RITZ_TRY(ritz_nested_note(nested, r, found.item[k].name,
                                      found.item[k].value));
        status = RITZ_OK; /* of a prefix that cannot be measured: nothing */
        ritz_measures_free(&found);
        ritz_reduced_free(&part);
    }
done:
    ritz_measures_free(&found);
    ritz_reduced_free(&part);
    return status;
}

ritz_status ritz_fit_nest(const ritz_fitter *fitter, const ritz_reduced *whole,
                          ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    nesting n = {.fitter = fitter, .whole = whole};
    ritz_fit_order order = {0};
    ritz_column_kind *kind = NULL;

    RITZ_NEW(kind, whole->K.ncol);
    RITZ_TRY(ritz_fit_kinds(whole, kind));
    RITZ_TRY(ritz_fit_order_new(whole->K.ncol, kind, excess_of, &n, &order));
    if (whole->T.nrow * order.count <= most_entries) {
        RITZ_TRY(ritz_fit_order_alone(&order));
        RITZ_TRY(ritz_fit_order_drop(&order));
    }
    RITZ_TRY(ritz_reduced_nest(whole, order.count, order.column,
                               order.fixed > 0 ? order.fixed : 1, out));
done:
    free(kind);
    ritz_fit_order_free(&order);
    return status;
}

/* A prefix as it is judged: on the grid, and then where it is confirmed. */
static ritz_status judge(ritz_fitter *fitter, const ritz_reduced *nested,
                         int64_t order, ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    ritz_reduced part = {0};

    ritz_measures_free(&out->errors);
    RITZ_TRY(ritz_reduced_prefix(nested, order, &part));
    out->order = out->columns = order;
    out->left_out = nested->K.ncol - order;
    RITZ_TRY(ritz_fit_measure(fitter, &part, out));
done:
    ritz_reduced_free(&part);
    return ritz_fit_refuse(status, out);
}

ritz_status ritz_fit_trim(ritz_fitter *fitter, const ritz_fit_candidate *from,
                          ritz_fit_candidate *out)
{
    ritz_status status = RITZ_OK;
    ritz_basis basis = {0};
    ritz_reduced whole = {0}, nested = {0};
    ritz_fit_candidate best = {0}, trial = {.method = from->method};

    RITZ_TRY(ritz_fit_make(fitter, from, &basis, &whole));
    RITZ_TRY(ritz_fit_nest(fitter, &whole, &nested));
    for (int64_t r = from->order - 1, failed = 0;
         r >= nested.nested.smallest && failed < 2; r--) {
        RITZ_TRY(judge(fitter, &nested, r, &trial));
        failed = trial.feasible ? 0 : failed + 1;
        if (trial.feasible) {
            ritz_fit_candidate_free(&best);
            best = trial;
            trial = (ritz_fit_candidate){.method = from->method};
        }
    }
    if (best.order > 0) {
        best.num_bodies = 1;
        best.spent = from->spent;
        RITZ_NEW(best.modes, 1);
        best.modes[0] = from->modes[0];
    }
    *out = best;
    best = (ritz_fit_candidate){0};
done:
    ritz_basis_free(&basis);
    ritz_reduced_free(&whole);
    ritz_reduced_free(&nested);
    ritz_fit_candidate_free(&best);
    ritz_fit_candidate_free(&trial);
    return status;
}

/* The first columns of what is nested, nested again. */
static ritz_status cut(ritz_reduced *nested, int64_t order)
{
    ritz_status status = RITZ_OK;
    ritz_reduced part = {0};
    int64_t *first = NULL;

    if (order >= nested->K.ncol)
        return RITZ_OK;
    RITZ_NEW(first, order);
    for (int64_t k = 0; k < order; k++)
        first[k] = k;
    RITZ_TRY(ritz_reduced_nest(nested, order, first, nested->nested.smallest,
                               &part));
    ritz_reduced_free(nested);
    *nested = part;
    part = (ritz_reduced){0};
done:
    ritz_reduced_free(&part);
    free(first);
    return status;
}

ritz_status ritz_fitter_reduced(ritz_fitter *fitter,
                                const ritz_fit_candidate *candidate,
                                ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    ritz_basis basis = {0};
    ritz_reduced whole = {0}, nested = {0};

    RITZ_TRY(ritz_fit_make(fitter, candidate, &basis, &whole));
    RITZ_TRY(ritz_fit_nest(fitter, &whole, &nested));
    RITZ_TRY(cut(&nested, candidate->order));
    RITZ_TRY(note_errors(fitter, &nested));
    RITZ_TRY(ritz_measures_copy(&candidate->errors, &nested.errors));
    RITZ_TRY(ritz_measures_copy(&candidate->estimates, &nested.estimates));
    *out = nested;
    nested = (ritz_reduced){0};
done:
    ritz_basis_free(&basis);
    ritz_reduced_free(&whole);
    ritz_reduced_free(&nested);
    return status;
}
