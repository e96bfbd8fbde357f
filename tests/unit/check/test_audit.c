/*
 * Audit of a lattice of springs, known in closed form, with each fault put in
 * once; of the beam of [McDaniel2000]; of a real plate rounded to few digits.
 */
#include "frame.h"
#include "project.h"
#include "testing.h"

#include <ritz/check.h>
#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/*
 * A tetrahedron with a brace: five grids of three translations and mass 1,
 * springs of stiffness 8 between all of them: free in space, six rigid modes.
 */
enum { GRIDS = 5, ROWS = 3 * GRIDS };

static const double places[GRIDS][3] = {
    {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 2}};

static void add_spring(ritz_dense *K, int a, int b)
{
    double axis[3];
    double square = 0.0;

    for (int i = 0; i < 3; i++) {
        axis[i] = places[b][i] - places[a][i];
        square += axis[i] * axis[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double k = 8.0 * axis[i] * axis[j] / square;

            ritz_dense_col(K, 3 * a + j)[3 * a + i] += k;
            ritz_dense_col(K, 3 * b + j)[3 * b + i] += k;
            ritz_dense_col(K, 3 * a + j)[3 * b + i] -= k;
            ritz_dense_col(K, 3 * b + j)[3 * a + i] -= k;
        }
}

/* Grids 11 to 15; `parts` 2: grid 15 hangs on nothing but a grounded spring. */
static ritz_component lattice(int parts)
{
    ritz_component c = {.num_dofs = ROWS, .grids = {.count = GRIDS}};
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    int64_t whole = parts == 2 ? GRIDS - 1 : GRIDS;

    c.grids.num_frames = 1;
    c.dof = ritz_zalloc(ROWS, sizeof *c.dof);
    c.grids.id = ritz_zalloc(GRIDS, sizeof *c.grids.id);
    c.grids.position = ritz_zalloc(ROWS, sizeof *c.grids.position);
    c.grids.frame = ritz_zalloc(GRIDS, sizeof *c.grids.frame);
    c.grids.axes = ritz_zalloc(9, sizeof *c.grids.axes);
    assert_ok(ritz_dense_new(ROWS, ROWS, &K));
    assert_ok(ritz_dense_new(ROWS, ROWS, &M));
    for (int64_t i = 0; i < 3; i++)
        c.grids.axes[4 * i] = 1.0;
    for (int g = 0; g < GRIDS; g++) {
        c.grids.id[g] = 11 + g;
        for (int i = 0; i < 3; i++) {
            c.grids.position[3 * g + i] = places[g][i];
            c.dof[3 * g + i] = (ritz_dof){11 + g, i + 1};
            ritz_dense_col(&M, 3 * g + i)[3 * g + i] = 1.0;
            if (g >= whole)
                ritz_dense_col(&K, 3 * g + i)[3 * g + i] = 8.0;
        }
    }
    for (int a = 0; a < whole; a++)
        for (int b = 0; b < a; b++)
            add_spring(&K, a, b);
    assert_ok(ritz_sparse_from_dense(&K, &c.K));
    assert_ok(ritz_sparse_from_dense(&M, &c.M));
    assert_ok(ritz_component_settle(&c, false));
    return c;
}

/* Entry (i, i) of a matrix that has it. */
static double *diagonal(ritz_sparse *A, int64_t i)
{
    for (int64_t p = A->colptr[i]; p < A->colptr[i + 1]; p++)
        if (A->rowind[p] == i)
            return &A->val[p];
    fail_msg("no entry (%lld, %lld)", (long long)i, (long long)i);
    return NULL;
}

static void add_port(ritz_component *c, const char *name, int64_t count,
                     const int64_t *row)
{
    ritz_port *port = NULL;

    if (!c->port)
        c->port = ritz_zalloc(4, sizeof *c->port);
    port = &c->port[c->num_ports++];
    snprintf(port->name, sizeof port->name, "%s", name);
    port->dofs.at = ritz_zalloc(count, sizeof *port->dofs.at);
    port->dofs.count = count;
    memcpy(port->dofs.at, row, (size_t)count * sizeof *row);
    for (int64_t i = 0; i < 3; i++)
        port->axes[4 * i] = 1.0;
}

/* Audit, look at one check, and free. */
static void expect(ritz_component *c, const char *name, ritz_verdict verdict,
                   double value, const char *where)
{
    RITZ_OWN(ritz_audit) audit = {0};
    const ritz_check *check = NULL;

    assert_ok(ritz_audit_component(c, &audit));
    check = find_check(&audit, name);
    if (check->verdict != verdict)
        fail_msg("%s: %s: %s", name, ritz_verdict_name(check->verdict),
                 check->says);
    if (!isnan(value))
        assert_near(check->value, value, 1e-12 * fabs(value));
    if (!strstr(check->where, where))
        fail_msg("%s: '%s' does not name '%s'", name, check->where, where);
}

static void a_sound_body_passes_every_check(void **)
{
    const int64_t rows[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    ritz_component c = lattice(1);
    RITZ_OWN(ritz_audit) audit = {0};

    add_port(&c, "base", 9, rows);
    assert_ok(ritz_audit_component(&c, &audit));
    for (int64_t k = 0; k < audit.count; k++)
        if (audit.check[k].verdict != RITZ_PASS)
            fail_msg("%s: %s", audit.check[k].name, audit.check[k].says);
    assert_near(find_check(&audit, "rigid-modes-geometry")->value, 6.0, 0.0);
    assert_near(find_check(&audit, "rigid-modes-null-space")->value, 6.0, 0.0);
    assert_near(find_check(&audit, "rigid-modes-eigenvectors")->value, 6.0,
                0.0);
    assert_non_null(
        strstr(find_check(&audit, "mass-translations")->says, "mass 5,"));
    /* mean of the places: 4/5 each */
    assert_non_null(
        strstr(find_check(&audit, "mass-coupling")->says, "0.8 0.8 0.8"));
    ritz_component_free(&c);
}

static void values_that_are_not_finite_end_the_audit(void **)
{
    ritz_component c = lattice(1);
    RITZ_OWN(ritz_audit) audit = {0};

    *diagonal(&c.K, 4) = nan("");
    assert_ok(ritz_audit_component(&c, &audit));
    assert_int_equal(audit.count, 1);
    assert_int_equal(audit.check[0].verdict, RITZ_FAIL);
    assert_string_equal(audit.check[0].where, "grid 12 T2");
    ritz_component_free(&c);
}

static void averaged_asymmetry_is_remembered(void **)
{
    ritz_component c = lattice(1);

    c.asymmetry = 2e-7;
    expect(&c, "symmetry", RITZ_PASS, 2e-7, "");
    c.asymmetry = 2e-5;
    expect(&c, "symmetry", RITZ_WARN, 2e-5, "");
    ritz_component_free(&c);
}

static void indefinite_matrices_name_a_dof(void **)
{
    ritz_component c = lattice(1);

    *diagonal(&c.M, 7) = -1.0;
    expect(&c, "mass-definite", RITZ_FAIL, -1.0, "grid 13 T2");
    ritz_component_free(&c);
    /* without half of what holds it, a grid is pushed away by the others */
    c = lattice(1);
    *diagonal(&c.K, 14) *= 0.25;
    expect(&c, "stiffness-definite", RITZ_FAIL, 1.0, "grid");
    ritz_component_free(&c);
}

static void empty_rows_are_named(void **)
{
    ritz_component c = lattice(1);

    *diagonal(&c.M, 3) = 0.0;
    expect(&c, "massless-dofs", RITZ_WARN, 1.0, "grid 12 T1");
    expect(&c, "mass-translations", RITZ_FAIL, 0.2, ""); /* 4 of 5 along x */
    ritz_component_free(&c);
    c = lattice(2);
    *diagonal(&c.K, 13) = 0.0;
    expect(&c, "unconnected-dofs", RITZ_WARN, 1.0, "grid 15 T2");
    ritz_component_free(&c);
}

static void separate_parts_are_counted_and_named(void **)
{
    const int64_t rows[] = {12, 13, 14};
    ritz_component c = lattice(2);

    expect(&c, "separate-bodies", RITZ_WARN, 2.0, "grid 15");
    add_port(&c, "loose", 3, rows);
    expect(&c, "port-disconnected", RITZ_FAIL, 3.0, "grid 15 T1");
    expect(&c, "port-dofs", RITZ_WARN, 3.0, "loose");
    ritz_component_free(&c);
}

/* One spring of 8 to the ground: a force of 8 meets a unit translation. */
static void a_held_body_shows_where(void **)
{
    ritz_component c = lattice(1);

    *diagonal(&c.K, 6) += 8.0;
    expect(&c, "grounding-translation", RITZ_WARN, 8.0, "grid 13 T1");
    expect(&c, "rigid-modes-geometry", RITZ_PASS, 5.0, "");
    expect(&c, "rigid-modes-eigenvectors", RITZ_PASS, 5.0, "");
    expect(&c, "rigid-modes-null-space", RITZ_PASS, 5.0, "");
    ritz_component_free(&c);
}

/* Moved in the list but not in the matrices: rotations are no longer free. */
static void a_wrong_position_is_noticed(void **)
{
    ritz_component c = lattice(1);

    c.grids.position[12] = 2.5;
    expect(&c, "rigid-modes-eigenvectors", RITZ_PASS, 6.0, "");
    expect(&c, "rigid-modes-agree", RITZ_WARN, nan(""), "");
    expect(&c, "grounding-rotation", RITZ_WARN, nan(""), "grid");
    expect(&c, "grounding-translation", RITZ_PASS, nan(""), "");
    ritz_component_free(&c);
}

static void missing_positions_leave_the_translations(void **)
{
    ritz_component c = lattice(1);

    ritz_grids_free(&c.grids);
    expect(&c, "positions", RITZ_WARN, 15.0, "grid 11 T1");
    expect(&c, "rigid-modes-geometry", RITZ_PASS, 3.0, "");
    expect(&c, "rigid-modes-agree", RITZ_PASS, nan(""), "");
    ritz_component_free(&c);
}

/* m_xy couples translations: no body has that about its own axes. */
static void mass_that_couples_translations_is_refused(void **)
{
    ritz_component c = lattice(1);
    int64_t row[ROWS + 2];
    int64_t col[ROWS + 2];
    double val[ROWS + 2];

    for (int k = 0; k < ROWS; k++) {
        row[k] = col[k] = k;
        val[k] = 1.0;
    }
    row[ROWS] = col[ROWS + 1] = 0;
    col[ROWS] = row[ROWS + 1] = 1;
    val[ROWS] = val[ROWS + 1] = 0.5;
    ritz_sparse_free(&c.M);
    assert_ok(
        ritz_sparse_from_triplets(ROWS, ROWS, ROWS + 2, row, col, val, &c.M));
    expect(&c, "mass-coupling", RITZ_FAIL, 0.1, ""); /* 0.5 of 5 */
    ritz_component_free(&c);
}

/* Grids 12 and 13 are two points, and two points are a line. */
static void ports_are_looked_at(void **)
{
    const int64_t line[] = {3, 4, 5, 6, 7, 8};
    const int64_t more[] = {6, 7, 8, 9, 10, 11, 12, 13, 14};
    ritz_component c = lattice(1);

    add_port(&c, "line", 6, line);
    add_port(&c, "plane", 9, more);
    expect(&c, "port-collinear", RITZ_WARN, nan(""), "line");
    expect(&c, "port-dependent", RITZ_WARN, 3.0, "grid 13 T1");
    expect(&c, "port-positions", RITZ_PASS, 0.0, "");
    memcpy(c.grids.position + 9, c.grids.position + 12,
           3 * sizeof *c.grids.position);
    expect(&c, "port-positions", RITZ_WARN, 3.0, "grid 15");
    ritz_component_free(&c);
}

/* In the plane there are three rigid motions, of a clamped beam none. */
static void beams_in_the_plane_have_three_motions(void **)
{
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, false, false, 1, &c));
    expect(&c, "rigid-modes-geometry", RITZ_PASS, 3.0, "");
    expect(&c, "rigid-modes-eigenvectors", RITZ_PASS, 3.0, "");
    expect(&c, "rigid-modes-agree", RITZ_PASS, nan(""), "");
    expect(&c, "mass-translations", RITZ_PASS, nan(""), "");
    expect(&c, "mass-coupling", RITZ_PASS, nan(""), "");
    ritz_component_free(&c);
    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, true, false, 1, &c));
    expect(&c, "rigid-modes-geometry", RITZ_PASS, 0.0, "");
    expect(&c, "rigid-modes-eigenvectors", RITZ_PASS, 0.0, "");
    expect(&c, "grounding-translation", RITZ_WARN, nan(""), "grid 2");
}

