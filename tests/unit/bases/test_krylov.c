#include "testing.h"

#include "frame.h"
#include "masses.h"
#include "matrices.h"
#include "moments.h"
#include "project.h"
#include "truss.h"

#include <ritz/basis.h>
#include <ritz/matrix.h>

#include <float.h>
#include <lapacke.h>
#include <stdlib.h>

/* The clamped beam of [McDaniel2000], fig. 3.4, and a truss; no ports. */
typedef struct fixture {
    ritz_component beam, truss, cantilever;
    ritz_request of_beam, of_truss, of_cantilever;
} fixture;

enum { MIDDLE = 3, DEFLECTION = 4, BEAM_DOFS = 9 };

/* One input on all three dofs of the middle node, its deflection is read. */
static void set_beam_io(ritz_component *beam)
{
    const int64_t in = MIDDLE;
    const int64_t out = DEFLECTION;

    assert_ok(frame_io(beam, 1, &in, 1, &out));
    for (int k = 0; k < 3; k++)
        beam->io.B.val[MIDDLE + k] = 1.0;
}

static int set_up(void **state)
{
    static fixture f;
    static const int64_t in[] = {1, 40};
    static const int64_t out[] = {70, 69};

    f = (fixture){.of_beam = RITZ_REQUEST_NONE,
                  .of_truss = RITZ_REQUEST_NONE,
                  .of_cantilever = RITZ_REQUEST_NONE};
    assert_ok(frame_component(4, 0.5, &frame_mcdaniel, true, true, 1, &f.beam));
    set_beam_io(&f.beam);
    assert_ok(truss_component(&truss_free72, &f.truss));
    assert_ok(frame_io(&f.truss, 2, in, 2, out));
    assert_ok(truss_component(&truss_cantilever48, &f.cantilever));
    assert_ok(frame_io(&f.cantilever, 2, in, 1, &(int64_t){47}));
    f.of_beam.component = &f.beam;
    f.of_truss.component = &f.truss;
    f.of_cantilever.component = &f.cantilever;
    f.of_beam.choice.loads = RITZ_LOADS_INPUTS;
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;

    ritz_component_free(&f->beam);
    ritz_component_free(&f->truss);
    ritz_component_free(&f->cantilever);
    return 0;
}

static ritz_basis basis_of(ritz_request request, int64_t vectors)
{
    ritz_basis basis = {0};

    request.modes = vectors;
    assert_ok(ritz_basis_make(&ritz_method_krylov, &request, &basis));
    return basis;
}

/* Rounding of modal sums and solves: the spread of eigenvalues. */
static double spread(const ritz_component *component)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};
    double out = 0.0;

    assert_ok(ritz_sparse_dense(&component->K, &K));
    assert_ok(ritz_sparse_dense(&component->M, &M));
    assert_ok(ritz_eigen_dense(&K, &M, &pairs));
    out = pairs.lambda[pairs.Phi.ncol - 1] / pairs.lambda[pairs.num_rigid];
    return out;
}

/* --- the published example ------------------------------------------------ */

/* [McDaniel2000], table 3.5, recomputed; printed digits. */
static void krylov_frequencies_are_the_published_ones(void **state)
{
    static const struct row {
        int64_t k;
        double hertz[5];
    } table[] = {
        {3, {0.099461, 0.276577, 1.314513}},
        {4, {0.099460, 0.276339, 0.767679, 1.670544}},
        {5, {0.099460, 0.276336, 0.548248, 1.036741, 2.760385}},
    };
    fixture *f = *state;

    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        RITZ_OWN(ritz_basis) basis = basis_of(f->of_beam, table[i].k);
        RITZ_OWN(ritz_dense) K = project(&f->beam.K, &basis.T);
        RITZ_OWN(ritz_dense) M = project(&f->beam.M, &basis.T);
        RITZ_OWN(ritz_pairs) pairs = {0};

        assert_int_equal(basis.T.ncol, table[i].k);
        assert_ok(ritz_eigen_dense(&K, &M, &pairs));
        for (int64_t k = 0; k < table[i].k; k++)
            assert_near(ritz_eigen_hertz(pairs.lambda[k]), table[i].hertz[k],
                        1e-6); /* 0.5e-6 of the digits, and the last one */
    }
}

