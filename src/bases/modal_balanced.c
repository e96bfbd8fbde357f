/*
 * Modes, ranked by their importance from inputs to outputs: the largest exact
 * Hankel value of a mode by itself, or of a cluster of modes closer than 1e-6
 * in frequency [Moore1981]. A mode with a displacement output has
 *
 *     sigma_k = |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta)
 *
 * For lightly damped modes of well separated frequencies these are the Hankel
 * values of the whole model, and the best modes are its balanced states; for
 * close modes neither holds. The error is at most the response of the modes
 * that are left out, which is bounded by twice the sum of all Hankel values of
 * each cluster by itself.
 *
 * Modes coupled by damping are one cluster, too. Those that are left out then
 * act on those that are kept, and the error has no bound.
 */
#include "base/alloc.h"
#include "bases/columns.h"
#include "gramians/modes.h"
#include "model/pair.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* A cluster of modes, kept whole or left out whole. */
typedef struct mode_group {
    int64_t first, size; /* its first flexible mode, and its number of modes */
    double value;        /* Hankel value by which groups are ranked */
    double bound;        /* H-infinity bound of its response */
    bool keep;
} mode_group;

typedef struct subset_search {
    ritz_modal_model modes;
    ritz_modal modal;
    int64_t *cluster; /* cluster of each flexible mode, then of each rigid
                         mode */
    int64_t count;
    mode_group *groups; /* count, by frequency of their first mode */
    int64_t kept;       /* number of modes that are kept */
    double bound;       /* of the response of all modes left out; NaN: not
                           known */
} subset_search;

static void subset_search_free(subset_search *s)
{
    ritz_modal_model_free(&s->modes);
    ritz_modal_free(&s->modal);
    RITZ_FREE(s->cluster, s->groups);
}

static ritz_status find_ranked_modes(const ritz_request *request,
                                     const ritz_damping *damping,
                                     subset_search *s)
{
    const ritz_io *io = &request->component->io;
    const ritz_gramians_request all = {.component = request->component,
                                       .damping = *damping,
                                       .among_hz = request->choice.among_hz};

    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "the best modes are asked for by their number, not by a "
                   "frequency: --modes, and --among-hz says which to choose "
                   "from");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no modes are asked for, one at least is needed: --modes");
    RITZ_CHECK(ritz_ends_check("component", io->num_inputs, io->num_outputs,
                               io->limit, io->output));
    RITZ_CHECK(ritz_gramians_modes(&all, &s->modes));
    RITZ_CHECK(ritz_modal_of_modes(&s->modes, io, NULL, &s->modal));
    RITZ_CHECK_NEW(s->cluster, s->modal.count + s->modal.num_rigid);
    return ritz_coupled_clusters(&s->modal, s->cluster);
}

/* The largest Hankel value of a cluster of modes by itself, over the band if
   one is requested. */
static ritz_status rank_group(const ritz_request *request,
                              const subset_search *s, mode_group *at)
{
    bool banded = request->choice.given & RITZ_USES_BAND;
    int64_t all = s->modal.count + s->modal.num_rigid;
    RITZ_OWN(ritz_modal) part = {0};
    RITZ_OWN_ARRAY double *sigma = NULL;
    RITZ_OWN_ARRAY bool *taken = NULL;

    RITZ_CHECK_NEW(taken, all);
    for (int64_t k = 0; k < all; k++)
        taken[k] = s->cluster[k] == at->first;
    RITZ_CHECK(
        ritz_modal_part(&s->modal, taken, taken + s->modal.count, &part));
    RITZ_CHECK_NEW(sigma, ritz_modal_order(&part));
    RITZ_CHECK(ritz_modal_hankel(&part, NULL, sigma));
    for (int64_t k = 0; k < ritz_modal_order(&part); k++)
        at->bound += 2.0 * sigma[k];
    if (banded)
        RITZ_CHECK(ritz_modal_hankel(&part, request->choice.band_hz, sigma));
    at->value = sigma[0];
    at->size = part.count;
    return RITZ_OK;
}

static ritz_status rank_groups(const ritz_request *request, subset_search *s)
{
    RITZ_CHECK_NEW(s->groups, s->modal.count);
    for (int64_t k = 0; k < s->modal.count; k++) {
        mode_group *at = &s->groups[s->count];

        if (s->cluster[k] != k)
            continue;
        at->first = k;
        RITZ_CHECK(rank_group(request, s, at));
        s->count++;
    }
    return RITZ_OK;
}

/*
 * The group with the largest value that is not kept yet; of equal ones the one
 * with the lowest frequency.
 */
static mode_group *find_best(subset_search *s)
{
    mode_group *found = NULL;

    for (int64_t k = 0; k < s->count; k++) {
        mode_group *at = &s->groups[k];

        if (!at->keep && at->value > (found ? found->value : 0.0))
            found = at;
    }
    return found;
}

/*
 * Keep groups in descending order of value, until the next one does not fit or
 * has value zero.
 */
