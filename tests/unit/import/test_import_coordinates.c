/* Components of matrices as CalculiX and Abaqus write them. */
#include "testing.h"

#include "folder.h"

#include <ritz/import.h>
#include <ritz/matrix.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static ritz_status import_and_free(const ritz_import_request *request)
{
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};

    return ritz_import(request, &c, &report);
}

static void assert_same_sparse(const ritz_sparse *a, const ritz_sparse *b)
{
    size_t nnz = (size_t)a->colptr[a->ncol];

    assert_int_equal(a->ncol, b->ncol);
    assert_memory_equal(a->colptr, b->colptr,
                        (size_t)(a->ncol + 1) * sizeof *a->colptr);
    assert_memory_equal(a->rowind, b->rowind, nnz * sizeof *a->rowind);
    assert_memory_equal(a->val, b->val, nnz * sizeof *a->val);
}

/* Three masses in a row; node 20 has the first row, and node 4 the last. */
#define HEAD "%%MatrixMarket matrix coordinate real symmetric\n3 3 5\n"
#define STIFFNESS                                                              \
    "1 1  1.5e+03\n1 2 -5.0e+02\n2 2  1.25e+03\n"                              \
    "2 3 -7.5e+02\n3 3  7.5e+02\n"
#define MIRRORED STIFFNESS "2 1 -5.0e+02\n3 2 -7.5e+02\n"
#define MASS     "1 1 2.0\n1 2 0.0\n2 2 3.0\n2 3 0.0\n3 3 1e-3\n"

static const char names[] = "20 1\n7 1\n4 1\n";
static const char dotted[] = "20.1\n7.1\n4.1\n";

static void one_component_is_read_from_each_spelling(void **)
{
    static const struct {
        const char *stiffness, *mass, *dofs;
    } spellings[] = {
        {HEAD STIFFNESS, MASS, dotted},
        {MIRRORED, MASS, names},   /* Abaqus */
        {STIFFNESS, MASS, dotted}, /* CalculiX */
    };
    ritz_import_request request = {.stiffness =
                                       folder_write("K", HEAD STIFFNESS),
                                   .mass = folder_write("M", HEAD MASS),
                                   .dofs = folder_write("D", names)};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) market = {0};

    assert_ok(ritz_import(&request, &market, &report));
    for (size_t k = 0; k < sizeof spellings / sizeof *spellings; k++) {
        RITZ_OWN(ritz_import_report) said = {0};
        RITZ_OWN(ritz_component) c = {0};

        request.stiffness = folder_write("K", spellings[k].stiffness);
        request.mass = folder_write("M", spellings[k].mass);
        request.dofs = folder_write("D", spellings[k].dofs);
        assert_ok(ritz_import(&request, &c, &said));
        assert_string_equal(said.map, "--dofs");
        assert_same_sparse(&c.K, &market.K);
        assert_same_sparse(&c.M, &market.M);
        assert_int_equal(c.num_dofs, 3);
        assert_memory_equal(c.dof, market.dof, 3 * sizeof *c.dof);
    }
    assert_survives_every_allocation(import_and_free(&request));
}

/* A mass whose last row has no entry is a row too small. */
static void files_of_other_sizes_are_refused(void **)
{
    ritz_import_request request = {.stiffness = folder_write("K", STIFFNESS),
                                   .mass =
                                       folder_write("M", "1 1 2.0\n2 2 3.0\n"),
                                   .dofs = folder_write("D", dotted)};

    assert_fails(import_and_free(&request), RITZ_ERR_FORMAT, "has 2 rows");
    request.mass = folder_write("M", "1 1 2.0\n2 2 3.0\n3 3 0.0\n");
    assert_ok(import_and_free(&request));
    request.dofs = folder_write("D", "20.1\n7.1\n");
    assert_fails(import_and_free(&request), RITZ_ERR_FORMAT, "names 2 dofs");
}

/* ---- files of others ---------------------------------------------------- */

/* conrod: as CalculiX 2.20 printed them, with seven digits; blockC3D10: by
   LAPACK, from these matrices. */
static const struct real {
    const char *stiffness, *mass, *dofs, *rows;
    int64_t n;
    double hertz[3], bound[3]; /* half a unit of the last digit */
} reals[] = {
    {"calculix/conrod/conrod.sti",
     "calculix/conrod/conrod.mas",
     "calculix/conrod/conrod.dof",
     NULL,
     2805,
     {5931.729, 10572.56, 13006.49},
     {5e-4, 5e-3, 5e-3}},
    {"abaqus/blockC3D10_STIF1.mtx",
     "abaqus/blockC3D10_MASS1.mtx",
     NULL,
     "123",
     771,
     {451.333341, 452.009851, 607.870197},
     {5e-7, 5e-7, 5e-7}},
};

/* Rigid motions of matrices of 14 digits have frequencies near 9 Hz. */
static void check_real(const char *folder, const struct real *it)
{
    const ritz_span span = {.modes = 9};
    char path[3][512];
    ritz_import_request request = {.stiffness = path[0],
                                   .mass = path[1],
                                   .dofs = it->dofs ? path[2] : NULL,
                                   .rows = it->rows};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    int64_t first = 0;

    snprintf(path[0], sizeof path[0], "%s/%s", folder, it->stiffness);
    snprintf(path[1], sizeof path[1], "%s/%s", folder, it->mass);
    snprintf(path[2], sizeof path[2], "%s/%s", folder,
             it->dofs ? it->dofs : "");
    assert_ok(ritz_import(&request, &c, &report));
    assert_int_equal(c.num_dofs, it->n);
    assert_int_equal(report.num_removed, 0);
    assert_int_equal(c.dof[it->n - 1].grid, it->n / 3);
    assert_int_equal(c.dof[it->n - 1].component, 3);
    assert_ok(ritz_eigen_sparse(&c.K, &c.M, &span, &pairs));
    while (ritz_eigen_hertz(pairs.lambda[first]) < it->hertz[0] / 2.0)
        first++;
    assert_int_equal(first, 6);
    for (int k = 0; k < 3; k++)
        assert_near(ritz_eigen_hertz(pairs.lambda[6 + k]), it->hertz[k],
                    it->bound[k]);
}

static void real_files_have_the_published_frequencies(void **)
{
    const char *folder = getenv("RITZ_EXTERNAL_DATA");

    if (!folder || access(folder, R_OK) != 0) {
        print_message("skipped: no external data\n");
        skip();
    }
    for (size_t k = 0; k < sizeof reals / sizeof *reals; k++)
        check_real(folder, &reals[k]);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_component_is_read_from_each_spelling),
    cmocka_unit_test(files_of_other_sizes_are_refused),
    cmocka_unit_test(real_files_have_the_published_frequencies),
};

TEST_MODULE(import_coordinates, tests, folder_make, folder_remove)
