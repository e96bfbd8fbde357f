/* Rows of G_m: substitution, and small dense systems where that is a circle. */
#include "model/elimination_rows.h"

#include "base/alloc.h"
#include "base/tolerances.h"

#include <lapacke.h>

#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>

enum {
    MOST_COUPLED = 2000,      /* in one circle: a factor of 32 MB */
    MOST_ENTRIES = 200000000, /* of all rows: 3 GB */
};

static void add(ritz_eliminator *s, int64_t col, double value)
{
    if (!s->used[col]) {
        s->used[col] = true;
        s->list[s->num_used++] = col;
    }
    s->sum[col] += value;
}

/*
 * Equation e with all that is known substituted, in `sum`; shares of members
 * of its own circle are taken from row i of I - R_mm instead.
 */
static void substitute(ritz_eliminator *s, int64_t e, int64_t i, ritz_dense *A)
{
    const ritz_equations *eq = s->equations;

    for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++) {
        int64_t of = s->equation[s->at[k]];
        const ritz_elimination_row *known = of < 0 ? NULL : &s->found[of];

        if (of < 0)
            add(s, s->at[k], eq->share[k]);
        else if (s->member[of] >= 0)
            ritz_dense_col(A, s->member[of])[i] -= eq->share[k];
        else
            for (int64_t j = 0; j < known->count; j++)
                add(s, known->col[j], eq->share[k] * known->val[j]);
    }
}

static void clear(ritz_eliminator *s)
{
    for (int64_t k = 0; k < s->num_used; k++) {
        s->sum[s->list[k]] = 0.0;
        s->used[s->list[k]] = false;
    }
    s->num_used = 0;
}

static ritz_status count_entries(ritz_eliminator *s, int64_t count)
{
    RITZ_REFUSE_IF(count > MOST_ENTRIES - s->num_kept, RITZ_ERR_FORMAT,
                   "the constraints spread over more than %d entries: a chain "
                   "of them sums up too much",
                   MOST_ENTRIES);
    s->num_kept += count;
    return RITZ_OK;
}

/* What lies in `sum`, or in column i of X by the places in `sum`, as a row. */
static ritz_status keep_row(ritz_eliminator *s, const ritz_dense *X, int64_t i,
                            ritz_elimination_row *out)
{
    ritz_status status = RITZ_OK;
    ritz_elimination_row new = {0};

    RITZ_TRY(count_entries(s, s->num_used));
    RITZ_NEW(new.col, s->num_used);
    RITZ_NEW(new.val, s->num_used);
    for (int64_t k = 0; k < s->num_used; k++) {
        double value = X ? ritz_dense_col(X, k)[i] : s->sum[s->list[k]];

        if (value == 0.0)
            continue;
        new.col[new.count] = s->list[k];
        new.val[new.count++] = value;
    }
    *out = new;
    new = (ritz_elimination_row){0};
done:
    free(new.col);
    free(new.val);
    return status;
}

/* X := A^-1 X. The rows of A are of entries about 1, its own scale. */
static ritz_status solve(const ritz_eliminator *s, const int64_t *circle,
                         ritz_dense *A, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    const ritz_equations *eq = s->equations;
    lapack_int n = (lapack_int)A->nrow;
    lapack_int *pivot = NULL;
    double size = 0.0;
    double rcond = 0.0;
    char name[RITZ_DOF_NAME_SIZE];
    char cited[RITZ_CITATION_SIZE];

    RITZ_NEW(pivot, n);
    size = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', n, n, A->val, n);
    if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, A->val, n, pivot) == 0)
        RITZ_FAIL_IF(LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', n, A->val, n, size,
                                    &rcond) != 0,
                     RITZ_ERR_MEMORY, "no memory for the constraints");
    RITZ_FAIL_IF(!(rcond > RITZ_UNDETERMINED), RITZ_ERR_SINGULAR,
                 "%s leaves '%s' undetermined%s",
                 ritz_equations_cite(eq, eq->source[circle[0]], cited),
                 ritz_dof_name(eq->dependent[circle[0]], name),
                 n > 1 ? ", together with the constraints that depend on it"
                       : ": it depends on itself alone");
    if (X->ncol > 0)
        RITZ_FAIL_IF(LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', n,
                                    (lapack_int)X->ncol, A->val, n, pivot,
                                    X->val, n) != 0,
                     RITZ_ERR_MEMORY, "no memory for the constraints");
done:
    free(pivot);
    return status;
}

/* Right-hand sides of a circle: columns as they come to be used. */
static ritz_status gather(ritz_eliminator *s, int64_t count,
                          const int64_t *circle, ritz_dense *A, ritz_dense *X)
{
    ritz_status status = RITZ_OK;
    ritz_elimination_row *side = NULL;

    RITZ_NEW(side, count);
    for (int64_t i = 0; i < count; i++) {
        substitute(s, circle[i], i, A);
        RITZ_TRY(keep_row(s, NULL, 0, &side[i]));
        for (int64_t k = 0; k < s->num_used; k++)
            s->sum[s->list[k]] = 0.0;
    }
    RITZ_TRY(ritz_dense_new(count, s->num_used, X));
    for (int64_t k = 0; k < s->num_used; k++)
        s->sum[s->list[k]] = (double)k;
    for (int64_t i = 0; i < count; i++)
        for (int64_t k = 0; k < side[i].count; k++)
            ritz_dense_col(X, (int64_t)s->sum[side[i].col[k]])[i] =
                side[i].val[k];
done:
    for (int64_t i = 0; side && i < count; i++) {
        free(side[i].col);
        free(side[i].val);
    }
    free(side);
    return status;
}

static ritz_status solve_circle(ritz_eliminator *s, int64_t count,
                                const int64_t *circle)
{
    ritz_status status = RITZ_OK;
    ritz_dense A = {0}, X = {0};

    RITZ_FAIL_IF(count > MOST_COUPLED, RITZ_ERR_FORMAT,
                 "%" PRId64 " dofs depend on each other in a circle, of at "
                 "most %d that is solved",
                 count, MOST_COUPLED);
    RITZ_TRY(ritz_dense_new(count, count, &A));
    for (int64_t i = 0; i < count; i++)
        ritz_dense_col(&A, i)[i] = 1.0;
    RITZ_TRY(gather(s, count, circle, &A, &X));
    RITZ_TRY(solve(s, circle, &A, &X));
    for (int64_t i = 0; i < count; i++)
        RITZ_TRY(keep_row(s, &X, i, &s->found[circle[i]]));
done:
    clear(s);
    ritz_dense_free(&A);
    ritz_dense_free(&X);
    return status;
}

static bool needs_itself(const ritz_eliminator *s, int64_t e)
{
    const ritz_equations *eq = s->equations;

    for (int64_t k = eq->first[e]; k < eq->first[e + 1]; k++)
        if (s->equation[s->at[k]] == e)
            return true;
    return false;
}

/* Members of a circle, or one equation that all it needs is known of. */
ritz_status ritz_eliminator_settle(ritz_eliminator *s, int64_t count,
                                   const int64_t *circle)
{
    ritz_status status = RITZ_OK;

    if (count == 1 && !needs_itself(s, circle[0])) {
        substitute(s, circle[0], 0, NULL);
        status = keep_row(s, NULL, 0, &s->found[circle[0]]);
        clear(s);
        return status;
    }
    for (int64_t i = 0; i < count; i++)
        s->member[circle[i]] = i;
    RITZ_TRY(solve_circle(s, count, circle));
    for (int64_t i = 0; i < count; i++)
        s->member[circle[i]] = -1;
done:
    return status;
}
