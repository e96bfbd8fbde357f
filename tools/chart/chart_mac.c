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

#include "base/alloc.h"
#include "base/text.h"
#include "model/squares.h"

#include <ritz/matrix.h>

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* A reader could not distinguish more modes. */
enum { MOST_MODES = 60, MOST_BODIES = 64, LABEL = RITZ_NAME_SIZE + 16 };

/* Masses agree if they differ by less than this part of the largest entry. */
static const double rounding = 1e-6;

/* One of the two models: shapes of its flexible modes, or columns of a basis,
   and what their rows are. */
typedef struct mac_side {
    const chart_file *file;
    const ritz_configuration *at; /* NULL: it is no system */
    ritz_dense U;                 /* n x count */
    ritz_dense MU; /* the same times the mass of bodies; {0}: U itself */
    char mode[MOST_MODES][32];          /* "3: 1.25", number and frequency */
    int64_t count, mode_at[MOST_MODES]; /* of all modes, from 0 */
    int64_t num_squares;    /* negative squares of forces, which are left out */
    const ritz_dof *dof;    /* n, borrowed; NULL: rows are not dofs */
    char (*channel)[LABEL]; /* n, inputs and outputs; NULL: rows are none */
    char name[2 * PICTURE_WORD]; /* "system.h5, clock=60" */
} mac_side;

typedef struct mac_pair {
    mac_side side[2];
    int64_t num_bodies; /* whose masses are used */
    const chart_file *body[MOST_BODIES];
    int64_t num_common; /* inputs and outputs, if it is by these */
    const char *how;    /* "by masses" */
} mac_pair;

static void mac_pair_free(mac_pair *pair)
{
    for (int k = 0; k < 2; k++) {
        ritz_dense_free(&pair->side[k].U);
        ritz_dense_free(&pair->side[k].MU);
        free(pair->side[k].channel);
    }
}

/* --- modes, at dofs and by inputs and outputs ----------------------------- */

/* Name the next row or column after mode k. A column of a basis may have no
   frequency, NaN. */
static void name_mode(mac_side *s, int64_t k, double hertz)
{
    snprintf(s->mode[s->count], sizeof *s->mode,
             isnan(hertz) ? "%ld" : "%ld: %.3g", k + 1, hertz);
}

/* The flexible modes, which follow the rigid ones, and their frequencies. */
static ritz_status list_modes(int64_t all, int64_t rigid, const double *lambda,
                              mac_side *out)
{
    for (int64_t k = rigid; k < all; k++) {
        if (out->at && ritz_configuration_is_square(out->at, k)) {
            out->num_squares++;
        } else if (out->count < MOST_MODES) {
            name_mode(out, k - rigid, ritz_eigen_hertz(lambda[k]));
            out->mode_at[out->count++] = k;
        }
    }
    RITZ_REFUSE_IF(out->count < 1, RITZ_ERR_ARGUMENT,
                   "there is no flexible mode");
    return RITZ_OK;
}

/* Modes in the coordinates of the model; a configuration is in modal ones. */
static ritz_status find_modes(mac_side *out)
{
    const ritz_span span = {.modes = MOST_MODES};
    const ritz_configuration *at = out->at;
    const model *m = &out->file->model;
    RITZ_OWN(ritz_pairs) pairs = {0};

    if (at) {
        RITZ_CHECK(list_modes(at->K.ncol, at->num_rigid, at->lambda, out));
        RITZ_CHECK(ritz_dense_new(at->K.ncol, out->count, &out->U));
        for (int64_t k = 0; k < out->count; k++)
            ritz_dense_col(&out->U, k)[out->mode_at[k]] = 1.0;
        return RITZ_OK;
    }
    if (m->kind == MODEL_REDUCED)
        RITZ_CHECK(ritz_eigen_dense(&m->reduced.K, &m->reduced.M, &pairs));
    else
        RITZ_CHECK(
            ritz_eigen_sparse(&m->component.K, &m->component.M, &span, &pairs));
    RITZ_CHECK(list_modes(pairs.Phi.ncol, pairs.num_rigid, pairs.lambda, out));
    return ritz_dense_columns(&pairs.Phi, pairs.num_rigid, out->count, &out->U);
}

