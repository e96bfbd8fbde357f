/*
 * Every tolerance of the library, with its reason. A number in a comparison
 * anywhere else is a mathematical constant of that method, with its source.
 *
 * eps is 2^-52, the distance from 1 to the next larger double. "Relative" is to
 * the larger of what is compared.
 */
#ifndef RITZ_BASE_TOLERANCES_H
#define RITZ_BASE_TOLERANCES_H

#define RITZ_PI 3.14159265358979323846
/* (sqrt(5) - 1) / 2: a bracket that is divided so keeps one of its points. */
#define RITZ_GOLDEN 0.61803398874989485

/* Everywhere */

/* A value below this part of the largest of its kind is rounding: some
   thousand terms were summed, and rigid motions that cancel leave 1e-13. */
#define RITZ_NEGLIGIBLE 1e-12
/* Numbers closer than this, relative or in degrees, are one: they are written
   with fewer digits, or computed in two ways. */
#define RITZ_SAME 1e-9
/* A value must exceed another by this factor to be the larger one: ties go to
   the first, on every processor. */
#define RITZ_TIE (1.0 + 1e-9)
/* Frequencies, or eigenvalues, closer than this are one cluster: vectors
   within it are any mixture, so that it is kept, tracked and ranked whole. */
#define RITZ_CLUSTER_GAP 1e-6
/* Asymmetry of a matrix, relative to its largest entry, that rounding of its
   sums explains. */
#define RITZ_SYMMETRIC 1e-12
/* A stiffening that was made for a spin about a point is of an axis that passes
   it by this part of the size of the body: it is then wrong by about as much. */
#define RITZ_SPIN_AWAY 1e-6
/* A body is rigid if the mass matrix of its rigid motion is its M, to this part
   of the largest entry: both are sums over all grids. */
#define RITZ_SPIN_RIGID 1e-8
/* Largest rate of a spin, rad/s: its square times any mass stays finite, and no
   structure in any units turns faster. */
#define RITZ_SPIN_FASTEST 1e15
/* Largest coordinate of a point of its axis, in units of length, for the same
   reason. */
#define RITZ_SPIN_FARTHEST 1e15
/* A scale that would be 0 is this, so that it divides. */
#define RITZ_LEAST_SCALE 1e-300

/* Subspaces and ranks */

/* Singular values below this part of the largest are rounding, where rows or
   columns were scaled to a norm of 1 first. */
#define RITZ_RANK_LOSS 1e-9
/* Relative length after orthogonalisation below which a vector depends on
   those before it. */
#define RITZ_DEPENDENT 1e-10
/* Eigenvalue, or reciprocal condition, of a Gram matrix of unit columns below
   which they depend on each other to six digits. */
#define RITZ_SQUARED_DEPENDENT 1e-12
/* Reciprocal condition, rows scaled, below which half of the digits of a
   solution are lost: such a matrix is not divided out. */
#define RITZ_WELL_CONDITIONED 1e-8
/* Root of eps. A sine, or a singular value relative to the largest, below it
   is decided by positions that keep less than half of their digits. */
#define RITZ_HALF_DIGITS 1.5e-8
/* Entries of a null vector below this part of its largest do not name a
   mechanism. */
#define RITZ_NULL_VECTOR_SHARE 1e-6

/* In a row of stresses the terms of a rigid motion cancel. If the terms have
   seven digits, as in OUTPUT4 of single precision, a row of a thousand of them
   leaves a few 1e-6 of the sum of their absolute values. */
#define RITZ_RIGID_ROW 1e-5

/* Assembly */

/* Gap and turn of a closed loop, over its size: a scene gives angles and
   positions with five digits or so. */
#define RITZ_LOOP_CLOSURE 1e-4
/* An axis in a loop is meant to lock it if it is off by a larger angle, in rad,
   from a direction with which the loop can move. */
#define RITZ_AXIS_NEAR 1e-2
/* Largest relative residual, to first order, after axes are turned to release a
   loop; terms of second order are about RITZ_AXIS_NEAR of it. */
#define RITZ_AXIS_LEFT 0.05
/* Two turns of axes that differ by less than this factor are equal. */
#define RITZ_AXIS_TIE 1.01
/* An axis that turns by less than this part of another is as good as exact. */
#define RITZ_AXIS_SHARE 0.01
/* The gap that products of a few rotations leave, each within eps of
   orthogonal. */
#define RITZ_PLACEMENT_ROUNDING 1e-13
/* Grids of two ports are paired within this part of the larger port: decks
   give positions with six digits. */
#define RITZ_PORT_MATCH 1e-5
/* Ports of one grid have no size: rounding of a position of about 1. */
#define RITZ_PORT_MATCH_LEAST 1e-12
/* Diagonal entries of a condensed matrix below this part of the largest are
   its rounding. */
#define RITZ_CONDENSED_ROUNDING 1e-13

/* A basis over the setting of a joint is interpolated so well that a mode is
   off by this part of it, in the mass norm: its energy by the square. */
#define RITZ_SWEPT_ERROR 1e-7
/* Bases at two settings next to each other, of which a direction turns by more
   than 60 degrees, are not continuous. */
#define RITZ_SWEPT_OVERLAP 0.5
/* The setting at which a mode leaves a band is found to this part of the
   range. */
#define RITZ_SWEPT_CHANGE 1e-4
/* A run warns if a basis leaves out a larger share of the initial state: 3 % of
   the amplitude. */
#define RITZ_SWEPT_LOST 1e-3
/* A run is refused if a basis spans a smaller share of the initial state, as
   nothing would move: 0.1 % of the amplitude. */
#define RITZ_SWEPT_LEFT 1e-6
/* An input whose static response a basis leaves out by more than this share
   hardly acts: most of its effect is missing. Local flexibility next to an
   input stays below. */
#define RITZ_SWEPT_LOST_FORCE 0.5
/* Rotations at two pairs of settings give one axis and a whole turn. */
#define RITZ_SWEPT_AXIS 1e-6

/* Responses */

/* Frequencies of a grid closer than this, relative, are one point: their last
   digits differ by rounding. */
#define RITZ_SAME_POINT 1e-13
/* Points of a cubic closer than this, relative, are one: a cubic through two
   of them divides the rounding of H by their distance. */
#define RITZ_SAME_KNOT 1e-9
/* An interval this short, relative to its frequency, is not halved: four times
   the distance of two knots. */
#define RITZ_SHORTEST_INTERVAL 4e-9
/* A frequency beyond the end of a range by this part of it is in the range. */
#define RITZ_RANGE_ROUNDING 1e-12
/* A response was prepared up to this factor of the end of its range: ends are
   computed in other units than points. */
#define RITZ_RANGE_END (1.0 + 1e-9)
/* A pole without damping gets this ratio, so that it is a point of the grid,
   at which the responder says what is wrong. */
#define RITZ_LEAST_RATIO 1e-15
/* A channel whose peak is below this part of what its errors are relative to
   is rounding. */
#define RITZ_CHANNEL_HEARD 0.5
/* Between points an error is measured at the middle, and at this part of the
   interval, only: it is held to RITZ_SAMPLED_MARGIN of the tolerance. */
#define RITZ_SAMPLED_AT     0.25
#define RITZ_SAMPLED_MARGIN 0.5
/* Rounding of a response from one frequency to the next, relative to its
   level: 4 eps. */
#define RITZ_RESPONSE_GRAIN 0x1p-50
/* A channel below this part of the geometric mean of its row and column is
   rounding of these. */
#define RITZ_CHANNEL_LEAST 1e-9
/* Poles of full matrices are found to this factor of the end: those above bend
   the response less than its tolerance. */
