/* The dofs of the rows of all matrices, and rows found by dof. */
#include "base/alloc.h"
#include "base/team.h"
#include "import/import.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- rows by name ------------------------------------------------------- */

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

/* ---- rows and recovered dofs --------------------------------------------- */

ritz_status ritz_extended_new(const ritz_component *component,
                              const ritz_equations *equations,
                              ritz_extended *out)
{
    RITZ_OWN(ritz_extended)
    new = {.view = *component,
           .num_rows = component->num_dofs,
           .equations = equations};
    const ritz_recovery *recovery = &component->recovery;

    new.view.dof = NULL;
    RITZ_CHECK(ritz_recovery_extend(recovery, component->num_dofs,
                                    component->dof, NULL, &new.view.dof, NULL));
    new.view.num_dofs += recovery->count;
    RITZ_CHECK(ritz_roster_new(new.view.num_dofs, new.view.dof, &new.roster));
    if (recovery->count > 0)
        RITZ_CHECK(ritz_sparse_transpose(&recovery->G, &new.from));
    RITZ_MOVE(*out, new);
    return RITZ_OK;
}

void ritz_extended_add(const ritz_extended *extended, int64_t row, double value,
                       int64_t stride, double *into)
{
    const ritz_sparse *from = &extended->from;
    int64_t k = row - extended->num_rows;

    if (k < 0)
        into[stride * row] += value;
    for (int64_t p = k < 0 ? 0 : from->colptr[k];
         k >= 0 && p < from->colptr[k + 1]; p++)
        into[stride * from->rowind[p]] += value * from->val[p];
}

void ritz_extended_free(ritz_extended *extended)
{
    free(extended->view.dof);
    ritz_roster_free(&extended->roster);
    ritz_sparse_free(&extended->from);
    *extended = (ritz_extended){0};
}

/* ---- names of a deck and of a file -------------------------------------- */

/*
 * Names that a deck or a file of names has for the rows of a matrix.
 *
 * A deck explains these sizes: the rows of an external superelement, which it
 * lists; all its dofs, in its own order; the same without those that its
 * supports fix, without those that its constraints make depend on others, or
 * without both; its a-set, the union of its sets.
 */

/* All dofs of the deck, in its own order. */
static ritz_status list_all(const ritz_deck *deck, ritz_row_names *out)
{
    RITZ_CHECK_COPY(out->dof, deck->dof, deck->num_dofs);
    out->count = deck->num_dofs;
    snprintf(out->map, sizeof out->map, "grids ascending");
    out->whole = true;
    return RITZ_OK;
}

bool ritz_dof_among(ritz_dof dof, int64_t count, const ritz_dof *sorted)
{
    return count > 0 && bsearch(&dof, sorted, (size_t)count, sizeof *sorted,
                                ritz_dof_compare);
}

/* All but those of a sorted list. */
static void leave_out(int64_t count, const ritz_dof *sorted,
                      ritz_row_names *names)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < names->count; k++)
        if (!ritz_dof_among(names->dof[k], count, sorted))
            names->dof[kept++] = names->dof[k];
    names->count = kept;
}

static ritz_status list_less(const ritz_deck *deck, bool fixed, bool dependents,
                             ritz_row_names *out)
{
    int64_t count = deck->equations.count;
    RITZ_OWN_ARRAY ritz_dof *tied = NULL; /* dependent dofs, sorted */

    RITZ_CHECK(list_all(deck, out));
    out->whole = !dependents;
    if (fixed)
        leave_out(deck->num_fixed, deck->fixed, out);
    if (dependents) {
        RITZ_CHECK_COPY(tied, deck->equations.dependent, count);
        qsort(tied, (size_t)count, sizeof *tied, ritz_dof_compare);
        leave_out(count, tied, out);
    }
    snprintf(out->map, sizeof out->map, "grids less %s%s%s",
             fixed ? "SPCs" : "", fixed && dependents ? " and " : "",
             dependents ? "dependents" : "");
    return RITZ_OK;
}

