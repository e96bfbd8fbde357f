/* Products of vectors with three components. */
#include "testing.h"

#include "base/vector.h"

static void a_cross_product_follows_the_right_hand(void **state)
{
    static const double e[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

    (void)state;
    for (int i = 0; i < 3; i++) {
        double out[3];

        ritz_cross(e[i], e[(i + 1) % 3], out);
        for (int k = 0; k < 3; k++)
            assert_true(out[k] == e[(i + 2) % 3][k]);
    }
}

static void products_have_these_values(void **state)
{
    static const double a[3] = {1, 2, 3}, b[3] = {4, -5, 6};
    double out[3];

    (void)state;
    assert_true(ritz_dot(a, b) == 12.0);
    ritz_cross(a, b, out);
    assert_true(out[0] == 27.0 && out[1] == 6.0 && out[2] == -13.0);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_cross_product_follows_the_right_hand),
    cmocka_unit_test(products_have_these_values),
};

TEST_MODULE(vector, tests, NULL, NULL)
