/*
 * Standard Input Data, read by fixtures/sid_file.c: files of others, a body
 * worked by hand, and what is written.
 */
#include "testing.h"

#include "base/alloc.h"
#include "base/vector.h"
#include "folder.h"
#include "formats/sid.h"
#include "moving_body.h"
#include "sid_file.h"

#include <ritz/basis.h>
#include <ritz/export.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* ---- the reader --------------------------------------------------------- */

static const char *sample_path(const char *variable, const char *name,
                               char path[static 4096])
{
    const char *folder = getenv(variable);

    if (!folder)
        return NULL;
    snprintf(path, 4096, "%s/sid/%s", folder, name);
    return access(path, R_OK) == 0 ? path : NULL;
}

static void the_reader_takes_the_layout(void **state)
{
    (void)state;
    const double s = sqrt(2.0);
    char path[4096];
    const char *sample = sample_path("RITZ_DATA", "stretch.SID_FEM", path);
    RITZ_OWN(sid_file) f = {0};

    assert_non_null(sample);
    sid_file_read(sample, &f);
    assert_int_equal(f.num_nodes, 2);
    assert_int_equal(f.num_modes, 1);
    assert_true(f.mass == 2.0);
    assert_string_equal(f.mode[0], "Eigen Mode    1 :        0.318 Hz");
    assert_int_equal(f.node[1].id, 2);
    assert_true(sid_m0(&f.node[0].at[SID_ORIGIN], 0, 0) == -1.0);
    assert_true(sid_m1(&f.node[1].at[SID_ORIGIN], 0, 0, 0) == sqrt(0.5));
    assert_true(sid_m0(&f.node[1].at[SID_AP], 2, 2) == 1.0);
    assert_true(sid_m1(&f.of[SID_J], 2, 0, 0) == 2.0 * s);
    assert_true(sid_m0(&f.of[SID_ME], 0, 0) == 1.0);
    assert_true(sid_m0(&f.of[SID_GR], 2, 2) == 2.0 * s);
    assert_true(sid_m1(&f.of[SID_OE], 0, 0, 2) == -1.0);
    assert_int_equal(f.longest_mantissa, 19);
}

/* Terms that are made of the same integrals show the order of indices and
 * columns: mdCM and Ct, J and Gr, Cr and Ge, J and Oe. They agree to twelve
 * digits. */
static void check_sample(const sid_file *f)
{
    static const int of_J[6][2] = {{0, 0}, {1, 1}, {2, 2},
                                   {0, 1}, {0, 2}, {1, 2}};
    static const int of_Oe[6] = {0, 1, 2, 3, 5, 4};
    const sid_taylor *J = &f->of[SID_J], *Gr = &f->of[SID_GR];
    const int64_t m = f->num_modes;

    for (int64_t k = 0; k < m; k++)
        for (int i = 0; i < 6; i++) {
            int a = of_J[i][0];
            int b = of_J[i][1];
            double change = sid_m1(J, i, k, 0);

            assert_near(change,
                        (sid_m0(Gr, a, 3 * k + b) + sid_m0(Gr, b, 3 * k + a)) /
                            2.0,
                        1e-10);
            assert_near(sid_m0(&f->of[SID_OE], k, of_Oe[i]),
                        i < 3 ? -change / 2.0 : -change, 1e-10);
            if (i < 3)
                assert_near(sid_m1(&f->of[SID_MDCM], i, k, 0),
                            sid_m0(&f->of[SID_CT], k, i), 1e-10);
        }
    /* columns by axes: these files only, see export_sid.c */
    for (int64_t l = 0; l < m; l++)
        for (int64_t k = 0; k < m; k++)
            for (int a = 0; a < 3; a++)
                assert_near(sid_m0(&f->of[SID_GE], l, a * m + k),
                            2.0 * sid_m1(&f->of[SID_CR], l, k, a), 1e-10);
}

static void check_file(const char *variable, const char *name)
{
    char path[4096];
    const char *sample = sample_path(variable, name, path);
    RITZ_OWN(sid_file) f = {0};

    if (!sample) {
        print_message("no sid/%s in %s\n", name, variable);
        skip();
    }
    sid_file_read(sample, &f);
    check_sample(&f);
}

