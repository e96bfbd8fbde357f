#include "testing.h"

#include "linear/eigen_sparse.h"

#include <ritz/matrix.h>

#include <float.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* Contributions of many bodies to K and M, as an element loop leaves them. */
typedef struct loop {
    int64_t count, room;
    int64_t *row, *col;
    double *k, *m;
} loop;

static void add(loop *l, int64_t row, int64_t col, double k, double m)
{
    if (l->count == l->room) {
        size_t size = (size_t)(l->room = 2 * l->room + 1024) * 8;

        l->row = realloc(l->row, size);
        l->col = realloc(l->col, size);
        l->k = realloc(l->k, size);
        l->m = realloc(l->m, size);
    }
    l->row[l->count] = row;
    l->col[l->count] = col;
    l->k[l->count] = k;
    l->m[l->count++] = m;
}

typedef struct pencil {
    ritz_sparse K, M;
} pencil;

static pencil finish(loop *l, int64_t n)
{
    pencil p = {0};

    assert_ok(
        ritz_sparse_from_triplets(n, n, l->count, l->row, l->col, l->k, &p.K));
    assert_ok(
        ritz_sparse_from_triplets(n, n, l->count, l->row, l->col, l->m, &p.M));
    free(l->row);
    free(l->col);
    free(l->k);
    free(l->m);
    *l = (loop){0};
    return p;
}

static void release(pencil *p)
{
    ritz_sparse_free(&p->K);
    ritz_sparse_free(&p->M);
}

/*
 * Bar of E A = rho A = length = 1 on dofs first.., its ends clamped if fewer
 * than `elements` + 1 dofs: node i is dof first + i - clamped.
 */
static void add_bar(loop *l, int64_t elements, int64_t first, int64_t clamped)
{
    const double h = 1.0 / (double)elements;
    const int64_t dofs = elements + 1 - 2 * clamped;

    for (int64_t e = 0; e < elements; e++)
        for (int64_t i = 0; i < 2; i++)
            for (int64_t j = 0; j < 2; j++) {
                int64_t a = e + i - clamped;
                int64_t b = e + j - clamped;

                if (a >= 0 && b >= 0 && a < dofs && b < dofs)
                    add(l, first + a, first + b, i == j ? 1.0 / h : -1.0 / h,
                        i == j ? h / 3.0 : h / 6.0);
            }
}

/* lambda_k = 6 / h^2 (1 - cos a) / (2 + cos a), a = k pi h. */
static double bar_eigenvalue(int64_t elements, int64_t k)
{
    double h = 1.0 / (double)elements;
    double a = (double)k * pi * h;
    double s = sin(a / 2.0);

    return 12.0 * s * s / (h * h * (2.0 + cos(a)));
}

static pencil bars(int64_t number, int64_t elements, int64_t clamped)
{
    loop l = {0};
    int64_t dofs = elements + 1 - 2 * clamped;

    for (int64_t b = 0; b < number; b++)
        add_bar(&l, elements, b * dofs, clamped);
    return finish(&l, number * dofs);
}

/* Five-point membrane of n x n unit masses, clamped around: lambda_pq. */
static pencil membrane(int64_t n)
{
    loop l = {0};

    for (int64_t i = 0; i < n * n; i++) {
        add(&l, i, i, 4.0, 1.0);
        if (i % n > 0)
            add(&l, i, i - 1, -1.0, 0.0);
        if (i % n < n - 1)
            add(&l, i, i + 1, -1.0, 0.0);
        if (i >= n)
            add(&l, i, i - n, -1.0, 0.0);
        if (i < n * n - n)
            add(&l, i, i + n, -1.0, 0.0);
    }
    return finish(&l, n * n);
}

static int ascending(const void *a, const void *b)
{
    const double *x = a;
    const double *y = b;

    return (*x > *y) - (*x < *y);
}

