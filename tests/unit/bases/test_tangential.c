#include "testing.h"

#include "bases/tangential.h"
#include "frame.h"
#include "masses.h"
#include "project.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <complex.h>
#include <float.h>
#include <lapacke.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/*
 * Rounding of an answer: eps times the condition of Z, which is that of K, some
 * 1e5 on these chains and beams, over the damping ratio, 1e-2; and 1e-10, below
 * which parts are left out.
 */
static const double answer_error = 1e-8;

enum { MASSES = 8 };

/*
 * The chain of 8 unit masses and springs, the last held by the ground too: K is
 * tridiagonal -1, 2, -1. With @p damped, D = 0.02 K and a dashpot of 0.1 from
 * mass 4 to the ground. Force on the first mass, displacement of the last.
 */
static void make_chain(bool damped, ritz_component *out)
{
    static const int64_t first = 0, last = MASSES - 1;
    double one[MASSES];
    int64_t row[3 * MASSES], col[3 * MASSES];
    double k[3 * MASSES], d[3 * MASSES];
    int64_t count = 0;

    for (int64_t i = 0; i < MASSES; i++)
        one[i] = 1.0;
    assert_ok(masses_component(MASSES, one, one, NULL, out));
    for (int64_t i = 0; i < MASSES; i++)
        for (int64_t j = i - 1; j <= i + 1; j++) {
            if (j < 0 || j >= MASSES)
                continue;
            row[count] = i;
            col[count] = j;
            k[count] = i == j ? 2.0 : -1.0;
            d[count] = 0.02 * k[count] + (i == 3 && j == 3 ? 0.1 : 0.0);
            count++;
        }
    ritz_sparse_free(&out->K);
    assert_ok(
        ritz_sparse_from_triplets(MASSES, MASSES, count, row, col, k, &out->K));
    if (damped)
        assert_ok(ritz_sparse_from_triplets(MASSES, MASSES, count, row, col, d,
                                            &out->D));
    assert_ok(frame_io(out, 1, &first, 1, &last));
}

static ritz_request ask(const ritz_component *component, int64_t modes)
{
    ritz_request request = RITZ_REQUEST_NONE;

    request.component = component;
    request.modes = modes;
    return request;
}

static void damp(const char *text, ritz_request *request)
{
    assert_ok(ritz_damping_parse(text, &request->choice.damping));
    request->choice.given |= RITZ_USES_DAMPING;
}

static void shift(int64_t count, const double *hertz, ritz_request *request)
{
    request->choice.given |= RITZ_USES_SHIFTS;
    request->choice.num_shifts = count;
    memcpy(request->choice.shift_hz, hertz, (size_t)count * sizeof *hertz);
}

/* Z(s), dense, column by column. */
static double _Complex *impedance(const ritz_component *c, double _Complex s)
{
    const ritz_sparse *A[] = {&c->M, &c->K, &c->D, &c->K4};
    const double _Complex factor[] = {
        s * s, 1.0, s, cimag(s) > 0.0 ? (double _Complex)_Complex_I : 0.0};
    int64_t n = c->num_dofs;
    double _Complex *Z = calloc((size_t)(n * n), sizeof *Z);

    assert_non_null(Z);
    for (int k = 0; k < 4; k++)
        for (int64_t j = 0; A[k]->colptr && j < n; j++)
            for (int64_t p = A[k]->colptr[j]; p < A[k]->colptr[j + 1]; p++)
                Z[A[k]->rowind[p] + j * n] += factor[k] * A[k]->val[p];
    return Z;
}

