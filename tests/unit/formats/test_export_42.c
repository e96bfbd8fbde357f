/*
 * Flexible bodies for 42, read here as its InitFlexModes() and InitNodes()
 * read [Stoneking2025]: numbers, then the rest of the line, which must not be
 * empty and has to fit into 80 bytes. Modal integrals are compared with sums
 * over point masses that follow the nodes.
 */
#include "testing.h"

#include "base/vector.h"
#include "folder.h"
#include "moving_body.h"

#include <ritz/export.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum {
    NODES = MOVING_GRIDS,
    MODES = MOVING_MODES,
    JOINTS = MOVING_GRIDS, /* all grids are ports */
    REST = 80
};

/* What 42 keeps of a body, with 42's names. */
typedef struct flex_body {
    int64_t Nf;
    double PSIj[JOINTS][3][MODES], THETAj[JOINTS][3][MODES];
    double PSI[NODES][3][MODES], THETA[NODES][3][MODES];
    double Mf[MODES][MODES], Kf[MODES][MODES], Cf[MODES][MODES];
    double Pf[3][MODES], Hf[3][MODES];
    double L[3][3][MODES], N[3][3][MODES][MODES];
    double NomPosB[NODES][3];
} flex_body;

/* Skip the rest of a line as scanf(" %[^\n] %[\n]") of 42 does. */
static void take_rest(FILE *file)
{
    char rest[4 * REST] = "";
    int c = 0;

    while ((c = fgetc(file)) == ' ')
        ;
    assert_true(c != '\n' && c != EOF);
    ungetc(c, file);
    assert_non_null(fgets(rest, sizeof rest, file));
    assert_true(strchr(rest, '\n') && strlen(rest) <= REST);
}

static void take_title(FILE *file, const char *words)
{
    char line[4 * REST] = "";

    assert_non_null(fgets(line, sizeof line, file));
    assert_true(strlen(line) <= REST); /* and '\n' */
    assert_non_null(strstr(line, words));
}

static int64_t take_whole(FILE *file)
{
    char word[32] = "";
    char *end = NULL;
    int64_t n = 0;

    assert_int_equal(fscanf(file, "%31s", word), 1);
    n = strtoll(word, &end, 10);
    assert_true(*end == '\0' && n >= 0);
    return n;
}

static double take_number(FILE *file)
{
    char word[64] = "";
    char *end = NULL;
    double x = 0.0;

    assert_int_equal(fscanf(file, "%63s", word), 1);
    x = strtod(word, &end);
    assert_true(*end == '\0');
    return x;
}

/* "[Mode] [Node] [Axis] Value"; at[node][axis][mode] */
static void take_shape(FILE *file, const char *words, int64_t points,
                       double (*at)[3][MODES])
{
    int64_t count = 0;

    take_title(file, words);
    count = take_whole(file);
    take_rest(file);
    for (int64_t i = 0; i < count; i++) {
        int64_t mode = take_whole(file);
        int64_t point = take_whole(file);
        int64_t axis = take_whole(file);

        assert_true(mode < MODES && point < points && axis < 3);
        at[point][axis][mode] = take_number(file);
        take_rest(file);
    }
}

static void take_matrix(FILE *file, const char *words, double (*at)[MODES])
{
    int64_t count = 0;

    take_title(file, words);
    count = take_whole(file);
    take_rest(file);
    for (int64_t k = 0; k < count; k++) {
        int64_t i = take_whole(file);
        int64_t j = take_whole(file);

        assert_true(i < MODES && j < MODES);
        at[i][j] = take_number(file);
        take_rest(file);
    }
}

static void take_momenta(FILE *file, const char *words, double (*at)[MODES])
{
    take_title(file, words);
    for (int k = 0; k < MODES; k++) {
        for (int a = 0; a < 3; a++)
            at[a][k] = take_number(file);
        take_rest(file);
    }
}

static void take_tensors(FILE *file, flex_body *b)
{
    int64_t count = 0;

    take_title(file, "Linear Modal Integral, L");
    count = take_whole(file);
    take_rest(file);
    for (int64_t k = 0; k < count; k++) {
        int64_t i = take_whole(file);
        int64_t j = take_whole(file);
        int64_t mode = take_whole(file);

        assert_true(i < 3 && j < 3 && mode < MODES);
        b->L[i][j][mode] = take_number(file);
        take_rest(file);
    }
    take_title(file, "Angular Modal Integral, N");
    count = take_whole(file);
    take_rest(file);
    for (int64_t k = 0; k < count; k++) {
        int64_t i = take_whole(file);
        int64_t j = take_whole(file);
        int64_t p = take_whole(file);
        int64_t q = take_whole(file);

        assert_true(i < 3 && j < 3 && p < MODES && q < MODES);
        b->N[i][j][p][q] = take_number(file);
        take_rest(file);
    }
}

