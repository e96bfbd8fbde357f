/*
 * Bases of Craig-Bampton and of normal modes, computed by all ranks: rank 0
 * calls fixed_make() and gets the basis, the others are in fixed_help()
 * meanwhile.
 */
#ifndef RITZ_LIBEXEC_SLEPC_FIXED_H
#define RITZ_LIBEXEC_SLEPC_FIXED_H

#include <ritz/basis.h>

/**
 * To be called in rank 0: compute the basis of a component whose matrices are
 * in its file only, not in memory.
 *
 * @param[in] path   of the component's file, readable by all ranks
 * @param[in] held   true: Craig-Bampton, with the attached dofs held; false:
 *                   normal modes of the free component
 * @param[in] loads  sum of RITZ_LOADS_..., for which static vectors of the held
 *                   component are made
 * @return as the methods of one process, or as rows_read()
 */
ritz_status fixed_make(const char *path, const ritz_request *request, bool held,
                       int loads, ritz_basis *out);

/** To be called in all other ranks: take part in each fixed_make() of rank 0,
 * until it calls fixed_dismiss(). */
void fixed_help(void);

/** To be called in rank 0: let fixed_help() return in the other ranks. */
void fixed_dismiss(void);

/** In rank 0: whether no fixed_make() is under way, so that the other ranks
 * wait for a task. */
bool fixed_is_idle(void);

#endif