/* f = B b + (C + s Cv + s^2 Ca)' c, with b before c. */
static double _Complex *force(const ritz_component *c,
                              const ritz_interpolation_point *probe)
{
    const ritz_io *io = &c->io;
    const double _Complex *b = probe->b;
    double _Complex s = probe->s;
    double _Complex *f = calloc((size_t)c->num_dofs, sizeof *f);

    assert_non_null(f);
    for (int64_t i = 0; i < c->num_dofs; i++) {
        int64_t at = 0;

        for (int64_t j = 0; j < io->num_inputs; j++)
            f[i] += ritz_dense_col(&io->B, j)[i] * b[at++];
        for (int64_t j = 0; j < io->num_outputs; j++)
            f[i] += (ritz_dense_col(&io->C, i)[j] +
                     s * ritz_dense_col(&io->Cv, i)[j] +
                     s * s * ritz_dense_col(&io->Ca, i)[j]) *
                    b[at++];
    }
    return f;
}

/* x := A^-1 x, A is lost. */
static void solve(int64_t n, double _Complex *A, double _Complex *x)
{
    int *pivot = calloc((size_t)n, sizeof *pivot);

    assert_non_null(pivot);
    assert_int_equal(
        LAPACKE_zgesv(LAPACK_COL_MAJOR, (int)n, 1, A, (int)n, pivot, x, (int)n),
        0);
    free(pivot);
}

/* T (T'ZT)^-1 T'f. */
static double _Complex *answer_reduced(const double _Complex *Z,
                                       const double _Complex *f,
                                       const ritz_dense *T)
{
    int64_t n = T->nrow;
    int64_t r = T->ncol;
    double _Complex *A = calloc((size_t)(r * r), sizeof *A);
    double _Complex *y = calloc((size_t)r, sizeof *y);
    double _Complex *x = calloc((size_t)n, sizeof *x);

    assert_true(A && y && x);
    for (int64_t a = 0; a < r; a++)
        for (int64_t i = 0; i < n; i++) {
            double _Complex Zt = 0.0;

            for (int64_t j = 0; j < n; j++)
                Zt += Z[i + j * n] * ritz_dense_col(T, a)[j];
            for (int64_t b = 0; b < r; b++)
                A[b + a * r] += ritz_dense_col(T, b)[i] * Zt;
            y[a] += ritz_dense_col(T, a)[i] * f[i];
        }
    solve(r, A, y);
    for (int64_t a = 0; a < r; a++)
        for (int64_t i = 0; i < n; i++)
            x[i] += ritz_dense_col(T, a)[i] * y[a];
    free(A);
    free(y);
    return x;
}

/* Full and reduced component answer every probe alike, at every dof. */
static void assert_interpolates(const ritz_component *c, const ritz_dense *T,
                                const ritz_probes *probes)
{
    int64_t n = c->num_dofs;

    assert_true(probes->count > 0);
    for (int64_t k = 0; k < probes->count; k++) {
        double _Complex *Z = impedance(c, probes->item[k].s);
        double _Complex *f = force(c, &probes->item[k]);
        double _Complex *x = answer_reduced(Z, f, T);
        double size = 0.0;

        solve(n, Z, f);
        for (int64_t i = 0; i < n; i++)
            size = fmax(size, cabs(f[i]));
        assert_true(size > 0.0);
        for (int64_t i = 0; i < n; i++)
            assert_near(cabs(x[i] - f[i]) / size, 0.0, answer_error);
        free(Z);
        free(f);
        free(x);
    }
}

/* What came of a request. */
typedef struct answer {
    ritz_basis basis;
    ritz_probes probes;
} answer;

static answer find(const ritz_request *request)
{
    answer got = {0};

    assert_ok(ritz_tangential_find(request, &got.basis, &got.probes));
    return got;
}

static void release(answer *got)
{
    ritz_basis_free(&got->basis);
    ritz_probes_free(&got->probes);
}

/*
 * Only the second of three oscillators is driven: w^2 = 9, zeta = 0.02. The
 * space is its own coordinate, and the point s^2 = -9 (1 - 0.02).
 */