static const double published[6] = {0.33467, 0.83204,  2.12857,
                                    5.45023, 13.95575, 35.73486};

static void moments_are_the_published_ones(void **state)
{
    fixture *f = *state;
    moments_model full = moments_full(&f->beam);

    for (int j = 0; j < 6; j++) {
        RITZ_OWN(ritz_dense) m = moments_undamped(&full, 0.0, j);

        assert_near(m.val[0], published[j], 0.51e-5);
    }
    moments_free(&full);
}

static void as_many_moments_are_kept_as_there_are_vectors(void **state)
{
    fixture *f = *state;
    const double bound = BEAM_DOFS * DBL_EPSILON * spread(&f->beam);
    moments_model full = moments_full(&f->beam);

    for (int k = 1; k <= 5; k++) {
        RITZ_OWN(ritz_basis) basis = basis_of(f->of_beam, k);
        moments_model part = moments_reduced(&f->beam, &basis.T);

        moments_agree(&full, &part, 0.0, k, bound);
        assert_true(moments_differ(&full, &part, 0.0, k) > 1e1 * bound);
        moments_free(&part);
    }
    moments_free(&full);
}

static void twice_as_many_with_outputs_among_the_loads(void **state)
{
    fixture *f = *state;
    const double bound = BEAM_DOFS * DBL_EPSILON * spread(&f->beam);
    ritz_request request = f->of_beam;
    moments_model full = moments_full(&f->beam);

    request.choice.loads = RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS;
    for (int k = 1; k <= 3; k++) {
        RITZ_OWN(ritz_basis) basis = basis_of(request, 2 * k);
        moments_model part = moments_reduced(&f->beam, &basis.T);

        moments_agree(&full, &part, 0.0, 2 * k, bound);
        moments_free(&part);
    }
    moments_free(&full);
}

/* Ratio of the largest to the smallest singular value. */
static double condition(const ritz_dense *A)
{
    RITZ_OWN(ritz_dense) copy = {0};
    double s[BEAM_DOFS], rest[BEAM_DOFS];

    assert_ok(ritz_dense_copy(A, &copy));
    assert_int_equal(LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'N', 'N', (int)A->nrow,
                                    (int)A->ncol, copy.val, (int)A->nrow, s,
                                    NULL, 1, NULL, 1, rest),
                     0);
    return s[0] / s[A->ncol - 1];
}

/* K^-1 G, K^-1 M K^-1 G, ... as they come. */
static ritz_dense raw_vectors(const ritz_component *c, int64_t k)
{
    ritz_dense out = {0}, x = {0};
    RITZ_OWN(ritz_factor) *L = NULL;

    assert_ok(ritz_dense_new(c->num_dofs, k, &out));
    assert_ok(ritz_factor_spd(&c->K, &L));
    assert_ok(ritz_dense_copy(&c->io.B, &x));
    for (int64_t j = 0; j < k; j++) {
        ritz_dense Mx = {0};

        assert_ok(ritz_factor_solve(L, &x));
        memcpy(ritz_dense_col(&out, j), x.val,
               (size_t)c->num_dofs * sizeof *x.val);
        assert_ok(ritz_sparse_mul(&c->M, &x, &Mx));
        ritz_dense_free(&x);
        x = Mx;
    }
    ritz_dense_free(&x);
    return out;
}

/* Published: 1.9e6 and 8.6e9. In the inner product of K ours is 1. */
static void raw_vectors_lose_what_orthonormal_ones_keep(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_dense) five = raw_vectors(&f->beam, 5);
    RITZ_OWN(ritz_dense) six = raw_vectors(&f->beam, 6);
    RITZ_OWN(ritz_basis) basis = basis_of(f->of_beam, 6);
    RITZ_OWN(ritz_dense) VKV = project(&f->beam.K, &basis.T);

    assert_near(condition(&five), 1.9e6, 0.05e6);
    assert_near(condition(&six), 8.6e9, 0.05e9);
    assert_near(condition(&VKV), 1.0, 6 * DBL_EPSILON * 1e4);
}

/* One antisymmetric mode is out of reach of this input: 8 of 9 dofs. */
static void the_controllable_space_is_found_by_deflation(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = basis_of(f->of_beam, 9);

    assert_int_equal(basis.T.ncol, 8);
    assert_non_null(strstr(basis.remark, "8 vectors and not 9"));
    assert_non_null(strstr(basis.remark, "nothing new is left"));
}

