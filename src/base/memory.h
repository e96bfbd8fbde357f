/* How much memory the process may hold, and whether something large fits. */
#ifndef RITZ_BASE_MEMORY_H
#define RITZ_BASE_MEMORY_H

#include <ritz/base.h>

#include <stdbool.h>
#include <stdint.h>

/** The limit of ritz_set_memory() in bytes, or what stands in its place. */
int64_t ritz_memory_limit(void);

/**
 * Return pages to the system in which all memory was freed. free() keeps them,
 * because the system takes time to clear pages that it gives out; call this
 * before a large array that will not fit into them.
 */
void ritz_memory_return(void);

/** Whether these bytes fit beside the memory in use, as ritz_memory_admit()
 * judges it. If they do not, memory that was freed is returned first. */
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
