/*
 * A straight chain of 2-D Euler-Bernoulli frame elements with consistent mass:
 * the beam of [McDaniel2000] chapter 3, whose frequencies are published.
 */
#ifndef RITZ_TESTS_FRAME_H
#define RITZ_TESTS_FRAME_H

#include <ritz/component.h>

/* What the beam is made of, and where its first node lies. */
typedef struct frame_section {
    double rho;     /* mass density */
    double area;    /* of the cross section */
    double inertia; /* second moment of area */
    double modulus; /* Young's */
    double offset;  /* x of the first node */
} frame_section;

/** The beam of [McDaniel2000], eq. 3.2.26; elements are 0.5 long. */
extern const frame_section frame_mcdaniel;

/**
 * Beam of @p elements elements along x, grids first_grid, first_grid + 1, ...
 * at (offset + node * length_of_element, 0, 0), dofs 1, 2, 6 of each grid in
 * that order; those of clamped ends are left out, their grids are not. No ports,
 * inputs or outputs.
 */
ritz_status frame_component(int64_t elements, double length_of_element,
                            const frame_section *section, bool clamp_left,
                            bool clamp_right, int64_t first_grid,
                            ritz_component *out);

/**
 * Give the beam inputs: unit forces on some rows; and outputs: displacements
 * of some rows. Named u1, u2, ... and y1, y2, ...
 */
ritz_status frame_io(ritz_component *beam, int64_t num_inputs,
                     const int64_t *input_row, int64_t num_outputs,
                     const int64_t *output_row);

#endif