/* --- the form of the reduced matrices ------------------------------------- */

/* Loads come in blocks of three; M_ij = 0 for blocks further than one apart. */
static void reduced_mass_is_block_tridiagonal(void **state)
{
    enum { BLOCK = 3 };
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = basis_of(f->of_cantilever, 5 * BLOCK);
    RITZ_OWN(ritz_dense) M = project(&f->cantilever.M, &basis.T);
    /* a product loses eps |v|'|K||v|, of K-orthonormal v: below the spread */
    const double bound =
        DBL_EPSILON * spread(&f->cantilever) * ritz_dense_max(&M);

    for (int64_t j = 0; j < M.ncol; j++)
        for (int64_t i = 0; i < M.nrow; i++)
            if (llabs(i / BLOCK - j / BLOCK) > 1)
                assert_near(ritz_dense_col(&M, j)[i], 0.0, bound);
    assert_true(fabs(ritz_dense_col(&M, BLOCK)[0]) > 1e3 * bound);
}

/* max |v|'|W||v| of the columns of V. */
static double largest_sum(const ritz_sparse *W, const ritz_dense *V)
{
    double most = 0.0;

    for (int64_t k = 0; k < V->ncol; k++) {
        const double *v = ritz_dense_col(V, k);
        double sum = 0.0;

        for (int64_t j = 0; j < W->ncol; j++)
            for (int64_t p = W->colptr[j]; p < W->colptr[j + 1]; p++)
                sum += fabs(v[W->rowind[p]] * W->val[p] * v[j]);
        most = fmax(most, sum);
    }
    return most;
}

/* max |V'WV - I| over eps max |v|'|W||v|. */
static double excess(const ritz_sparse *W, const ritz_dense *V)
{
    RITZ_OWN(ritz_dense) G = project(W, V);
    double worst = 0.0;

    for (int64_t j = 0; j < G.ncol; j++)
        ritz_dense_col(&G, j)[j] -= 1.0;
    worst = ritz_dense_max(&G);
    return worst / (DBL_EPSILON * largest_sum(W, V));
}

/* 16 is what the remark is held to; a long thin beam is as bad as it comes. */
static void vectors_are_as_orthonormal_as_products_can_show(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_component) thin = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    ritz_basis basis = {0};

    assert_ok(
        frame_component(300, 0.01, &frame_mcdaniel, true, false, 1, &thin));
    assert_ok(frame_io(&thin, 1, &(int64_t){898}, 1, &(int64_t){451}));
    request.component = &thin;
    basis = basis_of(request, 20);
    assert_true(excess(&thin.K, &basis.T) <= 16.0);
    assert_non_null(strstr(basis.remark, "|V'KV - I| is "));
    assert_non_null(strstr(basis.remark, ", within "));
    ritz_basis_free(&basis);
    basis = basis_of(f->of_cantilever, 20);
    assert_true(excess(&f->cantilever.K, &basis.T) <= 16.0);
    ritz_basis_free(&basis);
}

static void the_mass_inner_product_gives_the_same_span(void **state)
{
    fixture *f = *state;
    ritz_request request = f->of_cantilever;
    const double bound = 48 * DBL_EPSILON * spread(&f->cantilever);
    RITZ_OWN(ritz_basis) basis = {0};
    moments_model full = moments_full(&f->cantilever), part = {0};

    request.choice.inner = RITZ_INNER_MASS;
    basis = basis_of(request, 9);
    part = moments_reduced(&f->cantilever, &basis.T);
    assert_true(excess(&f->cantilever.M, &basis.T) <= 16.0);
    assert_non_null(strstr(basis.remark, "|V'MV - I| is "));
    moments_agree(&full, &part, 0.0, 6, bound);
    moments_free(&full);
    moments_free(&part);
}

/* Uniform in [-1, 1], the same on every machine. */
static double uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) * 0x1p-52 - 1.0;
}

enum { SMALL = 12 };

