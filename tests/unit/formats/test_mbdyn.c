/*
 * Bodies for MBDyn. The tests read them by the rules of its manual and of
 * mbdyn/struct/modal.cc [MBDyn2017]: a line "** RECORD GROUP n" opens a group,
 * whose numbers follow on any number of lines, and a line precedes each mode.
 * They sum the invariants of inertia over the nodes of a file, as the manual
 * defines them, and compare them with those of the body.
 */
#include "testing.h"

#include "base/vector.h"
#include "bodies.h"
#include "folder.h"
#include "model/floating.h"

#include <ritz/basis.h>
#include <ritz/export.h>

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum {
    GRIDS = 4,
    GROUPS = 20,
    TERMS = 4,
    NODES = 128,
    MODES = 18,
    LABEL = 32,
    LINE = 8192,
};

/* The contents of a file. */
typedef struct fem_data {
    const char *at; /* what is left of the text */
    bool has[GROUPS];
    int nodes, modes;
    char label[NODES][LABEL];
    double x[3][NODES];
    double psi[MODES][NODES][6];
    double M[MODES][MODES], K[MODES][MODES], D[MODES][MODES];
    double mass[NODES][6];
    int terms, tag[TERMS]; /* of group 19 */
    double K0[TERMS][MODES][MODES];
} fem_data;

/* ---- the reader --------------------------------------------------------- */

/* The next line; false at the end of the file. MBDyn stops at a longer line. */
static bool get_line(fem_data *f, char line[LINE])
{
    size_t length = strcspn(f->at, "\n");

    if (!*f->at)
        return false;
    assert_true(length < LINE - 1);
    memcpy(line, f->at, length);
    line[length] = '\0';
    f->at += length + (f->at[length] == '\n');
    return true;
}

static double get_number(fem_data *f)
{
    char *end = NULL;
    double value = strtod(f->at, &end);

    assert_true(end != f->at);
    f->at = end;
    return value;
}

static void get_word(fem_data *f, char word[LABEL])
{
    size_t length = 0;

    while (isspace((unsigned char)*f->at))
        f->at++;
    while (f->at[length] && !isspace((unsigned char)f->at[length]))
        length++;
    assert_true(length > 0 && length < LABEL);
    memcpy(word, f->at, length);
    word[length] = '\0';
    f->at += length;
}

/* Modes are those of three kinds, without the rejected ones. */
static void read_counts(fem_data *f)
{
    char line[LINE], revision[LABEL];

    assert_true(get_line(f, line));
    get_word(f, revision);
    f->nodes = (int)get_number(f);
    for (int k = 0; k < 3; k++)
        f->modes += (int)get_number(f);
    assert_true(get_number(f) == 0.0);
    assert_true(f->nodes <= NODES && f->modes > 0 && f->modes <= MODES);
}

static void read_shapes(fem_data *f)
{
    char line[LINE];

    for (int j = 0; j < f->modes; j++) {
        assert_true(get_line(f, line));
        assert_true(!*line || strncmp(line, "**", 2) == 0);
        for (int k = 0; k < f->nodes; k++)
            for (int a = 0; a < 6; a++)
                f->psi[j][k][a] = get_number(f);
        assert_true(get_line(f, line));
    }
}

static void read_square(fem_data *f, double A[MODES][MODES])
{
    for (int i = 0; i < f->modes; i++)
        for (int j = 0; j < f->modes; j++)
            A[i][j] = get_number(f);
}

static void read_masses(fem_data *f)
{
    for (int k = 0; k < f->nodes; k++) {
        for (int a = 0; a < 6; a++)
            f->mass[k][a] = get_number(f);
        assert_true(f->mass[k][1] == f->mass[k][0] &&
                    f->mass[k][2] == f->mass[k][0]);
    }
}

/* How many, then the tag and the rows of each, as modal.cc of 2023 reads them. */
static void read_stiffening(fem_data *f)
{
    f->terms = (int)get_number(f);
    assert_true(f->terms > 0 && f->terms <= TERMS);
    for (int k = 0; k < f->terms; k++) {
        f->tag[k] = (int)get_number(f);
        assert_true(f->tag[k] >= 1);
        read_square(f, f->K0[k]);
    }
}

