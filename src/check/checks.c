/*
 * The list of checks. A row may say several things, which docs/check.md
 * and docs/methods/stability.md explain. Each uses what those before it left.
 */
#include "check/check.h"

enum { BOTH = RITZ_OF_REDUCED | RITZ_OF_STATES };

const ritz_check_row ritz_checks[] = {
    {RITZ_OF_COMPONENT, 0, ritz_check_values},
    {RITZ_OF_COMPONENT, 0, ritz_check_dofs},
    {RITZ_OF_COMPONENT, 0, ritz_check_mass_definite},
    {RITZ_OF_COMPONENT, RITZ_NEEDS_STIFFNESS, ritz_check_stiffness_definite},
    {RITZ_OF_COMPONENT, 0, ritz_check_geometry},
    {RITZ_OF_COMPONENT, RITZ_NEEDS_STIFFNESS, ritz_check_forces},
    {RITZ_OF_COMPONENT, 0, ritz_check_rigid},
    {RITZ_OF_COMPONENT, RITZ_NEEDS_STIFFNESS, ritz_check_grounding},
    {RITZ_OF_COMPONENT, 0, ritz_check_mass},
    {RITZ_OF_COMPONENT, RITZ_NEEDS_DAMPING, ritz_check_damping},
    {RITZ_OF_COMPONENT, RITZ_NEEDS_PORTS, ritz_check_ports},

    {RITZ_OF_REDUCED, 0, ritz_check_reduced_mass},
    {RITZ_OF_REDUCED, 0, ritz_check_reduced_stiffness},
    {RITZ_OF_REDUCED, RITZ_NEEDS_DAMPING, ritz_check_reduced_damping},
    {RITZ_OF_REDUCED, RITZ_NEEDS_STRUCTURAL, ritz_check_reduced_structural},
    {BOTH | RITZ_OF_SPARSE, 0, ritz_check_poles},
    {BOTH, 0, ritz_check_growth},
    {BOTH, 0, ritz_check_passivity},
    {BOTH, 0, ritz_check_locked},
    {BOTH, 0, ritz_check_sprung},
    {RITZ_OF_REDUCED, 0, ritz_check_joined},

    {RITZ_OF_COMPONENT | RITZ_OF_REDUCED, RITZ_NEEDS_LOADS,
     ritz_check_buckling},
    {0, 0, NULL},
};