/* All eigenvalues 4 sin^2 + 4 sin^2, ascending; the caller frees. */
static double *membrane_eigenvalues(int64_t n)
{
    double *lambda = calloc((size_t)(n * n), sizeof *lambda);

    for (int64_t p = 0; p < n; p++)
        for (int64_t q = 0; q < n; q++) {
            double s = sin((double)(p + 1) * pi / (2.0 * (double)(n + 1)));
            double t = sin((double)(q + 1) * pi / (2.0 * (double)(n + 1)));

            lambda[p * n + q] = 4.0 * (s * s + t * t);
        }
    qsort(lambda, (size_t)(n * n), sizeof *lambda, ascending);
    return lambda;
}

/* Phi' M Phi = I within the bound. */
static void assert_orthonormal(const ritz_pairs *P, const ritz_sparse *M,
                               double bound)
{
    RITZ_OWN(ritz_dense) MPhi = {0}, G = {0};

    assert_ok(ritz_sparse_mul(M, &P->Phi, &MPhi));
    assert_ok(ritz_dense_mul_tn(&P->Phi, &MPhi, &G));
    for (int64_t j = 0; j < G.ncol; j++)
        for (int64_t i = 0; i < G.nrow; i++)
            assert_near(G.val[i + j * G.nrow], i == j ? 1.0 : 0.0, bound);
}

/*
 * Rounding of lambda is about eps lambda_max, of a bar 12 / h^2, in the dense
 * engine and by the rounding of K in any; sqrt(n) for the sum over a row of
 * rounding errors, and a safety of ten.
 */
static double rounding(int64_t n, double lambda_max)
{
    return 10.0 * sqrt((double)n) * DBL_EPSILON * lambda_max;
}

/* Twelve flexible modes of one bar, and its rigid one if it is free. */
static void check_bar(int64_t n, int64_t clamped, const char *engine)
{
    double bound = rounding(n, 12.0 * (double)n * (double)n);
    pencil p = bars(1, n, clamped);
    ritz_pairs P = {0};

    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 12}, &P));
    assert_string_equal(P.engine, engine);
    assert_int_equal(P.num_rigid, 1 - clamped);
    assert_int_equal(P.Phi.ncol, 13 - clamped);
    for (int64_t k = 0; k < P.Phi.ncol; k++) {
        assert_near(P.lambda[k], bar_eigenvalue(n, k + clamped), bound);
        assert_near(P.residual[k], 0.0, 1e-13); /* measured */
    }
    assert_true(P.proven_to > P.lambda[P.Phi.ncol - 1]);
    assert_true(P.proven_to < bar_eigenvalue(n, 13));
    assert_orthonormal(&P, &p.M, 1e-12); /* measured: 1e-14 */
    ritz_pairs_free(&P);
    release(&p);
}

/* 300 elements go to LAPACK, 2000 to block Lanczos. */
static void bars_have_the_modes_of_their_mesh(void **state)
{
    (void)state;
    for (int64_t clamped = 0; clamped < 2; clamped++) {
        check_bar(300, clamped, "dense LAPACK");
        check_bar(2000, clamped, "block Lanczos");
    }
}

/* Every engine finds the same modes of a membrane, by number or up to a
   frequency, with a count or without. */
static void all_engines_find_the_same_modes(void **state)
{
    static const struct {
        ritz_span span;
        const char *engine;
    } way[] = {
        {{.modes = 20}, "block Lanczos"},
        {{.modes = 20, .engine = RITZ_EIGEN_ARPACK}, "ARPACK"},
        {{.modes = 20, .uncounted = true}, "block Lanczos"},
        {{.modes = -1, .up_to_hz = 0.06, .uncounted = true}, "block Lanczos"},
        {{.modes = -1, .up_to_hz = 0.06}, "block Lanczos"},
        {{.modes = 240, .engine = RITZ_EIGEN_SLICES}, "spectrum slices"},
        {{.modes = -1, .up_to_hz = 0.2, .engine = RITZ_EIGEN_SLICES},
         "spectrum slices"},
    };
    pencil p = membrane(40);
    double *lambda = membrane_eigenvalues(40);
    const double bound = rounding(1600, 8.0);

    (void)state;
    for (size_t k = 0; k < sizeof way / sizeof *way; k++) {
        const ritz_span *span = &way[k].span;
        RITZ_OWN(ritz_pairs) P = {0};
        int64_t count = span->modes;

        if (span->modes < 0)
            for (count = 0; lambda[count] <= ritz_eigen_lambda(span->up_to_hz);)
                count++;
        assert_ok(ritz_eigen_sparse(&p.K, &p.M, span, &P));
        assert_string_equal(P.engine, way[k].engine);
        assert_int_equal(isnan(P.proven_to) != 0, span->uncounted);
        assert_true(P.Phi.ncol >= count && P.Phi.ncol <= count + 1);
        for (int64_t j = 0; j < P.Phi.ncol; j++)
            assert_near(P.lambda[j], lambda[j], bound);
    }
    free(lambda);
    release(&p);
}