static void read_group(fem_data *f, long group)
{
    switch (group) {
    case 1:
        read_counts(f);
        break;
    case 2:
        for (int k = 0; k < f->nodes; k++)
            get_word(f, f->label[k]);
        break;
    case 5:
    case 6:
    case 7:
        for (int k = 0; k < f->nodes; k++)
            f->x[group - 5][k] = get_number(f);
        break;
    case 8:
        read_shapes(f);
        break;
    case 9:
    case 10:
    case 13:
        read_square(f, group == 9 ? f->M : group == 10 ? f->K : f->D);
        break;
    case 11:
        read_masses(f);
        break;
    case 19:
        read_stiffening(f);
        break;
    default:
        fail_msg("group %ld is not of this exporter", group);
    }
}

static char *read_text(const char *path)
{
    enum { SIZE = 1 << 20 };
    FILE *file = fopen(path, "r");
    char *text = calloc(SIZE, 1);
    size_t size = 0;

    assert_non_null(file);
    assert_non_null(text);
    size = fread(text, 1, SIZE - 1, file);
    assert_int_equal(fclose(file), 0);
    assert_true(size > 0 && size < SIZE - 1);
    return text;
}

static void read_fem(const char *path, fem_data *f)
{
    static const char opens[] = "** RECORD GROUP ";
    static const int needed[] = {1, 2, 5, 6, 7, 8, 9, 10};
    char *text = read_text(path);
    char line[LINE];

    *f = (fem_data){.at = text};
    while (get_line(f, line) && strncmp(line, "** END OF FILE", 14) != 0) {
        char *end = NULL;
        long group = 0;

        if (strncmp(line, opens, sizeof opens - 1) != 0)
            continue;
        group = strtol(line + sizeof opens - 1, &end, 10);
        assert_true(end != line + sizeof opens - 1);
        assert_true(group > 0 && group < GROUPS && !f->has[group]);
        assert_true(group == 1 || f->has[1]);
        read_group(f, group);
        f->has[group] = true;
    }
    for (size_t k = 0; k < sizeof needed / sizeof *needed; k++)
        assert_true(f->has[needed[k]]);
    free(text);
    f->at = NULL;
}

/* ---- invariants --------------------------------------------------------- */

/* Invariants of inertia, as the theory manual numbers them. */
typedef struct fem_invariants {
    double I1, I2[3], I7[3][3];
    double I3[MODES][3], I4[MODES][3], I8[MODES][3][3];
    double I5[MODES][MODES][3], I9[MODES][MODES][3][3];
    double I6[MODES][MODES];
} fem_invariants;

/* -m a~ b~, whose entries are (a . b) I - b a'. */
static void add_twice(double m, const double a[3], const double b[3],
                      double out[3][3])
{
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] += m * ((i == j ? dot : 0.0) - b[i] * a[j]);
}

static void add_node(int modes, double m, const double x[3], double (*U)[3],
                     fem_invariants *of)
{
    double v[3];

    of->I1 += m;
    add_twice(m, x, x, of->I7);
    for (int a = 0; a < 3; a++)
        of->I2[a] += m * x[a];
    for (int j = 0; j < modes; j++) {
        ritz_cross(x, U[j], v);
        for (int a = 0; a < 3; a++) {
            of->I3[j][a] += m * U[j][a];
            of->I4[j][a] += m * v[a];
        }
        add_twice(m, x, U[j], of->I8[j]);
        for (int k = 0; k < modes; k++) {
            ritz_cross(U[j], U[k], v);
            for (int a = 0; a < 3; a++) {
                of->I5[j][k][a] += m * v[a];
                of->I6[j][k] += m * U[j][a] * U[k][a];
            }
            add_twice(-m, U[j], U[k], of->I9[j][k]);
        }
    }
}

