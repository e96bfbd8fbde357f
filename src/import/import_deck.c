/*
 * Names that a deck or a file of names has for the rows of a matrix.
 *
 * A deck explains these sizes: all its dofs, in its own order; the same without
 * those that its supports fix, without those that its constraints make depend
 * on others, or without both; its a-set, the union of its sets.
 */
#include "import/import.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* All dofs of the deck, in its own order. */
static ritz_status list_all(const ritz_deck *deck, ritz_names *out)
{
    RITZ_CHECK_NEW(out->dof, deck->num_dofs);
    if (deck->num_dofs > 0)
        memcpy(out->dof, deck->dof, (size_t)deck->num_dofs * sizeof *out->dof);
    out->count = deck->num_dofs;
    snprintf(out->map, sizeof out->map, "grids ascending");
    out->whole = true;
    return RITZ_OK;
}

/* Dofs that constraint elements eliminate, sorted. */
static ritz_status list_dependents(const ritz_deck *deck, ritz_dof **out)
{
    const ritz_equations *equations = &deck->equations;

    RITZ_CHECK_NEW(*out, equations->count);
    for (int64_t k = 0; k < equations->count; k++)
        (*out)[k] = equations->dependent[k];
    qsort(*out, (size_t)equations->count, sizeof **out, ritz_dof_compare);
    return RITZ_OK;
}

static bool is_in(ritz_dof dof, int64_t count, const ritz_dof *sorted)
{
    return count > 0 && bsearch(&dof, sorted, (size_t)count, sizeof *sorted,
                                ritz_dof_compare);
}

/* All but those of a sorted list. */
static void leave_out(int64_t count, const ritz_dof *sorted, ritz_names *names)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < names->count; k++)
        if (!is_in(names->dof[k], count, sorted))
            names->dof[kept++] = names->dof[k];
    names->count = kept;
}

static ritz_status list_less(const ritz_deck *deck, bool fixed, bool dependents,
                             ritz_names *out)
{
    ritz_status status = RITZ_OK;
    ritz_dof *tied = NULL;

    RITZ_TRY(list_all(deck, out));
    out->whole = !dependents;
    if (fixed)
        leave_out(deck->num_fixed, deck->fixed, out);
    if (dependents) {
        RITZ_TRY(list_dependents(deck, &tied));
        leave_out(deck->equations.count, tied, out);
    }
    snprintf(out->map, sizeof out->map, "grids less %s%s%s",
             fixed ? "SPCs" : "", fixed && dependents ? " and " : "",
             dependents ? "dependents" : "");
done:
    free(tied);
    return status;
}

/* The union of the sets that the deck states; empty if it states none. */
static ritz_status list_sets(const ritz_deck *deck, ritz_names *out)
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

static bool same_names(const ritz_names *a, const ritz_names *b)
{
    return a->count == b->count &&
           (a->count == 0 ||
            memcmp(a->dof, b->dof, (size_t)a->count * sizeof *a->dof) == 0);
}

enum { ALL, SETS, FREE, LESS, LEAST, KINDS };

/* What each list is called beside its size. */
static const char *const WORDS[KINDS] = {"", "a-set", "grids less SPCs",
                                         "grids less dependents",
                                         "grids less SPCs and dependents"};

/* "156 (26 grids)"; sizes that say nothing new are left out. */
static void explain(const ritz_deck *deck, const ritz_names *list, size_t size,
                    char *text)
{
    int used = snprintf(text, size, "%" PRId64 " (%" PRId64 " grids",
                        list[ALL].count, deck->grids.count);

    if (deck->num_points > 0)
        used += snprintf(text + used, size - (size_t)used,
                         ", %" PRId64 " points", deck->num_points);
    used += snprintf(text + used, size - (size_t)used, ")");
    for (int k = SETS; k < KINDS; k++) {
        bool news = list[k].count > 0;

        for (int j = 0; j < k; j++)
            news = news && list[j].count != list[k].count;
        if (news)
            used += snprintf(text + used, size - (size_t)used,
                             " or %" PRId64 " (%s)", list[k].count, WORDS[k]);
    }
}