/* lambda_2 = lambda_3 by symmetry: three asked are three, two are three too. */
static void a_double_mode_is_never_cut(void **state)
{
    const int64_t size[] = {20, 40};

    (void)state;
    for (size_t s = 0; s < 2; s++)
        for (int64_t modes = 1; modes <= 20; modes++) {
            int64_t n = size[s];
            double *exact = membrane_eigenvalues(n);
            pencil p = membrane(n);
            ritz_pairs P = {0};
            int64_t end = modes;

            while (exact[end] - exact[end - 1] < 1e-6 * exact[end])
                end++;
            assert_ok(ritz_eigen_sparse(&p.K, &p.M,
                                        &(ritz_span){.modes = modes}, &P));
            assert_int_equal(P.Phi.ncol, end);
            assert_int_equal(P.num_rigid, 0);
            for (int64_t k = 0; k < end; k++)
                assert_near(P.lambda[k], exact[k], rounding(n * n, 8.0));
            assert_orthonormal(&P, &p.M, 1e-12); /* measured: 1e-14 */
            ritz_pairs_free(&P);
            release(&p);
            free(exact);
        }
}

/* By frequency, in both engines: as many as lie below, the last one included.
 */
static void a_frequency_finds_every_mode_below(void **state)
{
    const int64_t elements[] = {200, 1500};

    (void)state;
    for (size_t e = 0; e < 2; e++)
        for (int64_t below = 0; below < 20; below += 6) {
            int64_t n = elements[e];
            double last = bar_eigenvalue(n, below > 0 ? below : 1);
            double hertz = ritz_eigen_hertz(below > 0 ? last : last / 2.0);
            pencil p = bars(1, n, 0);
            ritz_pairs P = {0};

            assert_ok(ritz_eigen_sparse(
                &p.K, &p.M, &(ritz_span){.modes = -1, .up_to_hz = hertz}, &P));
            assert_int_equal(P.Phi.ncol, below + 1);
            assert_int_equal(P.num_rigid, 1);
            assert_true(P.proven_to >= ritz_eigen_lambda(hertz));
            ritz_pairs_free(&P);
            release(&p);
        }
}

/* Modes are first counted 1e-8 above the frequency. If the fifth flexible mode
   is there, they are counted again 1e-7 above it. */
static void modes_are_counted_again_if_one_lies_at_the_limit(void **state)
{
    const double fifth = bar_eigenvalue(1500, 5);
    const ritz_span span = {.modes = -1,
                            .up_to_hz = ritz_eigen_hertz(fifth / (1.0 + 1e-8))};
    pencil p = bars(1, 1500, 0);
    ritz_pairs P = {0};

    (void)state;
    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &span, &P));
    assert_int_equal(P.Phi.ncol, 6);
    assert_true(P.proven_to > fifth * (1.0 + 8e-8));
    ritz_pairs_free(&P);
    release(&p);
}

/* A mode at each of the three values where modes are counted. */
static void modes_at_every_limit_are_refused(void **state)
{
    enum { N = 700 };
    const double at[] = {1.0 + 1e-8, 1.0 + 1e-7, 1.0 + 3e-7};
    loop l = {0};
    pencil p = {0};
    ritz_pairs P = {0};

    (void)state;
    for (int64_t i = 0; i < N; i++)
        add(&l, i, i, i < 3 ? at[i] : 2.0 + (double)i, 1.0);
    p = finish(&l, N);
    assert_fails(
        ritz_eigen_sparse(
            &p.K, &p.M,
            &(ritz_span){.modes = -1, .up_to_hz = ritz_eigen_hertz(1.0)}, &P),
        RITZ_ERR_SINGULAR, "cannot be counted: several lie there");
    release(&p);
}

