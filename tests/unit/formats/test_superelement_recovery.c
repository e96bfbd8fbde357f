/*
 * Rows of recovery in external superelements that are written: which rows have a
 * place in MES1, MEF1 and MUG1, and what is said of the others. The tables are
 * read back with the matrices, as another component.
 */
#include "testing.h"

#include "bar.h"
#include "damage.h"
#include "folder.h"
#include "scenes.h"

#include "base/alloc.h"

#include <ritz/basis.h>
#include <ritz/export.h>
#include <ritz/import.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct named_row {
    int64_t place;
    const char *part;
} named_row;

/* A quantity of these rows; row i has (i + 1) / 3 of dof i, and dof 5 as well. */
static ritz_status add_rows(ritz_component *c, const char *name,
                            const char *kind, int64_t count,
                            const named_row *rows)
{
    ritz_quantity *q = &c->quantity[c->num_quantities++];
    RITZ_OWN_ARRAY int64_t *row = NULL;
    RITZ_OWN_ARRAY int64_t *col = NULL;
    RITZ_OWN_ARRAY double *val = NULL;

    snprintf(q->name, sizeof q->name, "%s", name);
    snprintf(q->kind, sizeof q->kind, "%s", kind);
    q->count = count;
    RITZ_CHECK_NEW(q->place, count);
    RITZ_CHECK_NEW(q->part, count);
    RITZ_CHECK_NEW(row, 2 * count);
    RITZ_CHECK_NEW(col, 2 * count);
    RITZ_CHECK_NEW(val, 2 * count);
    for (int64_t i = 0; i < count; i++) {
        q->place[i] = rows[i].place;
        snprintf(q->part[i], sizeof q->part[i], "%s", rows[i].part);
        row[2 * i] = row[2 * i + 1] = i;
        col[2 * i] = i + 6;
        col[2 * i + 1] = 5;
        val[2 * i] = (double)(i + 1) / 3.0;
        val[2 * i + 1] = 1e-7 * (double)i;
    }
    return ritz_sparse_from_triplets(count, c->num_dofs, 2 * count, row, col,
                                     val, &q->S);
}

/* Rods 3 and 1, of which the items are mixed; a bar that lacks rows; words of
 * one's own; and an element whose rows are numbered. */
static const named_row forces[] = {
    {3, "crod.torque"}, {3, "crod.axial"}, {7, "sx"},
    {1, "crod.axial"},  {5, "type95.2"},   {1, "crod.torque"},
    {8, "cbar.m1a"},    {5, "type95.1"},   {0, "crod.axial"}};
static const named_row stresses[] = {{12, "celas1.s"}};
static const named_row twice[] = {{12, "celas1.s"}, {4, "celas2.s"}};
static const named_row grids[] = {{9, "T1"}, {9, "T2"}, {9, "T3"}, {9, "R1"},
                                  {9, "R2"}, {9, "R3"}, {5, "T1"}};

static ritz_status make_bar(ritz_reduced *out)
{
    RITZ_OWN(ritz_component) bar = {0};

    RITZ_CHECK(bar_component(20, &bar));
    RITZ_CHECK(add_port(&bar, "left", 1));
    RITZ_CHECK(add_port(&bar, "right", 21));
    RITZ_CHECK_NEW(bar.quantity, 4);
    RITZ_CHECK(add_rows(&bar, "force", "force", 9, forces));
    RITZ_CHECK(add_rows(&bar, "stress", "stress", 1, stresses));
    RITZ_CHECK(add_rows(&bar, "more", "stress", 2, twice));
    RITZ_CHECK(add_rows(&bar, "drift", "displacement", 7, grids));
    return reduce_with(&bar, &ritz_method_craig_bampton, 3, out);
}

static ritz_status write_to(const ritz_reduced *reduced, const char *path,
                            ritz_export_report *report)
{
    const ritz_export_object object = {.reduced = reduced};
    const ritz_stamp stamp = {.command = "ritz-export bar.h5"};
    const ritz_export_request request = {.output = path, .stamp = &stamp};

    return ritz_exporter_superelement.write(&object, &request, report);
}

static bool says(const ritz_export_report *report, const char *words)
{
    for (int64_t k = 0; k < report->count; k++)
        if (strstr(report->line[k], words))
            return true;
    return false;
}

/* Read the files with all that --superelement takes. */
static ritz_status read_back(const char *path, ritz_component *out)
{
    RITZ_OWN(ritz_superelement) found = {0};
    RITZ_OWN(ritz_import_report) report = {0};
    ritz_import_request request = {0};

    RITZ_CHECK(ritz_superelement_find(path, NULL, &found));
    request.stiffness = found.stiffness;
    request.mass = found.mass;
    request.bulk = found.bulk;
    request.num_recoveries = found.num_recoveries;
    request.recovery = (const char *const *)found.recovery;
    request.num_recovery_rows = found.num_recoveries;
    request.recovery_rows = (const char *const *)found.recovery_rows;
    return ritz_import(&request, out, &report);
}

/* Row i of a quantity that was read is row j of one that was written; both
 * ports come first in its coordinates, as they do in EXTRN. */
static void assert_same_row(const ritz_quantity *read, int64_t i,
                            const ritz_quantity *written, int64_t j)
{
    assert_int_equal(read->place[i], written->place[j]);
    assert_string_equal(read->part[i], written->part[j]);
    for (int64_t k = 0; k < written->ST.ncol; k++)
        assert_true(matrix_entry(&read->S, read->S.val, i, k) ==
                    ritz_dense_col(&written->ST, k)[j]);
}