#define RITZ_POLES_BEYOND 1.5
/* Error, relative to the largest |H|, that engines that approximate hold
   themselves to unless another is asked for. */
#define RITZ_ENGINE_TOLERANCE 1e-9
/* Rounding of inner products: a projection cannot be more exact, nor the terms
   of a response. */
#define RITZ_PROJECTION_FLOOR 1e-13
/* The first point of a free body, over the end of the range: at rest its
   response is infinite. */
#define RITZ_ABOVE_REST 1e-4
/* Distance from an undamped pole, relative to its frequency, at which K - w^2 M
   can still be factored to four digits. */
#define RITZ_BESIDE_POLE 1e-4
/* An expansion point needs the direction of a mode more than its digits. */
#define RITZ_BESIDE_MODE 1e-5
/* A node nearer than this to a pole or zero, relative, is on it. */
#define RITZ_NODE_CLEAR 1e-6
/* Of w^2: nearer to an undamped pole than this there is no response. */
#define RITZ_POLE_HIT 1e-12
/* Least lambda_h - w^2, of lambda_h, the first eigenvalue left out, so that a
   bound near it stays finite. */
#define RITZ_LEAST_GAP 0.02
/* An indicator is corrected by measured errors by this factor at most. */
#define RITZ_MOST_AMPLIFIED 1e6
/* A correction that leaves more than this part of the error was the last. */
#define RITZ_CORRECTION_PAYS 0.3
/* Of |L|: an imaginary part below this is 0, and a sign that changes through
   infinity is no crossing. */
#define RITZ_REAL_CROSSING 1e-6
/* Interval, relative to its frequency, at which bisection ends: 50 eps. */
#define RITZ_BISECTION_END 1e-14
/* Distance of a shift from an eigenvalue, relative: the matrix can be factored
   there. A pole that was projected out is itself in error by as much, and the
   digits that the factor loses are in a direction that does not count. */
#define RITZ_NUDGE 1e-9
/* Distance of a shift from rigid motions, of the first flexible lambda. */
#define RITZ_NUDGE_AT_REST 1e-6
/* Sums of rounding come to this many eps at most; 2 to 5 were measured. */
#define RITZ_SUMMED_ROUNDING 16.0
/* An eigenvalue of the stiffness below minus this part of the largest is no
   rounding; sound models have -3e-9, measured. */
#define RITZ_NEGATIVE_STIFFNESS 1e-6

/* Nominal value of a state, relative to its largest response to a unit step.
   Integrators bound the local error relative to the nominal value, and local
   errors add up to some hundred times one of them: measured on accelerations of
   a rotor. */
#define RITZ_NOMINAL_SHARE 0x1p-8

/* Comparison of models */

/* MAC from which on two modes are the same mode. */
#define RITZ_SAME_MODE 0.5
/* Bodies belong to a system if the sum of their masses, in its coordinates,
   differs from the system's mass matrix by less than this part of its largest
   entry. */
#define RITZ_SAME_MASS 1e-6
/* A track is nearly a tie unless the second candidate's MAC is less by this. */
#define RITZ_TRACK_CLEAR 0.1
/* Two modes of which each has this MAC with the other turn within their plane;
   below it they cross. */
#define RITZ_TRACK_MIXED 0.05
/* Part of a plane of two modes that must stay in it for the two to have turned
   rather than changed. */
#define RITZ_TRACK_PLANE 0.9
/* A force without its resultant, or a response without rigid motion, below this
   part of the whole is rounding of it: the body is rigid, or pushed as one. */
#define RITZ_FORCE_RELIEVED 1e-11
/* Singular values 60 dB below the mean are compared with the mean: a plot does
   not show them. */
#define RITZ_BODE_FLOOR 1e-3
/* A response over a band from 0 Hz starts at this part of its end. */
#define RITZ_BAND_START 1e-3
/* Largest relative change of a flexible response by rounding of the rigid
   stiffness at the start of a band, unless a tolerance is given. */
#define RITZ_START_ROUNDING 1e-3
/* An eigenvalue of a dense pencil of order e is in error by up to e eps
   lambda_max; two are compared, and P and V add their own: this many times
   e eps lambda_max, measured 3 to 8. */
#define RITZ_EIGENVALUE_ROUNDING 20.0
/* A mass of unit diagonal with a pivot below this is singular. */
#define RITZ_MASS_CONDITION 1e-12
/* Least relative length of a direction that rigid or kept modes add: rigid
   modes hold flexible motion of eps |P|'|K||P| / lambda, 1e-11 measured on
   frames of bars. */
#define RITZ_TIGHTEST_RIGID 1e-9
/* ... that static corrections of a system add. */
#define RITZ_TIGHTEST_STATIC 1e-12
/* ... that those of one body add: to forces that depend on each other they
   differ by eps cond(K) of its solver. */
#define RITZ_TIGHTEST_BODY 1e-10
/* No further angle is suggested for an error between listed angles below this,
   which a plot does not show, or below RITZ_SUGGEST_FACTOR times the error at
   listed angles, where another angle changes nothing. */
#define RITZ_SUGGEST_VISIBLE 1e-3
#define RITZ_SUGGEST_FACTOR  10.0

/* Bases */

/* A pole nearer to the real axis than this part of |s| is real. */
#define RITZ_POLE_REAL 1e-12
/* A mode without damping has its interpolation point at this ratio, lest the
   point be a pole. */
#define RITZ_LEAST_DECAY 1e-4
/* A mode at critical damping has its point at this part of w^2, not at 0. */
#define RITZ_LEAST_SQUARE 1e-2
/* IRKA ends where its points change by less, relative: interpolation is exact
   where they stand, and an optimum is flat. */
#define RITZ_POINTS_SETTLED 1e-6
/* Condition above which SEREP says that three digits of measured shapes are
   lost. */
#define RITZ_SEREP_CONDITION 1e3
/* Rounding of a Gramian above this part of the least damping is not small. */
#define RITZ_LANCZOS_SMALL 1e-3
/* Relative residual of a low-rank Gramian whose inverse scales the Lanczos
   vectors: the residual is divided by the square of the smallest value kept. */
#define RITZ_LANCZOS_RESIDUAL 1e-13
/* A pole must be left of the axis by this many times its rounding. */
#define RITZ_LANCZOS_SAFE 10.0
/* A pole may be off by this many times its first-order bound. */
#define RITZ_POLE_BOUND_FACTOR 8.0
/* Part of a state that is no rigid motion, relative, above which the state is
   another motion. */
#define RITZ_RIGID_STATE 1e-6
/* Squares of norms whose difference is below this part of them are equal: some
   400 eps for sums of thousands. */
#define RITZ_SQUARE_ROUNDING 1e-13
/* Sweeps with a shifted factor end in rounding of eps lambda_max / lambda of
   the first mode left out, 5e-8 measured on a rotor of stiff bars, 1e-13 on
   solids: a change of more than this is no convergence. */
#define RITZ_SWEEPS_UNSETTLED 1e-5
/* Sweeps end where the change is below this times sqrt(n), the rounding of a
   norm. */
#define RITZ_SWEEPS_SETTLED 1e-14
/* A shift below 0 as part of the first flexible eigenvalue: small enough to
   converge, large enough to keep digits of a free body. */
#define RITZ_SHIFT_OF_FIRST 1e-2
/* Residual modes use the factor of the search for modes if its shift is between
   the first part of the first flexible eigenvalue and the second part of the
   first eigenvalue that is left out. With a smaller shift the solves for a free
   body lose digits; with a larger one sweeps cost more than another factor. */