/* Sum over the nodes of a file, none of which has rotary inertia. */
static void sum_nodes(const fem_data *f, fem_invariants *of)
{
    double U[MODES][3];

    *of = (fem_invariants){0};
    for (int k = 0; k < f->nodes; k++) {
        const double x[3] = {f->x[0][k], f->x[1][k], f->x[2][k]};

        for (int a = 3; a < 6; a++)
            assert_true(f->mass[k][a] == 0.0);
        for (int j = 0; j < f->modes; j++)
            memcpy(U[j], f->psi[j][k], sizeof U[j]);
        add_node(f->modes, f->mass[k][0], x, U, of);
    }
}

/* Terms agree to 1e-12 of their largest size: modes have unit mass, and nodes
   lie within 2 m. */
static void assert_same(const double *found, const double *expected,
                        size_t count, double size)
{
    for (size_t k = 0; k < count; k++)
        assert_near(found[k], expected[k], 1e-12 * size);
}

static void assert_invariants(const fem_invariants *found,
                              const fem_invariants *expected)
{
    const double m = expected->I1;
    const double J =
        expected->I7[0][0] + expected->I7[1][1] + expected->I7[2][2];

    assert_near(found->I1, m, 1e-12 * m);
    assert_same(found->I2, expected->I2, 3, sqrt(m * J));
    assert_same(found->I7[0], expected->I7[0], 9, J);
    assert_same(found->I3[0], expected->I3[0], MODES * 3, sqrt(m));
    assert_same(found->I4[0], expected->I4[0], MODES * 3, sqrt(J));
    assert_same(found->I8[0][0], expected->I8[0][0], MODES * 9, sqrt(J));
    assert_same(found->I5[0][0], expected->I5[0][0], MODES * MODES * 3, 1.0);
    assert_same(found->I6[0], expected->I6[0], MODES * MODES, 1.0);
    assert_same(found->I9[0][0][0], expected->I9[0][0][0], MODES * MODES * 9,
                1.0);
}

/* ---- bodies ------------------------------------------------------------- */

static const double places[GRIDS][3] = {
    {0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {2, 1, 1}};
static const double weights[GRIDS] = {2.0, 1.0, 3.0, 1.5};

typedef struct fixture {
    ritz_reduced masses; /* four points joined by six springs: six modes */
    ritz_reduced chain;  /* four grids with rotations and dampers: 18 modes */
    ritz_reduced discs;  /* the chain with inertia J_x alone */
} fixture;

/* Springs along all lines between four points: K = sum k b b'. */
static ritz_status join_points(ritz_sparse *out)
{
    int64_t row[216], col[216], count = 0;
    double val[216];

    for (int i = 0; i < GRIDS; i++)
        for (int j = 0; j < i; j++) {
            double b[6], square = 0.0;

            for (int a = 0; a < 3; a++) {
                b[a] = places[i][a] - places[j][a];
                b[3 + a] = -b[a];
                square += b[a] * b[a];
            }
            for (int k = 0; k < 36; k++) {
                row[count] = 3 * (k / 6 < 3 ? i : j) + k / 6 % 3;
                col[count] = 3 * (k % 6 < 3 ? i : j) + k % 6 % 3;
                val[count++] =
                    (100.0 + 10.0 * i + j) * b[k / 6] * b[k % 6] / square;
            }
        }
    return ritz_sparse_from_triplets(12, 12, count, row, col, val, out);
}

static ritz_status reduce_body(const ritz_component *body, int64_t modes,
                               ritz_reduced *out)
{
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};

    request.component = body;
    request.modes = modes;
    RITZ_CHECK(ritz_basis_make(&ritz_method_macneal_rubin, &request, &basis));
    return ritz_reduce(body, &basis, out);
}

static ritz_status make_masses(ritz_reduced *out)
{
    RITZ_OWN(ritz_component) chain = {0}, body = {0};
    int64_t row[3 * GRIDS];
    double m[3 * GRIDS];

    RITZ_CHECK(body_chain(GRIDS, places, 11, 5, &chain));
    body.num_dofs = 3 * GRIDS;
    RITZ_MOVE(body.grids, chain.grids);
    RITZ_MOVE(body.dof, chain.dof);
    for (int64_t i = 0; i < body.num_dofs; i++) {
        body.dof[i] = (ritz_dof){11 + i / 3, 1 + i % 3};
        row[i] = i;
        m[i] = weights[i / 3];
    }
    RITZ_CHECK(ritz_sparse_from_triplets(12, 12, 12, row, row, m, &body.M));
    RITZ_CHECK(join_points(&body.K));
    RITZ_CHECK(ritz_component_settle(&body, false));
    return reduce_body(&body, 6, out);
}

