/*
 * How like the modes of two models are,
 *
 *     MAC_ij = (u_i'M v_j)^2 / (u_i'M u_i v_j'M v_j)
 *
 * with M = 1 at the dofs that both have; of two configurations of the same
 * bodies with the masses of these, if they are named; of anything else with a
 * system by inputs and outputs, M being 1 over the square of the largest of
 * each, so that units do not matter.
 */
#include "chart/chart.h"
#include "chart/html.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* More modes would not be told apart. */
enum {
    MOST_MODES = 60,
    MOST_FILES = 70,
    MOST_BODIES = 64,
    LABEL = RITZ_NAME_SIZE + 16,
};

/* Masses agree if they differ by less than this part of the largest entry. */
static const double rounding = 1e-6;

/* One of the two models: a file and, if it is a system, a configuration. */
typedef struct mac_side {
    const chart_file *file;
    const ritz_configuration *at; /* NULL: it is no system */
} mac_side;

/* Shapes of flexible modes, or columns of a basis, and what their rows are. */
typedef struct mac_shapes {
    ritz_dense U;  /* n x count */
    ritz_dense MU; /* the same times the mass of bodies; {0}: U itself */
    double hertz[MOST_MODES]; /* NaN: none */
    int64_t count;
    const ritz_dof *dof;    /* n, borrowed; NULL: rows are not dofs */
    int64_t num_common;     /* inputs and outputs in common, once matched */
    char (*channel)[LABEL]; /* n, inputs and outputs; NULL: rows are none */
    char name[2 * PICTURE_WORD]; /* "system.h5, clock=60" */
} mac_shapes;

static void free_shapes(mac_shapes *s)
{
    ritz_dense_free(&s->U);
    ritz_dense_free(&s->MU);
    free(s->channel);
}

/* --- modes, at dofs and by inputs and outputs ----------------------------- */

static void name_side(const mac_side *side, mac_shapes *out)
{
    snprintf(out->name, sizeof out->name, "%.80s%s%.80s",
             chart_base(side->file->path), side->at ? ", " : "",
             side->at ? side->at->at : "");
}

/* Number and frequencies of the flexible modes behind the rigid ones. */
static ritz_status count_modes(int64_t all, int64_t rigid, const double *lambda,
                               mac_shapes *out)
{
    out->count = all - rigid < MOST_MODES ? all - rigid : MOST_MODES;
    RITZ_REFUSE_IF(out->count < 1, RITZ_ERR_ARGUMENT,
                   "there is no flexible mode");
    for (int64_t k = 0; k < out->count; k++)
        out->hertz[k] = ritz_eigen_hertz(lambda[rigid + k]);
    return RITZ_OK;
}

/* Modes in the coordinates of the model; a configuration is in modal ones. */
static ritz_status find_modes(const mac_side *side, mac_shapes *out)
{
    const ritz_span span = {.modes = MOST_MODES};
    const ritz_configuration *at = side->at;
    const model *m = &side->file->model;
    RITZ_OWN(ritz_pairs) pairs = {0};

    if (at) {
        RITZ_CHECK(count_modes(at->K.ncol, at->num_rigid, at->lambda, out));
        RITZ_CHECK(ritz_dense_new(at->K.ncol, out->count, &out->U));
        for (int64_t k = 0; k < out->count; k++)
            ritz_dense_col(&out->U, k)[at->num_rigid + k] = 1.0;
        return RITZ_OK;
    }
    if (m->kind == MODEL_REDUCED)
        RITZ_CHECK(ritz_eigen_dense(&m->reduced.K, &m->reduced.M, &pairs));
    else
        RITZ_CHECK(
            ritz_eigen_sparse(&m->component.K, &m->component.M, &span, &pairs));
    RITZ_CHECK(count_modes(pairs.Phi.ncol, pairs.num_rigid, pairs.lambda, out));
    return ritz_dense_columns(&pairs.Phi, pairs.num_rigid, out->count, &out->U);
}