/* R'R + n / 10: definite by construction. */
static void random_definite(uint64_t *seed, ritz_sparse *out)
{
    double R[SMALL * SMALL], val[SMALL * SMALL] = {0.0};
    int64_t row[SMALL * SMALL], col[SMALL * SMALL];

    for (int k = 0; k < SMALL * SMALL; k++)
        R[k] = uniform(seed);
    for (int64_t k = 0; k < SMALL * SMALL; k++) {
        row[k] = k % SMALL;
        col[k] = k / SMALL;
        for (int i = 0; i < SMALL; i++)
            val[k] += R[i + SMALL * row[k]] * R[i + SMALL * col[k]];
        val[k] += row[k] == col[k] ? 0.1 * SMALL : 0.0;
    }
    assert_ok(ritz_sparse_from_triplets(SMALL, SMALL, (int64_t)SMALL * SMALL,
                                        row, col, val, out));
}

static void check_definite(ritz_dense *A)
{
    int n = (int)A->nrow;

    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            assert_near(ritz_dense_col(A, j)[i], ritz_dense_col(A, i)[j],
                        SMALL * DBL_EPSILON * ritz_dense_max(A));
    assert_int_equal(LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, A->val, n), 0);
    ritz_dense_free(A);
}

/* A Galerkin method: 1 000 random pencils with three loads, seven vectors. */
static void symmetry_and_definiteness_are_kept(void **state)
{
    uint64_t seed = 1;
    ritz_request request = RITZ_REQUEST_NONE;

    (void)state;
    for (int trial = 0; trial < 1000; trial++) {
        int64_t attached[] = {0, 5, 9};
        RITZ_OWN(ritz_component) c = {.num_dofs = SMALL};
        RITZ_OWN(ritz_basis) basis = {0};
        ritz_dense K = {0}, M = {0};

        assert_non_null(c.dof = calloc(SMALL, sizeof *c.dof));
        for (int64_t i = 0; i < SMALL; i++)
            c.dof[i] = (ritz_dof){i + 1, 1};
        random_definite(&seed, &c.K);
        random_definite(&seed, &c.M);
        assert_ok(ritz_component_settle(&c, false));
        request.component = &c;
        request.attached = (ritz_dofs){3, attached};
        basis = basis_of(request, 7);
        assert_int_equal(basis.T.ncol, 7);
        K = project(&c.K, &basis.T);
        M = project(&c.M, &basis.T);
        check_definite(&K);
        check_definite(&M);
    }
}

/* --- free bodies ---------------------------------------------------------- */

/* Four loads in a block: one block keeps two moments, two keep four. */
static void a_free_body_keeps_rigid_motion_and_elastic_moments(void **state)
{
    fixture *f = *state;
    const double bound = 72 * DBL_EPSILON * spread(&f->truss);
    moments_model full = moments_full(&f->truss);

    for (int blocks = 1; blocks <= 2; blocks++) {
        int64_t vectors = 4 * (int64_t)blocks;
        RITZ_OWN(ritz_basis) basis = basis_of(f->of_truss, vectors);
        moments_model part = moments_reduced(&f->truss, &basis.T);
        RITZ_OWN(ritz_pairs) pairs = {0};

        assert_int_equal(basis.T.ncol, 3 + vectors);
        for (int64_t j = 0; j < 3 + vectors; j++)
            assert_int_equal(basis.columns.kind[j],
                             j < 3 ? RITZ_COLUMN_RIGID : RITZ_COLUMN_KRYLOV);
        assert_true(isnan(basis.columns.hertz[3]));
        moments_agree(&full, &part, 0.0, 2 * blocks, bound);
        if (blocks == 1)
            assert_true(moments_differ(&full, &part, 0.0, 2) > 10.0 * bound);
        assert_ok(ritz_eigen_dense(&part.K, &part.M, &pairs));
        assert_int_equal(pairs.num_rigid, 3);
        moments_free(&part);
    }
    moments_free(&full);
}