static void a_third_party_file_has_the_same_order_of_indices(void **state)
{
    (void)state;
    check_file("RITZ_DATA", "balken1m.SID_FEM");
}

/* Four modes in a tangent frame, eleven in mean axes (third-party files). */
static void
larger_third_party_files_have_the_same_order_of_indices(void **state)
{
    (void)state;
    check_file("RITZ_EXTERNAL_DATA", "Beam_3m.SID_FEM");
    check_file("RITZ_EXTERNAL_DATA", "beam.SID_FEM");
}

/* ---- closed form -------------------------------------------------------- */

static ritz_status write_body(const ritz_reduced *reduced, const char *path,
                              const char *frame, const char *reference,
                              ritz_export_report *report)
{
    const ritz_export_request request = {
        .output = path, .frame = frame, .reference = reference};

    return ritz_exporter_sid.write(&(ritz_export_object){.reduced = reduced},
                                   &request, report);
}

/* The body of stretch.SID_FEM. */
static ritz_status make_stretch(ritz_component *out)
{
    const int64_t id[2] = {1, 2}, frame[2] = {0, 0};
    const int64_t row[6] = {0, 3, 0, 3, 0, 0}, col[6] = {0, 0, 3, 3, 0, 0};
    const int64_t each[6] = {0, 1, 2, 3, 4, 5};
    const double K[4] = {2.0, -2.0, -2.0, 2.0}, M[6] = {1, 1, 1, 1, 1, 1};
    const double position[6] = {-1.0, 0.0, 0.0, 1.0, 0.0, 0.0};
    const double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

    out->num_dofs = 6;
    RITZ_CHECK_NEW(out->dof, 6);
    for (int i = 0; i < 6; i++)
        out->dof[i] = (ritz_dof){1 + i / 3, 1 + i % 3};
    RITZ_CHECK(ritz_sparse_from_triplets(6, 6, 4, row, col, K, &out->K));
    RITZ_CHECK(ritz_sparse_from_triplets(6, 6, 6, each, each, M, &out->M));
    out->grids.count = 2;
    out->grids.num_frames = 1;
    RITZ_CHECK_COPY(out->grids.id, id, 2);
    RITZ_CHECK_COPY(out->grids.position, position, 6);
    RITZ_CHECK_COPY(out->grids.frame, frame, 2);
    RITZ_CHECK_COPY(out->grids.axes, axes, 9);
    return ritz_component_settle(out, false);
}

static ritz_status reduce_stretch(ritz_reduced *out)
{
    RITZ_OWN(ritz_component) body = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    RITZ_CHECK(make_stretch(&body));
    RITZ_CHECK(ritz_basis_new(6, 6, &basis));
    for (int64_t i = 0; i < 6; i++)
        ritz_dense_col(&basis.T, i)[i] = 1.0;
    return ritz_reduce(&body, &basis, out);
}

/* Compare two matrices whose values are below 5, to rounding. If the sign of
   the mode differs, terms with an odd power of q change their sign. */
static void assert_taylor(const sid_taylor *a, const sid_taylor *b, double sign,
                          bool odd)
{
    const double of_m0 = odd ? sign : 1.0, of_m1 = odd ? 1.0 : sign;

    assert_int_equal(a->nrow, b->nrow);
    assert_int_equal(a->ncol, b->ncol);
    assert_int_equal(a->order, b->order);
    for (int64_t k = 0; k < a->nrow * a->ncol; k++) {
        assert_near(a->m0[k], of_m0 * b->m0[k], 100 * DBL_EPSILON);
        assert_near(a->m1[k], of_m1 * b->m1[k], 100 * DBL_EPSILON);
    }
}

