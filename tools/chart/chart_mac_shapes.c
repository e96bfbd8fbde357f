/*
 * Shapes of modes, which of their rows are the same, and
 *
 *     MAC_ij = (u_i'M v_j)^2 / (u_i'M u_i v_j'M v_j)
 *
 * with M the mass of bodies, or 1 at dofs, or of inputs and outputs 1 over the
 * square of the largest of each.
 */
#include "chart/chart_mac.h"

#include <ritz/eigen.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- at dofs, and by inputs and outputs ----------------------------------- */

/* Flexible modes of a model, in its own coordinates. */
typedef struct modes {
    ritz_dense Phi;
    double *hertz;
} modes;

static void free_modes(modes *m)
{
    ritz_dense_free(&m->Phi);
    free(m->hertz);
}

static ritz_status keep_flexible(const ritz_pairs *pairs, modes *out)
{
    int64_t first = pairs->num_rigid;
    int64_t count = pairs->Phi.ncol - first;

    count = count < MAC_MOST_MODES ? count : MAC_MOST_MODES;
    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "there is no flexible mode");
    RITZ_CHECK(ritz_dense_columns(&pairs->Phi, first, count, &out->Phi));
    out->hertz = calloc((size_t)count, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++)
        out->hertz[k] = ritz_eigen_hertz(pairs->lambda[first + k]);
    return RITZ_OK;
}

/* Coordinates of a configuration are its modes, rigid ones first. */
static ritz_status modes_at(const ritz_configuration *at, modes *out)
{
    int64_t e = at->K.ncol, first = at->num_rigid;
    int64_t count = e - first < MAC_MOST_MODES ? e - first : MAC_MOST_MODES;

    RITZ_REFUSE_IF(count < 1, RITZ_ERR_ARGUMENT, "there is no flexible mode");
    RITZ_CHECK(ritz_dense_new(e, count, &out->Phi));
    out->hertz = calloc((size_t)count, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++) {
        ritz_dense_col(&out->Phi, k)[first + k] = 1.0;
        out->hertz[k] = ritz_eigen_hertz(at->lambda[first + k]);
    }
    return RITZ_OK;
}

static ritz_status modes_of(const mac_side *side, modes *out)
{
    ritz_status status = RITZ_OK;
    const ritz_span span = {.modes = MAC_MOST_MODES};
    const model *m = &side->file->model;
    ritz_pairs pairs = {0};

    if (side->at)
        return modes_at(side->at, out);
    if (m->kind == MODEL_REDUCED)
        RITZ_TRY(ritz_eigen_dense(&m->reduced.K, &m->reduced.M, &pairs));
    else
        RITZ_TRY(
            ritz_eigen_sparse(&m->component.K, &m->component.M, &span, &pairs));
    RITZ_TRY(keep_flexible(&pairs, out));
done:
    ritz_pairs_free(&pairs);
    return status;
}

static void name_side(const mac_side *side, mac_shapes *out)
{
    snprintf(out->name, sizeof out->name, "%.80s%s%.80s",
             chart_base(side->file->path), side->at ? ", " : "",
             side->at ? side->at->at : "");
}

static ritz_status columns_of(const ritz_basis *b, mac_shapes *out)
{
    int64_t count = b->T.ncol < MAC_MOST_MODES ? b->T.ncol : MAC_MOST_MODES;

    RITZ_CHECK(ritz_dense_columns(&b->T, 0, count, &out->U));
    out->hertz = calloc((size_t)count + 1, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < count; k++)
        out->hertz[k] = b->columns.hertz[k];
    out->count = count;
    return RITZ_OK;
}

ritz_status mac_shapes_of_dofs(const mac_side *side, mac_shapes *out)
{
    ritz_status status = RITZ_OK;
    const model *m = &side->file->model;
    modes found = {0};

    name_side(side, out);
    if (m->kind == MODEL_BASIS)
        return ritz_context(columns_of(&m->basis, out), side->file->path);
    RITZ_FAIL_IF(m->kind == MODEL_REDUCED && !m->reduced.dof, RITZ_ERR_ARGUMENT,
                 "it was made without its basis, it has no shapes");
    RITZ_TRY(modes_of(side, &found));
    out->count = found.Phi.ncol;
    out->hertz = found.hertz;
    found.hertz = NULL;
    if (m->kind == MODEL_REDUCED) {
        RITZ_TRY(ritz_dense_mul(&m->reduced.T, &found.Phi, &out->U));
        out->dof = m->reduced.dof;
    } else {
        out->U = found.Phi;
        found.Phi = (ritz_dense){0};
        out->dof = m->component.dof;
    }
done:
    free_modes(&found);
    return ritz_context(status, side->file->path);
}