/* The union of the sets that the deck states; empty if it states none. */
static ritz_status list_sets(const ritz_deck *deck, ritz_row_names *out)
{
    int64_t total = 0;

    for (int s = 0; s < RITZ_NUM_SETS; s++)
        total += deck->num_sets[s];
    RITZ_CHECK_NEW(out->dof, total);
    for (int s = 0; s < RITZ_NUM_SETS; s++)
        for (int64_t k = 0; k < deck->num_sets[s]; k++)
            out->dof[out->count++] = deck->set[s][k];
    out->count = ritz_dof_distinct(total, out->dof);
    snprintf(out->map, sizeof out->map, "A-set");
    return RITZ_OK;
}

/* The rows of an external superelement, which has no dependent dofs. */
static ritz_status list_external(const ritz_deck *deck, ritz_row_names *out)
{
    RITZ_CHECK_COPY(out->dof, deck->external, deck->num_external);
    out->count = deck->num_external;
    snprintf(out->map, sizeof out->map, "EXTRN");
    return RITZ_OK;
}

static bool same_names(const ritz_row_names *a, const ritz_row_names *b)
{
    return a->count == b->count &&
           (a->count == 0 ||
            memcmp(a->dof, b->dof, (size_t)a->count * sizeof *a->dof) == 0);
}

enum { ALL, EXTERNAL, SETS, FREE, LESS, LEAST, KINDS };

/* The lists of names that a deck explains. */
typedef struct deck_lists {
    ritz_row_names list[KINDS];
} deck_lists;

static void deck_lists_free(deck_lists *lists)
{
    for (int k = 0; k < KINDS; k++)
        ritz_row_names_free(&lists->list[k]);
}

/* Names of the lists in messages. */
static const char *const WORDS[KINDS] = {"",
                                         "EXTRN",
                                         "a-set",
                                         "grids less SPCs",
                                         "grids less dependents",
                                         "grids less SPCs and dependents"};

/* "156 (26 grids)"; sizes that say nothing new are left out. */
static void explain_sizes(const ritz_deck *deck, const ritz_row_names *list,
                          size_t size, char *text)
{
    int used = snprintf(text, size, "%" PRId64 " (%" PRId64 " grids",
                        list[ALL].count, deck->grids.count);

    if (deck->num_points > 0)
        used += snprintf(text + used, size - (size_t)used,
                         ", %" PRId64 " points", deck->num_points);
    used += snprintf(text + used, size - (size_t)used, ")");
    for (int k = EXTERNAL; k < KINDS; k++) {
        bool news = list[k].count > 0;

        for (int j = 0; j < k; j++)
            news = news && list[j].count != list[k].count;
        if (news)
            used += snprintf(text + used, size - (size_t)used,
                             " or %" PRId64 " (%s)", list[k].count, WORDS[k]);
    }
}

static ritz_status choose_list(const ritz_deck *deck, int64_t n,
                               const char *spec, const ritz_row_names *list,
                               int *chosen)
{
    char sizes[320];

    *chosen = -1;
    if (list[EXTERNAL].count == n && n > 0)
        *chosen = EXTERNAL; /* the only list that states the order of rows */
    for (int k = 0; k < KINDS && *chosen != ALL && *chosen != EXTERNAL; k++) {
        if (list[k].count != n || n == 0)
            continue;
        RITZ_REFUSE_IF(*chosen >= 0 && !same_names(&list[*chosen], &list[k]),
                       RITZ_ERR_FORMAT,
                       "'%s' has %" PRId64
                       " rows, as the deck's %s has and its "
                       "%s have: --dofs must say which",
                       spec, n, WORDS[*chosen], WORDS[k]);
        if (*chosen < 0)
            *chosen = k;
    }
    /* if EXTRN is incomplete, another list of the right length has another
       order */
    RITZ_REFUSE_IF(*chosen >= 0 && *chosen != EXTERNAL &&
                       list[EXTERNAL].count > 0,
                   RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " rows, but EXTRN names %" PRId64
                   ": --dofs must name the rows",
                   spec, n, list[EXTERNAL].count);
    if (*chosen >= 0)
        return RITZ_OK;
    explain_sizes(deck, list, sizeof sizes, sizes);
    return ritz_fail(RITZ_ERR_FORMAT,
                     "'%s' has %" PRId64 " rows; the deck explains %s", spec, n,
                     sizes);
}

