/* USER ELEMENT: texts written from the layout of the manuals, in the manner of
   Abaqus by hand and in that of CalculiX by its Fortran formats. */
#include "testing.h"

#include "damage.h"
#include "foreign.h"

#include <ritz/import.h>

#include <stdio.h>

static ritz_status read_text(const char *text)
{
    return damage_read_matrices(text, (int64_t)strlen(text));
}

static double entry(const ritz_matrix *m, int64_t i, int64_t j)
{
    return matrix_entry(&m->A, m->A.val, i, j);
}

/* Nodes 7 and 3 in 1 and 2, and node 12 in 6. */
static const char ABAQUS[] = "**\n"
                             "** SUBSTRUCTURE Z1\n"
                             "*USER ELEMENT, NODES= 3, LINEAR\n"
                             "** ELEMENT NODES\n"
                             "** 7, 3,\n"
                             "** 12\n"
                             "1, 2\n"
                             "3, 6\n"
                             "*MATRIX,TYPE=STIFFNESS\n"
                             "98.901098901099 ,\n"
                             "-3.5 , 80.25\n"
                             "0., 1.5E+1 , 77.\n"
                             "-2.0, -3.0, -4.0, 66.\n"
                             "0.25, 0.5, 0.0, 1.0\n"
                             "55.125\n"
                             "** RECOVERY MATRIX 1., 2.\n"
                             "*MATRIX,TYPE=MASS\n"
                             "1.\n0., 2.\n0., 0., 3.\n0., 0., 0., 4.\n"
                             "0., 0., 0., 0.\n5.\n";

static void abaqus_writes_stiffness_and_mass(void **state)
{
    static const double K[5][5] = {{98.901098901099, -3.5, 0.0, -2.0, 0.25},
                                   {-3.5, 80.25, 15.0, -3.0, 0.5},
                                   {0.0, 15.0, 77.0, -4.0, 0.0},
                                   {-2.0, -3.0, -4.0, 66.0, 1.0},
                                   {0.25, 0.5, 0.0, 1.0, 55.125}};
    static const ritz_dof ROWS[] = {{7, 1}, {7, 2}, {3, 1}, {3, 2}, {12, 6}};
    RITZ_OWN(ritz_matrices) all = {0};
    const ritz_matrix *m = NULL;
    (void)state;

    assert_ok(foreign_parse(ABAQUS, sizeof ABAQUS - 1, &all));
    assert_string_equal(foreign_format, "user-element");
    assert_int_equal(all.count, 2);
    assert_string_equal(all.matrix[0].name, "STIFFNESS");
    assert_string_equal(all.matrix[1].name, "MASS");
    assert_int_equal(all.matrix[0].digits, 14);
    for (int k = 0; k < 2; k++) {
        m = &all.matrix[k];
        assert_true(m->symmetric);
        assert_int_equal(m->A.nrow, 5);
        assert_null(m->col);
        for (int i = 0; i < 5; i++)
            assert_int_equal(ritz_dof_compare(&m->row[i], &ROWS[i]), 0);
        for (int e = 0; e < 25; e++) {
            int i = e / 5;
            int j = e % 5;
            double mass = i == j ? i + 1.0 : 0.0;

            assert_near(entry(m, i, j), k == 0 ? K[i][j] : mass, 0.0);
        }
    }
    assert_ok(ritz_sparse_check(&all.matrix[1].A, 5)); /* no zero is kept */
}

enum { ROWS = 12 };

/* A(i, j) of the lower triangle, which thirteen digits hold exactly. */
static double lower(int i, int j)
{
    return (i + 1) * 64.0 + (j + 1) / 16.0;
}

/* What CalculiX writes of three directions of nodes 40, 39, ...: a "node" for
 * each row, ten of them to a line (**,10(i10,',')), i10, (i10,',',i10), and
 * 4(e20.13,','). */
static void put_calculix(FILE *file)
{
    fputs("**\n** GENERATION OF SUBSTRUCTURE\n", file);
    fprintf(file, "*USER ELEMENT,NODES= %10d,LINEAR\n** ELEMENT NODES\n", ROWS);
    for (int i = 0; i < ROWS; i++)
        fprintf(file, "%s%10d,%s", i % 10 == 0 ? "**" : "", 40 - i / 3,
                i % 10 == 9 || i + 1 == ROWS ? "\n" : "");
    fprintf(file, "%10d\n", 1);
    for (int i = 1; i < ROWS; i++)
        fprintf(file, "%10d,%10d\n", i + 1, i % 3 + 1);
    fputs("*MATRIX,TYPE=STIFFNESS\n", file);
    for (int i = 0; i < ROWS; i++)
        for (int j = 0; j <= i; j++)
            fprintf(file, "%20.13E,%s", lower(i, j),
                    j % 4 == 3 || j == i ? "\n" : "");
}

