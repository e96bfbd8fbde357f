/*
 * Assembly at a configuration: with the coordinates q of all bodies and the
 * joints' constraints C q = 0, any P of full column rank whose columns span
 * the null space of C gives
 *
 *     M_e = P'MP,   K_e = P'KP,   e = Q - rank(C)
 *
 * K and D those of the bodies and of the springs that joints hold.
 *
 * The system's modes Phi_e are put into P, so that its coordinates are modal.
 */
#include "assembly/assembly.h"

#include "base/alloc.h"
#include "base/team.h"
#include "base/tolerances.h"
#include "linear/blas_threads.h"
#include "linear/general.h"

#include <ritz/base.h>
#include <ritz/matrix.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sum of P_k' A_k P_k, A the matrix at an offset in each body; {0} if no body
   has it. */
static ritz_status project_bodies(const ritz_stage *stage, size_t offset,
                                  const ritz_dense *P, ritz_dense *sum)
{
    for (int64_t k = 0; k < stage->count; k++) {
        const void *at = (const char *)&stage->body[k] + offset;
        const ritz_dense *A = at;
        RITZ_OWN(ritz_dense) block = {0}, part = {0};

        if (!A->val)
            continue;
        if (!sum->val)
            RITZ_CHECK(ritz_dense_new(P->ncol, P->ncol, sum));
        RITZ_CHECK(
            ritz_dense_block(P, stage->first[k], A->ncol, 0, P->ncol, &block));
        RITZ_CHECK(ritz_dense_project(A, &block, &part));
        ritz_dense_add(1.0, &part, sum);
    }
    return RITZ_OK;
}

/* P_k'KG P_k of each load of each body. */
static ritz_status project_loads(const ritz_stage *stage, const ritz_dense *P,
                                 ritz_configuration *c)
{
    int64_t count = 0;

    for (int64_t k = 0; k < stage->count; k++)
        count += stage->body[k].num_loads;
    RITZ_CHECK_NEW(c->load, count);
    for (int64_t k = 0; k < stage->count; k++) {
        const ritz_reduced *body = &stage->body[k];
        RITZ_OWN(ritz_dense) block = {0};

        RITZ_CHECK(ritz_dense_block(P, stage->first[k], body->K.ncol, 0,
                                    P->ncol, &block));
        for (int64_t j = 0; j < body->num_loads; j++) {
            ritz_reduced_load *made = &c->load[c->num_loads++];

            RITZ_CHECK(ritz_body_load_name(stage->scene->component[k].name,
                                           body->load[j].name, made->name));
            RITZ_CHECK(
                ritz_dense_congruence(&body->load[j].KG, &block, &made->KG));
        }
    }
    return RITZ_OK;
}

/* K and M of the system, sums over bodies and springs. */
static ritz_status project_pencil(const ritz_stage *stage,
                                  const ritz_springs *springs,
                                  const ritz_dense *P, ritz_dense *K,
                                  ritz_dense *M)
{
    RITZ_CHECK(project_bodies(stage, offsetof(ritz_reduced, K), P, K));
    RITZ_CHECK(project_bodies(stage, offsetof(ritz_reduced, M), P, M));
    return ritz_springs_add(springs, false, P, K);
}

/*
 * Whether modes i and j have separate frequencies: not both rigid, nor of one
 * cluster.
 */
static bool are_separate(const double *lambda, int64_t rigid, int64_t i,
                         int64_t j)
{
    return (i >= rigid || j >= rigid) &&
           fabs(lambda[i] - lambda[j]) >
               RITZ_CLUSTER_GAP * fmax(fabs(lambda[i]), fabs(lambda[j]));
}

/*
 * The eigensolver has an error of eps lambda_max in every mode, which is large
 * for the low ones and mixes flexible motion into the rigid ones. K and M are
 * therefore projected again on the modes, each entry with its own rounding
 * only. Their differences from diag(lambda) and I correct P to first order, P
 * <- P (I + E):
 *
 *     E_ij = (K_ij - lambda_j M_ij) / (lambda_j - lambda_i),  modes apart,
 *     E_ij = -M_ij / 2 within a cluster,  E_jj = (1 - M_jj) / 2
 *
 * [OgitaAishima2018]. On return lambda holds the Rayleigh quotients.
 */