/* Clamped, nothing lies below half the first frequency. */
static void there_may_be_no_mode(void **state)
{
    pencil p = bars(1, 1500, 1);
    ritz_pairs P = {0};
    double hertz = ritz_eigen_hertz(pi * pi) / 2.0;

    (void)state;
    assert_ok(ritz_eigen_sparse(
        &p.K, &p.M, &(ritz_span){.modes = -1, .up_to_hz = hertz}, &P));
    assert_int_equal(P.Phi.ncol, 0);
    ritz_pairs_free(&P);
    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 0}, &P));
    assert_int_equal(P.Phi.ncol, 0);
    ritz_pairs_free(&P);
    release(&p);
}

/* Each of 20 bars has one rigid mode, and the flexible ones are 20-fold. */
static void every_free_body_has_its_rigid_mode(void **state)
{
    const int64_t elements[] = {20, 60};

    (void)state;
    for (size_t e = 0; e < 2; e++) {
        pencil p = bars(20, elements[e], 0);
        ritz_pairs P = {0};

        assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 3}, &P));
        assert_int_equal(P.num_rigid, 20);
        assert_int_equal(P.Phi.ncol, 40);
        for (int64_t k = 20; k < 40; k++)
            assert_near(P.lambda[k], bar_eigenvalue(elements[e], 1), 1e-8);
        ritz_pairs_free(&P);
        release(&p);
    }
}

/*
 * Chain of n springs 1, unit mass at every second joint only: two springs in
 * series are one of 1/2, so lambda_k = 2 sin^2(k pi / (n + 1)) for odd n.
 */
static pencil half_heavy(int64_t n)
{
    loop l = {0};

    for (int64_t i = 0; i < n; i++) {
        add(&l, i, i, 2.0, i % 2 == 1 ? 1.0 : 0.0);
        if (i > 0) {
            add(&l, i, i - 1, -1.0, 0.0);
            add(&l, i - 1, i, -1.0, 0.0);
        }
    }
    return finish(&l, n);
}

/* The lowest `modes`, or all there are. */
static void check_half_heavy(int64_t n, int64_t modes, const char *engine)
{
    int64_t all = (n - 1) / 2;
    pencil p = half_heavy(n);
    ritz_pairs P = {0};

    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = modes}, &P));
    assert_string_equal(P.engine, engine);
    assert_int_equal(P.Phi.ncol, modes < all ? modes : all);
    for (int64_t k = 0; k < P.Phi.ncol; k++) {
        double x = sin((double)(k + 1) * pi / (double)(n + 1));

        assert_near(P.lambda[k], 2.0 * x * x, rounding(n, 4.0));
    }
    assert_orthonormal(&P, &p.M, 1e-11); /* measured: 1e-13 */
    ritz_pairs_free(&P);
    release(&p);
}

static void joints_without_mass_have_no_modes(void **state)
{
    (void)state;
    check_half_heavy(101, 101, "dense LAPACK");
    check_half_heavy(801, 200, "condensed LAPACK");
    check_half_heavy(2001, 30, "block Lanczos");
}

/* One mass of 1 at the end of 700 massless springs: lambda = 1 / 700. */
static void a_single_mass_has_a_single_mode(void **state)
{
    loop l = {0};
    pencil p = {0};
    ritz_pairs P = {0};

    (void)state;
    for (int64_t i = 0; i < 700; i++) {
        add(&l, i, i, i < 699 ? 2.0 : 1.0, i < 699 ? 0.0 : 1.0);
        if (i > 0) {
            add(&l, i, i - 1, -1.0, 0.0);
            add(&l, i - 1, i, -1.0, 0.0);
        }
    }
    p = finish(&l, 700);
    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 9}, &P));
    assert_int_equal(P.Phi.ncol, 1);
    assert_near(P.lambda[0], 1.0 / 700.0, 700.0 * DBL_EPSILON);
    ritz_pairs_free(&P);
    release(&p);
}

