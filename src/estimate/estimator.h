/*
 * Enclosures of a full model's eigenvalues by Lehmann's method, from Ritz pairs
 * and counts of modes. Throughout, A = K - sigma M with sigma < 0, and
 *
 *     S = A^-1/2 M A^-1/2
 *
 * has the eigenvalues kappa = 1 / (lambda - sigma), 0 for massless motions.
 */
#ifndef RITZ_ESTIMATE_ESTIMATOR_H
#define RITZ_ESTIMATE_ESTIMATOR_H

#include <ritz/matrix.h>
#include <ritz/verify.h>

#include <stdbool.h>

enum { RITZ_MOST_COUNTS = 64 };

/* Exactly `below` eigenvalues of the full model lie below rho. */
typedef struct ritz_counted {
    double rho;
    int64_t below;
} ritz_counted;

struct ritz_estimator {
    const ritz_component *component; /* borrowed */
    ritz_estimate_request request;
    double sigma;
    ritz_factor *A; /* factor of K - sigma M; NULL: not made yet */
    int64_t num_counts;
    ritz_counted count[RITZ_MOST_COUNTS]; /* rho ascends */
};

/*
 * The trial space: the lowest Ritz pairs in the range of a basis, computed anew
 * from the full matrices, and their residuals.
 */
typedef struct ritz_lehmann {
    int64_t count;    /* m */
    ritz_dense X;     /* n x m, X'MX = I, X'KX = Theta */
    double *theta;    /* m, ascending */
    double *rounding; /* m, absolute error of theta: eps |x|'|K||x| and more */
    double *reduced_rounding; /* m, of the reduced model's eigenvalues */
    double *mass_terms; /* m, |x|'|M||x| + |q|'|M_r||q|: sums behind x'Mx = 1 */
    /* m, ends of what the reduced model's eigenvalue can be; where rounding may
       exchange modes they share one interval */
    double *reduced_low, *reduced_high;
    ritz_dense R; /* n x m, residuals K X - M X Theta */
    ritz_dense E; /* n x m, A^-1 R */
    ritz_dense G; /* m x m, R'A^-1 R */
    double sigma;
} ritz_lehmann;

/** Factor K - sigma M if it is not yet; |sigma| grows if it must. */
ritz_status ritz_estimator_open(ritz_estimator *estimator, double sigma);

/**
 * Count the modes below about @p rho; it moves off a mode.
 *
 * @return RITZ_ERR_ARGUMENT if there is no room for one more
 */
ritz_status ritz_estimator_count(ritz_estimator *estimator, double rho);

/** Pairs of the space that the first @p count modes of @p reduced span. */
ritz_status ritz_lehmann_new(ritz_estimator *estimator, const ritz_dense *T,
                             const ritz_reduced *reduced,
                             const ritz_pairs *pairs, int64_t count,
                             ritz_lehmann *out);

/** The same of A^-1 M X: one inverse iteration on, @p trial's errors shrink. */
ritz_status ritz_lehmann_polish(ritz_estimator *estimator,
                                const ritz_lehmann *trial, ritz_lehmann *out);
void ritz_lehmann_free(ritz_lehmann *trial);

/** How many of some ascending eigenvalues are below @p rho. */
int64_t ritz_count_below(int64_t count, const double *lambda, double rho);

/* Intervals that hold the full model's lowest eigenvalues. */
typedef struct ritz_enclosure {
    int64_t count;    /* full modes, by their number */
    double *low;      /* count, ascending; 0 if nothing is known */
    double *high;     /* count, ascending; HUGE_VAL if nothing is known */
    int64_t num_near; /* intervals around trial modes, each of which */
    double *near_low, *near_high; /* holds a full mode of unknown number */
} ritz_enclosure;

/* A relative error of a frequency, and of which reduced and full mode. */
typedef struct ritz_pair_error {
    double value;
    int64_t mode, full_mode;
} ritz_pair_error;

