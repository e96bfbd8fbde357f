/*
 * External superelements that are written: the cards of a small component, its
 * matrices bit for bit, refusals. Decks and OUTPUT4 are read back by readers
 * that do not come from the writer, and whole components by ritz_import.
 */
#include "testing.h"

#include "bar.h"
#include "damage.h"
#include "folder.h"
#include "foreign.h"
#include "scenes.h"

#include "base/alloc.h"

#include <ritz/basis.h>
#include <ritz/export.h>
#include <ritz/import.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ORDER = 3, DOFS = 4 };

static const double third = 1.0 / 3.0;

static ritz_status put_values(const double *value, ritz_dense *out)
{
    RITZ_CHECK(ritz_dense_new(ORDER, ORDER, out));
    memcpy(out->val, value, ORDER * ORDER * sizeof *value);
    return RITZ_OK;
}

/* Grid 11 at (0, 1/3, -2), and grid 12 with axes (y, z, x). */
static ritz_status make_grids(ritz_grids *out)
{
    static const int64_t id[] = {11, 12, 13};
    static const double position[] = {0.0, 0.0, -2.0, 1.0, 0.0,
                                      0.0, 0.0, 5.0,  0.0};
    static const int64_t frame[] = {0, 1, 0};
    static const double axes[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0,
                                  0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0};

    out->count = 3;
    out->num_frames = 2;
    RITZ_CHECK_COPY(out->id, id, 3);
    RITZ_CHECK_COPY(out->position, position, 9);
    RITZ_CHECK_COPY(out->frame, frame, 3);
    RITZ_CHECK_COPY(out->axes, axes, 18);
    out->position[1] = third;
    return RITZ_OK;
}

/* A port of grid 11 and the free grid 13, of which R1 is twice T2 of 13. */
static ritz_status make_port(ritz_reduced *out)
{
    static const ritz_dof dof[] = {{11, 1}, {13, 2}};
    static const ritz_dof recovered[] = {{13, 4}};
    static const int64_t zero[] = {0};
    static const int64_t from[] = {2};
    static const double twice[] = {2.0};
    ritz_port_map *port = NULL;

    RITZ_CHECK_NEW(out->port, 1);
    port = &out->port[out->num_ports++];
    snprintf(port->name, sizeof port->name, "ends");
    port->count = 2;
    RITZ_CHECK_COPY(port->dof, dof, 2);
    out->recovery.count = 1;
    RITZ_CHECK_COPY(out->recovery.dof, recovered, 1);
    return ritz_sparse_from_triplets(1, DOFS, 1, zero, from, twice,
                                     &out->recovery.G);
}

/* The coordinates are grid 12 T3, a mode and grid 11 T1. The mode moves 13
   T2. */
static ritz_status make_small(ritz_reduced *out)
{
    static const ritz_dof dof[] = {{11, 1}, {12, 3}, {13, 2}, {13, 3}};
    static const int64_t row[] = {1, -1, 0};
    const double K[] = {4.0, 0.0, -third, 0.0, 1e7, 0.0, -third, 0.0, 2.0};
    const double M[] = {2.0, 0.0, 0.0, 0.0, 1.0, third, 0.0, third, 3.0};

    RITZ_CHECK(put_values(K, &out->K));
    RITZ_CHECK(put_values(M, &out->M));
    RITZ_CHECK(ritz_dense_new(DOFS, ORDER, &out->T));
    RITZ_CHECK(ritz_columns_new(ORDER, &out->columns));
    out->num_dofs = DOFS;
    RITZ_CHECK_COPY(out->dof, dof, DOFS);
    for (int64_t j = 0; j < ORDER; j++) {
        ritz_dense_col(&out->T, j)[row[j] < 0 ? 2 : row[j]] = 1.0;
        out->columns.dof[j] = row[j];
        if (row[j] >= 0)
            out->columns.kind[j] = RITZ_COLUMN_CONSTRAINT;
    }
    ritz_dense_col(&out->T, 0)[2] = 0.25;
    RITZ_CHECK(make_grids(&out->grids));
    RITZ_CHECK(make_port(out));
    return ritz_measures_add(&out->errors, "frequency-relative", 1.25e-3,
                             nan(""), "mode 7, 3.41 Hz");
}

