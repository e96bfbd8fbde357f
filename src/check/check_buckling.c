/* What checks say of buckling: factors of each load, and of loads that act. */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "check/buckling.h"
#include "check/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A model whose factors are looked for: K and KG of its loads, dense if it is
   reduced. */
typedef struct loaded {
    int64_t count;
    const ritz_component *component; /* NULL: `reduced` */
    const ritz_reduced *reduced;
    const ritz_dense *K, *M; /* of a reduced one, with springs of dampers */
} loaded;

static loaded loaded_of(const ritz_checker *it)
{
    return (loaded){.count = it->component ? it->component->num_loads
                                           : it->reduced->num_loads,
                    .component = it->component,
                    .reduced = it->reduced,
                    .K = &it->model.K,
                    .M = &it->model.M};
}

static const char *name_of(const loaded *l, int64_t k)
{
    return l->component ? l->component->load[k].name : l->reduced->load[k].name;
}

static ritz_status find_factors(const loaded *l, int64_t k, ritz_buckling *out)
{
    return l->component
               ? ritz_buckling_sparse(&l->component->K,
                                      &l->component->load[k].KG, out)
               : ritz_buckling_dense(l->K, &l->reduced->load[k].KG, out);
}

static ritz_status check_held(const loaded *l, bool *held)
{
    return l->component
               ? ritz_buckling_held(&l->component->K, &l->component->M, held)
               : ritz_buckling_held_dense(l->K, l->M, held);
}

/* sum_k amount_k KG_k, a load of its own. */
static ritz_status sum_sparse(const ritz_component *c, const double *amount,
                              ritz_sparse *out)
{
    RITZ_CHECK(ritz_sparse_new(c->num_dofs, c->num_dofs, 0, out));
    for (int64_t k = 0; k < c->num_loads; k++) {
        RITZ_OWN(ritz_sparse) sum = {0};

        RITZ_CHECK(ritz_sparse_add(1.0, out, amount[k], &c->load[k].KG, &sum));
        ritz_sparse_free(out);
        RITZ_MOVE(*out, sum);
    }
    return RITZ_OK;
}

static ritz_status sum_dense(const ritz_reduced *r, const double *amount,
                             ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(r->K.nrow, r->K.ncol, out));
    for (int64_t k = 0; k < r->num_loads; k++)
        for (int64_t e = 0; e < out->nrow * out->ncol; e++)
            out->val[e] += amount[k] * r->load[k].KG.val[e];
    return RITZ_OK;
}

static ritz_status find_applied(const loaded *l, const double *amount,
                                ritz_buckling *out)
{
    RITZ_OWN(ritz_sparse) sparse = {0};
    RITZ_OWN(ritz_dense) dense = {0};

    if (l->component) {
        RITZ_CHECK(sum_sparse(l->component, amount, &sparse));
        return ritz_buckling_sparse(&l->component->K, &sparse, out);
    }
    RITZ_CHECK(sum_dense(l->reduced, amount, &dense));
    return ritz_buckling_dense(l->K, &dense, out);
}

/* A line for each direction of a load. */
static void say_load(ritz_checker *it, const char *load,
                     const ritz_buckling *found)
{
    const struct {
        const char *prefix, *never;
        double factor;
    } line[RITZ_LINES_OF_LOAD] = {
        {"buckling", "it does not buckle under it", found->factor},
        {"buckling-reversed", "it does not buckle under the load reversed",
         found->reversed},
    };

    for (int k = 0; k < RITZ_LINES_OF_LOAD; k++) {
        char name[2 * RITZ_NAME_SIZE], says[RITZ_WHERE_SIZE];

        snprintf(name, sizeof name, "%s:%s", line[k].prefix, load);
        if (isnan(line[k].factor))
            snprintf(says, sizeof says, "%s", line[k].never);
        else
            snprintf(says, sizeof says, "K + %.8g KG is singular",
                     line[k].factor);
        ritz_checker_say(it, name, line[k].factor, nan(""), RITZ_PASS, "", "%s",
                         says);
    }
}

/* Loads that act are too near to their buckling load, or beyond it. */
static void say_applied(ritz_checker *it, const ritz_buckling *found)
{
    static const double limit = 1.0 / RITZ_BUCKLING_PART;
    const double mu = found->factor;

    if (isnan(mu))
        ritz_checker_say(it, "buckling-applied", mu, limit, RITZ_PASS, "",
                         "the loads that act stiffen it");
    else if (mu <= 1.0)
        ritz_checker_say(it, "buckling-applied", mu, limit, RITZ_FAIL, "",
                         "it buckles at %.6g times the loads that act", mu);
    else
        ritz_checker_say(it, "buckling-applied", mu, limit,
                         mu < limit ? RITZ_WARN : RITZ_PASS, "",
                         "the loads that act are %.3g %% of those at which it "
                         "buckles, and make deflections %.3g times as large",
                         100.0 / mu, mu / (mu - 1.0));
}

/* K may be too nearly singular to be divided out, or iterations fail: the audit
   says so and goes on. */
static bool could_not(ritz_checker *it, const char *load, ritz_status status)
{
    char name[2 * RITZ_NAME_SIZE];

    if (status != RITZ_ERR_SINGULAR && status != RITZ_ERR_CONVERGENCE)
        return false;
    snprintf(name, sizeof name, "buckling%s%s", *load ? ":" : "", load);
    ritz_checker_say(it, name, nan(""), nan(""), RITZ_WARN, "",
                     "not computed: %s", ritz_error_message());
    return true;
}

/* Factors of load k. */
static ritz_status check_load(ritz_checker *it, const loaded *l, int64_t k)
{
    ritz_buckling found = {0};
    const ritz_status status = find_factors(l, k, &found);

    if (could_not(it, name_of(l, k), status))
        return RITZ_OK;
    RITZ_CHECK_IN(name_of(l, k), status);
    say_load(it, name_of(l, k), &found);
    return RITZ_OK;
}

ritz_status ritz_check_buckling(ritz_checker *it)
{
    const loaded l = loaded_of(it);
    ritz_status status = RITZ_OK;
    ritz_buckling found = {0};
    bool held = false;

    status = check_held(&l, &held);
    if (could_not(it, "", status))
        return RITZ_OK;
    RITZ_CHECK(status);
    if (!held) {
        ritz_checker_say(it, "buckling", nan(""), nan(""),
                         it->amount ? RITZ_WARN : RITZ_PASS, "",
                         "not computed: a motion is free, and a load turns "
                         "what nothing holds");
        return RITZ_OK;
    }
    for (int64_t k = 0; k < l.count; k++)
        RITZ_CHECK(check_load(it, &l, k));
    if (!it->amount)
        return RITZ_OK;
    status = find_applied(&l, it->amount, &found);
    if (could_not(it, "applied", status))
        return RITZ_OK;
    RITZ_CHECK(status);
    say_applied(it, &found);
    return RITZ_OK;
}
