/* Methods that make a basis: their requests, and how to find a method. */
#ifndef RITZ_BASIS_H
#define RITZ_BASIS_H

#include <ritz/model.h>

#pragma GCC visibility push(default)

/*
 * What a method is told beside how many vectors it makes: one table of words
 * that options (--shift-hz 0,5) and scenes (shift_hz: [0, 5]) share.
 */

enum { RITZ_MOST_SHIFTS = 16 };

/* What a method heeds of a request; the rest must be left alone. */
enum {
    RITZ_USES_MODES = 1,
    RITZ_USES_ATTACHED = 2,
    RITZ_USES_SHIFTS = 4,
    RITZ_USES_LOADS = 8,
    RITZ_USES_INNER = 16,
    RITZ_USES_INTERFACE = 32,
    RITZ_USES_GRAMIAN = 64,
    RITZ_USES_OPERATOR = 128,
    RITZ_USES_DAMPING = 256,
    RITZ_USES_NEIGHBOUR = 512,
    RITZ_USES_ENGINE = 1024,
    RITZ_USES_AMONG = 2048,
    RITZ_USES_BAND = 4096,
    RITZ_USES_REMAINDER = 8192,
    RITZ_USES_SIDES = 16384,
    RITZ_USES_COUNT = 65536,
    RITZ_USES_ACCURACY = 131072,
    RITZ_USES_EIGEN = RITZ_USES_COUNT | RITZ_USES_ENGINE |
                      RITZ_USES_ACCURACY, /* computes modes */
    RITZ_USES_SPACE = 32768, /* a state space in the place of a component */
};

/* Forces whose static solutions are vectors: H K^-1 F. */
enum {
    RITZ_LOADS_ATTACHED = 1, /* unit forces at the attached dofs */
    RITZ_LOADS_INPUTS = 2,
    RITZ_LOADS_OUTPUTS = 4, /* rows of C, Cv and Ca */
    RITZ_LOADS_DAMPERS = 8, /* influence vectors of discrete dampers */
};

typedef enum ritz_inner {
    RITZ_INNER_STIFFNESS, /* v' K v = 1, or K - sigma M with a shift */
    RITZ_INNER_MASS,      /* v' M v = 1 */
} ritz_inner;

typedef enum ritz_gramian {
    RITZ_GRAMIAN_INPUTS,  /* controllability */
    RITZ_GRAMIAN_OUTPUTS, /* observability */
} ritz_gramian;

/* How Gramians or modes are computed. */
typedef enum ritz_engine {
    RITZ_ENGINE_AUTO,
    RITZ_ENGINE_DENSE, /* this and the next three: Gramians */
    RITZ_ENGINE_MODAL,
    RITZ_ENGINE_LOW_RANK,
    RITZ_ENGINE_PROJECTION,
    RITZ_ENGINE_LANCZOS, /* this and the next four: modes, see ritz_span */
    RITZ_ENGINE_ARPACK,
    RITZ_ENGINE_SLICES,
    RITZ_ENGINE_AMLS,
    RITZ_ENGINE_SLEPC, /* in several processes; only ritz-basis has it */
} ritz_engine;

typedef struct ritz_choice {
    int given; /* RITZ_USES_... of the words that were given */
    int64_t num_shifts;
    double shift_hz[RITZ_MOST_SHIFTS]; /* expansion points, each once */
    int loads;                         /* sum of RITZ_LOADS_... */
    ritz_inner inner;
    int64_t interface_modes; /* instead of all attached dofs */
    ritz_gramian gramian;
    bool inverse;         /* Lanczos on A^-1 instead of A */
    ritz_damping damping; /* instead of the component's own */
    ritz_engine engine;
    double among_hz;   /* modal engine: modes up to here */
    double band_hz[2]; /* where the response matters */
    bool perturb;      /* the remainder answers statically, it is not dropped */
    bool one_sided;    /* of second order: W = T, which keeps symmetry */
    bool uncounted;    /* skip the count of modes that proves none missing */
    double accuracy;   /* of eigenvalues of modes, relative; see ritz_span */
} ritz_choice;

/* What the value of a word is. */
typedef enum ritz_choice_kind {
    RITZ_CHOICE_SHIFTS,
    RITZ_CHOICE_SET,      /* some of its words, as bits of an int */
    RITZ_CHOICE_ENUM,     /* one of its words, as an int */
    RITZ_CHOICE_FLAG,     /* the first of two words is false */
    RITZ_CHOICE_COUNT,    /* int64_t, 1 or more */
    RITZ_CHOICE_HERTZ,    /* above 0 */
    RITZ_CHOICE_ACCURACY, /* 1e-8 to 1e-2 */
    RITZ_CHOICE_BAND,
    RITZ_CHOICE_DAMPING,
} ritz_choice_kind;