static void one_driven_oscillator_by_hand(void **state)
{
    static const double m[] = {1, 1, 1}, k[] = {1, 1, 1};
    static const double lambda[] = {1, 9, 25};
    static const int64_t at[] = {0, 1, 2};
    RITZ_OWN(ritz_component) three = {0};
    ritz_request request = ask(&three, 2);
    answer got = {0};

    (void)state;
    assert_ok(masses_component(3, m, k, NULL, &three));
    assert_ok(frame_io(&three, 1, at + 1, 1, at + 1));
    ritz_sparse_free(&three.K);
    assert_ok(ritz_sparse_from_triplets(3, 3, 3, at, at, lambda, &three.K));
    damp("modal 0.02", &request);
    got = find(&request);
    assert_int_equal(got.basis.T.ncol, 1);
    assert_int_equal(got.probes.count, 1);
    assert_near(creal(got.probes.item[0].s), 0.0, 0.0);
    assert_near(cimag(got.probes.item[0].s), 3.0 * sqrt(0.98),
                64 * DBL_EPSILON);
    assert_near(got.basis.T.val[0], 0.0, 64 * DBL_EPSILON);
    assert_near(got.basis.T.val[2], 0.0, 64 * DBL_EPSILON);
    assert_string_equal(got.basis.remark, "points settled after 1 round(s); "
                                          "1 vector(s) fewer than asked");
    release(&got);
}

/*
 * A point of NumPy's, to the last digit, is among those that were found. Rounds
 * stop at a change of 1e-6, and each shrinks the error to less than half
 * (seen): no more than that again is left.
 */
static void assert_point(const ritz_probes *probes, double _Complex expected)
{
    double nearest = HUGE_VAL;

    for (int64_t k = 0; k < probes->count; k++)
        nearest = fmin(nearest, cabs(probes->item[k].s - expected));
    assert_near(nearest, 0.0, 2e-6 * cabs(expected));
}

/*
 * Ratios alone: a real vector for each of as many points, near the resonances.
 * Where it settles is where an independent program (NumPy) does, to the 1e-6
 * at which both stop.
 */
static void with_ratios_every_vector_is_a_point(void **state)
{
    static const double expected[] = {0.34385184020192994, 0.6772823585082353,
                                      0.9902249746303671, 1.2734766431854896};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = ask(&chain, 4);
    answer got = {0};

    (void)state;
    make_chain(false, &chain);
    damp("modal 0.02", &request);
    got = find(&request);
    assert_int_equal(got.basis.T.ncol, 4);
    assert_int_equal(got.probes.count, 4);
    assert_interpolates(&chain, &got.basis.T, &got.probes);
    for (int k = 0; k < 4; k++)
        assert_point(&got.probes, (double _Complex)_Complex_I * expected[k]);
    assert_non_null(strstr(got.basis.remark, "points settled after "));
    assert_string_equal(got.basis.origin.options, "");
    release(&got);
}

/*
 * With D a point is a mirrored pole of what is reduced, and takes two vectors:
 * four vectors are two points, where NumPy finds them.
 */
static void with_a_damping_matrix_points_mirror_poles(void **state)
{
    const double _Complex i = (double _Complex)_Complex_I;
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = ask(&chain, 4);
    answer got = {0};

    (void)state;
    make_chain(true, &chain);
    got = find(&request);
    assert_int_equal(got.basis.T.ncol, 4);
    assert_int_equal(got.probes.count, 2);
    assert_point(&got.probes, 0.005998376255083765 + 0.6840616390250917 * i);
    assert_point(&got.probes, 0.01820981500182257 + 1.0000385941190575 * i);
    assert_interpolates(&chain, &got.basis.T, &got.probes);
    for (int64_t j = 0; j < 4; j++)
        assert_int_equal(got.basis.columns.kind[j], RITZ_COLUMN_KRYLOV);
    release(&got);
}

/*
 * H_r(s) b = H(s) b for inputs, c' H_r(s) = c' H(s) for outputs, or both at
 * once: the answer is in the space, whichever loads are asked for.
 */