#define RITZ_SHIFT_LENT_LEAST 1e-5
#define RITZ_SHIFT_LENT_MOST  0.05
/* ... as part of K / M where no flexible mode is known. */
#define RITZ_SHIFT_OF_SIZE 1e-6

/* Rankings */

/* A coupling K_bn over sqrt(K_bb K_nn) above this: these are modes of another
   interface than the one that is held. */
#define RITZ_FOREIGN_INTERFACE 1e-6
/* Effective masses that sum to less than this part of the body: rigid modes
   carry all of it. */
#define RITZ_NO_MASS_SHARE 1e-9
/* A mode whose Gramian entry is below this part of the largest is rounding, and
   so is its coupling. */
#define RITZ_NEGLIGIBLE_GRAMIAN 1e-20
/* Part of the old weight that a reweighting keeps, which damps its
   oscillation. */
#define RITZ_OLD_WEIGHT 0.5

/* Linear algebra */

/* An entry of a product below this part of the same product in magnitudes is
   rounding: 64 eps. */
#define RITZ_SUM_ROUNDING 0x1p-46
/* Asymmetry that a few sums of products leave: 8 eps. A matrix within it is
   taken as symmetric, which saves work and digits. */
#define RITZ_SYMMETRIC_SUMS 0x1p-49
/* Relative error of a pole that Arnoldi iterations found: a hundred times the
   residual at which they stop. */
#define RITZ_POLE_FOUND 1e-10
/* If 0 is a pole, the expansion point moves onto the real axis: to this part of
   |A| / |E|, which is above the rounding that makes A - s E singular, and
   further by the second factor as long as A - s E stays singular. */
#define RITZ_SHIFT_ASIDE   1e-10
#define RITZ_SHIFT_FARTHER 1e2
/* Convergence of ARPACK: eigenvalues err by its square. */
#define RITZ_ARNOLDI_SETTLED 1e-12
/* An eigenvalue at an end of the spectrum of A x = theta B x is accepted if its
   residual and the rounding of B change it by at most this, relatively. This is
   a bound: a column of 1000 elements has the bound 1e-3, the error 1.5e-4. */
#define RITZ_END_ERROR 1e-4
/* Rounding of x'K x, relative to lambda, above which pairs are computed again
   with sums of twice the digits. Rounding below this leaves errors of up to
   half of it, with any shift: residuals |lambda K^-1 M x - x| / |x| of 1e-10
   are promised, and a response at a relative distance d of w^2 from a mode has
   the error of the eigenvalue divided by d. A free bar of 700 elements, with
   rounding of 4.4e-11, had errors of 2e-12 or 1.5e-11, depending on the shift,
   and of 2e-10 in a response with d = 0.07. The first mode of a solid of
   163,000 dofs has less than this. */
#define RITZ_DIGITS_FEW 2e-11
/* Relative residual at which Krylov-Schur and block Lanczos of engine slepc
   have converged. Vectors become more accurate by one inverse iteration. */
#define RITZ_KRYLOV_SETTLED 1e-10
/* A Ritz pair of block Lanczos has converged if |A^-1 M x - theta x| is at most
   this part of theta |x|, norms by M. The vectors returned are more accurate,
   by one inverse iteration. */
#define RITZ_LANCZOS_SETTLED 1e-10
/* Rounding of eigenvalues that a count of ritz-fit compares, in multiples of
   eps lambda_max: some hundred sums of terms of that size. */
#define RITZ_SCREEN_ROUNDING 1e2
/* The k-th largest eigenvalue of a band matrix is found within this, relative,
   to have its eigenvector: neighbours are some 1 / k apart. */
#define RITZ_KTH_WITHIN 1e-7
/* The same as RITZ_LANCZOS_SETTLED if eigenvalues are requested to a relative
   accuracy: this part of its
   square root. The error of an eigenvalue is about the square of the residual
   divided by the relative distance to the eigenvalues that are not found, and
   only the last pairs have residuals as large as this. For 500 modes of a solid
   and an accuracy of 1e-4 the bound was a twentieth of it. */
#define RITZ_ACCURACY_SETTLED 0.5
/* If the bound exceeds the accuracy requested, the search is repeated, and
   pairs have converged at this part of the former residual. */
#define RITZ_ACCURACY_FINER 1e-2
/* The range of accuracies that can be requested. Bounds of errors have rounding
   errors of some 1e-12, which are then far below the accuracy. Eigenvalues with
   errors of more than 1e-2 are of no use. */
#define RITZ_ACCURACY_LEAST 1e-8
#define RITZ_ACCURACY_MOST  1e-2
/* Cholesky factor of the inner products of a block: a pivot that is a smaller
   part of its diagonal entry x'M x means that x depends on the vectors before
   it, within 1e-3 of its length. Such blocks are
   orthonormalised vector by vector, because the pivot has lost six digits. */
#define RITZ_GRAM_DEPENDENT 1e-6
/* A vector without its components along a basis that is shorter than this part
   of what it was consists of rounding errors of the sums over all rows: it has
   no direction of its own. */
#define RITZ_NO_DIRECTION 1e-13
/* A vector of length one that was made orthogonal to a basis keeps its length
   when this is done once more. If it becomes shorter than this, it consists of
   rounding errors. */
#define RITZ_MOSTLY_LEFT 0.5
/* Entries of a vector this near to its largest are as large: the first of them
   gives the sign, on every processor. */
#define RITZ_LIKE_LARGEST 1e-9
/* Rounding that scaling may add, over that of the matrices as given. */
#define RITZ_FRAME_GROWTH 1e4
/* An eigenvalue of a dense pencil below this part of the largest has lost three
   digits and more, and is found again among its like. */
#define RITZ_EIGEN_FAR_BELOW 1e-3
/* Residual of a sparse eigenpair after inverse iteration: a larger one is
   refused. */
#define RITZ_EIGEN_RESIDUAL 1e-11
/* Point within a gap of eigenvalues where modes below it are counted, if the
   middle of the gap is an eigenvalue. */
#define RITZ_COUNT_PLACE 0.3
/* Modes up to a frequency are counted this far above its lambda, relative. If a
   mode lies there, the next value is tried. */
#define RITZ_COUNT_ABOVE                                                       \
    {                                                                          \
        1e-8, 1e-7, 3e-7                                                       \
    }
/* Two eigenvalues closer than this part of the largest one found are both
   rounding, and modes are not counted between them: 64 eps, as for rigid modes.
   Relative to each other computed zeros may be far apart. */
#define RITZ_COUNT_ROUNDING 0x1p-46
/* A mode this close to the value below which modes were counted, relative, may
   have been counted or not: rounding is eps times the largest eigenvalue, which
   is up to 1e-10 of a low one. A tenth of the least of RITZ_COUNT_ABOVE. */
#define RITZ_COUNT_UNCLEAR 1e-9
/* A mode this close above the end of a range, relative in lambda, is in it. */
#define RITZ_SPAN_ROUNDING 1e-8
/* Backward error of a factor of an indefinite matrix, relative, above which
   another shift is taken: 1e-14 is usual, and residuals of 1e-11 need 1e-12. */
#define RITZ_SIGNED_ERROR 1e-12
/* Largest relative error of eigenvalues by substructures. Material data and the
   mesh cause larger errors in most models. */
#define RITZ_AMLS_ERROR 1e-4
/* Rounding of theta = 1 / (lambda - sigma) is 1e-15 of the largest theta after
   substructures are condensed: below this part of it, theta has fewer than four
   digits. */