/* Shapes at the dofs of a component, a reduced component or a basis. */
static ritz_status shapes_at_dofs(const mac_side *side, mac_shapes *out)
{
    const model *m = &side->file->model;
    const ritz_basis *b = &m->basis;

    name_side(side, out);
    if (m->kind == MODEL_BASIS) {
        out->count = b->T.ncol < MOST_MODES ? b->T.ncol : MOST_MODES;
        for (int64_t k = 0; k < out->count; k++)
            out->hertz[k] = b->columns.hertz[k];
        return ritz_dense_columns(&b->T, 0, out->count, &out->U);
    }
    RITZ_REFUSE_IF(m->kind == MODEL_REDUCED && !m->reduced.dof,
                   RITZ_ERR_ARGUMENT,
                   "it was made without its basis, it has no shapes");
    RITZ_CHECK(find_modes(side, out));
    out->dof = m->component.dof;
    if (m->kind == MODEL_REDUCED) {
        ritz_dense Phi = out->U;
        ritz_status status = RITZ_OK;

        out->U = (ritz_dense){0};
        out->dof = m->reduced.dof;
        status = ritz_dense_mul(&m->reduced.T, &Phi, &out->U);
        ritz_dense_free(&Phi);
        return status;
    }
    return RITZ_OK;
}

/* Rows: inputs, then displacements, velocities and accelerations of outputs. */
static ritz_status stack_channels(const ritz_io *io, mac_shapes *out)
{
    static const char *const kind[] = {"output", "velocity", "acceleration"};
    const ritz_dense *const C[] = {&io->C, &io->Cv, &io->Ca};
    int64_t n = io->num_inputs + 3 * io->num_outputs, row = 0;

    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    out->channel = calloc((size_t)n + 1, sizeof *out->channel);
    RITZ_REFUSE_IF(!out->channel, RITZ_ERR_MEMORY, "no memory for modes");
    for (int64_t j = 0; j < io->num_inputs; j++, row++) {
        snprintf(out->channel[row], LABEL, "input %s", io->input[j]);
        for (int64_t k = 0; k < out->count; k++)
            ritz_dense_col(&out->U, k)[row] = ritz_dense_col(&io->B, j)[k];
    }
    for (int t = 0; t < 3; t++)
        for (int64_t i = 0; i < io->num_outputs; i++, row++) {
            snprintf(out->channel[row], LABEL, "%s %s", kind[t], io->output[i]);
            for (int64_t k = 0; k < out->count; k++)
                ritz_dense_col(&out->U, k)[row] = ritz_dense_col(C[t], k)[i];
        }
    return RITZ_OK;
}

/* What each input drives and each output senses of the modes of anything but a
   basis. */
static ritz_status shapes_by_channels(const mac_side *side, mac_shapes *out)
{
    const model *m = &side->file->model;
    const ritz_io *io = side->at                   ? &side->at->io
                        : m->kind == MODEL_REDUCED ? &m->reduced.io
                                                   : &m->component.io;
    RITZ_OWN(ritz_io) own = {0};

    name_side(side, out);
    RITZ_REFUSE_IF(m->kind == MODEL_BASIS ||
                       io->num_inputs + io->num_outputs < 1,
                   RITZ_ERR_ARGUMENT,
                   "it has no inputs and outputs, by which its modes could be "
                   "compared with those of a system");
    RITZ_CHECK(find_modes(side, out));
    RITZ_CHECK(ritz_io_project(io, &out->U, &own));
    ritz_dense_free(&out->U);
    return stack_channels(&own, out);
}

/* --- by masses ------------------------------------------------------------ */

