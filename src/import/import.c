/* ritz_import: read, name, place, and settle. */
#include "import/import.h"
#include "base/alloc.h"
#include "base/team.h"
#include "base/text.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- matrices of the component ------------------------------------------ */

/*
 * From matrices as read to matrices of the component: rows are placed by name,
 * what the deck fixes is left out (u = 0), and rows empty in both K and M are
 * left out too, as nothing moves there.
 */

/* Whether the rows of a part that stay keep their order in the component. */
static bool is_in_order(const ritz_part *part, const int64_t *stays)
{
    int64_t last = -1;

    for (int64_t i = 0; i < part->matrix.A.nrow; i++) {
        int64_t row = stays[part->place[i]];

        if (row >= 0 && row <= last)
            return false;
        last = row >= 0 ? row : last;
    }
    return true;
}

/* Whether entries are zero: each thread looks at some of them. */
typedef struct zero_search {
    const double *val;
    bool found[RITZ_TEAM_SHARES]; /* by each thread */
} zero_search;

static void find_zero(int thread, int64_t from, int64_t to, void *task)
{
    zero_search *search = task;
    bool found = false;

    for (int64_t p = from; p < to; p++)
        found |= search->val[p] == 0.0;
    search->found[thread] = found;
}

static bool has_zeros(const ritz_sparse *A)
{
    const int64_t nnz = A->colptr[A->ncol];
    zero_search search = {.val = A->val};
    bool found = false;

    ritz_team_over(ritz_part_threads(A), nnz, find_zero, &search);
    for (int k = 0; k < RITZ_TEAM_SHARES; k++)
        found = found || search.found[k];
    return found;
}

/* Whether the matrix of a part is that of the component as it is. */
static bool is_complete(const ritz_part *part, const int64_t *stays, int64_t n)
{
    const ritz_sparse *A = &part->matrix.A;
    bool whole = A->ncol == n;

    for (int64_t j = 0; j < A->ncol && whole; j++)
        whole = stays[part->place[j]] == j;
    return whole && !has_zeros(A);
}

/* Remove the other rows and columns of such a part within its own arrays, which
 * `out` takes over. */
static ritz_status close_up_part(ritz_part *part, const int64_t *stays,
                                 int64_t n, ritz_sparse *out)
{
    ritz_sparse *A = &part->matrix.A;
    RITZ_OWN_ARRAY int64_t *colptr = NULL;
    int64_t kept = 0;

    RITZ_CHECK_NEW(colptr, n + 1);
    for (int64_t j = 0; j < A->ncol; j++) {
        int64_t col = stays[part->place[j]];
        int64_t before = kept;

        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            int64_t row = stays[part->place[A->rowind[p]]];

            if (col < 0 || row < 0 || A->val[p] == 0.0)
                continue;
            A->rowind[kept] = row;
            A->val[kept++] = A->val[p];
        }
        if (col >= 0)
            colptr[col + 1] = kept - before;
    }
    for (int64_t j = 0; j < n; j++)
        colptr[j + 1] += colptr[j];
    free(A->colptr);
    *out = (ritz_sparse){n, n, colptr, A->rowind, A->val};
    colptr = NULL;
    *A = (ritz_sparse){0};
    return RITZ_OK;
}

/*
 * A(place, place) of the rows that stay. The part loses its matrix: it is
 * freed, or `out` takes over its arrays. Zeros are left out, so that a dense
 * and a sparse spelling of a matrix give the same component.
 */
static ritz_status scatter_part(ritz_part *part, const int64_t *stays,
                                int64_t n, ritz_sparse *out)
{
    const ritz_sparse *A = &part->matrix.A;
    int64_t nnz = A->colptr[A->ncol];
    int64_t kept = 0;
    RITZ_OWN_ARRAY int64_t *row = NULL;
    RITZ_OWN_ARRAY int64_t *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;

    if (is_complete(part, stays, n)) {
        RITZ_MOVE(*out, part->matrix.A);
        return RITZ_OK;
    }
    if (is_in_order(part, stays))
        return close_up_part(part, stays, n, out);
    RITZ_CHECK_NEW(row, nnz);
    RITZ_CHECK_NEW(col, nnz);
    RITZ_CHECK_NEW(val, nnz);
    for (int64_t j = 0; j < A->ncol; j++)
        for (int64_t p = A->colptr[j]; p < A->colptr[j + 1]; p++) {
            row[kept] = stays[part->place[A->rowind[p]]];
            col[kept] = stays[part->place[j]];
            val[kept] = A->val[p];
            kept += A->val[p] != 0.0 && row[kept] >= 0 && col[kept] >= 0;
        }
    RITZ_CHECK(ritz_sparse_from_triplets(n, n, kept, row, col, val, out));
    ritz_sparse_free(&part->matrix.A);
    return RITZ_OK;
}

