/*
 * Which rows of two sets of shapes are the same, and
 *
 *     MAC_ij = (u_i'M v_j)^2 / (u_i'M u_i v_j'M v_j)
 *
 * with M the mass of bodies, or 1 at dofs, or of inputs and outputs 1 over the
 * square of the largest of each.
 */
#include "chart/chart_mac.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_same(const mac_shapes *a, int64_t k, const mac_shapes *b,
                    int64_t i)
{
    if (a->seen)
        return strcmp(a->seen[k], b->seen[i]) == 0;
    return a->dof[k].grid == b->dof[i].grid &&
           a->dof[k].component == b->dof[i].component;
}

static double largest_in(const mac_shapes *s, int64_t row)
{
    double most = 0.0;

    for (int64_t k = 0; k < s->count; k++)
        most = fmax(most, fabs(ritz_dense_col(&s->U, k)[row]));
    return most;
}

static void divide_row(mac_shapes *s, int64_t row, double by)
{
    for (int64_t k = 0; k < s->count; k++)
        ritz_dense_col(&s->U, k)[row] /= by;
}

/* Each input and output counts as much as any other, whatever its unit. */
static ritz_status level(mac_shapes *a, mac_shapes *b, const int64_t *row)
{
    int64_t count = 0;

    for (int64_t k = 0; k < a->U.nrow; k++) {
        double most =
            row[k] < 0 ? 0.0 : fmax(largest_in(a, k), largest_in(b, row[k]));

        if (!(most > 0.0))
            continue;
        divide_row(a, k, most);
        divide_row(b, row[k], most);
        count++;
    }
    RITZ_REFUSE_IF(
        count < 2, RITZ_ERR_ARGUMENT,
        "'%s' and '%s' have %s in common by which modes could be told "
        "apart; configurations of the same bodies can be compared by "
        "their masses: name their reduced components too",
        a->name, b->name,
        count == 0 ? "no input or output" : "but one input or output");
    a->num_seen = b->num_seen = count;
    return RITZ_OK;
}

ritz_status mac_match(mac_shapes *a, mac_shapes *b, int64_t **out)
{
    ritz_status status = RITZ_OK;
    int64_t n = a->U.nrow, m = b->U.nrow, common = 0;
    int64_t *row = calloc((size_t)n + 1, sizeof *row);
    bool named = (a->dof && b->dof) || (a->seen && b->seen);

    RITZ_FAIL_IF(!row, RITZ_ERR_MEMORY, "no memory for dofs");
    RITZ_FAIL_IF(!named && n != m, RITZ_ERR_ARGUMENT,
                 "a basis names no dofs: '%s' has %lld rows and '%s' %lld",
                 a->name, (long long)n, b->name, (long long)m);
    for (int64_t k = 0, guess = 0; k < n; k++) {
        row[k] = named ? -1 : k;
        for (int64_t i = 0; named && i < m && row[k] < 0; i++) {
            int64_t at = (guess + i) % m; /* they mostly come in one order */

            if (is_same(a, k, b, at))
                row[k] = at;
        }
        guess = row[k] >= 0 ? row[k] + 1 : guess;
        common += row[k] >= 0;
    }
    if (a->seen && b->seen)
        RITZ_TRY(level(a, b, row));
    RITZ_FAIL_IF(common == 0, RITZ_ERR_ARGUMENT,
                 "'%s' and '%s' have no dof in common", a->name, b->name);
    *out = row;
    row = NULL;
done:
    free(row);
    return status;
}

double mac_of(const mac_shapes *a, const mac_shapes *b, const int64_t *row,
              int64_t i, int64_t j)
{
    const ritz_dense *MA = a->MU.val ? &a->MU : &a->U;
    const ritz_dense *MB = b->MU.val ? &b->MU : &b->U;
    const double *u = a->U.val + i * a->U.nrow, *Mu = MA->val + i * a->U.nrow;
    const double *v = b->U.val + j * b->U.nrow, *Mv = MB->val + j * b->U.nrow;
    double uv = 0.0, uu = 0.0, vv = 0.0;

    for (int64_t k = 0; k < a->U.nrow; k++) {
        if (row[k] < 0)
            continue;
        uv += u[k] * Mv[row[k]];
        uu += u[k] * Mu[k];
        vv += v[row[k]] * Mv[row[k]];
    }
    return uu > 0.0 && vv > 0.0 ? uv * uv / (uu * vv) : nan("");
}
