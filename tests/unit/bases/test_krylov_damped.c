#include "testing.h"

#include "frame.h"
#include "matrices.h"
#include "moments.h"
#include "project.h"
#include "truss.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <stdio.h>
#include <stdlib.h>

enum { DOFS = 48, LOADS = 3 };

/* Solves of a truss: eps n times the condition of K, 1e5 for 12 bays. */
static const double solve_error = DOFS * DBL_EPSILON * 1e5;

/* A cantilever truss with dampers that no damping ratio can stand for. */
typedef struct fixture {
    ritz_component truss;
    ritz_request request;
} fixture;

/* Dashpots c between dofs (b < 0: ground), and g (e_a e_b' - e_b e_a'). */
static void set_damping(ritz_component *c, int64_t count,
                        const int64_t (*between)[2], double dashpot,
                        double gyroscopic)
{
    int64_t row[32], col[32];
    double val[32];
    int64_t k = 0;

    ritz_sparse_free(&c->D);
    for (int64_t i = 0; i < count; i++) {
        int64_t a = between[i][0];
        int64_t b = between[i][1];

        row[k] = col[k] = a;
        val[k++] = dashpot;
        if (b < 0)
            continue;
        row[k] = col[k] = b;
        val[k++] = dashpot;
        row[k] = a;
        col[k] = b;
        val[k++] = gyroscopic - dashpot;
        row[k] = b;
        col[k] = a;
        val[k++] = -gyroscopic - dashpot;
    }
    assert_ok(ritz_sparse_from_triplets(c->num_dofs, c->num_dofs, k, row, col,
                                        val, &c->D));
}

static const int64_t dashpots[][2] = {{2, 11}, {16, 23}, {47, -1}};

static int set_up(void **state)
{
    static fixture f;
    static const int64_t in[] = {9, 40};

    f = (fixture){.request = RITZ_REQUEST_NONE};
    assert_ok(truss_component(&truss_cantilever48, &f.truss));
    assert_ok(frame_io(&f.truss, 2, in, 1, &(int64_t){47}));
    set_damping(&f.truss, 3, dashpots, 300.0, 0.0);
    f.request.component = &f.truss;
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->truss);
    return 0;
}

static ritz_basis basis_of(ritz_request request, int64_t vectors)
{
    ritz_basis basis = {0};

    request.modes = vectors;
    assert_ok(ritz_basis_make(&ritz_method_krylov_damped, &request, &basis));
    return basis;
}

static void check_moments(const fixture *f, const ritz_request *request,
                          int64_t vectors, int kept)
{
    RITZ_OWN(ritz_basis) basis = basis_of(*request, vectors);
    moments_model full = moments_full(request->component);
    moments_model part = moments_reduced(request->component, &basis.T);

    (void)f;
    assert_int_equal(basis.T.ncol, vectors);
    moments_agree(&full, &part, nan(""), kept, solve_error);
    moments_free(&full);
    moments_free(&part);
}

static void inputs_alone_keep_a_moment_a_block(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;

    request.choice.loads = RITZ_LOADS_INPUTS;
    for (int blocks = 1; blocks <= 6; blocks++)
        check_moments(f, &request, 2 * (int64_t)blocks, blocks);
}

static void inputs_and_outputs_keep_two(void **state)
{
    fixture *f = *state;

    for (int blocks = 1; blocks <= 5; blocks++)
        check_moments(f, &f->request, LOADS * (int64_t)blocks, 2 * blocks);
}

/* Blocks of krylov keep what D does not touch: the static gain, and no more. */
static void undamped_vectors_keep_fewer(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};
    moments_model full = moments_full(&f->truss), part = {0};

    request.modes = 2 * LOADS;
    assert_ok(ritz_basis_make(&ritz_method_krylov, &request, &basis));
    part = moments_reduced(&f->truss, &basis.T);
    moments_agree(&full, &part, nan(""), 2, solve_error);
    assert_true(moments_differ(&full, &part, nan(""), 3) > 1e3 * solve_error);
    moments_free(&full);
    moments_free(&part);
}

/* Forty vectors of forty-eight: raw ones are one vector after some fifteen. */
static void long_chains_stay_independent(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dense) G = {0};

    request.choice.loads = RITZ_LOADS_OUTPUTS;
    basis = basis_of(request, 40);
    G = project(&f->truss.K, &basis.T);
    assert_int_equal(basis.T.ncol, 40);
    for (int64_t j = 0; j < 40; j++)
        ritz_dense_col(&G, j)[j] -= 1.0;
    assert_near(ritz_dense_max(&G), 0.0, solve_error);
}

