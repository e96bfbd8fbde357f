/* The steps of COMPARE's second stage. */
#ifndef RITZ_SYNTHESIS_COMPARE_PARTS_H
#define RITZ_SYNTHESIS_COMPARE_PARTS_H

#include <ritz/compare.h>

/**
 * The least value of a mode that matters: the scene's tolerance times the
 * largest over all listed configurations. Without inputs and outputs modes
 * matter by the band, and this is not used.
 *
 * @param[in] system  stage one, at all listed configurations
 */
ritz_status ritz_compare_threshold(const ritz_scene *scene,
                                   const ritz_system *system, double *least);

/** Choose the modes of one configuration that matter: num_kept and kept. */
ritz_status ritz_compare_select(const ritz_scene *scene,
                                const ritz_configuration *configuration,
                                double least, ritz_compare_row *row);

/**
 * The composite mode set on each body: kept modes and, if the scene asks,
 * static corrections of all configurations that count; dependent columns
 * removed by SVD in the M inner product.
 *
 * @param[out] V      stage->count matrices, r_c x s_c, M-orthonormal; the
 *                    identity where s_c would be r_c
 * @param[out] count  vectors before dependent ones were removed
 */
ritz_status ritz_compare_composite(const ritz_stage *stage,
                                   const ritz_system *system,
                                   const ritz_compare_row *row, ritz_dense *V,
                                   int64_t *count);

/**
 * Hold the second system against the first at one configuration.
 *
 * @param[in]     V    of every body
 * @param[in,out] row  kept modes if listed; errors are filled in
 */
ritz_status ritz_compare_measure(const ritz_stage *stage, const ritz_dense *V,
                                 const ritz_configuration *first,
                                 const ritz_configuration *second,
                                 ritz_compare_row *row);

#endif
