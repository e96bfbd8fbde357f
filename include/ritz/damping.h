/*
 * Damping as scenes and options state it, beside what matrices carry.
 *
 * Text form, one word and numbers: "modal 0.002"; "bands 0 5 0.002 5 20 0.005"
 * (from Hz, to Hz, ratio; ...); "rayleigh a b" (D = a M + b K).
 */
#ifndef RITZ_DAMPING_H
#define RITZ_DAMPING_H

#include <ritz/dense.h>
#include <ritz/text.h>

enum { RITZ_MAX_BANDS = 8 };

typedef enum ritz_damping_kind {
    RITZ_DAMPING_NONE,
    RITZ_DAMPING_MODAL,
    RITZ_DAMPING_BANDS,
    RITZ_DAMPING_RAYLEIGH,
} ritz_damping_kind;

typedef struct ritz_damping {
    ritz_damping_kind kind;
    double zeta;                    /* modal */
    int64_t count;                  /* bands */
    double band[RITZ_MAX_BANDS][3]; /* from Hz, to Hz, zeta */
    double a, b;                    /* rayleigh */
} ritz_damping;

/**
 * Whether a damping makes sense: ratios above 0 and below 1; bands that ascend
 * from 0 Hz and do not overlap; a and b not negative nor both 0; a text form
 * that fits RITZ_NAME_SIZE, as files keep it so.
 *
 * @return RITZ_ERR_ARGUMENT with what is wrong
 */
ritz_status ritz_damping_check(const ritz_damping *damping);

/** @return RITZ_ERR_ARGUMENT with what is wrong; "" is none */
ritz_status ritz_damping_parse(const char *text, ritz_damping *out);

/** The text form of a checked damping, shortest digits that read back the
 * same. */
void ritz_damping_print(const ritz_damping *damping, char text[RITZ_NAME_SIZE]);

/**
 * Damping ratio of a mode at @p omega rad/s; 0 outside all bands. An edge that
 * two bands share belongs to the upper one. Rayleigh: (a / omega + b omega) / 2
 * or, where omega is 0 and no ratio stands for a, 0.
 */
double ritz_damping_ratio(const ritz_damping *damping, double omega);

#endif