/*
 * Shapes of a configuration in the coordinates of all its bodies, each fixed in
 * its own axes, so that a turned body needs no turning back:
 *
 *     u = (P_1 x, P_2 x, ...),    u'M v = sum_c (P_c x)' M_c (P_c' x')
 *
 * as ritz_track has it. A system does not hold M_c: the reduced components do
 * that it was assembled from, which sum_c P_c' M_c P_c = M of it shows.
 */

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
    const ritz_dense part = ritz_dense_part(P, rigid, out->count);
    RITZ_OWN(ritz_dense) MP = {0};

    RITZ_CHECK(ritz_dense_mul(M, &part, &MP));
    for (int64_t k = 0; k < out->count; k++)
        for (int64_t i = 0; i < P->nrow; i++) {
            ritz_dense_col(&out->U, k)[first + i] = ritz_dense_col(&part, k)[i];
            ritz_dense_col(&out->MU, k)[first + i] = ritz_dense_col(&MP, k)[i];
        }
    return RITZ_OK;
}

/* Whether U'MU, with the masses of the files, is M of the configuration. */
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

/* Coordinates of all bodies of a configuration, and their masses times them;
   the bodies' files come in any order that fits. */
static ritz_status shapes_of_bodies(const mac_side *side, int64_t count,
                                    const chart_file *const *body,
                                    mac_shapes *out)
{
    const ritz_system *s = &side->file->model.system;
    const ritz_configuration *at = side->at;
    const ritz_reduced *of[MOST_BODIES] = {NULL};
    int64_t n = 0, first = 0;

    name_side(side, out);
    RITZ_CHECK(assign_bodies(side, count, body, of));
    for (int64_t c = 0; c < s->num_components; c++)
        n += s->order[c];
    RITZ_CHECK_IN(side->file->path,
                  count_modes(at->K.ncol, at->num_rigid, at->lambda, out));
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->MU));
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
    if (a->channel)
        return strcmp(a->channel[k], b->channel[i]) == 0;
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

/* Divide each input and output by its largest value in both models, so that
   units do not matter. */
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
    a->num_common = b->num_common = count;
    return RITZ_OK;
}

static ritz_status match_rows(mac_shapes *a, mac_shapes *b, picture *p,
                              int64_t **out)
{
    int64_t n = a->U.nrow, m = b->U.nrow, common = 0;
    int64_t *row = NULL;
    bool named = (a->dof && b->dof) || (a->channel && b->channel);

    PICTURE_NEW(p, row, n);
    RITZ_REFUSE_IF(!named && n != m, RITZ_ERR_ARGUMENT,
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
    if (a->channel && b->channel)
        RITZ_CHECK(scale_rows(a, b, row));
    RITZ_REFUSE_IF(common == 0, RITZ_ERR_ARGUMENT,
                   "'%s' and '%s' have no dof in common", a->name, b->name);
    *out = row;
    return RITZ_OK;
}

static double mac_of(const mac_shapes *a, const mac_shapes *b,
                     const int64_t *row, int64_t i, int64_t j)
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

/* --- which two ------------------------------------------------------------ */

/* The two models, and the bodies whose masses are used. */
typedef struct choice {
    mac_side side[2];
    int64_t num_bodies;
    const chart_file *body[MOST_FILES];
} choice;

static ritz_status find_at(const chart_file *file, const char *at,
                           mac_side *out)
{
    ritz_status status = RITZ_OK;
    const ritz_configuration *found = NULL;

    *out = (mac_side){.file = file};
    if (file->holds == CHART_SYSTEM)
        status = ritz_system_find(&file->model.system, at, &found);
    out->at = found;
    return ritz_context(status, file->path);
}

/* Two systems, --at being given once for both, for each, or not at all. */
static ritz_status choose_two(const chart_file *const *system,
                              const cli_list *at, choice *out)
{
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(find_at(system[k],
                           at->count == 0   ? NULL
                           : at->count == 1 ? at->text[0]
                                            : at->text[k],
                           &out->side[k]));
    return RITZ_OK;
}

/* One system: two configurations of it, or one and another model. */
static ritz_status choose_one(const chart_file *system, const cli_list *at,
                              choice *out)
{
    const ritz_system *s = &system->model.system;

    if (at->count == 2) {
        for (int k = 0; k < 2; k++)
            RITZ_CHECK(find_at(system, at->text[k], &out->side[k]));
    } else if (out->num_bodies == 1) {
        RITZ_CHECK(
            find_at(system, at->count ? at->text[0] : NULL, &out->side[0]));
        RITZ_CHECK(find_at(out->body[0], NULL, &out->side[1]));
        out->num_bodies = 0;
    } else {
        RITZ_REFUSE_IF(
            at->count == 1 || s->num_configurations != 2, RITZ_ERR_ARGUMENT,
            "MAC is of two: choose two configurations of '%s' by --at "
            "and --at again",
            system->path);
        out->side[0] = (mac_side){system, &s->configuration[0]};
        out->side[1] = (mac_side){system, &s->configuration[1]};
    }
    return RITZ_OK;
}

static ritz_status choose(const chart_sources *sources, const cli_list *at,
                          choice *out)
{
    const chart_file *system[2] = {NULL, NULL};
    int64_t num_systems = 0;

    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];

        if (file->holds != CHART_MODES && file->holds != CHART_SYSTEM)
            continue;
        RITZ_REFUSE_IF(
            file->holds == CHART_SYSTEM ? num_systems == 2
                                        : out->num_bodies == MOST_FILES,
            RITZ_ERR_ARGUMENT, "MAC is of two models, these are more");
        if (file->holds == CHART_SYSTEM)
            system[num_systems++] = file;
        else
            out->body[out->num_bodies++] = file;
    }
    RITZ_REFUSE_IF(at->count > 2, RITZ_ERR_ARGUMENT,
                   "MAC is of two: --at is there more than twice");
    if (num_systems == 2)
        return choose_two(system, at, out);
    if (num_systems == 1)
        return choose_one(system[0], at, out);
    RITZ_REFUSE_IF(at->count > 0, RITZ_ERR_ARGUMENT,
                   "no file is a system, --at has nothing to choose from");
    RITZ_REFUSE_IF(out->num_bodies != 2, RITZ_ERR_ARGUMENT,
                   "MAC is of two models, %s",
                   out->num_bodies < 2 ? "this is one" : "these are more");
    for (int k = 0; k < 2; k++)
        out->side[k] = (mac_side){.file = out->body[k]};
    out->num_bodies = 0;
    return RITZ_OK;
}

