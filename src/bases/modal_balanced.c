/*
 * Modes, ranked by their importance from inputs to outputs: the largest exact
 * Hankel value that a mode has alone, or a cluster of modes closer than 1e-6 in
 * frequency [Moore1981],
 *
 *     sigma_k = |b||c| / (4 zeta w^2) (sqrt(1 + zeta^2) + zeta)
 *
 * with a displacement output. Of lightly damped modes far apart these are the
 * Hankel values of the whole, and the best modes its balanced states; of close
 * ones they are not. The error is at most the response of all modes that are
 * left out: twice the sum of all values of each cluster alone.
 */
#include "base/alloc.h"
#include "bases/balance_asked.h"
#include "gramians/cluster.h"
#include "gramians/engines.h"
#include "gramians/modal_modes.h"

#include <ritz/matrix.h>

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Modes that are kept whole or not at all. */
typedef struct mode_group {
    int64_t first, last; /* flexible modes first .. last - 1 */
    double value;        /* by which it is ranked */
    double bound;        /* of what it answers alone */
    bool keep;
} mode_group;

typedef struct subset_search {
    ritz_gramians_request asked;
    ritz_modal_model modes;
    ritz_modal modal;
    int64_t count;
    mode_group *groups; /* by frequency */
    int64_t kept;       /* modes */
    double bound;       /* of all that is left out */
} subset_search;

static void release_search(subset_search *s)
{
    ritz_modal_model_free(&s->modes);
    ritz_modal_free(&s->modal);
    free(s->groups);
}

