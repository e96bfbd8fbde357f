/*
 * The equations that integrators solve, in one of four forms. All outputs are
 *
 *     y = C x + Cv x' + feed u,   accelerations being replaced by the equations
 *
 * modal    x'' + D x' + Lambda x = B u, D diagonal or not
 * dense    M x'' + D x' + K x = B u, full matrices, M regular
 * sparse   the same of a full component; rows of M may be empty
 * states   x' = A x + B u,   y = C x + feed u
 */
#ifndef RITZ_SIMULATE_MOTION_H
#define RITZ_SIMULATE_MOTION_H

#include "linear/general.h"
#include "model/modal.h"

#include <ritz/matrix.h>
#include <ritz/simulate.h>

typedef enum ritz_form {
    RITZ_FORM_MODAL,
    RITZ_FORM_DENSE,
    RITZ_FORM_SPARSE,
    RITZ_FORM_STATES,
} ritz_form;

typedef struct ritz_motion {
    ritz_form form;
    int64_t n;          /* coordinates, or states */
    int64_t original;   /* coordinates of the model, those of x0 and v0 */
    int64_t num_rigid;  /* modal */
    double *lambda;     /* modal, n; 0 where rigid */
    double highest;     /* largest |lambda| known of a dense model, else NaN */
    ritz_dense K, M, D; /* dense, n x n; D {0}: none; modal: D alone */
    ritz_sparse sK, sM, sD; /* sparse; sD {0}: none */
    ritz_dense A;           /* states */
    ritz_dense B;           /* n x inputs */
    ritz_dense C, Cv;       /* outputs x n; Cv {0} of states */
    ritz_dense feed;        /* outputs x inputs */
    ritz_dense push;        /* n x inputs: change of x', or of states x, by a
                               unit impulse */
    ritz_dense to;          /* original x n: x = to' x0; {0}: the same */
    bool *massless;         /* sparse, n: rows empty in M */
    bool energies;          /* are requested; they take time */
    bool any_step;          /* accept an unstable explicit step */
} ritz_motion;

/** Modal if @p modal, else dense; in modes of the model if M is singular. */
ritz_status ritz_motion_dense(ritz_model subject, bool modal, ritz_motion *out);

/** Modal, with the matrices of @p modes, which are moved. */
ritz_status ritz_motion_take(ritz_modal_model *modes, ritz_motion *m);

/** The form that a subject and an integrator need: a dense model is integrated
 * in its modes, by every integrator. */
ritz_status ritz_motion_new(ritz_model subject,
                            const ritz_simulation_request *request,
                            ritz_motion *out);

/** The same, with full matrices of a dense model by all integrators but
 * modal. */
ritz_status ritz_motion_full(ritz_model subject,
                             const ritz_simulation_request *request,
                             ritz_motion *out);

/* A matrix of a dense or sparse motion. */
typedef enum ritz_term {
    RITZ_STIFFNESS,
    RITZ_MASS,
    RITZ_DAMPING,
} ritz_term;

/** y += alpha A x, A being that matrix. */
void ritz_motion_add(const ritz_motion *motion, ritz_term term, double alpha,
                     const double *x, double *y);

/** y += alpha A x of a dense matrix; y stays as it is if A is {0}. */
void ritz_motion_gemv(const ritz_dense *A, double alpha, const double *x,
                      double *y);
/** x'A x of a symmetric A, whose lower triangle is read. */
double ritz_motion_form(const ritz_dense *A, const double *x);
double ritz_motion_dot(int64_t n, const double *a, const double *b);

/* A factor of m M + d D + k K. */
typedef struct ritz_effective {
    int64_t n;
    ritz_general_factor dense;
    ritz_factor *spd;
    ritz_ldl *ldl;
    ritz_zldl *general; /* of the sparse matrix below, which it borrows */
    ritz_sparse kept;
    double _Complex *z; /* n, to work in */
} ritz_effective;

/**
 * @param[out] out  empty; must stay where it is, freed on failure too
 * @param[in] fill  1 in its diagonal where rows of M are empty: for M alone
 * @return RITZ_ERR_SINGULAR
 */
ritz_status ritz_effective_new(const ritz_motion *motion, double m, double d,
                               double k, bool fill, ritz_effective *out);
