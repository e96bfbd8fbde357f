/*
 * Stand-ins for what the tools of fuzz_commands.c read and compute: sample
 * models, each named by one letter, and a refusal wherever a computation
 * begins. Up to there the tools read their command lines and the files that
 * these name.
 */
#include "cli/model.h"

#include "base/alloc.h"
#include "sample_quantities.h"
#include "samples.h"

#include <ritz/ranking.h>
#include <ritz/response.h>

#include <string.h>

/* NOLINTBEGIN(*-reserved-identifier, *-identifier-naming): the linker's */
ritz_status __wrap_model_read(cli_run *run, const char *path, int wanted,
                              model *out);
ritz_status __wrap_ritz_rank(const ritz_ranker *ranker,
                             const ritz_rank_request *request,
                             ritz_ranking *out);
ritz_status __wrap_ritz_responder_sample(void *responder, const void *grid,
                                         ritz_response *out);
ritz_status __wrap_ritz_responder_follow(void *responder, const void *grid,
                                         double tolerance, ritz_response *out);
const char *__wrap_ritz_responder_remark(const void *responder);
ritz_rounded __wrap_ritz_responder_rounded(const void *responder);
double __wrap_ritz_responder_uncertainty(const void *responder);

/* --- models --------------------------------------------------------------- */

static ritz_status sample_model(char letter, model *out)
{
    switch (letter) {
    case 'c':
        out->kind = MODEL_COMPONENT;
        return sample_component(true, &out->component);
    case 'b':
        out->kind = MODEL_BASIS;
        return sample_basis(&out->basis);
    case 'r':
        out->kind = MODEL_REDUCED;
        return sample_reduced(true, &out->reduced);
    case 's':
        out->kind = MODEL_SYSTEM;
        return sample_system(true, &out->system);
    case 'p':
        out->kind = MODEL_RESPONSE;
        return sample_response(&out->response);
    case 'k':
        out->kind = MODEL_RANKING;
        return sample_rankings(true, &out->rankings);
    case 'x':
        out->kind = MODEL_STATES;
        return sample_state_space(true, &out->states);
    case 't':
        out->kind = MODEL_SIMULATION;
        return sample_simulation(&out->simulation);
    case 'm':
        out->kind = MODEL_RECOVERED;
        return sample_recovered(&out->recovered);
    default:
        return ritz_fail(RITZ_ERR_FILE, "there are nine samples");
    }
}

ritz_status __wrap_model_read(cli_run *run, const char *path, int wanted,
                              model *out)
{
    (void)run;
    RITZ_REFUSE_IF(strlen(path) != 4 || strcmp(path + 1, ".h5") != 0,
                   RITZ_ERR_FILE, "there is no sample '%.40s'", path);
    RITZ_CHECK(sample_model(path[0], out));
    RITZ_REFUSE_IF(!(wanted & (int)out->kind), RITZ_ERR_FORMAT,
                   "the sample is of another kind");
    return RITZ_OK;
}

/* --- results -------------------------------------------------------------- */

/* A ranking of three modes, which keeps the table of their tracks short. */
ritz_status __wrap_ritz_rank(const ritz_ranker *ranker,
                             const ritz_rank_request *request,
                             ritz_ranking *out)
{
    enum { MODES = 3 };
    RITZ_OWN(ritz_rankings) all = {0};

    (void)request;
    RITZ_CHECK(sample_rankings(true, &all));
    RITZ_MOVE(*out, all.item[0]);
    RITZ_CHECK(ritz_name_copy(ranker->name, out->by));
    out->count = MODES;
    out->parts.nrow = MODES;
    for (int64_t k = 0; k < MODES; k++)
        out->order[k] = out->cluster[k] = k;
    return RITZ_OK;
}

ritz_status __wrap_ritz_responder_sample(void *responder, const void *grid,
                                         ritz_response *out)
{
    (void)responder;
    (void)grid;
    return sample_response(out);
}

ritz_status __wrap_ritz_responder_follow(void *responder, const void *grid,
                                         double tolerance, ritz_response *out)
{
    (void)tolerance;
    return __wrap_ritz_responder_sample(responder, grid, out);
}

const char *__wrap_ritz_responder_remark(const void *responder)
{
    (void)responder;
    return "";
}

ritz_rounded __wrap_ritz_responder_rounded(const void *responder)
{
    (void)responder;
    return (ritz_rounded){0};
}

double __wrap_ritz_responder_uncertainty(const void *responder)
{
    (void)responder;
    return 0.0;
}

/* A stand-in that does nothing and succeeds. */
#define PASSES(name)                                                           \
    ritz_status __wrap_##name(void);                                           \
    ritz_status __wrap_##name(void)                                            \
    {                                                                          \
        return RITZ_OK;                                                        \
    }
PASSES(ritz_component_install)
PASSES(ritz_responder_new)
PASSES(ritz_responder_or_direct)
PASSES(ritz_rank_request_of_configuration)
PASSES(ritz_rank_request_of_reduced)

#define REFUSES(name)                                                          \
    ritz_status __wrap_##name(void);                                           \
    ritz_status __wrap_##name(void)                                            \
    {                                                                          \
        return ritz_fail(RITZ_ERR_CONVERGENCE, "nothing is computed");         \
    }
REFUSES(ritz_audit_component)
REFUSES(ritz_audit_reduced)
REFUSES(ritz_audit_states)
REFUSES(ritz_basis_make)
REFUSES(ritz_closed_loop)
REFUSES(ritz_estimate)
REFUSES(ritz_fitter_new)
REFUSES(ritz_gramians_of_component)
REFUSES(ritz_gramians_of_space_by)
REFUSES(ritz_h2_of)
REFUSES(ritz_joint_neighbour)
REFUSES(ritz_placing_of)
REFUSES(ritz_recoverer_new)
REFUSES(ritz_reduce)
REFUSES(ritz_reduce_space)
REFUSES(ritz_reweigh)
REFUSES(ritz_scan_of)
REFUSES(ritz_simulate)
REFUSES(ritz_simulate_accurate)
REFUSES(ritz_simulate_cost)
REFUSES(ritz_singular_of)
REFUSES(ritz_spectrum_near)
REFUSES(ritz_spectrum_of)
REFUSES(ritz_stage_new)
REFUSES(ritz_tuning_of)
REFUSES(ritz_verify)
REFUSES(ritz_zeros_of)
/* NOLINTEND(*-reserved-identifier, *-identifier-naming) */
