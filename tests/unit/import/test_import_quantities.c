/* Quantities to recover that are read from matrix files, and the labels of
   their rows. */
#include "testing.h"

#include "folder.h"
#include "matrix_files.h"

#include <ritz/import.h>
#include <ritz/matrix.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define ARRAY "%%MatrixMarket matrix array real general\n"

/* Three scalar points, and two rows of stresses of them. */
static ritz_import_request request_of(const char *const *recovery)
{
    return (ritz_import_request){.mass = put_diagonal("m.mtx", 3, NULL),
                                 .rows = "0",
                                 .num_recoveries = 1,
                                 .recovery = recovery};
}

/* "stress=FILE:..." with the file in the test's folder. */
static const char *spell(const char *name, const char *path, const char *rest)
{
    static char text[16][4096];
    static int next;
    char *out = text[next++ % 16];

    snprintf(out, sizeof text[0], "%s=%s%s", name, path, rest);
    return out;
}

static const char *put_rows(void)
{
    return folder_write("s.mtx", ARRAY "2 3\n1\n2\n0\n4\n5\n6\n");
}

static void rows_come_with_their_names(void **)
{
    const char *const names = folder_write("s.txt", "# element, word\n"
                                                    "12 sx\n\n"
                                                    "7, sy # shear\n");
    const char *const recovery[] = {spell("stress", put_rows(), "")};
    const char *const rows[] = {spell("stress", names, "")};
    ritz_import_request request = request_of(recovery);
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_dense) S = {0};
    const ritz_quantity *q = NULL;

    request.num_recovery_rows = 1;
    request.recovery_rows = rows;
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_quantities, 1);
    q = c.quantity;
    assert_string_equal(q->name, "stress");
    assert_string_equal(q->kind, "stress"); /* by its name */
    assert_int_equal(q->count, 2);
    assert_int_equal(q->place[0], 12);
    assert_int_equal(q->place[1], 7);
    assert_string_equal(q->part[1], "sy");
    assert_int_equal(q->S.colptr[3], 5); /* zeros are not stored */
    assert_ok(ritz_sparse_dense(&q->S, &S));
    for (int64_t k = 0; k < 6; k++)
        assert_near(S.val[k], k == 2 ? 0.0 : (double)(k + 1), 0.0);
}

/* The matrix may have its rows as rows or as columns, in any format of
   matrices; the kind follows a comma. */
static void rows_may_be_columns(void **)
{
    const char *const turned =
        folder_write("t.mtx", ARRAY "3 2\n1\n0\n5\n2\n4\n6\n");
    const char *const recovery[] = {spell("mug1", turned, ",displacement")};
    const ritz_import_request request = request_of(recovery);
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    assert_ok(ritz_import(&request, &c, &report));
    assert_string_equal(c.quantity->kind, "displacement");
    assert_int_equal(c.quantity->count, 2);
    assert_int_equal(c.quantity->place[0], 0);
    assert_string_equal(c.quantity->part[0], "");
    assert_near(c.quantity->S.val[0], 1.0, 0.0);
}

/* Grid 2 follows grid 1 rigidly at a distance of 2 along x:
   u_y = v + 2 theta. */
static void rows_of_dependent_dofs_follow_the_others(void **)
{
    static const char deck[] = "BEGIN BULK\n"
                               "GRID,1,,0.,0.,0.\n"
                               "GRID,2,,2.,0.,0.\n"
                               "RBE2,9,1,123456,2\n";
    const char *const s = folder_write(
        "s12.mtx", "%%MatrixMarket matrix coordinate real general\n"
                   "1 12 1\n1 8 3.\n");
    const char *const recovery[] = {spell("tip", s, ",other")};
    ritz_import_request request = request_of(recovery);
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_dense) S = {0};

    request.mass = put_diagonal("m12.mtx", 12, NULL);
    request.rows = NULL;
    request.bulk = folder_write("two.bdf", deck);
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 6);
    assert_ok(ritz_sparse_dense(&c.quantity->S, &S));
    for (int64_t k = 0; k < 6; k++)
        assert_near(S.val[k], k == 1 ? 3.0 : k == 5 ? 6.0 : 0.0, 0.0);
}

/* MUG1 and MEF1 as NASTRAN wrote them for an external superelement. */
static void rows_of_nastran_come_with_its_superelement(void **)
{
    const char *const data = getenv("RITZ_EXTERNAL_DATA");
    char op4[2048], mug1[4096], mef1[4096];
    const char *recovery[] = {mug1, mef1};
    RITZ_OWN(ritz_superelement) found = {0};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    ritz_import_request request = {0};

    snprintf(op4, sizeof op4, "%s/nastran/nas2cam_csuper/inboard.op4",
             data ? data : ".");
    if (access(op4, R_OK) != 0) {
        print_message("skipped: %s is not there\n", op4);
        return;
    }
    snprintf(mug1, sizeof mug1, "drift=%s:MUG1,displacement", op4);
    snprintf(mef1, sizeof mef1, "force=%s:MEF1", op4);
    assert_ok(ritz_superelement_find(op4, NULL, &found));
    request = (ritz_import_request){.stiffness = found.stiffness,
                                    .mass = found.mass,
                                    .bulk = found.bulk,
                                    .num_recoveries = 2,
                                    .recovery = recovery};
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, 32);
    assert_int_equal(c.quantity[0].count, 36);
    assert_int_equal(c.quantity[1].count, 16);
    assert_string_equal(c.quantity[1].kind, "force");
}