static void take_modes(FILE *file, flex_body *b)
{
    take_title(file, "Flexible Body Inputs for 42");
    take_title(file, "! Description");
    b->Nf = take_whole(file);
    assert_int_equal(b->Nf, MODES);
    take_rest(file);
    take_title(file, "Initial Modal States");
    for (int k = 0; k < MODES; k++) {
        assert_true(take_number(file) == 0.0);
        assert_true(take_number(file) == 0.0);
        take_rest(file);
    }
    take_title(file, "Joint Node Mode Shapes");
    take_shape(file, "(PSI)", JOINTS, b->PSIj);
    take_shape(file, "(THETA)", JOINTS, b->THETAj);
    take_title(file, "Analysis Node Mode Shapes");
    take_shape(file, "(PSI)", NODES, b->PSI);
    take_shape(file, "(THETA)", NODES, b->THETA);
    take_matrix(file, "Mass Matrix", b->Mf);
    take_matrix(file, "Stiffness Matrix", b->Kf);
    take_matrix(file, "Damping Matrix", b->Cf);
    take_momenta(file, "Linear Momentum Modal Integral, Pf", b->Pf);
    take_momenta(file, "Angular Momentum Modal Integral, Hf", b->Hf);
    take_tensors(file, b);
}

static void take_nodes(FILE *file, flex_body *b)
{
    take_title(file, "Body Node Inputs for 42");
    take_title(file, "! Description");
    assert_int_equal(take_whole(file), NODES);
    take_rest(file);
    take_title(file, "Node Location, Comment");
    for (int k = 0; k < NODES; k++) {
        char comment[REST] = "";

        for (int a = 0; a < 3; a++)
            b->NomPosB[k][a] = take_number(file);
        assert_int_equal(fscanf(file, " \"%79[^\"]\" ", comment), 1);
        assert_int_equal(strncmp(comment, "grid ", 5), 0);
    }
    assert_int_equal(fgetc(file), EOF);
}

/* Write and read a body. Returns the text behind "[EOF]", to be freed. */
static char *read_body(const char *frame, const char *reference,
                       const moving_body *of, flex_body *b)
{
    const char *path = folder_path("Flex.txt");
    FILE *file = NULL;
    char *rest = calloc(1 << 16, 1);

    assert_non_null(rest);
    moving_body_write(of, &ritz_exporter_42, path, frame, reference);
    file = fopen(path, "r");
    assert_non_null(file);
    take_modes(file, b);
    take_title(file, "[EOF]");
    assert_true(fread(rest, 1, (1 << 16) - 1, file) > 0);
    assert_int_equal(fclose(file), 0);
    file = fopen(folder_path("Flex.txt.nodes"), "r");
    assert_non_null(file);
    take_nodes(file, b);
    assert_int_equal(fclose(file), 0);
    return rest;
}

/* The numbers on the line of `rest` that ends in these words. */
static void find_numbers(const char *rest, const char *words, int count,
                         double *out)
{
    const char *at = strstr(rest, words);
    char *end = NULL;

    assert_non_null(at);
    while (at > rest && at[-1] != '\n')
        at--;
    for (int k = 0; k < count; k++, at = end) {
        out[k] = strtod(at, &end);
        assert_true(end != at);
    }
}

/* ---- sums over points --------------------------------------------------- */

static void collect_points(const moving_body *f, const flex_body *b,
                           const double *reference, moving_point *out)
{
    moving_node node[NODES] = {0};

    for (int i = 0; i < NODES; i++)
        for (int a = 0; a < 3; a++) {
            node[i].x[a] = b->NomPosB[i][a] - reference[a];
            for (int k = 0; k < MODES; k++) {
                node[i].phi[k][a] = b->PSI[i][a][k];
                node[i].psi[k][a] = b->THETA[i][a][k];
            }
        }
    moving_body_points(f, node, out);
}

static void check_momenta(const flex_body *b, const moving_point *n)
{
    for (int k = 0; k < MODES; k++) {
        double P[3] = {0}, H[3] = {0};

        for (int i = 0; i < MOVING_POINTS; i++) {
            double moment[3];

            ritz_cross(n[i].x, n[i].u[k], moment);
            for (int a = 0; a < 3; a++) {
                P[a] += n[i].m * n[i].u[k][a];
                H[a] += n[i].m * moment[a];
            }
        }
        for (int a = 0; a < 3; a++) {
            assert_near(b->Pf[a][k], P[a], moving_rounding);
            assert_near(b->Hf[a][k], H[a], moving_rounding);
        }
    }
}

