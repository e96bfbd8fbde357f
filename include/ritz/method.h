/* Methods that make a basis: what they are asked, how to find one. */
#ifndef RITZ_METHOD_H
#define RITZ_METHOD_H

#include <ritz/basis.h>
#include <ritz/choice.h>
#include <ritz/component.h>
#include <ritz/state_space.h>

#pragma GCC visibility push(default)

/* What hangs on the attached dofs while modes are found, of their order. */
typedef struct ritz_neighbour {
    ritz_dense K, M; /* attached x attached, condensed [N/m], [kg]; {0}: none */
} ritz_neighbour;

/*
 * What is asked of a method. A method that needs more gets a field here, which
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
} ritz_request;

/* A request that asks for nothing yet. */
#define RITZ_REQUEST_NONE                                                      \
    {                                                                          \
        .modes = -1, .tolerance = 1e-10                                        \
    }

enum { RITZ_NAMED_FOR_COMPONENTS = 1, RITZ_NAMED_FOR_SCENES = 2 };

typedef struct ritz_method {
    const char *name;      /* as typed on the command line */
    const char *summary;   /* one line for --list */
    const char *reference; /* key in docs/references.bib */
    /* what a newcomer chooses by, a line of --list each: for which components,
       at what cost, what is guaranteed, where it fails */
    const char *when, *cost, *holds, *fails;
    int uses;       /* RITZ_USES_... */
    int only_named; /* ritz-fit tries it only where it is named: sum of
                       RITZ_NAMED_FOR_... */
    /** @return RITZ_ERR_ARGUMENT, RITZ_ERR_SINGULAR or RITZ_ERR_CONVERGENCE */
    ritz_status (*make)(const ritz_request *request, ritz_basis *out);
} ritz_method;

/** All methods, ended by NULL. */
extern const ritz_method *const ritz_methods[];

extern const ritz_method ritz_method_balanced;
extern const ritz_method ritz_method_balanced_band;
extern const ritz_method ritz_method_balanced_position;
extern const ritz_method ritz_method_balanced_velocity;
extern const ritz_method ritz_method_craig_bampton;
extern const ritz_method ritz_method_dual_craig_bampton;
extern const ritz_method ritz_method_full;
extern const ritz_method ritz_method_guyan;
extern const ritz_method ritz_method_inertia_relief;
extern const ritz_method ritz_method_irs;
extern const ritz_method ritz_method_krylov;
extern const ritz_method ritz_method_krylov_cms_fixed;
extern const ritz_method ritz_method_krylov_cms_free;
extern const ritz_method ritz_method_krylov_damped;
extern const ritz_method ritz_method_lanczos_one_sided;
extern const ritz_method ritz_method_lanczos_two_sided;
extern const ritz_method ritz_method_loaded_interface;
extern const ritz_method ritz_method_macneal;
extern const ritz_method ritz_method_macneal_rubin;
extern const ritz_method ritz_method_modal_balanced;
extern const ritz_method ritz_method_normal_modes;
extern const ritz_method ritz_method_rigid;
extern const ritz_method ritz_method_rubin;
extern const ritz_method ritz_method_serep;
extern const ritz_method ritz_method_tangential;

/** Method called @p name; NULL and a sentence with the nearest if none. */
const ritz_method *ritz_method_find(const char *name);

/**
 * Say whether a request makes sense to a method, before there is a component.
 *
 * @return RITZ_ERR_ARGUMENT if it names both a number of modes and a frequency,
 *         neither, or what the method does not use
 */
ritz_status ritz_request_check(const ritz_method *method,
                               const ritz_request *request);

/** Make a basis and sign it with method, options and reference. */
ritz_status ritz_basis_make(const ritz_method *method,
                            const ritz_request *request, ritz_basis *out);

#pragma GCC visibility pop

#endif