/* Shapes at the dofs of a component, a reduced component or a basis. */
static ritz_status find_dof_shapes(mac_side *out)
{
    const model *m = &out->file->model;
    const ritz_basis *b = &m->basis;
    RITZ_OWN(ritz_dense) Phi = {0};

    if (m->kind == MODEL_BASIS) {
        for (; out->count < b->T.ncol && out->count < MOST_MODES; out->count++)
            name_mode(out, out->count, b->columns.hertz[out->count]);
        return ritz_dense_columns(&b->T, 0, out->count, &out->U);
    }
    RITZ_REFUSE_IF(m->kind == MODEL_REDUCED && !m->reduced.dof,
                   RITZ_ERR_ARGUMENT,
                   "it was made without its basis, it has no shapes");
    RITZ_CHECK(find_modes(out));
    out->dof = m->component.dof;
    if (m->kind != MODEL_REDUCED)
        return RITZ_OK;
    RITZ_MOVE(Phi, out->U);
    out->dof = m->reduced.dof;
    return ritz_dense_mul(&m->reduced.T, &Phi, &out->U);
}

/* Rows: inputs, then displacements, velocities and accelerations of outputs. */
static ritz_status stack_channels(const ritz_io *io, mac_side *out)
{
    const struct {
        const char *kind;
        const ritz_dense *C;
        int64_t count;
        char (*name)[RITZ_NAME_SIZE];
    } parts[] = {{"input", NULL, io->num_inputs, io->input},
                 {"output", &io->C, io->num_outputs, io->output},
                 {"velocity", &io->Cv, io->num_outputs, io->output},
                 {"acceleration", &io->Ca, io->num_outputs, io->output}};
    const int64_t n = io->num_inputs + 3 * io->num_outputs;

    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    RITZ_CHECK_NEW(out->channel, n);
    for (int64_t j = 0; j < io->num_inputs; j++)
        for (int64_t k = 0; k < out->count; k++)
            ritz_dense_col(&out->U, k)[j] = ritz_dense_col(&io->B, j)[k];
    for (int64_t p = 0, row = 0; p < 4; row += parts[p++].count) {
        if (parts[p].C)
            ritz_dense_put(parts[p].C, row, 0, &out->U);
        for (int64_t i = 0; i < parts[p].count; i++)
            snprintf(out->channel[row + i], LABEL, "%s %s", parts[p].kind,
                     parts[p].name[i]);
    }
    return RITZ_OK;
}

/* Modes in the rows of inputs B and outputs C; a basis has none. */
static ritz_status find_channel_shapes(mac_side *out)
{
    const model *m = &out->file->model;
    const ritz_io *io = out->at                    ? &out->at->io
                        : m->kind == MODEL_REDUCED ? &m->reduced.io
                                                   : &m->component.io;
    RITZ_OWN(ritz_io) own = {0};

    RITZ_REFUSE_IF(m->kind == MODEL_BASIS ||
                       io->num_inputs + io->num_outputs < 1,
                   RITZ_ERR_ARGUMENT,
                   "it has no inputs and outputs, by which its modes could be "
                   "compared with those of a system");
    RITZ_CHECK(find_modes(out));
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

[[gnu::format(printf, 2, 3)]] static ritz_status
refuse_bodies(const mac_side *side, const char *format, ...)
{
    const ritz_system *s = &side->file->model.system;
    char list[400] = "", why[120];
    va_list args;

    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    for (int64_t c = 0; c < s->num_components; c++)
        sink_append(list, sizeof list, "%s'%.63s'", c > 0 ? ", " : "",
                    s->component[c].name);
    return ritz_fail(RITZ_ERR_ARGUMENT,
                     "the bodies of '%s' (%s) are not these: %s",
                     side->file->path, list, why);
}

/* Bring the files into the order of the bodies: to each the first one left that
   has as many coordinates. */
static ritz_status sort_bodies(const mac_side *side, mac_pair *pair)
{
    const ritz_system *s = &side->file->model.system;
    const chart_file **body = pair->body;

    if (pair->num_bodies != s->num_components)
        return refuse_bodies(side, "%ld bodies, %ld named", s->num_components,
                             pair->num_bodies);
    for (int64_t c = 0; c < pair->num_bodies; c++) {
        const chart_file *found = NULL;
        int64_t k = c;

        while (k < pair->num_bodies &&
               body[k]->model.reduced.K.ncol != s->component[c].order)
            k++;
        if (k == pair->num_bodies)
            return refuse_bodies(side, "none left has %ld coordinates",
                                 s->component[c].order);
        found = body[k];
        for (; k > c; k--)
            body[k] = body[k - 1];
        body[c] = found;
    }
    return RITZ_OK;
}

/* Whether U'MU, with the masses of the files, is M of the configuration. */
static ritz_status check_mass(const mac_side *side)
{
    RITZ_OWN(ritz_dense) product = {0}, due = {0};

    RITZ_CHECK(ritz_dense_mul_tn(&side->U, &side->MU, &product));
    RITZ_CHECK(
        ritz_dense_principal(&side->at->M, side->count, side->mode_at, &due));
    ritz_dense_add(-1.0, &due, &product);
    if (ritz_dense_max(&product) <= rounding * ritz_dense_max(&due))
        return RITZ_OK;
    return refuse_bodies(side, "their masses are not its mass");
}

/* Coordinates of all bodies of a configuration, and their masses times them;
   the bodies' files come in any order that fits. */
static ritz_status find_body_shapes(mac_pair *pair, mac_side *out)
{
    const ritz_system *s = &out->file->model.system;
    const ritz_configuration *at = out->at;
    int64_t n = 0;

    RITZ_CHECK(sort_bodies(out, pair));
    for (int64_t c = 0; c < s->num_components; c++)
        n += s->component[c].order;
    RITZ_CHECK_IN(out->file->path,
                  list_modes(at->K.ncol, at->num_rigid, at->lambda, out));
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->U));
    RITZ_CHECK(ritz_dense_new(n, out->count, &out->MU));
    n = 0;
    for (int64_t c = 0; c < s->num_components; n += s->component[c++].order) {
        RITZ_OWN(ritz_dense) part = {0}, MP = {0};

        RITZ_CHECK(ritz_dense_pick(&at->P[c], out->count, out->mode_at, &part));
        RITZ_CHECK(ritz_dense_mul(&pair->body[c]->model.reduced.M, &part, &MP));
        ritz_dense_put(&part, n, 0, &out->U);
        ritz_dense_put(&MP, n, 0, &out->MU);
    }
    return check_mass(out);
}

