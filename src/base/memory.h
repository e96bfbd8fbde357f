/* How much memory the process may hold, and whether something large fits. */
#ifndef RITZ_BASE_MEMORY_H
#define RITZ_BASE_MEMORY_H

#include <ritz/base.h>

#include <stdbool.h>
#include <stdint.h>

/** The limit of ritz_set_memory() in bytes, or what stands in its place. */
int64_t ritz_memory_limit(void);

/**
 * Return to the system the pages that hold only freed memory. free() keeps them,
 * because the system takes time to clear the pages that it gives out. Call this
 * before you allocate a large array that does not fit into freed memory.
 */
void ritz_memory_return(void);

/** Count bytes that are mapped without malloc() as in use; negative: no longer.
 */
void ritz_memory_count_mapped(int64_t bytes);

/** How many bytes more the limit allows; negative if it is exceeded. Freed
 * memory that was not returned counts as in use. */
int64_t ritz_memory_left(void);

/** Whether so many bytes and the memory in use are within the limit, by the rule
 * of ritz_memory_admit(). If they are not, freed memory is returned to the
 * system, and the memory in use is read once more.
 *
 * In use are the pages of the process in memory, those of its program and
 * libraries included, and arrays that were allocated and not yet written. */
bool ritz_memory_fits(int64_t bytes);

/**
 * Refuse what would not fit, before it is allocated.
 *
 * @param[in] what   begins the sentence, "the factor"
 * @param[in] bytes  that will be written; less than 1/64 of the limit is always
 *                   admitted, without a look at what is in use
 * @return RITZ_ERR_MEMORY if these bytes and the memory in use exceed the limit
 */
ritz_status ritz_memory_admit(const char *what, int64_t bytes);

/**
 * The same for an array, which alloc.h calls for each: the sentence names the last
 * step of ritz_monitor_step(). Arrays of less than 1 MiB, or of less
 * than 1/1024 of the limit, are always admitted.
 */
ritz_status ritz_memory_admit_array(int64_t bytes);

/** What the caller of a factor will need later, so that a refusal names what is
 * enough for that, too. */
typedef struct ritz_foresight {
    int64_t beside; /* bytes, while there is a factor */
    int64_t after;  /* bytes in place of it, once it is freed */
} ritz_foresight;

/** Foresee what factors of this thread are followed by. Returns what was
 * foreseen before; pass it back when the factor is made. */
ritz_foresight ritz_memory_foresee(ritz_foresight later);

/**
 * ritz_memory_admit() of a factor and of what is foreseen.
 *
 * @param[in] making  bytes while it is made
 * @param[in] kept    bytes of the factor itself
 */
ritz_status ritz_memory_admit_factor(int64_t making, int64_t kept);

#endif