/* What the entries of a row are of. */
enum { HAS_STIFFNESS = 1, HAS_MASS = 2, HAS_OTHER = 4 };

static void mark_rows(const ritz_parts *parts, const ritz_component *component,
                      unsigned char *mark)
{
    for (int64_t k = 0; k < parts->count; k++) {
        const ritz_sparse *becomes = parts->part[k].becomes;

        ritz_part_mark(&parts->part[k],
                       becomes == &component->K   ? HAS_STIFFNESS
                       : becomes == &component->M ? HAS_MASS
                                                  : HAS_OTHER,
                       mark);
    }
}

/* Sort the rows: stays[k] is the new row, -1 if it is left out. */
static ritz_status sort_rows(const unsigned char *mark, const ritz_deck *deck,
                             const ritz_row_names *names, bool rigid,
                             int64_t *stays, ritz_import_report *report,
                             ritz_component *to)
{
    char name[RITZ_DOF_NAME_SIZE];

    for (int64_t k = 0; k < names->count; k++) {
        bool empty = !(mark[k] & (HAS_STIFFNESS | HAS_MASS));

        stays[k] = -1;
        if (!empty &&
            ritz_dof_among(names->dof[k], deck->num_fixed, deck->fixed)) {
            report->fixed[report->num_fixed++] = names->dof[k];
            continue;
        }
        RITZ_REFUSE_IF(empty && mark[k] & HAS_OTHER, RITZ_ERR_FORMAT,
                       "'%s' has damping or geometric stiffness, but neither "
                       "stiffness nor mass",
                       ritz_dof_name(names->dof[k], name));
        if (empty) {
            report->removed[report->num_removed++] = names->dof[k];
            continue;
        }
        report->num_massless += !(mark[k] & HAS_MASS);
        report->num_floating += !(mark[k] & HAS_STIFFNESS) && !rigid;
        stays[k] = to->num_dofs;
        to->dof[to->num_dofs++] = names->dof[k];
    }
    RITZ_REFUSE_IF(to->num_dofs == 0, RITZ_ERR_FORMAT,
                   "no row that is free to move has stiffness or mass");
    return RITZ_OK;
}

/* Whether the deck fixes the place of a grid. */
static bool is_held(const ritz_deck *deck, int64_t id)
{
    for (int component = 1; component <= 3; component++)
        if (!ritz_dof_among((ritz_dof){id, component}, deck->num_fixed,
                            deck->fixed))
            return false;
    return true;
}

/* Keep the grids that have rows in the matrices, and the grids that the deck
   holds: some solvers leave out the rows of these. The motion of any other grid
   is not known. */
static void keep_grids(const ritz_roster *roster, const ritz_deck *deck,
                       ritz_grids *grids)
{
    int64_t kept = 0;

    for (int64_t k = 0; k < grids->count; k++) {
        const int64_t at = ritz_roster_from(roster, grids->id[k]);

        if ((at == roster->count ||
             roster->place[at].dof.grid != grids->id[k]) &&
            !is_held(deck, grids->id[k]))
            continue;
        grids->id[kept] = grids->id[k];
        grids->frame[kept] = grids->frame[k];
        memmove(grids->position + 3 * kept++, grids->position + 3 * k,
                3 * sizeof *grids->position);
    }
    grids->count = kept;
}

/* One grid and no deck: wherever it is, that is the origin. */
static ritz_status place_alone(const ritz_row_names *names, ritz_grids *out)
{
    RITZ_OWN(ritz_grids) grids = {.count = 1, .num_frames = 1};

    for (int64_t k = 0; k < names->count; k++)
        if (names->dof[k].grid != names->dof[0].grid ||
            names->dof[k].component == 0)
            return RITZ_OK;
    RITZ_CHECK_NEW(grids.id, 1);
    RITZ_CHECK_NEW(grids.position, 3);
    RITZ_CHECK_NEW(grids.frame, 1);
    RITZ_CHECK_NEW(grids.axes, 9);
    grids.id[0] = names->dof[0].grid;
    for (int64_t i = 0; i < 3; i++)
        grids.axes[4 * i] = 1.0;
    RITZ_MOVE(*out, grids);
    return RITZ_OK;
}

/* Move the parts into the component, without the rows that are empty in K and
 * M. The grids of the component are set elsewhere. */
