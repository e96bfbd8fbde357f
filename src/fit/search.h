/* The search of one method, and the list of candidates that it leaves. */
#ifndef RITZ_FIT_SEARCH_H
#define RITZ_FIT_SEARCH_H

#include "fit/fitter.h"

/* A candidate up to this factor larger than the smallest may still win once
   columns are left out. */
#define RITZ_FIT_REACH 1.5

/** Try a candidate, or find it among those that were tried. */
ritz_status ritz_fit_visit(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                           const int64_t *modes, int64_t *at);

/** Whether it was made, and not refused. */
bool ritz_fit_was_made(const ritz_fit_candidate *candidate);

/** One candidate more, moved into the list. */
ritz_status ritz_fit_append(ritz_fit *fit, ritz_fit_candidate *candidate);

/** Whether candidate @p a is a better answer than @p b: smaller, or as small
 * and nearer. */
bool ritz_fit_is_better(const ritz_fit_candidate *a,
                        const ritz_fit_candidate *b);

/** Of a method's candidates of no higher order the largest, the nearest of
 * those; -1: it has none. */
int64_t ritz_fit_largest_of(const ritz_fit *fit, int64_t method, int64_t order);

/** The best and the nearest of a method, of all that were tried. */
void ritz_fit_conclude(ritz_fit *fit, int64_t method);

/** Make COMPARE's first stage rich enough; @p end: what ended that, or none. */
ritz_status ritz_fit_enrich(ritz_fitter *fitter, ritz_fit_end *end);

/** Search one method; @p on: beyond the end of the scene's first ladder, where
 * nothing was met. */
ritz_status ritz_fit_search(ritz_fitter *fitter, ritz_fit *fit, int64_t method,
                            bool on);

#endif
