#include "testing.h"

#include "bar.h"
#include "frame.h"
#include "project.h"
#include "spring_chain.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>
#include <ritz/model.h>

#include <lapacke.h>

#include <float.h>
#include <stdlib.h>

enum { MASSES = 30, MODES = 8, DAMPERS = 3, PRINTED = 4 };

static const int64_t damped[DAMPERS] = {2, 9, 17};

/*
 * Rounding of a solve with K of the chain, whose condition number is about
 * 4 k_max m_max / (k_min m_min w_1^2) = 4 * 1600 * 1.4 / 2.7 = 3e3.
 */
static const double solve_error = MASSES * DBL_EPSILON * 3e3;

typedef struct fixture {
    ritz_component chain;
    ritz_request request;
    ritz_basis basis;
} fixture;

static int set_up(void **state)
{
    static fixture f;

    f = (fixture){.request = RITZ_REQUEST_NONE};
    f.request.component = &f.chain;
    f.request.modes = MODES;
    assert_ok(spring_chain(MASSES, false, &f.chain));
    assert_ok(spring_chain_damp(&f.chain, DAMPERS, damped, 150.0, -200.0));
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &f.request, &f.basis));
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->chain);
    ritz_basis_free(&f->basis);
    return 0;
}

static void columns_are_normal_then_static(void **state)
{
    const ritz_columns *columns = &((fixture *)*state)->basis.columns;

    assert_int_equal(columns->count, MODES + DAMPERS);
    for (int64_t j = 0; j < MODES + DAMPERS; j++) {
        assert_int_equal(columns->kind[j],
                         j < MODES ? RITZ_COLUMN_NORMAL : RITZ_COLUMN_STATIC);
        assert_int_equal(columns->dof[j], -1);
    }
}

/*
 * A pair of unit forces across spring s stretches it by 1 / k_s and moves all
 * masses beyond it: that is K^-1 b. The modes of the basis have their share.
 */
static void modes_and_static_vector_make_the_static_answer(void **state)
{
    fixture *f = *state;
    const ritz_dense *T = &f->basis.T;

    for (int64_t d = 0; d < DAMPERS; d++)
        for (int64_t i = 0; i < MASSES; i++) {
            const double *b = ritz_dense_col(&f->chain.dampers.B, d);
            double exact =
                i < damped[d] ? 0.0 : 1.0 / spring_chain_stiffness(damped[d]);
            double sum = ritz_dense_col(T, MODES + d)[i];

            for (int64_t k = 0; k < MODES; k++) {
                const double *phi = ritz_dense_col(T, k);
                double w =
                    2.0 * 3.14159265358979323846 * f->basis.columns.hertz[k];
                double share = phi[damped[d]] - phi[damped[d] - 1];

                sum += phi[i] * share / (w * w);
            }
            assert_near(b[damped[d]], 1.0, 0.0);
            assert_near(sum, exact,
                        solve_error / spring_chain_stiffness(damped[d]));
        }
}

static void matrices_are_block_diagonal(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_dense) Kr = project(&f->chain.K, &f->basis.T);
    RITZ_OWN(ritz_dense) Mr = project(&f->chain.M, &f->basis.T);

    for (int64_t j = 0; j < MODES + DAMPERS; j++)
        for (int64_t i = 0; i < MODES && i < j; i++) {
            double mass = sqrt(ritz_dense_col(&Mr, j)[j]);
            double stiffness =
                sqrt(ritz_dense_col(&Kr, i)[i] * ritz_dense_col(&Kr, j)[j]);

            assert_near(ritz_dense_col(&Mr, j)[i], 0.0, solve_error * mass);
            assert_near(ritz_dense_col(&Kr, j)[i], 0.0,
                        solve_error * stiffness);
        }
}

/* A model as the damped eigenproblem takes it: x = T q of the chain. */
typedef struct small_model {
    int r;
    double K[MASSES * MASSES], B[MASSES * DAMPERS]; /* M = I */
} small_model;