static ritz_status refine_modes(const ritz_stage *stage,
                                const ritz_springs *springs, int64_t rigid,
                                double *lambda, ritz_dense *P)
{
    int64_t e = P->ncol;
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, E = {0}, correction = {0};

    RITZ_CHECK(project_pencil(stage, springs, P, &K, &M));
    RITZ_CHECK(ritz_dense_new(e, e, &E));
    for (int64_t j = 0; j < e; j++)
        lambda[j] = ritz_dense_col(&K, j)[j] / ritz_dense_col(&M, j)[j];
    for (int64_t j = 0; j < e; j++)
        for (int64_t i = 0; i < e; i++) {
            double k = ritz_dense_col(&K, j)[i];
            double m = ritz_dense_col(&M, j)[i];

            ritz_dense_col(&E, j)[i] =
                i == j ? 0.5 * (1.0 - m)
                : are_separate(lambda, rigid, i, j)
                    ? (k - lambda[j] * m) / (lambda[j] - lambda[i])
                    : -0.5 * m;
        }
    RITZ_CHECK(ritz_dense_mul(P, &E, &correction));
    ritz_dense_add(1.0, &correction, P);
    return RITZ_OK;
}

/* The modes of the system with coordinates P, which becomes P Phi. */
static ritz_status make_modal(const ritz_stage *stage,
                              const ritz_springs *springs, ritz_dense *P,
                              ritz_configuration *c)
{
    RITZ_OWN(ritz_dense) K = {0}, M = {0}, Q = {0};
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK(project_pencil(stage, springs, P, &K, &M));
    RITZ_CHECK_IN("system modes", ritz_eigen_unchecked(&K, &M, &pairs));
    RITZ_CHECK(ritz_dense_mul(P, &pairs.Phi, &Q));
    for (int pass = 0; pass < 2; pass++)
        RITZ_CHECK(
            refine_modes(stage, springs, pairs.num_rigid, pairs.lambda, &Q));
    c->num_rigid = pairs.num_rigid;
    RITZ_MOVE(c->lambda, pairs.lambda);
    ritz_dense_replace(P, &Q);
    return RITZ_OK;
}

/* Name, settings, blocks, matrices and io of a configuration with modal P. */
static ritz_status fill_configuration(const ritz_stage *stage,
                                      const double *setting,
                                      const ritz_springs *springs,
                                      const ritz_dense *P,
                                      ritz_configuration *c)
{
    const ritz_scene *scene = stage->scene;

    RITZ_CHECK_COPY(c->setting, setting, scene->num_sweeps);
    c->num_settings = scene->num_sweeps;
    ritz_configuration_name(scene->num_sweeps, (const char *)scene->sweep,
                            sizeof *scene->sweep, setting, c->at);
    RITZ_CHECK_NEW(c->P, stage->count);
    for (int64_t k = 0; k < stage->count; k++) {
        c->num_blocks++;
        RITZ_CHECK(ritz_dense_block(P, stage->first[k], stage->body[k].K.ncol,
                                    0, P->ncol, &c->P[k]));
    }
    RITZ_CHECK(ritz_dense_identity(P->ncol, &c->M));
    RITZ_CHECK(ritz_dense_new(P->ncol, P->ncol, &c->K));
    for (int64_t j = 0; j < P->ncol; j++)
        ritz_dense_col(&c->K, j)[j] = c->lambda[j];
    RITZ_CHECK(project_bodies(stage, offsetof(ritz_reduced, D), P, &c->D));
    RITZ_CHECK(ritz_springs_add(springs, true, P, &c->D));
    RITZ_CHECK(project_bodies(stage, offsetof(ritz_reduced, K4), P, &c->K4));
    RITZ_CHECK(project_loads(stage, P, c));
    RITZ_CHECK(ritz_io_project(&stage->io, P, &c->io));
    RITZ_CHECK(ritz_dampers_project(&stage->dampers, P, &c->dampers));
    return ritz_place_configuration(stage, setting, c);
}

