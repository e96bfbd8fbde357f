#include "testing.h"

#include "folder.h"

#include <ritz/import.h>

#include <matio.h>
#include <stdio.h>
#include <stdlib.h>

#define ARRAY "%%MatrixMarket matrix array real general\n"

/* 3001 x 3001 with @p value on the diagonal or, with @p columns, in all entries
   of the first columns. */
static void write_many(const char *name, int value, int columns)
{
    const int n = 3001, count = columns > 0 ? columns * n : n;
    size_t size = 64 + 16 * (size_t)count, used = 0;
    char *text = malloc(size);

    assert_non_null(text);
    used = (size_t)snprintf(text, size,
                            "%%%%MatrixMarket matrix coordinate real general\n"
                            "%d %d %d\n",
                            n, n, count);
    for (int k = 0; k < count; k++)
        used +=
            (size_t)snprintf(text + used, size - used, "%d %d %d\n", k % n + 1,
                             (columns > 0 ? k / n : k) + 1, value);
    folder_write(name, text);
    free(text);
}

/* Two states, one input, two outputs. */
static int set_up(void **state)
{
    int failed = folder_make(state);

    if (failed)
        return failed;
    folder_write("A.mtx", ARRAY "2 2\n-1\n0\n2\n-3\n");
    folder_write("B.mtx", ARRAY "2 1\n4\n5\n");
    folder_write("C.mtx", ARRAY "2 2\n1\n0\n0\n7\n");
    folder_write("D.mtx", ARRAY "2 1\n0\n9\n");
    folder_write("E.mtx", ARRAY "2 2\n2\n0\n0\n3\n");
    folder_write("one.mtx", ARRAY "2 2\n1\n0\n0\n1\n");
    folder_write("flat.mtx", ARRAY "2 2\n1\n2\n2\n4\n");
    folder_write("loads.mtx", "%%MatrixMarket matrix coordinate real general\n"
                              "2 3001 1\n1 1 1\n");
    folder_write("wide.mtx", ARRAY "3 1\n1\n1\n1\n");
    folder_write("pairs.mtx", "%%MatrixMarket matrix array complex general\n"
                              "2 2\n1 1\n0 0\n0 0\n1 0\n");
    write_many("many.mtx", -1, 0);
    write_many("ones.mtx", 1, 0);
    write_many("full.mtx", -1, 301);
    folder_write("tall.mtx", "%%MatrixMarket matrix coordinate real general\n"
                             "3001 1 1\n1 1 1\n");
    folder_write("long.mtx", "%%MatrixMarket matrix coordinate real general\n"
                             "1 3001 1\n1 1 1\n");
    return 0;
}

/* "A=A.mtx,..." with the folder before each file. */
static const char *list(const char *text)
{
    static char out[4096];
    size_t used = 0;

    for (const char *c = text; *c; c++) {
        used += (size_t)snprintf(out + used, sizeof out - used, "%c", *c);
        if (*c == '=')
            used += (size_t)snprintf(out + used, sizeof out - used, "%s",
                                     folder_path(""));
    }
    return out;
}

static ritz_status import(const char *matrices, const char *inputs,
                          const char *outputs, ritz_state_space *out)
{
    const ritz_import_space_request request = {
        .matrices = matrices, .inputs = inputs, .outputs = outputs};

    return ritz_import_state_space(&request, out);
}

static void a_matrix_for_each_letter_makes_a_state_space(void **)
{
    RITZ_OWN(ritz_state_space) s = {0};

    assert_ok(import(list("C=C.mtx,A=A.mtx,B=B.mtx"), NULL, NULL, &s));
    assert_int_equal(s.A.nrow, 2);
    assert_true(s.A.val[0] == -1.0 && s.A.val[1] == 0.0 && s.A.val[2] == 2.0);
    assert_true(s.B.val[1] == 5.0 && s.C.val[3] == 7.0);
    assert_true(s.D.nrow == 2 && s.D.ncol == 1 && ritz_dense_max(&s.D) == 0.0);
    assert_null(s.E.val);
    assert_string_equal(s.input[0], "u1");
    assert_string_equal(s.output[1], "y2");
    assert_true(isnan(s.limit[0]));
}