/* In the modes of the subspace, where the mass is one. */
static void make_small(const fixture *f, const ritz_dense *T, small_model *out)
{
    RITZ_OWN(ritz_dense) K = project(&f->chain.K, T);
    RITZ_OWN(ritz_dense) M = project(&f->chain.M, T);
    RITZ_OWN(ritz_dense) X = {0}, B = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    assert_ok(ritz_dense_mul(T, &pairs.Phi, &X));
    assert_ok(ritz_dense_mul_tn(&X, &f->chain.dampers.B, &B));
    out->r = (int)X.ncol;
    memset(out->K, 0, sizeof out->K);
    memcpy(out->B, B.val, (size_t)(B.nrow * B.ncol) * sizeof *B.val);
    for (int j = 0; j < out->r; j++)
        out->K[j + j * out->r] = pairs.lambda[j];
    for (int d = 0; d < DAMPERS; d++)
        for (int j = 0; j < out->r; j++)
            for (int i = 0; i < out->r; i++)
                out->K[i + j * out->r] += f->chain.dampers.k[d] *
                                          out->B[i + d * out->r] *
                                          out->B[j + d * out->r];
}

/* Frequency and damping in % of the lowest oscillating modes, by |s|. */
static void damp(const small_model *model, double c, double w[PRINTED],
                 double zeta[PRINTED])
{
    static double A[4 * MASSES * MASSES];
    double re[2 * MASSES], im[2 * MASSES];
    int r = model->r;

    memset(A, 0, sizeof A);
    for (int j = 0; j < r; j++) {
        A[j + (r + j) * 2 * r] = 1.0;
        for (int i = 0; i < r; i++) {
            A[r + i + j * 2 * r] = -model->K[i + j * r];
            for (int d = 0; d < DAMPERS; d++)
                A[r + i + (r + j) * 2 * r] -=
                    c * model->B[i + d * r] * model->B[j + d * r];
        }
    }
    assert_int_equal(LAPACKE_dgeev(LAPACK_COL_MAJOR, 'N', 'N', 2 * r, A, 2 * r,
                                   re, im, NULL, 1, NULL, 1),
                     0);
    for (int k = 0; k < PRINTED; k++)
        w[k] = HUGE_VAL;
    for (int j = 0; j < 2 * r; j++) {
        double size = hypot(re[j], im[j]);
        int k = PRINTED;

        if (!(im[j] > 0.0))
            continue;
        for (; k > 0 && size < w[k - 1]; k--)
            if (k < PRINTED) {
                w[k] = w[k - 1];
                zeta[k] = zeta[k - 1];
            }
        if (k < PRINTED) {
            w[k] = size;
            zeta[k] = -100.0 * re[j] / size;
        }
    }
}

/* A column of the table in oracles.md section 5, and the optima below it. */
typedef struct column {
    double w[PRINTED], zeta[PRINTED];
    double best[2], best_zeta; /* c for modes 1 and 2; zeta of mode 2 */
    double digits;             /* of best_zeta */
} column;

/*
 * Six significant digits of w and five decimals of zeta are printed, of w
 * above 10 one decimal fewer.
 */
static void check_column(const small_model *model, const column *expected)
{
    double w[PRINTED], zeta[PRINTED];
    double most[2] = {0.0, 0.0}, at[2] = {0.0, 0.0};

    damp(model, 150.0, w, zeta);
    for (int k = 0; k < PRINTED; k++) {
        assert_near(w[k], expected->w[k], w[k] < 10.0 ? 5e-7 : 5e-6);
        assert_near(zeta[k], expected->zeta[k], 5e-6);
    }
    for (int step = 1; 10.0 * step <= 1.1 * expected->best[0]; step++) {
        double c = 10.0 * step;

        damp(model, c, w, zeta);
        for (int k = 0; k < 2; k++)
            if (zeta[k] > most[k]) {
                most[k] = zeta[k];
                at[k] = c;
            }
    }
    assert_near(at[0], expected->best[0], 0.0);
    assert_near(at[1], expected->best[1], 0.0);
    assert_near(most[1], expected->best_zeta, expected->digits);
}

