/* Arrays that change their length. */
#include "testing.h"

#include "base/alloc.h"

#include <stdint.h>

/* From a few items to more than a page, so that the array moves. */
static void a_lengthened_array_keeps_its_values(void **state)
{
    RITZ_OWN_ARRAY double *x = NULL;

    (void)state;
    assert_ok(ritz_array_lengthen(&x, 2, sizeof *x));
    x[0] = 1.5;
    x[1] = -2.5;
    for (int64_t count = 3; count < 1 << 20; count *= 7) {
        assert_ok(ritz_array_lengthen(&x, count, sizeof *x));
        x[count - 1] = (double)count;
        assert_near(x[0], 1.5, 0.0);
        assert_near(x[1], -2.5, 0.0);
        assert_near(x[count - 1], (double)count, 0.0);
    }
}

static void an_impossible_length_is_refused(void **state)
{
    RITZ_OWN_ARRAY double *x = NULL;

    (void)state;
    assert_ok(ritz_array_lengthen(&x, 1, sizeof *x));
    x[0] = 4.0;
    assert_fails(ritz_array_lengthen(&x, INT64_MAX, sizeof *x), RITZ_ERR_MEMORY,
                 "cannot allocate 9223372036854775807 items of 8 bytes");
    assert_fails(ritz_array_lengthen(&x, 0, sizeof *x), RITZ_ERR_MEMORY,
                 "cannot allocate 0 items");
    assert_near(x[0], 4.0, 0.0); /* as it was */
}

static ritz_status lengthen_twice(void)
{
    RITZ_OWN_ARRAY double *x = NULL;

    RITZ_CHECK(ritz_array_lengthen(&x, 8, sizeof *x));
    x[7] = 1.0;
    return ritz_array_lengthen(&x, 16, sizeof *x);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    assert_survives_every_allocation(lengthen_twice());
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_lengthened_array_keeps_its_values),
    cmocka_unit_test(an_impossible_length_is_refused),
    cmocka_unit_test(every_allocation_may_fail),
};

TEST_MODULE(alloc, tests, NULL, NULL)