/* A word, and what it sets. */
typedef struct ritz_choice_word {
    const char *key;      /* "shift_hz" in scenes, --shift-hz as option */
    const char *argument; /* of the option: "F[,F]" */
    const char *help;
    int uses; /* bit of a method that heeds it */
    ritz_choice_kind kind;
    size_t offset;           /* of the field in ritz_choice */
    const char *what;        /* what sentences call a value */
    const char (*value)[16]; /* words that it can be */
    int64_t num_values;
} ritz_choice_word;

/* All words, ended by one without a key. */
extern const ritz_choice_word ritz_choice_words[];

/**
 * Take a value: "0,5" for shift_hz, "inputs,outputs" for loads, "mass" or
 * "stiffness" for inner, "8" for interface_modes, "inputs" or "outputs" for
 * gramian, "state" or "inverse" for operator, "modal 0.01" for damping, "auto",
 * "dense", "modal", "low-rank", "projection", "lanczos", "arpack", "slices",
 * "amls" or "slepc" for engine, "yes" or "no" for count, "1e-4" for accuracy,
 * "50" for among_hz, "0,10" for band_hz, "dropped" or "static" for remainder,
 * "one" or "two" for sides.
 *
 * @return RITZ_ERR_ARGUMENT with what is wrong
 */
ritz_status ritz_choice_take(const ritz_choice_word *word, const char *text,
                             ritz_choice *choice);

/** Words that were given, as "shift-hz 0,5 inner mass"; cut to fit. */
void ritz_choice_print(const ritz_choice *choice, int64_t size, char *out);

/* Mass and stiffness of a loaded interface, condensed to the attached dofs. */
typedef struct ritz_neighbour {
    ritz_dense K, M; /* attached x attached, condensed [N/m], [kg]; {0}: none */
} ritz_neighbour;

/*
 * The request to a method. A method that needs more gets a field here, which
 * is zero for all others; its signature stays.
 */
typedef struct ritz_request {
    const ritz_component *component; /* borrowed */
    const ritz_state_space *space; /* in its place, RITZ_USES_SPACE; borrowed */
    ritz_dofs attached; /* kept as they are, in this order; borrowed */
    int64_t modes;      /* how many flexible ones; -1: as up_to_hz says */
    double up_to_hz;    /* every mode up to this frequency; 0: modes decides */
    double tolerance;   /* relative, below which a column is dependent */
    ritz_choice choice; /* shifts, loads, inner product and so on */
    const ritz_neighbour *neighbour; /* loaded interface; NULL: none */
    /* the same as `component` if a method may free its K and M once it no
       longer needs them, so that memory does not hold both them and copies of
       parts of them; NULL: they are kept */
    ritz_component *owned;
    /* the lowest modes of `component`, none of which is missing below
       `proven_to`: methods with free-interface modes copy them, and krylov
       methods copy the rigid-body modes, if there are enough; borrowed, NULL:
       the method computes its modes */
    const ritz_pairs *known;
} ritz_request;

/* A request without number of modes or frequency. */
#define RITZ_REQUEST_NONE                                                      \
    {                                                                          \
        .modes = -1, .tolerance = 1e-10                                        \
    }

enum { RITZ_NAMED_FOR_COMPONENTS = 1, RITZ_NAMED_FOR_SCENES = 2 };

/**
 * The basis T V with fewer modes, where T is the basis of @p wide.
 *
 * @param[in]  wide       the component reduced by T
 * @param[in]  at         count columns of T: the modes that are kept,
 *                        ascending, and then all columns that are not modes
 * @param[in]  tolerance  relative, below which a column is dependent
 * @param[out] V          number of columns of T x count; {0} if a column of the
 *                        basis with fewer modes would depend on others
 * @param[out] columns    kinds, dofs and frequencies of the columns of T V
 * @return RITZ_ERR_MEMORY, or as solutions of order count fail
 */
typedef ritz_status ritz_narrow(const ritz_reduced *wide, int64_t count,
                                const int64_t *at, double tolerance,
                                ritz_dense *V, ritz_columns *columns);