/* Rows: inputs, then displacements, velocities and accelerations of outputs. */
static ritz_status stack_channels(const ritz_io *io, mac_shapes *out)
{
    static const char *const kind[] = {"output", "velocity", "acceleration"};
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t n = io->num_inputs + 3 * io->num_outputs, row = 0;

    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    out->seen = calloc((size_t)n + 1, sizeof *out->seen);
    RITZ_REFUSE_IF(!out->seen, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t j = 0; j < io->num_inputs; j++, row++) {
        snprintf(out->seen[row], MAC_LABEL, "input %s", io->input[j]);
        for (int64_t k = 0; k < out->count; k++)
            ritz_dense_col(&out->U, k)[row] = ritz_dense_col(&io->B, j)[k];
    }
    for (int t = 0; t < 3; t++)
        for (int64_t i = 0; i < io->num_outputs; i++, row++) {
            snprintf(out->seen[row], MAC_LABEL, "%s %s", kind[t],
                     io->output[i]);
            for (int64_t k = 0; k < out->count; k++)
                ritz_dense_col(&out->U, k)[row] = ritz_dense_col(C[t], k)[i];
        }
    return RITZ_OK;
}

ritz_status mac_shapes_of_channels(const mac_side *side, mac_shapes *out)
{
    ritz_status status = RITZ_OK;
    const model *m = &side->file->model;
    const ritz_io *io = side->at                   ? &side->at->io
                        : m->kind == MODEL_REDUCED ? &m->reduced.io
                                                   : &m->component.io;
    ritz_io seen = {0};
    modes found = {0};

    name_side(side, out);
    RITZ_FAIL_IF(m->kind == MODEL_BASIS || io->num_inputs + io->num_outputs < 1,
                 RITZ_ERR_ARGUMENT,
                 "it has no inputs and outputs, by which its modes could be "
                 "compared with those of a system");
    RITZ_TRY(modes_of(side, &found));
    RITZ_TRY(ritz_io_project(io, &found.Phi, &seen));
    out->count = found.Phi.ncol;
    out->hertz = found.hertz;
    found.hertz = NULL;
    RITZ_TRY(stack_channels(&seen, out));
done:
    ritz_io_free(&seen);
    free_modes(&found);
    return ritz_context(status, side->file->path);
}

void mac_shapes_free(mac_shapes *s)
{
    ritz_dense_free(&s->U);
    ritz_dense_free(&s->MU);
    free(s->hertz);
    free(s->seen);
    *s = (mac_shapes){0};
}

/*
 * --- by masses ----------------------------------------------------------------
 *
 * Shapes of a configuration in the coordinates of all its bodies, each fixed in
 * its own axes, so that a turned body needs no turning back:
 *
 *     u = (P_1 x, P_2 x, ...),    u'M v = sum_c (P_c x)' M_c (P_c' x')
 *
 * as ritz_track has it. A system does not hold M_c: the reduced components do
 * that it was assembled from, which sum_c P_c' M_c P_c = M of it shows.
 */

/* Of the largest of M: what assembly and files lose. */
static const double rounding = 1e-6;

enum { MOST_BODIES = 64 };

static ritz_status refuse_bodies(const mac_side *side, const char *why)
{
    const ritz_system *s = &side->file->model.system;
    char list[400] = "";
    size_t used = 0;

    for (int64_t c = 0; c < s->num_components && used < sizeof list; c++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s'%.63s'",
                                 c > 0 ? ", " : "", s->component[c]);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the bodies of '%s' (%s) are not these: %s",
                     side->file->path, list, why);
}

