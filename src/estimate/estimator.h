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

#include "linear/inertia.h"
#include "poles/poles.h"

#include <ritz/verify.h>

#include <complex.h>

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
    ritz_factor *A;        /* factor of K - sigma M; NULL: not made yet */
    ritz_counter *counter; /* NULL: no count was made yet */
    ritz_counted early;    /* counted while A was factored; rho 0: nothing */
    int64_t num_factors;   /* number of factorisations made for counts */
    int64_t num_counts;
    ritz_counted count[RITZ_MOST_COUNTS]; /* rho ascends */
};

/* The nu of Lehmann's method for one rho (enclose.c), ascending. */
typedef struct ritz_lehmann_values {
    double rho;
    int64_t count; /* 0: rho is too close to a mode of the trial */
    double *nu;
} ritz_lehmann_values;

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
    ritz_dense E; /* n x m, A^-1 R of the residuals R = K X - M X Theta */
    ritz_dense G; /* m x m, R'A^-1 R */
    /* r x m, Phi_r'T'M X with all modes Phi_r of the reduced model; of an
       inverse iterate empty until ritz_measuring_predict() needs it */
    ritz_dense Q;
    double sigma;
    double *kappa; /* m, of X'M A^-1 M X, ascending; NULL: not needed yet */
    /* of each rho that was used: every further count asks for all of them */
    int64_t num_values, room_values;
    ritz_lehmann_values *values;
} ritz_lehmann;

/**
 * Factor K - sigma M of the estimator's sigma, whose magnitude grows until the
 * matrix is definite. If @p rho is not NaN, another thread counts the modes
 * below it meanwhile. That count becomes `early`; if it fails, or memory may not
 * hold both factors, there is none, and whoever needs it takes it again.
 */
ritz_status ritz_estimator_factor(ritz_estimator *estimator, double rho);

/** Count the modes below @p rho by a factor, unless it is the early count. */
ritz_status ritz_estimator_below(ritz_estimator *estimator, double rho,
                                 int64_t *below);

/**
 * Pairs of the space that the first @p count modes of @p reduced span, and
 * their residuals R in place of E. G is empty until ritz_lehmann_solve().
 */
ritz_status ritz_lehmann_new(const ritz_estimator *estimator,
                             const ritz_dense *T, const ritz_reduced *reduced,
                             const ritz_pairs *pairs, int64_t count,
                             ritz_lehmann *out);

/** E := A^-1 E and G = R'A^-1 R of a trial from ritz_lehmann_new(). */
ritz_status ritz_lehmann_solve(ritz_factor *A, ritz_lehmann *trial);

/** Ritz pairs in the range of Y, whose columns are independent; no reduced
 * model. Y is left empty, or overwritten if that fails. */
ritz_status ritz_lehmann_of_span(ritz_estimator *estimator, ritz_dense *Y,
                                 ritz_lehmann *out);

/** The same of (A^-1 M)^2 X: two inverse iterations shrink the errors of
 * @p trial. */
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
    bool unmatched;      /* it is unknown with which mode some mode is paired */
    double count_at;     /* where a count may help; NaN: nowhere */
    int64_t num_full;    /* full modes that may lie below the band's end */
    int64_t num_missing; /* those in the band that have no proven pair */
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
    ritz_lehmann rich; /* the trial and the responses to its residuals */
    ritz_enclosure enclosure;
    ritz_prediction prediction;
    bool refused; /* the last count could not be taken */
} ritz_measuring;

/** Enclose anew by Lehmann's method, with every count that was taken. */
ritz_status ritz_measuring_enclose(ritz_measuring *m);
void ritz_enclosure_free(ritz_enclosure *enclosure);

/* At least, and at most. */
typedef struct ritz_bounds {
    double least, most;
} ritz_bounds;

/* How far a reduced mode can be from a full one, and from which. */
typedef struct ritz_claim {
    double bound;      /* |f_k - f| / f is at most this */
    double least;      /* and about this at least */
    int64_t full_mode; /* number from 0; -1: near one of unknown number */
} ritz_claim;

/** |f_k - f| / f of reduced mode @p k and a full mode in [low, high]. */
ritz_bounds ritz_error_of(const ritz_measuring *m, int64_t k, double low,
                          double high);

/** The claim on reduced mode @p k that has the least bound. */
ritz_claim ritz_claim_of(const ritz_measuring *m, int64_t k);

/** Whether modes were counted at some frequency inside (low, high). */
bool ritz_counted_within(const ritz_estimator *estimator, double low,
                         double high);

/** Predict what ritz-verify finds of the band, as far as enclosures tell. */
ritz_status ritz_measuring_predict(ritz_measuring *m);