static void without_damping_the_span_is_that_of_krylov(void **state)
{
    fixture *f = *state;
    ritz_component still = f->truss;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) undamped = {0};

    still.D = (ritz_sparse){0};
    request.component = &still;
    RITZ_OWN(ritz_basis) damped = basis_of(request, 4 * LOADS);
    request.modes = 4 * LOADS;
    assert_ok(ritz_basis_make(&ritz_method_krylov, &request, &undamped));
    assert_near(outside(&still.K, &damped.T, &undamped.T), 0.0, solve_error);
    assert_non_null(strstr(damped.remark, "there is no damping"));
}

/* Damping by words and by a matrix: one span. */
static void stated_rayleigh_damping_is_a_matrix(void **state)
{
    fixture *f = *state;
    const double a = 3.0;
    const double b = 1e-4;
    ritz_component stated = f->truss, matrix = f->truss;
    ritz_request request = f->request;

    stated.D = matrix.D = (ritz_sparse){0};
    assert_ok(ritz_sparse_add(a, &f->truss.M, b, &f->truss.K, &matrix.D));
    request.component = &matrix;
    RITZ_OWN(ritz_basis) by_matrix = basis_of(request, 9);
    request.component = &stated;
    (void)snprintf(stated.damping, sizeof stated.damping, "rayleigh 3 1e-4");
    RITZ_OWN(ritz_basis) by_text = basis_of(request, 9);
    (void)snprintf(stated.damping, sizeof stated.damping, "modal 0.01");
    request.choice.given = RITZ_USES_DAMPING;
    request.choice.damping =
        (ritz_damping){.kind = RITZ_DAMPING_RAYLEIGH, .a = a, .b = b};
    RITZ_OWN(ritz_basis) by_choice = basis_of(request, 9);
    assert_near(outside(&stated.K, &by_matrix.T, &by_text.T), 0.0, solve_error);
    assert_near(outside(&stated.K, &by_matrix.T, &by_choice.T), 0.0,
                solve_error);
    ritz_sparse_free(&matrix.D);
}

/*
 * A discrete damper with a spring, kept apart, counts as D and K do, and its
 * spring as any stiffness where damping is proportional to that.
 */
static void discrete_dampers_count(void **state)
{
    fixture *f = *state;
    ritz_component apart = f->truss, within = {0};
    ritz_request request = f->request;

    apart.D = (ritz_sparse){0};
    assert_ok(ritz_dampers_new(DOFS, 1, &apart.dampers));
    (void)snprintf(apart.dampers.name[0], RITZ_NAME_SIZE, "strut");
    apart.dampers.c[0] = 300.0;
    apart.dampers.k[0] = 1e5;
    ritz_dense_col(&apart.dampers.B, 0)[47] = 1.0;
    assert_ok(truss_component(&truss_cantilever48, &within));
    assert_ok(ritz_dampers_copy(&apart.dampers, &within.dampers));
    assert_ok(ritz_component_install(&within));
    ritz_dampers_free(&within.dampers);
    ritz_io_free(&within.io);
    within.io = f->truss.io;
    request.choice.given = RITZ_USES_DAMPING;
    request.choice.damping =
        (ritz_damping){.kind = RITZ_DAMPING_RAYLEIGH, .a = 3.0, .b = 1e-2};
    request.component = &apart;
    RITZ_OWN(ritz_basis) one = basis_of(request, 9);
    request.component = &within;
    RITZ_OWN(ritz_basis) other = basis_of(request, 9);
    assert_near(outside(&within.K, &other.T, &one.T), 0.0, solve_error);
    within.io = (ritz_io){0};
    ritz_dampers_free(&apart.dampers);
    ritz_component_free(&within);
}

/* A gyroscope: D' goes with outputs, and as many moments are kept. */
static void an_unsymmetric_matrix_keeps_its_moments(void **state)
{
    fixture *f = *state;
    static const int64_t rotor[][2] = {{30, 33}, {20, 27}};
    ritz_component spun = f->truss;
    ritz_request request = f->request;

    spun.D = (ritz_sparse){0};
    set_damping(&spun, 2, rotor, 100.0, 500.0);
    request.component = &spun;
    for (int blocks = 1; blocks <= 4; blocks++)
        check_moments(f, &request, LOADS * (int64_t)blocks, 2 * blocks);
    ritz_sparse_free(&spun.D);
}