static void static_vectors_get_the_damping_right(void **state)
{
    static const column full = {{1.649553, 5.007665, 8.389993, 11.95587},
                                {1.24409, 2.38032, 2.09051, 3.46340},
                                {810, 260},
                                2.793,
                                5e-4};
    static const column ritz = {{1.649553, 5.007663, 8.389981, 11.95581},
                                {1.24408, 2.38033, 2.09076, 3.46761},
                                {810, 260},
                                2.793,
                                5e-4};
    fixture *f = *state;
    small_model model;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) all = {0};

    make_small(f, &f->basis.T, &model);
    check_column(&model, &ritz);
    request.modes = -1;
    assert_ok(ritz_basis_make(&ritz_method_full, &request, &all));
    make_small(f, &all.T, &model);
    check_column(&model, &full);
}

/* As many modes alone misplace the best damper four times over. */
static void modes_alone_get_it_wrong(void **state)
{
    static const column truncated = {{1.648109, 4.960024, 8.264060, 11.53278},
                                     {1.04182, 2.44723, 3.03347, 6.73235},
                                     {3270, 970},
                                     10.11,
                                     5e-3};
    fixture *f = *state;
    ritz_component plain = f->chain;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};
    small_model model;

    plain.dampers = (ritz_dampers){0};
    request.component = &plain;
    request.modes = MODES + DAMPERS;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_int_equal(basis.T.ncol, MODES + DAMPERS);
    make_small(f, &basis.T, &model);
    check_column(&model, &truncated);
}

/*
 * For a free body the answer is that of its flexible part: with loads at the
 * attached dofs the columns are those of macneal-rubin.
 */
static void attached_loads_of_a_free_body_give_macneal_rubin(void **state)
{
    enum { ELEMENTS = 16 };
    int64_t attached[] = {0, 5, ELEMENTS};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) bar = {0};
    RITZ_OWN(ritz_basis) one = {0}, two = {0};

    assert_ok(bar_component(ELEMENTS, &bar));
    request.component = &bar;
    request.attached = (ritz_dofs){3, attached};
    request.modes = 4;
    assert_ok(ritz_basis_make(&ritz_method_macneal_rubin, &request, &one));
    request.choice.given = RITZ_USES_LOADS;
    request.choice.loads = RITZ_LOADS_ATTACHED;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &two));
    assert_int_equal(two.T.ncol, 1 + 4 + 3);
    assert_int_equal(two.columns.kind[0], RITZ_COLUMN_RIGID);
    for (int64_t j = 5; j < two.T.ncol; j++) {
        assert_int_equal(two.columns.kind[j], RITZ_COLUMN_STATIC);
        assert_int_equal(two.columns.dof[j], attached[j - 5]);
    }
    assert_memory_equal(one.T.val, two.T.val,
                        (size_t)(one.T.nrow * one.T.ncol) * sizeof(double));
}

/* Inputs and outputs are loads too; a row of zeros is none. */
static void loads_are_what_is_asked_for(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    ritz_basis basis = {0};
    ritz_io none = f->chain.io;
    const int64_t in[] = {29}, out[] = {4, 11};

    f->chain.io = (ritz_io){0};
    assert_ok(frame_io(&f->chain, 1, in, 2, out));
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_int_equal(basis.T.ncol, MODES + 1 + DAMPERS);
    ritz_basis_free(&basis);
    request.choice.given = RITZ_USES_LOADS;
    request.choice.loads = RITZ_LOADS_OUTPUTS;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_int_equal(basis.T.ncol, MODES + 2);
    assert_string_equal(basis.remark, /* rows of zeros are no loads */
                        "3 damper(s) without a static vector: damping may be "
                        "wrong where frequencies are right, take dampers among "
                        "the loads");
    ritz_basis_free(&basis);
    ritz_io_free(&f->chain.io);
    f->chain.io = none;
}

static void a_damper_given_twice_has_one_vector(void **state)
{
    const int64_t same[] = {9, 9};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) chain = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(spring_chain(MASSES, true, &chain));
    assert_ok(spring_chain_damp(&chain, 2, same, 1.0, 0.0));
    request.component = &chain;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_int_equal(basis.T.ncol, 1 + MODES + 1);
    assert_non_null(strstr(basis.remark, "1 static mode(s) left out"));
    assert_non_null(strstr(basis.remark, "damper 'damper 9'"));
}