static void d_e_names_and_limits_are_taken(void **)
{
    RITZ_OWN(ritz_state_space) s = {0};

    assert_ok(import(list("A=A.mtx,B=B.mtx,C=C.mtx,D=D.mtx,E=E.mtx"), "force",
                     "tip@1e-3,root", &s));
    assert_true(s.D.val[1] == 9.0 && s.E.val[0] == 2.0 && s.E.val[3] == 3.0);
    assert_string_equal(s.input[0], "force");
    assert_string_equal(s.output[0], "tip");
    assert_true(s.limit[0] == 1e-3 && isnan(s.limit[1]));
}

static void an_identity_is_no_e(void **)
{
    RITZ_OWN(ritz_state_space) s = {0};

    assert_ok(
        import(list("A=A.mtx,B=B.mtx,C=C.mtx,E=one.mtx"), NULL, NULL, &s));
    assert_null(s.E.val);
}

static void what_is_large_and_sparse_stays_so(void **)
{
    RITZ_OWN(ritz_state_space) s = {0}, plain = {0};

    assert_ok(import(list("A=many.mtx,B=tall.mtx,C=long.mtx,E=many.mtx"), NULL,
                     NULL, &s));
    assert_true(ritz_state_space_is_sparse(&s));
    assert_int_equal(ritz_state_space_order(&s), 3001);
    assert_true(s.sA.colptr[3001] == 3001 && s.sE.val[0] == -1.0);
    assert_true(s.B.val[0] == 1.0 && s.columns.count == 3001);
    assert_ok(import(list("A=many.mtx,B=tall.mtx,C=long.mtx,E=ones.mtx"), NULL,
                     NULL, &plain));
    assert_null(plain.sE.colptr);
}

static void what_makes_no_state_space_is_refused(void **)
{
    static const struct {
        const char *matrices, *inputs, *outputs, *words;
    } table[] = {
        {"A=A.mtx,B=B.mtx", 0, 0, "there is no 'C'"},
        {"A=A.mtx,A=A.mtx", 0, 0, "'A' is given twice"},
        {"A=A.mtx,B=B.mtx,C=C.mtx,E=flat.mtx", 0, 0, "'E' is singular"},
        {"A=A.mtx,B=wide.mtx,C=C.mtx", 0, 0, "'B' is 3 x 1 where 2 x 1 is due"},
        {"A=A.mtx,B=B.mtx,C=B.mtx", 0, 0, "'C' is 2 x 1 where 2 x 2 is due"},
        {"A=B.mtx,B=B.mtx,C=C.mtx", 0, 0, "'A' is 2 x 1 where 2 x 2 is due"},
        {"A=A.mtx,B=B.mtx,C=C.mtx,D=C.mtx", 0, 0,
         "'D' is 2 x 2 where 2 x 1 is due"},
        {"A=pairs.mtx,B=B.mtx,C=C.mtx", 0, 0, "'A' is complex"},
        {"A=full.mtx,B=tall.mtx,C=long.mtx", 0, 0, "at most 3000 states"},
        {"A=A.mtx,B=loads.mtx,C=C.mtx", 0, 0,
         "'B' is 2 x 3001: at most 3000 inputs and outputs are taken"},
        {"A=A.mtx,B=B.mtx,C=C.mtx", "u,v", 0, "2 names are given for 1"},
        {"A=A.mtx,B=B.mtx,C=C.mtx", 0, "y,y", "'y' is named twice"},
        {"A=A.mtx,B=B.mtx,C=C.mtx", 0, "y@0,z", "'0' is no limit"},
        {"A=A.mtx,B=B.mtx,C=C.mtx", 0, "y@x,z", "'x' is no limit"},
        {"A=none.mtx,B=B.mtx,C=C.mtx", 0, 0, "cannot open"},
    };
    ritz_state_space s = {0};

    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        assert_int_not_equal(import(list(table[k].matrices), table[k].inputs,
                                    table[k].outputs, &s),
                             RITZ_OK);
        if (!strstr(ritz_error_message(), table[k].words))
            fail_msg("%s: %s", table[k].matrices, ritz_error_message());
        assert_null(s.A.val);
    }
}

