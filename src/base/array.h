/* Arrays that grow item by item. */
#ifndef RITZ_BASE_ARRAY_H
#define RITZ_BASE_ARRAY_H

#include <ritz/base.h>

#include <stddef.h>
#include <stdint.h>

/**
 * An array that has room for one more item: itself, or a larger copy in its
 * place, which is then freed; NULL if there is no memory for it.
 */
void *ritz_array_grown(void *array, int64_t count, int64_t *room, size_t size);

/* Make sure of room for one more item. */
#define RITZ_ROOM(array, count, room)                                          \
    do {                                                                       \
        void *grown_ =                                                         \
            ritz_array_grown((array), (count), &(room), sizeof *(array));      \
        if (!grown_) {                                                         \
            status = RITZ_ERR_MEMORY;                                          \
            goto done;                                                         \
        }                                                                      \
        (array) = grown_;                                                      \
    } while (0)

/* RITZ_ROOM for a function that owns nothing: it returns at once. */
#define RITZ_CHECK_ROOM(array, count, room)                                    \
    do {                                                                       \
        void *grown_ =                                                         \
            ritz_array_grown((array), (count), &(room), sizeof *(array));      \
        if (!grown_)                                                           \
            return RITZ_ERR_MEMORY;                                            \
        (array) = grown_;                                                      \
    } while (0)

#endif