static void the_mass_inner_product_keeps_them_too(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;

    request.choice.inner = RITZ_INNER_MASS;
    check_moments(f, &request, 3 * LOADS, 6);
}

/* H(s) of a dense model, one output. */
static double _Complex transfer(const moments_model *m, double _Complex s)
{
    int n = (int)m->K.nrow;
    double _Complex *Z = calloc((size_t)n * (size_t)n, sizeof *Z);
    double _Complex *x = calloc((size_t)n, sizeof *x);
    int *pivot = calloc((size_t)n, sizeof *pivot);
    double _Complex sum = 0.0;

    assert_true(Z && x && pivot);
    for (int64_t k = 0; k < (int64_t)n * n; k++)
        Z[k] = m->K.val[k] + s * m->D.val[k] + s * s * m->M.val[k];
    for (int i = 0; i < n; i++)
        x[i] = m->B.val[i];
    assert_int_equal(LAPACKE_zgesv(LAPACK_COL_MAJOR, n, 1, Z, n, pivot, x, n),
                     0);
    for (int i = 0; i < n; i++)
        sum += ritz_dense_col(&m->C, i)[0] * x[i];
    free(Z);
    free(x);
    free(pivot);
    return sum;
}

/*
 * A free truss on two dashpots to ground: D moves the body as a whole. At rest
 * the dashpots push back as hard as the input does, so that their answers
 * belong to the first block: three vectors, and a second block of states that
 * brings dashpots only. Two moments are kept, and the error falls by 2^2 when s
 * halves; without D Phi_r among the loads it would not fall at all.
 */
static void damping_of_rigid_motion_is_answered(void **state)
{
    static const int64_t tether[][2] = {{70, -1}, {10, -1}};
    RITZ_OWN(ritz_component) body = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    moments_model full = {0}, part = {0};
    double error[2];

    (void)state;
    assert_ok(truss_component(&truss_free72, &body));
    assert_ok(frame_io(&body, 1, &(int64_t){1}, 1, &(int64_t){51}));
    set_damping(&body, 2, tether, 400.0, 0.0);
    request.component = &body;
    request.choice.loads = RITZ_LOADS_INPUTS;
    basis = basis_of(request, 3);
    full = moments_full(&body);
    part = moments_reduced(&body, &basis.T);
    for (int k = 0; k < 2; k++) {
        double _Complex s = (k ? 5.0 : 10.0) * (double _Complex)_Complex_I;

        error[k] = cabs(transfer(&full, s) - transfer(&part, s));
    }
    assert_int_equal(basis.columns.kind[2], RITZ_COLUMN_RIGID);
    assert_int_equal(basis.T.ncol, 3 + 3);
    assert_true(error[1] * 4.0 <= error[0] * 1.1);
    moments_free(&full);
    moments_free(&part);
}

/* K4 of the truss: structural damping at three dofs. */
static void set_loss(ritz_component *c)
{
    int64_t row[3] = {0, 13, 40};
    double val[3] = {2e6, 1e6, 3e6};

    ritz_sparse_free(&c->K4);
    assert_ok(ritz_sparse_from_triplets(c->num_dofs, c->num_dofs, 3, row, row,
                                        val, &c->K4));
}

/* A dense complex model: Z(s) = s^2 M + s D + K + i K4. */
typedef struct wave_model {
    int n, p, q;
    double _Complex *K; /* K + i K4 */
    double *M, *D, *B, *C;
} wave_model;

static double *dense_of(const ritz_sparse *A, const ritz_dense *T)
{
    int64_t n = T->ncol;
    double *out = calloc((size_t)(n * n), sizeof *out);

    assert_non_null(out);
    if (A->colptr) {
        RITZ_OWN(ritz_dense) P = project(A, T);

        memcpy(out, P.val, (size_t)(n * n) * sizeof *out);
    }
    return out;
}

static wave_model waves_of(const ritz_component *c, const ritz_dense *T)
{
    wave_model m = {(int)T->ncol,
                    (int)c->io.num_inputs,
                    (int)c->io.num_outputs,
                    NULL,
                    NULL,
                    NULL,
                    NULL,
                    NULL};
    double *K = dense_of(&c->K, T), *K4 = dense_of(&c->K4, T);
    RITZ_OWN(ritz_dense) B = {0}, C = {0};

    m.M = dense_of(&c->M, T);
    m.D = dense_of(&c->D, T);
    m.K = calloc((size_t)m.n * (size_t)m.n, sizeof *m.K);
    assert_non_null(m.K);
    for (int k = 0; k < m.n * m.n; k++)
        m.K[k] = K[k] + K4[k] * (double _Complex)_Complex_I;
    free(K);
    free(K4);
    assert_ok(ritz_dense_mul_tn(T, &c->io.B, &B));
    assert_ok(ritz_dense_mul(&c->io.C, T, &C));
    m.B = B.val;
    m.C = C.val;
    B.val = C.val = NULL;
    return m;
}