#define RITZ_AMLS_DIGITS 1e-11
/* Modes of substructures are kept up to so many times the last eigenvalue to be
   found: measured, see docs/methods/eigen.md. */
#define RITZ_AMLS_CUTOFF 6.0
/* Lanczos with a random vector ends where beta is below this part of the first
   alpha: the next vector would be rounding. */
#define RITZ_DENSITY_END 1e-13
/* Least gap between two slices of the spectrum, relative to the eigenvalue.
   Vectors of two slices are then orthogonal to 1e-6, their residuals divided by
   this gap, and one projection makes them orthogonal to rounding. */
#define RITZ_BORDER_GAP 1e-4
/* Largest cosine between vectors of two slices, before the projection that
   leaves its square. Above it the vectors are not accurate. */
#define RITZ_BORDER_COSINE 1e-6
/* Distance of a shift from a cluster below it, relative to the eigenvalue, if
   no other eigenvalue is known. */
#define RITZ_BEHIND_CLUSTER 1e-2
/* If the factor at a shift is singular, the distance of the shift from the last
   slice is multiplied by this. */
#define RITZ_SHIFT_ASTRAY 0.93
/* First shift below 0, at most this part of the median of K_jj / M_jj, and the
   least part of that which is taken where a low frequency asks for less. */
#define RITZ_FIRST_SHIFT 1e-5
#define RITZ_LEAST_SHIFT 1e-6
/* First shift of a body that is l elements long, times l^4, and of a body that
   does not bend, over (k / n)^(2/3) of k modes and n dofs: see first_shift.c.
   Of free solids of 11k and 55k dofs the 50th eigenvalue was 3e4 and 8e4 times
   the shift, of a plate of 43k dofs 1e3 times; frequencies were the same to
   1e-14 with a shift twenty times larger. */
#define RITZ_FIRST_BENDING 0.5
#define RITZ_FIRST_LEAST   3e-6
/* A shift this many times the first flexible eigenvalue blurs it: another is
   taken. */
#define RITZ_SHIFT_BLURRED 1e3
/* A rigid motion whose stiffness is below this part of the first flexible
   eigenvalue is free: half of the digits of a double are beyond it. */
#define RITZ_FREE_MOTION 1e-8
/* Eigenvalues of a free body below this part of the largest may be rigid: a
   matrix written with ten digits leaves them there. */
#define RITZ_RIGID_DIGITS 1e-9
/* A pivot of a matrix of unit diagonal above this hides no eigenvalue of the
   size of rounding, and a column with it is independent of those before. */
#define RITZ_PIVOT_STRONG 1e-3
/* A pivot this many times above the rounding of the products of columns that it
   is made of is that of an independent column. The rounding is a bound: on a
   plate what it bounds was a hundred thousand times smaller. */
#define RITZ_PIVOT_ROUNDING 1e1
/* No pivot of a first block below this is strong, however small the rounding. */
#define RITZ_PIVOT_CLEAR 1e-8
/* |Q'WQ - I| of which the square, which the next pass leaves, is rounding. */
#define RITZ_NEARLY_NORMAL 1e-8
/* Smallest eigenvalue of a definite matrix of unit diagonal that is not
   rounding: eps, measured in test_factor.c. */
#define RITZ_SINGULAR_SPD 0x1p-52
/* Smallest |H y| / |y| of rows scaled to one that is not rounding: 4 eps. */
#define RITZ_SINGULAR_LDL 0x1p-50
/* Rounding of each entry of a column after all sums of an orthogonalisation, in
   eps. */
#define RITZ_ENTRY_ROUNDING 100.0
/* A change with less than this part of the energy of a column does not cancel
   its digits. */
#define RITZ_SMALL_CHANGE 1e-2
/* Energy of a column, over that of its rounding, from which directions that
   rounding has left in it change products of columns by 1e-12 at most. */
#define RITZ_CLEAR_OF_ROUNDING 1e12
/* Square of eps: a squared norm below this part of another is 0. */
#define RITZ_NEGLIGIBLE_SQUARE 0x1p-104
/* A peak below this part of the highest is not followed between points. */
#define RITZ_PEAK_WORTH 0.5
/* A bracket of a peak, or of a dip, this short, relative to its upper end, is
   done: the curve is flat there to the square of it. */
#define RITZ_PEAK_PLACED 1e-9
/* A peak is infinite, for want of damping, if it grows by RITZ_PEAK_GROWTH
   while its bracket shrinks from RITZ_PEAK_LATE to RITZ_PEAK_SHARP. */
#define RITZ_PEAK_SHARP  1e-10
#define RITZ_PEAK_LATE   1e-8
#define RITZ_PEAK_GROWTH 1.5

/* Modal models and states */

/* Relative share of motions without mass that a shifted solve leaves where
   they have none. */
#define RITZ_MASSLESS_SHARE 1e-8
/* A loose motion is known to eps over the gap RITZ_HALF_DIGITS: a row that has
   more than this part of it depends on it. */
#define RITZ_LOOSE_PART 1e-6
/* Sine of the angle between the two axes of a joint below which they are
   parallel: scenes give axes with six digits. */
#define RITZ_PARALLEL_AXES 1e-6

/* Gramians */

/* Hankel values whose relative gap is below this count once in the bound. Two
   of one sign with the gap g need in one channel a pole g^2 / 16 of the others:
   below this it is rounding, above it both count, as the error of such a system
   is the sum of both. */
#define RITZ_HANKEL_REPEATED 1e-9
/* Largest relative gap between the last value kept and the first left out at
   which the two can be states of one mode: these have values in the ratio 1 - 2
   zeta, here with zeta = 0.05. modal-balanced also uses the number as the
   smallest ratio of the values of two modes of close frequencies that form a
   pair. */
#define RITZ_HANKEL_PAIR 0.1
/* Distance of W'E T from I up to which a value still has a direction. */
#define RITZ_BALANCED_DEFECT 0.1
/* Residual of a low-rank Gramian, if none is asked for. */
#define RITZ_ADI_TOLERANCE 1e-10
/* Default bound of the error of Hankel values of engine projection, relative to
   the largest value. */
#define RITZ_PROJECTION_TOLERANCE 1e-8
/* A shift is added to the space of engine projection if the largest residual of
   a static solution is above this part of the tolerance: the residuals of both
   Lyapunov equations were 1 to 100 times as large (measured). */
#define RITZ_PROJECTION_SHIFT 1e-3
/* A Krylov vector is orthogonalised again if less than this part of its energy
   is left: it has then lost 99 % of its length, and with it two digits of
   orthogonality. */
#define RITZ_PROJECTION_KEPT 1e-4
/* A Krylov vector depends on those before it if orthogonalisation leaves less
   than this part of its length; a combination of vectors of one block is
   nothing if its energy is less than this part of theirs. */
#define RITZ_PROJECTION_DEPENDENT 1e-12
/* As soon as the residual of ADI is below this multiple of the tolerance,
   engine projection also solves the equation in the span of ADI's columns: the
   residual of that solution was from twice to some thousand times smaller
   (measured). */
#define RITZ_GALERKIN_LEAD 1e4
/* A load without its rigid motion below this part, squared, is rounding: there
   is nothing flexible to iterate on. */
#define RITZ_ADI_NOTHING 1e-24
/* Columns of a factor below this part of the longest are dropped. */
#define RITZ_SHORT_COLUMN 1e-14
/* Bytes that one factor may take: three of them stay below 4 GiB. */
#define RITZ_FACTOR_BYTES 1.4e9
/* Rigid motion that sparse products leave, of the same product in magnitudes,
   where there is none. */
