/*
 * The cooled rail of the benchmark collections, E x' = A x + B u with E and A
 * symmetric. The file is of the mesh of 1357 nodes, whatever its folder says;
 * the values of the mesh of 371 are 0.194054765 0.036274691 0.03317563.
 */
#include "testing.h"

#include "spaces.h"

#include <ritz/basis.h>

#include <stdio.h>
#include <stdlib.h>

/* Outside: closed form of symmetric pencils, eigenvalues of the product of
   Gramians, SciPy 1.10. Eigenvalues from 2e-5 to 8 are known to eps 8. */
static void the_rail_has_its_values(void **unused)
{
    static const struct {
        int64_t at;
        double sigma;
    } known[] = {{0, 0.1905332214551},   {1, 0.03464639844634},
                 {2, 0.03244911947213},  {3, 0.01938916049019},
                 {4, 0.01550985149871},  {5, 0.01222226140857},
                 {40, 1.180314481336e-5}};
    RITZ_OWN(ritz_state_space) model = {0};
    RITZ_OWN(ritz_gramians) g = {0};
    int64_t count = 0;
    double *sigma = NULL;

    (void)unused;
    if (!spaces_read("rail_371", &model))
        skip();
    if (model.A.nrow != 1357) {
        printf("skipped: the rail has %d nodes\n", (int)model.A.nrow);
        skip();
    }
    assert_ok(ritz_gramians_of_space(&model, &g));
    assert_int_equal(g.T.ncol, 0);
    assert_ok(ritz_gramians_hankel(&g, &count, &sigma));
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        assert_near(sigma[known[k].at], known[k].sigma, 1e-9 * known[k].sigma);
    free(sigma);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_rail_has_its_values),
};

TEST_MODULE(gramians_rail, tests, NULL, NULL)