static void two_masses_are_those_worked_by_hand(void **state)
{
    (void)state;
    /* whether m0 is odd in the mode */
    static const bool odd[SID_OF_BODY] = {
        [SID_CT] = true, [SID_CR] = true, [SID_GR] = true, [SID_OE] = true};
    static const bool node_odd[SID_OF_NODE] = {
        [SID_PHI] = true, [SID_PSI] = true};
    const char *path = folder_path("stretch.SID_FEM");
    char hand[4096];
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(sid_file) mine = {0}, by_hand = {0};
    double sign = 1.0;

    assert_ok(reduce_stretch(&reduced));
    assert_ok(write_body(&reduced, path, NULL, NULL, &report));
    sid_file_read(path, &mine);
    assert_non_null(sample_path("RITZ_DATA", "stretch.SID_FEM", hand));
    sid_file_read(hand, &by_hand);
    assert_int_equal(mine.num_modes, 1);
    assert_int_equal(mine.num_nodes, 2);
    assert_near(mine.mass, 2.0, 4 * DBL_EPSILON);
    sign = sid_m0(&mine.node[1].at[SID_PHI], 0, 0) > 0.0 ? 1.0 : -1.0;
    for (int i = 0; i < SID_OF_BODY; i++)
        assert_taylor(&mine.of[i], &by_hand.of[i], sign, odd[i]);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < SID_OF_NODE; i++)
            assert_taylor(&mine.node[k].at[i], &by_hand.node[k].at[i], sign,
                          node_odd[i]);
}

/* ---- round trip --------------------------------------------------------- */

static void assert_dense(const sid_taylor *t, const ritz_dense *m0,
                         const ritz_dense *m1)
{
    for (int64_t i = 0; i < t->nrow; i++)
        for (int64_t j = 0; j < t->ncol; j++) {
            assert_true(sid_m0(t, i, j) == ritz_dense_col(m0, j)[i]);
            for (int64_t k = 0; m1 && m1->val && k < t->nq; k++)
                assert_true(sid_m1(t, i, k, j) ==
                            ritz_dense_col(m1, k * t->ncol + j)[i]);
        }
}

static void assert_node(const sid_file *f, const sid_body *b, int64_t k)
{
    const sid_node *node = &f->node[k];

    assert_int_equal(node->id, b->normal.floating.id[k]);
    for (int a = 0; a < 3; a++) {
        assert_true(sid_m0(&node->at[SID_ORIGIN], a, 0) ==
                    b->normal.floating.position[3 * k + a]);
        for (int64_t j = 0; j < f->num_modes; j++) {
            double phi = ritz_dense_col(&b->normal.shape, j)[3 * k + a];

            assert_true(sid_m0(&node->at[SID_PHI], a, j) == phi);
            assert_true(sid_m1(&node->at[SID_ORIGIN], a, j, 0) == phi);
            assert_true(sid_m0(&node->at[SID_PSI], a, j) ==
                        ritz_dense_col(&b->normal.turn, j)[3 * k + a]);
        }
    }
}

/* AP v = v + psi x v */
static void assert_turned(const sid_node *node, int64_t j)
{
    double psi[3];

    for (int a = 0; a < 3; a++)
        psi[a] = sid_m0(&node->at[SID_PSI], a, j);
    for (int b = 0; b < 3; b++) {
        const double unit[3] = {b == 0, b == 1, b == 2};
        double moved[3];

        ritz_cross(psi, unit, moved);
        for (int a = 0; a < 3; a++) {
            assert_true(sid_m0(&node->at[SID_AP], a, b) == unit[a]);
            assert_true(sid_m1(&node->at[SID_AP], a, j, b) == moved[a]);
        }
    }
}

static void every_bit_is_read_again(void **state)
{
    const moving_body *f = *state;
    const ritz_export_request request = {0};
    const char *path = folder_path("body.SID_FEM");
    RITZ_OWN(sid_file) file = {0};
    RITZ_OWN(sid_body) b = {0};
    const ritz_sid_terms *t = &b.terms;

    moving_body_write(f, &ritz_exporter_sid, path, NULL, NULL);
    sid_file_read(path, &file);
    assert_ok(sid_body_of(&f->reduced, &request, &b));
    assert_int_equal(file.num_nodes, MOVING_GRIDS);
    assert_int_equal(file.num_modes, MOVING_MODES);
    assert_int_equal(file.longest_mantissa, 19); /* EMBSlib has room for 19 */
    assert_true(file.mass == t->mass);
    for (int64_t k = 0; k < MOVING_GRIDS; k++) {
        assert_node(&file, &b, k);
        for (int64_t j = 0; j < MOVING_MODES; j++)
            assert_turned(&file.node[k], j);
    }
    assert_dense(&file.of[SID_MDCM], &t->mdCM.m0, &t->mdCM.m1);
    assert_dense(&file.of[SID_J], &t->J.m0, &t->J.m1);
    assert_dense(&file.of[SID_CT], &t->Ct.m0, NULL);
    assert_dense(&file.of[SID_CR], &t->Cr.m0, &t->Cr.m1);
    assert_dense(&file.of[SID_GR], &t->Gr.m0, NULL);
    assert_dense(&file.of[SID_GE], &t->Ge.m0, NULL);
    assert_dense(&file.of[SID_OE], &t->Oe.m0, &t->Oe.m1);
    assert_dense(&file.of[SID_DE], &b.normal.D, NULL);
    for (int64_t k = 0; k < MOVING_MODES; k++)
        assert_true(sid_m0(&file.of[SID_KE], k, k) == b.normal.K[k]);
}