static ritz_status make_chain(bool discs, ritz_reduced *out)
{
    RITZ_OWN(ritz_component) body = {0};

    RITZ_CHECK(body_chain(GRIDS, places, 21, 9, &body));
    RITZ_CHECK(ritz_sparse_copy(&body.K, &body.D));
    for (int64_t j = 0; discs && j < body.num_dofs; j++)
        for (int64_t e = body.M.colptr[j]; e < body.M.colptr[j + 1]; e++)
            if (j % 6 > 3 || (j % 6 == 3 && body.M.rowind[e] != j))
                body.M.val[e] = 0.0;
    return reduce_body(&body, discs ? 12 : MODES, out);
}

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){0};
    *state = &f;
    assert_ok(make_masses(&f.masses));
    assert_ok(make_chain(false, &f.chain));
    assert_ok(make_chain(true, &f.discs));
    return folder_make(state);
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_reduced_free(&f->masses);
    ritz_reduced_free(&f->chain);
    ritz_reduced_free(&f->discs);
    return folder_remove(state);
}

static ritz_status write_model(const ritz_reduced *reduced,
                               ritz_export_request request,
                               ritz_export_report *report)
{
    request.output = folder_path("body.fem");
    return ritz_exporter_mbdyn.write(&(ritz_export_object){.reduced = reduced},
                                     &request, report);
}

/* Write the body in a frame, read the file, and make the same floating body. */
static void write_and_read(const ritz_reduced *reduced, const char *frame,
                           const char *reference, fem_data *f,
                           ritz_floating *body)
{
    const ritz_floating_request request = {frame, reference};
    RITZ_OWN(ritz_export_report) report = {0};

    assert_ok(write_model(
        reduced, (ritz_export_request){.frame = frame, .reference = reference},
        &report));
    read_fem(folder_path("body.fem"), f);
    assert_ok(ritz_floating_of(reduced, &request, body));
    assert_int_equal(f->modes, body->K.ncol);
    assert_true(f->nodes > body->count);
}

/* ---- tests -------------------------------------------------------------- */

static void assert_square(double A[MODES][MODES], const ritz_dense *B)
{
    for (int64_t i = 0; i < B->nrow; i++)
        for (int64_t j = 0; j < B->ncol; j++)
            assert_true(A[i][j] == ritz_dense_col(B, j)[i]);
}

static void mbdyn_reads_every_bit(void **state)
{
    const fixture *s = *state;
    static fem_data f;
    RITZ_OWN(ritz_floating) body = {0};

    write_and_read(&s->chain, NULL, NULL, &f, &body);
    assert_true(f.has[11] && f.has[13] && !f.has[12]);
    assert_int_equal(body.count, GRIDS);
    for (int64_t k = 0; k < GRIDS; k++) {
        assert_int_equal(strtol(f.label[k], NULL, 10), 21 + k);
        for (int a = 0; a < 3; a++) {
            assert_true(f.x[a][k] == places[k][a]);
            for (int64_t j = 0; j < f.modes; j++) {
                assert_true(f.psi[j][k][a] ==
                            ritz_dense_col(&body.shape, j)[3 * k + a]);
                assert_true(f.psi[j][k][3 + a] ==
                            ritz_dense_col(&body.turn, j)[3 * k + a]);
            }
        }
        for (int a = 0; a < 6; a++)
            assert_true(f.mass[k][a] == 0.0);
    }
    assert_square(f.M, &body.M);
    assert_square(f.K, &body.K);
    assert_non_null(body.D.val);
    assert_square(f.D, &body.D);
    assert_string_equal(f.label[GRIDS], "inertia1");
}

/* Where all mass is at the grids, the invariants are known: sums over these
   masses with the modes of the file, in each frame. */