/* Stiffness as a file of ten digits holds it: the rigid mode is not lost. */
static void ten_digits_keep_the_rigid_modes(void **state)
{
    const int64_t elements[] = {287, 1001};

    (void)state;
    for (size_t e = 0; e < 2; e++) {
        pencil p = bars(1, elements[e], 0);
        ritz_pairs P = {0};

        for (int64_t k = 0; k < p.K.colptr[p.K.ncol]; k++) {
            char text[32];

            /* 1/3 of it, as whole numbers would need no rounding */
            snprintf(text, sizeof text, "%.9e", p.K.val[k] / 3.0);
            p.K.val[k] = strtod(text, NULL);
        }
        assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 4}, &P));
        assert_int_equal(P.num_rigid, 1);
        assert_int_equal(P.Phi.ncol, 5);
        ritz_pairs_free(&P);
        release(&p);
    }
}

/* Units of 1e-8 for every second dof: the same modes. */
static void units_do_not_matter(void **state)
{
    const int64_t elements[] = {200, 1200};

    (void)state;
    for (size_t e = 0; e < 2; e++) {
        int64_t n = elements[e];
        pencil p = bars(1, n, 0);
        ritz_pairs P = {0};

        for (int64_t j = 0; j <= n; j++)
            for (int64_t k = p.K.colptr[j]; k < p.K.colptr[j + 1]; k++) {
                double s = (j % 2 == 1 ? 1e-4 : 1.0) *
                           (p.K.rowind[k] % 2 == 1 ? 1e-4 : 1.0);

                p.K.val[k] *= s;
                p.M.val[k] *= s;
            }
        assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 5}, &P));
        assert_int_equal(P.num_rigid, 1);
        for (int64_t k = 0; k < 6; k++)
            assert_near(P.lambda[k], bar_eigenvalue(n, k),
                        rounding(n, 12.0 * (double)(n * n)));
        ritz_pairs_free(&P);
        release(&p);
    }
}

/*
 * Cantilever of n beam elements, E I = rho A = L = 1: its modes span ten
 * decades, and the first guess of sigma is far off. lambda_1 = 1.8751^4,
 * lambda_2 = 4.6941^4 [Blevins2016]; K is rounded by eps x'|K||x| = 48 n^4 eps.
 */
static void slender_beams_are_not_too_soft(void **state)
{
    enum { ELEMENTS = 400 };

    const double h = 1.0 / ELEMENTS;
    const double k[4][4] = {
        {12, 6, -12, 6}, {6, 4, -6, 2}, {-12, -6, 12, -6}, {6, 2, -6, 4}};
    const double m[4][4] = {{156, 22, 54, -13},
                            {22, 4, 13, -3},
                            {54, 13, 156, -22},
                            {-13, -3, -22, 4}};
    const double exact[] = {12.362363369, 485.518818};
    loop l = {0};
    pencil p = {0};
    ritz_pairs P = {0};

    (void)state;
    for (int64_t e = 0; e < ELEMENTS; e++)
        for (int64_t i = 0; i < 4; i++)
            for (int64_t j = 0; j < 4; j++) {
                double s = (i % 2 ? h : 1.0) * (j % 2 ? h : 1.0);

                if (2 * e + i >= 2 && 2 * e + j >= 2)
                    add(&l, 2 * e + i - 2, 2 * e + j - 2,
                        k[i][j] * s / (h * h * h), m[i][j] * s * h / 420.0);
            }
    p = finish(&l, 2 * (int64_t)ELEMENTS);
    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 8}, &P));
    assert_string_equal(P.engine, "block Lanczos");
    assert_int_equal(P.num_rigid, 0);
    assert_int_equal(P.Phi.ncol, 8);
    for (int64_t i = 0; i < 2; i++)
        assert_near(P.lambda[i], exact[i],
                    48.0 * pow(ELEMENTS, 4) * DBL_EPSILON + 1e-6 * exact[i]);
    ritz_pairs_free(&P);
    release(&p);
}