/* ---- the title, reports, refusals --------------------------------------- */

static void the_certificate_is_in_the_first_line(void **state)
{
    const moving_body *f = *state;
    const char *path = folder_path("sealed.SID_FEM");
    char text[] = "0123456789abcdef  a\nb.h5";
    char *const input[] = {text};
    char long_command[2000] = "";
    const ritz_stamp stamp = {
        .command = long_command, .num_inputs = 1, .input = input};
    const ritz_export_request request = {.output = path, .stamp = &stamp};
    const ritz_measure first = {.name = "frequency-relative",
                                .value = 1.5e-6,
                                .limit = 1e-3,
                                .where = "mode 7, 3.41 Hz"};
    ritz_measure items[30] = {first};
    ritz_reduced known = f->reduced; /* borrowed */
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(sid_file) file = {0};
    bool said = false;

    memset(long_command, 'J', sizeof long_command - 1);
    /* more than there is room for: the input is there all the same */
    for (int k = 1; k < 30; k++) {
        items[k] = first;
        snprintf(items[k].name, sizeof items[k].name, "measure-%d", k);
    }
    known.errors = (ritz_measures){30, items};
    assert_ok(ritz_exporter_sid.write(&(ritz_export_object){.reduced = &known},
                                      &request, &report));
    sid_file_read(path, &file);
    assert_true(strlen(file.comment) < 1000);
    assert_non_null(strstr(file.comment, "frequency-relative 1.5e-06, limit "
                                         "0.001, at mode 7, 3.41 Hz"));
    assert_non_null(strstr(file.comment, "0123456789abcdef  a?b.h5"));
    assert_null(strstr(file.comment, "JJJ"));
    for (int64_t k = 0; k < report.count; k++)
        said = said || strstr(report.line[k], "lines of the certificate");
    assert_true(said);
}

static void assert_refused(const ritz_reduced *reduced, const char *reference,
                           ritz_status code, const char *words)
{
    const char *path = folder_path("none.SID_FEM");
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(write_body(reduced, path, NULL, reference, &report), code,
                 words);
    assert_int_equal(access(path, F_OK), -1);
}

static void a_body_without_shapes_is_refused(void **state)
{
    const moving_body *f = *state;
    ritz_reduced other = f->reduced; /* borrowed */

    other.T = (ritz_dense){0};
    assert_refused(&other, NULL, RITZ_ERR_ARGUMENT, "--without-basis");
    assert_refused(&f->reduced, "loose", RITZ_ERR_ARGUMENT, "loose");
}

static ritz_status write_once(const moving_body *f, const char *path)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_body(&f->reduced, path, "22", NULL, &report);
}

static void no_allocation_failure_leaks(void **state)
{
    assert_survives_every_allocation(
        write_once(*state, folder_path("body.SID_FEM")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_reader_takes_the_layout),
    cmocka_unit_test(a_third_party_file_has_the_same_order_of_indices),
    cmocka_unit_test(larger_third_party_files_have_the_same_order_of_indices),
    cmocka_unit_test(two_masses_are_those_worked_by_hand),
    cmocka_unit_test(every_bit_is_read_again),
    cmocka_unit_test(the_certificate_is_in_the_first_line),
    cmocka_unit_test(a_body_without_shapes_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(sid, tests, moving_body_set_up, moving_body_tear_down)