static ritz_status check_request(const ritz_request *request)
{
    const ritz_io *io = &request->component->io;

    RITZ_REFUSE_IF(request->up_to_hz > 0.0, RITZ_ERR_ARGUMENT,
                   "the best modes are asked for by their number, not by a "
                   "frequency: among-hz says which to choose from");
    RITZ_REFUSE_IF(request->modes < 1, RITZ_ERR_ARGUMENT,
                   "no modes are asked for, one at least is needed");
    RITZ_REFUSE_IF(io->num_inputs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no inputs: no mode can be reached");
    RITZ_REFUSE_IF(io->num_outputs == 0, RITZ_ERR_ARGUMENT,
                   "the component has no outputs: no mode can be seen");
    for (int64_t i = 0; i < io->num_outputs; i++)
        RITZ_REFUSE_IF(io->limit[i] <= 0.0, RITZ_ERR_ARGUMENT,
                       "output '%s' has the limit %g, which is not positive",
                       io->output[i], io->limit[i]);
    return RITZ_OK;
}

static ritz_status find_modes(const ritz_request *request, subset_search *s)
{
    const ritz_choice *choice = &request->choice;
    ritz_coupling coupling = {0};

    s->asked = (ritz_gramians_request){.component = request->component,
                                       .engine = RITZ_ENGINE_MODAL,
                                       .among_hz = choice->among_hz};
    RITZ_CHECK(ritz_request_damping(request, &s->asked.damping));
    RITZ_CHECK(ritz_gramians_modes(&s->asked, &s->modes));
    if (ritz_modes_coupled(&s->modes, &coupling))
        RITZ_CHECK(ritz_coupling_refuse(
            &coupling, "modes are ranked one by one: take 'balanced'"));
    return ritz_modal_of_modes(&s->modes, &request->component->io, &s->modal);
}

/* The value of modes first .. last - 1 alone; over a band, if there is one. */
static ritz_status weigh_modes(const subset_search *s, const double *band,
                               double *sigma, mode_group *at)
{
    RITZ_OWN(ritz_modal) part = {0};

    RITZ_CHECK(ritz_modal_part(&s->modal, at->first, at->last, &part));
    RITZ_CHECK(ritz_modal_hankel(&part, sigma));
    for (int64_t k = 0; k < 2 * part.count; k++)
        at->bound += 2.0 * sigma[k];
    if (band)
        RITZ_CHECK(ritz_modal_hankel_band(&part, band, sigma));
    at->value = sigma[0];
    return RITZ_OK;
}

static ritz_status rank_groups(const ritz_request *request, subset_search *s)
{
    bool banded = request->choice.given & RITZ_USES_BAND;
    const double *band = banded ? request->choice.band_hz : NULL;
    RITZ_OWN_ARRAY double *sigma = NULL;
    int64_t last = 0;

    RITZ_CHECK_NEW(sigma, 2 * s->modal.count);
    RITZ_CHECK_NEW(s->groups, s->modal.count);
    for (int64_t first = 0; first < s->modal.count; first = last) {
        mode_group *at = &s->groups[s->count++];

        last = ritz_modal_cluster(&s->modal, first);
        *at = (mode_group){.first = first, .last = last};
        RITZ_CHECK(weigh_modes(s, band, sigma, at));
    }
    return RITZ_OK;
}

/*
 * The best group that is not kept yet; of equal ones the lowest in frequency.
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
 * Choose the best groups first, until the next one does not fit or has value
 * zero.
 */
static ritz_status choose_groups(const ritz_request *request, subset_search *s)
{
    mode_group *next = find_best(s);

    RITZ_REFUSE_IF(!next, RITZ_ERR_ARGUMENT,
                   "inputs reach no mode that outputs see");
    RITZ_REFUSE_IF(next->last - next->first > request->modes, RITZ_ERR_ARGUMENT,
                   "%" PRId64
                   " modes at %.6g Hz are one cluster, kept whole or "
                   "not at all: ask for as many at least",
                   next->last - next->first,
                   ritz_eigen_hertz(s->modal.omega[next->first] *
                                    s->modal.omega[next->first]));
    for (; next && s->kept + next->last - next->first <= request->modes;
         next = find_best(s)) {
        next->keep = true;
        s->kept += next->last - next->first;
    }
    for (int64_t k = 0; k < s->count; k++)
        s->bound += s->groups[k].keep ? 0.0 : s->groups[k].bound;
    return RITZ_OK;
}

static void copy_mode(const subset_search *s, int64_t mode, int64_t column,
                      ritz_basis *basis)
{
    bool rigid = mode < s->modes.num_rigid;

    memcpy(ritz_dense_col(&basis->T, column),
           ritz_dense_col(&s->modes.Phi, mode),
           (size_t)basis->T.nrow * sizeof *basis->T.val);
    basis->columns.kind[column] =
        rigid ? RITZ_COLUMN_RIGID : RITZ_COLUMN_NORMAL;
    basis->columns.hertz[column] =
        rigid ? 0.0 : ritz_eigen_hertz(s->modes.lambda[mode]);
}

static void add_remark(const ritz_request *request, const subset_search *s,
                       ritz_basis *basis)
{
    char damping[RITZ_DAMPING_SIZE] = "";
    char text[2 * RITZ_DAMPING_SIZE];
    char among[RITZ_NAME_SIZE] = "";
    char less[RITZ_NAME_SIZE] = "";

    if (s->asked.among_hz > 0.0)
        snprintf(among, sizeof among, " up to %.6g Hz", s->asked.among_hz);
    if (s->kept < request->modes)
        snprintf(less, sizeof less, " of %" PRId64 " asked for",
                 request->modes);
    ritz_damping_print(&s->asked.damping, damping);
    snprintf(text, sizeof text,
             "the best %" PRId64 " of %" PRId64
             " modes%s%s; the others together answer at most %.4g; "
             "damping: %s",
             s->kept, s->modal.count, among, less, s->bound,
             damping[0] ? damping : "that of the matrices");
    ritz_remark_append(basis, text);
}

static ritz_status make_modal_balanced(const ritz_request *request,
                                       ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    subset_search s = {0};
    ritz_basis basis = {0};
    int64_t column = 0;

    RITZ_TRY(check_request(request));
    RITZ_TRY(find_modes(request, &s));
    RITZ_TRY(rank_groups(request, &s));
    RITZ_TRY(choose_groups(request, &s));
    RITZ_TRY(
        ritz_basis_new(s.modes.num_dofs, s.modes.num_rigid + s.kept, &basis));
    for (; column < s.modes.num_rigid; column++)
        copy_mode(&s, column, column, &basis);
    for (int64_t k = 0; k < s.count; k++)
        for (int64_t j = s.groups[k].first;
             j < s.groups[k].last && s.groups[k].keep; j++)
            copy_mode(&s, s.modes.num_rigid + j, column++, &basis);
    snprintf(basis.origin.engine, sizeof basis.origin.engine, "closed form");
    add_remark(request, &s, &basis);
    RITZ_MOVE(*out, basis);
done:
    release_search(&s);
    ritz_basis_free(&basis);
    return status;
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
