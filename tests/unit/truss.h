/*
 * A plane truss of equal bays along x: two chords, posts and one diagonal a
 * bay, pin-jointed bars of one kind with consistent mass. Grids 1, 2 are the
 * lower and upper joint at x = 0, grids 3, 4 those at the end of the first bay,
 * and so on; each has directions 1 and 2.
 *
 *     2 --- 4 --- 6 --- 8
 *     |  /  |  /  |  /  |
 *     1 --- 3 --- 5 --- 7
 *
 * truss_free72: 17 bays, 72 dofs, free, three rigid modes in its plane; its
 * matrices are those of data/truss72. Cantilevers of 4 and 12 bays have 16 and
 * 48 dofs.
 */
#ifndef RITZ_TESTS_TRUSS_H
#define RITZ_TESTS_TRUSS_H

#include <ritz/component.h>

typedef struct truss_shape {
    int64_t bays;
    double bay, height; /* length of a bay, distance of the chords [m] */
    double EA, rhoA;    /* of every bar [N], [kg/m] */
    bool clamp_left;    /* joints at x = 0 are held: their dofs are left out */
    double tip_mass;    /* at each joint of the last post [kg] */
} truss_shape;

extern const truss_shape truss_free72, truss_cantilever16, truss_cantilever48;

/**
 * Without ports, inputs and outputs; positions are there.
 *
 * Dofs 0, 1 are directions 1, 2 of the first grid that is not held, 2, 3 those
 * of the next.
 */
ritz_status truss_component(const truss_shape *shape, ritz_component *out);

#endif