static ritz_status write_to(const ritz_reduced *reduced, const char *path,
                            const ritz_export_request *style,
                            ritz_export_report *report)
{
    const ritz_export_object object = {.reduced = reduced};
    const ritz_stamp stamp = {.command = "ritz-export small.h5"};
    ritz_export_request request = {0};

    if (style)
        request = *style;
    request.output = path;
    request.stamp = &stamp;
    return ritz_exporter_superelement.write(&object, &request, report);
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

/* Read a deck and leave out its comments. */
static char *cards_of(const char *name)
{
    char *text = NULL;
    char *to = NULL;

    assert_ok(ritz_text_read(folder_path(name), &text));
    to = text;
    for (char *at = text; *at;) {
        char *end = strchr(at, '\n');
        const size_t length = end ? (size_t)(end - at) + 1 : strlen(at);

        if (*at != '$') {
            memmove(to, at, length);
            to += length;
        }
        at += length;
    }
    *to = '\0';
    return text;
}

#define GEOMETRY                                                               \
    "CORD2R*             1001               0              0.              "   \
    "0.\n"                                                                     \
    "*                     0.              1.              0.              "   \
    "0.\n"                                                                     \
    "*                     0.              1.              0.\n"               \
    "GRID*                 11               0              0."                 \
    ".333333333333333\n"                                                       \
    "*                    -2.               0\n"                               \
    "GRID*                 12               0              1.              "   \
    "0.\n"                                                                     \
    "*                     0.            1001\n"

static void the_small_component_has_these_cards(void **state)
{
    static const char assembly[] =
        "SEBULK         7  EXTOP4          MANUAL                       7\n"
        "SECONCT        7       0                                              "
        "  "
        "\n"
        "              11      11      12      12    1001    1001\n" GEOMETRY
        "SPOINT      1001\n";
    static const char part[] =
        "BEGIN SUPER       7\n"
        "EXTRN         11       1      12       3    1001       0\n" GEOMETRY
        "ASET          11       1\n"
        "ASET          12       3\n"
        "QSET1          0    1001\n"
        "SPOINT      1001\n"
        "DTI         TUG1       0      12       3   32767       0       7      "
        " "
        "0\n"
        "            PHIP               7                    REAL       1  "
        "ENDREC\n"
        "DTI         TUG1       1       1     0.0       2     0.0       3     "
        "0.0\n"
        "          ENDREC\n"
        "DTI         TUG1       2                                              "
        "  "
        "\n"
        "            TYPE      ID    COMP     ROW    TYPE      ID    COMP     "
        "ROW\n"
        "               1      11       6       1       1      13       6      "
        " "
        "7\n"
        "          ENDREC\n";
    const ritz_export_request style = {.id = 7};
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN_ARRAY char *asm_cards = NULL;
    RITZ_OWN_ARRAY char *pch_cards = NULL;
    RITZ_OWN_ARRAY char *text = NULL;

    (void)state;
    assert_ok(make_small(&small));
    assert_ok(write_to(&small, folder_path("small.op4"), &style, &report));
    asm_cards = cards_of("small.asm");
    assert_string_equal(asm_cards, assembly);
    pch_cards = cards_of("small.pch");
    assert_string_equal(pch_cards, part);
    assert_ok(ritz_text_read(folder_path("small.pch"), &text));
    assert_non_null(strstr(text, "$ command: ritz-export small.h5\n"));
    assert_non_null(strstr(text, "$ error, measured: frequency-relative "
                                 "0.00125, at mode 7, 3.41 Hz\n"));
    assert_true(says(&report, "SPOINT 1001 to 1001"));
    assert_true(says(&report, "axes of grids are CORD2R 1001 to 1001, new"));
    assert_true(says(&report, "ASSIGN INPUTT4='small.op4' UNIT=7 in the"));
    assert_true(says(&report, "INCLUDE 'small.asm' in the main bulk data, "
                              "INCLUDE 'small.pch' behind it"));
    assert_true(says(&report, "port 'ends' was not attached"));
    assert_true(says(&report, "displacements of the 2 grids and points"));
}

/* ---- matrices ------------------------------------------------------------ */

static void check_member(const ritz_matrices *all, int64_t k, const char *name,
                         int64_t nrow, int64_t ncol)
{
    assert_string_equal(all->matrix[k].name, name);
    assert_int_equal(all->matrix[k].A.nrow, nrow);
    assert_int_equal(all->matrix[k].A.ncol, ncol);
}

static double value(const ritz_matrix *m, int64_t i, int64_t j)
{
    return matrix_entry(&m->A, m->A.val, i, j);
}

/* Rows are in the order 11 T1, 12 T3, 1001: coordinates 2, 0, 1. */
static void check_matrices(const ritz_reduced *small, const char *path)
{
    static const int64_t place[] = {2, 0, 1};
    RITZ_OWN(ritz_matrices) all = {0};

    assert_ok(foreign_read(path, &all));
    assert_int_equal(all.count, 23);
    check_member(&all, 0, "KAA", 3, 3);
    check_member(&all, 1, "MAA", 3, 3);
    check_member(&all, 2, "BAA", 1, 1);
    check_member(&all, 3, "K4XX", 1, 1);
    check_member(&all, 8, "VA", 3, 1);
    check_member(&all, 9, "MUG1", 12, 3);
    check_member(&all, 22, "MQMG1O", 1, 1);
    assert_true(all.matrix[0].symmetric);
    for (int64_t k = 0; k < 9; k++) {
        const int64_t i = k % 3;
        const int64_t j = k / 3;
        const int64_t from = place[i] + ORDER * place[j];

        assert_true(value(&all.matrix[0], i, j) == small->K.val[from]);
        assert_true(value(&all.matrix[1], i, j) == small->M.val[from]);
    }
    for (int64_t i = 0; i < 3; i++)
        assert_true(value(&all.matrix[8], i, 0) == 1.0);
    for (int64_t j = 0; j < 3; j++) { /* u of 11 T1, 13 T2, 13 R1 */
        const double u = j == 1 ? 0.25 : j == 2;

        assert_true(value(&all.matrix[9], 0, j) == (j == 0));
        assert_true(value(&all.matrix[9], 7, j) == u);
        assert_true(value(&all.matrix[9], 9, j) == 2.0 * u);
        assert_true(value(&all.matrix[9], 8, j) == 0.0);
    }
}

static void matrices_come_back_in_every_bit(void **state)
{
    const ritz_export_request styles[] = {
        {0}, {.dense = true}, {.text = true}, {.text = true, .dense = true}};
    RITZ_OWN(ritz_reduced) small = {0};

    (void)state;
    assert_ok(make_small(&small));
    for (size_t k = 0; k < sizeof styles / sizeof *styles; k++) {
        RITZ_OWN(ritz_export_report) report = {0};

        assert_ok(
            write_to(&small, folder_path("bits.op4"), &styles[k], &report));
        check_matrices(&small, folder_path("bits.op4"));
        assert_false(says(&report, "digits: values are rounded"));
    }
}

/* The body is the small one with a scalar point in place of grid 11. */
static void scalar_points_may_be_attached(void **state)
{
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN_ARRAY char *cards = NULL;

    (void)state;
    assert_ok(make_small(&small));
    small.dof[0].component = 0;
    small.port[0].dof[0].component = 0;
    assert_ok(write_to(&small, folder_path("points.op4"), NULL, &report));
    cards = cards_of("points.pch");
    assert_non_null(
        strstr(cards, "EXTRN         11       0      12       3    1001"));
    assert_non_null(strstr(cards, "ASET          11       0\n"));
    assert_non_null(strstr(cards, "SPOINT        11\nSPOINT      1001\n"));
    assert_null(strstr(cards, "GRID*                 11"));
    assert_non_null(strstr(cards, "DTI         TUG1       0      12       3 "));
    assert_non_null(strstr(cards, "       2      11       6       1       1 "
                                  "     13       6       7\n"));
}

static void rounding_to_few_digits_is_reported(void **state)
{
    const ritz_export_request style = {.text = true, .digits = 9};
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_matrix) K = {0};
    char spec[600];

    (void)state;
    assert_ok(make_small(&small));
    assert_ok(write_to(&small, folder_path("nine.op4"), &style, &report));
    assert_true(says(&report, "9 digits: values are rounded"));
    snprintf(spec, sizeof spec, "%s:KAA", folder_path("nine.op4"));
    assert_ok(foreign_select(spec, &K));
    assert_true(value(&K, 0, 1) == -0.333333333);
}