#define RITZ_RIGID_LOAD 1e-10
/* Points of first-order tangential interpolation have settled when their
   relative change is below this: the H2 error, which is stationary there, then
   changes by the square. */
#define RITZ_SPACE_POINTS_SETTLED 1e-4
/* Relative difference of the coarse and the fine quadrature rule of a panel,
   below which the panel is not divided: the fine rule is then exact to
   rounding, and Hankel values to half of the digits. */
#define RITZ_BAND_QUADRATURE 1e-9
/* An imaginary part below this of the real one makes a shift real. */
#define RITZ_SHIFT_REAL 1e-3
/* Least |Re p| / |p| of a shift that can be told from none: 64 eps. */
#define RITZ_SHIFT_DAMPED 0x1p-46
/* Damping between two modes, relative to the geometric mean of their own, above
   which they are coupled: the closed forms err by its square. */
#define RITZ_DAMPING_COUPLES 1e-6
/* Damping between two modes, relative to the geometric mean of their own, above
   which both are ranked as one cluster: at close frequencies, the value of a
   mode alone, damped by its own damping, errs by about this part. */
#define RITZ_DAMPING_JOINS 0.1
/* A pole nearer to 0 than this part of the lowest frequency, and not left of
   the axis by more than its rounding, belongs to rigid motion at 0. */
#define RITZ_POLE_AT_REST 1e-6
/* Expansion point on the positive real axis from which poles at 0 are found,
   relative to |s| of the next pole: far above the square root of rounding by
   which double poles err, and near enough for an iteration to gain a digit. */
#define RITZ_ZERO_POLE_SHIFT 0.05
/* Part of that point at which the response of the other poles is taken for that
   at 0: it differs by the square, 3e-7. */
#define RITZ_ZERO_POLE_BESIDE 0.01
/* Roundings of a band Gramian, relative to the magnitudes it sums: 8 eps. */
#define RITZ_BAND_ROUNDING 0x1p-49
/* Up to this ratio a mode is eliminated as a whole: eigenvectors of its two
   poles are no better than its block. */
#define RITZ_NEARLY_CRITICAL 1.001

/* Poles, zeros and norms */

/* Backward error of LAPACK's eigensolvers, in eps. What the middle of a
   symmetric structure observes of modes that are zero there, measured: 0.1 to
   1.8 times the first-order bound with 1 for it, of rows of 5 to 767 masses and
   clamped beams of 4 to 128 elements. */
#define RITZ_BACKWARD_ERROR 8.0
/* A gain below this part of its error is rounding. */
#define RITZ_NO_GAIN 1e-14
/* A modal matrix with smaller entries, against its diagonal, is diagonal: the
   error is of its square. */
#define RITZ_DIAGONAL_WITHIN 1e-9
/* ... against the largest entry of all: rounding of its projection. */
#define RITZ_DIAGONAL_ROUNDING 1e-15
/* A mode whose participation in all channels is below this part of the product
   of the largest is not controllable and observable. */
#define RITZ_UNOBSERVED 1e-10
/* D is a M + b K up to this part of |D|: more than rounding leaves of matrices
   in text of few digits. */
#define RITZ_PROPORTIONAL_WITHIN 1e-6
/* A step of inverse iteration this small, of |s|, is the last. */
#define RITZ_REFINED 1e-12
/* A step, or the term of a series, below this that no longer shrinks is the
   last too: slow poles of stiff models err by eps |K| / |s|. */
#define RITZ_REFINED_NEARLY 1e-6
/* The series of modes that are left out is good to this part of the whole
   response at the end of the range. */
#define RITZ_SERIES_WITHIN 1e-12
/* A change of a term of that series this small, of its largest value, is the
   last. */
#define RITZ_SERIES_SETTLED 1e-14
/* A change below this part of the whole response does not alter it: eps / 2. */
#define RITZ_SERIES_NEGLIGIBLE 0x1p-53
/* Shift below 0 of that series, of the last eigenvalue that is kept: a step
   then shrinks by 100. */
#define RITZ_SERIES_SHIFT 0.01
/* A shift below this part of the largest K_jj / M_jj is lost in the rounding
   of K. */
#define RITZ_SHIFT_LOST 1e-10
/* The correction for ratios of modes above the sum is accurate when it changes
   by less than this part of the largest |H| while its space is doubled. */
#define RITZ_RATIO_SETTLED 1e-9
/* Uncertainty of that correction, relative to the largest |H|, above which the
   user is told of it. */
#define RITZ_RATIO_UNCERTAIN 1e-6
/* Ratio of the first to the largest eigenvalue in that space; eigenvalues
   beyond belong to motions without mass. */
#define RITZ_RATIO_REACH 1e-13
/* Relative size of the independent part of a vector, below which that space
   does not take it. */
#define RITZ_RATIO_INDEPENDENT 1e-10
/* Terms must fall by this factor each: forty of them reach
   RITZ_SERIES_WITHIN. */
#define RITZ_SERIES_FALLS 0.5
/* A static response to a damper of which less than this is new adds nothing to
   the undamped modes. */
#define RITZ_STATIC_DEPENDENT 1e-8
/* Undamped modes are taken to this factor of what is asked for, in number and
   in frequency: damping moves poles across. */
#define RITZ_SPECTRUM_BEYOND 2.0
/* Inverse iteration that moves s further than this, relative, went to another
   pole. */
#define RITZ_REFINED_ELSEWHERE 0.1
/* Shapes of equal poles that correlate more than this are one; of a double
   pole they are not. */
#define RITZ_SAME_SHAPE 0.9
/* Square of the error of an entry of a motion without mass, of its largest. */
#define RITZ_MASSLESS_VECTOR 1e-24
/* Damping between a motion without mass and others, of the largest, above which
   it must be damped itself. */
#define RITZ_MASSLESS_COUPLED 1e-8
/* A step of a zero no larger than this part of it is the last: 4 eps. */
#define RITZ_ZERO_STEP 0x1p-50
/* A zero that rounding may move by this part of its distance from 0 and from
   all poles is one at infinity. */
#define RITZ_ZERO_DOUBT 0.1
/* K that differs from a multiple of M by less than this, squared and relative,
   is one: b of a M + b K is then 0. */
#define RITZ_PROPORTIONAL_RANK 1e-12
/* Steps of a scan by which its end may lie beyond the last one. */
#define RITZ_RANGE_STEPS 1e-9
/* Where a damper holds a mode by more than this times what the mode resists
   without it, the response that few dampers leave would lose four digits: the
   whole system is solved. */
#define RITZ_DAMPER_CANCELS 1e4
/* A coupled modal system with a worse reciprocal condition is on a pole. */
#define RITZ_COUPLED_RCOND 1e-16

/* Checks of models */

/* Asymmetry of a matrix, relative to its largest entry, that importing averages
   away: rounding leaves 6e-7 in superelements as supplied. */
#define RITZ_SYMMETRIC_SOURCE 1e-6
/* Whole numbers of some unit up to this are meant as they stand, not rounded,
   unless harm is shown. */
#define RITZ_SHORT_NUMBERS 1e6
/* Negative eigenvalues of a matrix of unit diagonal that a static condensation
   leaves: commercial superelements stay below, measured, and matrices in text
   of ten digits. */
#define RITZ_CONDENSATION_LOSS 1e-10
/* Columns with this part of the largest share of a motion are named with it. */
#define RITZ_WORTH_NAMING 0.3
/* A rigid motion driven by less than this part of the softest flexible
   eigenvalue has not moved a radius in 1e6 of that mode's radians. */