/* --- rows in common, and MAC ---------------------------------------------- */

static bool is_same(const mac_side *a, int64_t k, const mac_side *b, int64_t i)
{
    if (a->channel)
        return strcmp(a->channel[k], b->channel[i]) == 0;
    return a->dof[k].grid == b->dof[i].grid &&
           a->dof[k].component == b->dof[i].component;
}

/* Those rows of U in place of all; where rows are matched there is no MU. */
static ritz_status take_rows(int64_t count, const int64_t *row, mac_side *s)
{
    RITZ_OWN(ritz_dense) some = {0};

    RITZ_CHECK(ritz_dense_rows(&s->U, count, row, &some));
    ritz_dense_replace(&s->U, &some);
    return RITZ_OK;
}

/* Keep the rows that both have, in the order of the first. */
static ritz_status match_rows(mac_side *a, mac_side *b)
{
    const int64_t n = a->U.nrow, m = b->U.nrow;
    const bool named = (a->dof && b->dof) || (a->channel && b->channel);
    RITZ_OWN_ARRAY int64_t *row = NULL, *other = NULL;
    int64_t common = 0;

    RITZ_CHECK_NEW(row, n);
    RITZ_CHECK_NEW(other, n);
    RITZ_REFUSE_IF(!named && n != m, RITZ_ERR_ARGUMENT,
                   "a basis names no dofs: '%s' has %ld rows and '%s' %ld",
                   a->name, n, b->name, m);
    for (int64_t k = 0, guess = 0; k < n && named; k++)
        for (int64_t i = 0; i < m; i++) {
            const int64_t at = (guess + i) % m; /* mostly in one order */

            if (!is_same(a, k, b, at))
                continue;
            row[common] = k;
            other[common++] = at;
            guess = at + 1;
            break;
        }
    RITZ_REFUSE_IF(named && common == 0 && !a->channel, RITZ_ERR_ARGUMENT,
                   "'%s' and '%s' have no dof in common", a->name, b->name);
    if (!named)
        return RITZ_OK;
    RITZ_CHECK(take_rows(common, row, a));
    return take_rows(common, other, b);
}

/* Divide each input and output by its largest value in both models, so that
   units do not matter; those without any tell nothing. */
