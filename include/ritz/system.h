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

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#pragma GCC visibility push(default)

typedef struct ritz_configuration {
    char at[RITZ_NAME_SIZE]; /* "clock=60,cone=0" */
    int64_t num_settings;
    double *setting;  /* one for each sweep of the scene, in its order */
    int64_t rank;     /* of the constraints */
    ritz_dense K, M;  /* e x e */
    ritz_dense D, K4; /* e x e; {0}: no damping but ritz_system.damping */
    int64_t num_loads;
    ritz_reduced_load *load; /* e x e, of all bodies: "body:load" */
    ritz_dampers dampers;    /* of all bodies; K and D hold them */
    double *lambda; /* e, ascending; by |lambda| where a dual assembly has
                       negative eigenvalues  [rad^2/s^2] */
    int64_t num_rigid;
    ritz_io io;           /* for e coordinates */
    int64_t num_blocks;   /* as many as there are components */
    ritz_dense *P;        /* num_blocks, r_c x e */
    ritz_dense momentum;  /* 6 x e, R'M P of all bodies, R the rigid motions
                             about the origin of the first body's basic frame;
                             {0}: not known of every body */
    double rigid[36];     /* R'MR, symmetric */
    ritz_dense places;    /* num_blocks x 12: rotation R, row by row, and
                             translation t of each body, whose points x are at R
                             x + t; {0}: not known */
    ritz_measures errors; /* of ritz-verify or ritz-compare */
} ritz_configuration;

/* A component of a system: rows first .. first + order - 1 of q are its own. */
typedef struct ritz_block {
    char name[RITZ_NAME_SIZE];
    int64_t first, order; /* r_c */
    int64_t order_full;   /* n of the full component */
    bool turns;           /* in a time response: a joint turns it as it moves */
} ritz_block;

typedef struct ritz_system {
    char name[RITZ_NAME_SIZE];
    int64_t num_components;
    ritz_block *component;
    int64_t num_sweeps;
    char (*sweep)[RITZ_NAME_SIZE];
    int64_t num_configurations;
    ritz_configuration *configuration;
    double band_hz[2];
    char damping[RITZ_DAMPING_SIZE]; /* as ritz_damping_parse reads */
    char units[RITZ_NAME_SIZE];
    char spin[4 * RITZ_NAME_SIZE]; /* included in K, D and inputs: model,
                                      rad/s, axis; "": none */
} ritz_system;

/**
 * The configuration that @p at names, such as "clock=60,slide=0.5". Settings
 * are compared within 1e-9, and joints that are not named must have one setting
 * only. NULL @p at: the only configuration.
 *
 * @return RITZ_ERR_ARGUMENT if there is none; the sentence lists those that
 * exist
 */
ritz_status ritz_system_find(const ritz_system *system, const char *at,
                             const ritz_configuration **out);

/** "clock=60,slide=0.5" from names and settings. */
void ritz_configuration_name(int64_t count, const char *sweep, size_t stride,
                             const double *setting, char out[RITZ_NAME_SIZE]);

/**
 * Add the dampers, at their present values, to K and D: see
 * ritz_dampers_install. lambda does not change.
 */
ritz_status ritz_configuration_install(ritz_configuration *configuration);

/**
 * A system at one of its configurations, as a reduced component whose
 * coordinates are the modes of the system, rigid ones without stiffness. The
 * component has inputs, outputs, dampers, damping, mass properties and errors.
 * It has neither ports nor T, because shapes are those of the bodies.
 */
ritz_status ritz_reduced_of_configuration(const ritz_system *system,
                                          const ritz_configuration *at,
                                          ritz_reduced *out);

/**
 * Check that these are the bodies of a system, in its order: that the mass of
 * the system is sum_c P_c' M_c P_c.
 *
 * @return RITZ_ERR_ARGUMENT if they are not
 */
ritz_status ritz_system_check_bodies(const ritz_system *system,
                                     const ritz_configuration *at,
                                     const ritz_reduced *const *bodies);

/**
 * Add the ports of its bodies, with the names "body/port", to a system that is
 * linearised at a configuration. Their grids have the positions of the
 * configuration and the axes of the system. Numbers of grids of body k
 * (k = 0, 1, ...) are increased by k 10^d, where 10^d is above all numbers. A
 * port with only some directions of a grid keeps the axes of its body.
 *
 * @param[in,out] reduced  of ritz_reduced_of_configuration, without ports
 * @return RITZ_ERR_ARGUMENT as ritz_system_check_bodies, or if the system does
 *         not say where its bodies are
 */
ritz_status ritz_reduced_place_ports(const ritz_system *system,
                                     const ritz_configuration *at,
                                     const ritz_reduced *const *bodies,
                                     ritz_reduced *reduced);

void ritz_configuration_free(ritz_configuration *configuration);
void ritz_system_free(ritz_system *system);

#pragma GCC visibility pop

#endif