static ritz_status assemble_bodies(const ritz_stage *stage,
                                   const double *setting,
                                   ritz_configuration *out)
{
    RITZ_OWN(ritz_configuration) c = {0};
    RITZ_OWN(ritz_springs) springs = {0};
    RITZ_OWN(ritz_dense) C = {0}, P = {0};

    RITZ_CHECK(ritz_stage_constraints(stage, setting, stage->scale, &C));
    RITZ_CHECK(ritz_stage_springs(stage, setting, &springs));
    if (ritz_dual_is_due(stage)) {
        RITZ_CHECK(ritz_dual_assemble(stage, &springs, &C, &P, &c));
    } else {
        RITZ_CHECK(ritz_null_space(&C, &c.rank, &P));
        ritz_dense_scale_rows(stage->scale, &P);
        RITZ_CHECK(make_modal(stage, &springs, &P, &c));
    }
    RITZ_CHECK(fill_configuration(stage, setting, &springs, &P, &c));
    RITZ_MOVE(*out, c);
    return RITZ_OK;
}

ritz_status ritz_stage_assemble(const ritz_stage *stage, const double *setting,
                                ritz_configuration *out)
{
    const ritz_scene_spin *spin = &stage->scene->spin;
    RITZ_OWN(ritz_spun) spun = {0};

    if (!spin->given || spin->rate.course != RITZ_SPIN_CONSTANT)
        return assemble_bodies(stage, setting, out);
    RITZ_CHECK(ritz_stage_spun(stage, setting, &spun));
    return assemble_bodies(&spun.stage, setting, out);
}

/* Coordinates up to which threads work on a system each. Matrices are then
   smaller than the arrays that are compared with the limit of memory, and the
   BLAS hardly gains from several threads. */
enum { SMALL_STAGE = 360 };

int ritz_stage_threads(const ritz_stage *stage, int64_t count)
{
    return ritz_team_ready(stage->num_coordinates <= SMALL_STAGE ? count : 1);
}

int64_t ritz_stage_round(const ritz_stage *stage)
{
    const int threads = ritz_stage_threads(stage, RITZ_TEAM_SHARES);

    return threads > 1 ? ritz_team_shares(threads) : 1;
}

/* Systems at some settings. */
typedef struct some_systems {
    const ritz_stage *stage;
    const double *const *setting;
    ritz_configuration *out;
} some_systems;

static ritz_status assemble_item(int64_t k, void *task)
{
    const some_systems *s = task;

    return ritz_stage_assemble(s->stage, s->setting[k], &s->out[k]);
}

ritz_status ritz_stage_assemble_some(const ritz_stage *stage, int64_t count,
                                     const double *const *setting,
                                     ritz_configuration *out)
{
    const int threads = ritz_stage_threads(stage, count);
    some_systems some = {stage, setting, out};
    [[maybe_unused]] RITZ_OWN(ritz_blas_single) single = {0};

    if (threads > 1)
        single = ritz_blas_single_new();
    return ritz_team_try(threads, count, assemble_item, &some);
}

/* A system over all configurations of a scene. */

/* "consistent, 2 rad/s about (0 0 1) through (0 0 0)"; "" for a rate that
   changes, because the system is then that at rest. */
static void describe_spin(const ritz_scene_spin *spin,
                          char out[4 * RITZ_NAME_SIZE])
{
    const double *n = spin->axis, *c = spin->through;

    if (spin->given && spin->rate.course == RITZ_SPIN_CONSTANT)
        snprintf(out, (size_t)4 * RITZ_NAME_SIZE,
                 "%s, %.17g rad/s about (%.6g %.6g %.6g) through (%.6g %.6g "
                 "%.6g)",
                 ritz_spin_model_name(spin->model), spin->rate.value[0], n[0],
                 n[1], n[2], c[0], c[1], c[2]);
}

