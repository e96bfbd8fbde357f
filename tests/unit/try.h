/* What a test or fixture that fails goes through to its `done:` label, with a
 * local `status`. */
#ifndef RITZ_TESTS_TRY_H
#define RITZ_TESTS_TRY_H

#include "base/alloc.h"

#define RITZ_TRY(call)                                                         \
    do {                                                                       \
        status = (call);                                                       \
        if (status != RITZ_OK)                                                 \
            goto done;                                                         \
    } while (0)

#define RITZ_FAIL_IF(condition, code, ...)                                     \
    do {                                                                       \
        if (condition) {                                                       \
            status = ritz_fail((code), __VA_ARGS__);                           \
            goto done;                                                         \
        }                                                                      \
    } while (0)

#define RITZ_NEW(pointer, count)                                               \
    do {                                                                       \
        (pointer) = ritz_zalloc((count), sizeof *(pointer));                   \
        if (!(pointer)) {                                                      \
            status = RITZ_ERR_MEMORY;                                          \
            goto done;                                                         \
        }                                                                      \
    } while (0)

#endif