static void put(mat_t *file, const char *name, const char *field, int n)
{
    const double value[4] = {-1, 0, 0, -2};
    double copy[4];
    size_t dims[2] = {(size_t)n, (size_t)n};
    size_t one[2] = {1, 1};
    matvar_t *outer = NULL;
    matvar_t *matrix = NULL;

    memcpy(copy, value, sizeof copy);
    matrix = Mat_VarCreate(field ? field : name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2,
                           dims, copy, 0);
    if (field) {
        outer = Mat_VarCreateStruct(name, 2, one, &field, 1);
        Mat_VarSetStructFieldByName(outer, field, 0, matrix);
        matrix = outer;
    }
    assert_int_equal(Mat_VarWrite(file, matrix, MAT_COMPRESSION_ZLIB), 0);
    Mat_VarFree(matrix);
}

/* File of A, B and C as they are called, structs of an a alone beside. */
static const char *mat_file(const char *name, int num_structs, bool bare)
{
    const char *path = folder_path(name);
    mat_t *file = Mat_CreateVer(path, NULL, MAT_FT_MAT5);

    if (bare) {
        put(file, "A", NULL, 2);
        put(file, "B", NULL, 2);
        put(file, "c", NULL, 2); /* nobody else is called C */
    }
    for (int k = 0; k < num_structs; k++)
        put(file, k ? "other" : "sys", "a", 2);
    assert_int_equal(Mat_Close(file), 0);
    return path;
}

static void one_file_names_the_matrices_itself(void **state)
{
    ritz_state_space s = {0};
    char spec[600];

    (void)state;
    assert_ok(import(mat_file("bare.mat", 1, true), NULL, NULL, &s));
    assert_int_equal(s.num_outputs, 2);
    ritz_state_space_free(&s);
    assert_fails(import(mat_file("two.mat", 2, false), NULL, NULL, &s),
                 RITZ_ERR_ARGUMENT, "holds several state spaces");
    assert_fails(import(mat_file("one.mat", 1, false), NULL, NULL, &s),
                 RITZ_ERR_ARGUMENT, "there is no 'B'"); /* of sys */
    snprintf(spec, sizeof spec, "%s:other", mat_file("two.mat", 2, false));
    assert_fails(import(spec, NULL, NULL, &s), RITZ_ERR_ARGUMENT,
                 "there is no 'B'");
    assert_fails(import(folder_path("A.mtx"), NULL, NULL, &s), RITZ_ERR_FORMAT,
                 "holds no matrix 'A'");
}

static ritz_status import_and_drop(const char *matrices)
{
    ritz_state_space s = {0};
    ritz_status status = import(matrices, "force", "tip,root@2", &s);

    ritz_state_space_free(&s);
    return status;
}

static void every_allocation_may_fail(void **)
{
    assert_survives_every_allocation(
        import_and_drop(list("A=A.mtx,B=B.mtx,C=C.mtx,D=D.mtx,E=E.mtx")));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_matrix_for_each_letter_makes_a_state_space),
    cmocka_unit_test(d_e_names_and_limits_are_taken),
    cmocka_unit_test(an_identity_is_no_e),
    cmocka_unit_test(what_is_large_and_sparse_stays_so),
    cmocka_unit_test(what_makes_no_state_space_is_refused),
    cmocka_unit_test(one_file_names_the_matrices_itself),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(import_space, tests, set_up, folder_remove)
