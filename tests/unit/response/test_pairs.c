/*
 * Pairs of matrices from elsewhere whose numbers are known: oracles.md section
 * 7 (third-party files, RITZ_EXTERNAL_DATA).
 */
#include "foreign.h"
#include "responses.h"
#include "testing.h"

#include <ritz/basis.h>
#include <ritz/import.h>
#include <ritz/matrix.h>
#include <ritz/response.h>

#include <complex.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static bool find(const char *name, char path[static 512])
{
    const char *data = getenv("RITZ_EXTERNAL_DATA");

    if (!data || access(data, R_OK) != 0) {
        print_message("skipped: no external data\n");
        return false;
    }
    snprintf(path, 512, "%s/%s", data, name);
    return true;
}

static bool read_sparse(const char *name, ritz_sparse *out)
{
    char path[512];
    RITZ_OWN(ritz_matrix) matrix = {0};

    if (!find(name, path))
        return false;
    assert_ok(foreign_select(path, &matrix));
    *out = matrix.A;
    matrix.A = (ritz_sparse){0};
    return true;
}

/* x'|K||x|: eps of it is what rounding of K does to the eigenvalue of x. */
static double rounding(const ritz_sparse *K, const ritz_dense *Phi, int64_t k)
{
    const double *x = ritz_dense_col(Phi, k);
    double sum = 0.0;

    for (int64_t j = 0; j < K->ncol; j++)
        for (int64_t p = K->colptr[j]; p < K->colptr[j + 1]; p++)
            sum += fabs(x[K->rowind[p]] * K->val[p] * x[j]);
    return DBL_EPSILON * sum;
}

static void lund_has_its_eigenvalues(void **state)
{
    const double expected[] = {208.236649516, 574.256137708, 1399.127921942};
    const ritz_span span = {.modes = 3};
    ritz_sparse K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    (void)state;
    if (!read_sparse("pairs/lund/lund_a.mtx", &K))
        skip();
    assert_true(read_sparse("pairs/lund/lund_b.mtx", &M));
    assert_ok(ritz_eigen_sparse(&K, &M, &span, &pairs));
    assert_int_equal(pairs.num_rigid, 0);
    for (int64_t k = 0; k < 3; k++)
        assert_near(pairs.lambda[k], expected[k],
                    5e-10 /* printed */ + rounding(&K, &pairs.Phi, k));
    ritz_sparse_free(&K);
    ritz_sparse_free(&M);
}

/* Rows of LF10 as if of three grids: its input and output are row 8. */
static bool import_lf10(ritz_component *out)
{
    const char *const input[] = {"u=2:2"};
    const char *const output[] = {"y=2:2"};
    char K[512], M[512], D[512];
    const ritz_import_request request = {.stiffness = K,
                                         .mass = M,
                                         .damping = D,
                                         .num_inputs = 1,
                                         .input = input,
                                         .num_outputs = 1,
                                         .output = output};
    RITZ_OWN(ritz_import_report) report = {0};

    if (!find("second_order/LF10/K.mtx", K))
        return false;
    find("second_order/LF10/M.mtx", M);
    find("second_order/LF10/D.mtx", D);
    assert_ok(ritz_import(&request, out, &report));
    return true;
}

static void lf10_has_its_frequencies(void **state)
{
    const double omega[] = {1233.70659, 4935.12192, 11109.4949};
    const ritz_span span = {.modes = 3};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    (void)state;
    if (!import_lf10(&c))
        skip();
    assert_int_equal(c.num_dofs, 18);
    assert_ok(ritz_eigen_sparse(&c.K, &c.M, &span, &pairs));
    for (int64_t k = 0; k < 3; k++) {
        const double half = k < 2 ? 5e-6 : 5e-5; /* nine digits */
        const double w = sqrt(pairs.lambda[k]);

        assert_near(w, omega[k], half + rounding(&c.K, &pairs.Phi, k) / w);
    }
}

