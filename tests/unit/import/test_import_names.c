/* Files of `GRID COMP` or `NODE.COMP` rows, which --dofs names. */
#include "import/import.h"
#include "testing.h"

#include <stdio.h>

static const char path[] = "test_import_names.txt";

static void write_file(const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");

    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static ritz_status read_text(const char *text, ritz_row_names *out)
{
    write_file(text, strlen(text));
    return ritz_names_of_file(path, out);
}

static const char *const samples[] = {
    "101 1\n101 2\n101 3\n102 1\n102 2\n",
    "# of the rotor\r\n\r\n 7\t6 # a turn\r\n2001 0\r\n7 1",
    "1 0\n2 0\n3 0\n4 0\n5 0\n6 0\n7 0\n8 0\n9 0\n10 0\n11 0\n",
    "999999999999999999 6\n+5 3\n12345 4\n",
    "101.1\n101.2\n101.3\n7.1\n7.6\n",
    "# of CalculiX\n\n  12345678.1\r\n12345678.2 # a comment\n9.0\n",
};

/* Neither a file of ANSYS nor a description of its columns was to be had: this
   layout is what is said of them. */
static const char mapping[] = "  Matrix Eqn   Node   Dof\n"
                              "         1      101    UX \r\n"
                              "         2      101    ROTZ\n"
                              "\n"
                              "         3        7    uy\n";

static void a_mapping_of_ansys_names_rows(void **)
{
    static const ritz_dof due[] = {{101, 1}, {101, 6}, {7, 2}};
    ritz_row_names names = {0};

    assert_ok(read_text(mapping, &names));
    assert_int_equal(names.count, 3);
    for (int k = 0; k < 3; k++)
        assert_int_equal(ritz_dof_compare(&names.dof[k], &due[k]), 0);
    ritz_row_names_free(&names);
    remove(path);
}

static void rows_are_named_in_the_order_of_the_file(void **)
{
    static const ritz_dof due[] = {{7, 6}, {2001, 0}, {7, 1}};
    ritz_row_names names = {0};

    assert_ok(read_text(samples[1], &names));
    assert_int_equal(names.count, 3);
    for (int k = 0; k < 3; k++)
        assert_int_equal(ritz_dof_compare(&names.dof[k], &due[k]), 0);
    ritz_row_names_free(&names);
    remove(path);
}

/* A double of 16 digits has none left for the direction of the second. */
static void dofs_of_calculix_are_split_at_the_point(void **)
{
    static const ritz_dof due[] = {{12345678, 1}, {12345678, 2}, {9, 0}};
    ritz_row_names names = {0};

    assert_ok(read_text(samples[5], &names));
    assert_int_equal(names.count, 3);
    for (int k = 0; k < 3; k++)
        assert_int_equal(ritz_dof_compare(&names.dof[k], &due[k]), 0);
    ritz_row_names_free(&names);
    assert_ok(read_text("99999999999999999.2\n99999999999999999.3", &names));
    assert_int_equal(names.dof[0].grid, 99999999999999999);
    assert_int_equal(names.dof[0].component, 2);
    assert_int_equal(names.dof[1].grid, 99999999999999999);
    assert_int_equal(names.dof[1].component, 3);
    ritz_row_names_free(&names);
    remove(path);
}

static void what_is_wrong_is_said_with_its_line(void **)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"1 1\n\n2\n", "line 3: a grid and its direction are due"},
        {"1 1 1\n", "line 1: a grid and its direction are due"},
        {"1 T1\n", "line 1: a grid and its direction are due"},
        {"1 1.0\n", "line 1: a grid and its direction are due"},
        {"1 7\n", "line 1: '1 7' is no dof"},
        {"1 -1\n", "line 1: '1 -1' is no dof"},
        {"0 1\n", "line 1: '0 1' is no dof"},
        {"99999999999999999999 1\n", "line 1: a grid and its direction"},
        {"5.2\n6.7\n", "line 2: '6.7' is no dof"},
        {"5.2\n0.1\n", "line 2: '0.1' is no dof"},
        {"5.2\n6 1\n",
         "line 2: a grid and its direction are due, such as '101.3'"},
        {"5.2\n6.1 2\n", "line 2: a grid and its direction are due"},
        {"5.2\n.1\n", "line 2: a grid and its direction are due"},
        {"5.2\n6.\n", "line 2: a grid and its direction are due"},
        {"5.2\n6.-1\n", "line 2: a grid and its direction are due"},
        {"5.2\n6.1e3\n", "line 2: a grid and its direction are due"},
        {"5 2\n6.1\n",
         "line 2: a grid and its direction are due, such as '101 3'"},
        {"99999999999999999999.1\n", "line 1: a grid and its direction"},
        {"5.2\n4.1\n5.2\n", "line 3: 'grid 5 T2' was named at line 1 already"},
        {"1 5 UX\n2 5 TEMP\n",
         "line 2: 'TEMP' is none of the directions UX UY UZ ROTX ROTY ROTZ"},
        {"Eqn Node Dof\n1 5 UX\n3 5 UY\n",
         "line 3: equation 2 is due, not '3'"},
        {"1 5 UX\n2 0 UY\n",
         "line 2: an equation, its node and its direction are due"},
        {"1 5 UX\n2 5\n",
         "line 2: an equation, its node and its direction are due"},
        {"1 5 UX\n2 5 UY 0\n",
         "line 2: an equation, its node and its direction are due"},
        {"1 5 UX\nNode\n",
         "line 2: an equation, its node and its direction are due"},
        {"1 5 UX\n2 5 UX\n", "line 2: 'grid 5 T1' was named at line 1 already"},
        {"5 2\n4 1\n# c\n5 2\n",
         "line 4: 'grid 5 T2' was named at line 1 already"},
    };

    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        ritz_row_names names = {0};

        assert_fails(read_text(cases[k].text, &names), RITZ_ERR_FORMAT,
                     cases[k].words);
        assert_non_null(strstr(ritz_error_message(), path));
        assert_null(names.dof);
    }
    remove(path);
}