static void waves_free(wave_model *m)
{
    free(m->K);
    free(m->M);
    free(m->D);
    free(m->B);
    free(m->C);
}

/*
 * Taylor coefficient j of C Z(s)^-1 B about s (q x p), times unit^j, by the
 * recurrence X_0 = Z^-1 B, X_j = -Z^-1 ((2 s M + D) X_j-1 + M X_j-2).
 */
static void wave_moments(const wave_model *m, double _Complex s, double unit,
                         int count, double _Complex *out)
{
    size_t n = (size_t)m->n, p = (size_t)m->p, q = (size_t)m->q;
    double _Complex *Z = calloc(n * n, sizeof *Z);
    double _Complex *X = calloc(3 * n * p, sizeof *X); /* X_j, X_j-1, X_j-2 */
    int *pivot = calloc(n, sizeof *pivot);

    assert_true(Z && X && pivot);
    for (size_t k = 0; k < n * n; k++)
        Z[k] = m->K[k] + s * m->D[k] + s * s * m->M[k];
    assert_int_equal(
        LAPACKE_zgetrf(LAPACK_COL_MAJOR, m->n, m->n, Z, m->n, pivot), 0);
    for (int j = 0; j < count; j++) {
        for (size_t c = 0; c < p; c++)
            for (size_t i = 0; i < n; i++) {
                double _Complex sum = j == 0 ? m->B[i + c * n] : 0.0;

                for (size_t k = 0; k < n && j > 0; k++)
                    sum -= unit *
                               (2.0 * s * m->M[i + k * n] + m->D[i + k * n]) *
                               X[n * p + k + c * n] +
                           unit * unit * m->M[i + k * n] *
                               X[2 * n * p + k + c * n];
                X[i + c * n] = sum;
            }
        assert_int_equal(LAPACKE_zgetrs(LAPACK_COL_MAJOR, 'N', m->n, m->p, Z,
                                        m->n, pivot, X, m->n),
                         0);
        for (size_t c = 0; c < p; c++)
            for (size_t r = 0; r < q; r++) {
                double _Complex sum = 0.0;

                for (size_t i = 0; i < n; i++)
                    sum += m->C[r + i * q] * X[i + c * n];
                out[(size_t)j * p * q + r + c * q] = sum;
            }
        memmove(X + n * p, X, 2 * n * p * sizeof *X);
    }
    free(Z);
    free(X);
    free(pivot);
}

enum { MOST_MOMENTS = 8, MOST_CHANNELS = 4 };

/* For each j < count: the largest difference of moment j between the component
   and its projection onto T, relative to the largest entry. */
static void differ_about(const ritz_component *c, const ritz_dense *T,
                         double hertz, int count, double *out)
{
    double _Complex a[MOST_MOMENTS * MOST_CHANNELS] = {0.0};
    double _Complex b[MOST_MOMENTS * MOST_CHANNELS] = {0.0};
    double _Complex s =
        2.0 * 3.14159265358979323846 * hertz * (double _Complex)_Complex_I;
    RITZ_OWN(ritz_dense) whole = {0};
    wave_model full, part;
    int size = 0;

    assert_ok(ritz_dense_identity(c->num_dofs, &whole));
    full = waves_of(c, &whole);
    part = waves_of(c, T);
    size = full.p * full.q;
    wave_moments(&full, s, 50.0, count, a);
    wave_moments(&part, s, 50.0, count, b);
    for (int j = 0; j < count; j++) {
        double gap = 0.0, all = 0.0;

        for (int k = j * size; k < (j + 1) * size; k++) {
            gap = fmax(gap, cabs(a[k] - b[k]));
            all = fmax(all, cabs(a[k]));
        }
        out[j] = gap / all;
    }
    waves_free(&full);
    waves_free(&part);
}

/* Relative error of a moment by the two dense recurrences; 4e-12 was
   measured. */
#define WAVE_ERROR (0.02 * solve_error)

/* The first `kept` moments about the point agree with those of the component.
   With a single block the next moment differs; more blocks make its difference
   small as well. */
