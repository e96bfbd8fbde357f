/*
 * A system: components joined at one or several configurations.
 *
 * At a configuration the coordinates q of all components, one block after the
 * other, are q = P x with the joints' constraints C P = 0; x are the system's
 * own coordinates: its mass-normalised modes, rigid ones first, so that M = I
 * and K = diag(lambda).
 */
#ifndef RITZ_SYSTEM_H
#define RITZ_SYSTEM_H

#include <ritz/reduced.h>

#pragma GCC visibility push(default)

typedef struct ritz_configuration {
    char at[RITZ_NAME_SIZE]; /* "clock=60,cone=0" */
    int64_t num_settings;
    double *setting;  /* one for each sweep of the scene, in its order */
    int64_t rank;     /* of the constraints */
    ritz_dense K, M;  /* e x e */
    ritz_dense D, K4; /* e x e; {0}: none beside the damping of the system */
    ritz_dampers dampers; /* of all bodies; K and D hold them */
    double *lambda; /* e, ascending; by size where a dual assembly has negative
                       ones  [rad^2/s^2] */
    int64_t num_rigid;
    ritz_io io;           /* for e coordinates */
    int64_t num_blocks;   /* as many as there are components */
    ritz_dense *P;        /* num_blocks, r_c x e */
    ritz_dense momentum;  /* 6 x e, R'M P of all bodies, R the rigid motions
                             about the origin of the first body's basic frame;
                             {0}: not known of every body */
    double rigid[36];     /* R'MR, symmetric */
    ritz_measures errors; /* by ritz-verify or ritz-compare */
} ritz_configuration;

typedef struct ritz_system {
    char name[RITZ_NAME_SIZE];
    int64_t num_components;
    char (*component)[RITZ_NAME_SIZE];
    int64_t *order;      /* r_c of each */
    int64_t *order_full; /* n of each full component */
    int64_t num_sweeps;
    char (*sweep)[RITZ_NAME_SIZE];
    int64_t num_configurations;
    ritz_configuration *configuration;
    double band_hz[2];
    char damping[RITZ_DAMPING_SIZE]; /* as ritz_damping_parse reads */
    char units[RITZ_NAME_SIZE];
} ritz_system;

/**
 * The configuration that @p at names: "clock=60,slide=0.5", settings compared
 * within 1e-9; joints that are not named must have one setting only.
 * NULL @p at: the only configuration.
 *
 * @return RITZ_ERR_ARGUMENT listing what there is
 */
ritz_status ritz_system_find(const ritz_system *system, const char *at,
                             const ritz_configuration **out);

/** "clock=60,slide=0.5" from names and settings. */
void ritz_configuration_name(int64_t count, const char (*sweep)[RITZ_NAME_SIZE],
                             const double *setting, char out[RITZ_NAME_SIZE]);

/**
 * Change K and D to what the dampers are now: see ritz_dampers_install. lambda
 * stays what it was.
 */
ritz_status ritz_configuration_install(ritz_configuration *configuration);

void ritz_configuration_free(ritz_configuration *configuration);
void ritz_system_free(ritz_system *system);

#pragma GCC visibility pop

#endif