/**
 * Fewest full modes less reduced ones below any count at or above the band's
 * end: a mode just within the band may have its partner just outside. -1 if
 * nothing was counted there.
 */
int64_t ritz_missing_modes(const ritz_measuring *m);

/** Whether more than @p k full modes were counted at or below @p rho. */
bool ritz_estimator_has_counted(const ritz_estimator *estimator, int64_t k,
                                double rho);

/**
 * Whether reduced mode @p k, with eigenvalue @p theta, is a rigid motion that
 * the basis represents badly: it is far below @p band, an eigenvalue, and a
 * count shows the full mode of its number below half its eigenvalue.
 */
bool ritz_estimator_sees_rigid(const ritz_estimator *estimator, int64_t k,
                               double theta, double band);

/** Add the bounds of the worst mode and of each, and of modes missing. */
ritz_status ritz_measuring_report(const ritz_measuring *m, ritz_measures *out);

/**
 * Add "frequency-relative-least", the largest of the lower bounds over full
 * modes that are certainly in the band. Nothing can be said of a band that does
 * not begin at 0, as modes below it need no partner.
 */
ritz_status ritz_measuring_report_least(const ritz_measuring *m,
                                        ritz_measures *out);

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
ritz_status ritz_bound_response(ritz_measuring *m, const ritz_reduced *reduced,
                                ritz_measures *out);

/* The bound of a response, whose equations are at the head of response.c. */

/* C, Cv and Ca of outputs. */
enum { KINDS = 3 };

/*
 * One input or output at a frequency w: its vector b, or c + i w cv - w^2 ca,
 * the reduced modes' response eta to it, and the residual r that the full
 * equations leave of that, as a combination of the vectors V of the bounder.
 */
typedef struct ritz_side {
    double _Complex *participation; /* X'b, or c'X */
    double _Complex *eta;           /* response of each trial mode */
    double _Complex *residual;      /* coordinates of r in V */
    /* derivatives by w of the residual and of the participation, and a bound of
       the second derivative of the latter */
    double _Complex *residual_slope, *participation_slope;
    double *curvature;
    double residual_norm; /* |r|_(A^-1), without what damping adds */
    double change;        /* bound of its change in the interval */
    double damping_part;  /* bound of what damping ratios add to |r| */
    /* sums over j of |eta_j||R_j| theta_j^(-1/4), and theta_j^(-3/4), that
       bound the defect of reduced damping */
    double defect_quarter, defect_three;
    double self; /* sum of |participation|^2 / |z|: largest response of a side
                    to itself */
    /* for each trial mode, upper bounds of |eta|, |eta'| and |(c eta)''| in the
       interval */
    double *most[3];
} ritz_side;

/* Terms whose sum is the bound of a response. */
typedef enum ritz_bound_part {
    RITZ_PART_ERROR,   /* the error as far as it is known */
    RITZ_PART_DAMPING, /* ratios act on full modes, which are known only
                          approximately */
    RITZ_PART_REST,    /* modes that the trial space does not contain */
    RITZ_PART_BETWEEN, /* change between the points */
    RITZ_PART_ROUNDING,
    RITZ_PARTS
} ritz_bound_part;

/* The bound of one channel. */
typedef struct ritz_channel_bound {
    double weight;           /* one over the magnitude that the bound is
                                relative to; 0: none */
    double _Complex known;   /* the known part of H - H_r */
    double part[RITZ_PARTS]; /* their sum is the bound */
    double response;         /* |H_r + known| */
    double most;             /* upper bound of |H_r|, by Cauchy-Schwarz from
                                `self` of both sides */
} ritz_channel_bound;

struct ritz_refinement;

typedef struct ritz_bounder {
    const ritz_lehmann *trial;
    const ritz_enclosure *e;
    const ritz_io *io;
    int64_t num_rigid;
    bool rayleigh; /* D = a M + b K; else the ratio zeta of all modes */
    double zeta, a, b;
    double *rates;                 /* damping of each trial mode */
    double *rounding;              /* of each theta, in both models together */
    int64_t size;                  /* columns of V = [R b_o c_o D_o K4_o] */
    ritz_dense V, E;               /* V, and A^-1 V */
    ritz_dense G, Q;               /* V'A^-1 V and V'A^-1 M A^-1 V */
    double *vector_norm;           /* |V_j|_(A^-1) */
    ritz_dense channel[1 + KINDS]; /* B'X, C X, Cv X, Ca X */
    double *sin2; /* of each full mode to the trial space, at most */
    int64_t num_sides;
    ritz_side *side;          /* inputs, then outputs */
    double _Complex *GV, *QV; /* G and Q times the residual of an input */
    bool coupled;             /* D or K4 couples modes: an estimate, no bound */
    const double *matrix_rates; /* the part of rates that is of D and K4; NULL:
                                   rates are 2 zeta omega, or a + b lambda */
    ritz_dense D, K4;           /* of trial modes */
    double _Complex *Z, *responses;
    int *pivot;
    ritz_channel_bound *at;        /* outputs x inputs, at the frequency solved
                                      last */
    struct ritz_refinement *finer; /* the richer trial; NULL: none; borrowed */
} ritz_bounder;