/* Names that a deck has for @p spec, n rows. @return RITZ_ERR_FORMAT */
static ritz_status list_deck_names(const ritz_deck *deck, int64_t n,
                                   const char *spec, ritz_row_names *out)
{
    RITZ_OWN(deck_lists) lists = {0};
    ritz_row_names *list = lists.list;
    int chosen = -1;

    RITZ_REFUSE_IF(deck->unnumbered, RITZ_ERR_FORMAT,
                   "%s: --dofs must name the rows of '%s'", deck->unnumbered,
                   spec);
    RITZ_REFUSE_IF(deck->external_twice, RITZ_ERR_FORMAT, "%s",
                   deck->external_twice);
    RITZ_CHECK(list_all(deck, &list[ALL]));
    RITZ_CHECK(list_external(deck, &list[EXTERNAL]));
    RITZ_CHECK(list_sets(deck, &list[SETS]));
    for (int k = FREE; k < KINDS; k++)
        RITZ_CHECK(list_less(deck, k != LESS, k != FREE, &list[k]));
    RITZ_CHECK(choose_list(deck, n, spec, list, &chosen));
    RITZ_MOVE(*out, list[chosen]);
    return RITZ_OK;
}

/* ---- one list for all matrices ------------------------------------------ */

ritz_status ritz_import_directions(const char *text, bool want[static 7])
{
    RITZ_REFUSE_IF(!*text, RITZ_ERR_ARGUMENT, "no directions follow ':'");
    for (const char *c = text; *c; c++) {
        int k = *c - '0';

        RITZ_REFUSE_IF(
            k < 0 || k > 6 || want[k], RITZ_ERR_ARGUMENT,
            "'%s' are not directions: digits 1 to 6, each once, or 0 "
            "for scalar points",
            text);
        want[k] = true;
    }
    RITZ_REFUSE_IF(want[0] && text[1], RITZ_ERR_ARGUMENT,
                   "'%s' are not directions: 0, for scalar points, goes alone",
                   text);
    return RITZ_OK;
}

/* Without a deck, grids 1, 2, ... have a row for each direction of --rows, six
 * by default; 0: scalar points. */
static ritz_status number_grids(int64_t n, const char *spec, const char *rows,
                                ritz_row_names *out)
{
    const char *directions = rows ? rows : "123456";
    int64_t each = (int64_t)strlen(directions);

    RITZ_REFUSE_IF(!rows && (n == 0 || n % 6 != 0), RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " rows, which is not six for each grid: "
                   "--rows, --dofs or --bulk must say what they are",
                   spec, n);
    RITZ_REFUSE_IF(n == 0 || n % each != 0, RITZ_ERR_FORMAT,
                   "'%s' has %" PRId64 " rows, which is not %" PRId64
                   " for each grid, as --rows %s has it",
                   spec, n, each, rows);
    RITZ_CHECK_NEW(out->dof, n);
    out->count = n;
    for (int64_t k = 0; k < n; k++)
        out->dof[k] = (ritz_dof){k / each + 1, directions[k % each] - '0'};
    snprintf(out->map, sizeof out->map, "%s",
             rows ? "--rows" : "grids ascending");
    return RITZ_OK;
}

