#include "base/crowd.h"
#include "testing.h"

/* How many threads run is not known here, but no machine has a million cores. */
static void a_million_threads_are_too_many_and_none_are_not(void **state)
{
    (void)state;
    assert_true(ritz_cores_crowded(1000000));
    assert_false(ritz_cores_crowded(-1000000));
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_million_threads_are_too_many_and_none_are_not),
};

TEST_MODULE(crowd, tests, NULL, NULL)