typedef struct ritz_method {
    const char *name;      /* as typed on the command line */
    const char *summary;   /* one line for --list */
    const char *reference; /* key in docs/references.bib */
    /* what a newcomer chooses by, a line of --list each: for which components,
       at what cost, what is guaranteed, where it fails */
    const char *when, *cost, *holds, *fails;
    int uses;             /* sum of RITZ_USES_... */
    bool keeps_interface; /* has a column for every attached dof, however few
                             others are kept */
    bool nested;          /* its basis with fewer modes consists of columns of
                             its basis with more: all that are no modes, and the
                             first modes. Not where there are static columns:
                             they are made without the part in the modes */
    bool by_ranks;        /* `make` is one of libexec/ritz-basis-slepc.c, which
                             works in several processes */
    int only_named;       /* ritz-fit tries the method only if the user names
                             it: sum of RITZ_NAMED_FOR_... */
    /* the method by whose basis T, with more modes, a basis of this method is
       T V; it may be this method itself; NULL: there is none */
    const struct ritz_method *wide;
    ritz_narrow *narrow;
    /** @return RITZ_ERR_ARGUMENT, RITZ_ERR_SINGULAR or RITZ_ERR_CONVERGENCE */
    ritz_status (*make)(const ritz_request *request, ritz_basis *out);
} ritz_method;

/* Every method: ritz_method_NAME is in src/bases. */
#define RITZ_EACH_METHOD(X)                                                    \
    X(balanced)                                                                \
    X(balanced_band)                                                           \
    X(balanced_position)                                                       \
    X(balanced_velocity)                                                       \
    X(craig_bampton)                                                           \
    X(dual_craig_bampton)                                                      \
    X(full)                                                                    \
    X(guyan)                                                                   \
    X(inertia_relief)                                                          \
    X(irs)                                                                     \
    X(krylov)                                                                  \
    X(krylov_cms_fixed)                                                        \
    X(krylov_cms_free)                                                         \
    X(krylov_damped)                                                           \
    X(lanczos_one_sided)                                                       \
    X(lanczos_two_sided)                                                       \
    X(loaded_interface)                                                        \
    X(macneal)                                                                 \
    X(macneal_rubin)                                                           \
    X(modal_balanced)                                                          \
    X(normal_modes)                                                            \
    X(rigid)                                                                   \
    X(rubin)                                                                   \
    X(serep)                                                                   \
    X(tangential)

#define RITZ_DECLARE_METHOD(name) extern const ritz_method ritz_method_##name;
RITZ_EACH_METHOD(RITZ_DECLARE_METHOD)
#undef RITZ_DECLARE_METHOD

/** All of them in this order, ended by NULL. */
extern const ritz_method *const ritz_methods[];

/** Method called @p name; NULL and a sentence with the nearest if none. */
const ritz_method *ritz_method_find(const char *name);

/**
 * Whether a request for @p method may name @p engine: an engine for modes where
 * the method computes modes, one for Gramians where it does not, and
 * RITZ_ENGINE_AUTO always.
 */
bool ritz_engine_fits(const ritz_method *method, ritz_engine engine);

/**
 * Check a request against its method, before there is a component.
 *
 * @return RITZ_ERR_ARGUMENT if it names both a number of modes and a frequency,
 *         neither, or what the method does not use
 */
ritz_status ritz_request_check(const ritz_method *method,
                               const ritz_request *request);

/** The options of a request, "modes 12", as ritz_basis_make signs a basis with
 * them. */
void ritz_request_print(const ritz_request *request, char out[RITZ_NAME_SIZE]);

/** Make a basis and sign it with method, options and reference. */
ritz_status ritz_basis_make(const ritz_method *method,
                            const ritz_request *request, ritz_basis *out);

/*
 * Gramians, Hankel singular values and balancing. With
 *
 *     A W_c E' + E W_c A' + B B' = 0,    A' W_o E + E' W_o A + C' C = 0,
 *
 * W_c = Z_c Z_c' and W_o = Z_o Z_o', the Hankel values are the singular values
 * of Z_o' E Z_c. Only the factors are ever formed. Outputs that have a limit
 * are divided by it, so that values of different quantities can be compared.
 *
 * Four engines give them:
 *
 *     dense       of first-order form, by SLICOT; any damping; O(n^3)
 *     modal       closed form in modal coordinates; modal damping; O(m^2)
 *     low-rank    ADI on sparse M, D, K; damping that lets Gramians decay
 *     projection  closed form in rational Krylov vectors of sparse M and K,
 *                 with a bound of the error; D = a M + b K and discrete dampers
 *
 * [Moore1981], [Hammarling1982]
 */