/* In names that are accepted there is no dof twice, and none that is none. */
static void assert_answered(const char *bytes, size_t size)
{
    ritz_row_names names = {0};
    ritz_status status = RITZ_OK;

    write_file(bytes, size);
    ritz_record("%s", "");
    status = ritz_names_of_file(path, &names);
    if (status != RITZ_OK) {
        assert_int_equal(status, RITZ_ERR_FORMAT);
        assert_true(strlen(ritz_error_message()) > 0);
        assert_null(names.dof);
        return;
    }
    for (int64_t k = 0; k < names.count; k++) {
        assert_true(names.dof[k].grid >= 1);
        assert_in_range(names.dof[k].component, 0, 6);
    }
    assert_int_equal(ritz_dof_distinct(names.count, names.dof), names.count);
    ritz_row_names_free(&names);
}

static void a_file_cut_or_corrupted_anywhere_is_answered(void **)
{
    uint64_t seed = 77;

    for (size_t s = 0; s < sizeof samples / sizeof *samples; s++) {
        size_t size = strlen(samples[s]);
        char bytes[200];

        for (size_t cut = 0; cut <= size; cut++)
            assert_answered(samples[s], cut);
        for (int k = 0; k < 500; k++) {
            memcpy(bytes, samples[s], size);
            for (int n = 0; n <= k % 5; n++) {
                seed =
                    seed * UINT64_C(6364136223846793005) + 1442695040888963407U;
                bytes[(seed >> 33) % size] =
                    (char)(k % 2 ? (int)(seed >> 20 & 0xff)
                                 : "0123456789 #-\t.\n"[seed >> 60]);
            }
            assert_answered(bytes, size);
        }
    }
    remove(path);
}

static void a_mapping_cut_anywhere_is_answered(void **)
{
    for (size_t cut = 0; cut < sizeof mapping; cut++)
        assert_answered(mapping, cut);
    remove(path);
}

static ritz_status read_and_drop(void)
{
    ritz_row_names names = {0};
    ritz_status status = ritz_names_of_file(path, &names);

    ritz_row_names_free(&names);
    return status;
}

static void every_allocation_may_fail(void **)
{
    write_file(samples[4], strlen(samples[4]));
    assert_survives_every_allocation(read_and_drop());
    write_file(mapping, sizeof mapping - 1);
    assert_survives_every_allocation(read_and_drop());
    write_file(samples[0], strlen(samples[0]));
    assert_survives_every_allocation(read_and_drop());
    remove(path);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(rows_are_named_in_the_order_of_the_file),
    cmocka_unit_test(dofs_of_calculix_are_split_at_the_point),
    cmocka_unit_test(a_mapping_of_ansys_names_rows),
    cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    cmocka_unit_test(a_file_cut_or_corrupted_anywhere_is_answered),
    cmocka_unit_test(a_mapping_cut_anywhere_is_answered),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(import_names, tests, NULL, NULL)