static void check_tensors(const flex_body *b, const moving_point *n)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int p = 0; p < MODES; p++) {
                double L = 0.0, N[MODES] = {0};

                for (int k = 0; k < MOVING_POINTS; k++) {
                    L += n[k].m * n[k].u[p][i] * n[k].x[j];
                    for (int q = 0; q < MODES; q++)
                        N[q] += n[k].m * n[k].u[p][i] * n[k].u[q][j];
                }
                assert_near(b->L[i][j][p], L, moving_rounding);
                for (int q = 0; q < MODES; q++)
                    assert_near(b->N[i][j][p][q], N[q], moving_rounding);
            }
}

static void check_mass(const char *rest, const moving_point *n,
                       const double *reference)
{
    double m = 0.0, J[9] = {0}, c[3] = {0};
    double mass = 0.0, moments[3], products[3], centre[3];

    for (int i = 0; i < MOVING_POINTS; i++) {
        const double *x = n[i].x;

        m += n[i].m;
        for (int a = 0; a < 9; a++)
            J[a] += n[i].m *
                    ((a % 4 == 0 ? ritz_dot(x, x) : 0.0) - x[a / 3] * x[a % 3]);
        for (int a = 0; a < 3; a++)
            c[a] += n[i].m * x[a];
    }
    find_numbers(rest, "! Mass\n", 1, &mass);
    find_numbers(rest, "! Moments of Inertia", 3, moments);
    find_numbers(rest, "! Products of Inertia (xy,xz,yz)", 3, products);
    find_numbers(rest, "! Location of mass center", 3, centre);
    assert_near(mass, m, moving_rounding);
    for (int a = 0; a < 3; a++) {
        assert_near(moments[a], J[4 * a], moving_rounding);
        assert_near(centre[a], c[a] / m + reference[a], moving_rounding);
    }
    assert_near(products[0], -J[1], moving_rounding);
    assert_near(products[1], -J[2], moving_rounding);
    assert_near(products[2], -J[5], moving_rounding);
}

static void check_body(const moving_body *f, const char *frame,
                       const char *reference, bool at_centre)
{
    flex_body b = {0};
    moving_point n[MOVING_POINTS] = {0};
    char *rest = read_body(frame, reference, f, &b);
    double at[3] = {0};

    assert_non_null(
        strstr(rest, at_centre ? "\nREFPT_CM !" : "\nREFPT_JOINT !"));
    if (at_centre)
        find_numbers(rest, "! Location of mass center", 3, at);
    collect_points(f, &b, at, n);
    check_momenta(&b, n);
    check_tensors(&b, n);
    check_mass(rest, n, at);
    for (int k = 0; k < MODES; k++) {
        assert_true(b.Mf[k][k] == 1.0);
        for (int l = 0; l < MODES; l++)
            assert_true(k == l || (b.Kf[k][l] == 0.0 && b.Mf[k][l] == 0.0));
        for (int a = 0; at_centre && a < 3; a++) {
            assert_near(b.Pf[a][k], 0.0, moving_rounding);
            assert_near(b.Hf[a][k], 0.0, moving_rounding);
        }
    }
    free(rest);
}

static void integrals_are_sums_over_points(void **state)
{
    check_body(*state, NULL, NULL, true);
    check_body(*state, "centre", "mean-axis", true);
    check_body(*state, "24", NULL, false);
    check_body(*state, "basic", "mean-axis", false);
    check_body(*state, "basic", "none", false);
}

/* ---- what 42 makes of it ------------------------------------------------ */

/* The force on mode p of a body that turns, as 42 adds it up from Qf, Rf and Sf
   of InitFlexModes(). */
static double force_of_42(const flex_body *b, int p, const moving_motion *at)
{
    const double *w = at->w;
    double force = 0.0;

    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3;
        int k = (i + 2) % 3;

        force -= (b->L[j][j][p] + b->L[k][k][p]) * w[i] * w[i];
        force += (b->L[j][i][p] * w[j] + b->L[k][i][p] * w[k]) * w[i];
        for (int q = 0; q < MODES; q++) {
            double Q = b->N[k][j][p][q] - b->N[j][k][p][q];
            double S = -(b->N[j][j][p][q] + b->N[k][k][p][q]) * w[i] +
                       b->N[j][i][p][q] * w[j] + b->N[k][i][p][q] * w[k];

            force += (2.0 * Q * at->rate[q] + S * at->q[q]) * w[i];
        }
    }
    return force;
}