/*
 * Of n states: those of a state space, or x = [u; u'] of a component, for which
 * n is twice its dofs and E = [I 0; 0 M].
 */
typedef struct ritz_gramians {
    ritz_dense Zc;      /* n x k */
    ritz_dense EZc;     /* n x k; {0}: E is the identity */
    ritz_dense Zo;      /* n x l */
    ritz_dense core[2]; /* core[1]'core[0] = Z_o'E Z_c with far fewer rows than
                           n, from which Hankel values cost less; {0}: not
                           known */
    ritz_dense T, W;    /* n x a, W'E T = I: the states of poles that are not
                        left of the axis (rigid modes: positions and then
                        velocities), decoupled and without Gramian */
    double residual[2]; /* of either equation, |R| / |B B'| and |R| / |C' C|,
                           if solved iteratively; 0: exact to rounding; its
                           norm: see ritz_gramians_of_component */
    double error;       /* projection: bound of the error of each Hankel value,
                           relative to the largest; 0: other engines have
                           none */
    char engine[RITZ_NAME_SIZE];     /* "SLICOT SB03OD", "closed form", "ADI" */
    char damping[RITZ_DAMPING_SIZE]; /* of a component, that was used */
} ritz_gramians;

/*
 * The order of a truncation and its bound: with sigma_1 .. sigma_m and r kept,
 * the H-infinity norm of the error is at most 2 sum_{k > r} sigma_k, each value
 * that repeats counted once.
 */
typedef struct ritz_balanced {
    int64_t count;   /* m Hankel values, of which rounding leaves these */
    double *sigma;   /* m, descending */
    int64_t kept;    /* r */
    ritz_dense T, W; /* n x r, W'E T = I, of the kept ones, best first */
    double bound;    /* 2 sum of the rest; rank decisions are not in it */
} ritz_balanced;

/**
 * Gramians of a state space with or without E, by dense matrices. Poles right
 * of the imaginary axis, or left of it by no more than eight times their
 * rounding error, are decoupled; none is if the model is provably stable in
 * spite of rounding. A symmetric definite E is reduced by its Cholesky factor
 * (SLICOT SB03OD); any other E is kept (SG03BD).
 *
 * @return RITZ_ERR_ARGUMENT if it has no states, no inputs or no outputs, or a
 *         limit is not positive; RITZ_ERR_FORMAT as ritz_state_space_check;
 *         RITZ_ERR_CONVERGENCE if poles that must be separated are too close
 * @cost   some 60 n^3, a third where A and E are symmetric, three times as much
 *         with SG03BD
 * @see    [Hammarling1982], [Penzl1998]
 */
ritz_status ritz_gramians_of_space(const ritz_state_space *model,
                                   ritz_gramians *out);

/**
 * Gramians of a state space by an engine: `dense` as above; `low-rank`, by ADI
 * with sparse factors, for models whose poles, except those at 0, are all left
 * of the imaginary axis; `projection`, by Galerkin's condition in the span of
 * ADI's columns, with the residual of that solution, for models of which E and
 * -(A + A') are definite; `auto`, which takes `dense` for a dense model, and
 * for a sparse one `low-rank` or, where ADI does not converge and the model is
 * small enough, `dense`.
 *
 * @param[in] band_hz  the two ends of a band, whose Gramians are found by
 *                     quadrature; NULL: all frequencies
 * @return RITZ_ERR_ARGUMENT also if the engine is `modal`, or is not `auto`
 *         over a band; RITZ_ERR_CONVERGENCE if the Gramians have no low rank
 */
ritz_status ritz_gramians_of_space_by(const ritz_state_space *model,
                                      ritz_engine engine, const double *band_hz,
                                      ritz_gramians *out);

/* The request for a component's Gramians. */
typedef struct ritz_gramians_request {
    const ritz_component *component; /* borrowed */
    ritz_damping damping;            /* added to matrices and dampers */
    ritz_engine engine;
    double among_hz;   /* modal: all modes up to here; 0: all there are */
    double band_hz[2]; /* modal: over this band alone; 0, 0: all frequencies */
    bool values_only;  /* projection: only Hankel values are wanted, so Zc, EZc
                          and Zo get no columns */
    int64_t most;      /* projection: limit of Krylov vectors; 0: as memory
                          allows */
    double tolerance;  /* low-rank: of the residual; 0: 1e-10; projection: of
                          the error of Hankel values and of both residuals;
                          0: 1e-8 */
} ritz_gramians_request;

