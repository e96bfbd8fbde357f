/*
 * Every tolerance of the library, with its reason. A number in a comparison
 * anywhere else is a mathematical constant of that method, with its source.
 *
 * eps is 2^-52, the distance from 1 to the next larger double.
 */
#ifndef RITZ_BASE_TOLERANCES_H
#define RITZ_BASE_TOLERANCES_H

#define RITZ_PI 3.14159265358979323846

/* Subspaces and ranks */

/* Singular values below this part of the largest are rounding, where rows
   or columns were scaled to a norm of 1 first. */
#define RITZ_RANK_LOSS 1e-9
/* What orthogonalisation leaves of a vector, relative to its length: less
   is a combination of those before it. */
#define RITZ_DEPENDENT 1e-10
/* Frequencies, or eigenvalues, closer than this are one cluster: vectors
   within it are any mixture, so that it is kept, tracked and ranked whole. */
#define RITZ_CLUSTER_GAP 1e-6
/* A value must exceed another by this factor to be the larger one: ties go
   to the first, on every processor. */
#define RITZ_TIE (1.0 + 1e-9)
/* Entries of a null vector below this part of its largest do not name a
   mechanism. */
#define RITZ_NULL_VECTOR_SHARE 1e-6
/* Asymmetry of a matrix, relative to its largest entry, that rounding of
   its sums explains. */
#define RITZ_SYMMETRIC 1e-12

/* Assembly */

/* Gap of a closed loop over its size, and its turn: angles and positions in
   a scene are written with five digits or so. */
#define RITZ_LOOP_CLOSURE 1e-4
/* The same of placements that are products of a few rotations, each within
   eps of orthogonal: no gap at all. */
#define RITZ_PLACEMENT_ROUNDING 1e-13
/* Grids of two ports are paired within this part of the larger port: decks
   give positions with six digits. */
#define RITZ_PORT_MATCH 1e-5
/* The same of ports of one grid, which have no size: rounding of a position
   of the order of 1. */
#define RITZ_PORT_MATCH_LEAST 1e-12
/* Diagonal entries of a condensed matrix below this part of the largest are
   its rounding. */
#define RITZ_CONDENSED_ROUNDING 1e-13

/* Responses */

/* Frequencies of a grid closer than this, relative, are one point: their
   last digits differ by rounding. */
#define RITZ_SAME_POINT 1e-13
/* Points of a cubic closer than this, relative, are one: a cubic through
   two of them divides the rounding of H by their distance. */
#define RITZ_SAME_KNOT 1e-9
/* A step of the search for a minimum of |H| smaller than this part of the
   frequency is the last. */
#define RITZ_DIP_SETTLED 1e-9
/* An interval this short, relative to its frequency, is not halved: four
   times what is one knot. */
#define RITZ_SHORTEST_INTERVAL 4e-9
/* A frequency beyond the end of a range by this part of it lies in the
   range. */
#define RITZ_RANGE_ROUNDING 1e-12
/* A response was prepared up to this factor of the end of its range: ends
   are computed in other units than points. */
#define RITZ_RANGE_END (1.0 + 1e-9)
/* A pole without damping gets this ratio, so that it is a point of the
   grid, at which the responder says what is wrong. */
#define RITZ_LEAST_RATIO 1e-15
/* A channel whose peak is below this part of what its errors are relative
   to is rounding. */
#define RITZ_CHANNEL_HEARD 0.5
/* Between points an error is measured at the middle and at a quarter only:
   it is held to this part of the tolerance. */
#define RITZ_SAMPLED_MARGIN 0.5
/* The place of the second sample of an interval, beside its middle. */
#define RITZ_SAMPLED_AT 0.25
/* A channel that never exceeds this part of its level is rounding: rigid
   motions that cancel leave 1e-13, measured. */
#define RITZ_CHANNEL_ROUNDING 1e-12
/* Rounding of a response from one frequency to the next, relative to its
   level: 4 eps. */
#define RITZ_RESPONSE_GRAIN 0x1p-50
/* A channel below this part of the geometric mean of its row and column is
   rounding of these. */
#define RITZ_CHANNEL_LEAST 1e-9
/* Poles of full matrices are found to this factor of the end: those above
   bend the response less than its tolerance. */
#define RITZ_POLES_BEYOND 1.5
/* What engines that approximate hold themselves to where nothing is asked,
   relative to the largest |H|. */