ritz_status ritz_effective_solve(ritz_effective *F, int64_t columns, double *x);
void ritz_effective_free(ritz_effective *F);

void ritz_motion_free(ritz_motion *motion);

/* Groups of modes or states: a matrix couples those of one group, and none of
   one group with one of another. */
typedef struct ritz_groups {
    int64_t count;
    int64_t *first;  /* count + 1 */
    int64_t *member; /* of group k: member[first[k]] ... */
} ritz_groups;

/**
 * Divide the rows of a square matrix D into groups, the connected parts of its
 * graph. Entries with |D_ij| <= @p floor count as zero.
 */
ritz_status ritz_groups_new(const ritz_dense *D, double floor,
                            ritz_groups *out);
void ritz_groups_free(ritz_groups *groups);

/*
 * A motion over time: its state, and how it advances by a step. Integrators
 * fill one (ritz_march_new). Runs of other than one linear model (switched
 * models, constraints, closed loops, spin and sweeps) fill one with functions
 * of their own. ritz_march_run is the loop over time of all.
 */
typedef struct ritz_march {
    const ritz_motion *motion; /* borrowed */
    double step;
    int64_t steps; /* done so far */
    double *x, *v; /* n each; of states v is NULL */
    double dissipated, work;
    void *own; /* of the integrator */
    /** The numbers, part of `own`, that a step needs in addition to x and v: if
     * they are restored, the march continues with identical bits. */
    double *memory;
    int64_t num_memory;
    /** One step, with inputs as they are at its start and at its end. */
    ritz_status (*advance)(struct ritz_march *march, const double *u0,
                           const double *u1);
    /** x, v were set and inputs are u: anything else that follows from it. */
    ritz_status (*settle)(struct ritz_march *march, const double *u);
    /** Outputs of the present state; NULL: y = C x + Cv v + feed u. */
    void (*outputs)(const struct ritz_march *march, const double *u, double *y);
    /** Energies of the present state; NULL: those of M and K. */
    void (*energy)(const struct ritz_march *march, double *kinetic,
                   double *potential);
    /** Diagnostics that are stored with each time that is written, such as the
     * violation of constraints, and their names. */
    int64_t num_diagnostics;
    const char *const *diagnostic;
    void (*diagnose)(const struct ritz_march *march, double *out);
    void (*free)(void *own);
} ritz_march;

/** Allocate x and v, all else by the integrator's start. */
ritz_status ritz_march_new(const ritz_motion *motion,
                           const ritz_integrator *integrator, double step,
                           double rho, ritz_march *out);
void ritz_march_free(ritz_march *march);

/** Outputs of the present state, inputs being u. */
void ritz_march_outputs(const ritz_march *march, const double *u, double *y);

/** Kinetic and potential energy of the present state. */
void ritz_march_energy(const ritz_march *march, double *kinetic,
                       double *potential);

/** Rounding of the potential energy of the present state: eps times the terms
 * whose sum it is. 0 if the stiffness is not that of the motion. */
double ritz_march_energy_rounding(const ritz_march *march);

/* Weights of Newmark's integrators and of generalised-alpha. */
typedef struct ritz_newmark_weights {
    double alpha_m, alpha_f, beta, gamma;
} ritz_newmark_weights;

/** Of generalised-alpha. @return RITZ_ERR_ARGUMENT if rho is not in 0 to 1 */
ritz_status ritz_generalised_alpha(double rho, ritz_newmark_weights *w);

/** Processor time, s, of a step with inputs @p u: the least of several. */
ritz_status ritz_march_cost(ritz_march *march, const double *u, double *out);

struct ritz_reach;

/**
 * The loop over time: the initial state and impulses of a request, its steps,
 * and what is stored.
 *
 * @param[in,out] reach  noted with each time that is written; may be NULL
 * @param[out] s  empty; freed by the caller on failure too. Its inputs, outputs
 *                and damping have no names yet (ritz_simulation_label)
 * @return RITZ_ERR_CONVERGENCE if the motion grows without bound
 */
ritz_status ritz_march_run(ritz_march *march,
                           const ritz_simulation_request *request,
                           struct ritz_reach *reach, ritz_simulation *s);

/** Give a simulation the names of inputs and outputs and the damping of its
 * model. */
ritz_status ritz_simulation_label(ritz_model subject, ritz_simulation *s);