/** Complete a bounder whose trial, enclosure, io and damping are set: compute
 * rates, unless they are set, and all that follows from V. */
ritz_status ritz_bounder_open(ritz_estimator *estimator, ritz_bounder *r);
void ritz_bounder_free(ritz_bounder *r);

/** Solve for responses and residuals of all sides at @p w rad/s, with bounds of
 * their changes within @p h of it. */
void ritz_bounder_solve(ritz_bounder *r, double w, double h);

/** Multiply G and Q by the residual of an input, for ritz_bound_pair. */
void ritz_bounder_take_input(ritz_bounder *r, int64_t input);

/**
 * The bound of |H - H_r| of one channel, with its terms and the known part, by
 * the residuals of its two sides. Call ritz_bounder_solve and
 * ritz_bounder_take_input before.
 */
void ritz_bound_pair(const ritz_bounder *r, double w, double h, int64_t input,
                     int64_t output, ritz_channel_bound *result);

/** Change of H_r of a channel by rounding. */
double ritz_rounding_of_pair(const ritz_bounder *r, double w, int64_t input,
                             int64_t output);

/** Whether D is a M + b K with a, b >= 0, and which; K4 is absent then. */
ritz_status ritz_estimator_rayleigh(const ritz_component *full, double *a,
                                    double *b, bool *found);

/**
 * Rates where no ratio is common to all modes: D's diagonal, K4's over omega,
 * and what was requested. Modes above those known get the least ratio.
 *
 * @param[out] matrices  the part of each rate that is of D and K4; borrowed by
 *                       @p r
 */
ritz_status ritz_bounder_take_rates(const ritz_estimator *estimator,
                                    ritz_bounder *r, double *matrices);

/** Which damping is unknown, so that there is no bound; NULL: none. */
const char *ritz_bounder_unknown(const ritz_measuring *m,
                                 const ritz_bounder *r);

/** Stiffness of a trial mode; 0 of a rigid one. */
double ritz_bounder_stiffness(const ritz_bounder *r, int64_t j);

/** z of a trial mode at w; and the least |z| within h of w. */
double _Complex ritz_bounder_z(const ritz_bounder *r, int64_t j, double w);
double ritz_bounder_least_z(const ritz_bounder *r, int64_t j, double w,
                            double h);

/* Richer trials, whose response is compared with that of the trial before; the
   equations are at the head of refinement.c. */

/* The residual r of one side, in the modes of the richer trial. */
typedef struct ritz_finer_side {
    double _Complex *r, *slope; /* of each mode: r, and its derivative by w */
    double *curvature;          /* of each mode: upper bound of |r''| in the
                                   interval */
} ritz_finer_side;

typedef struct ritz_refinement {
    ritz_bounder fine; /* of the richer trial */
    ritz_dense U, U_d; /* X_2'V and, with ratios, its part from damping; else
                          {0} */
    ritz_dense defect; /* W'D_2 W - D with ratios; else {0} */
    int64_t num_sides;
    ritz_finer_side *side;
} ritz_refinement;

/**
 * Ritz pairs of a richer space: the trial and A^-1 V, without columns of V that
 * are rounding or dependent.
 *
 * @param[in]  coarse  after ritz_bounder_open
 * @param[out] rich    count 0 if all of V is rounding
 */
ritz_status ritz_enrich(ritz_estimator *estimator, const ritz_bounder *coarse,
                        ritz_lehmann *rich);

/**
 * @param[in] rich  borrowed until free, as @p enclosure and the damping of @p
 *                  coarse are
 */
ritz_status ritz_refinement_new(ritz_estimator *estimator,
                                const ritz_bounder *coarse,
                                const ritz_lehmann *rich,
                                const ritz_enclosure *enclosure,
                                ritz_refinement *out);

/** Solve the richer trial within @p h of @p w; @p coarse has been solved. */
void ritz_refinement_solve(const ritz_bounder *coarse, ritz_refinement *f,
                           double w, double h);

/** As ritz_bound_pair, by the richer trial. */
void ritz_refinement_bound(const ritz_bounder *coarse, const ritz_refinement *f,
                           double w, double h, int64_t input, int64_t output,
                           ritz_channel_bound *result);

void ritz_refinement_free(ritz_refinement *f);

#endif
