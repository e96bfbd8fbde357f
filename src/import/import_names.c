/* What the rows of all matrices are, in one list. */
#include "import/import.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Without a deck: grids 1, 2, ... with six rows each. */
static ritz_status number_grids(int64_t n, const char *spec, ritz_names *out)
{
    RITZ_REFUSE_IF(n == 0 || n % 6 != 0, RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " rows, which is not six for each grid: "
                   "--dofs or --bulk must say what they are",
                   spec, n);
    RITZ_CHECK_NEW(out->dof, n);
    out->count = n;
    for (int64_t k = 0; k < n; k++)
        out->dof[k] = (ritz_dof){k / 6 + 1, k % 6 + 1};
    snprintf(out->map, sizeof out->map, "grids ascending");
    return RITZ_OK;
}

/* The first part that does not name its rows; NULL if all do. */
static const ritz_part *first_unnamed(const ritz_parts *parts)
{
    for (int64_t k = 0; k < parts->count; k++)
        if (!parts->part[k].matrix.row)
            return &parts->part[k];
    return NULL;
}

/* All rows that any file names, ascending by grid and direction. */
static ritz_status unite(const ritz_parts *parts, ritz_names *out)
{
    int64_t total = 0;

    for (int64_t k = 0; k < parts->count; k++)
        total += parts->part[k].matrix.A.nrow;
    RITZ_CHECK_NEW(out->dof, total);
    for (int64_t k = 0; k < parts->count; k++)
        for (int64_t i = 0; i < parts->part[k].matrix.A.nrow; i++)
            out->dof[out->count++] = parts->part[k].matrix.row[i];
    out->count = ritz_dof_distinct(total, out->dof);
    snprintf(out->map, sizeof out->map, "file");
    return RITZ_OK;
}

/* Rows that --dofs names: files that name theirs otherwise must agree. */
static ritz_status name_by_file(const char *path, ritz_parts *parts,
                                ritz_names *out)
{
    const ritz_part *first = NULL;

    RITZ_CHECK(ritz_names_of_file(path, out));
    for (int64_t k = 0; k < parts->count; k++) {
        const ritz_part *part = &parts->part[k];
        int64_t n = part->matrix.A.nrow;

        RITZ_REFUSE_IF(out->count != n, RITZ_ERR_FORMAT,
                       "'%s' names %" PRId64 " dofs, '%s' has %" PRId64 " rows",
                       path, out->count, part->spec, n);
        if (!part->matrix.row)
            continue;
        RITZ_REFUSE_IF(first &&
                           memcmp(first->matrix.row, part->matrix.row,
                                  (size_t)n * sizeof *part->matrix.row) != 0,
                       RITZ_ERR_FORMAT,
                       "'%s' and '%s' hold different dofs, one --dofs cannot "
                       "name the rows of both",
                       first->spec, part->spec);
        first = part;
    }
    return RITZ_OK;
}

static ritz_status check_size(const ritz_part *part, int64_t due,
                              const char *other)
{
    if (part->matrix.A.nrow == due)
        return RITZ_OK;
    return ritz_fail(RITZ_ERR_FORMAT,
                     "'%s' has %" PRId64 " rows, '%s' has %" PRId64, part->spec,
                     part->matrix.A.nrow, other, due);
}

/* Parts whose files name the rows are placed by name, others as they are. */
static ritz_status place_rows(ritz_part *part, const ritz_names *names,
                              const ritz_roster *roster, const ritz_dof *row)
{
    int64_t n = part->matrix.A.nrow;
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_CHECK_NEW(part->place, n);
    for (int64_t i = 0; i < n; i++) {
        part->place[i] = row ? ritz_roster_row(roster, row[i]) : i;
        RITZ_REFUSE_IF(part->place[i] < 0, RITZ_ERR_FORMAT,
                       "'%s' names '%s', which is not among the %" PRId64
                       " rows of the other matrices",
                       part->spec, ritz_dof_name(row[i], name), names->count);
    }
    return RITZ_OK;
}

static ritz_status choose_names(const ritz_import_request *request,
                                const ritz_deck *deck, ritz_parts *parts,
                                ritz_names *out)
{
    const ritz_part *unnamed = first_unnamed(parts);
    int64_t n = unnamed ? unnamed->matrix.A.nrow : 0;

    if (request->dofs)
        RITZ_CHECK(name_by_file(request->dofs, parts, out));
    else if (!unnamed)
        RITZ_CHECK(unite(parts, out));
    else if (request->bulk)
        RITZ_CHECK(ritz_names_of_deck(deck, n, unnamed->spec, out));
    else
        RITZ_CHECK(number_grids(n, unnamed->spec, out));
    if (request->bulk && (request->dofs || !unnamed))
        out->whole = out->count >= deck->num_dofs;
    return RITZ_OK;
}

ritz_status ritz_names_find(const ritz_import_request *request,
                            const ritz_deck *deck, ritz_parts *parts,
                            ritz_names *out)
{
    ritz_status status = RITZ_OK;
    ritz_names names = {0};
    ritz_roster roster = {0};
    const ritz_part *unnamed = first_unnamed(parts);

    for (int64_t k = 0; unnamed && k < parts->count; k++)
        if (!parts->part[k].matrix.row)
            RITZ_TRY(check_size(&parts->part[k], unnamed->matrix.A.nrow,
                                unnamed->spec));
    RITZ_TRY(choose_names(request, deck, parts, &names));
    RITZ_TRY(ritz_roster_new(names.count, names.dof, &roster));
    for (int64_t k = 0; k < parts->count; k++) {
        ritz_part *part = &parts->part[k];

        RITZ_TRY(place_rows(part, &names, &roster,
                            request->dofs ? NULL : part->matrix.row));
    }
    *out = names;
    names = (ritz_names){0};
done:
    ritz_names_free(&names);
    ritz_roster_free(&roster);
    return status;
}