/* The first file for each body that has as many coordinates. */
static ritz_status assign_bodies(const mac_side *side, int64_t count,
                                 const chart_file *const *body,
                                 const ritz_reduced *of[MOST_BODIES])
{
    const ritz_system *s = &side->file->model.system;
    bool taken[MOST_BODIES] = {false};
    char why[120];

    if (count != s->num_components || count > MOST_BODIES) {
        snprintf(why, sizeof why, "%lld bodies, %lld named",
                 (long long)s->num_components, (long long)count);
        return refuse_bodies(side, why);
    }
    for (int64_t c = 0; c < count; c++) {
        int64_t k = 0;

        while (k < count &&
               (taken[k] || body[k]->model.reduced.K.ncol != s->order[c]))
            k++;
        if (k == count) {
            snprintf(why, sizeof why, "none left has %lld coordinates",
                     (long long)s->order[c]);
            return refuse_bodies(side, why);
        }
        taken[k] = true;
        of[c] = &body[k]->model.reduced;
    }
    return RITZ_OK;
}

/* Flexible columns of P_c, and M_c times them, into their rows. */
static ritz_status put_block(const ritz_dense *P, const ritz_dense *M,
                             int64_t rigid, int64_t first, mac_shapes *out)
{
    ritz_status status = RITZ_OK;
    const ritz_dense part = ritz_dense_part(P, rigid, out->count);
    ritz_dense MP = {0};

    RITZ_TRY(ritz_dense_mul(M, &part, &MP));
    for (int64_t k = 0; k < out->count; k++)
        for (int64_t i = 0; i < P->nrow; i++) {
            ritz_dense_col(&out->U, k)[first + i] = ritz_dense_col(&part, k)[i];
            ritz_dense_col(&out->MU, k)[first + i] = ritz_dense_col(&MP, k)[i];
        }
done:
    ritz_dense_free(&MP);
    return status;
}

/* Whether U'MU is what M of the configuration says. */
static ritz_status check_mass(const mac_side *side, const mac_shapes *s)
{
    ritz_status status = RITZ_OK;
    const ritz_dense *M = &side->at->M;
    int64_t rigid = side->at->num_rigid;
    ritz_dense product = {0};
    double apart = 0.0, most = 0.0;

    RITZ_TRY(ritz_dense_mul_tn(&s->U, &s->MU, &product));
    for (int64_t j = 0; j < s->count; j++)
        for (int64_t i = 0; i < s->count; i++) {
            double due = ritz_dense_col(M, rigid + j)[rigid + i];

            apart = fmax(apart, fabs(ritz_dense_col(&product, j)[i] - due));
            most = fmax(most, fabs(due));
        }
    if (!(apart <= rounding * most))
        status = refuse_bodies(side, "their masses are not its mass");
done:
    ritz_dense_free(&product);
    return status;
}

ritz_status mac_shapes_of_bodies(const mac_side *side, int64_t count,
                                 const chart_file *const *body, mac_shapes *out)
{
    const ritz_system *s = &side->file->model.system;
    const ritz_configuration *at = side->at;
    const ritz_reduced *of[MOST_BODIES] = {NULL};
    int64_t n = 0, first = 0;

    snprintf(out->name, sizeof out->name, "%.80s, %.80s",
             chart_base(side->file->path), at->at);
    RITZ_CHECK(assign_bodies(side, count, body, of));
    for (int64_t c = 0; c < s->num_components; c++)
        n += s->order[c];
    out->count = at->K.ncol - at->num_rigid;
    out->count = out->count < MAC_MOST_MODES ? out->count : MAC_MOST_MODES;
    RITZ_REFUSE_IF(out->count < 1, RITZ_ERR_ARGUMENT,
                   "%s: there is no flexible mode", side->file->path);
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->MU));
    out->hertz = calloc((size_t)out->count, sizeof *out->hertz);
    RITZ_REFUSE_IF(!out->hertz, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t k = 0; k < out->count; k++)
        out->hertz[k] = ritz_eigen_hertz(at->lambda[at->num_rigid + k]);
    for (int64_t c = 0; c < s->num_components; c++) {
        RITZ_CHECK(put_block(&at->P[c], &of[c]->M, at->num_rigid, first, out));
        first += s->order[c];
    }
    return check_mass(side, out);
}

/* --- rows in common, and MAC ---------------------------------------------- */

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
static ritz_status scale_rows(mac_shapes *a, mac_shapes *b, const int64_t *row)
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
        RITZ_TRY(scale_rows(a, b, row));
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
