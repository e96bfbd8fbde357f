/* Sparse pencils: closed forms of tridiagonal ones, and refusals. */
#include "testing.h"

#include "spaces.h"

#include "base/complex.h"
#include "linear/pencil.h"

#include <complex.h>
#include <stdlib.h>

static void pencil_of(int64_t n, double wind, bool mass, ritz_pencil *out)
{
    RITZ_OWN(ritz_state_space) rod = {0};

    assert_ok(spaces_rod(n, wind, mass, &rod));
    assert_ok(ritz_pencil_new(&rod.sA, &rod.sE, out));
}

/* |(A - s E) x - b|, or the same of the transposed matrix. */
static double left_over(const ritz_pencil *p, bool transposed,
                        double _Complex s, const double _Complex *x,
                        const double _Complex *b)
{
    double _Complex *Ax = calloc((size_t)p->n, sizeof *Ax);
    double _Complex *Ex = calloc((size_t)p->n, sizeof *Ex);
    double worst = 0.0;

    assert_true(Ax && Ex);
    ritz_pencil_times(ritz_pencil_system(p, transposed), 1, x, Ax);
    ritz_pencil_times(ritz_pencil_descriptor(p, transposed), 1, x, Ex);
    for (int64_t i = 0; i < p->n; i++)
        worst = fmax(worst, cabs(Ax[i] - s * Ex[i] - b[i]));
    free(Ax);
    free(Ex);
    return worst;
}

static void both_sides_are_solved(void **)
{
    const double _Complex at[] = {0.0, ritz_complex(0.3, 0.5), 2.0};

    for (int k = 0; k < 12; k++) {
        const double wind = k & 1 ? 0.4 : 0.0;
        const bool transposed = k & 2;
        RITZ_OWN(ritz_pencil) p = {0};
        double _Complex b[30], x[30];

        pencil_of(30, wind, k % 4 < 2, &p);
        assert_true(ritz_pencil_is_symmetric(&p) == (wind == 0.0));
        for (int i = 0; i < 30; i++)
            x[i] = b[i] = ritz_complex(cos(i), sin(3 * i));
        assert_ok(ritz_pencil_factor(&p, at[k % 3]));
        assert_ok(ritz_pencil_solve(&p, transposed, 1, x));
        /* condition 900, and entries of x up to 500 */
        assert_near(left_over(&p, transposed, at[k % 3], x, b), 0.0, 1e-12);
    }
}

/* Poles nearest to a shift, of small rods (dense eigenvalues) and of larger
   ones (Arnoldi iterations). */
static void eigenvalues_near_a_point_are_those_of_the_closed_form(void **)
{
    static const struct {
        int64_t n;
        double wind, shift;
        int64_t first; /* number of the pole nearest to the shift */
    } table[] = {{40, 0.0, 0.0, 1},
                 {400, 0.0, 0.0, 1},
                 {400, 0.01, 0.0, 1},
                 {400, 0.0, -4.5, 400}};

    for (size_t t = 0; t < sizeof table / sizeof *table; t++) {
        RITZ_OWN(ritz_pencil) p = {0};
        RITZ_OWN(ritz_pencil_pairs) pairs = {0};

        pencil_of(table[t].n, table[t].wind, false, &p);
        assert_ok(ritz_pencil_nearest(&p, table[t].shift, 6, &pairs));
        assert_int_equal(pairs.count, 6);
        for (int64_t k = 0; k < 6; k++) {
            int64_t which = table[t].first == 1 ? k + 1 : table[t].first - k;

            assert_near(creal(pairs.s[k]),
                        spaces_rod_pole(table[t].n, table[t].wind, which),
                        1e-10);
            assert_true(cimag(pairs.s[k]) == 0.0);
            assert_near(pairs.residual[k], 0.0, 1e-11);
        }
    }
}

/* With a wind above 1 the poles are pairs -2 +- 2 i sqrt(wind^2 - 1)
   cos(..). */
static void the_pole_above_the_real_axis_comes_first(void **)
{
    RITZ_OWN(ritz_pencil) p = {0};
    RITZ_OWN(ritz_pencil_pairs) pairs = {0};
    const double size = 2.0 * sqrt(9999.0);

    pencil_of(300, 100.0, false, &p);
    assert_ok(ritz_pencil_nearest(&p, -1.0, 4, &pairs));
    for (int64_t k = 0; k < 4; k++) {
        int64_t which = 150 - k / 2;
        double im = size * cos((double)which * acos(-1.0) / 301.0);

        assert_near(creal(pairs.s[k]), -2.0, 1e-9);
        assert_near(cimag(pairs.s[k]), k % 2 ? -im : im, 1e-9);
    }
}

static void a_shift_on_an_eigenvalue_is_refused(void **)
{
    RITZ_OWN(ritz_pencil) p = {0};
    RITZ_OWN(ritz_pencil_pairs) pairs = {0};

    pencil_of(41, 0.0, false, &p);
    assert_fails(ritz_pencil_nearest(&p, -2.0, 3, &pairs), RITZ_ERR_SINGULAR,
                 "singular"); /* pole 21 is -2 */
    assert_fails(ritz_pencil_nearest(&p, 0.0, 0, &pairs), RITZ_ERR_ARGUMENT,
                 "no poles are asked for");
}

static ritz_status find_some(int64_t n)
{
    RITZ_OWN(ritz_state_space) rod = {0};
    RITZ_OWN(ritz_pencil) p = {0};
    RITZ_OWN(ritz_pencil_pairs) pairs = {0};

    RITZ_CHECK(spaces_rod(n, 0.2, true, &rod));
    RITZ_CHECK(ritz_pencil_new(&rod.sA, &rod.sE, &p));
    return ritz_pencil_nearest(&p, 0.0, 2, &pairs);
}

static void every_allocation_may_fail(void **)
{
    assert_survives_every_allocation(find_some(20));
    assert_survives_every_allocation(find_some(130));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(both_sides_are_solved),
    cmocka_unit_test(eigenvalues_near_a_point_are_those_of_the_closed_form),
    cmocka_unit_test(the_pole_above_the_real_axis_comes_first),
    cmocka_unit_test(a_shift_on_an_eigenvalue_is_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(pencil, tests, NULL, NULL)
