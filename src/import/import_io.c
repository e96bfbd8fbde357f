/*
 * Inputs "NAME=GRID:COMP[*SCALE]" and outputs
 * "NAME=GRID:COMP[/vel|/acc][@LIMIT]", along basic axes.
 *
 * With u_b = t' u the displacement of a grid along a basic axis, a force along
 * it is the row vector t in B, as it does the work t' u; an output is t in C.
 * Of dofs that constraints eliminated, u = G u_n, these are G' t and t' G.
 */
#include "import/import.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* A direction of a grid along a basic axis, in terms of dofs. */
typedef struct aim {
    int64_t count;
    int64_t row[3];
    double share[3];
} aim;

static ritz_status take_aim(const ritz_extended *extended, ritz_dof dof,
                            aim *out)
{
    ritz_status status = RITZ_OK;
    const ritz_roster *roster = &extended->roster;
    ritz_port port = {.name = ""};
    int64_t rows[3];
    int64_t first = dof.component > 3 ? 4 : 1;
    ritz_dense turn = {0};
    ritz_dof *label = NULL;

    port.dofs.at = rows;
    if (dof.component == 0) {
        rows[0] = ritz_roster_row(roster, dof);
        port.dofs.count = rows[0] >= 0;
    }
    for (int64_t c = first; dof.component > 0 && c < first + 3; c++) {
        int64_t row = ritz_roster_row(roster, (ritz_dof){dof.grid, c});

        if (row >= 0)
            rows[port.dofs.count++] = row;
    }
    if (port.dofs.count == 0) {
        status = ritz_roster_miss(roster, dof);
        goto done;
    }
    RITZ_TRY(ritz_port_turn(&extended->view, &port, &turn, &label));
    *out = (aim){0};
    for (int64_t k = 0; k < port.dofs.count; k++)
        for (int64_t j = 0;
             label[k].component == dof.component && j < port.dofs.count; j++) {
            out->row[out->count] = rows[j];
            out->share[out->count++] = ritz_dense_col(&turn, j)[k];
        }
    if (out->count == 0)
        status = ritz_roster_miss(roster, dof);
done:
    ritz_dense_free(&turn);
    free(label);
    return status;
}

/*
 * Add scale t to a column of B (stride 1) or a row of C (stride the number of
 * outputs); a dof that follows, u = G u_n, puts G' there.
 */
static void add_aim(const ritz_extended *extended, const aim *to, double scale,
                    int64_t stride, double *into)
{
    const ritz_sparse *from = &extended->from;

    for (int64_t i = 0; i < to->count; i++) {
        int64_t k = to->row[i] - extended->num_rows;

        if (k < 0)
            into[stride * to->row[i]] += scale * to->share[i];
        for (int64_t p = k < 0 ? 0 : from->colptr[k];
             k >= 0 && p < from->colptr[k + 1]; p++)
            into[stride * from->rowind[p]] +=
                scale * to->share[i] * from->val[p];
    }
}

/* "GRID:COMP" of `length` letters. */
static ritz_status take_dof(const char *text, size_t length, ritz_dof *out)
{
    char copy[48] = "";
    char *colon = NULL;
    bool good = length < sizeof copy;

    if (good) {
        memcpy(copy, text, length);
        colon = strchr(copy, ':');
        good = colon != NULL;
    }
    if (good) {
        *colon = '\0';
        good = ritz_text_whole(copy, &out->grid) && out->grid > 0 &&
               ritz_text_whole(colon + 1, &out->component) &&
               out->component >= 0 && out->component <= 6;
    }
    RITZ_REFUSE_IF(!good, RITZ_ERR_ARGUMENT,
                   "'%.*s' is no grid and direction such as 101:3 (0 for a "
                   "scalar point)",
                   (int)length, text);
    return RITZ_OK;
}

/* A number behind `mark`, if that is there; the text is cut before it. */
static ritz_status take_number(const char *text, char mark, size_t *length,
                               double *out)
{
    const char *at = strchr(text, mark);

    if (!at)
        return RITZ_OK;
    RITZ_REFUSE_IF(!ritz_text_real(at + 1, out) || *out == 0.0,
                   RITZ_ERR_ARGUMENT, "'%s' is no number other than zero",
                   at + 1);
    *length = (size_t)(at - text);
    return RITZ_OK;
}