/* Check that --rows has directions, and that nothing else names the rows. */
static ritz_status check_rows(const ritz_import_request *request,
                              const ritz_part *unnamed)
{
    bool want[7] = {0};

    if (!request->rows)
        return RITZ_OK;
    RITZ_REFUSE_IF(!*request->rows, RITZ_ERR_ARGUMENT,
                   "'' are not directions: digits 1 to 6, each once, or 0 for "
                   "scalar points");
    RITZ_CHECK(ritz_import_directions(request->rows, want));
    RITZ_REFUSE_IF(request->dofs || request->bulk || !unnamed,
                   RITZ_ERR_ARGUMENT, "%s names the rows already",
                   request->dofs   ? "--dofs"
                   : request->bulk ? "the deck"
                                   : "the file of the matrices");
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
static ritz_status unite_rows(const ritz_parts *parts, ritz_row_names *out)
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
static ritz_status name_by_file(const char *path, ritz_side_files *side,
                                ritz_parts *parts, ritz_row_names *out)
{
    const ritz_part *first = NULL;

    RITZ_CHECK(ritz_side_files_names(side, out));
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

/* Parts whose files name the rows are placed by name, others as they are. */
static ritz_status place_rows(ritz_part *part, const ritz_row_names *names,
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
                                const ritz_deck *deck, ritz_side_files *side,
                                ritz_parts *parts, ritz_row_names *out)
{
    const ritz_part *unnamed = first_unnamed(parts);
    int64_t n = unnamed ? unnamed->matrix.A.nrow : 0;

    RITZ_CHECK_IN("--rows", check_rows(request, unnamed));
    if (request->dofs)
        RITZ_CHECK(name_by_file(request->dofs, side, parts, out));
    else if (!unnamed)
        RITZ_CHECK(unite_rows(parts, out));
    else if (request->bulk)
        RITZ_CHECK(list_deck_names(deck, n, unnamed->spec, out));
    else
        RITZ_CHECK(number_grids(
            n, unnamed->spec, request->frequencies ? "0" : request->rows, out));
    if (request->frequencies)
        snprintf(out->map, sizeof out->map, "modes");
    if (request->bulk && (request->dofs || !unnamed))
        out->whole = out->count >= deck->num_dofs;
    return RITZ_OK;
}

ritz_status ritz_names_find(const ritz_import_request *request,
                            const ritz_deck *deck, ritz_side_files *side,
                            ritz_parts *parts, ritz_row_names *out)
{
    RITZ_OWN(ritz_row_names) names = {0};
    RITZ_OWN(ritz_roster) roster = {0};
    const ritz_part *unnamed = first_unnamed(parts);

    for (int64_t k = 0; unnamed && k < parts->count; k++) {
        const ritz_matrix *one = &parts->part[k].matrix;

        RITZ_REFUSE_IF(
            !one->row && one->A.nrow != unnamed->matrix.A.nrow, RITZ_ERR_FORMAT,
            "'%s' has %" PRId64 " rows, '%s' has %" PRId64, parts->part[k].spec,
            one->A.nrow, unnamed->spec, unnamed->matrix.A.nrow);
    }
    RITZ_CHECK(choose_names(request, deck, side, parts, &names));
    RITZ_CHECK(ritz_roster_new(names.count, names.dof, &roster));
    for (int64_t k = 0; k < parts->count; k++) {
        ritz_part *part = &parts->part[k];

        RITZ_CHECK(place_rows(part, &names, &roster,
                              request->dofs ? NULL : part->matrix.row));
    }
    RITZ_MOVE(*out, names);
    return RITZ_OK;
}

int ritz_part_threads(const ritz_sparse *A)
{
    enum { ENTRIES = 1 << 18 }; /* a fraction of a millisecond */
    const int64_t gain = A->colptr[A->ncol] / ENTRIES;

    return ritz_team_ready(gain < RITZ_TEAM_SHARES ? gain : RITZ_TEAM_SHARES);
}

/* Rows with an entry on the diagonal: each thread marks some of them. */
typedef struct marking {
    const ritz_part *part;
    unsigned char bit;
    unsigned char *mark;
    int64_t marked[RITZ_TEAM_SHARES]; /* by each thread */
} marking;

static void mark_diagonal(int thread, int64_t from, int64_t to, void *task)
{
    marking *all = task;
    int64_t marked = 0;

    for (int64_t j = from; j < to; j++)
        if (ritz_sparse_diagonal(&all->part->matrix.A, j) != 0.0) {
            all->mark[all->part->place[j]] |= all->bit;
            marked++;
        }
    all->marked[thread] = marked;
}

void ritz_part_mark(const ritz_part *part, unsigned char bit,
                    unsigned char *mark)
{
    const ritz_sparse *A = &part->matrix.A;
    marking all = {.part = part, .bit = bit, .mark = mark};
    int64_t marked = 0;

    ritz_team_over(ritz_part_threads(A), A->ncol, mark_diagonal, &all);
    for (int k = 0; k < RITZ_TEAM_SHARES; k++)
        marked += all.marked[k];
    if (marked == A->ncol) /* the usual case: there is no row left */
        return;
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++)
            if (A->val[p] != 0.0) {
                mark[part->place[j]] |= bit;
                mark[part->place[A->rowind[p]]] |= bit;
            }
}
