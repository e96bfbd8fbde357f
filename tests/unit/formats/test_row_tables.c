/*
 * Tables of NASTRAN that name rows of recovery: those of files that NASTRAN
 * wrote, cut and corrupted ones, and which rows an element has.
 */
#include "testing.h"

#include "damage.h"

#include "formats/nastran_items.h"

#include <ritz/import.h>

#include <stdio.h>
#include <string.h>

/* Record 0 and the others as NX NASTRAN 9 punches them, with three columns. */
static const char TABLES[] =
    "BEGIN SUPER      102\n"
    "DTI     TUG1    0       12      3       32767   0       7       0\n"
    "        PHIP            7                       REAL           1ENDREC\n"
    "DTI     TUG1    1       1       0.00000 2       0.00000 3       0.00000\n"
    "        ENDREC\n"
    "DTI     TUG1    2\n"
    "        TYPE    ID      COMP    ROW     TYPE    ID      COMP    ROW\n"
    "        1       3       6       1       2       1995002 6       7\n"
    "        ENDREC\n"
    "DTI     TES1    2\n"
    "        TYPE    ID      COMP    ROW     TYPE    ID      COMP    ROW\n"
    "        34      11      9       1       95      23      2       10\n"
    "        ENDREC\n"
    "DTI     TES1    3\n"
    "        34      11\n"
    "        95      23\n"
    "        ENDREC\n"
    "DTI     TEF1    2\n"
    "        TYPE    ID      COMP    ROW     TYPE    ID      COMP    ROW\n"
    "        34      10      8       1       2       97      77      9\n"
    "        33      5       3       86      ENDREC\n";

static void assert_row(const ritz_row_table *table, int64_t row, int64_t place,
                       const char *part)
{
    assert_true(row < table->count);
    assert_int_equal(table->place[row], place);
    assert_string_equal(table->part[row], part);
}

static void rows_of_elements_have_the_names_of_their_items(void **state)
{
    static const char *const stress[] = {"cbar.sa1", "cbar.sa2",   "cbar.sa3",
                                         "cbar.sa4", "cbar.axial", "cbar.sb1",
                                         "cbar.sb2", "cbar.sb3",   "cbar.sb4"};
    static const char *const force[] = {"cbar.m1a",   "cbar.m2a",   "cbar.m1b",
                                        "cbar.m2b",   "cbar.v1",    "cbar.v2",
                                        "cbar.axial", "cbar.torque"};
    RITZ_OWN(ritz_row_table) stresses = {0}, forces = {0};

    (void)state;
    assert_ok(ritz_row_table_parse("t.pch", TABLES, "stress", &stresses));
    assert_int_equal(stresses.count, 11);
    for (int64_t k = 0; k < 9; k++)
        assert_row(&stresses, k, 11, stress[k]);
    assert_row(&stresses, 9, 23, "type95.1");
    assert_row(&stresses, 10, 23, "type95.2");
    assert_ok(ritz_row_table_parse("t.pch", TABLES, "force", &forces));
    assert_int_equal(forces.count, 88);
    for (int64_t k = 0; k < 8; k++)
        assert_row(&forces, k, 10, force[k]);
    assert_row(&forces, 8, 97, "cbeam.m1.1");
    assert_row(&forces, 14, 97, "cbeam.warping.1");
    assert_row(&forces, 15, 97, "cbeam.m1.2");
    assert_row(&forces, 84, 97, "cbeam.warping.11");
    assert_row(&forces, 87, 5, "cquad4.3"); /* it has eight rows of forces */
}

static void rows_of_grids_have_the_names_of_their_directions(void **state)
{
    static const char *const part[] = {"T1", "T2", "T3", "R1", "R2", "R3"};
    RITZ_OWN(ritz_row_table) table = {0}, none = {0};

    (void)state;
    assert_ok(ritz_row_table_parse("t.pch", TABLES, "displacement", &table));
    assert_int_equal(table.count, 12);
    for (int64_t k = 0; k < 6; k++)
        assert_row(&table, k, 3, part[k]);
    assert_row(&table, 6, 1995002, "point.1");
    assert_row(&table, 11, 1995002, "point.6");
    assert_ok(ritz_row_table_parse("t.pch", TABLES, "acceleration", &none));
    assert_int_equal(none.count, 0);
    assert_ok(ritz_row_table_parse("t.pch", "GRID,3\n", "stress", &none));
    assert_int_equal(none.count, 0);
}

static void a_text_with_tables_is_recognised(void **state)
{
    (void)state;
    assert_true(ritz_row_table_recognise(TABLES));
    assert_true(ritz_row_table_recognise("dti,TES1,2"));
    assert_false(ritz_row_table_recognise("12 sx\n13 DTI\n"));
    assert_false(ritz_row_table_recognise("DTIX 1\n"));
    assert_false(ritz_row_table_recognise("DTI"));
    assert_false(ritz_row_table_recognise(""));
}