static ritz_status make_input(const char *text, const ritz_extended *extended,
                              int64_t k, ritz_io *io)
{
    const char *rest = NULL;
    size_t length = 0;
    double scale = 1.0;
    ritz_dof dof = {0};
    aim to = {0};

    RITZ_CHECK(
        ritz_import_split(text, "NAME=GRID:COMP[*SCALE]", io->input[k], &rest));
    length = strlen(rest);
    RITZ_CHECK(take_number(rest, '*', &length, &scale));
    RITZ_CHECK(take_dof(rest, length, &dof));
    RITZ_CHECK(take_aim(extended, dof, &to));
    add_aim(extended, &to, scale, 1, ritz_dense_col(&io->B, k));
    return RITZ_OK;
}

/* What is put out: displacement unless a word behind '/' says otherwise. */
static ritz_status take_quantity(const char *text, size_t *length, ritz_io *io,
                                 ritz_dense **out)
{
    const struct {
        const char *word;
        ritz_dense *matrix;
    } table[] = {{"vel", &io->Cv}, {"acc", &io->Ca}};
    const char *slash = memchr(text, '/', *length);
    size_t left = 0;

    *out = &io->C;
    if (!slash)
        return RITZ_OK;
    left = *length - (size_t)(slash + 1 - text);
    for (size_t k = 0; k < sizeof table / sizeof *table; k++)
        if (left == strlen(table[k].word) &&
            memcmp(slash + 1, table[k].word, left) == 0) {
            *out = table[k].matrix;
            *length = (size_t)(slash - text);
            return RITZ_OK;
        }
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "'%.*s' is neither 'vel' nor 'acc', and displacement is "
                     "put out without a word",
                     (int)left, slash + 1);
}

static ritz_status make_output(const char *text, const ritz_extended *extended,
                               int64_t k, ritz_io *io)
{
    const char *rest = NULL;
    size_t length = 0;
    ritz_dof dof = {0};
    ritz_dense *C = NULL;
    aim to = {0};

    RITZ_CHECK(ritz_import_split(text, "NAME=GRID:COMP[/vel|/acc][@LIMIT]",
                                 io->output[k], &rest));
    length = strlen(rest);
    RITZ_CHECK(take_number(rest, '@', &length, &io->limit[k]));
    RITZ_REFUSE_IF(io->limit[k] < 0.0, RITZ_ERR_ARGUMENT,
                   "a limit is positive, '%g' is not", io->limit[k]);
    RITZ_CHECK(take_quantity(rest, &length, io, &C));
    RITZ_CHECK(take_dof(rest, length, &dof));
    RITZ_CHECK(take_aim(extended, dof, &to));
    add_aim(extended, &to, 1.0, C->nrow, C->val + k);
    return RITZ_OK;
}

ritz_status ritz_import_aim(const char *text, size_t length,
                            const ritz_extended *extended, double scale,
                            double *into)
{
    ritz_dof dof = {0};
    aim to = {0};

    RITZ_CHECK(take_dof(text, length, &dof));
    RITZ_CHECK(take_aim(extended, dof, &to));
    add_aim(extended, &to, scale, 1, into);
    return RITZ_OK;
}

static ritz_status check_new(const char (*name)[RITZ_NAME_SIZE], int64_t k,
                             const char *what)
{
    for (int64_t j = 0; j < k; j++)
        if (strcmp(name[j], name[k]) == 0)
            return ritz_fail(RITZ_ERR_ARGUMENT, "there are two %s '%s'", what,
                             name[k]);
    return RITZ_OK;
}

ritz_status ritz_import_io(const ritz_import_request *request,
                           const ritz_extended *extended,
                           ritz_component *component)
{
    ritz_io *io = &component->io;

    RITZ_CHECK(ritz_io_new(component->num_dofs, request->num_inputs,
                           request->num_outputs, io));
    for (int64_t k = 0; k < request->num_inputs; k++) {
        RITZ_CHECK_IN(request->input[k],
                      make_input(request->input[k], extended, k, io));
        RITZ_CHECK(
            check_new((const char(*)[RITZ_NAME_SIZE])io->input, k, "inputs"));
    }
    for (int64_t k = 0; k < request->num_outputs; k++) {
        RITZ_CHECK_IN(request->output[k],
                      make_output(request->output[k], extended, k, io));
        RITZ_CHECK(
            check_new((const char(*)[RITZ_NAME_SIZE])io->output, k, "outputs"));
    }
    return RITZ_OK;
}