static void loads_are_answered_alone_and_together(void **state)
{
    static const int loads[] = {RITZ_LOADS_INPUTS, RITZ_LOADS_OUTPUTS,
                                RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS};
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    make_chain(true, &chain);
    for (int k = 0; k < 3; k++) {
        ritz_request request = ask(&chain, 6);
        answer got = {0};

        request.choice.given = RITZ_USES_LOADS;
        request.choice.loads = loads[k];
        got = find(&request);
        assert_int_equal(got.probes.count, 3);
        assert_interpolates(&chain, &got.basis.T, &got.probes);
        release(&got);
    }
}

/*
 * Two inputs, and two outputs of which one reads displacement and velocity and
 * the other velocity: points are NumPy's, for which directions count.
 */
static void velocities_are_read_and_directions_found(void **state)
{
    static const int64_t rows[] = {0, 5}, ends[] = {7, 7};
    static const double re[2][2] = {
        {0.01199054316504148, 0.005980563253591949},
        {0.011967892475206176, 0.0059617088441260456}};
    static const double im[2][2] = {{0.347254009331603, 0.68400660736705},
                                    {0.34730040389324485, 0.6841315370672192}};
    static const int loads[] = {RITZ_LOADS_INPUTS, RITZ_LOADS_OUTPUTS};
    RITZ_OWN(ritz_component) chain = {0};

    (void)state;
    make_chain(true, &chain);
    assert_ok(frame_io(&chain, 2, rows, 2, ends));
    ritz_dense_col(&chain.io.B, 1)[5] = 2.0;
    ritz_dense_col(&chain.io.C, 7)[1] = 0.0;
    ritz_dense_col(&chain.io.Cv, 2)[0] = 0.5;
    ritz_dense_col(&chain.io.Cv, 4)[1] = 2.0;
    for (int k = 0; k < 2; k++) {
        ritz_request request = ask(&chain, 4);
        answer got = {0};

        request.choice.loads = loads[k];
        got = find(&request);
        assert_interpolates(&chain, &got.basis.T, &got.probes);
        for (int j = 0; j < 2; j++)
            assert_point(&got.probes,
                         re[k][j] + (double _Complex)_Complex_I * im[k][j]);
        release(&got);
    }
}

/* y = 3 u'' of the middle, with and without D. */
static void accelerations_are_read(void **state)
{
    ritz_component chain = {0};

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        ritz_request request = ask(&chain, 4);
        answer got = {0};

        make_chain(damped == 1, &chain);
        damp("modal 0.02", &request);
        request.choice.loads = RITZ_LOADS_OUTPUTS;
        ritz_dense_col(&chain.io.C, MASSES - 1)[0] = 0.0;
        ritz_dense_col(&chain.io.Ca, 4)[0] = 3.0;
        got = find(&request);
        assert_interpolates(&chain, &got.basis.T, &got.probes);
        release(&got);
        ritz_component_free(&chain);
    }
}

/* K4 = 0.02 K: poles are w sqrt(-1 - 0.02 i), of a ratio of 0.01. */
static void structural_damping_counts(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = ask(&chain, 4);
    answer got = {0};

    (void)state;
    make_chain(false, &chain);
    assert_ok(ritz_sparse_add(0.02, &chain.K, 0.0, &chain.M, &chain.K4));
    got = find(&request);
    assert_int_equal(got.probes.count, 2);
    assert_interpolates(&chain, &got.basis.T, &got.probes);
    for (int64_t k = 0; k < 2; k++) /* of second order in 0.01 */
        assert_near(creal(got.probes.item[k].s) / cabs(got.probes.item[k].s),
                    0.01, 1e-4);
    release(&got);
}

/* Points that are given: static, real, and two of the damped chain. */
static void given_points_are_interpolated(void **state)
{
    static const double hertz[] = {0.0, 0.1, 0.2};
    ritz_component chain = {0};

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        ritz_request request = ask(&chain, 8);
        answer got = {0};
        int64_t answers = damped == 1 ? 5 : 6; /* 1 + 1 and 2 + 2 + 2 are 8 */

        make_chain(damped == 1, &chain);
        shift(3, hertz, &request);
        request.choice.loads = RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS;
        got = find(&request);
        assert_int_equal(got.basis.T.ncol, damped == 1 ? 8 : 6);
        assert_int_equal(got.probes.count, answers);
        assert_near(cimag(got.probes.item[2].s), 0.2 * pi, 4 * DBL_EPSILON);
        assert_interpolates(&chain, &got.basis.T, &got.probes);
        assert_non_null(
            strstr(got.basis.remark, " response(s) interpolated; "));
        assert_non_null(strstr(got.basis.remark, damped == 1
                                                     ? "1 more have no room"
                                                     : "2 vector(s) fewer"));
        release(&got);
        ritz_component_free(&chain);
    }
}

