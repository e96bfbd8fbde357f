/*
 * Rankings of modes: which matter from input to output, or carry mass. Rigid
 * modes are not ranked. Modes closer than 1e-6 in frequency are one cluster,
 * which gets one value and is kept or dropped whole. Rankings that evaluate a
 * cluster as a model of its own also put modes into one cluster that damping
 * couples by more than 0.1 of their own damping.
 */
#ifndef RITZ_RANKING_H
#define RITZ_RANKING_H

#include <ritz/model.h>

#pragma GCC visibility push(default)

/* What a ranking needs of a model; the rest may be absent. */
enum {
    RITZ_RANK_INPUTS = 1,
    RITZ_RANK_OUTPUTS = 2,
    RITZ_RANK_DAMPING = 4,
    RITZ_RANK_BAND = 8,
    RITZ_RANK_MOMENTUM = 16,
    RITZ_RANK_INTERFACE = 32, /* ranks the modes of its interface held */
};

/*
 * Weights of inputs and outputs: the cost is sum_i Q_i y_i^2 of inputs of
 * intensity W_j. Q_i is 1 / limit^2 and W_j is 1 where nothing is said.
 */
typedef struct ritz_weight {
    char name[RITZ_NAME_SIZE];
    double value; /* not negative */
} ritz_weight;

typedef struct ritz_weights {
    int64_t num_inputs, num_outputs;
    ritz_weight *input, *output;
} ritz_weights;

/**
 * Take "torque=4,force=1" for inputs, or for outputs; NULL: none.
 *
 * @return RITZ_ERR_ARGUMENT if it is no list of names and weights, or a name
 *         comes twice
 */
ritz_status ritz_weights_parse(const char *inputs, const char *outputs,
                               ritz_weights *out);

void ritz_weights_free(ritz_weights *weights);

/* Options of a ranking. */
typedef struct ritz_rank_choice {
    ritz_damping damping;        /* added to its matrices */
    double band_hz[2];           /* [0, 0]: none */
    const ritz_weights *weights; /* borrowed; NULL: none */
} ritz_rank_choice;

/* What is ranked. {0} parts are absent. */
typedef struct ritz_rank_request {
    ritz_modal modal; /* the modes */
    bool undamped;    /* they have no damping: ratios there mean nothing */
    bool bare;        /* values and order alone, no exact values of the whole */
    double band_hz[2];             /* HUGE_VAL is infinity */
    ritz_dense momentum;           /* 6 x m, R'M phi about the basic origin */
    double rigid[36];              /* R'MR, symmetric */
    ritz_dense coupling;           /* p x m, M_ib of fixed-interface modes */
    ritz_dense interface;          /* p x p, mass of the interface: Psi'M Psi */
    char (*input)[RITZ_NAME_SIZE]; /* NULL: without names */
    char (*output)[RITZ_NAME_SIZE]; /* NULL: without names */
} ritz_rank_request;

/*
 * One ranking, of one model at one configuration. Of a component or a state
 * space there are no modes, only exact values.
 */
typedef struct ritz_ranking {
    char by[RITZ_NAME_SIZE];
    char reference[RITZ_NAME_SIZE];
    char at[RITZ_NAME_SIZE];         /* configuration; "" of a model without */
    char damping[RITZ_DAMPING_SIZE]; /* as ritz_damping_parse reads; "" that of
                                        the matrices alone */
    int64_t count;                   /* m flexible modes */
    double *hertz;                   /* m */
    double *zeta;                    /* m, the damping used; 0: none was */
    double *value;    /* m, one for each mode; equal within a cluster */
    int64_t *order;   /* m, best first; ties in order of frequency */
    int64_t *cluster; /* m, the first mode of its cluster; modes of a cluster
                         need not be neighbours */
    double total;     /* what all values add up to by identity; NaN: nothing */
    int64_t num_parts;
    char (*part)[RITZ_NAME_SIZE]; /* what a value is made of: outputs, inputs,
                                     directions */
    ritz_dense parts;             /* m x num_parts */
    double *whole; /* num_parts, what all of a part is; NaN where unknown */
    int64_t num_system;
    double *system_value; /* exact Hankel values of the whole model, descending;
                             poles at 0 of damped rigid motion are left out */
    double coupling;      /* largest normalised off-diagonal of the exact modal
                        Gramian: where it is not small, Gregory's assumption
                        fails; NaN if not computed */
    int64_t coupled[2];   /* modes between which it stands */
} ritz_ranking;

typedef struct ritz_ranker {
    const char *name;
    const char *summary;
    const char *reference;
    int needs; /* RITZ_RANK_... */
    bool sums; /* values add up: that of a cluster is divided equally among its
                  modes; if not, it is the value of each of them */
    double (*exact)(const double pair[static 2]); /* what a value approaches, of
                   a pair of exact Hankel values; NULL: it is no Hankel value */
    bool joins; /* modes that damping couples are put into one cluster */
    /* one of both: the value of a cluster, which is a model of its own, over a
       band if the ranking needs one, or ... */
    ritz_status (*value)(const double *band_hz, const ritz_modal *cluster,
                         double *out);
    /** ... all values, and `total` and parts where it has any, by
     * ritz_ranking_parts; all modes of a cluster get the same value, or they
     * are
     * summed up by the caller. */
    ritz_status (*rank)(const ritz_rank_request *request,
                        ritz_ranking *ranking);
} ritz_ranker;

/* Every ranking: ritz_ranker_NAME is in src/ranking. */
#define RITZ_EACH_RANKER(X)                                                    \
    X(gregory)                                                                 \
    X(hankel)                                                                  \
    X(hankel_band)                                                             \
    X(modal_cost)                                                              \
    X(h2)                                                                      \
    X(effective_mass)                                                          \
    X(effective_interface_mass)                                                \
    X(participation)