static ritz_status shapes_of(const choice *chosen, const char **how,
                             mac_shapes set[2])
{
    const bool systems = chosen->side[0].at || chosen->side[1].at;

    *how = chosen->num_bodies > 0 ? "by masses"
           : systems              ? "by inputs and outputs"
                                  : "by dofs";
    for (int64_t k = 0; k < chosen->num_bodies; k++)
        RITZ_REFUSE_IF(chosen->body[k]->model.kind != MODEL_REDUCED,
                       RITZ_ERR_ARGUMENT,
                       "'%s' is no reduced component, of which systems are "
                       "assembled",
                       chosen->body[k]->path);
    for (int k = 0; k < 2; k++)
        if (chosen->num_bodies > 0)
            RITZ_CHECK(shapes_of_bodies(&chosen->side[k], chosen->num_bodies,
                                        chosen->body, &set[k]));
        else if (systems)
            RITZ_CHECK_IN(chosen->side[k].file->path,
                          shapes_by_channels(&chosen->side[k], &set[k]));
        else
            RITZ_CHECK_IN(chosen->side[k].file->path,
                          shapes_at_dofs(&chosen->side[k], &set[k]));
    return RITZ_OK;
}

/* --- the picture ---------------------------------------------------------- */

/* Up to this many modes there is a number in each cell. */
enum { NUMBERED = 24 };

static void say_mode(const mac_shapes *s, int64_t k, char out[32])
{
    if (isnan(s->hertz[k]))
        snprintf(out, 32, "%lld", (long long)k + 1);
    else
        snprintf(out, 32, "%lld: %.3g", (long long)k + 1, s->hertz[k]);
}