static void invariants_are_those_of_the_masses(void **state)
{
    static const char *const frames[][2] = {
        {NULL, NULL}, {"centre", "none"}, {"centre", "mean-axis"}};
    const fixture *s = *state;
    static fem_data f;
    static fem_invariants found, expected;

    for (int t = 0; t < 3; t++) {
        RITZ_OWN(ritz_floating) body = {0};
        double U[MODES][3];

        write_and_read(&s->masses, frames[t][0], frames[t][1], &f, &body);
        assert_int_equal(f.nodes, 2 * GRIDS);
        assert_false(f.has[13]);
        expected = (fem_invariants){0};
        for (int k = 0; k < GRIDS; k++) {
            const double x[3] = {f.x[0][k], f.x[1][k], f.x[2][k]};

            for (int j = 0; j < f.modes; j++)
                memcpy(U[j], f.psi[j][k], sizeof U[j]);
            add_node(f.modes, weights[k], x, U, &expected);
        }
        sum_nodes(&f, &found);
        assert_invariants(&found, &expected);
        for (int j = 0; j < f.modes; j++)
            assert_same(found.I6[j], f.M[j], (size_t)f.modes, 1.0);
    }
    for (int a = 0; a < 3; a++) /* about the centre */
        assert_near(found.I2[a], 0.0, 1e-12 * found.I1);
}

static void assert_momenta(const fem_data *f, const ritz_floating *body)
{
    static fem_invariants found;
    const ritz_dense *P = &body->invariants.product;
    const double *A = body->invariants.rigid;
    const double J = A[21] + A[28] + A[35];

    sum_nodes(f, &found);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            assert_near(found.I7[a][b], A[3 + a + 6 * (3 + b)], 1e-12 * J);
    for (int64_t j = 0; j < f->modes; j++) {
        const double *momentum = ritz_dense_col(&body->invariants.momentum, j);
        const double size = sqrt(ritz_dense_col(&body->M, j)[j]);

        assert_same(found.I3[j], momentum, 3, sqrt(found.I1) * size);
        assert_same(found.I4[j], momentum + 3, 3, sqrt(J) * size);
        for (int64_t k = 0; k < f->modes; k++)
            for (int a = 0; a < 3; a++) {
                int64_t b = (a + 1) % 3 * f->modes;
                int64_t c = (a + 2) % 3 * f->modes;
                double other = sqrt(ritz_dense_col(&body->M, k)[k]);

                assert_near(found.I5[j][k][a],
                            ritz_dense_col(P, c + k)[b + j] -
                                ritz_dense_col(P, b + k)[c + j],
                            2e-12 * size * other);
            }
    }
}

/* Grids that turn have rotary inertia: mass, inertia and momenta of a file are
   those of the whole M, and products those of the invariants. Modes of the free
   body have no momentum; modes in a tangent frame have. */
static void rotary_inertia_is_in_the_file(void **state)
{
    const fixture *s = *state;
    static fem_data f;
    RITZ_OWN(ritz_floating) free_modes = {0}, tangent = {0};

    write_and_read(&s->chain, NULL, NULL, &f, &free_modes);
    assert_momenta(&f, &free_modes);
    write_and_read(&s->chain, "23", "tangent", &f, &tangent);
    assert_true(ritz_dense_max(&tangent.invariants.momentum) > 1.0);
    assert_momenta(&f, &tangent);
}

static void a_tangent_frame_holds_its_grid(void **state)
{
    const fixture *s = *state;
    static fem_data f;
    RITZ_OWN(ritz_floating) body = {0};

    write_and_read(&s->chain, "23", "tangent", &f, &body);
    for (int a = 0; a < 3; a++)
        assert_true(f.x[a][2] == 0.0);
    for (int j = 0; j < f.modes; j++)
        for (int a = 0; a < 6; a++)
            assert_near(f.psi[j][2][a], 0.0, 1e-12);
}

/* The certificate quotes the command, which may contain any words; these must
   not open a record group. */