/* Three rigid motions of a plane beam are kept first, and exactly. */
static void rigid_motion_of_a_free_body_is_kept(void **state)
{
    static const int64_t force[] = {1}, reads[] = {19};
    RITZ_OWN(ritz_component) beam = {0};
    ritz_request request = ask(&beam, 5);
    answer got = {0};
    RITZ_OWN(ritz_dense) K = {0};

    (void)state;
    assert_ok(frame_component(6, 0.5, &frame_mcdaniel, false, false, 1, &beam));
    assert_ok(frame_io(&beam, 1, force, 1, reads));
    got = find(&request);
    assert_int_equal(got.basis.T.ncol, 8);
    for (int64_t j = 0; j < 8; j++)
        assert_int_equal(got.basis.columns.kind[j],
                         j < 3 ? RITZ_COLUMN_RIGID : RITZ_COLUMN_KRYLOV);
    K = project(&beam.K, &got.basis.T);
    for (int64_t j = 0; j < 3; j++)
        for (int64_t i = 0; i < 8; i++)
            assert_near(ritz_dense_col(&K, j)[i], 0.0,
                        1e-10 * ritz_dense_max(&K)); /* measured */
    assert_interpolates(&beam, &got.basis.T, &got.probes);
    assert_non_null(strstr(got.basis.remark, "damping modal 0.01 assumed"));
    release(&got);
}

/* The modes of a pencil with what force and output see of each. */
typedef struct modal {
    int64_t count;
    double omega[80], b[80], c[80];
} modal;

static void add_modes(const ritz_dense *K, const ritz_dense *M,
                      const double *force, const double *reads, double sign,
                      modal *out)
{
    RITZ_OWN(ritz_pairs) pairs = {0};

    assert_ok(ritz_eigen_dense(K, M, &pairs));
    for (int64_t k = 0; k < pairs.Phi.ncol; k++) {
        int64_t at = out->count++;

        assert_true(at < 80);
        out->omega[at] = sqrt(pairs.lambda[k]);
        out->b[at] = out->c[at] = 0.0;
        for (int64_t i = 0; i < K->nrow; i++) {
            out->b[at] += ritz_dense_col(&pairs.Phi, k)[i] * force[i];
            out->c[at] += sign * ritz_dense_col(&pairs.Phi, k)[i] * reads[i];
        }
    }
}

/* |H|^2 = sum_ij c_i c_j b_i b_j S / (Delta^2 + S N): gramian.c. */
static double h2_norm(const modal *m, double zeta)
{
    double sum = 0.0;

    for (int64_t i = 0; i < m->count; i++)
        for (int64_t j = 0; j < m->count; j++) {
            double wi = m->omega[i];
            double wj = m->omega[j];
            double S = 2.0 * zeta * (wi + wj);
            double N = 2.0 * zeta * wi * wj * (wi + wj);
            double Delta = (wi - wj) * (wi + wj);

            sum += m->c[i] * m->c[j] * m->b[i] * m->b[j] * S /
                   (Delta * Delta + S * N);
        }
    return sqrt(fmax(sum, 0.0));
}

/* Relative error in H2 with a ratio for all modes, of the full and the reduced;
 * one force, one displacement. */