static void whole_elements_come_back_in_every_bit(void **state)
{
    static const int64_t order[] = {3, 5, 1, 0, 7, 4}; /* rods 1, 3; 95: 5 */
    RITZ_OWN(ritz_reduced) bar = {0};
    RITZ_OWN(ritz_component) back = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    (void)state;
    assert_ok(make_bar(&bar));
    assert_ok(write_to(&bar, folder_path("se.op4"), &report));
    assert_ok(read_back(folder_path("se.op4"), &back));
    assert_int_equal(back.num_quantities, 3);
    assert_string_equal(back.quantity[2].kind, "force");
    assert_int_equal(back.quantity[2].count, 6);
    for (int64_t k = 0; k < 6; k++)
        assert_same_row(&back.quantity[2], k, &bar.quantity[0], order[k]);
    assert_string_equal(back.quantity[1].kind, "stress");
    assert_int_equal(back.quantity[1].count, 1); /* 4, as 12 is there twice */
    assert_same_row(&back.quantity[1], 0, &bar.quantity[2], 1);
    assert_int_equal(back.quantity[0].count, 18); /* grids 1, 9 and 21 */
    for (int64_t k = 0; k < 6; k++)
        assert_same_row(&back.quantity[0], 6 + k, &bar.quantity[3], k);
}

static void rows_without_a_place_are_named(void **state)
{
    RITZ_OWN(ritz_reduced) bar = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    (void)state;
    assert_ok(make_bar(&bar));
    assert_ok(write_to(&bar, folder_path("se.op4"), &report));
    assert_true(says(&report, "6 rows of kind force, of 3 elements, are MEF1, "
                              "named by TEF1"));
    assert_true(says(&report,
                     "MEF1 lacks rows that are not whole elements: 'force' "
                     "element 7 sx, 'force' row 9 crod.axial, 'force' element "
                     "8 cbar.m1a"));
    assert_true(says(&report, "1 rows of kind stress, of 1 elements, are "
                              "MES1, named by TES1"));
    assert_true(says(&report, "MES1 lacks rows that are not whole elements: "
                              "'stress' element 12 celas1.s, 'more' element "
                              "12 celas1.s"));
    assert_true(says(&report, "MUG1 lacks rows that are not whole elements: "
                              "'drift' grid 5 T1"));
}

static void many_rows_without_a_place_are_counted(void **state)
{
    static named_row many[14];
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_reduced) reduced = {0};
    RITZ_OWN(ritz_export_report) report = {0};
    RITZ_OWN(ritz_superelement) found = {0};

    (void)state;
    for (int k = 0; k < 14; k++)
        many[k] = (named_row){k + 1, "a_word_of_one's_own"};
    assert_ok(bar_component(20, &bar));
    assert_ok(add_port(&bar, "left", 1));
    assert_non_null(bar.quantity = ritz_zalloc(1, sizeof *bar.quantity));
    assert_ok(add_rows(&bar, "stress", "stress", 14, many));
    assert_ok(reduce_with(&bar, &ritz_method_craig_bampton, 3, &reduced));
    assert_ok(write_to(&reduced, folder_path("many.op4"), &report));
    assert_true(says(&report, "'stress' element 1 a_word_of_one's_own, 'str"));
    assert_true(says(&report, "a_word_of_one's_own, 10 more"));
    assert_ok(ritz_superelement_find(folder_path("many.op4"), NULL, &found));
    assert_int_equal(found.num_recoveries, 1); /* MUG1 alone */
}

/* MES1 multiplies coordinates alone. */
static void mode_acceleration_is_left_out(void **state)
{
    RITZ_OWN(ritz_reduced) bar = {0};
    RITZ_OWN(ritz_export_report) report = {0};

    (void)state;
    assert_ok(make_bar(&bar));
    assert_ok(ritz_dense_copy(&bar.quantity[2].ST, &bar.quantity[2].Q));
    assert_ok(ritz_dense_copy(&bar.quantity[2].ST, &bar.quantity[2].A));
    assert_ok(write_to(&bar, folder_path("se.op4"), &report));
    assert_true(says(&report, "MES1 has these rows by mode displacement: it "
                              "has no place for mode acceleration"));
    assert_false(says(&report, "MEF1 has these rows by mode displacement"));
}

static ritz_status write_once(const ritz_reduced *bar)
{
    RITZ_OWN(ritz_export_report) report = {0};

    return write_to(bar, folder_path("se.op4"), &report);
}

static ritz_status read_once(void)
{
    RITZ_OWN(ritz_component) back = {0};

    return read_back(folder_path("se.op4"), &back);
}

static void every_allocation_may_fail(void **state)
{
    RITZ_OWN(ritz_reduced) bar = {0};

    (void)state;
    assert_ok(make_bar(&bar));
    assert_survives_every_allocation(write_once(&bar));
    assert_survives_every_allocation(read_once());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(whole_elements_come_back_in_every_bit),
    cmocka_unit_test(rows_without_a_place_are_named),
    cmocka_unit_test(many_rows_without_a_place_are_counted),
    cmocka_unit_test(mode_acceleration_is_left_out),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(superelement_recovery, tests, folder_make, folder_remove)
