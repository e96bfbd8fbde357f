/* What every test includes: cmocka, and assertions in the terms of numerics. */
#ifndef RITZ_TESTS_TESTING_H
#define RITZ_TESTS_TESTING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/alloc.h"

#include <ritz/status.h>


#include <math.h>
#include <string.h>

/* |actual - expected| <= bound. Say at the call where the bound comes from. */
#define assert_near(actual, expected, bound)                                   \
    do {                                                                       \
        double actual_ = (actual), expected_ = (expected), bound_ = (bound);   \
        if (!(fabs(actual_ - expected_) <= bound_))                            \
            fail_msg("%s = %.17g, not %.17g: off by %.2e, allowed %.2e",       \
                     #actual, actual_, expected_, fabs(actual_ - expected_),   \
                     bound_);                                                  \
    } while (0)

/* The call succeeds; if not, the test fails with the library's own sentence. */
#define assert_ok(call)                                                        \
    do {                                                                       \
        if ((call) != RITZ_OK)                                                 \
            fail_msg("%s: %s", #call, ritz_error_message());                   \
    } while (0)

/* The call fails with this status and a sentence that contains `words`. */
#define assert_fails(call, expected, words)                                    \
    do {                                                                       \
        assert_int_equal(call, expected);                                      \
        assert_non_null(strstr(ritz_error_message(), words));                  \
    } while (0)

/** A pipe that @p text comes out of; @p path names its end, to be closed. */
int testing_pipe(const char *text, char path[static 32]);

/** From here on CHOLMOD allocates through ritz_alloc_budget as well. */
void testing_count_cholmod(void);

/*
 * Let the first, second, third, ... allocation of the call fail, until none
 * does. Run under AddressSanitizer this proves that every error path frees all
 * it owns.
 */
#define assert_survives_every_allocation(call)                                 \
    do {                                                                       \
        ritz_status status_ = RITZ_ERR_MEMORY;                                 \
        testing_count_cholmod();                                               \
        for (int64_t n_ = 0; status_ != RITZ_OK; n_++) {                       \
            ritz_alloc_budget = n_;                                            \
            status_ = (call);                                                  \
            ritz_alloc_budget = -1;                                            \
            assert_true(status_ == RITZ_OK || status_ == RITZ_ERR_MEMORY);     \
            assert_true(n_ < 10000);                                           \
        }                                                                      \
    } while (0)

#endif