/* Between lambda_4 and lambda_5 there are 5 below, with the rigid one. */
static void inertia_counts_modes(void **state)
{
    pencil p = bars(1, 50, 0);
    double at = bar_eigenvalue(50, 4);
    int64_t count = -1;

    (void)state;
    assert_ok(ritz_eigen_count(&p.K, &p.M, 1.01 * at, &count));
    assert_int_equal(count, 5);
    assert_ok(ritz_eigen_count(&p.K, &p.M, -1.0, &count));
    assert_int_equal(count, 0);
    assert_fails(ritz_eigen_count(&p.K, &p.M, at, &count), RITZ_ERR_SINGULAR,
                 "the matrix is singular");
    assert_fails(ritz_eigen_count(&p.K, &p.M, HUGE_VAL, &count),
                 RITZ_ERR_ARGUMENT, "modes below inf");
    release(&p);
}

static void what_is_no_pencil_is_refused(void **state)
{
    pencil p = bars(1, 3, 0);
    ritz_sparse big = {0};
    ritz_pairs P = {0};

    (void)state;
    assert_ok(ritz_sparse_new(5, 5, 0, &big));
    assert_fails(ritz_eigen_sparse(&p.K, &big, &(ritz_span){.modes = 1}, &P),
                 RITZ_ERR_ARGUMENT, "stiffness is 4 x 4 but mass 5 x 5");
    assert_fails(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = -2}, &P),
                 RITZ_ERR_ARGUMENT, "-2 modes cannot be asked for");
    assert_fails(ritz_eigen_sparse(&p.K, &p.M,
                                   &(ritz_span){.modes = -1, .up_to_hz = 0.0},
                                   &P),
                 RITZ_ERR_ARGUMENT, "up to 0 Hz");
    assert_null(P.lambda);
    ritz_sparse_free(&big);
    release(&p);
}

/* Masses of 1 between springs of 1 and 1e9 in turn. Rounding of x'K x, 1e-7, is
   more than the lowest eigenvalues: that the first is zero shows once x'K x is
   summed with twice the digits. */
static void
a_free_chain_of_soft_and_stiff_springs_has_one_rigid_mode(void **state)
{
    enum { MASSES = 960 };
    loop l = {0};
    pencil p = {0};
    ritz_pairs P = {0};

    (void)state;
    for (int64_t i = 0; i < MASSES; i++) {
        const double k = i % 2 == 0 ? 1.0 : 1e9;

        add(&l, i, i, 0.0, 1.0);
        if (i + 1 == MASSES)
            continue;
        add(&l, i, i, k, 0.0);
        add(&l, i + 1, i + 1, k, 0.0);
        add(&l, i, i + 1, -k, 0.0);
        add(&l, i + 1, i, -k, 0.0);
    }
    p = finish(&l, MASSES);
    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 5}, &P));
    assert_int_equal(P.num_rigid, 1);
    assert_int_equal(P.Phi.ncol, 6);
    ritz_pairs_free(&P);
    release(&p);
}

static void masses_without_stiffness_are_refused(void **state)
{
    enum { MASSES = 960 };
    loop l = {0};
    pencil p = {0};
    ritz_pairs P = {0};

    (void)state;
    for (int64_t i = 0; i < MASSES; i++)
        add(&l, i, i, 0.0, 1.0);
    p = finish(&l, MASSES);
    assert_fails(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 5}, &P),
                 RITZ_ERR_SINGULAR, "the stiffness is zero");
    release(&p);
}

/* A negative mass, small beside 700 others and far above their rounding. */
static void a_small_negative_mass_is_refused(void **state)
{
    loop l = {0};
    pencil p = {0};
    ritz_pairs P = {0};

    (void)state;
    add_bar(&l, 700, 0, 0);
    add(&l, 701, 701, 1.0, -1e-4);
    p = finish(&l, 702);
    assert_fails(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 1}, &P),
                 RITZ_ERR_SINGULAR,
                 "mass is not positive definite: entry (701, 701) is -0.0001");
    assert_null(P.lambda);
    release(&p);
}