#define RITZ_ENGINE_TOLERANCE 1e-9
/* A projection cannot be more exact than this: rounding of its inner
   products. Also what rounding leaves of the terms of a response. */
#define RITZ_PROJECTION_FLOOR 1e-13
/* The first point of a free body, over the end of the range: at rest its
   response is infinite. */
#define RITZ_ABOVE_REST 1e-4
/* Distance from an undamped pole, relative to its frequency, at which K -
   w^2 M can still be factored to four digits. */
#define RITZ_BESIDE_POLE 1e-4
/* The same of an expansion point, which needs the direction of the mode
   more than its digits. */
#define RITZ_BESIDE_MODE 1e-5
/* A node nearer than this to a pole or zero, relative, is on it. */
#define RITZ_NODE_CLEAR 1e-6
/* Of w^2: nearer to an undamped pole than this there is no response. */
#define RITZ_POLE_HIT 1e-12
/* Poles nearer than this, relative to |s|, are one. */
#define RITZ_SAME_POLE 1e-9
/* Of lambda_h, the first eigenvalue left out: what lambda_h - w^2 is taken
   for at least, so that a bound near it stays finite. */
#define RITZ_LEAST_GAP 0.02
/* An indicator is corrected by what was measured, at most by this factor. */
#define RITZ_MOST_AMPLIFIED 1e6
/* A correction that leaves more than this part of the error was the last. */
#define RITZ_CORRECTION_PAYS 0.3
/* Of |L|: an imaginary part below this is 0, and a sign that changes
   through infinity is no crossing. */
#define RITZ_REAL_CROSSING 1e-6
/* Bisection of a frequency ends where its interval is this part of it, some
   50 eps. */
#define RITZ_BISECTION_END 1e-14
/* How far a shift stays from a pole that was projected out, of its lambda:
   its own error is of this size or less, while the factor loses as many
   digits in a direction that does not count. */
#define RITZ_NUDGE 1e-9
/* The same of rigid motions, of the first flexible lambda. */
#define RITZ_NUDGE_AT_REST 1e-6
/* Sums of rounding come to this many eps, at most; 2 to 5 were measured. */
#define RITZ_SUMMED_ROUNDING 16.0
/* An eigenvalue of the stiffness below minus this part of the largest is no
   rounding; -3e-9 was seen of sound models. */
#define RITZ_NEGATIVE_STIFFNESS 1e-6
/* A product A N below this part of |A| |N| is rounding: A does not act on
   N. */
#define RITZ_NO_COUPLING 1e-12

/* COMPARE */

/* MAC from which on a mode of the next configuration is taken for the same
   mode. */
#define RITZ_TRACK_LIKE 0.5
/* A second candidate must be this much less like, or the track is a near-
   tie. */
#define RITZ_TRACK_CLEAR 0.1
/* Two modes of which each holds this much of the other turn within their
   plane; below it they cross. */
#define RITZ_TRACK_MIXED 0.05
/* Part of a plane of two modes that must stay in it for the two to have
   turned rather than changed. */
#define RITZ_TRACK_PLANE 0.9
/* What is left of a force without the part that pushes the body as a whole:
   less is rounding of that part. */
#define RITZ_FORCE_RELIEVED 1e-11
/* Singular values 60 dB below the mean are compared with the mean: nobody
   reads a plot there. */
#define RITZ_BODE_FLOOR 1e-3
/* A response over a band from 0 Hz starts at this part of its end. */
#define RITZ_BAND_START 1e-3
/* An eigenvalue of a dense pencil of order e is in error by up to e eps
   lambda_max; two are compared, and P and V add their own: this many times
   e eps lambda_max, measured 3 to 8. */
#define RITZ_EIGENVALUE_ROUNDING 20.0
/* A mass scaled to unit diagonal with a pivot below this counts as
   singular. */
#define RITZ_MASS_CONDITION 1e-12
/* Least relative length of a direction that rigid or kept modes add: rigid
   modes hold flexible motion of eps |P|'|K||P| / lambda, 1e-11 measured on
   frames of bars. */
#define RITZ_TIGHTEST_RIGID 1e-9
/* The same of static corrections of a system. */
#define RITZ_TIGHTEST_STATIC 1e-12
/* The same of static corrections of one body: to forces that depend on each
   other they differ by eps cond(K) of its solver. */