static ritz_status choose_groups(const ritz_request *request, subset_search *s)
{
    mode_group *next = find_best(s);

    RITZ_REFUSE_IF(!next, RITZ_ERR_ARGUMENT,
                   "no mode is both controllable and observable");
    RITZ_REFUSE_IF(
        next->size > request->modes, RITZ_ERR_ARGUMENT,
        "%" PRId64 " modes at %.6g Hz%s are one cluster, kept whole or "
        "not at all: ask for as many at least",
        next->size,
        ritz_eigen_hertz(s->modal.omega[next->first] *
                         s->modal.omega[next->first]),
        s->modal.Delta.val ? ", and others that damping joins," : "");
    for (; next && s->kept + next->size <= request->modes;
         next = find_best(s)) {
        next->keep = true;
        s->kept += next->size;
    }
    for (int64_t k = 0; k < s->count; k++)
        s->bound += s->groups[k].keep ? 0.0 : s->groups[k].bound;
    if (s->modal.Delta.val && s->kept < s->modal.count)
        s->bound = nan("");
    return RITZ_OK;
}

static void copy_mode(const subset_search *s, int64_t mode, int64_t column,
                      ritz_basis *basis)
{
    const ritz_dense phi = ritz_dense_part(&s->modes.Phi, mode, 1);

    ritz_dense_put(&phi, 0, column, &basis->T);
    basis->columns.hertz[column] = ritz_eigen_hertz(s->modes.lambda[mode]);
    if (mode < s->modes.num_rigid)
        ritz_columns_label_rigid(column, &basis->columns);
}

static double hertz_of(const subset_search *s, const mode_group *group)
{
    return ritz_eigen_hertz(s->modes.lambda[group->first + s->modes.num_rigid]);
}

/* Remark on the first pair of modes that the choice splits. */
static void add_tie(const subset_search *s, ritz_basis *basis)
{
    for (int64_t i = 0; i < s->count; i++)
        for (int64_t j = 0; j < s->count; j++) {
            const mode_group *kept = &s->groups[i], *left = &s->groups[j];
            const double hertz[] = {hertz_of(s, kept), hertz_of(s, left)};
            const double value[] = {kept->value, left->value};
            char text[RITZ_PAIR_SIZE];

            if (!kept->keep || left->keep || !ritz_is_pair(hertz, value))
                continue;
            ritz_pair_print(hertz, value, s->kept, text);
            ritz_remark_add(basis, "; ", "%s", text);
            return;
        }
}

static void add_choice(const ritz_request *request, const subset_search *s,
                       const ritz_damping *damping, ritz_basis *basis)
{
    char stated[RITZ_DAMPING_SIZE] = "";
    char among[RITZ_NAME_SIZE] = "";
    char less[RITZ_NAME_SIZE] = "";
    char bound[RITZ_NAME_SIZE] = "is not bounded, since damping couples modes";

    if (!isnan(s->bound))
        snprintf(bound, sizeof bound, "together is at most %.4g", s->bound);
    if (request->choice.among_hz > 0.0)
        snprintf(among, sizeof among, " up to %.6g Hz",
                 request->choice.among_hz);
    if (s->kept < request->modes)
        snprintf(less, sizeof less, " of %" PRId64 " asked for",
                 request->modes);
    ritz_damping_print(damping, stated);
    ritz_remark_add(basis, "; ",
                    "the best %" PRId64 " of %" PRId64
                    " modes%s%s; the response of the others %s; damping: %s",
                    s->kept, s->modal.count, among, less, bound,
                    stated[0] ? stated : "that of the matrices");
}

static bool is_kept(const subset_search *s, int64_t mode)
{
    int64_t k = 0;

    while (s->groups[k].first != s->cluster[mode])
        k++;
    return s->groups[k].keep;
}

static ritz_status make_modal_balanced(const ritz_request *request,
                                       ritz_basis *out)
{
    RITZ_OWN(subset_search) s = {0};
    RITZ_OWN(ritz_basis) basis = {0};
    ritz_damping damping = {0};
    int64_t column = 0;

    RITZ_CHECK(ritz_request_damping(request, &damping));
    RITZ_CHECK(find_ranked_modes(request, &damping, &s));
    RITZ_CHECK(rank_groups(request, &s));
    RITZ_CHECK(choose_groups(request, &s));
    RITZ_CHECK(
        ritz_basis_new(s.modes.num_dofs, s.modes.num_rigid + s.kept, &basis));
    for (; column < s.modes.num_rigid; column++)
        copy_mode(&s, column, column, &basis);
    for (int64_t k = 0; k < s.modal.count; k++)
        if (is_kept(&s, k))
            copy_mode(&s, s.modes.num_rigid + k, column++, &basis);
    snprintf(basis.origin.engine, sizeof basis.origin.engine,
             s.modal.Delta.val ? "SLICOT SB03OD" : "closed form");
    add_tie(&s, &basis);
    add_choice(request, &s, &damping, &basis);
    RITZ_MOVE(*out, basis);
    return RITZ_OK;
}

const ritz_method ritz_method_modal_balanced = {
    .name = "modal-balanced",
    .summary = "the modes that matter most from inputs to outputs",
    .reference = "Moore1981",
    .when = "light damping, few inputs and outputs, modes as coordinates",
    .cost = "all modes, or those up to a frequency; ranking O(m)",
    .holds = "kept modes, symmetry, stability; a bound of what is left out",
    .fails = "close modes: their values add up or cancel; static gain",
    .uses =
        RITZ_USES_MODES | RITZ_USES_DAMPING | RITZ_USES_AMONG | RITZ_USES_BAND,
    .make = make_modal_balanced,
};