#define RITZ_DRIFT_UNNOTICED 1e-12
/* A rigid motion held by no more than this part of the first flexible
   eigenvalue is meant to be free. */
#define RITZ_NEARLY_FREE 1e-4
/* Eigenvalues of R'MR below this part of the largest: a rigid motion without
   mass. */
#define RITZ_MOTION_WITHOUT_MASS 1e-10
/* Forces of a rigid motion that elements computed in double precision leave:
   1024 eps; a commercial code left 290 in a solid, measured. */
#define RITZ_ELEMENT_ROUNDING 0x1p-42
/* A source with this many significant digits or more counts as binary. */
#define RITZ_MOST_DIGITS 15.0
/* Rounding of positions and frames kept in single precision, or as eight
   letters of a card. */
#define RITZ_SINGLE_PRECISION 0x1p-24
/* Digits of a source that lose nothing of the differences of stiffness. */
#define RITZ_ENOUGH_DIGITS 12.0
/* Sine of the angle between rigid eigenvectors and the motions that positions
   give: six digits of a position; beyond the second one a position or a frame
   is wrong. */
#define RITZ_MOTIONS_AGREE    1e-6
#define RITZ_MOTIONS_BEARABLE 1e-3
/* Relative difference of the masses along the axes, and of their couplings,
   that lumping, averaging and single precision leave; beyond the second one no
   averaging explains it. */
#define RITZ_MASS_AGREES   1e-6
#define RITZ_MASS_BEARABLE 1e-2
/* A motion that a port holds by less than this part of the best is not held. */
#define RITZ_PORT_HELD 1e-6
/* Entries of a rigid motion below this, per unit of size, are no motion. */
#define RITZ_MOTION_PRESENT 1e-9
/* Square of the error of an entry of a motion without mass, of its largest,
   where its damping is judged. */
#define RITZ_MASSLESS_DAMPING 1e-20
/* A free motion this small is not followed any more. */
#define RITZ_DIED_OUT 1e-3
/* Rounding that squaring e^(A t) may have added up when it ends, and growth of
   the energy of a free motion that it leaves. */
#define RITZ_POWERS_ROUNDING 1e-7
#define RITZ_GROWTH_ROUNDING 1e-6
/* Error of a state per step that integrators accept by default: a motion that
   grows by more than its inverse is lost in it. */
#define RITZ_INTEGRATOR_ERROR 1e-3
/* Springs, masses and dampers that are attached to an interface, times its own:
   three decades to either side. */
#define RITZ_ATTACHMENTS                                                       \
    {                                                                          \
        1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3                                   \
    }
/* A zero beyond this times the largest pole is met by stiffer attachments
   alone. */
#define RITZ_ZEROS_REACH 1e3
/* A zero no further right of the axis, of |s|, is on it. */
#define RITZ_ZERO_ON_AXIS 1e-7
/* There is no response this close to a pole, of w. */
#define RITZ_SAMPLER_POLE 1e-13
/* Least width of a pole, of |s|, to place frequencies around it. */
#define RITZ_LEAST_WIDTH 1e-3
/* An eigenvalue of a Hamiltonian pencil no further from the axis, of |s|, is on
   it. */
#define RITZ_PENCIL_ON_AXIS 1e-6
/* Negative part of a response, of |G|, that rounding may leave of a passive
   model. */
#define RITZ_PASSIVE 1e-9

/* Decks and files of other programs */

/* 16 eps, some ten operations on a position: shares of a tie, scaled so that
   lengths cancel, below this part of the largest of their row, which would only
   fill the matrices; the distance of a grid from the axis of a curved system
   that it is on, of that from the origin. */
#define RITZ_TIE_ROUNDING 0x1p-48
/* A rigid-body motion of which less than this part is independent of the others
   is not counted: grids on a line have five. */
#define RITZ_ROTATION_ON_A_LINE 1e-8
/* Part of a motion without stiffness that no rigid motion explains: between
   what matrices of six digits do to a rigid mode (1e-5, a judgement) and the
   order of 1 of a loose part. */
#define RITZ_LOOSE_IN_FRAME 1e-3
/* Frequency of a rigid motion, relative to the first flexible one, above which
   the ground is taken to hold the body: rounding of matrices of six digits
   leaves 1e-3, the square root of 1e-6. */
#define RITZ_HELD 1e-2
/* Participation of a mode in translation or rotation, relative to that of the
   whole body, below which it counts as zero: the effective mass is its square,
   1e-12 of the body's. */
#define RITZ_NO_PARTICIPATION 1e-6
/* Largest cosine between the participation vectors of a mode in translation and
   in rotation at which they count as perpendicular, so that a mass on a spring
   can represent the mode. */
#define RITZ_SKEW_PARTICIPATION 1e-6
/* A block of M is taken for that of a beam if it differs from it by at most
   this part of its terms of translations with rotations; single precision makes
   a smaller difference. The same bound decides whether two grids share a
   direction along the beam. */
#define RITZ_BEAM_FITS 1e-6
/* Eigenvalues below this of the matrix of products of displacement fields,
   which are scaled to size 1, are rounding: of sums over grids, and of rigid
   motion that was removed. An invariant without them has at most this error,
   relative to the size of its fields. */
#define RITZ_INVARIANT_ROUNDING 1e-13
/* A loss of kinetic energy above this is reported: rounding of modes that 98
   columns make is 3e-9, measured. */
#define RITZ_ENERGY_LOST 1e-6
/* Numbers below this, or above 9e98, may take an exponent of three digits once
   they are rounded. */
#define RITZ_TWO_DIGIT_EXPONENT 1e-98
/* Rounding of a few products of double-doubles, each within 2^-102: a decimal
   that is nearer to a tie goes to strtod. */
#define RITZ_DOUBLE_DOUBLE 0x1p-96

/* Simulation */

/* Rounding of an output may have grown to this part of what could be shown:
   more is an error of the step. */
#define RITZ_ROUNDING_GROWN 1e-9
/* Elongation of the period of the highest wanted mode, for which the step of an
   accurate simulation is quoted. */
#define RITZ_PERIOD_ERROR 1e-3
/* Least processor time of one measurement of a step: some thousand times what
   the clock resolves and what reading it takes. */
#define RITZ_MEASURED_SECONDS 2e-4
/* What is left of the equation for a law of constraints at the end of a step,
   relative to its terms: some eps, as each is a sum of as many terms as there
   are constraints. */
#define RITZ_LAW_SOLVED 1e-13
/* A violation of the initial values is a sum of terms. Below this part of them
   it is rounding: some hundred terms, in coordinates that are rounded too. */
#define RITZ_VIOLATION_ROUNDING 1e-13
/* A run warns if initial values change by a larger part of their size to
   satisfy the constraints: values given to three digits change by less. */
#define RITZ_START_MOVED 1e-3
/* A run warns if the relative rounding error of the forces of stiff springs is
   larger. */
#define RITZ_FORCE_ROUNDING 1e-3
/* Frequency up to which parameters of a constraint are chosen with an explicit
   integrator, as part of what the step allows: a tenth is kept free. */
#define RITZ_GAIN_ROOM 0.9
/* A parameter that has less than this over the step is not chosen: violations
   would last for tens of steps, and penalties be soft. */
#define RITZ_GAIN_LEAST 0.1
/* More steps are a mistake in a step or an end. */
#define RITZ_MOST_STEPS 1e10
/* The step at which a split loop becomes unstable is bracketed by steps of this
   ratio and then bisected to this part of it: some 40 spectral radii in all. */