/* A bar that craig-bampton reduced is written, imported again and compared. */
static void a_bar_comes_back_as_it_was(void **state)
{
    RITZ_OWN(ritz_component) bar = {0}, back = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_import_report) done = {0};
    RITZ_OWN(ritz_superelement) found = {0};
    ritz_import_request request = {0};

    (void)state;
    assert_ok(bar_component(20, &bar));
    assert_ok(add_port(&bar, "left", 1));
    assert_ok(add_port(&bar, "right", 21));
    assert_ok(reduce_with(&bar, &ritz_method_craig_bampton, 6, &reduced));
    snprintf(reduced.damping, sizeof reduced.damping, "modal 0.02");
    assert_ok(write_to(&reduced, folder_path("bar.op4"), NULL, &report));
    assert_true(says(&report, "damping 'modal 0.02' is in D"));
    assert_ok(ritz_superelement_find(folder_path("bar.op4"), NULL, &found));
    assert_string_equal(found.bulk, folder_path("bar.pch"));
    assert_non_null(found.damping);
    assert_null(found.structural_damping);
    request.stiffness = found.stiffness;
    request.mass = found.mass;
    request.damping = found.damping;
    request.bulk = found.bulk;
    assert_ok(ritz_import(&request, &back, &done));
    assert_string_equal(done.map, "EXTRN");
    assert_int_equal(back.num_dofs, 8);
    assert_int_equal(back.dof[0].grid, 1);
    assert_int_equal(back.dof[1].grid, 21);
    assert_int_equal(back.dof[2].grid, 1001);
    assert_int_equal(back.dof[2].component, 0);
    assert_int_equal(back.grids.count, 2);
    for (int64_t i = 0; i < 8; i++)
        for (int64_t j = 0; j < 8; j++) {
            const double k = ritz_dense_col(&reduced.K, j)[i];
            const double l = ritz_dense_col(&reduced.K, i)[j];

            /* the mean of both triangles, which differ by rounding */
            assert_true(matrix_entry(&back.K, back.K.val, i, j) ==
                        k / 2.0 + l / 2.0);
        }
}

