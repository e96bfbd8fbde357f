/*
 * A full model made ready once, to be compared with many reductions of it: its
 * modes to three times the band, what lies above them as static answer, and its
 * responses at every frequency where they are compared.
 */
#ifndef RITZ_REFERENCE_H
#define RITZ_REFERENCE_H

#include <ritz/verify.h>

#pragma GCC visibility push(default)

typedef struct ritz_reference ritz_reference;

typedef struct ritz_reference_request {
    double band_hz[2];    /* not [0, 0] */
    ritz_damping damping; /* none: as the model says, or else modal 0.01 */
    int64_t num_random;   /* further frequencies, anywhere in the band */
    uint64_t seed;        /* of those; one seed always gives the same */
} ritz_reference_request;

/* Where responses are compared, beside an even grid and the full model's own
   poles. */
enum {
    RITZ_AT_OTHER_POLES = 1, /* those of the reduced model */
    RITZ_AT_RANDOM = 2,      /* the random frequencies */
};

/**
 * @param[in] full     borrowed until free; dampers count as far as K and D hold
 *                     them
 * @param[in] request  copied
 * @return RITZ_ERR_ARGUMENT if the band is none
 * @cost   the modes to three times the band; a factor a frequency where dampers
 *         couple modes of a model that is not small
 */
ritz_status ritz_reference_new(const ritz_component *full,
                               const ritz_reference_request *request,
                               ritz_reference **out);

/**
 * What ritz_verify_reduced measures.
 *
 * @param[in] limits  its limits alone are used
 * @param[in] where   sum of RITZ_AT_...
 */
ritz_status ritz_reference_measure(const ritz_reference *reference,
                                   const ritz_reduced *reduced,
                                   const ritz_verify_request *limits, int where,
                                   ritz_measures *out);

/** What ritz_verify_system measures. */
ritz_status ritz_reference_measure_at(const ritz_reference *reference,
                                      const ritz_configuration *reduced,
                                      const ritz_verify_request *limits,
                                      int where, ritz_measures *out);

/** Flexible modes of the full model in the band; rigid ones beside them. */
int64_t ritz_reference_modes(const ritz_reference *reference, int64_t *rigid);

/**
 * Whether each frequency takes a factor of the full model: dampers couple modes
 * and not all of them are known.
 */
bool ritz_reference_factors(const ritz_reference *reference);

void ritz_reference_free(ritz_reference **reference);

/**
 * @p count frequencies of a band, ascending and distinct, the same for one seed.
 */
void ritz_random_hertz(uint64_t seed, const double band_hz[2], int64_t count,
                       double *out);

/** The next number of a sequence, in [0, 1) [Steele2014]. */
double ritz_random_next(uint64_t *state);

#pragma GCC visibility pop

#endif