/* X = P' S P F with the support as given. */
static void answer_on(const ritz_component *c, const ritz_dense *Phi,
                      const int64_t held[3], ritz_dense *X)
{
    int64_t at[3] = {held[0], held[1], held[2]};
    ritz_dofs support = {3, at}, rest = {0};
    RITZ_OWN(ritz_sparse) K_ww = {0};
    RITZ_OWN(ritz_factor) *L = NULL;
    ritz_dense MPhi = {0}, F = {0}, share = {0}, x = {0}, gone = {0};

    assert_ok(ritz_dofs_complement(&support, c->num_dofs, &rest));
    assert_ok(ritz_sparse_extract(&c->K, rest.count, rest.at, rest.count,
                                  rest.at, &K_ww));
    assert_ok(ritz_factor_spd(&K_ww, &L));
    assert_ok(ritz_sparse_mul(&c->M, Phi, &MPhi));
    assert_ok(ritz_dense_copy(&c->io.B, &F));
    assert_ok(ritz_dense_mul_tn(Phi, &F, &share));
    assert_ok(ritz_dense_mul(&MPhi, &share, &gone));
    assert_ok(ritz_dense_new(rest.count, F.ncol, &x));
    assert_ok(ritz_dense_new(c->num_dofs, F.ncol, X));
    for (int64_t j = 0; j < F.ncol; j++)
        for (int64_t i = 0; i < rest.count; i++)
            ritz_dense_col(&x, j)[i] = ritz_dense_col(&F, j)[rest.at[i]] -
                                       ritz_dense_col(&gone, j)[rest.at[i]];
    assert_ok(ritz_factor_solve(L, &x));
    for (int64_t j = 0; j < F.ncol; j++)
        for (int64_t i = 0; i < rest.count; i++)
            ritz_dense_col(X, j)[rest.at[i]] = ritz_dense_col(&x, j)[i];
    ritz_dense_free(&share);
    ritz_dense_free(&gone);
    assert_ok(ritz_dense_mul_tn(&MPhi, X, &share));
    assert_ok(ritz_dense_mul(Phi, &share, &gone));
    for (int64_t k = 0; k < X->nrow * X->ncol; k++)
        X->val[k] -= gone.val[k];
    ritz_dofs_free(&rest);
    ritz_dense_free(&MPhi);
    ritz_dense_free(&F);
    ritz_dense_free(&share);
    ritz_dense_free(&x);
    ritz_dense_free(&gone);
}

/* The static answers of equation (6) lie in the span, whatever holds the body:
 * within the rounding of solves, eps times the spread of eigenvalues. */
static void the_formula_with_any_support_gives_the_same(void **state)
{
    fixture *f = *state;
    const int64_t supports[][3] = {{0, 1, 2}, {0, 1, 69}, {30, 33, 65}};
    const double bound = 72 * DBL_EPSILON * spread(&f->truss);
    ritz_request request = f->of_truss;
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dense) Phi = {0}, V = {0};

    request.choice.loads = RITZ_LOADS_INPUTS;
    basis = basis_of(request, 2);
    assert_ok(ritz_dense_columns(&basis.T, 0, 3, &Phi));
    assert_ok(ritz_dense_columns(&basis.T, 3, 2, &V));
    for (int s = 0; s < 3; s++) {
        RITZ_OWN(ritz_dense) X = {0};

        answer_on(&f->truss, &Phi, supports[s], &X);
        assert_near(outside(&f->truss.K, &V, &X), 0.0, bound);
    }
}

/* --- several points, and loads that depend on each other ------------------ */

static void moments_are_kept_about_every_point(void **state)
{
    fixture *f = *state;
    const double hertz[] = {60.0, 0.0};
    ritz_component *const bodies[] = {&f->truss, &f->cantilever};
    const ritz_request *const requests[] = {&f->of_truss, &f->of_cantilever};

    for (int b = 0; b < 2; b++) {
        ritz_request request = *requests[b];
        const double bound = 72 * DBL_EPSILON * spread(bodies[b]);
        moments_model full = moments_full(bodies[b]), part = {0};
        int64_t block = b == 0 ? 4 : 3;
        RITZ_OWN(ritz_basis) basis = {0};

        request.choice.num_shifts = 2;
        memcpy(request.choice.shift_hz, hertz, sizeof hertz);
        basis = basis_of(request, 4 * block);
        part = moments_reduced(bodies[b], &basis.T);
        assert_non_null(strstr(basis.remark, "2 whole block(s) about 0 Hz, 2 "
                                             "whole block(s) about 60 Hz"));
        assert_string_equal(basis.origin.engine, "CHOLMOD + MUMPS");
        moments_agree(&full, &part, 0.0, 4, bound);
        moments_agree(&full, &part, ritz_eigen_lambda(60.0), 4, bound);
        moments_free(&full);
        moments_free(&part);
    }
}