static ritz_status settle_parts(ritz_parts *parts, const ritz_deck *deck,
                                const ritz_row_names *names,
                                ritz_component *component,
                                ritz_import_report *report)
{
    RITZ_OWN_ARRAY unsigned char *mark = NULL;
    RITZ_OWN_ARRAY int64_t *stays = NULL;
    bool rigid = true;

    for (int64_t k = 0; k < parts->count; k++)
        rigid = rigid && parts->part[k].becomes != &component->K;
    RITZ_CHECK_NEW(mark, names->count);
    RITZ_CHECK_NEW(stays, names->count);
    RITZ_CHECK_NEW(component->dof, names->count);
    RITZ_CHECK_NEW(report->removed, names->count);
    RITZ_CHECK_NEW(report->fixed, names->count);
    mark_rows(parts, component, mark);
    RITZ_CHECK(sort_rows(mark, deck, names, rigid, stays, report, component));
    for (int64_t k = 0; k < parts->count; k++)
        RITZ_CHECK(scatter_part(&parts->part[k], stays, component->num_dofs,
                                parts->part[k].becomes));
    memcpy(report->map, names->map, sizeof report->map);
    return RITZ_OK;
}

static void ritz_parts_free(ritz_parts *parts)
{
    for (int64_t k = 0; k < parts->count; k++) {
        ritz_matrix_free(&parts->part[k].matrix);
        RITZ_FREE(parts->part[k].place, parts->part[k].owned);
    }
    free(parts->part);
    *parts = (ritz_parts){0};
}

/* ---- all of it ---------------------------------------------------------- */

/* Leave out imaginary parts that are all zero. */
static void drop_zeros(ritz_matrix *m)
{
    if (!m->imaginary || !m->A.colptr)
        return;
    for (int64_t k = 0; k < m->A.colptr[m->A.ncol]; k++)
        if (m->imaginary[k] != 0.0)
            return;
    free(m->imaginary);
    m->imaginary = NULL;
}

/* Split a complex stiffness into K + i K4, unless K4 has a matrix of its own.
   The array has room for one more part. */
static ritz_status split_stiffness(ritz_component *component, ritz_parts *parts)
{
    ritz_part *whole = &parts->part[0];
    ritz_part *more = &parts->part[parts->count];

    if (whole->becomes != &component->K || !whole->matrix.imaginary ||
        !whole->matrix.A.colptr)
        return RITZ_OK;
    for (int64_t k = 1; k < parts->count; k++)
        if (parts->part[k].becomes == &component->K4)
            return RITZ_OK;
    *more = (ritz_part){.spec = whole->spec,
                        .what = "structural damping",
                        .becomes = &component->K4,
                        .matrix = {.symmetric = whole->matrix.symmetric,
                                   .digits = whole->matrix.digits}};
    parts->count++;
    RITZ_CHECK(ritz_sparse_copy(&whole->matrix.A, &more->matrix.A));
    for (int64_t k = 0;
         more->matrix.A.val && k < whole->matrix.A.colptr[whole->matrix.A.ncol];
         k++)
        more->matrix.A.val[k] = whole->matrix.imaginary[k];
    if (whole->matrix.row)
        RITZ_CHECK_COPY(more->matrix.row, whole->matrix.row,
                        whole->matrix.A.nrow);
    free(whole->matrix.imaginary);
    whole->matrix.imaginary = NULL;
    return RITZ_OK;
}

static ritz_status check_matrix(const ritz_part *part)
{
    const ritz_matrix *A = &part->matrix;

    RITZ_REFUSE_IF(A->A.nrow != A->A.ncol, RITZ_ERR_FORMAT,
                   "'%s' is %" PRId64 " x %" PRId64 ", a square matrix is due",
                   part->spec, A->A.nrow, A->A.ncol);
    RITZ_REFUSE_IF(A->imaginary, RITZ_ERR_FORMAT,
                   "'%s' is complex: only a stiffness may be, K + i K4, "
                   "without another structural damping",
                   part->spec);
    return RITZ_OK;
}

/* Read the matrices of all parts, inputs and outputs; each file is read
 * once. */
static ritz_status read_parts(const ritz_import_request *request,
                              ritz_parts *parts, ritz_io_files *files)
{
    int64_t count = parts->count;
    RITZ_OWN_ARRAY ritz_wanted *wanted = NULL;

    RITZ_CHECK_NEW(wanted, count + RITZ_NUM_IO_FILES + request->num_recoveries);
    for (int64_t k = 0; k < parts->count; k++) {
        ritz_part *part = &parts->part[k];

        wanted[k] = (ritz_wanted){part->spec, part->what, &part->matrix};
    }
    RITZ_CHECK(ritz_io_files_want(request, files, wanted, &count));
    return ritz_foreign_collect(count, wanted, request->sums);
}