static void lf10_gives_its_static_gain(void **state)
{
    const ritz_damping none = {0};
    const ritz_grid grid = {.from_hz = 0.0, .to_hz = 1.0, .count = 2};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_response) response = {0};

    (void)state;
    if (!import_lf10(&c))
        skip();
    assert_ok(direct_response(&c, &none, 0.0, &grid, &response));
    assert_near(creal(response.H[0]), 2.06988240e-3, 5e-12);
    assert_near(cimag(response.H[0]), 0.0, 0.0);
}

/* Its three matrices were rounded to 17 digits: half an ulp each. */
static void lf10_is_damped_in_proportion(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_sparse) rayleigh = {0}, rest = {0};
    RITZ_OWN(ritz_dense) left = {0}, size = {0};

    (void)state;
    if (!import_lf10(&c))
        skip();
    assert_ok(ritz_sparse_add(100.0, &c.M, 0.01, &c.K, &rayleigh));
    assert_ok(ritz_sparse_add(1.0, &c.D, -1.0, &rayleigh, &rest));
    assert_ok(ritz_sparse_dense(&rest, &left));
    assert_ok(ritz_sparse_dense(&c.D, &size));
    for (int64_t k = 0; k < left.nrow * left.ncol; k++)
        assert_near(left.val[k], 0.0, 2.0 * DBL_EPSILON * fabs(size.val[k]));
}

static void dmig_pair_has_its_frequencies(void **state)
{
    const double hertz[] = {1.033490, 2.130694};
    const ritz_span span = {.modes = 2};
    char K[512], M[512];
    const ritz_import_request request = {.stiffness = K, .mass = M};
    RITZ_OWN(ritz_import_report) report = {0};
    RITZ_OWN(ritz_component) c = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    (void)state;
    if (!find("nastran/pynastran/dmig.pch:KAAX", K))
        skip();
    find("nastran/pynastran/dmig.pch:MAAX", M);
    assert_ok(ritz_import(&request, &c, &report));
    assert_ok(ritz_eigen_sparse(&c.K, &c.M, &span, &pairs));
    for (int64_t k = 0; k < 2; k++)
        assert_near(ritz_eigen_hertz(pairs.lambda[pairs.num_rigid + k]),
                    hertz[k], 5e-7);
}

/* The rotor's rows 1 to 6 are two nodes on its axis, here grids 1 and 2. */
static void an_interface_on_a_line_is_refused(void **state)
{
    int64_t rows[] = {0, 1, 2, 3, 4, 5};
    RITZ_OWN(ritz_component) c = {.num_dofs = 345};
    ritz_request request = RITZ_REQUEST_NONE;
    ritz_basis none = {0};

    (void)state;
    if (!read_sparse("ansys/rotorAnsysStiffnessMatrixSparse.txt", &c.K))
        skip();
    assert_true(read_sparse("ansys/rotorAnsysMassMatrixSparse.txt", &c.M));
    c.dof = calloc(345, sizeof *c.dof);
    assert_non_null(c.dof);
    for (int64_t i = 0; i < 345; i++)
        c.dof[i] = (ritz_dof){i / 3 + 1, i % 3 + 1};
    assert_ok(ritz_component_settle(&c, false));
    request.component = &c;
    request.modes = 4;
    request.attached = (ritz_dofs){6, rows};
    assert_fails(ritz_basis_make(&ritz_method_craig_bampton, &request, &none),
                 RITZ_ERR_SINGULAR,
                 "1 motion(s) cost no energy; largest at grid ");
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(lund_has_its_eigenvalues),
    cmocka_unit_test(lf10_has_its_frequencies),
    cmocka_unit_test(lf10_gives_its_static_gain),
    cmocka_unit_test(lf10_is_damped_in_proportion),
    cmocka_unit_test(dmig_pair_has_its_frequencies),
    cmocka_unit_test(an_interface_on_a_line_is_refused),
};

TEST_MODULE(pairs, tests, NULL, NULL)