/* A punch file names rows by the table of their kind. */
static void rows_may_be_named_by_a_table_of_nastran(void **)
{
    const char *const punched =
        folder_write("t.pch", "DTI,TEF1,2,,10,9,2,1\n,ENDREC\n"
                              "DTI,TES1,2,,11,7,1,1\n,12,8,1,2,ENDREC\n");
    const char *const recovery[] = {spell("top", put_rows(), ",stress")};
    const char *const rows[] = {spell("top", punched, "")};
    ritz_import_request request = request_of(recovery);
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    request.num_recovery_rows = 1;
    request.recovery_rows = rows;
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.quantity->place[0], 7);
    assert_string_equal(c.quantity->part[0], "celas1.s");
    assert_int_equal(c.quantity->place[1], 8);
    assert_string_equal(c.quantity->part[1], "celas2.s");
}

static void refuse(const char *recovery, const char *rows, ritz_status code,
                   const char *words)
{
    ritz_import_request request = request_of(&recovery);
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    request.num_recovery_rows = rows ? 1 : 0;
    request.recovery_rows = &rows;
    assert_fails(ritz_import(&request, &c, &report), code, words);
}

static void rows_that_do_not_fit_are_refused(void **)
{
    const char *const s = put_rows();
    const char *const good = spell("stress", s, "");
    const char *const wide =
        folder_write("w.mtx", ARRAY "2 4\n1\n2\n3\n4\n5\n6\n7\n8\n");
    const struct {
        const char *text, *words;
    } names[] = {
        {"12 sx\n", "names 1 rows, 'stress' has 2"},
        {"1 a\n2 b\n3 c\n", "names more than the 2 rows of 'stress'"},
        {"1 a\n\nsx 3\n", "line 3 is no number of an element"},
        {"1 a\n2 b c\n", "line 2 is no number of an element"},
        {"1 a\n-2 b\n", "line 2 is no number of an element"},
        {"DTI,TEF1,2,,10,9,2,1\n,ENDREC\n",
         "has a table of NASTRAN for 0 rows of kind stress, 'stress' has 2"},
        {"DTI,TES1,2,,10,9,2,1\n,34,8,9,3,ENDREC\n",
         "has a table of NASTRAN for 11 rows of kind stress, 'stress' has 2"},
    };

    refuse("stress", NULL, RITZ_ERR_ARGUMENT, "'stress' is not of the form");
    refuse("stress=,stress", NULL, RITZ_ERR_ARGUMENT, "names no file");
    refuse(spell("a/b", s, ""), NULL, RITZ_ERR_ARGUMENT, "a/b");
    refuse(spell("stress", wide, ""), NULL, RITZ_ERR_FORMAT,
           "3 columns are due, one for each dof of the mass");
    refuse(good, spell("strain", s, ""), RITZ_ERR_ARGUMENT,
           "there is no quantity 'strain'");
    refuse(good, "stress", RITZ_ERR_ARGUMENT, "is not of the form NAME=FILE");
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        refuse(good, spell("stress", folder_write("n.txt", names[k].text), ""),
               RITZ_ERR_FORMAT, names[k].words);
}

static void two_quantities_of_one_name_are_refused(void **)
{
    const char *const recovery[] = {spell("stress", put_rows(), ""),
                                    spell("stress", put_rows(), "")};
    ritz_import_request request = request_of(recovery);
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    request.num_recoveries = 2;
    assert_fails(ritz_import(&request, &c, &report), RITZ_ERR_ARGUMENT,
                 "there are two quantities 'stress'");
}

static ritz_status import_once(const ritz_import_request *request)
{
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    return ritz_import(request, &c, &report);
}

static void all_allocations_may_fail(void **)
{
    const char *const names = folder_write("a.txt", "12 sx\n7 sy\n");
    const char *const recovery[] = {spell("stress", put_rows(), "")};
    const char *const rows[] = {spell("stress", names, "")};
    ritz_import_request request = request_of(recovery);

    request.num_recovery_rows = 1;
    request.recovery_rows = rows;
    assert_survives_every_allocation(import_once(&request));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows_come_with_their_names),
    cmocka_unit_test(rows_may_be_columns),
    cmocka_unit_test(rows_of_dependent_dofs_follow_the_others),
    cmocka_unit_test(rows_of_nastran_come_with_its_superelement),
    cmocka_unit_test(rows_may_be_named_by_a_table_of_nastran),
    cmocka_unit_test(rows_that_do_not_fit_are_refused),
    cmocka_unit_test(two_quantities_of_one_name_are_refused),
    cmocka_unit_test(all_allocations_may_fail),
};

TEST_MODULE(import_quantities, tests, folder_make, folder_remove)