/* The file; the caller frees it. */
static char *write_calculix(size_t *size)
{
    char *text = NULL;
    FILE *file = open_memstream(&text, size);

    assert_non_null(file);
    put_calculix(file);
    assert_int_equal(fclose(file), 0);
    return text;
}

static void calculix_names_a_node_for_each_row(void **state)
{
    RITZ_OWN(ritz_matrices) all = {0};
    const ritz_matrix *m = NULL;
    size_t size = 0;
    char *text = write_calculix(&size);
    (void)state;

    assert_ok(foreign_parse(text, (int64_t)size, &all));
    free(text);
    assert_int_equal(all.count, 1);
    m = all.matrix;
    assert_int_equal(m->A.nrow, ROWS);
    assert_ok(ritz_sparse_check(&m->A, ROWS * ROWS));
    for (int i = 0; i < ROWS; i++) {
        assert_int_equal(m->row[i].grid, 40 - i / 3);
        assert_int_equal(m->row[i].component, i % 3 + 1);
        for (int j = 0; j <= i; j++) {
            assert_near(entry(m, i, j), lower(i, j), 0.0);
            assert_near(entry(m, j, i), lower(i, j), 0.0);
        }
    }
}

static void the_list_has_sizes_without_values(void **state)
{
    static const char TEXT[] = "*USER ELEMENT,NODES=1,LINEAR,TYPE=U1\n"
                               "**ELEMENT NODES\n**5\n3\n*MATRIX,TYPE=Mass\nx\n"
                               "*USER ELEMENT,LINEAR,NODES=2\n"
                               "** comment\n** ELEMENT NODES\n** 5\n** 6\n"
                               "1,2,3\n*MATRIX,TYPE=MASS\n";
    ritz_foreign file = {.bytes = TEXT,
                         .size = sizeof TEXT - 1,
                         .format = &ritz_format_user_element};
    ritz_matrix m = {0};
    (void)state;

    assert_true(ritz_format_user_element.recognise(TEXT, sizeof TEXT - 1));
    assert_ok(ritz_foreign_list(&file));
    assert_int_equal(file.listing.count, 2);
    assert_string_equal(file.listing.item[0].name, "MASS");
    assert_int_equal(file.listing.item[0].nrow, 1);
    assert_int_equal(file.listing.item[1].ncol, 6);
    assert_true(file.listing.item[1].symmetric);
    assert_fails(ritz_foreign_take(&file, 0, &m), RITZ_ERR_FORMAT,
                 "line 6: 'x' is not a number");
    assert_fails(ritz_foreign_take(&file, 1, &m), RITZ_ERR_FORMAT,
                 "the matrix ends before row 1 of 6, 'grid 5 T1', is complete");
    file.listing.item[1].at = 77; /* a mapped file was changed */
    assert_fails(ritz_foreign_take(&file, 1, &m), RITZ_ERR_FORMAT,
                 "the matrix 'MASS' is no longer there");
    ritz_foreign_free(&file);
}

/* A file of one element: its keyword on line 1, directions from line 4 on. */
#define UEL   "*USER ELEMENT,LINEAR,NODES="
#define TWO   UEL "2\n** ELEMENT NODES\n** 1, 2\n"
#define STIFF "*MATRIX,TYPE=STIFFNESS\n"