/**
 * Of a component, by the engine that is asked for. `auto` is: modal where all
 * modes can be had and D couples none, dense up to RITZ_STATE_DOFS; beyond that
 * projection if D is a M + b K, with or without discrete dampers, otherwise
 * low-rank.
 *
 * `residual` is a norm of S R S', R the residual of an equation, relative to
 * that of its load. With low-rank, S is diagonal, so that squares of the rows
 * of S R are energies: 1/sqrt(M_ii) for momenta, and for displacements
 * sqrt(K_ii) (first equation) or for forces 1/sqrt(K_ii) (second); the norm is
 * the 2-norm. With projection, S weights whole vectors, and the norm is that of
 * Frobenius: |S (u, f)|^2 is u'M u + f'K_s^-1 f for displacements u and forces
 * f in the first equation; in the second, f'K_s^-1 f + w_0^2 g'K_s^-1 g for the
 * rows f of displacements and g of velocities. w_0 is the lowest angular
 * frequency, and K_s = K + mu M, mu = w_0^2 for a free body and 0 for others.
 *
 * @return RITZ_ERR_ARGUMENT if it has no inputs or no outputs, or the engine
 *         does not fit it; RITZ_ERR_CONVERGENCE if the rank grows too large
 */
ritz_status ritz_gramians_of_component(const ritz_gramians_request *request,
                                       ritz_gramians *out);

/**
 * Hankel values, to be freed, descending: singular values of Z_o' E Z_c, small
 * ones as accurate as the factors are; 0 stands for what is below eps^2 of the
 * largest.
 *
 * @see [Drmac1998]
 */
ritz_status ritz_gramians_hankel(const ritz_gramians *gramians, int64_t *count,
                                 double **sigma);

/**
 * Balance by square roots: Z_o'E Z_c = U S V', T = Z_c V S^-1/2,
 * W = Z_o U S^-1/2, cut to @p order, or where values fall below @p tolerance of
 * the largest, whichever is less (order -1: all). Equal values (relative gap
 * below 1e-6) are kept or dropped whole: the cut moves down. Values below
 * max(k, l) eps of the largest, and those whose directions rounding has taken,
 * are never kept nor counted.
 *
 * [Moore1981], [Tombs1987]
 */
ritz_status ritz_gramians_balance(const ritz_gramians *gramians, int64_t order,
                                  double tolerance, ritz_balanced *out);

/**
 * 2 sum of sigma_k, k = kept.., each value that repeats (relative gap below
 * 1e-9: no error tells such from equal ones) counted once.
 */
double ritz_hankel_bound(int64_t count, const double *sigma, int64_t kept);

void ritz_gramians_free(ritz_gramians *gramians);
void ritz_balanced_free(ritz_balanced *balanced);

/* Report of ritz_mode_acceleration(). */
typedef struct ritz_mode_accelerations {
    int64_t count;   /* quantities with mode acceleration */
    int64_t motions; /* rigid motions that the ports leave free */
    double rigid; /* largest |S R| / (|S||R|) of the rows of these quantities,
                        with R the rigid motions */
    char reason[4 * RITZ_NAME_SIZE]; /* why a quantity, the last of several, has
                                        no mode acceleration; "" */
} ritz_mode_accelerations;

/**
 * Add mode acceleration, that is Q, V, A, F and H, to the quantities of a
 * reduced component. It comes from a static solution of the full component in
 * which the dofs of the ports move by T q; where they leave a rigid motion
 * free, inertia relief balances the loads. Quantities of kind acceleration have
 * none, nor have quantities that change in a free rigid motion.
 *
 * @param[in] T        n x r, of the basis that made @p reduced
 * @param[in] ports    names, with commas between them, of ports on which forces
 *                     act that are no inputs; NULL: all, "": none
 * @param[in,out] reduced  has the quantities of the component; after a failure
 *                     some of them may have some of these matrices
 * @return RITZ_ERR_ARGUMENT if there are no quantities, no such port or sizes
 *         disagree; RITZ_ERR_SINGULAR as ritz_eigen_sparse, or if K is singular
 *         with its rigid motions held
 * @cost   one factor and 2 r solves, 3 r with a damping matrix
 * @see    [CraigKurdila2006]
 */
ritz_status ritz_mode_acceleration(const ritz_component *component,
                                   const ritz_dense *T, const char *ports,
                                   ritz_reduced *reduced,
                                   ritz_mode_accelerations *out);

#pragma GCC visibility pop

#endif