static void check_waves(const ritz_request *request, int64_t vectors,
                        double hertz, int kept)
{
    RITZ_OWN(ritz_basis) basis = basis_of(*request, vectors);
    double error[MOST_MOMENTS] = {0.0};

    assert_true(kept < MOST_MOMENTS);
    differ_about(request->component, &basis.T, hertz, kept + 1, error);
    for (int j = 0; j < kept; j++)
        assert_near(error[j], 0.0, WAVE_ERROR);
    assert_true(vectors > 2 * LOADS || error[kept] > 1e-6);
}

static void shift_to(ritz_request *request, int64_t count, const double *hertz)
{
    request->choice.given |= RITZ_USES_SHIFTS;
    request->choice.num_shifts = count;
    for (int64_t k = 0; k < count; k++)
        request->choice.shift_hz[k] = hertz[k];
}

/*
 * About a frequency above 0 Hz each load gives two vectors, real and imaginary
 * part. A block keeps two moments if inputs and outputs are loads, one moment
 * if inputs alone are.
 */
static void moments_about_a_frequency_are_kept(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;

    shift_to(&request, 1, &(double){7.0});
    for (int blocks = 1; blocks <= 3; blocks++)
        check_waves(&request, 2 * LOADS * (int64_t)blocks, 7.0, 2 * blocks);
    request.choice.loads = RITZ_LOADS_INPUTS;
    for (int blocks = 1; blocks <= 4; blocks++)
        check_waves(&request, 4 * (int64_t)blocks, 7.0, blocks);
}

/* Blocks of vectors are added about each expansion point in turn; a block about
   0 Hz has half as many vectors as one about another frequency. */
static void several_points_keep_moments_each(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;

    shift_to(&request, 2, (double[]){11.0, 0.0});
    check_waves(&request, 3 * LOADS, 0.0, 2);
    check_waves(&request, 3 * LOADS, 11.0, 2);
    check_waves(&request, 6 * LOADS, 11.0, 4);
    shift_to(&request, 2, (double[]){4.0, 11.0});
    check_waves(&request, 4 * LOADS, 4.0, 2);
    check_waves(&request, 4 * LOADS, 11.0, 2);
}

/* K4 is part of Z(s) at every expansion point, 0 Hz included. */
static void structural_damping_is_expanded_too(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    ritz_component still;
    double without[1] = {0.0};
    RITZ_OWN(ritz_basis) blind = {0};

    set_loss(&f->truss);
    check_waves(&request, 2 * LOADS, 0.0, 2);
    check_waves(&request, 4 * LOADS, 0.0, 4);
    shift_to(&request, 1, &(double){7.0});
    check_waves(&request, 4 * LOADS, 7.0, 4);
    still = f->truss;
    still.K4 = (ritz_sparse){0};
    request.component = &still;
    blind = basis_of(request, 2 * LOADS);
    differ_about(&f->truss, &blind.T, 7.0, 1, without);
    assert_true(without[0] > 1e3 * WAVE_ERROR);
}

static void gyroscopic_models_keep_moments_about_a_frequency(void **state)
{
    fixture *f = *state;
    static const int64_t rotor[][2] = {{30, 33}, {20, 27}};
    ritz_component spun = f->truss;
    ritz_request request = f->request;

    spun.D = (ritz_sparse){0};
    set_damping(&spun, 2, rotor, 100.0, 500.0);
    request.component = &spun;
    shift_to(&request, 1, &(double){7.0});
    for (int blocks = 1; blocks <= 3; blocks++)
        check_waves(&request, 2 * LOADS * (int64_t)blocks, 7.0, 2 * blocks);
    ritz_sparse_free(&spun.D);
}

/* Of a free body, whose rigid vectors are known to eps lambda_max over the
   lowest flexible eigenvalue: 3e-11 measured on the kernels of OpenBLAS. */
#define FREE_ERROR (4.0 * WAVE_ERROR)

/* A free truss with dampers to ground: D couples rigid and elastic motion, and
   the moments contain both. */
static void free_bodies_keep_their_moments(void **state)
{
    static const int64_t tether[][2] = {{70, -1}, {10, -1}};
    RITZ_OWN(ritz_component) body = {0};
    ritz_request request = RITZ_REQUEST_NONE;

    (void)state;
    assert_ok(truss_component(&truss_free72, &body));
    assert_ok(frame_io(&body, 1, &(int64_t){1}, 1, &(int64_t){51}));
    set_damping(&body, 2, tether, 400.0, 0.0);
    request.component = &body;
    request.modes = 0;
    shift_to(&request, 1, &(double){9.0});
    for (int blocks = 1; blocks <= 2; blocks++) {
        RITZ_OWN(ritz_basis) basis = basis_of(request, 4 * (int64_t)blocks);
        double error[MOST_MOMENTS] = {0.0};

        assert_int_equal(basis.T.ncol, 3 + 4 * blocks);
        differ_about(&body, &basis.T, 9.0, 2 * blocks, error);
        for (int j = 0; j < 2 * blocks; j++)
            assert_near(error[j], 0.0, FREE_ERROR);
    }
}