/*
 * The largest value that a motion could give an output; its rounding is
 * relative to that: with |x|^2 = x'M x, and M in M^-1 by its diagonal alone,
 *
 *     |c x + cv x' + ca x''| <= |c| |x| + |cv| |x'| + |ca| |x''|,
 *     |c|^2 = c M^-1 c',
 *
 * and of dofs without mass by the strain energy, with x'K x and K. Units of
 * dofs, of outputs and of time cancel. Of a state space sum |c_j| |x_j|.
 */
typedef struct ritz_reach {
    int64_t count;  /* outputs */
    double *weight; /* 4 x count: |c|, |cv|, |ca| and |c| by K; NULL: of
                          states */
    double *size;   /* count: the largest value so far */
    double *last;   /* n: velocities when it was last noted */
    double *work;   /* n */
    double seconds; /* when that was */
} ritz_reach;

ritz_status ritz_reach_new(ritz_model subject, const ritz_motion *motion,
                           ritz_reach *out);

/** Take the state of the march at @p seconds into account. */
void ritz_reach_note(ritz_reach *reach, const ritz_march *march,
                     double seconds);

void ritz_reach_free(ritz_reach *reach);

/** How many steps a request takes. @return RITZ_ERR_ARGUMENT */
ritz_status ritz_request_steps(const ritz_simulation_request *request,
                               int64_t *out);

/**
 * ritz_simulate, with or without energies.
 *
 * @param[out] reach  may be NULL; the caller frees it
 */
ritz_status ritz_simulate_noting(ritz_model subject,
                                 const ritz_simulation_request *request,
                                 bool energies, ritz_reach *reach,
                                 ritz_simulation *out);

/**
 * Inputs and outputs as given, followed by outputs V u, V u' and V u'' of the
 * coordinates u.
 *
 * @param[in] V  NULL: the identity
 */
ritz_status ritz_coordinates_add(const ritz_io *own, const ritz_dense *V,
                                 ritz_io *out);

/** Move the coordinates out of the outputs of a run, of which the first @p own
 * stay. */
ritz_status ritz_coordinates_take(int64_t own, ritz_simulation *s);

/** A run of a model, which may be given more outputs than it has. */
typedef ritz_status ritz_run_function(ritz_model subject,
                                      const ritz_simulation_request *request,
                                      const void *context,
                                      ritz_simulation *out);

/**
 * Run. If the request includes coordinates, they are additional outputs of the
 * run, after those of the model, and are moved out of the outputs at its end.
 */
ritz_status ritz_simulate_coordinates(ritz_model subject,
                                      const ritz_simulation_request *request,
                                      ritz_run_function *run,
                                      const void *context,
                                      ritz_simulation *out);

/** Largest |value| of an output, and its largest difference from another. */
void ritz_simulation_compare(const ritz_simulation *exact,
                             const ritz_simulation *other, int64_t output,
                             double *size, double *difference);

/**
 * Starts a march of a state space, by the exponential of A if @p exact, else by
 * the trapezoidal rule.
 *
 * @return RITZ_ERR_SINGULAR if 2 / step is an eigenvalue of A, by that rule
 */
ritz_status ritz_states_start(const ritz_motion *motion, double step,
                              bool exact, ritz_march *out);

/**
 * x_1 = E x_0 + G u_0 + H (u_1 - u_0) of a state space, exactly.
 *
 * @param[out] H  NULL: not wanted
 */
ritz_status ritz_states_exact(const ritz_motion *motion, double step,
                              ritz_dense *E, ritz_dense *G, ritz_dense *H);

/*
 * One damped mode, q'' + d q' + lambda q = f, propagated exactly over h while f
 * changes linearly, at rate g:
 *
 *     q_1  = (S' + d S) q_0 +      S  v_0 + P f + R g
 *     v_1  =   -lambda S q_0 +     S' v_0 + S f + P g
 *
 * S is the response of q to a unit velocity, S' its rate, P and R its first and
 * second integral.
 */
typedef struct ritz_oscillator {
    double hold; /* S' + d S */
    double S, rate, P, R;
} ritz_oscillator;

/** For any real lambda and d, without loss of digits where roots meet or
 * vanish. */
ritz_oscillator ritz_oscillator_over(double lambda, double d, double h);

#endif