static double h2_error(const ritz_component *full, const ritz_dense *T,
                       double zeta)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, b = {0}, c = {0};
    RITZ_OWN(ritz_dense) K_r = project(&full->K, T);
    RITZ_OWN(ritz_dense) M_r = project(&full->M, T);
    ritz_dense reads = {full->num_dofs, 1, full->io.C.val}; /* one row */
    modal m = {0};
    double norm = 0.0;

    assert_ok(ritz_sparse_dense(&full->K, &K));
    assert_ok(ritz_sparse_dense(&full->M, &M));
    add_modes(&K, &M, full->io.B.val, full->io.C.val, 1.0, &m);
    norm = h2_norm(&m, zeta);
    assert_ok(ritz_dense_mul_tn(T, &full->io.B, &b));
    assert_ok(ritz_dense_mul_tn(T, &reads, &c));
    add_modes(&K_r, &M_r, b.val, c.val, -1.0, &m);
    return h2_norm(&m, zeta) / norm;
}

/*
 * A clamped beam of 10 elements, force at the tip, displacement of the middle,
 * ratio 0.02, four vectors. Measured: 1.5e-3, with the four lowest modes
 * 2.9e-3, with four Krylov vectors 1.2e-2.
 */
static void in_h2_it_is_no_worse_than_modes_and_krylov(void **state)
{
    static const int64_t force[] = {28}, reads[] = {13};
    RITZ_OWN(ritz_component) beam = {0};
    ritz_request request = ask(&beam, 4);
    RITZ_OWN(ritz_basis) tangential = {0}, krylov = {0};
    ritz_span span = {.modes = 4};
    RITZ_OWN(ritz_pairs) modes = {0};
    double error[3];

    (void)state;
    assert_ok(frame_component(10, 0.5, &frame_mcdaniel, true, false, 1, &beam));
    assert_ok(frame_io(&beam, 1, force, 1, reads));
    assert_ok(ritz_basis_make(&ritz_method_krylov, &request, &krylov));
    damp("modal 0.02", &request);
    assert_ok(ritz_basis_make(&ritz_method_tangential, &request, &tangential));
    assert_ok(ritz_eigen_sparse(&beam.K, &beam.M, &span, &modes));
    assert_int_equal(tangential.T.ncol, 4);
    assert_int_equal(krylov.T.ncol, 4);
    assert_int_equal(modes.Phi.ncol, 4);
    error[0] = h2_error(&beam, &tangential.T, 0.02);
    error[1] = h2_error(&beam, &modes.Phi, 0.02);
    error[2] = h2_error(&beam, &krylov.T, 0.02);
    assert_near(error[0], 1.528e-3, 1e-5);
    assert_near(error[1], 2.934e-3, 1e-5);
    assert_near(error[2], 1.245e-2, 1e-4);
}

enum { SMALL = 5, SEEDS = 1000 };

/* Numbers between -1 and 1, the same everywhere. */
static double next(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005U + 1442695040888963407U;
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

/* G G' + 1e-3 I. */
static void random_definite(uint64_t *seed, ritz_sparse *out)
{
    int64_t row[SMALL * SMALL], col[SMALL * SMALL];
    double G[SMALL * SMALL], val[SMALL * SMALL];

    for (int k = 0; k < SMALL * SMALL; k++)
        G[k] = next(seed);
    for (int64_t k = 0; k < SMALL * SMALL; k++) {
        row[k] = k % SMALL;
        col[k] = k / SMALL;
        val[k] = row[k] == col[k] ? 1e-3 : 0.0;
        for (int64_t j = 0; j < SMALL; j++)
            val[k] += G[row[k] + j * SMALL] * G[col[k] + j * SMALL];
    }
    ritz_sparse_free(out);
    assert_ok(ritz_sparse_from_triplets(SMALL, SMALL, SMALL * SMALL, row, col,
                                        val, out));
}

static void assert_definite(const ritz_sparse *A, const ritz_dense *T)
{
    RITZ_OWN(ritz_dense) Ar = project(A, T);

    assert_int_equal(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', (int)Ar.ncol, Ar.val,
                                    (int)Ar.ncol),
                     0);
}