/* Names, orders, band and damping of the scene. */
static ritz_status label_system(const ritz_stage *stage, ritz_system *system)
{
    const ritz_scene *scene = stage->scene;

    memcpy(system->name, scene->name, sizeof system->name);
    memcpy(system->band_hz, scene->band_hz, sizeof system->band_hz);
    ritz_damping_print(&scene->damping, system->damping);
    describe_spin(&scene->spin, system->spin);
    if (stage->count > 0)
        memcpy(system->units, stage->body[0].units, sizeof system->units);
    RITZ_CHECK(ritz_stage_blocks(stage, &system->component));
    system->num_components = stage->count;
    for (int64_t k = 0; k < stage->count; k++)
        RITZ_REFUSE_IF(
            strcmp(stage->body[k].units, system->units) != 0, RITZ_ERR_ARGUMENT,
            "'%s' is in units '%s' and '%s' in '%s'", scene->component[0].name,
            system->units, scene->component[k].name, stage->body[k].units);
    RITZ_CHECK_NEW(system->sweep, scene->num_sweeps);
    system->num_sweeps = scene->num_sweeps;
    for (int64_t k = 0; k < scene->num_sweeps; k++)
        memcpy(system->sweep[k], scene->sweep[k].name, RITZ_NAME_SIZE);
    return RITZ_OK;
}

bool ritz_stop_asked(const ritz_stop *stop)
{
    return stop && stop->asked(stop->context);
}

/* All configurations until they are stopped. */
static ritz_status assemble_all(const ritz_stage *stage, const ritz_stop *stop,
                                ritz_system *system)
{
    const ritz_scene *scene = stage->scene;
    const int64_t all = scene->num_configurations;
    const int64_t most = ritz_stage_round(stage);
    RITZ_OWN_ARRAY const double **row = NULL;
    bool stopped = false;

    RITZ_CHECK_NEW(row, most);
    RITZ_CHECK_NEW(system->configuration, all);
    while (system->num_configurations < all && !stopped) {
        const int64_t first = system->num_configurations;
        int64_t k = first;

        for (; k < all && k < first + most && !stopped; k += !stopped) {
            stopped = k > 0 && ritz_stop_asked(stop);
            if (stopped)
                continue;
            ritz_monitor_step("configuration", k, all);
            row[k - first] = scene->setting + k * scene->num_sweeps;
        }
        system->num_configurations = k;
        RITZ_CHECK(ritz_stage_assemble_some(stage, k - first, row,
                                            &system->configuration[first]));
    }
    return RITZ_OK;
}

/* One configuration by its name. */
static ritz_status assemble_one(const ritz_stage *stage, const char *at,
                                ritz_system *system)
{
    const ritz_scene *scene = stage->scene;
    RITZ_OWN_ARRAY double *setting = NULL;

    RITZ_CHECK_NEW(setting, scene->num_sweeps);
    RITZ_CHECK_NEW(system->configuration, 1);
    ritz_monitor_step("configuration", 0, 1);
    RITZ_CHECK_IN("--at", ritz_scene_settings(scene, at, setting));
    system->num_configurations = 1;
    return ritz_stage_assemble(stage, setting, &system->configuration[0]);
}

/* One configuration by its name, or all until they are stopped. */
static ritz_status assemble_rows(const ritz_stage *stage, const char *at,
                                 const ritz_stop *stop, ritz_system *out)
{
    RITZ_OWN(ritz_system) system = {0};

    RITZ_CHECK(label_system(stage, &system));
    RITZ_CHECK(at ? assemble_one(stage, at, &system)
                  : assemble_all(stage, stop, &system));
    RITZ_MOVE(*out, system);
    return RITZ_OK;
}

ritz_status ritz_assemble(const ritz_stage *stage, const char *at,
                          ritz_system *out)
{
    return assemble_rows(stage, at, NULL, out);
}

ritz_status ritz_assemble_until(const ritz_stage *stage, const ritz_stop *stop,
                                ritz_system *out)
{
    return assemble_rows(stage, NULL, stop, out);
}
