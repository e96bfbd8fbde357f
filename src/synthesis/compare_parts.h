/* The steps of COMPARE's second stage. */
#ifndef RITZ_SYNTHESIS_COMPARE_PARTS_H
#define RITZ_SYNTHESIS_COMPARE_PARTS_H

#include <ritz/compare.h>

/**
 * Choose the modes that matter at each listed configuration: those whose value
 * is at least the scene's tolerance times the largest over all configurations.
 * Without inputs and outputs, those in the band.
 *
 * @param[in]     system  stage one, at all listed configurations
 * @param[in,out] row     one for each; num_kept and kept are filled in
 */
ritz_status ritz_compare_select(const ritz_scene *scene,
                                const ritz_system *system,
                                ritz_compare_row *row);

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