static void make_random(uint64_t seed, ritz_component *body)
{
    random_definite(&seed, &body->K);
    random_definite(&seed, &body->M);
    random_definite(&seed, &body->D);
}

static void assert_all_definite(const ritz_component *body, const ritz_dense *T)
{
    assert_definite(&body->K, T);
    assert_definite(&body->M, T);
    assert_definite(&body->D, T);
}

/* Chain of five, to be overwritten: force on one end, displacement of the
 * other. */
static void make_small(ritz_component *out)
{
    static const double ones[SMALL] = {1, 1, 1, 1, 1};
    static const int64_t first = 0, last = SMALL - 1;

    assert_ok(masses_component(SMALL, ones, ones, ones, out));
    assert_ok(frame_io(out, 1, &first, 1, &last));
}

/*
 * One projection keeps K, M and D definite, so that every reduced component is
 * stable: at a point that is real and one that is not, of every seed.
 */
static void random_components_stay_definite(void **state)
{
    RITZ_OWN(ritz_component) body = {0};

    (void)state;
    make_small(&body);
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        const ritz_dense none = {.nrow = SMALL};
        ritz_request request = ask(&body, 3);
        RITZ_OWN(ritz_rational) R = {0};
        RITZ_OWN(ritz_probes) probes = {0};
        RITZ_OWN(ritz_dense) T = {0};
        int64_t gave[2];

        make_random(seed, &body);
        assert_ok(ritz_rational_new(&request, RITZ_LOADS_INPUTS, 1.0, &R));
        assert_ok(ritz_probes_new(2, R.num_loads, &probes));
        probes.item[0].b[0] = probes.item[1].b[0] = 1.0;
        probes.item[1].s = 0.3 + (double _Complex)_Complex_I;
        assert_ok(ritz_rational_span(&R, &probes, &none, 3, &T, gave));
        assert_int_equal(T.ncol, 3);
        assert_all_definite(&body, &T);
    }
}

/* The same where points are searched, settled or not. */
static void searches_end_in_definite_components(void **state)
{
    RITZ_OWN(ritz_component) body = {0};

    (void)state;
    make_small(&body);
    for (uint64_t seed = 0; seed < 10; seed++) {
        ritz_request request = ask(&body, 2 + (int64_t)(seed % 3));
        RITZ_OWN(ritz_basis) basis = {0};

        make_random(seed, &body);
        assert_ok(ritz_basis_make(&ritz_method_tangential, &request, &basis));
        assert_all_definite(&body, &basis.T);
    }
}

/* With a mass of 0, and more vectors than there can be: all of the space. */
static void more_vectors_than_dofs_are_all_there_is(void **state)
{
    static const double m[] = {1, 0, 2, 1}, k[] = {1, 2, 3, 4};
    static const int64_t at[] = {1, 3};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = ask(&chain, 20);
    answer got = {0};

    (void)state;
    assert_ok(masses_component(4, m, k, NULL, &chain));
    assert_ok(frame_io(&chain, 1, at, 1, at + 1));
    damp("modal 0.05", &request);
    got = find(&request);
    assert_in_range(got.basis.T.ncol, 3, 4);
    assert_interpolates(&chain, &got.basis.T, &got.probes);
    release(&got);
}

/* No damping is known below 0.1 Hz: points stay off the poles there. */
static void modes_without_damping_have_points_too(void **state)
{
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = ask(&chain, 3);
    answer got = {0};

    (void)state;
    make_chain(false, &chain);
    damp("bands 0.1 1 0.01", &request);
    got = find(&request);
    assert_int_equal(got.basis.T.ncol, 3);
    release(&got);
}