/* Names of modes, as an array of the template. */
static ritz_status give_modes(picture *p, const char *name, const mac_shapes *s)
{
    enum { SIZE = 32 };
    char(*word)[SIZE] = NULL;

    PICTURE_NEW(p, word, s->count);
    for (int64_t k = 0; k < s->count; k++)
        say_mode(s, k, word[k]);
    picture_give_texts(p, name, s->count, word[0], SIZE);
    return RITZ_OK;
}

static void put_data(const mac_shapes *a, const mac_shapes *b,
                     const int64_t *row, picture *p)
{
    FILE *data = p->data.file, *table = p->table.file;
    char x[32], y[32];

    fprintf(data, "column\trow\tmac\ttip\n");
    html_line(table, a->name);
    for (int64_t j = 0; j < b->count; j++) {
        say_mode(b, j, x);
        fprintf(table, "\t%s", x);
    }
    for (int64_t i = 0; i < a->count; i++) {
        say_mode(a, i, y);
        fprintf(table, "\n%s", y);
        for (int64_t j = 0; j < b->count; j++) {
            double mac = mac_of(a, b, row, i, j);

            say_mode(b, j, x);
            fprintf(data, "%lld\t%lld\t%.6g\t", (long long)j, (long long)i,
                    mac);
            picture_tip(p, "%.60s %s Hz\n%.60s %s Hz\nMAC %.4f", a->name, y,
                        b->name, x, mac);
            fprintf(data, "\n");
            fprintf(table, "\t%.4f", mac);
        }
        fprintf(data, "\n");
    }
    fprintf(table, "\n");
}

static ritz_status draw_mac(const mac_shapes *a, const mac_shapes *b,
                            const int64_t *row, const char *how, picture *p)
{
    enum { LEFT = 116, RIGHT = 64, HEAD = 40, FOOT = 100, LETTER = 8 };
    const int64_t most = a->count > b->count ? a->count : b->count;
    const double cell = most <= NUMBERED ? 34.0 : 640.0 / (double)most;
    char title[4 * PICTURE_WORD];
    size_t letters =
        (size_t)snprintf(title, sizeof title, "MAC of %.160s and %.160s, %s",
                         a->name, b->name, how);

    p->wide = fmax(LEFT + RIGHT + cell * (double)b->count,
                   (double)(LEFT + LETTER * letters));
    p->body = HEAD + FOOT + cell * (double)a->count;
    /* as many modes can be told apart as there are inputs and outputs */
    if (a->num_common > 0 &&
        (a->num_common < a->count || a->num_common < b->count))
        snprintf(p->note, sizeof p->note,
                 "%lld inputs and outputs tell no more modes apart than that: "
                 "likeness can be chance",
                 (long long)a->num_common);
    fprintf(p->given.file,
            "across = %lld\ndown = %lld\ncell = %.6g\nleft = %d\n"
            "numbered = %d\n",
            (long long)b->count, (long long)a->count, cell, (int)LEFT,
            most <= NUMBERED);
    picture_give_text(p, "head", title);
    picture_give_text(p, "xlabel", b->name);
    picture_give_text(p, "ylabel", a->name);
    RITZ_CHECK(give_modes(p, "column_name", b));
    RITZ_CHECK(give_modes(p, "row_name", a));
    put_data(a, b, row, p);
    return picture_draw(p, "mac.gp", title,
                        "likeness of mode shapes: 1 the same, 0 nothing in "
                        "common");
}

ritz_status chart_mac(const chart_sources *sources,
                      const chart_request *request, picture *out)
{
    ritz_status status = RITZ_OK;
    choice chosen = {.num_bodies = 0};
    mac_shapes set[2] = {{.count = 0}};
    const char *how = "";
    int64_t *row = NULL;

    RITZ_TRY(choose(sources, &request->at, &chosen));
    RITZ_TRY(shapes_of(&chosen, &how, set));
    RITZ_TRY(picture_new(request->path, request->keep, out));
    RITZ_TRY(match_rows(&set[0], &set[1], out, &row));
    RITZ_TRY(draw_mac(&set[0], &set[1], row, how, out));
done:
    free_shapes(&set[0]);
    free_shapes(&set[1]);
    return status;
}