/*
 * A free truss with structural damping K4 = 0.05 K, expanded about 0 Hz. Only
 * the elastic part is expanded, because K4 does not act on rigid motion. As two
 * moments are kept, the error of the elastic response falls by 2^2 when s
 * halves.
 */
static void free_bodies_with_structural_damping_keep_two_moments(void **state)
{
    RITZ_OWN(ritz_component) body = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_basis) basis = {0};
    double error[2][1], size[2];

    (void)state;
    assert_ok(truss_component(&truss_free72, &body));
    assert_ok(frame_io(&body, 1, &(int64_t){1}, 1, &(int64_t){51}));
    assert_ok(ritz_sparse_add(0.05, &body.K, 0.0, &body.M, &body.K4));
    request.component = &body;
    basis = basis_of(request, 4);
    assert_int_equal(basis.T.ncol, 3 + 4);
    for (int k = 0; k < 2; k++) {
        double hertz = k ? 1.0 : 2.0;

        differ_about(&body, &basis.T, hertz, 1, error[k]);
        size[k] = error[k][0] / (hertz * hertz); /* rigid: |H| ~ 1 / s^2 */
    }
    assert_true(error[0][0] < 1e-3);
    assert_true(size[1] * 3.6 <= size[0]);
}

static void requests_that_make_no_sense_are_refused(void **state)
{
    fixture *f = *state;
    ritz_component stated = f->truss;
    ritz_request request = f->request;
    ritz_basis none = {0};

    request.modes = 6;
    request.component = &stated;
    (void)snprintf(stated.damping, sizeof stated.damping, "modal 0.01");
    assert_fails(ritz_basis_make(&ritz_method_krylov_damped, &request, &none),
                 RITZ_ERR_ARGUMENT, "ratios of modes make no matrix D");
    stated.damping[0] = '\0';
    request.choice.loads = RITZ_LOADS_DAMPERS;
    assert_fails(ritz_basis_make(&ritz_method_krylov_damped, &request, &none),
                 RITZ_ERR_ARGUMENT, "there is no load to respond to");
    request.choice.loads = 0;
    request.modes = -1;
    request.up_to_hz = 3.0;
    assert_fails(ritz_basis_make(&ritz_method_krylov_damped, &request, &none),
                 RITZ_ERR_ARGUMENT, "ask for a number of them");
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    ritz_request request = f->request;
    RITZ_OWN(ritz_basis) basis = {0}, again = {0};

    request.modes = 7;
    assert_survives_every_allocation(
        ritz_method_krylov_damped.make(&request, &basis));
    shift_to(&request, 2, (double[]){0.0, 7.0});
    assert_survives_every_allocation(
        ritz_method_krylov_damped.make(&request, &again));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(inputs_alone_keep_a_moment_a_block),
    cmocka_unit_test(inputs_and_outputs_keep_two),
    cmocka_unit_test(undamped_vectors_keep_fewer),
    cmocka_unit_test(long_chains_stay_independent),
    cmocka_unit_test(without_damping_the_span_is_that_of_krylov),
    cmocka_unit_test(stated_rayleigh_damping_is_a_matrix),
    cmocka_unit_test(discrete_dampers_count),
    cmocka_unit_test(an_unsymmetric_matrix_keeps_its_moments),
    cmocka_unit_test(the_mass_inner_product_keeps_them_too),
    cmocka_unit_test(damping_of_rigid_motion_is_answered),
    cmocka_unit_test(moments_about_a_frequency_are_kept),
    cmocka_unit_test(several_points_keep_moments_each),
    cmocka_unit_test(structural_damping_is_expanded_too),
    cmocka_unit_test(gyroscopic_models_keep_moments_about_a_frequency),
    cmocka_unit_test(free_bodies_keep_their_moments),
    cmocka_unit_test(free_bodies_with_structural_damping_keep_two_moments),
    cmocka_unit_test(requests_that_make_no_sense_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(krylov_damped, tests, set_up, tear_down)