/* "F@LOAD": geometric stiffness of a unit load. */
static ritz_status take_load(const char *text, ritz_component *component,
                             ritz_parts *parts)
{
    ritz_load *load = &component->load[component->num_loads];
    const char *at = strrchr(text, '@');
    ritz_part *part = &parts->part[parts->count];

    RITZ_REFUSE_IF(!at || at == text, RITZ_ERR_ARGUMENT,
                   "'%s' is not of the form FILE@LOAD", text);
    RITZ_CHECK(ritz_name_copy(at + 1, load->name));
    for (int64_t k = 0; k < component->num_loads; k++)
        RITZ_REFUSE_IF(strcmp(component->load[k].name, load->name) == 0,
                       RITZ_ERR_ARGUMENT, "there are two loads '%s'",
                       load->name);
    RITZ_CHECK_NEW(part->owned, at - text + 1);
    memcpy(part->owned, text, (size_t)(at - text));
    part->spec = part->owned;
    part->what = "geometric stiffness";
    part->becomes = &load->KG;
    parts->count++;
    component->num_loads++;
    return RITZ_OK;
}

static ritz_status list_parts(const ritz_import_request *request,
                              ritz_component *component, ritz_parts *parts)
{
    const struct {
        const char *option, *spec;
        ritz_sparse *becomes;
    } table[] = {
        {"stiffness", request->stiffness, &component->K},
        {"mass", request->mass, &component->M},
        {"damping", request->damping, &component->D},
        {"structural damping", request->structural_damping, &component->K4},
    };
    int64_t most = (int64_t)(sizeof table / sizeof *table);

    RITZ_REFUSE_IF(!request->mass, RITZ_ERR_ARGUMENT,
                   "no mass matrix is given, without one nothing can move");
    RITZ_CHECK_NEW(parts->part, most + request->num_loads + 1);
    RITZ_CHECK_NEW(component->load, request->num_loads);
    for (int64_t k = 0; k < most; k++)
        if (table[k].spec)
            parts->part[parts->count++] =
                (ritz_part){.spec = table[k].spec,
                            .what = table[k].option,
                            .becomes = table[k].becomes};
    for (int64_t k = 0; k < request->num_loads; k++)
        RITZ_CHECK_IN("geometric stiffness",
                      take_load(request->load[k], component, parts));
    return RITZ_OK;
}

static ritz_status take_parts(const ritz_import_request *request,
                              ritz_component *component, ritz_parts *parts,
                              ritz_io_files *files)
{
    RITZ_REFUSE_IF(request->ratios && !request->frequencies, RITZ_ERR_ARGUMENT,
                   "ratios are given, but no frequencies");
    if (request->frequencies)
        RITZ_CHECK(ritz_modal_want(request, component, parts));
    else
        RITZ_CHECK(list_parts(request, component, parts));
    RITZ_CHECK(read_parts(request, parts, files));
    if (request->frequencies)
        RITZ_CHECK(ritz_modal_make(request, component, parts));
    for (int64_t k = 0; k < parts->count; k++)
        drop_zeros(&parts->part[k].matrix);
    if (!request->frequencies)
        RITZ_CHECK(split_stiffness(component, parts));
    for (int64_t k = 0; k < parts->count; k++)
        RITZ_CHECK_IN(parts->part[k].what, check_matrix(&parts->part[k]));
    return RITZ_OK;
}

ritz_status ritz_import_units(const char *text, char out[RITZ_NAME_SIZE])
{
    RITZ_REFUSE_IF(strlen(text) >= RITZ_NAME_SIZE, RITZ_ERR_ARGUMENT,
                   "'%.40s...' is longer than %d letters", text,
                   RITZ_NAME_SIZE - 1);
    for (const char *c = text; *c; c += ritz_letter_length(c))
        RITZ_REFUSE_IF(ritz_letter_length(c) == 0, RITZ_ERR_ARGUMENT,
                       "'%s' is not one line of UTF-8", text);
    memcpy(out, text, strlen(text) + 1);
    return RITZ_OK;
}

/* Grids of rows, of recovered dofs and of held ones; the origin for a single
 * grid without a deck. */
