/* Scenes that are fitted, their models in the test's folder. */
#ifndef RITZ_TESTS_FIT_SCENES_H
#define RITZ_TESTS_FIT_SCENES_H

#include <ritz/fit.h>

/** A tolerance, and little of what costs time and decides nothing. */
ritz_fit_request fit_scenes_quick(const char *tolerance);

/** The same by @p count methods, borrowed. */
ritz_fit_request fit_scenes_by(const ritz_method *const *methods, int64_t count,
                               const char *tolerance);

/** left.h5 and right.h5: a clamped beam of `left` elements, and one of `right`
 * that begins where it ends; ports 'joint', and 'tip' of the right one. */
void fit_scenes_store_beams(int64_t left, int64_t right);

/** A damper from the end of the left beam to the ground. */
void fit_scenes_damp_left(void);

/** The two fixed to each other, driven and seen across at the tip. */
extern const char fit_scenes_beams[];

/** Driven where they are joined, seen at the tip in two directions. */
extern const char fit_scenes_driven[];

/** rotor.h5, stator.h5 and platform.h5 of the dual-spin spacecraft. */
void fit_scenes_store_spacecraft(void);

/** The spacecraft at two angles, rotor and stator flexible. */
extern const char fit_scenes_spacecraft[];

#endif