/* An input twice, and the sum of two: six loads are four. */
static void dependent_loads_are_left_out(void **state)
{
    fixture *f = *state;
    ritz_component twin = f->truss;
    ritz_request request = f->of_truss;
    ritz_dense B = {0};
    RITZ_OWN(ritz_basis) once = basis_of(request, 8);

    assert_ok(ritz_dense_new(72, 4, &B));
    memcpy(B.val, twin.io.B.val, 144 * sizeof *B.val);
    memcpy(ritz_dense_col(&B, 2), twin.io.B.val, 72 * sizeof *B.val);
    for (int64_t i = 0; i < 72; i++)
        ritz_dense_col(&B, 3)[i] =
            2.0 * twin.io.B.val[i] - twin.io.B.val[72 + i];
    twin.io.B = B;
    twin.io.num_inputs = 4;
    request.component = &twin;
    RITZ_OWN(ritz_basis) twice = basis_of(request, 8);
    assert_int_equal(twice.T.ncol, once.T.ncol);
    assert_non_null(strstr(twice.remark, "2 whole block(s) about 0 Hz"));
    ritz_dense_free(&B);
}

/* Seven vectors of three loads are two blocks and a third of one. */
static void a_block_that_is_cut_does_not_count(void **state)
{
    fixture *f = *state;
    RITZ_OWN(ritz_basis) basis = basis_of(f->of_cantilever, 7);

    assert_int_equal(basis.T.ncol, 7);
    assert_non_null(strstr(basis.remark, "2 whole block(s) about 0 Hz"));
}

/* Two loads that differ by 1e-6: one or two, as the tolerance says. */
static void the_tolerance_says_what_depends(void **state)
{
    fixture *f = *state;
    static const double tolerances[] = {1e-3, 1e-10};
    ritz_component near = f->cantilever;
    ritz_request request = f->of_cantilever;
    ritz_dense B = {0};

    assert_ok(ritz_dense_copy(&near.io.B, &B));
    memcpy(ritz_dense_col(&B, 1), B.val, 48 * sizeof *B.val);
    ritz_dense_col(&B, 1)[20] += 1e-6;
    near.io.B = B;
    request.component = &near;
    request.choice.loads = RITZ_LOADS_INPUTS;
    for (int k = 0; k < 2; k++) {
        RITZ_OWN(ritz_basis) basis = {0};

        request.tolerance = tolerances[k];
        basis = basis_of(request, 2);
        assert_non_null(strstr(basis.remark, k ? "1 whole" : "2 whole"));
    }
    ritz_dense_free(&B);
}

/* A velocity that is read starts a chain as a displacement does: y = W x' has
 * the moments of W x, one power of s later. */
static void velocity_outputs_keep_their_moments(void **state)
{
    fixture *f = *state;
    ritz_component gauge = f->cantilever;
    ritz_request request = f->of_cantilever;
    const double bound = 48 * DBL_EPSILON * spread(&gauge);
    ritz_dense none = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    moments_model full = moments_full(&gauge), part = {0};

    assert_ok(ritz_dense_new(1, 48, &none));
    gauge.io.Cv = f->cantilever.io.C;
    gauge.io.C = none;
    request.component = &gauge;
    basis = basis_of(request, 6);
    part = moments_reduced(&f->cantilever, &basis.T);
    moments_agree(&full, &part, 0.0, 4, bound);
    moments_free(&full);
    moments_free(&part);
    ritz_dense_free(&none);
}

/* --- masses that are not there, and other corners ------------------------- */

/* Masses on springs, of which every second one is nothing: M is singular. */
static ritz_component chain_of(int64_t n, bool grounded)
{
    ritz_component c = {0};
    double k[MASSES_MOST], m[MASSES_MOST];

    assert_true(n <= MASSES_MOST);
    for (int64_t i = 0; i < n; i++) {
        k[i] = i > 0 || grounded ? 1.0 : 0.0;
        m[i] = i % 2 ? 0.0 : 2.0;
    }
    assert_ok(masses_component(n, m, k, NULL, &c));
    assert_ok(frame_io(&c, 1, &(int64_t){1}, 1, &(int64_t){n - 1}));
    return c;
}

