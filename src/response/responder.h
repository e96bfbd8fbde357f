/* What the engines of responses give, and what all of them share. */
#ifndef RITZ_RESPONSE_RESPONDER_H
#define RITZ_RESPONSE_RESPONDER_H

#include "poles/poles.h"

/*
 * What of a response is rounding. In coordinates that make the diagonal of
 * K + tau M one, tau of the end of the range, which knows no units,
 *
 *     |H_ij| = |c_i'Z^-1 b_j| <= |c_i| |Z^-1| |b_j|,
 *
 * and what solves with Z leave of zero is eps of the right-hand side or more.
 * |Z^-1| is at least the largest |H_ij| / (|c_i| |b_j|) of all channels.
 */

typedef struct ritz_noise {
    int64_t num_outputs, num_inputs;
    double *output; /* 3 x num_outputs: of C, Cv and Ca; NULL: not known */
    double *input;
} ritz_noise;

/**
 * Raise @p level, num_outputs x num_inputs, to |c_i| |Z^-1| |b_j| at a
 * frequency.
 */
void ritz_noise_heed(const ritz_noise *noise, double hertz,
                     const double _Complex *H, double *level);

/**
 * What errors within @p tolerance are measured by: ritz_channel_scales, and
 * more where that is beneath rounding. A channel that is nowhere more than
 * 1e-12 of its level is rounding, and may err by as much as that.
 */
void ritz_noise_scales(int64_t num_outputs, int64_t num_inputs,
                       double tolerance, const double *peak,
                       const double *level, double *scale);

enum { RITZ_REMARK_SIZE = 320 };

struct ritz_responder {
    const ritz_response_engine *engine;
    /* names, and the modes that a grid is refined around: of the state */
    const ritz_poles *poles;
    /* the undamped modes of the component, where there is one */
    const ritz_component *component;
    const ritz_pairs *pairs;
    double from_hz, to_hz;
    ritz_damping given;              /* beside what matrices hold */
    char damping[RITZ_DAMPING_SIZE]; /* the same, or what a model says */
    char remark[RITZ_REMARK_SIZE];
    ritz_noise noise; /* of what engines answer */
    void *state;
    /** H, which is zero before. */
    ritz_status (*at)(void *state, double hertz, double _Complex *H);
    void (*free)(void *state); /* and what it owns */
};

extern const ritz_response_engine ritz_response_engine_direct;
extern const ritz_response_engine ritz_response_engine_krylov;
extern const ritz_response_engine ritz_response_engine_modal;
extern const ritz_response_engine ritz_response_engine_rational;
extern const ritz_response_engine ritz_response_engine_states;

/**
 * By an engine; where that does not converge on a component by direct, and the
 * remark says why.
 */
ritz_status ritz_responder_or_direct(const ritz_response_engine *engine,
                                     const ritz_response_request *request,
                                     ritz_responder **out);

/** The highest mode that a request wants of a component, Hz. */
double ritz_response_highest(const ritz_response_request *request);

/** The highest frequency of a grid, Hz, whatever it is made of. */
double ritz_grid_end(const ritz_grid *grid);

/** Make an engine ready and respond on a grid. */
ritz_status ritz_response_once(const ritz_response_engine *engine,
                               ritz_response_request *request,
                               const ritz_grid *grid, ritz_response *out);

/**
 * Damped poles: roots of s^2 + rate s + lambda of modes that nothing couples,
 * and that any channel shows; else of the full matrices, if there is a
 * component with its modes, to half as far again as the range; else of the
 * modal ones. Of a pair the one above the axis; 0 twice for each rigid motion
 * that nothing holds back.
 */
ritz_status ritz_responder_poles(const ritz_responder *responder,
                                 int64_t *count, double _Complex **out);

/**
 * What an error of each channel is measured by: the largest |H| of the channel,
 * but at least a billionth of the geometric mean of the largest in its row and
 * in its column, below which a channel is rounding.
 *
 * @param[in]  peak   num_outputs x num_inputs, largest |H| of each channel
 * @param[out] scale  the same; may be @p peak
 */
void ritz_channel_scales(int64_t num_outputs, int64_t num_inputs,
                         const double *peak, double *scale);

#endif