#define RITZ_STEP_RATIO 1.5
#define RITZ_STEP_FOUND 1e-4
/* Steps are tried from this part of the shortest time constant on, over which a
   held output is late by little, but from no less than the second part of the
   step of the run, which are 17 radii more at most. */
#define RITZ_STEP_OF_CONSTANT 0.05
#define RITZ_STEP_LEAST       1e-3
/* A loop that still grows at a step this many times finer does so by its delay. */
#define RITZ_STEP_FINER 8.0
/* The part that a loop adds to the matrices of an exact step is rounding below
   this times (4 + |A| h) of their norm: the exponential itself has an error of
   eps |A| h. */
#define RITZ_STEP_MATRIX_ROUNDING 0x1p-52
#define RITZ_STEP_MATRIX_LEAST    4.0
/* A map of more numbers than 160 is applied to a vector so often, four times;
   from the first half to the second growth by powers of the count halves its
   rate, exponential growth does not. A rate below 1e-6 a step is not told from
   that of no growth. */
#define RITZ_GROWTH_MAPS  500
#define RITZ_GROWTH_LEAST 1e-6
#define RITZ_GROWTH_KEPT  0.75
/* A step that ends within this part of itself of the end, ends there. */
#define RITZ_STEP_ROUNDING 1e-6
/* A delay that whole steps miss by more than rounding is said as it is used. */
#define RITZ_DELAY_ROUNDING 1e-12

/* Full against reduced */

/* A full model's modes are computed to this multiple of the band's end. */
#define RITZ_REFERENCE_REACH 3.0
/* Error, relative to the largest |H| of a channel, of projected responses that
   replace those of the full model: below the digits printed of any error. */
#define RITZ_REFERENCE_TOLERANCE 1e-11
/* Hz: no model has a mode above. */
#define RITZ_ALL_MODES 1e100
/* Singular values of a response are zero below this part of the largest. */
#define RITZ_ZERO_SINGULAR 1e-10
/* Relative tolerance of H-infinity norms. */
#define RITZ_NORM_TOLERANCE 1e-8
/* ... of sparse models: an interpolant whose peak is that near to a value of
   the model itself is not searched any longer. */
#define RITZ_SPARSE_NORM 1e-6

/* Dampers tuned for the least H2 norm */

/* Relative change of the norm, when the number of modes is doubled, below which
   it has settled: six digits are then known [ChuMilman1992]. */
#define RITZ_H2_SETTLED 1e-6
/* Relative difference allowed between the norms of the full model and of the
   projected model that was tuned: near a minimum, values are then known to its
   square root, 1 %. */
#define RITZ_TUNED_FULL 1e-4
/* A search ends when a step changes the norm by less than this relative amount,
   or each variable by less than the second number, in units of its range: a
   norm is flat at its minimum. */
#define RITZ_TUNED_NORM  1e-14
#define RITZ_TUNED_PLACE 1e-9
/* A damping constant is searched by a variable x in 0 .. 1 that is linear in
   the logarithm of its distance from the lower end, plus 1/1000 of its range:
   ln 1000, three decades. */
#define RITZ_TUNED_DECADES 6.907755278982137
/* Relative slope (d norm / d x) / norm, with x from 0 to 1 over a range, above
   which a search has not ended at a minimum. */
#define RITZ_TUNED_SLOPE 1e-4
/* Relative difference of the norms of two searches below which both ended at
   the same minimum. */
#define RITZ_TUNED_SAME 1e-6
/* Least distance between the starts of searches, as a part of each range. */
#define RITZ_TUNED_STARTS 0.25
/*
 * A bound holds in exact arithmetic. Solving Lyapunov equations and projecting
 * moves the response by some n eps |G|: an error may exceed its bound by this
 * many times that. The factor is a choice: no error of
 * tests/claims/states.claims is so close to its bound that it matters.
 */
#define RITZ_BOUND_ROUNDING 1e3
/* Next to a slow pole, rounding also moves the response by the first-order
   effect of a relative change eps of A, which the condition of the pole
   amplifies, times this factor for a Schur form and a projection. */
#define RITZ_BOUND_CONDITION 1.0
/* Participation below this part of |c_i| |phi|, or of the largest product of a
   channel, is rounding of products and eigenvectors. */
#define RITZ_PARTICIPATION_ROUNDING 1e-10
/* Leaving out a mode costs as much as frequencies 15 % apart do: with two left
   out, modes pair up to 30 %. */
#define RITZ_SKIP_COST 0.15
/* Modes whose participation in inputs and outputs differs wholly cost as much
   as frequencies 10 % apart. */
#define RITZ_UNLIKE_COST 0.1
/* An exchange of paired modes that gains less is rounding. */
#define RITZ_EXCHANGE_GAIN 1e-9
/* Largest tolerances of a relative measure, and of a count. */
#define RITZ_MOST_RELATIVE 1.0
/* A relative error without a tolerance is reported in addition to the worst one
   that has a tolerance, if it is more than this many times as large. */
#define RITZ_BESIDE_WORST 10.0
#define RITZ_MOST_COUNT   1e9
/* Modes closer than this, relative, are one cluster to ritz-verify: reduction
   turns vectors within modes that lie closer than its own error. */
#define RITZ_CLOSE 1e-3
/* A response below this part of the largest |H| is not compared. */
#define RITZ_AUDIBLE 1e-6
/* A thousand eps: rounding of a sum over some thousand modes. */
#define RITZ_HEARD_ROUNDING 2.3e-13

/* Estimates */

/* Roundings, in eps, of a sum of terms that cancel: one is due, the rest is
   room. */
#define RITZ_CANCELLED_ROUNDINGS 4.0
/* Eigenvalues within this many times their rounding of a shift may be counted
   on either side: once for the count, which does not test whether the shift is
   an eigenvalue, and once for the eigenvalue. */
#define RITZ_COUNT_MARGIN 2.0
/* A ratio of bound to error that is good enough. */
#define RITZ_GOOD_RATIO 3.0
/* Relative error above which a mode is in no known gap. */
#define RITZ_COARSE_ERROR 0.1
/* Shifts rho of counts, as multiples of the highest eigenvalue in the band. The
   first count lies between NEAR and OFF, or between NEAR and FAR if no gap of
   the reduced spectrum is found there; a count for responses lies between FAR
   and FARTHEST. A smaller rho makes bounds loose. Below a larger one the
   reduced model has fewer modes than the full one, and finding the missing ones
   takes further counts: models S10 and P50 of the benchmarks take 4 and 3
   counts with rho up to OFF, 7 and 5 with rho up to FAR. */
#define RITZ_COUNT_NEAR     2.0
#define RITZ_COUNT_OFF      3.0
#define RITZ_COUNT_FAR      8.0
#define RITZ_COUNT_FARTHEST 40.0
/* Ratio (rho - sigma) / (theta - sigma) beyond which a count gains nothing. */
#define RITZ_COUNT_ENOUGH 3.0
/* A gap narrower than this part of its distance to the mode gains nothing. */
#define RITZ_GAP_CLOSE 0.3
/* Parts of the band's end, in lambda, below which a reduced mode may be a rigid
   motion that the basis holds badly, and below which a mode is rigid. */
#define RITZ_MAY_BE_RIGID 1e-6
#define RITZ_SURELY_RIGID 0.5e-6
/* Gaps of eigenvalues narrower than this, relative, hold no count. */
#define RITZ_GAP_NARROW 1e-6
/* The full mode of the same number is named unless another one's bound is
   smaller by this factor. */