/* A dof with neither stiffness nor mass beside 700 that have both. */
static void a_mechanism_without_mass_is_refused(void **state)
{
    loop l = {0};
    pencil p = {0};
    ritz_pairs P = {0};

    (void)state;
    add_bar(&l, 700, 0, 0);
    add(&l, 701, 701, 0.0, 0.0);
    p = finish(&l, 702);
    assert_fails(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 1}, &P),
                 RITZ_ERR_SINGULAR, "is there a mechanism without mass?");
    assert_null(P.lambda);
    release(&p);
}

/* What a search lent its factor for. */
typedef struct lent {
    const pencil *p;
    int calls;
    int without; /* calls without a factor */
    int64_t count;
    double worst; /* |x - A^-1 (K - sigma M) x| of x = 1, 2, ... */
    ritz_status answer;
} lent;

static ritz_status use_factor(void *of, const ritz_pairs *found, int64_t count,
                              ritz_factor *A, double sigma)
{
    lent *l = of;
    RITZ_OWN(ritz_dense) x = {0}, y = {0}, mass = {0};

    l->without += !A;
    l->count = count;
    if (!A)
        return l->answer;
    RITZ_CHECK(ritz_dense_new(l->p->K.nrow, 1, &x));
    for (int64_t i = 0; i < x.nrow; i++)
        x.val[i] = (double)(i + 1) / (double)x.nrow;
    RITZ_CHECK(ritz_sparse_mul(&l->p->K, &x, &y));
    RITZ_CHECK(ritz_sparse_mul(&l->p->M, &x, &mass));
    ritz_dense_add(-sigma, &mass, &y);
    RITZ_CHECK(ritz_factor_solve(A, &y));
    ritz_dense_add(-1.0, &x, &y);
    l->worst = ritz_dense_max(&y);
    l->calls++;
    assert_true(count <= found->Phi.ncol);
    return l->answer;
}

/* By number and by frequency, with and without a count; not by LAPACK. */
static void the_factor_is_lent_while_it_is_there(void **state)
{
    const double fifth = ritz_eigen_hertz(bar_eigenvalue(700, 5)) * 1.01;
    const ritz_span spans[] = {
        {.modes = 5},
        {.modes = 5, .uncounted = true},
        {.modes = -1, .up_to_hz = fifth},
        {.modes = -1, .up_to_hz = fifth, .uncounted = true}};
    pencil p = bars(1, 700, 0), small = bars(1, 20, 0);

    (void)state;
    for (size_t k = 0; k < sizeof spans / sizeof *spans; k++) {
        lent l = {.p = &p};
        const ritz_factor_use use = {use_factor, &l};
        RITZ_OWN(ritz_pairs) P = {0};

        assert_ok(ritz_eigen_lending(&p.K, &p.M, &spans[k], &use, &P));
        assert_int_equal(P.Phi.ncol, 6);
        assert_int_equal(l.calls, 1);
        assert_int_equal(l.count, 6);
        /* |A| |A^-1| eps of a bar, whose mass at the shift is small */
        assert_near(l.worst, 0.0, 700.0 * 700.0 * 700.0 * DBL_EPSILON);
    }
    {
        lent l = {.p = &p, .answer = RITZ_ERR_CONVERGENCE};
        const ritz_factor_use use = {use_factor, &l};
        RITZ_OWN(ritz_pairs) P = {0};

        assert_int_equal(ritz_eigen_lending(&p.K, &p.M, &spans[0], &use, &P),
                         RITZ_ERR_CONVERGENCE);
        l = (lent){.p = &small};
        assert_ok(ritz_eigen_lending(&small.K, &small.M, &spans[0], &use, &P));
        assert_int_equal(l.calls + l.without, 0);
    }
    release(&p);
    release(&small);
}

/* Slices free the factor. Who uses it is told so, as an earlier search may have
   lent one for other pairs. */
