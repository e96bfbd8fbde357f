/*
 * Craig-Bampton and normal modes by all ranks: rank 0 asks, and gets the basis;
 * the others wait for what they are to do.
 */
#ifndef RITZ_LIBEXEC_SLEPC_FIXED_H
#define RITZ_LIBEXEC_SLEPC_FIXED_H

#include <ritz/basis.h>

/**
 * Rank 0: the basis of a component whose matrices are in a file, and which has
 * none in memory.
 *
 * @param[in] held  attached dofs have constraint modes; false: normal modes
 * @return as the methods of one process, or as rows_read
 */
ritz_status fixed_make(const char *path, const ritz_request *request, bool held,
                       ritz_basis *out);

/** Other ranks: help until rank 0 dismisses them. */
void fixed_help(void);

/** Rank 0: the others need not wait any longer. */
void fixed_dismiss(void);

/** Whether the others wait for rank 0, rather than work with it. */
bool fixed_is_idle(void);

#endif