#define RITZ_TIGHTEST_BODY 1e-10
/* An error between listed angles below this asks for no further angle:
   nobody would see it in a plot. */
#define RITZ_SUGGEST_VISIBLE 1e-3
/* Nor does one below this many times the error at listed angles, where
   another angle would change nothing. */
#define RITZ_SUGGEST_FACTOR 10.0
/* Angles that differ by less, in degrees, are one: they are written with
   fewer digits. */
#define RITZ_SAME_ANGLE 1e-9

/* Bases */

/* A pole nearer to the real axis than this part of |s| is real. */
#define RITZ_POLE_REAL 1e-12
/* A mode without damping has its interpolation point at this ratio, lest
   the point be a pole. */
#define RITZ_LEAST_DECAY 1e-4
/* A mode at critical damping has its point at this part of w^2, not at 0. */
#define RITZ_LEAST_SQUARE 1e-2
/* Participation of a mode below this part of the largest of its kind is
   rounding. */
#define RITZ_LEAST_PARTICIPATION 1e-12
/* IRKA ends where its points change by less, relative: interpolation is
   exact where they stand, and an optimum is flat. */
#define RITZ_POINTS_SETTLED 1e-6
/* Above this condition three digits of what is measured are lost, and it is
   said. */
#define RITZ_SEREP_CONDITION 1e3
/* Rounding of a Gramian above this part of the least damping is not small. */
#define RITZ_LANCZOS_SMALL 1e-3
/* A pole must be left of the axis by this many times its rounding. */
#define RITZ_LANCZOS_SAFE 10.0
/* A pole may be off by this many times its first-order bound. */
#define RITZ_POLE_BOUND_FACTOR 8.0
/* What of a state is no rigid motion, relative: more is another motion. */
#define RITZ_RIGID_STATE 1e-6
/* Squares of norms whose difference is below this part of them are equal:
   some 400 eps for sums of thousands. */
#define RITZ_SQUARE_ROUNDING 1e-13
/* A column below this part of the largest is no motion of the body. */
#define RITZ_NO_MOTION 1e-12
/* Sweeps with a shifted factor end in rounding of eps lambda_max / lambda
   of the first mode left out, 5e-8 measured on a rotor of stiff bars, 1e-13
   on solids: a change of more than this is no convergence. */
#define RITZ_SWEEPS_UNSETTLED 1e-5
/* Sweeps end where the change is below this times sqrt(n), the rounding of
   a norm. */
#define RITZ_SWEEPS_SETTLED 1e-14
/* A residual mode below this part of what its load does, rigid motion
   included, is rounding: the load acts on a body that is rigid. */
#define RITZ_RESIDUAL_ROUNDING 1e-11
/* A shift below 0 as part of the first flexible eigenvalue: small enough to
   converge, large enough to keep digits of a free body. */
#define RITZ_SHIFT_OF_FIRST 1e-2
/* The same as part of K / M where no flexible mode is known. */
#define RITZ_SHIFT_OF_SIZE 1e-6
/* Forces that cancel to this part of what they were summed from are none. */
#define RITZ_CANCELLED_FORCE 1e-11

/* Rankings */

/* A coupling K_bn over sqrt(K_bb K_nn) above this: these are modes of
   another interface than the one that is held. */
#define RITZ_FOREIGN_INTERFACE 1e-6
/* Effective masses that sum to less than this part of the body: rigid modes
   carry what there is. */
#define RITZ_NO_MASS_SHARE 1e-9
/* Eigenvalues of the interface mass, of unit diagonal, below this part of
   the largest: motions that move no mass. */
#define RITZ_MASSLESS_INTERFACE 1e-12
/* A mode whose Gramian entry is below this part of the largest is rounding,
   and so is its coupling. */
#define RITZ_NEGLIGIBLE_GRAMIAN 1e-20
/* Part of the old weight that a reweighting keeps, which damps its
   oscillation. */
#define RITZ_OLD_WEIGHT 0.5
/* Weights, whose mean is 1, that differ by less are the same: reweighting
   has settled, or oscillates. */
#define RITZ_SAME_WEIGHTS 1e-9
/* Values of a ranking below this part of the largest are rounding, and so
   equal. */
#define RITZ_EQUAL_VALUES 1e-12

#endif
