/* Full against reduced: every error measure, never one alone. */
#ifndef RITZ_VERIFY_H
#define RITZ_VERIFY_H

#include <ritz/measures.h>
#include <ritz/reduced.h>
#include <ritz/response.h>
#include <ritz/state_space.h>
#include <ritz/system.h>

#pragma GCC visibility push(default)

/* What is compared, and what it is held to. */
typedef struct ritz_verify_request {
    double band_hz[2];           /* [0, 0]: up to half the highest frequency of
                                    the basis, or of the reduced model */
    ritz_damping damping;        /* of the responses */
    double limit[RITZ_MEASURES]; /* by ritz_measure_id; NaN: only measured.
                                    Missing modes are held to 0 where frequency
                                    or damping has a limit */
} ritz_verify_request;

#define RITZ_NO_LIMIT(name) (double)NAN,
#define RITZ_VERIFY_NONE                                                       \
    {                                                                          \
        .limit = { RITZ_EACH_MEASURE(RITZ_NO_LIMIT) }                          \
    }

/**
 * A full component and its reduction. Dampers count as far as K and D hold
 * them: install them first.
 *
 * @return RITZ_ERR_ARGUMENT if the reduction is of another model, or a response
 *         or gain has a limit and there are no inputs or no outputs
 */
ritz_status ritz_verify_reduced(const ritz_component *full,
                                const ritz_reduced *reduced,
                                const ritz_verify_request *request,
                                ritz_measures *out);

/**
 * A full-order assembled system and one reduced configuration: the same
 * measures, but MAC, which needs shapes, is of what inputs drive and outputs
 * see, of the modes that are seen at all: see docs/methods/verify.md.
 */
ritz_status ritz_verify_system(const ritz_component *full,
                               const ritz_configuration *reduced,
                               const ritz_verify_request *request,
                               ritz_measures *out);

/**
 * Two models in first-order form, of the same inputs and outputs; outputs that
 * have a limit in @p full are divided by it.
 *
 *     h-infinity, h-infinity-relative, h2-relative
 *                            norms of the difference, and over those of the full
 *                            model. Poles that are not left of the axis, if both
 *                            have as many, are left out of all of them
 *     h-infinity-bound       the first again, held to the bound that the
 *                            reduced model has as estimate
 *     response-relative      largest |H - H_r| / max |H|, if a band is given
 *     static-gain-relative   of D - C A^-1 B, if neither has a pole at 0
 *     growth-relative        of the reduced model: see ritz_probe_record
 *
 * @return RITZ_ERR_ARGUMENT if names differ, or a limit is set for a measure
 *         that does not exist
 * @cost   O(n^3), some fifty times
 */
ritz_status ritz_verify_states(const ritz_state_space *full,
                               const ritz_state_space *reduced,
                               const ritz_verify_request *request,
                               ritz_measures *out);

/**
 * Take "frequency=1e-3,mac=0.99,gain=1e-6": words of measures and their
 * tolerances; a number alone is of the response. Others stay as they are.
 *
 * @return RITZ_ERR_ARGUMENT for a word that names no measure of second-order
 *         models, naming the nearest, for one that is given twice, or for a
 *         tolerance that can be none
 */
ritz_status ritz_tolerance_take(const char *text, ritz_verify_request *limits);

/** Its text form: "response=0.01". Cut to fit. */
void ritz_tolerance_print(const ritz_verify_request *limits, int64_t size,
                          char *out);

/** All words that ritz_tolerance_take knows: "frequency, mac". Cut to fit. */
void ritz_tolerance_words(int64_t size, char *out);

/** Word of a measure: "response" of "response-relative"; its own name if it has
 * none. */
const char *ritz_tolerance_word(const char *measure);

/**
 * Flexible static gain C Phi_f Lambda_f^-1 Phi_f' B of a dense model.
 *
 * @param[in] num_rigid  of the model this one stands for, 0: not known. As many
 *                       of the lowest modes are left out at least: a reduction
 *                       that holds a rigid motion badly has it at some
 *                       frequency, and no compliance by that
 */
ritz_status ritz_static_gain(const ritz_dense *K, const ritz_dense *M,
                             const ritz_io *io, int64_t num_rigid,
                             ritz_dense *out);

/**
 * |G - G_r| / |G| of two static gains of one size, largest singular values; NaN
 * where G is nothing but rounding beside the difference.
 */
ritz_status ritz_gain_error(const ritz_dense *full, const ritz_dense *reduced,
                            double *out);

#pragma GCC visibility pop

#endif