/* Each name is that of one row, the one that has it. */
static void names_are_those_of_rows(void **state)
{
    static const ritz_nastran_item of[] = {
        {34, 0, 8}, {34, 0, 9},  {2, 0, 77}, {10, 0, 2}, {12, 0, 1}, {33, 0, 8},
        {33, 0, 6}, {102, 0, 6}, {95, 0, 4}, {34, 0, 3}, {1, 0, 6},  {2, 0, 6}};
    static const char *const kind[] = {"force", "stress", "displacement"};
    char name[RITZ_NAME_SIZE];

    (void)state;
    for (size_t k = 0; k < sizeof of / sizeof *of; k++)
        for (int i = 0; i < 3; i++)
            for (int64_t row = 0; row < of[k].rows; row++) {
                const ritz_nastran_item item = {of[k].type, row, of[k].rows};
                ritz_nastran_item found = {0};

                if (i == 2 && item.type > 2)
                    continue;
                ritz_nastran_item_name(kind[i], &item, name);
                assert_true(ritz_nastran_item_find(kind[i], name, &found));
                assert_int_equal(found.type, item.type);
                assert_int_equal(found.index, row);
                assert_true(found.rows == 0 || found.rows == item.rows);
            }
}

static void other_names_are_no_rows(void **state)
{
    static const char *const bad[] = {
        "",           "sx",       "cbar",      "cbar.",
        "cbar.sx",    "cbar.0",   "cbar.-1",   "cbar.1x",
        "cbar.m1a.1", "cbeam.m1", "cbeam.m1.", "cbeam.m1.12",
        "cbeam.m1.0", "type.1",   "type0.1",   "type95",
        "typex.1",    ".1",       "T1",        "type123456789.1"};
    static const char *const grids[] = {"T4", "T",       "R12",
                                        "x",  "point.0", "cbar.1"};
    ritz_nastran_item item = {0};

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_false(ritz_nastran_item_find("force", bad[k], &item));
    for (size_t k = 0; k < sizeof grids / sizeof *grids; k++)
        assert_false(ritz_nastran_item_find("displacement", grids[k], &item));
}

static void a_table_that_is_not_understood_is_refused(void **state)
{
    static const struct {
        const char *kind, *text, *words;
    } bad[] = {
        {"stress", "DTI,TES1,2,,34,11,9,1\n",
         "'t.pch', line 1: record 2 of TES1 ends without ENDREC"},
        {"stress", "DTI,TES1,2,,34,11,9,ENDREC\n",
         "is not behind TYPE, ID, COMP and ROW of a whole entry"},
        {"stress", "DTI,TES1,2,,34,x,9,1\n,ENDREC\n",
         "'x' in DTI is not a positive whole number"},
        {"stress", "DTI,TES1,2,,34,11,9,2\n,ENDREC\n",
         "TES1 has row 2 for 11 where 1 is due"},
        {"stress", "DTI,TES1,2,,34,11,9,1\n,34,12,9,9,ENDREC\n",
         "TES1 has row 9 for 12 where 10 is due"},
        {"force", "DTI,TEF1,2,,34,11,1000001,1\n,ENDREC\n",
         "TEF1 names more than 1000000 rows"},
        {"displacement", "DTI,TUG1,2,,3,11,6,1\n,ENDREC\n",
         "TUG1 has type 3 of 11, which is neither 1, a grid, nor 2"},
        {"force",
         "DTI,TEF1,2,,34,11,8,1\n,ENDREC\nDTI,TEF1,2,,34,11,8,1\n,ENDREC\n",
         "line 3: TEF1 is there twice: a file with one superelement alone"},
    };

    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        ritz_row_table table = {0};

        assert_fails(
            ritz_row_table_parse("t.pch", bad[k].text, bad[k].kind, &table),
            RITZ_ERR_FORMAT, bad[k].words);
        assert_null(table.place);
    }
}

static ritz_status read_bytes(const char *bytes, int64_t size)
{
    static const char *const kind[] = {"displacement", "stress", "force"};
    char text[4096];

    assert_true(size < (int64_t)sizeof text);
    memcpy(text, bytes, (size_t)size);
    text[size] = '\0';
    for (int k = 0; k < 3; k++) {
        RITZ_OWN(ritz_row_table) table = {0};
        const ritz_status status =
            ritz_row_table_parse("t.pch", text, kind[k], &table);

        if (status != RITZ_OK)
            return status;
    }
    return RITZ_OK;
}

static void tables_cut_or_corrupted_anywhere_end_well(void **state)
{
    (void)state;
    damage_cut(read_bytes, TABLES, sizeof TABLES - 1);
    damage_corrupt(read_bytes, TABLES, sizeof TABLES - 1);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(read_bytes(TABLES, sizeof TABLES - 1));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows_of_elements_have_the_names_of_their_items),
    cmocka_unit_test(rows_of_grids_have_the_names_of_their_directions),
    cmocka_unit_test(a_text_with_tables_is_recognised),
    cmocka_unit_test(names_are_those_of_rows),
    cmocka_unit_test(other_names_are_no_rows),
    cmocka_unit_test(a_table_that_is_not_understood_is_refused),
    cmocka_unit_test(tables_cut_or_corrupted_anywhere_end_well),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(row_tables, tests, NULL, NULL)