static void a_factor_that_is_gone_is_reported(void **state)
{
    const ritz_span span = {.modes = 5, .engine = RITZ_EIGEN_SLICES};
    pencil p = bars(1, 700, 0);
    lent l = {.p = &p};
    const ritz_factor_use use = {use_factor, &l};
    RITZ_OWN(ritz_pairs) P = {0};

    (void)state;
    assert_ok(ritz_eigen_lending(&p.K, &p.M, &span, &use, &P));
    assert_string_equal(P.engine, "spectrum slices");
    assert_int_equal(l.calls, 0);
    assert_int_equal(l.without, 1);
    assert_int_equal(l.count, P.Phi.ncol);
    release(&p);
}

static ritz_status lowest(const pencil *p, int64_t modes)
{
    ritz_pairs P = {0};
    ritz_status status =
        ritz_eigen_sparse(&p->K, &p->M, &(ritz_span){.modes = modes}, &P);

    ritz_pairs_free(&P);
    return status;
}

/* Sizes are those of tests (linear/trial.h): 40 dofs for LAPACK, not 600. */
static void survive_with(const char *engine, pencil p, const char *found)
{
    RITZ_OWN(ritz_pairs) P = {0};

    setenv("RITZ_TEST_ENGINE", engine, 1);
    assert_ok(ritz_eigen_sparse(&p.K, &p.M, &(ritz_span){.modes = 1}, &P));
    assert_string_equal(P.engine, found);
    assert_survives_every_allocation(lowest(&p, 1));
    unsetenv("RITZ_TEST_ENGINE");
    release(&p);
}

/* Dense, condensed and iterative; what LAPACK, ARPACK and MUMPS take is
   theirs. */
static void no_allocation_failure_leaks(void **state)
{
    pencil p = bars(1, 5, 0);

    (void)state;
    assert_survives_every_allocation(lowest(&p, 2));
    release(&p);
    survive_with("lanczos", half_heavy(81), "condensed LAPACK"); /* 40 masses */
    survive_with("lanczos", bars(1, 62, 1), "block Lanczos");
    survive_with("arpack", bars(1, 62, 1), "ARPACK");
}

static void nothing_has_no_modes(void **state)
{
    RITZ_OWN(ritz_sparse) A = {0};
    RITZ_OWN(ritz_pairs) P = {0};

    (void)state;
    assert_ok(ritz_sparse_new(0, 0, 0, &A));
    assert_ok(ritz_eigen_sparse(&A, &A, &(ritz_span){.modes = 3}, &P));
    assert_int_equal(P.Phi.ncol, 0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(bars_have_the_modes_of_their_mesh),
    cmocka_unit_test(all_engines_find_the_same_modes),
    cmocka_unit_test(a_double_mode_is_never_cut),
    cmocka_unit_test(a_frequency_finds_every_mode_below),
    cmocka_unit_test(modes_are_counted_again_if_one_lies_at_the_limit),
    cmocka_unit_test(modes_at_every_limit_are_refused),
    cmocka_unit_test(there_may_be_no_mode),
    cmocka_unit_test(every_free_body_has_its_rigid_mode),
    cmocka_unit_test(joints_without_mass_have_no_modes),
    cmocka_unit_test(a_single_mass_has_a_single_mode),
    cmocka_unit_test(ten_digits_keep_the_rigid_modes),
    cmocka_unit_test(units_do_not_matter),
    cmocka_unit_test(slender_beams_are_not_too_soft),
    cmocka_unit_test(inertia_counts_modes),
    cmocka_unit_test(what_is_no_pencil_is_refused),
    cmocka_unit_test(a_free_chain_of_soft_and_stiff_springs_has_one_rigid_mode),
    cmocka_unit_test(masses_without_stiffness_are_refused),
    cmocka_unit_test(a_small_negative_mass_is_refused),
    cmocka_unit_test(a_mechanism_without_mass_is_refused),
    cmocka_unit_test(the_factor_is_lent_while_it_is_there),
    cmocka_unit_test(a_factor_that_is_gone_is_reported),
    cmocka_unit_test(no_allocation_failure_leaks),
    cmocka_unit_test(nothing_has_no_modes),
};

TEST_MODULE(eigen, tests, NULL, NULL)