/* ---- what is refused ----------------------------------------------------- */

static void assert_refused(const ritz_reduced *small, const char *name,
                           const char *words)
{
    RITZ_OWN(ritz_export_report) report = {0};

    assert_fails(write_to(small, folder_path(name), NULL, &report),
                 RITZ_ERR_ARGUMENT, words);
    assert_int_equal(access(folder_path("no.op4"), F_OK), -1);
    assert_int_equal(access(folder_path("no.asm"), F_OK), -1);
    assert_int_equal(access(folder_path("no.pch"), F_OK), -1);
}

static void what_is_no_superelement_is_refused(void **state)
{
    const double K4[] = {1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    RITZ_OWN(ritz_reduced) small = {0};

    (void)state;
    assert_ok(make_small(&small));
    assert_refused(&small, "no.bdf",
                   "no.bdf' does not end with .op4: a "
                   "superelement is the files NAME.op4, "
                   "NAME.asm and NAME.pch");
    assert_refused(&small, ".op4", "does not end with .op4");
    assert_ok(put_values(K4, &small.K4));
    assert_refused(&small, "no.op4",
                   "'K4' is not symmetric, and NASTRAN takes "
                   "no such superelement");
    ritz_dense_free(&small.K4);
    small.M.val[0] = nan("");
    assert_refused(&small, "no.op4", "is not finite");
    small.M.val[0] = 2.0;
    small.grids.count = 1;
    assert_refused(&small, "no.op4",
                   "grid 12 has no position, and a "
                   "superelement is placed by those of its "
                   "grids: import the component with --bulk");
    small.grids.count = 3;
    ritz_dense_col(&small.T, 1)[0] = 0.5;
    assert_refused(&small, "no.op4",
                   "grid 11 T1 is attached, but no "
                   "coordinate is its displacement, as a "
                   "superelement wants it");
    small.columns.dof[0] = small.columns.dof[2] = -1;
    assert_refused(&small, "no.op4", "by which a superelement is joined");
    ritz_dense_free(&small.T);
    assert_refused(&small, "no.op4", "it was made --without-basis");
}

static void all_three_files_are_there_or_none(void **state)
{
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    (void)state;
    assert_ok(make_small(&small));
    assert_int_equal(mkdir(folder_path("half.pch"), 0700), 0);
    assert_fails(write_to(&small, folder_path("half.op4"), NULL, &report),
                 RITZ_ERR_FILE, "half.pch");
    assert_int_equal(access(folder_path("half.op4"), F_OK), -1);
    assert_int_equal(access(folder_path("half.asm"), F_OK), -1);
    assert_int_equal(rmdir(folder_path("half.pch")), 0);
}

static void a_number_is_for_superelements(void **state)
{
    const ritz_export_request request = {.output = "x.op4", .id = 5};

    (void)state;
    assert_ok(ritz_export_check(&ritz_exporter_superelement, &request));
    assert_fails(ritz_export_check(&ritz_exporter_output4, &request),
                 RITZ_ERR_ARGUMENT, "output4 has no superelement to number");
}

static ritz_status read_deck(const char *bytes, int64_t size)
{
    RITZ_OWN(ritz_deck) deck = {0};
    char text[4096];

    assert_true(size < (int64_t)sizeof text);
    memcpy(text, bytes, (size_t)size);
    text[size] = '\0';
    return ritz_deck_parse("small.pch", text, size, NULL, &deck);
}

static void written_decks_are_read_or_refused_wherever_cut(void **state)
{
    RITZ_OWN(ritz_reduced) small = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    (void)state;
    assert_ok(make_small(&small));
    assert_ok(write_to(&small, folder_path("cut.op4"), NULL, &report));
    for (int k = 0; k < 2; k++) {
        RITZ_OWN_ARRAY char *cards = cards_of(k ? "cut.asm" : "cut.pch");

        damage_cut(read_deck, cards, (int64_t)strlen(cards));
    }
}

static ritz_status write_once(const ritz_reduced *small)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_to(small, folder_path("denied.op4"), NULL, &report);
}

static void survives_failing_allocations(void **state)
{
    RITZ_OWN(ritz_reduced) small = {0};

    (void)state;
    assert_ok(make_small(&small));
    assert_survives_every_allocation(write_once(&small));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_small_component_has_these_cards),
    cmocka_unit_test(matrices_come_back_in_every_bit),
    cmocka_unit_test(scalar_points_may_be_attached),
    cmocka_unit_test(rounding_to_few_digits_is_reported),
    cmocka_unit_test(a_bar_comes_back_as_it_was),
    cmocka_unit_test(what_is_no_superelement_is_refused),
    cmocka_unit_test(all_three_files_are_there_or_none),
    cmocka_unit_test(a_number_is_for_superelements),
    cmocka_unit_test(written_decks_are_read_or_refused_wherever_cut),
    cmocka_unit_test(survives_failing_allocations),
};

TEST_MODULE(superelement, tests, folder_make, folder_remove)