static ritz_status place_grids(ritz_deck *deck, const ritz_row_names *kept,
                               ritz_component *component)
{
    const ritz_recovery *recovery = &component->recovery;
    RITZ_OWN(ritz_row_names) all = {.count = kept->count + recovery->count};
    RITZ_OWN(ritz_roster) roster = {0};

    RITZ_CHECK(ritz_recovery_extend(recovery, kept->count, kept->dof, NULL,
                                    &all.dof, NULL));
    if (deck->grids.count == 0)
        return place_alone(&all, &component->grids);
    RITZ_CHECK(ritz_roster_new(all.count, all.dof, &roster));
    RITZ_MOVE(component->grids, deck->grids);
    keep_grids(&roster, deck, &component->grids);
    return RITZ_OK;
}

/* Rows, with the dofs eliminated that constraints make depend on others. */
static ritz_status settle_rows(const ritz_import_request *request,
                               ritz_parts *parts, ritz_deck *deck,
                               ritz_row_names *names, ritz_component *component,
                               ritz_import_report *report)
{
    RITZ_OWN(ritz_row_names) kept = {0};
    RITZ_OWN(ritz_tying) tying = {0};

    RITZ_CHECK(ritz_tying_new(deck, parts, names, component, report, &tying));
    RITZ_CHECK(ritz_tying_ports(request, deck, &tying, report));
    RITZ_CHECK(ritz_tying_apply(&tying, parts, &kept, report));
    RITZ_CHECK(settle_parts(parts, deck, &kept, component, report));
    RITZ_CHECK(ritz_tying_recover(&tying, component, report));
    return place_grids(deck, &kept, component);
}

/* From matrices and a deck to a component without ports. */
static ritz_status make_component(const ritz_import_request *request,
                                  ritz_side_files *side, ritz_parts *parts,
                                  ritz_deck *deck, ritz_io_files *files,
                                  ritz_component *component,
                                  ritz_import_report *report)
{
    const ritz_grids *grids = &component->grids;
    RITZ_OWN(ritz_row_names) names = {0};

    RITZ_CHECK(ritz_side_files_deck(side, deck));
    RITZ_REFUSE_IF(deck->imposed, RITZ_ERR_FORMAT, "%s", deck->imposed);
    RITZ_CHECK(ritz_names_find(request, deck, side, parts, &names));
    RITZ_CHECK(ritz_io_files_name(request, &names, files));
    if (deck->num_constraints > 0 || request->num_rigid_ports > 0 ||
        request->num_averaged_ports > 0) {
        RITZ_CHECK(
            settle_rows(request, parts, deck, &names, component, report));
    } else {
        RITZ_CHECK(settle_parts(parts, deck, &names, component, report));
        RITZ_CHECK(place_grids(deck, &names, component));
    }
    RITZ_MOVE(component->elements, deck->elements);
    report->num_hidden =
        deck->num_strange +
        ritz_elements_keep(&component->elements, grids->count, grids->id);
    /*
     * Of the stiffness, which comes first, as it is differences of stiffness
     * that rounding spoils; of the mass if there is none. An identity as mass
     * has one digit and tells nothing.
     */
    component->digits = (double)parts->part[0].matrix.digits;
    if (request->units)
        RITZ_CHECK_IN("--units",
                      ritz_import_units(request->units, component->units));
    return RITZ_OK;
}

ritz_status ritz_import(const ritz_import_request *request, ritz_component *out,
                        ritz_import_report *report)
{
    RITZ_OWN(ritz_component) component = {0};
    RITZ_OWN(ritz_import_report) done_what = {0};
    RITZ_OWN(ritz_parts) parts = {0};
    RITZ_OWN(ritz_deck) deck = {0};
    RITZ_OWN(ritz_io_files) files = {0};
    [[gnu::cleanup(ritz_side_files_end)]] ritz_side_files *side = NULL;

    RITZ_CHECK(ritz_side_files_begin(request, &side));
    RITZ_CHECK(take_parts(request, &component, &parts, &files));
    RITZ_CHECK(make_component(request, side, &parts, &deck, &files, &component,
                              &done_what));
    ritz_parts_free(&parts); /* the larger half of the memory, done with */
    RITZ_CHECK(
        ritz_import_attach(request, &deck, &done_what, &files, &component));
    RITZ_CHECK(ritz_component_settle(&component, request->symmetrise));
    RITZ_CHECK(ritz_import_preload(request, &component));
    RITZ_MOVE(*out, component);
    RITZ_MOVE(*report, done_what);
    return RITZ_OK;
}

void ritz_import_report_free(ritz_import_report *report)
{
    RITZ_FREE(report->removed, report->fixed, report->constraint,
              report->unknown, report->grid);
    *report = (ritz_import_report){0};
}