/* More modes than there are: all, and no static vector beside them. */
static void more_modes_than_there_are_leave_nothing_to_answer(void **state)
{
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = 2 * MASSES;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_int_equal(basis.T.ncol, MASSES);
    assert_non_null(strstr(basis.remark, "3 static mode(s) left out"));
}

/* A force on a dof without mass is answered there, whatever modes are kept. */
static void a_load_on_a_massless_dof_is_answered(void **state)
{
    static const int64_t row[] = {0, 1, 0, 1}, col[] = {0, 0, 1, 1};
    static const double k[] = {3.0, -2.0, -2.0, 2.0};
    ritz_request request = ((fixture *)*state)->request;
    RITZ_OWN(ritz_component) two = {.num_dofs = 2};
    RITZ_OWN(ritz_basis) basis = {0};
    int64_t zero = 0;

    /* ground -1- mass -2- dof without mass: u = [1, 1.5] / k of a unit force */
    assert_non_null(two.dof = calloc(2, sizeof *two.dof));
    two.dof[0] = (ritz_dof){1, 1};
    two.dof[1] = (ritz_dof){2, 1};
    assert_ok(ritz_sparse_from_triplets(2, 2, 4, row, col, k, &two.K));
    assert_ok(ritz_sparse_from_triplets(2, 2, 1, &zero, &zero, &(double){1.0},
                                        &two.M));
    assert_ok(ritz_component_settle(&two, false));
    assert_ok(frame_io(&two, 1, &(int64_t){1}, 0, NULL));
    request.component = &two;
    request.modes = 1;
    assert_ok(ritz_basis_make(&ritz_method_normal_modes, &request, &basis));
    assert_int_equal(basis.T.ncol, 2); /* w^2 = 1, phi = [1, 1] */
    assert_near(ritz_dense_col(&basis.T, 1)[0], 0.0, 8 * DBL_EPSILON);
    assert_near(ritz_dense_col(&basis.T, 1)[1], 0.5, 8 * DBL_EPSILON);
}

static void loads_that_are_not_there_are_refused(void **state)
{
    ritz_request request = ((fixture *)*state)->request;
    int64_t twice[] = {4, 4};
    ritz_basis none = {0};

    request.choice.given = RITZ_USES_LOADS;
    request.choice.loads = RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS;
    assert_fails(ritz_basis_make(&ritz_method_normal_modes, &request, &none),
                 RITZ_ERR_ARGUMENT,
                 "there is no load to respond to, no input or output");
    request.choice.loads = RITZ_LOADS_ATTACHED;
    assert_fails(ritz_basis_make(&ritz_method_normal_modes, &request, &none),
                 RITZ_ERR_ARGUMENT, "no attached dof");
    request.attached = (ritz_dofs){2, twice};
    assert_fails(ritz_basis_make(&ritz_method_normal_modes, &request, &none),
                 RITZ_ERR_ARGUMENT, "listed twice");
    request.choice.given |= RITZ_USES_INNER;
    assert_fails(ritz_basis_make(&ritz_method_normal_modes, &request, &none),
                 RITZ_ERR_ARGUMENT, "has no 'inner' to choose");
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = {0};

    assert_survives_every_allocation(
        ritz_method_normal_modes.make(&f->request, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(columns_are_normal_then_static),
    cmocka_unit_test(modes_and_static_vector_make_the_static_answer),
    cmocka_unit_test(matrices_are_block_diagonal),
    cmocka_unit_test(static_vectors_get_the_damping_right),
    cmocka_unit_test(modes_alone_get_it_wrong),
    cmocka_unit_test(attached_loads_of_a_free_body_give_macneal_rubin),
    cmocka_unit_test(loads_are_what_is_asked_for),
    cmocka_unit_test(a_damper_given_twice_has_one_vector),
    cmocka_unit_test(more_modes_than_there_are_leave_nothing_to_answer),
    cmocka_unit_test(a_load_on_a_massless_dof_is_answered),
    cmocka_unit_test(loads_that_are_not_there_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(normal_modes, tests, set_up, tear_down)