/* Six dofs, three of them with mass: a force on one without is a vector more
 * than there are modes, and then there is no more. */
static void dofs_without_mass_are_answered(void **state)
{
    const bool grounded[] = {true, false};

    (void)state;
    for (int g = 0; g < 2; g++) {
        RITZ_OWN(ritz_component) c = chain_of(6, grounded[g]);
        ritz_request request = RITZ_REQUEST_NONE;
        ritz_basis basis = {0};
        moments_model full = moments_full(&c), part = {0};

        request.component = &c;
        basis = basis_of(request, 4);
        part = moments_reduced(&c, &basis.T);
        if (grounded[g]) {
            RITZ_OWN(ritz_dense) a = moments_damped(&full, 0);
            RITZ_OWN(ritz_dense) b = moments_damped(&part, 0);

            assert_near(a.val[0], b.val[0], 64 * DBL_EPSILON * a.val[0]);
        }
        moments_free(&part);
        ritz_basis_free(&basis);
        basis = basis_of(request, 6);
        assert_true(basis.T.ncol <= 6);
        assert_non_null(strstr(basis.remark, "nothing new is left"));
        moments_free(&full);
        ritz_basis_free(&basis);
    }
}

static void a_rigid_body_is_its_rigid_motion(void **state)
{
    RITZ_OWN(ritz_component) mass = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    int64_t zero = 0;
    RITZ_OWN(ritz_basis) basis = {0};

    (void)state;
    assert_ok(masses_component(1, &(double){4.0}, &(double){0.0}, NULL, &mass));
    request.component = &mass;
    request.attached = (ritz_dofs){1, &zero};
    basis = basis_of(request, 3);
    assert_int_equal(basis.T.ncol, 1);
    assert_int_equal(basis.columns.kind[0], RITZ_COLUMN_RIGID);
    assert_non_null(strstr(basis.remark, "0 vectors and not 3"));
}

/* Weight moves a free body and bends it nowhere: M t leaves rounding to the
 * elastic part, and rounding is no answer. */
static void weight_is_no_load_of_a_free_body(void **state)
{
    fixture *f = *state;
    ritz_component heavy = f->truss;
    ritz_request request = f->of_truss;
    ritz_dense t = {0}, B = {0};
    RITZ_OWN(ritz_basis) basis = {0};

    assert_ok(ritz_dense_new(72, 1, &t));
    for (int64_t i = 0; i < 72; i++)
        t.val[i] = i % 2 ? -9.81 : 0.1;
    assert_ok(ritz_sparse_mul(&heavy.M, &t, &B));
    heavy.io.B = B;
    heavy.io.num_inputs = 1;
    request.component = &heavy;
    request.choice.loads = RITZ_LOADS_INPUTS;
    basis = basis_of(request, 2);
    assert_int_equal(basis.T.ncol, 3);
    assert_non_null(strstr(basis.remark, "0 vectors and not 2"));
    ritz_dense_free(&t);
    ritz_dense_free(&B);
}

static void requests_that_make_no_sense_are_refused(void **state)
{
    fixture *f = *state;
    ritz_request request = f->of_cantilever;
    RITZ_OWN(ritz_component) massless = chain_of(6, true);
    ritz_basis none = {0};

    request.up_to_hz = 10.0;
    assert_fails(ritz_basis_make(&ritz_method_krylov, &request, &none),
                 RITZ_ERR_ARGUMENT, "ask for a number of them");
    request.up_to_hz = 0.0;
    request.modes = 4;
    request.choice.loads = RITZ_LOADS_ATTACHED;
    assert_fails(ritz_basis_make(&ritz_method_krylov, &request, &none),
                 RITZ_ERR_ARGUMENT, "there is no load to respond to");
    request.choice.loads = 0;
    request.modes = 0;
    assert_fails(ritz_basis_make(&ritz_method_krylov, &request, &none),
                 RITZ_ERR_ARGUMENT, "the basis would have no vectors");
    request.modes = 4;
    request.choice.inner = RITZ_INNER_MASS;
    request.component = &massless;
    assert_fails(ritz_basis_make(&ritz_method_krylov, &request, &none),
                 RITZ_ERR_SINGULAR, "mass is singular");
}