static void requests_without_sense_are_refused(void **state)
{
    static const double hertz[] = {0.0};
    static int64_t twice[] = {1, 1};
    ritz_component chain = {0};
    ritz_request request = ask(&chain, 1);
    ritz_basis none = {0};

    (void)state;
    make_chain(true, &chain);
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "tangential: one vector cannot hold");
    request.modes = 0;
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "no vector is asked for");
    request.modes = 4;
    request.attached = (ritz_dofs){2, twice};
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "listed twice");
    request.attached = (ritz_dofs){0};
    chain.D.val[1] += 0.5;
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "D is not symmetric (gyroscopic?)");
    ritz_io_free(&chain.io);
    ritz_sparse_free(&chain.D);
    assert_ok(ritz_io_new(MASSES, 0, 0, &chain.io));
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "there is no load to respond to");
    ritz_component_free(&chain);
    assert_ok(
        frame_component(4, 0.5, &frame_mcdaniel, false, false, 1, &chain));
    assert_ok(frame_io(&chain, 1, twice, 1, twice));
    shift(1, hertz, &request);
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_ARGUMENT, "so that 0 Hz is a pole of it");
    ritz_component_free(&chain);
}

/* One mass on one spring, both 1, and the point 1 rad/s. */
static void a_point_on_a_pole_is_refused(void **state)
{
    static const double one[] = {1};
    static const int64_t at[] = {0};
    const double hertz[] = {1.0 / (2.0 * pi)};
    RITZ_OWN(ritz_component) mass = {0};
    ritz_request request = ask(&mass, 1);
    ritz_basis none = {0};

    (void)state;
    assert_ok(masses_component(1, one, one, NULL, &mass));
    assert_ok(frame_io(&mass, 1, at, 1, at));
    shift(1, hertz, &request);
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_SINGULAR, "0+1i rad/s is a pole of the component");
}

/* The third mass is loose, and the only one that is driven. */
static void loads_that_drive_nothing_flexible_are_refused(void **state)
{
    static const double m[] = {1, 1, 1}, k[] = {1, 1, 0};
    static const int64_t at[] = {2};
    RITZ_OWN(ritz_component) chain = {0};
    ritz_request request = ask(&chain, 1);
    ritz_basis none = {0};

    (void)state;
    assert_ok(masses_component(3, m, k, NULL, &chain));
    assert_ok(frame_io(&chain, 1, at, 1, at));
    assert_fails(ritz_basis_make(&ritz_method_tangential, &request, &none),
                 RITZ_ERR_ARGUMENT,
                 "no flexible mode is controllable by the loads");
}

static void no_allocation_failure_leaks(void **state)
{
    static const double m[] = {1, 1, 1}, k[] = {1, 2, 3}, c[] = {0, 0.1, 0};
    static const int64_t at[] = {0, 2};

    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        RITZ_OWN(ritz_component) chain = {0};
        ritz_request request = ask(&chain, 2);
        RITZ_OWN(ritz_basis) basis = {0};

        assert_ok(masses_component(3, m, k, damped == 1 ? c : NULL, &chain));
        assert_ok(frame_io(&chain, 1, at, 1, at + 1));
        assert_survives_every_allocation(
            ritz_method_tangential.make(&request, &basis));
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_driven_oscillator_by_hand),
    cmocka_unit_test(with_ratios_every_vector_is_a_point),
    cmocka_unit_test(with_a_damping_matrix_points_mirror_poles),
    cmocka_unit_test(loads_are_answered_alone_and_together),
    cmocka_unit_test(velocities_are_read_and_directions_found),
    cmocka_unit_test(accelerations_are_read),
    cmocka_unit_test(structural_damping_counts),
    cmocka_unit_test(given_points_are_interpolated),
    cmocka_unit_test(rigid_motion_of_a_free_body_is_kept),
    cmocka_unit_test(in_h2_it_is_no_worse_than_modes_and_krylov),
    cmocka_unit_test(random_components_stay_definite),
    cmocka_unit_test(searches_end_in_definite_components),
    cmocka_unit_test(more_vectors_than_dofs_are_all_there_is),
    cmocka_unit_test(modes_without_damping_have_points_too),
    cmocka_unit_test(requests_without_sense_are_refused),
    cmocka_unit_test(a_point_on_a_pole_is_refused),
    cmocka_unit_test(loads_that_drive_nothing_flexible_are_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(tangential, tests, NULL, NULL)
