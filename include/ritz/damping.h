/*
 * Damping as scenes and options state it, beside what matrices carry.
 *
 * Text form, one word and numbers: "modal 0.002"; "modes 0.01 0.02" (of the
 * first flexible mode, the second, ...; the last for all above); "bands 0 5
 * 0.002 5 20 0.005" (from Hz, to Hz, ratio; ...); "rayleigh a b" (D = a M +
 * b K); "fit 1 0.01 10 0.02" (Hz, ratio; ...: the a and b that come nearest).
 */
#ifndef RITZ_DAMPING_H
#define RITZ_DAMPING_H

#include <ritz/dense.h>
#include <ritz/text.h>

#include <stdbool.h>

#pragma GCC visibility push(default)

enum {
    RITZ_MAX_BANDS = 8,
    RITZ_MOST_RATIOS = 40,
    RITZ_MOST_POINTS = 20,
    RITZ_DAMPING_SIZE = 1024, /* room for the longest text and its NUL */
};

typedef enum ritz_damping_kind {
    RITZ_DAMPING_NONE,
    RITZ_DAMPING_MODAL,
    RITZ_DAMPING_BANDS,
    RITZ_DAMPING_RAYLEIGH,
    RITZ_DAMPING_MODES,
    RITZ_DAMPING_FIT,
} ritz_damping_kind;

typedef struct ritz_damping {
    ritz_damping_kind kind;
    double zeta;                       /* modal */
    int64_t count;                     /* bands, modes, points of a fit */
    double band[RITZ_MAX_BANDS][3];    /* from Hz, to Hz, zeta */
    double ratio[RITZ_MOST_RATIOS];    /* modes */
    double point[RITZ_MOST_POINTS][2]; /* fit: Hz, zeta */
    double a, b;                       /* rayleigh, and what a fit came to */
} ritz_damping;

/**
 * Whether a damping makes sense: ratios above 0 and below 1; bands that ascend
 * from 0 Hz and do not overlap; a and b not negative nor both 0; two different
 * frequencies at least in a fit.
 *
 * @return RITZ_ERR_ARGUMENT with what is wrong
 */
ritz_status ritz_damping_check(const ritz_damping *damping);

/** @return RITZ_ERR_ARGUMENT with what is wrong; "" is none */
ritz_status ritz_damping_parse(const char *text, ritz_damping *out);

/** The text form of a checked damping, shortest digits that read back the
 * same. */
void ritz_damping_print(const ritz_damping *damping,
                        char text[RITZ_DAMPING_SIZE]);

/**
 * Put a and b of a fit whose points are checked where
 *
 *     sum_k ((a / w_k + b w_k) / 2 - zeta_k)^2
 *
 * is least for a, b >= 0.
 */
void ritz_damping_fit(ritz_damping *damping);

/** Whether it is a M + b K, as stated or as fitted. */
bool ritz_damping_is_rayleigh(const ritz_damping *damping);

/**
 * Largest |ratio of the fit - ratio asked| of its points; 0 of another kind.
 *
 * @param[out] at  index of that point, 0 if there is none
 */
double ritz_damping_misfit(const ritz_damping *damping, int64_t *at);

/**
 * Damping ratio at @p omega rad/s; 0 outside all bands. An edge that two bands
 * share belongs to the upper one. Rayleigh: (a / omega + b omega) / 2 or, where
 * omega is 0 and no ratio stands for a, 0. Of modes: that of all above.
 */
double ritz_damping_ratio(const ritz_damping *damping, double omega);

/** The same of flexible mode @p mode, 0 being the first. */
double ritz_damping_of_mode(const ritz_damping *damping, int64_t mode,
                            double omega);

#pragma GCC visibility pop

#endif
