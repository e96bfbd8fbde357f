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

/** Whether so many bytes and the memory in use are within the limit, by the rule
 * of ritz_memory_admit(). If they are not, freed memory is returned to the
 * system, and the memory in use is read once more. */
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

#endif