static void forces_of_42_are_those_of_the_points(void **state)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    flex_body b = {0};
    moving_point n[MOVING_POINTS] = {0};

    free(read_body("24", "tangent", *state, &b));
    collect_points(*state, &b, origin, n);
    for (int p = 0; p < MODES; p++)
        assert_near(force_of_42(&b, p, &moving_example),
                    moving_force(n, p, &moving_example),
                    10.0 * moving_rounding);
}

/* The joints of the file are the ports, in their order; each grid of this body
   is a port. */
static void joints_move_as_their_grids(void **state)
{
    flex_body b = {0};
    char *rest = read_body("24", NULL, *state, &b);

    for (int i = 0; i < NODES; i++)
        for (int a = 0; a < 3; a++)
            for (int k = 0; k < MODES; k++) {
                assert_true(b.PSIj[i][a][k] == b.PSI[i][a][k]);
                assert_true(b.THETAj[i][a][k] == b.THETA[i][a][k]);
                if (i == 3) {
                    assert_near(b.PSI[i][a][k], 0.0, moving_rounding);
                    assert_near(b.THETA[i][a][k], 0.0, moving_rounding);
                }
            }
    assert_non_null(strstr(rest, "\n0 is port g1, grid 21\n"));
    assert_non_null(strstr(rest, "\n3 is port g4, grid 24\n"));
    assert_non_null(strstr(rest, "craig-bampton, modes 5"));
    free(rest);
}

/* In the frame of its last grid, which the basis attaches, the body has the
   fixed-interface modes of the basis, and Cf = Kf as D = K, to rounding. */
static void clamped_modes_are_those_of_the_basis(void **state)
{
    const moving_body *f = *state;
    flex_body b = {0};
    const ritz_columns *columns = &f->reduced.columns;
    int mode = 0;

    free(read_body("24", NULL, f, &b));
    for (int64_t k = 0; k < columns->count; k++) {
        const double hertz = columns->hertz[k];

        if (!(hertz > 0.0))
            continue;
        assert_near(sqrt(b.Kf[mode][mode]) / (2.0 * 3.14159265358979323846),
                    hertz, 1e-11 * hertz);
        assert_near(b.Cf[mode][mode], b.Kf[mode][mode],
                    1e-11 * b.Kf[mode][mode]);
        mode++;
    }
    assert_int_equal(mode, MODES);
}

/* ---- reports, refusals -------------------------------------------------- */

static ritz_status write_body(const ritz_reduced *reduced, const char *path,
                              const char *frame, const char *reference,
                              ritz_export_report *report)
{
    const ritz_export_request request = {
        .output = path, .frame = frame, .reference = reference};

    return ritz_exporter_42.write(&(ritz_export_object){.reduced = reduced},
                                  &request, report);
}

static void a_long_name_is_warned_of(void **state)
{
    const moving_body *f = *state;
    const char *path = folder_path("a-name-of-a-file-that-42-cannot-hold.txt");
    RITZ_OWN(ritz_export_report) report = {0};
    bool warned = false;

    assert_ok(write_body(&f->reduced, path, NULL, NULL, &report));
    for (int64_t k = 0; k < report.count; k++)
        warned = warned || strncmp(report.line[k], "warning: ", 9) == 0;
    assert_true(warned);
}

static void assert_refused(const ritz_reduced *reduced, const char *frame,
                           const char *reference, const char *words)
{
    const char *path = folder_path("none.txt");
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(write_body(reduced, path, frame, reference, &report),
                 RITZ_ERR_ARGUMENT, words);
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(access(folder_path("none.txt.nodes"), F_OK), -1);
}

static void what_42_cannot_take_is_refused(void **state)
{
    const moving_body *f = *state;
    ritz_reduced other = f->reduced; /* borrowed */

    assert_refused(&f->reduced, NULL, "none", "referred to mean axes");
    assert_refused(&f->reduced, "centre", "none", "name another frame");
    other.T = (ritz_dense){0};
    assert_refused(&other, NULL, NULL, "--without-basis");
}

static ritz_status write_once(const moving_body *f, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_body(&f->reduced, path, "22", NULL, &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(
        write_once(*state, folder_path("Flex.txt")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(integrals_are_sums_over_points),
    cmocka_unit_test(forces_of_42_are_those_of_the_points),
    cmocka_unit_test(joints_move_as_their_grids),
    cmocka_unit_test(clamped_modes_are_those_of_the_basis),
    cmocka_unit_test(a_long_name_is_warned_of),
    cmocka_unit_test(what_42_cannot_take_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(export_42, tests, moving_body_set_up, moving_body_tear_down)