static ritz_status scale_channels(mac_pair *pair)
{
    mac_side *const a = &pair->side[0], *const b = &pair->side[1];
    mac_side *const both[] = {a, b};

    for (int64_t i = 0; i < a->U.nrow; i++) {
        double most = 0.0;

        for (int t = 0; t < 2; t++)
            for (int64_t k = 0; k < both[t]->count; k++)
                most = fmax(most, fabs(ritz_dense_col(&both[t]->U, k)[i]));
        for (int t = 0; t < 2 && most > 0.0; t++)
            for (int64_t k = 0; k < both[t]->count; k++)
                ritz_dense_col(&both[t]->U, k)[i] /= most;
        pair->num_common += most > 0.0;
    }
    RITZ_REFUSE_IF(
        pair->num_common < 2, RITZ_ERR_ARGUMENT,
        "'%s' and '%s' have %s in common by which modes could be told "
        "apart; configurations of the same bodies can be compared by "
        "their masses: name their reduced components too",
        a->name, b->name,
        pair->num_common == 0 ? "no input or output"
                              : "but one input or output");
    return RITZ_OK;
}

static double mac_of(const mac_side *a, const mac_side *b, int64_t i, int64_t j)
{
    const ritz_dense *Ma = a->MU.val ? &a->MU : &a->U;
    const ritz_dense *Mb = b->MU.val ? &b->MU : &b->U;
    const double uv = ritz_dense_dot(&a->U, i, Mb, j);
    const double uu = ritz_dense_dot(&a->U, i, Ma, i);
    const double vv = ritz_dense_dot(&b->U, j, Mb, j);

    return uu > 0.0 && vv > 0.0 ? uv * uv / (uu * vv) : nan("");
}

/* --- which two ------------------------------------------------------------ */

/* Systems, and the other files as bodies. */
static ritz_status part_files(const chart_sources *sources, mac_pair *out,
                              int64_t *num_systems)
{
    for (int64_t k = 0; k < sources->count; k++) {
        const chart_file *file = &sources->file[k];
        const bool system = file->holds == MODEL_SYSTEM;

        RITZ_REFUSE_IF(
            system ? *num_systems == 2 : out->num_bodies == MOST_BODIES,
            RITZ_ERR_ARGUMENT, "MAC is of two models, these are more");
        if (system)
            out->side[(*num_systems)++].file = file;
        else
            out->body[out->num_bodies++] = file;
    }
    return RITZ_OK;
}

/* Two models without bodies; or two systems, perhaps one at two configurations,
   whose bodies the other files are. */
static ritz_status choose_sides(const chart_sources *sources,
                                const cli_list *at, mac_pair *out)
{
    mac_side *const side = out->side;
    int64_t num_systems = 0;
    bool both = false; /* configurations of the only system */

    RITZ_CHECK(part_files(sources, out, &num_systems));
    RITZ_REFUSE_IF(at->count > 2, RITZ_ERR_ARGUMENT,
                   "MAC is of two: --at is there more than twice");
    RITZ_REFUSE_IF(num_systems == 0 && at->count > 0, RITZ_ERR_ARGUMENT,
                   "no file is a system, --at has nothing to choose from");
    if (num_systems == 0 ||
        (num_systems == 1 && at->count < 2 && out->num_bodies == 1)) {
        RITZ_REFUSE_IF(num_systems + out->num_bodies != 2, RITZ_ERR_ARGUMENT,
                       "MAC is of two models, %s",
                       out->num_bodies < 2 ? "this is one" : "these are more");
        for (int64_t k = num_systems; k < 2; k++)
            side[k].file = out->body[k - num_systems];
        out->num_bodies = 0;
    } else if (num_systems == 1) {
        side[1].file = side[0].file;
        both = at->count == 0 &&
               side[0].file->model.system.num_configurations == 2;
        RITZ_REFUSE_IF(
            at->count < 2 && !both, RITZ_ERR_ARGUMENT,
            "MAC is of two: choose two configurations of '%s' by --at and --at "
            "again",
            side[0].file->path);
    }
    for (int k = 0; k < 2; k++) {
        const ritz_system *system = &side[k].file->model.system;
        const char *text = at->count ? at->text[k < at->count ? k : 0] : NULL;

        if (both)
            side[k].at = &system->configuration[k];
        else if (side[k].file->holds == MODEL_SYSTEM)
            RITZ_CHECK_IN(side[k].file->path,
                          ritz_system_find(system, text, &side[k].at));
    }
    return RITZ_OK;
}