static void what_is_wrong_is_said_with_its_line(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {UEL "x\n", "line 1: 'x' is not a whole number"},
        {UEL "0\n", "line 1: *USER ELEMENT does not say how many NODES"},
        {"*USER ELEMENT,LINEAR\n", "does not say how many NODES"},
        {UEL "2,UNSYMM\n", "line 1: an unsymmetric element is not read"},
        {UEL "2,FILE=k\n", "line 1: 'FILE' of *USER ELEMENT is not read"},
        {UEL "2\n1,2\n", "line 2: no comment '** ELEMENT NODES' follows"},
        {UEL "2\n** a\n", "line 2: no comment '** ELEMENT NODES' follows"},
        {UEL "2\n** ELEMENT NODES\n** 4,\n1\n",
         "line 4: the comment names 1 of 2 nodes"},
        {UEL "1\n** ELEMENT NODES\n** 4, 5\n",
         "line 3: more nodes than the 1 of *USER ELEMENT"},
        {UEL "1\n** ELEMENT NODES\n** x\n", "line 3: 'x' is not a whole"},
        {UEL "1\n** ELEMENT NODES\n** -4\n",
         "line 3: node -4 is internal to Abaqus"},
        {TWO, "line 3: no degrees of freedom follow *USER ELEMENT"},
        {TWO STIFF, "line 3: no degrees of freedom follow"},
        {TWO "1,8\n", "line 4: degree of freedom 8, a pressure"},
        {TWO "1,2,3,4,5,6,1\n", "line 4: more than six degrees of freedom"},
        {TWO ",\n", "line 4: '' is not a whole number"},
        {TWO "1,2\n2\n", "line 5: no degree of freedom follows the place"},
        {TWO "1\n1,2\n",
         "line 5: place 1 among 2 nodes does not follow place 1"},
        {TWO "1\n3,2\n", "line 5: place 3 among 2 nodes does not"},
        {TWO "1,1\n", "line 4: 'grid 1 T1' is named twice"},
        {UEL "2\n** ELEMENT NODES\n** 9,9\n6\n" STIFF,
         "line 4: 'grid 9 R3' is named twice"},
        {TWO "1\n", "line 4: no *MATRIX follows *USER ELEMENT"},
        {TWO "1\n*MATRIX\n", "line 5: *MATRIX has no TYPE"},
        {TWO "1\n*MATRIX,TYPE=LOAD\n", "neither STIFFNESS nor MASS but 'LOAD'"},
        {TWO "1\n*MATRIX,TYPE=MASS,INPUT=m\n",
         "line 5: the numbers are in another file, 'm'"},
        {TWO "1\n*MATRIX,UNSYM\n", "line 5: 'UNSYM' of *MATRIX is not read"},
        {TWO "1\n*ELEMENT\n",
         "line 5: '*ELEMENT' is neither *USER ELEMENT nor *MATRIX"},
        {TWO "1\n" STIFF, "line 5: the matrix ends before row 1 of 2"},
        {TWO "1\n" STIFF "1.\n2.\n",
         "line 7: the count of numbers on a line of row 2, 'grid 2 T1', is 1 "
         "instead of 2"},
        {TWO "1\n" STIFF "1.,2.\n",
         "line 6: the count of numbers on a line of row 1, 'grid 1 T1', is 2 "
         "instead of 1"},
        {TWO "1\n" STIFF "1.\n2.,3.\n4.\n",
         "line 8: more numbers than the lower triangle of 2 rows has"},
        {TWO "1\n" STIFF "1.\n2.,3.\n*MATRIX,TYPE=MASS\n1.\n",
         "line 9: the matrix ends before row 2 of 2, 'grid 2 T1'"},
        {TWO "1\n" STIFF "1.\n2.,y\n", "line 7: 'y' is not a number"},
        {TWO "1\n" STIFF "1.\n,3.\n", "line 7: '' is not a number"},
        {TWO "1\n" STIFF "1.\n2.,inf\n", "line 7: 'inf' is not finite"},
        {TWO "1,2\n" STIFF "1.\n2.,3.\n4.,5.,6.\n7.,8.,9.,1.,2.\n",
         "line 9: the count of numbers on a line of row 4, 'grid 2 T2', is 5 "
         "instead of 4"},
    };
    (void)state;

    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++)
        assert_fails(read_text(CASES[k].text), RITZ_ERR_FORMAT, CASES[k].words);
}

static void files_whose_first_keyword_is_another_are_refused(void **state)
{
    static const struct {
        const char *text, *words;
    } CASES[] = {
        {STIFF "1.\n", "line 1: *MATRIX comes before *USER ELEMENT"},
        {"1.\n", "line 1: '1.' follows no keyword"},
        {"*USER ELEMENT,NODES=2\n", "line 1: a *USER ELEMENT that is not"},
    };
    (void)state;

    for (size_t k = 0; k < sizeof CASES / sizeof *CASES; k++) {
        const char *text = CASES[k].text;
        const int64_t size = (int64_t)strlen(text);
        ritz_foreign file = {
            .bytes = text, .size = size, .format = &ritz_format_user_element};

        assert_false(ritz_format_user_element.recognise(text, size));
        assert_fails(ritz_foreign_list(&file), RITZ_ERR_FORMAT, CASES[k].words);
        ritz_foreign_free(&file);
    }
}

static void a_file_cut_or_corrupted_anywhere_ends_well(void **state)
{
    size_t size = 0;
    char *text = write_calculix(&size);
    (void)state;

    damage_cut(damage_read_matrices, text, (int64_t)size);
    damage_corrupt(damage_read_matrices, text, (int64_t)size);
    free(text);
    damage_cut(damage_read_matrices, ABAQUS, sizeof ABAQUS);
    damage_corrupt(damage_read_matrices, ABAQUS, sizeof ABAQUS - 1);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(read_text(ABAQUS));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(abaqus_writes_stiffness_and_mass),
    cmocka_unit_test(calculix_names_a_node_for_each_row),
    cmocka_unit_test(the_list_has_sizes_without_values),
    cmocka_unit_test(what_is_wrong_is_said_with_its_line),
    cmocka_unit_test(files_whose_first_keyword_is_another_are_refused),
    cmocka_unit_test(a_file_cut_or_corrupted_anywhere_ends_well),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(user_element, tests, NULL, NULL)