#define RITZ_CLAIM_FAVOUR 4.0
/* Largest sin^2 of the angle between a group and the vector that means it. */
#define RITZ_VECTOR_NEAR 0.1
/* Rounding of |c|^2, here and in ritz-verify. */
#define RITZ_SHARE_ROUNDING 1e-6
/* The band is taken wider by this, in lambda: ritz-verify allows 2e-9. */
#define RITZ_BAND_EDGE_COUNTED 4e-9
/* A count at the band's end lies this far behind it, in lambda: further than
   what ritz-verify takes to be in the band. */
#define RITZ_COUNT_BEHIND 8e-9
/* Norm of a residual vector, relative to that of the whole, below which it is
   rounding; and least eigenvalue of the Gram matrix of unit residual vectors,
   at which half of the digits are kept. */
#define RITZ_ENRICH_LEAST       1e-10
#define RITZ_ENRICH_INDEPENDENT 1e-8
/* An input and an output count as decoupled if their response is nowhere proven
   to exceed this part of its Cauchy-Schwarz bound. Positions in single
   precision disturb symmetry by about as much. */
#define RITZ_CHANNEL_COUPLED 1e-6
/* For an input and an output to count as decoupled, their response must also be
   proven to stay below this part of its Cauchy-Schwarz bound. */
#define RITZ_CHANNEL_WEAK 1e-2
/* A bound of a response is refined with a richer trial space if it is more than
   this many times the known part of the error. */
#define RITZ_RESPONSE_LOOSE 2.0
/* The cause of a bound is named if the bound is more than this many times the
   known part of the error. */
#define RITZ_BOUND_FAR 10.0
/* Least distance of a count from an eigenvalue, as a part of the largest
   eigenvalue of a dense pencil, whose rounding is some thousand eps of it. */
#define RITZ_WHOLE_CLEAR 1e-12
/* A frequency error below this needs no tighter bound. */
#define RITZ_NO_ERROR 1e-9
/* Least and largest relative distance of a count from the mode it is for. */
#define RITZ_COUNT_BESIDE  1e-7
#define RITZ_COUNT_TOO_FAR 0.03
/* A rigid motion counts as at least this part of the limit of rigid ones. */
#define RITZ_COUNT_LEAST 1e-3
/* -sigma as a part of the band's end in lambda: a smaller one makes bounds at
   the end tighter, a larger one rounds less. */
#define RITZ_ESTIMATE_SHIFT 0.1
/* The trial holds modes to this multiple of the band's end, in lambda, and as
   many beyond the band's last. */
#define RITZ_TRIAL_REACH 30.0
/* D is a M + b K if entries differ by less than this part of sqrt(d_ii d_jj):
   rounding of matrices printed with 15 digits. */
#define RITZ_RAYLEIGH_WITHIN 1e-13
/* A participation below this part of the largest is rounding. */
#define RITZ_NO_PART 1e-9
/* Largest relative residual of a rigid mode; its square is below rounding. */
#define RITZ_RIGID_RESIDUAL 1e-7
/* An interval is split until its bound is within this factor of the points'. */
#define RITZ_INTERVAL_SLACK 1.05
/* Relative asymmetry of D above which it has a gyroscopic part. */
#define RITZ_GYROSCOPIC 1e-9

/* Fits and scenes */

/*
 * A first stage that stands for the full system: modes of bodies up to this
 * part of the band, and further where a tolerance is finer than ten times the
 * relative error of frequencies that it leaves. Measured on beams by
 * Craig-Bampton: frequencies in the band err by 6.4e-5 at 8 times the band, and
 * from 4 times fell faster than its square.
 */
#define RITZ_RICH_TO     8.0
#define RITZ_RICH_LEAVES 6.4e-5
/* Largest multiple of the band's end that a first stage has modes to: bodies of
   a solid have modes as its third power. */
#define RITZ_RICH_MOST 32.0
/* Part of the modes that a reference holds up to which those of bodies are
   steps of the ladder: to six times the band, and further for the finest
   tolerances. */
#define RITZ_LADDER_TO 0.75
/* Logarithm of the ratio of two steps that is reported: five per cent. */
#define RITZ_STEP_WORTH_SAYING 0.05
/* A MAC above this is reported by its distance from 1. */
#define RITZ_MAC_NEARLY_ONE 0.9989
/* A share of rigid motion in a column below this is rounding. */
#define RITZ_RIGID_PART 1e-6
/* Part of a tolerance that may be the first stage's own error. */
#define RITZ_STAGE_MAY_LEAVE 0.1
/* A richer first stage has modes to this multiple of the frequency. */
#define RITZ_STAGE_FARTHER 1.5
/* A longer ladder, or a richer stage, is of use if it leaves less than this
   part of the error. */
#define RITZ_NO_NEARER 0.9
/* Of two ratios of error to tolerance the smaller one is nearer, but for
   rounding. */
#define RITZ_SAME_RATIO 1e-6
/* A pivot of Gram-Schmidt columns must exceed another by this factor: of those
   that are equal to six digits the first is taken. */
#define RITZ_PIVOT_TIE (1.0 + 1e-6)
/* Defaults of a scene. `select: {tolerance}`: part of the largest value at all
   configurations. `attached: auto`: relative error of the largest and the
   smallest singular value of the response. `extraneous: compact`: increase of
   the errors of frequencies and of |H|, relative to the frequency and to the
   largest |H|. `spin: {negligible}`: relative change of a frequency. */
#define RITZ_SCENE_SELECT   1e-3
#define RITZ_SCENE_ATTACHED 1e-3
#define RITZ_SCENE_COMPACT  1e-3
#define RITZ_SCENE_SPIN     1e-3
/* Forces whose normalised columns differ by less than this are the same
   force. */
#define RITZ_SAME_FORCE 1e-9
/* A motion of a body takes part in no mode of the system if its participation
   is below this part of the largest. */
#define RITZ_NO_MOTION 1e-12

/* Buckling */

/* A load does not buckle in a direction if it has no factor there up to this
   many times that of the other direction: what rounding of KG leaves of the
   other sign is far beyond it. */
#define RITZ_BUCKLING_REACH 1e3
/* A count of factors is made this part below one that was found, or it would be
   at a singular matrix. */
#define RITZ_BUCKLING_BELOW 1e-6
/* A load above this part of its buckling load is reported: deflections are
   1 / (1 - part) of those without it, twice as large. */
#define RITZ_BUCKLING_PART 0.5

/* Floating-point operations of a factor below which one thread is used: two
   wait for each other in every block of columns. Measured with CHOLMOD: factors
   of 1.3e9 and 1.8e9 operations take as long with two threads as with one, a
   factor of 2e10 takes two thirds of the time. */
#define RITZ_FACTOR_ALONE 4e9

/* Switched models */

/* Shares of a residual, or a share and Emin, closer than this are a tie: each
   is a sum of squares of some thousand coordinates. */
#define RITZ_SWITCH_TIE 1e-12
/* A vector of length one of which less than this is new beside others that
   were chosen gives no direction: eight digits of it would be rounding. */
#define RITZ_SWITCH_NEW 1e-8
/* A motion with less than this part of the largest kinetic energy has died out:
   what a set leaves out of it does not matter. */
#define RITZ_SWITCH_MOVES 1e-6
/* A set that leaves more than this share of the kinetic energy out is warned
   of: 3 % of the velocity. Runs that are as good as the fixed model of their
   library stay below, and those that lose a rigid motion are above. */
#define RITZ_SWITCH_LEFT_OUT 1e-3
/* A vector is an eigenvector of M, D or K if it is off by no more than this:
   iterated modes are good to the root of their residuals, 1e-16. What energy
   the rest can raise is below |D| times this a second. */
#define RITZ_COMMUTES 1e-8

#endif