static void the_certificate_is_in_comments(void **state)
{
    const fixture *s = *state;
    static fem_data f;
    char text[] = "0123456789abcdef  a.h5";
    char *const input[] = {text};
    const ritz_stamp stamp = {.command = "RECORD GROUP 9, END OF FILE",
                              .num_inputs = 1,
                              .input = input};
    RITZ_OWN(ritz_export_report) report = {0};
    char *all = NULL;

    assert_ok(write_model(&s->chain, (ritz_export_request){.stamp = &stamp},
                          &report));
    read_fem(folder_path("body.fem"), &f);
    all = read_text(folder_path("body.fem"));
    assert_non_null(strstr(all, "\n**   reduced component by Ritz"));
    assert_non_null(strstr(all, "\n**   input: 0123456789abcdef  a.h5\n"));
    assert_non_null(
        strstr(all, "\n**   command: RECORD GROUP 9, END OF FILE\n"));
    free(all);
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

static void the_lost_energy_is_reported(void **state)
{
    const fixture *s = *state;
    RITZ_OWN(ritz_export_report)
    chain = {0}, masses = {0}, discs = {0}, structural = {0};
    ritz_reduced other = s->masses; /* borrowed */

    assert_ok(write_model(&s->chain, (ritz_export_request){0}, &chain));
    assert_true(says(&chain, "are not grids"));
    assert_true(says(&chain, "'damping from file'"));
    assert_true(says(&chain, "inputs, outputs, ports and units are left out"));
    assert_false(says(&chain, "grids without rotations"));
    assert_ok(write_model(&s->masses, (ritz_export_request){0}, &masses));
    assert_true(says(&masses, "nodes inertia1 to inertia4 are not grids"));
    assert_true(says(&masses, "4 of 4 grids without rotations"));
    assert_false(says(&masses, "negative"));
    assert_false(says(&masses, "'damping from file'"));
    assert_ok(write_model(&s->discs, (ritz_export_request){0}, &discs));
    assert_true(says(&discs, "of their masses are negative"));
    other.K4 = other.K;
    assert_ok(write_model(&other, (ritz_export_request){0}, &structural));
    assert_true(says(&structural, "structural damping left out"));
}

/* The body with its own K and M as geometric stiffness of two loads, of which
   a part of the caller's is borrowed. */
static ritz_reduced with_loads(const ritz_reduced *reduced,
                               ritz_reduced_load load[2])
{
    ritz_reduced loaded = *reduced;

    load[0] = (ritz_reduced_load){"stretch", reduced->K};
    load[1] = (ritz_reduced_load){"accel_y", reduced->M};
    loaded.num_loads = 2;
    loaded.load = load;
    return loaded;
}

/* K0 of KG = K is the modal stiffness, and of KG = M the modal mass. Tags are
   those of ModalAd: w_z^2 is 3, w_z w_x is 6, the acceleration along y is 11, a
   force along x on the first interface node 13, a moment about z on the second
   24. */
static void group_19_holds_stiffening_by_its_tags(void **state)
{
    static const struct {
        const char *text;
        int tag[2];
    } rows[] = {
        {"spin_zz=stretch,accel_y", {3, 11}},
        {"spin_xz=stretch,turn_x=accel_y", {6, 7}},
        {"force_x@22=stretch,moment_z@24=accel_y", {13, 24}},
    };
    const fixture *s = *state;
    static fem_data f;

    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        ritz_reduced_load load[2];
        const ritz_reduced loaded = with_loads(&s->chain, load);
        RITZ_OWN(ritz_export_report) report = {0};

        assert_ok(write_model(&loaded,
                              (ritz_export_request){.stiffening = rows[k].text},
                              &report));
        assert_true(says(&report, "use automatic differentiation"));
        assert_false(says(&report, "is left out: name its term"));
        assert_true(says(&report, "begin with grids 22, 24") == (k == 2));
        read_fem(folder_path("body.fem"), &f);
        assert_true(f.has[19]);
        assert_int_equal(f.terms, 2);
        for (int t = 0; t < 2; t++)
            assert_int_equal(f.tag[t], rows[k].tag[t]);
        for (int i = 0; i < f.modes; i++)
            for (int j = 0; j < f.modes; j++) {
                const double Kii = sqrt(f.K[i][i] * f.K[j][j]);

                assert_near(f.K0[0][i][j], f.K[i][j], 1e-11 * Kii);
                assert_near(f.K0[1][i][j], f.M[i][j], 1e-12);
            }
    }
}

