/*
 * What estimates are made of, all with A = K - sigma M, sigma < 0, and
 *
 *     S = A^-1/2 M A^-1/2,   kappa = 1 / (lambda - sigma)
 *
 * its eigenvalues: 0 where there is no mass.
 */
#ifndef RITZ_ESTIMATE_ESTIMATOR_H
#define RITZ_ESTIMATE_ESTIMATOR_H

#include <ritz/eigen.h>
#include <ritz/estimate.h>
#include <ritz/factor.h>

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
    ritz_factor *A; /* of K - sigma M; NULL: not made yet */
    int64_t num_counts;
    ritz_counted count[RITZ_MOST_COUNTS]; /* rho ascends */
};

/*
 * The lowest Ritz pairs in the range of a basis, anew from the full matrices,
 * and how the full model resists them: R = K X - M X Theta.
 */
typedef struct ritz_lehmann {
    int64_t count;    /* m */
    ritz_dense X;     /* n x m, X'MX = I, X'KX = Theta */
    double *theta;    /* m, ascending */
    double *rounding; /* m, of theta, absolute: eps |x|'|K||x| and more */
    double *reduced; /* m, of the reduced model's: eps |q|'|K_r||q| and so on */
    double *inertia; /* m, of x'Mx = 1 in both: |q|'|M_r||q| and so on */
    double *least, *most; /* m, its eigenvalues, which rounding may exchange */
    ritz_dense R, E;      /* n x m; E = A^-1 R */
    ritz_dense G;         /* m x m, R'A^-1 R */
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

/**
 * Pairs of the space that the first @p count of @p pairs, those of @p reduced,
 * span through @p T.
 */
ritz_status ritz_lehmann_new(ritz_estimator *estimator, const ritz_dense *T,
                             const ritz_reduced *reduced,
                             const ritz_pairs *pairs, int64_t count,
                             ritz_lehmann *out);

/** The same of A^-1 M X: one inverse iteration on, @p trial's errors shrink. */
ritz_status ritz_lehmann_polish(ritz_estimator *estimator,
                                const ritz_lehmann *trial, ritz_lehmann *out);
void ritz_lehmann_free(ritz_lehmann *trial);

/* Enclosures of the full model's lowest eigenvalues, and of trial modes. */
typedef struct ritz_enclosure {
    int64_t count; /* of full modes */
    double *low;   /* count, ascending; 0 if nothing is known */
    double *high;  /* count, ascending; HUGE_VAL if nothing is known */
    int64_t num_near;
    double *near_low, *near_high; /* num_near, each holds some full mode */
} ritz_enclosure;

/* What verify would find of full modes in the band; see estimate_judge.c. */
typedef struct ritz_matched {
    bool known;      /* there are no more than `full` up to its end */
    bool any;        /* some may be in it */
    bool astride;    /* of some it is not known whether they are */
    bool slow;       /* or whether they are rigid */
    bool open;       /* the bound may be far above the error */
    bool unsettled;  /* some mode's partner is not known */
    double rho;      /* where a count may help; NaN: nowhere */
    int64_t full;    /* so many full modes may lie below its end */
    int64_t missing; /* so many of the band are not proven to have partners */
    int64_t first;   /* of these; -1: none */
    double bound;    /* worst |f_r - f| / f; below 0: none has a partner */
    int64_t mode, number; /* reduced and full mode where it is */
    double least;         /* what that is at least */
    int64_t least_mode, least_number;
} ritz_matched;

/* One reduction at work. */
typedef struct ritz_measuring {
    ritz_pairs pairs; /* of the reduced model, as it is */
    double band_hz[2];
    const ritz_dense *T; /* borrowed */
    int64_t first, last; /* its flexible modes in the band: first .. last - 1 */
    int64_t reach; /* last, or further: numbers of full modes in the band */
    ritz_lehmann trial, polished;
    ritz_enclosure enclosure;
    ritz_matched matched;
} ritz_measuring;

/**
 * From the trial, that after an inverse iteration, {0} if there is none, and
 * all that was counted, by Lehmann's method.
 */
ritz_status ritz_enclosure_new(const ritz_estimator *estimator,
                               const ritz_lehmann *trial,
                               const ritz_lehmann *polished,
                               ritz_enclosure *out);
void ritz_enclosure_free(ritz_enclosure *enclosure);

/* How far a reduced mode can be off, and which mode of the full model it is. */
typedef struct ritz_claim {
    double bound;   /* |f_k - f| / f, f of that full mode */
    double least;   /* what it is about at least */
    int64_t number; /* of the full mode, from 0; -1: some mode is so near */
} ritz_claim;

/** Of mode @p k, whose eigenvalue in the reduced model is @p theta. */
ritz_claim ritz_claim_of(const ritz_lehmann *trial,
                         const ritz_enclosure *enclosure, int64_t k,
                         double theta);

/** How far mode @p k can be from the full one of its number. */
double ritz_claim_same(const ritz_lehmann *trial,
                       const ritz_enclosure *enclosure, int64_t k,
                       double theta);

/**
 * Whether mode @p k, so slow beside the band, is a rigid motion that the basis
 * holds badly: the full model's is below half of it.
 */
bool ritz_counted_rigid(const ritz_estimator *estimator, int64_t k,
                        double theta, double band);

/** Whether more than @p k full modes were counted at or below @p rho. */
bool ritz_counted_more(const ritz_estimator *estimator, int64_t k, double rho);

/* Modes first .. last - 1, and how many counts were taken for each. */
typedef struct ritz_pursuit {
    int64_t first, last;
    int64_t *tries;
} ritz_pursuit;

/**
 * Where to count next, so that these modes are told better.
 *
 * @param[out] mode  for which; -1: for all
 * @return NaN: nowhere
 */
double ritz_propose_count(const ritz_estimator *estimator,
                          const ritz_lehmann *trial,
                          const ritz_enclosure *enclosure,
                          const ritz_pursuit *pursuit, int64_t *mode);

/** Where to count far above a band that ends at @p band; NaN: nowhere. */
double ritz_propose_above(const ritz_estimator *estimator,
                          const ritz_lehmann *trial, double band);

/** What verify would find of the band, as far as enclosures tell it. */
ritz_status ritz_measuring_judge(const ritz_estimator *estimator,
                                 const ritz_measuring *m, ritz_matched *out);

/**
 * Full modes less reduced ones below the end of the band, or below a count
 * above it: a mode just within the band may have its partner just outside. -1
 * if nothing was counted there.
 *
 * @param[out] at  rho of that count
 */
int64_t ritz_missing_modes(const ritz_estimator *estimator,
                           const ritz_measuring *m, double *at);

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
ritz_status ritz_bound_response(ritz_estimator *estimator,
                                const ritz_measuring *measuring,
                                const ritz_reduced *reduced,
                                ritz_measures *out);

#endif