static void stiffness_that_was_forgotten_is_noticed(void **)
{
    ritz_component c = lattice(1);

    ritz_sparse_free(&c.K);
    assert_ok(ritz_component_settle(&c, false));
    expect(&c, "rigid-modes-eigenvectors", RITZ_FAIL, 15.0, "");
    ritz_component_free(&c);
}

static ritz_status audit_and_free(const ritz_component *c)
{
    RITZ_OWN(ritz_audit) audit = {0};
    ritz_status status = ritz_audit_component(c, &audit);

    return status;
}

static void no_allocation_failure_leaks(void **)
{
    const int64_t rows[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    ritz_component c = lattice(1);

    add_port(&c, "base", 9, rows);
    assert_survives_every_allocation(audit_and_free(&c));
    ritz_component_free(&c);
}

/* The plate of oracles.md section 7 with an identity as mass. */
static bool read_plate(ritz_component *c)
{
    const char *where = getenv("RITZ_EXTERNAL_DATA");
    char path[512];
    char mass[] = "/tmp/ritz-audit-XXXXXX";
    int handle = -1;
    FILE *file = NULL;
    ritz_import_request request = {.stiffness = path, .mass = mass};
    RITZ_OWN(ritz_import_report) report = {0};

    if (!where) {
        print_message("skipped: no RITZ_EXTERNAL_DATA\n");
        return false;
    }
    snprintf(path, sizeof path, "%s/nastran/pynastran/testplate_kgg_ascii.op4",
             where);
    handle = mkstemp(mass);
    assert_true(handle >= 0);
    file = fdopen(handle, "w");
    fprintf(file, "%%%%MatrixMarket matrix coordinate real symmetric\n"
                  "726 726 726\n");
    for (int k = 1; k <= 726; k++)
        fprintf(file, "%d %d 1\n", k, k);
    fclose(file);
    assert_ok(ritz_import(&request, c, &report));
    unlink(mass);
    return true;
}

static void round_to(ritz_sparse *A, int digits)
{
    char text[40];

    for (int64_t p = 0; A->colptr && p < A->colptr[A->ncol]; p++) {
        snprintf(text, sizeof text, "%.*e", digits - 1, A->val[p]);
        A->val[p] = strtod(text, NULL);
    }
}

/*
 * Printed to one digit: 4e-2 at ten digits, 4e3 at five. Not one but the body
 * is free, and no verdict may call it so.
 */
static void few_digits_hold_a_free_plate(void **)
{
    const struct {
        int digits;
        double force;
    } cases[] = {{10, 4e-2}, {5, 4e3}};

    for (size_t k = 0; k < 2; k++) {
        RITZ_OWN(ritz_component) c = {0};
        RITZ_OWN(ritz_audit) audit = {0};
        const ritz_check *check = NULL;

        if (!read_plate(&c))
            skip();
        round_to(&c.K, cases[k].digits);
        assert_ok(ritz_audit_component(&c, &audit));
        check = find_check(&audit, "grounding-translation");
        /* half a unit of the one digit printed */
        assert_near(check->value, cases[k].force, 0.125 * cases[k].force);
        assert_int_equal(check->verdict, RITZ_FAIL);
        assert_non_null(strstr(check->says, "a free body is not free"));
        check = find_check(&audit, "source-digits");
        assert_near(check->value, cases[k].digits, 0.0);
        assert_int_equal(check->verdict, RITZ_FAIL);
        check = find_check(&audit, "stiffness-definite");
        assert_int_equal(check->verdict, RITZ_WARN);
        assert_true(check->value >= 1.0);
        assert_int_equal(find_check(&audit, "rigid-modes-geometry")->verdict,
                         RITZ_FAIL);
    }
}

/* Grids from single-precision input: nothing fails, SOURCE.md of the demo. */
static void the_demo_does_not_fail(void **)
{
    const char *where = getenv("RITZ_DATA");
    static const char *const names[] = {"rotor", "stator"};

    if (!where) {
        print_message("skipped: no RITZ_DATA\n");
        skip();
    }
    for (size_t k = 0; k < 2; k++) {
        char K[512];
        char M[512];
        char deck[512];
        const ritz_import_request request = {
            .stiffness = K, .mass = M, .bulk = deck};
        RITZ_OWN(ritz_import_report) report = {0};
        RITZ_OWN(ritz_component) c = {0};
        RITZ_OWN(ritz_audit) audit = {0};

        snprintf(K, sizeof K, "%s/dualspin/%s.op4:KGG", where, names[k]);
        snprintf(M, sizeof M, "%s/dualspin/%s.op4:MGG", where, names[k]);
        snprintf(deck, sizeof deck, "%s/dualspin/%s.bdf", where, names[k]);
        assert_ok(ritz_import(&request, &c, &report));
        assert_ok(ritz_audit_component(&c, &audit));
        for (int64_t i = 0; i < audit.count; i++)
            assert_int_equal(audit.check[i].verdict, RITZ_PASS);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_sound_body_passes_every_check),
    cmocka_unit_test(values_that_are_not_finite_end_the_audit),
    cmocka_unit_test(averaged_asymmetry_is_remembered),
    cmocka_unit_test(indefinite_matrices_name_a_dof),
    cmocka_unit_test(empty_rows_are_named),
    cmocka_unit_test(separate_parts_are_counted_and_named),
    cmocka_unit_test(a_held_body_shows_where),
    cmocka_unit_test(a_wrong_position_is_noticed),
    cmocka_unit_test(missing_positions_leave_the_translations),
    cmocka_unit_test(mass_that_couples_translations_is_refused),
    cmocka_unit_test(ports_are_looked_at),
    cmocka_unit_test(beams_in_the_plane_have_three_motions),
    cmocka_unit_test(stiffness_that_was_forgotten_is_noticed),
    cmocka_unit_test(no_allocation_failure_leaks),
    cmocka_unit_test(few_digits_hold_a_free_plate),
    cmocka_unit_test(the_demo_does_not_fail),
};

TEST_MODULE(audit, tests, NULL, NULL)
