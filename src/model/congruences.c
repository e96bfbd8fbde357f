#include "model/congruences.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "linear/general.h"
#include "model/equations.h"

#include <math.h>
#include <string.h>

void ritz_fastest_add(double k, double m, ritz_fastest *fastest)
{
    if (m > 0.0)
        fastest->ratio = fmax(fastest->ratio, k / m);
    else
        fastest->massless = true;
}

bool ritz_may_be_rigid(ritz_column_kind kind)
{
    return kind == RITZ_COLUMN_RIGID || kind == RITZ_COLUMN_CONSTRAINT;
}

ritz_status ritz_congruences_twofold(const ritz_dense *G, bool *out)
{
    RITZ_OWN(ritz_dense) scaled = {0};
    double rcond = 0.0;

    *out = false;
    if (G->ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_copy(G, &scaled));
    for (int64_t j = 0; j < G->ncol; j++)
        for (int64_t i = 0; i < G->ncol; i++)
            ritz_dense_col(&scaled, j)[i] /=
                sqrt(ritz_dense_col(G, i)[i] * ritz_dense_col(G, j)[j]);
    RITZ_CHECK(ritz_general_cholesky(&scaled, &rcond));
    *out = !(rcond > RITZ_SQUARED_DEPENDENT);
    return RITZ_OK;
}

/*
 * T'KT. A direction d in which columns of T nearly depend on each other has a
 * stiffness d'Kd and a coupling phi'Kd that are far below the rounding of
 * |T|'|K||T|, and what is made of them, (phi'Kd)^2 / d'Kd, would be off in the
 * modes that are kept: K T is then summed with twice the digits.
 */
static ritz_status project_stiffness(const ritz_sparse *K, const ritz_dense *T,
                                     bool twofold, ritz_dense *out)
{
    RITZ_OWN(ritz_dense) KT = {0};

    if (!twofold)
        return ritz_sparse_project(K, T, out);
    RITZ_CHECK(ritz_sparse_mul_twofold(K, T, &KT));
    RITZ_CHECK(ritz_dense_mul_tn(T, &KT, out));
    if (ritz_sparse_asymmetry(K) == 0.0)
        ritz_dense_symmetrise(out);
    return RITZ_OK;
}

/* T with zeros for massless columns, so that invariants agree with M. */
static ritz_status copy_mass_columns(const ritz_column_kind *kind,
                                     const ritz_dense *T, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_copy(T, out));
    for (int64_t j = 0; j < out->ncol; j++)
        if (kind[j] == RITZ_COLUMN_MASSLESS)
            memset(ritz_dense_col(out, j), 0,
                   (size_t)out->nrow * sizeof *out->val);
    return RITZ_OK;
}

static ritz_status find_inertia(const ritz_component *component,
                                const ritz_column_kind *kind,
                                const ritz_dense *T, ritz_congruences *out)
{
    RITZ_OWN(ritz_dense) moving = {0};
    bool any = false;

    for (int64_t j = 0; j < T->ncol; j++)
        any = any || kind[j] == RITZ_COLUMN_MASSLESS;
    RITZ_CHECK(ritz_inertia_momenta(component, &out->rigid));
    if (any)
        RITZ_CHECK(copy_mass_columns(kind, T, &moving));
    return ritz_invariants_of(component, any ? &moving : T, &out->invariants);
}

/* |T|'|K||T| in rows and columns that may be rigid. */
static ritz_status find_terms(const ritz_sparse *K,
                              const ritz_column_kind *kind, const ritz_dense *T,
                              ritz_dense *out)
{
    const int64_t r = T->ncol;
    RITZ_OWN(ritz_dense) terms = {0};
    RITZ_OWN_ARRAY int64_t *rigid = NULL;
    int64_t count = 0;

    RITZ_CHECK_NEW(rigid, r);
    for (int64_t j = 0; j < r; j++)
        if (ritz_may_be_rigid(kind[j]))
            rigid[count++] = j;
    RITZ_CHECK(ritz_sparse_terms(K, T, count, rigid, &terms));
    RITZ_CHECK(ritz_dense_new(r, r, out));
    for (int64_t k = 0; k < count; k++)
        for (int64_t i = 0; i < r; i++)
            ritz_dense_col(out, rigid[k])[i] =
                ritz_dense_col(out, i)[rigid[k]] = ritz_dense_col(&terms, k)[i];
    return RITZ_OK;
}

ritz_status ritz_congruences_of(const ritz_component *component,
                                const ritz_column_kind *kind,
                                const ritz_dense *T, bool twofold,
                                ritz_congruences *out)
{
    const ritz_sparse *K4 = &component->K4;
    RITZ_OWN(ritz_congruences) s = {0};

    ritz_monitor_step("projection", 0, 0);
    RITZ_CHECK(find_inertia(component, kind, T, &s));
    RITZ_CHECK(project_stiffness(&component->K, T, twofold, &s.K));
    RITZ_CHECK(find_terms(&component->K, kind, T, &s.K_terms));
    RITZ_CHECK(ritz_sparse_project(&component->M, T, &s.M));
    RITZ_CHECK(ritz_sparse_project(&component->D, T, &s.D));
    RITZ_CHECK(ritz_sparse_project(K4, T, &s.K4));
    if (K4->colptr)
        RITZ_CHECK(find_terms(K4, kind, T, &s.K4_terms));
    RITZ_CHECK(
        ritz_loads_reduce(component->num_loads, component->load, T, &s.load));
    s.num_loads = component->num_loads;
    RITZ_MOVE(*out, s);
    return RITZ_OK;
}

void ritz_congruences_free(ritz_congruences *sums)
{
    enum { MEMBERS = 7 };
    ritz_dense *const all[MEMBERS] = {
        &sums->K,       &sums->M,        &sums->D,    &sums->K4,
        &sums->K_terms, &sums->K4_terms, &sums->rigid};

    for (int k = 0; k < MEMBERS; k++)
        ritz_dense_free(all[k]);
    RITZ_FREE_EACH(ritz_reduced_load, sums->num_loads, sums->load);
    ritz_invariants_free(&sums->invariants);
    *sums = (ritz_congruences){0};
}