static void loads_without_a_term_are_named(void **state)
{
    const fixture *s = *state;
    static fem_data f;
    ritz_reduced_load load[2];
    const ritz_reduced loaded = with_loads(&s->chain, load);
    RITZ_OWN(ritz_export_report) report = {0};

    assert_ok(write_model(&loaded, (ritz_export_request){0}, &report));
    assert_true(says(&report, "load 'stretch' is left out: name its term by "
                              "--stiffening TERM=stretch"));
    assert_true(says(&report, "load 'accel_y' is left out"));
    read_fem(folder_path("body.fem"), &f);
    assert_false(f.has[19]);
}

static void terms_that_cannot_be_are_refused(void **state)
{
    static const struct {
        const char *text, *frame, *words;
    } rows[] = {
        {"spin_zx=stretch", NULL, "there is no term 'spin_zx'"},
        {"", NULL, "there is no term ''"},
        {"spin_zz=strech", NULL, "is 'stretch' meant"},
        {"spin_zz", NULL, "spin_zz"},
        {"force_x=stretch", NULL, "forces and moments are of a grid"},
        {"spin_zz@21=stretch", NULL, "forces and moments are of a grid"},
        {"force_x@=stretch", NULL, "'force_x@' names no grid"},
        {"force_x@2a=stretch", NULL, "'force_x@2a' names no grid"},
        {"force_x@99=stretch", NULL, "there is no grid 99"},
        {"turn_z=stretch,turn_z=accel_y", NULL, "'turn_z' is named twice"},
        {"spin_zz=stretch", "23", "export with --frame basic"},
    };
    const fixture *s = *state;

    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        ritz_reduced_load load[2];
        const ritz_reduced loaded = with_loads(&s->chain, load);
        RITZ_OWN(ritz_export_report) report = {0};

        assert_fails(
            write_model(&loaded,
                        (ritz_export_request){.stiffening = rows[k].text,
                                              .frame = rows[k].frame},
                        &report),
            RITZ_ERR_ARGUMENT, rows[k].words);
    }
}

static void assert_refused(const ritz_reduced *reduced, const char *frame,
                           const char *words)
{
    const char *path = folder_path("body.fem");
    RITZ_OWN(ritz_export_report) report = {0};

    (void)remove(path);
    assert_fails(
        write_model(reduced, (ritz_export_request){.frame = frame}, &report),
        RITZ_ERR_ARGUMENT, words);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(report.count, 0);
}

static void bodies_without_shapes_or_frames_are_refused(void **state)
{
    const fixture *s = *state;
    ritz_reduced other = s->chain; /* borrowed */

    other.T = (ritz_dense){0};
    assert_refused(&other, NULL, "--without-basis");
    other = s->chain;
    other.grids.count = 0;
    assert_refused(&other, NULL, "no grid has a position");
    assert_refused(&s->chain, "99", "99");
}

static ritz_status write_once(const fixture *s)
{
    ritz_reduced_load load[2];
    const ritz_reduced loaded = with_loads(&s->masses, load);
    RITZ_OWN(ritz_export_report) report = {0};

    return write_model(
        &loaded, (ritz_export_request){.stiffening = "spin_zz=stretch,accel_y"},
        &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(write_once(*state));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(mbdyn_reads_every_bit),
    cmocka_unit_test(invariants_are_those_of_the_masses),
    cmocka_unit_test(rotary_inertia_is_in_the_file),
    cmocka_unit_test(a_tangent_frame_holds_its_grid),
    cmocka_unit_test(the_certificate_is_in_comments),
    cmocka_unit_test(the_lost_energy_is_reported),
    cmocka_unit_test(bodies_without_shapes_or_frames_are_refused),
    cmocka_unit_test(group_19_holds_stiffening_by_its_tags),
    cmocka_unit_test(loads_without_a_term_are_named),
    cmocka_unit_test(terms_that_cannot_be_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(mbdyn, tests, set_up, tear_down)
