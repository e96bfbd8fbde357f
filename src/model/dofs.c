#include "base/alloc.h"
#include "model/equations.h"

#include <ritz/model.h>

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

ritz_status ritz_dofs_complement(const ritz_dofs *set, int64_t n,
                                 ritz_dofs *out)
{
    ritz_dofs rest = {0};
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_CHECK_NEW(taken, n);
    for (int64_t k = 0; k < set->count; k++) {
        int64_t dof = set->at[k];

        RITZ_REFUSE_IF(dof < 0 || dof >= n, RITZ_ERR_ARGUMENT,
                       "dof %" PRId64 " is not among the %" PRId64
                       " of the component",
                       dof, n);
        RITZ_REFUSE_IF(taken[dof], RITZ_ERR_ARGUMENT,
                       "dof %" PRId64 " is listed twice", dof);
        taken[dof] = true;
    }
    RITZ_CHECK_NEW(rest.at, n - set->count);
    for (int64_t dof = 0; dof < n; dof++)
        if (!taken[dof])
            rest.at[rest.count++] = dof;
    *out = rest;
    return RITZ_OK;
}

ritz_status ritz_dofs_copy(const ritz_dofs *set, ritz_dofs *out)
{
    RITZ_CHECK_COPY(out->at, set->at, set->count);
    out->count = set->count;
    return RITZ_OK;
}

const char *ritz_dof_name(ritz_dof dof, char text[RITZ_DOF_NAME_SIZE])
{
    if (dof.component == 0)
        snprintf(text, RITZ_DOF_NAME_SIZE, "point %" PRId64, dof.grid);
    else
        snprintf(text, RITZ_DOF_NAME_SIZE, "grid %" PRId64 " %c%" PRId64,
                 dof.grid, dof.component <= 3 ? 'T' : 'R',
                 dof.component <= 3 ? dof.component : dof.component - 3);
    return text;
}

int ritz_dof_compare(const void *left, const void *right)
{
    const ritz_dof *a = left;
    const ritz_dof *b = right;

    if (a->grid != b->grid)
        return a->grid < b->grid ? -1 : 1;
    return (a->component > b->component) - (a->component < b->component);
}

int64_t ritz_dof_distinct(int64_t count, ritz_dof *dof)
{
    int64_t kept = 0;

    if (count > 1)
        qsort(dof, (size_t)count, sizeof *dof, ritz_dof_compare);
    for (int64_t k = 0; k < count; k++)
        if (kept == 0 || ritz_dof_compare(&dof[kept - 1], &dof[k]) != 0)
            dof[kept++] = dof[k];
    return kept;
}

void ritz_dofs_free(ritz_dofs *set)
{
    free(set->at);
    *set = (ritz_dofs){0};
}

/* ---- rows by name ------------------------------------------------------- */

/* Most lists of dofs come in order, and qsort would take as long for them. */
static bool is_ascending(int64_t count, const ritz_dof *dof)
{
    for (int64_t k = 1; k < count; k++)
        if (ritz_dof_compare(&dof[k - 1], &dof[k]) > 0)
            return false;
    return true;
}

ritz_status ritz_roster_new(int64_t count, const ritz_dof *dof,
                            ritz_roster *out)
{
    RITZ_OWN(ritz_roster) roster = {.count = count};
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_CHECK_NEW(roster.place, count);
    for (int64_t k = 0; k < count; k++)
        roster.place[k] = (ritz_row_place){dof[k], k};
    if (!is_ascending(count, dof))
        qsort(roster.place, (size_t)count, sizeof *roster.place,
              ritz_dof_compare);
    for (int64_t k = 1; k < count; k++)
        RITZ_REFUSE_IF(
            ritz_dof_compare(&roster.place[k - 1], &roster.place[k]) == 0,
            RITZ_ERR_FORMAT, "%s has two rows",
            ritz_dof_name(roster.place[k].dof, name));
    RITZ_MOVE(*out, roster);
    return RITZ_OK;
}

int64_t ritz_roster_row(const ritz_roster *roster, ritz_dof dof)
{
    const ritz_row_place wanted = {.dof = dof};
    const ritz_row_place *found =
        bsearch(&wanted, roster->place, (size_t)roster->count,
                sizeof *roster->place, ritz_dof_compare);

    return found ? found->row : -1;
}

int64_t ritz_roster_from(const ritz_roster *roster, int64_t grid)
{
    int64_t low = 0;
    int64_t high = roster->count;

    while (low < high) {
        int64_t middle = low + (high - low) / 2;

        if (roster->place[middle].dof.grid < grid)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

void ritz_roster_free(ritz_roster *roster)
{
    free(roster->place);
    *roster = (ritz_roster){0};
}