#define RITZ_DECLARE_RANKER(name) extern const ritz_ranker ritz_ranker_##name;
RITZ_EACH_RANKER(RITZ_DECLARE_RANKER)
#undef RITZ_DECLARE_RANKER

/** All of them in this order, ended by NULL. */
extern const ritz_ranker *const ritz_rankers[];

const ritz_ranker *ritz_ranker_find(const char *name);

/**
 * The request to rank a reduced component or a configuration: its flexible
 * modes or, for rankings that need them, those with its interface clamped.
 *
 * @param[in] needs  of the ranker
 * @return RITZ_ERR_ARGUMENT if the model lacks it, or a weight names nothing
 */
ritz_status ritz_rank_request_of_reduced(const ritz_reduced *reduced,
                                         const ritz_rank_choice *choice,
                                         int needs, ritz_rank_request *out);
ritz_status
ritz_rank_request_of_configuration(const ritz_configuration *configuration,
                                   const ritz_rank_choice *choice, int needs,
                                   ritz_rank_request *out);

void ritz_rank_request_free(ritz_rank_request *request);

/**
 * Rank by magnitude of value, with exact system values and the coupling flag if
 * there are inputs, outputs and damping.
 *
 * @return RITZ_ERR_ARGUMENT if the request lacks what the ranker needs, or a
 *         motion other than a rigid one does not decay
 */
ritz_status ritz_rank(const ritz_ranker *ranker,
                      const ritz_rank_request *request, ritz_ranking *out);

/** Room for parts, all zero; names and wholes are the ranker's to fill. */
ritz_status ritz_ranking_parts(int64_t count, ritz_ranking *ranking);

/** Rankings of several configurations, and which modes of them correspond. */
typedef struct ritz_rankings {
    int64_t count;
    ritz_ranking *item;
    int64_t **track; /* of each, m numbers that say which mode is which in the
                        others; NULL: the k-th is the k-th */
} ritz_rankings;

/**
 * The largest value of each mode over several rankings, in one.
 *
 * @param[out] where  of each mode, the ranking that has it; to be freed
 * @param[out] track  of each mode, its number; to be freed
 * @return RITZ_ERR_ARGUMENT if they are not by one ranking, or without tracks
 *         not of as many modes
 */
ritz_status ritz_rankings_largest(const ritz_rankings *rankings,
                                  ritz_ranking *out, int64_t **where,
                                  int64_t **track);

void ritz_ranking_free(ritz_ranking *ranking);
void ritz_rankings_free(ritz_rankings *rankings);

/*
 * Output weights that suit a choice of modes. Modal costs depend on weights;
 * the weights that should decide are those of outputs that the choice serves
 * badly. So they are iterated [ZhuSkelton1992]:
 *
 *     keep the k modes of largest cost sum_i q_i V_ki,
 *     d_i = |Y_i - Y_i(kept alone)|, what output i misses, in squared limits,
 *     q_i := (1 - a) p d_i / sum d + a q_i,    a = 1/2, q_i = 1 at first
 *
 * until weights and choice repeat: from one round to the next, or after several
 * rounds, which is an oscillation: then no weights suit their own choice.
 */

typedef struct ritz_reweighing {
    int64_t num_outputs;
    double *weight; /* q of the best round, times those of the request */
    double *cost;   /* Y, variance of each output for white inputs */
    double *missed; /* d of the best round: its largest is the least */
    int64_t num_kept;
    int64_t *kept;     /* modes of the best round, ascending */
    int64_t rounds;    /* that were made */
    int64_t period;    /* 1: settled; more: oscillates; 0: does neither */
    int64_t num_other; /* oscillates: modes that another round of the period
                            would keep */
    int64_t *other;
} ritz_reweighing;

/**
 * @param[in] keep  k, less than there are modes; clusters stay whole
 * @return RITZ_ERR_ARGUMENT if there is nothing to choose from
 */
ritz_status ritz_reweigh(const ritz_rank_request *request, int64_t keep,
                         ritz_reweighing *out);

void ritz_reweighing_free(ritz_reweighing *reweighing);

/*
 * How far two rankings of the same modes agree.
 *
 * Places are compared, not values: modes are sorted by magnitude, those below
 * 1e-12 of the largest are rounding and share the last place, as others of one
 * value share theirs.
 */

/* The first k of either, clusters whole. */
typedef struct ritz_overlap {
    int64_t k;
    double share; /* of the larger of both that the other has too */
} ritz_overlap;

typedef struct ritz_agreement {
    int64_t common;       /* modes that both have */
    int64_t alone[2];     /* modes that one has only */
    double spearman;      /* correlation of places, -1 .. 1; NaN if all are
                             equal in one */
    double kendall;       /* tau-b: pairs in the same order less those in the
                             other */
    int64_t num_overlaps; /* k = 1, 2, 5, 10, 20, 50, ... */
    ritz_overlap *overlap;
    int64_t top; /* the k of what follows */
    double top_share;
    int64_t num_left, num_entered; /* of the first k: in the first ranking */
    int64_t *left, *entered;       /* alone, in the second alone; numbers of
                                      modes or tracks, as they rank */
} ritz_agreement;

/**
 * Compare two rankings of one set of modes, matched by number.
 *
 * @param[in] track  of either, which number each mode has; NULL: its index
 * @param[in] top    whose changes are listed
 * @cost O(m^2)
 */
ritz_status ritz_rankings_agree(const ritz_ranking *a, const int64_t *track_a,
                                const ritz_ranking *b, const int64_t *track_b,
                                int64_t top, ritz_agreement *out);

void ritz_agreement_free(ritz_agreement *agreement);

#pragma GCC visibility pop

#endif
