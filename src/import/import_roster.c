/* Rows by name, and what is said of a name that is not there. */
#include "import/import.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>

static int compare_places(const void *left, const void *right)
{
    const ritz_place *a = left;
    const ritz_place *b = right;

    return ritz_dof_compare(&a->dof, &b->dof);
}

ritz_status ritz_roster_new(int64_t count, const ritz_dof *dof,
                            ritz_roster *out)
{
    ritz_status status = RITZ_OK;
    ritz_roster roster = {.count = count};
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_NEW(roster.place, count);
    for (int64_t k = 0; k < count; k++)
        roster.place[k] = (ritz_place){dof[k], k};
    qsort(roster.place, (size_t)count, sizeof *roster.place, compare_places);
    for (int64_t k = 1; k < count; k++)
        RITZ_FAIL_IF(compare_places(&roster.place[k - 1], &roster.place[k]) ==
                         0,
                     RITZ_ERR_FORMAT, "%s has two rows",
                     ritz_dof_name(roster.place[k].dof, name));
    *out = roster;
    roster = (ritz_roster){0};
done:
    ritz_roster_free(&roster);
    return status;
}

int64_t ritz_roster_row(const ritz_roster *roster, ritz_dof dof)
{
    const ritz_place wanted = {.dof = dof};
    const ritz_place *found =
        bsearch(&wanted, roster->place, (size_t)roster->count,
                sizeof *roster->place, compare_places);

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

/* Nearest grid by number; the roster is not empty. */
static int64_t nearest_grid(const ritz_roster *roster, int64_t grid)
{
    int64_t k = ritz_roster_from(roster, grid);
    int64_t above = k < roster->count ? roster->place[k].dof.grid : 0;
    int64_t below = k > 0 ? roster->place[k - 1].dof.grid : 0;

    if (k == roster->count)
        return below;
    return k > 0 && grid - below <= above - grid ? below : above;
}

ritz_status ritz_roster_miss(const ritz_roster *roster, ritz_dof dof)
{
    char name[RITZ_DOF_NAME_SIZE];
    int64_t k = ritz_roster_from(roster, dof.grid);

    if (roster->count == 0)
        return ritz_fail(RITZ_ERR_ARGUMENT, "there are no dofs");
    if (k == roster->count || roster->place[k].dof.grid != dof.grid)
        return ritz_fail(RITZ_ERR_ARGUMENT,
                         "there is no grid or point '%" PRId64
                         "', the nearest is %" PRId64,
                         dof.grid, nearest_grid(roster, dof.grid));
    return ritz_fail(RITZ_ERR_ARGUMENT, "there is no '%s' among the dofs",
                     ritz_dof_name(dof, name));
}

void ritz_roster_free(ritz_roster *roster)
{
    free(roster->place);
    *roster = (ritz_roster){0};
}