/* K - sigma M = 0 exactly. */
static void an_expansion_about_a_resonance_is_refused(void **state)
{
    RITZ_OWN(ritz_component) c = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    const double one = 1.0;
    const double stiffness = ritz_eigen_lambda(1.0);
    int64_t zero = 0;
    ritz_basis none = {0};

    (void)state;
    assert_ok(masses_component(1, &one, &stiffness, NULL, &c));
    request.component = &c;
    request.attached = (ritz_dofs){1, &zero};
    request.modes = 1;
    request.choice.num_shifts = 1;
    request.choice.shift_hz[0] = 1.0;
    assert_fails(ritz_basis_make(&ritz_method_krylov, &request, &none),
                 RITZ_ERR_SINGULAR,
                 "expansion point 1 Hz is a natural frequency: move it");
}

/* A spring of -1 beside two of 1 to ground. */
static void a_stiffness_that_is_not_definite_is_refused(void **state)
{
    static const int64_t row[] = {0, 1, 0, 1}, col[] = {0, 0, 1, 1};
    static const double k[] = {0.0, 1.0, 1.0, 0.0};
    ritz_request request = RITZ_REQUEST_NONE;
    RITZ_OWN(ritz_component) c = {.num_dofs = 2};
    int64_t first = 0;
    ritz_basis none = {0};

    (void)state;
    assert_non_null(c.dof = calloc(2, sizeof *c.dof));
    c.dof[0] = (ritz_dof){1, 1};
    c.dof[1] = (ritz_dof){2, 1};
    assert_ok(ritz_sparse_from_triplets(2, 2, 4, row, col, k, &c.K));
    assert_ok(ritz_sparse_from_triplets(2, 2, 2, (int64_t[]){0, 1},
                                        (int64_t[]){0, 1}, (double[]){1.0, 1.0},
                                        &c.M));
    assert_ok(ritz_component_settle(&c, false));
    request.component = &c;
    request.attached = (ritz_dofs){1, &first};
    request.modes = 1;
    assert_fails(ritz_basis_make(&ritz_method_krylov, &request, &none),
                 RITZ_ERR_SINGULAR, "an eigenvalue is -1");
}

static void no_allocation_failure_leaks(void **state)
{
    fixture *f = *state;
    ritz_request request = f->of_truss;
    RITZ_OWN(ritz_basis) basis = {0};

    request.modes = 10;
    assert_survives_every_allocation(ritz_method_krylov.make(&request, &basis));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(krylov_frequencies_are_the_published_ones),
    cmocka_unit_test(moments_are_the_published_ones),
    cmocka_unit_test(as_many_moments_are_kept_as_there_are_vectors),
    cmocka_unit_test(twice_as_many_with_outputs_among_the_loads),
    cmocka_unit_test(raw_vectors_lose_what_orthonormal_ones_keep),
    cmocka_unit_test(the_controllable_space_is_found_by_deflation),
    cmocka_unit_test(reduced_mass_is_block_tridiagonal),
    cmocka_unit_test(vectors_are_as_orthonormal_as_products_can_show),
    cmocka_unit_test(the_mass_inner_product_gives_the_same_span),
    cmocka_unit_test(symmetry_and_definiteness_are_kept),
    cmocka_unit_test(a_free_body_keeps_rigid_motion_and_elastic_moments),
    cmocka_unit_test(the_formula_with_any_support_gives_the_same),
    cmocka_unit_test(moments_are_kept_about_every_point),
    cmocka_unit_test(dependent_loads_are_left_out),
    cmocka_unit_test(a_block_that_is_cut_does_not_count),
    cmocka_unit_test(the_tolerance_says_what_depends),
    cmocka_unit_test(velocity_outputs_keep_their_moments),
    cmocka_unit_test(dofs_without_mass_are_answered),
    cmocka_unit_test(a_rigid_body_is_its_rigid_motion),
    cmocka_unit_test(weight_is_no_load_of_a_free_body),
    cmocka_unit_test(requests_that_make_no_sense_are_refused),
    cmocka_unit_test(an_expansion_about_a_resonance_is_refused),
    cmocka_unit_test(a_stiffness_that_is_not_definite_is_refused),
    cmocka_unit_test(no_allocation_failure_leaks),
};

TEST_MODULE(krylov, tests, set_up, tear_down)