/* What ritz-verify would find of the full modes in the band. */
typedef struct ritz_prediction {
    bool counted;        /* at most num_full modes lie below the band's end */
    bool any_in_band;    /* some full mode may be in the band */
    bool edge_unclear;   /* an interval reaches across the band's end */
    bool rigid_unclear;  /* the first flexible mode may be a rigid one */
    bool loose;          /* the bound may be far above the error */
    bool unmatched;      /* it is not known which mode is some mode's partner */
    double count_at;     /* where a count may help; NaN: nowhere */
    int64_t num_full;    /* full modes that may lie below the band's end */
    int64_t num_missing; /* those in the band without a proven partner */
    int64_t first_missing; /* -1: there is none */
    /* the worst |f_r - f| / f is at most, and at least, this; bound below 0: no
       mode has a partner */
    ritz_pair_error bound, least;
} ritz_prediction;

/* One reduced model while it is estimated. */
typedef struct ritz_measuring {
    ritz_estimator *estimator; /* borrowed */
    ritz_pairs pairs;          /* of the reduced matrices as they are */
    double band_hz[2];
    const ritz_dense *T; /* borrowed */
    int64_t first, last; /* its flexible modes in the band: first .. last - 1 */
    int64_t reach;       /* at least last: modes that counts are spent on */
    ritz_lehmann trial, polished; /* polished: after an inverse iteration */
    ritz_enclosure enclosure;
    ritz_prediction prediction;
} ritz_measuring;

/** Enclose by Lehmann's method, with every count that was taken. */
ritz_status ritz_enclosure_new(const ritz_measuring *m, ritz_enclosure *out);
void ritz_enclosure_free(ritz_enclosure *enclosure);

/* How far a reduced mode can be from a full one, and from which. */
typedef struct ritz_claim {
    double bound;      /* |f_k - f| / f is at most this */
    double least;      /* and about this at least */
    int64_t full_mode; /* number from 0; -1: near one of unknown number */
} ritz_claim;

/** |f_k - f| / f at most, and at least, of a full mode in [low, high]. */
double ritz_error_most(const ritz_measuring *m, int64_t k, double low,
                       double high);
double ritz_error_least(const ritz_measuring *m, int64_t k, double low,
                        double high);

/** The claim on reduced mode @p k that has the least bound. */
ritz_claim ritz_claim_of(const ritz_measuring *m, int64_t k);

/** Bound of |f_k - f| / f for the full mode of the same number. */
double ritz_claim_same(const ritz_measuring *m, int64_t k);

/**
 * Whether reduced mode @p k, with eigenvalue @p theta, is a rigid motion that
 * the basis represents badly: it is far below the band, and a count shows the
 * full mode of its number below half its eigenvalue.
 */
bool ritz_counted_rigid(const ritz_estimator *estimator, int64_t k,
                        double theta, double band);

/** Whether more than @p k full modes were counted at or below @p rho. */
bool ritz_counted_more(const ritz_estimator *estimator, int64_t k, double rho);

/** Whether modes were counted at some frequency inside (low, high). */
bool ritz_counted_within(const ritz_estimator *estimator, double low,
                         double high);

/**
 * Where a count would tighten the enclosures of modes first .. reach - 1 most.
 *
 * @param[in]  tries  counts that each of them has had
 * @param[out] mode   the mode that it is for; -1: all of them
 * @return NaN if no count helps
 */
double ritz_propose_count(const ritz_measuring *m, const int64_t *tries,
                          int64_t *mode);

/** A gap to count in, far above the band; NaN: none. */
double ritz_propose_above(const ritz_measuring *m);

/** Predict what ritz-verify finds of the band, as far as enclosures tell. */
ritz_status ritz_measuring_predict(const ritz_measuring *m,
                                   ritz_prediction *out);

/**
 * Fewest full modes less reduced ones below any count at or above the band's
 * end: a mode just within the band may have its partner just outside. -1 if
 * nothing was counted there.
 */
int64_t ritz_missing_modes(const ritz_measuring *m);

/**
 * Whether anything can be said of a reduced response: there are inputs, outputs
 * and damping, and of the reduced model's modes, @p modes, none is massless.
 */
bool ritz_response_boundable(const ritz_estimator *estimator,
                             const ritz_reduced *reduced, int64_t modes);

/**
 * Add "response-relative-bound" or, where modes are damped by no common ratio
 * and by no a M + b K, "response-relative-estimate". The trial holds all modes.
 */
ritz_status ritz_bound_response(const ritz_measuring *m,
                                const ritz_reduced *reduced,
                                ritz_measures *out);

#endif