static ritz_status choose(const ritz_deck *deck, int64_t n, const char *spec,
                          const ritz_names *list, int *chosen)
{
    char sizes[320];

    *chosen = -1;
    for (int k = 0; k < KINDS && *chosen != ALL; k++) {
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
    if (*chosen < 0) {
        explain(deck, list, sizeof sizes, sizes);
        RITZ_REFUSE_IF(true, RITZ_ERR_FORMAT,
                       "'%s' has %" PRId64 " rows; the deck explains %s", spec,
                       n, sizes);
    }
    return RITZ_OK;
}

ritz_status ritz_names_of_deck(const ritz_deck *deck, int64_t n,
                               const char *spec, ritz_names *out)
{
    ritz_status status = RITZ_OK;
    ritz_names list[KINDS] = {0};
    int chosen = -1;

    RITZ_TRY(list_all(deck, &list[ALL]));
    RITZ_TRY(list_sets(deck, &list[SETS]));
    RITZ_TRY(list_less(deck, true, false, &list[FREE]));
    RITZ_TRY(list_less(deck, false, true, &list[LESS]));
    RITZ_TRY(list_less(deck, true, true, &list[LEAST]));
    RITZ_TRY(choose(deck, n, spec, list, &chosen));
    *out = list[chosen];
    list[chosen] = (ritz_names){0};
done:
    for (int k = 0; k < KINDS; k++)
        ritz_names_free(&list[k]);
    return status;
}

/* `GRID COMP` of one line, which may be blank or end in a comment. */
static ritz_status take_line(const char *path, int64_t number, char *line,
                             ritz_names *names)
{
    const char *const blanks = " \t\r";
    const char *field[3] = {NULL, NULL, NULL};
    int count = 0;
    ritz_dof dof = {0};

    line[strcspn(line, "#")] = '\0';
    for (char *at = line + strspn(line, blanks); *at && count < 3;) {
        size_t length = strcspn(at, blanks);
        bool last = at[length] == '\0';

        field[count++] = at;
        at[length] = '\0';
        at += length + (last ? 0 : 1);
        at += strspn(at, blanks);
    }
    if (count == 0)
        return RITZ_OK;
    RITZ_REFUSE_IF(count != 2 || !ritz_text_whole(field[0], &dof.grid) ||
                       !ritz_text_whole(field[1], &dof.component),
                   RITZ_ERR_FORMAT,
                   "'%s', line %" PRId64 ": a grid and its direction are due, "
                   "such as '101 3'",
                   path, number);
    RITZ_REFUSE_IF(
        dof.grid < 1 || dof.component < 0 || dof.component > 6, RITZ_ERR_FORMAT,
        "'%s', line %" PRId64 ": '%s %s' is no dof: grids are from 1 "
        "on, directions 1 to 6, and 0 for a scalar point",
        path, number, field[0], field[1]);
    names->dof[names->count++] = dof;
    return RITZ_OK;
}

/* Say at which lines a dof stands twice: lines hold the places of names. */
static ritz_status check_distinct(const char *path, const ritz_names *names,
                                  const int64_t *line)
{
    ritz_status status = RITZ_OK;
    ritz_place *sorted = NULL;
    int64_t again = -1;
    int64_t first = -1;
    char name[RITZ_DOF_NAME_SIZE];

    RITZ_NEW(sorted, names->count);
    for (int64_t k = 0; k < names->count; k++)
        sorted[k] = (ritz_place){names->dof[k], line[k]};
    qsort(sorted, (size_t)names->count, sizeof *sorted, ritz_dof_compare);
    for (int64_t k = 1; k < names->count && again < 0; k++)
        if (ritz_dof_compare(&sorted[k - 1].dof, &sorted[k].dof) == 0) {
            bool swap = sorted[k - 1].row > sorted[k].row;

            first = sorted[swap ? k : k - 1].row;
            again = sorted[swap ? k - 1 : k].row;
            ritz_dof_name(sorted[k].dof, name);
        }
    RITZ_FAIL_IF(again >= 0, RITZ_ERR_FORMAT,
                 "'%s', line %" PRId64 ": '%s' was named at line %" PRId64
                 " already",
                 path, again, name, first);
done:
    free(sorted);
    return status;
}

ritz_status ritz_names_of_file(const char *path, ritz_names *out)
{
    ritz_status status = RITZ_OK;
    ritz_names names = {0};
    char *text = NULL;
    int64_t *line = NULL;
    int64_t lines = 1;
    int64_t number = 0;

    RITZ_TRY(ritz_text_read(path, &text));
    for (const char *c = text; *c; c++)
        lines += *c == '\n';
    RITZ_NEW(names.dof, lines);
    RITZ_NEW(line, lines);
    for (char *at = text; at;) {
        char *end = strchr(at, '\n');
        int64_t before = names.count;

        if (end)
            *end = '\0';
        RITZ_TRY(take_line(path, ++number, at, &names));
        if (names.count > before)
            line[before] = number;
        at = end ? end + 1 : NULL;
    }
    RITZ_TRY(check_distinct(path, &names, line));
    snprintf(names.map, sizeof names.map, "--dofs");
    *out = names;
    names = (ritz_names){0};
done:
    free(text);
    free(line);
    ritz_names_free(&names);
    return status;
}

void ritz_names_free(ritz_names *names)
{
    free(names->dof);
    *names = (ritz_names){0};
}