/* Shapes of both sides, in rows that both have. */
static ritz_status find_shapes(mac_pair *pair)
{
    mac_side *const side = pair->side;
    const bool systems = side[0].at || side[1].at;
    const bool masses = pair->num_bodies > 0;

    pair->how = masses    ? "by masses"
                : systems ? "by inputs and outputs"
                          : "by dofs";
    for (int64_t k = 0; k < pair->num_bodies; k++)
        RITZ_REFUSE_IF(pair->body[k]->holds != MODEL_REDUCED, RITZ_ERR_ARGUMENT,
                       "'%s' is no reduced component, of which systems are "
                       "assembled",
                       pair->body[k]->path);
    for (int k = 0; k < 2; k++) {
        snprintf(side[k].name, sizeof side[k].name, "%.80s%s%.80s",
                 ritz_path_name(side[k].file->path), side[k].at ? ", " : "",
                 side[k].at ? side[k].at->at : "");
        if (masses)
            RITZ_CHECK(find_body_shapes(pair, &side[k]));
        else
            RITZ_CHECK_IN(side[k].file->path,
                          systems ? find_channel_shapes(&side[k])
                                  : find_dof_shapes(&side[k]));
    }
    RITZ_CHECK(match_rows(&side[0], &side[1]));
    return side[0].channel ? scale_channels(pair) : RITZ_OK;
}

/* --- the picture ---------------------------------------------------------- */

/* Up to this many modes there is a number in each cell. */
enum { NUMBERED = 24 };

static void put_data(const mac_side *a, const mac_side *b, picture *p)
{
    FILE *data = p->data.file, *table = p->table.file;

    fprintf(data, "column\trow\tmac\ttip\n");
    html_line(table, a->name);
    for (int64_t j = 0; j < b->count; j++)
        fprintf(table, "\t%s", b->mode[j]);
    for (int64_t i = 0; i < a->count; i++) {
        fprintf(table, "\n%s", a->mode[i]);
        for (int64_t j = 0; j < b->count; j++) {
            double mac = mac_of(a, b, i, j);

            fprintf(data, "%ld\t%ld\t%.6g\t", j, i, mac);
            picture_tip(p, "%.60s %s Hz\n%.60s %s Hz\nMAC %.4f", a->name,
                        a->mode[i], b->name, b->mode[j], mac);
            fprintf(data, "\n");
            fprintf(table, "\t%.4f", mac);
        }
        fprintf(data, "\n");
    }
    fprintf(table, "\n");
}

ritz_status chart_mac(const chart_sources *sources,
                      const chart_request *request, picture *p)
{
    enum { LEFT = 116, RIGHT = 64, HEAD = 40, FOOT = 100, LETTER = 8 };
    RITZ_OWN(mac_pair) pair = {0};
    const mac_side *a = &pair.side[0], *b = &pair.side[1];
    char title[4 * PICTURE_WORD];
    int64_t most = 0;
    double cell = 34.0, letters = 0.0;

    RITZ_CHECK(choose_sides(sources, &request->at, &pair));
    RITZ_CHECK(find_shapes(&pair));
    most = a->count > b->count ? a->count : b->count;
    if (most > NUMBERED)
        cell = 640.0 / (double)most;
    letters = snprintf(title, sizeof title, "MAC of %.160s and %.160s, %s",
                       a->name, b->name, pair.how);
    p->wide =
        fmax(LEFT + RIGHT + cell * (double)b->count, LEFT + LETTER * letters);
    p->body = HEAD + FOOT + cell * (double)a->count;
    for (int k = 0; k < 2; k++)
        chart_leave_squares(sources, pair.side[k].name,
                            pair.side[k].num_squares, p);
    /* as many modes can be told apart as there are inputs and outputs */
    if (pair.num_common > 0 && pair.num_common < most)
        sink_append(p->note, sizeof p->note,
                    "%s%ld inputs and outputs tell no more modes apart than "
                    "that: likeness can be chance",
                    *p->note ? "; " : "", pair.num_common);
    fprintf(p->given.file,
            "across = %ld\ndown = %ld\ncell = %.6g\nleft = %d\n"
            "numbered = %d\n",
            b->count, a->count, cell, (int)LEFT, most <= NUMBERED);
    picture_give_text(p, "head", title);
    picture_give_text(p, "xlabel", b->name);
    picture_give_text(p, "ylabel", a->name);
    picture_give_texts(p, "column_name", b->count, b->mode[0],
                       sizeof b->mode[0]);
    picture_give_texts(p, "row_name", a->count, a->mode[0], sizeof a->mode[0]);
    put_data(a, b, p);
    return picture_draw(p, "mac.gp", title,
                        "likeness of mode shapes: 1 the same, 0 nothing in "
                        "common");
}
