/*
 * Responses of a component at points of the complex plane,
 *
 *     v = Z(s)^-1 F(s) b,    Z(s) = s^2 M + s D + K + i K4,
 *     F(s) = F_0 + s F_1 + s^2 F_2,
 *
 * and the real basis that spans some of them. Damping that is given as ratios
 * is not in Z, which has the matrices alone.
 */
#ifndef RITZ_BASES_TANGENTIAL_H
#define RITZ_BASES_TANGENTIAL_H

#include <ritz/basis.h>
#include <ritz/matrix.h>

enum { RITZ_RATIONAL_GROUPS = 4 };

/* Loads of one kind; powers of s without a load are {0}. */
typedef struct ritz_rational_loads {
    int kind;          /* RITZ_LOADS_... */
    bool interpolated; /* false: poles are only weighted by it */
    int64_t first;     /* number of its first load among all loads */
    int64_t count;
    ritz_dense F[3]; /* n x count */
} ritz_rational_loads;

/*
 * One requested response: the point s, and a direction b of one group of loads.
 */
typedef struct ritz_interpolation_point {
    double _Complex s; /* Im s >= 0; K4 counts above the real axis only */
    int64_t group;
    double _Complex *b; /* as many as there are loads of all groups, zero of
                           others; borrowed from ritz_probes */
} ritz_interpolation_point;

typedef struct ritz_probes {
    int64_t count;
    ritz_interpolation_point *item;
    double _Complex *b; /* the directions of all */
} ritz_probes;

typedef struct ritz_rational {
    const ritz_component *component; /* borrowed */
    double tolerance;                /* below which a vector is dependent */
    int64_t num_loads;
    int64_t num_groups;
    ritz_rational_loads group[RITZ_RATIONAL_GROUPS];
    ritz_sparse P; /* inner product M + K / scale */
    ritz_zldl *Z;
    double _Complex s; /* at which Z is factored */
    bool factored;
} ritz_rational;

/**
 * Each kind of load is a group. Inputs and outputs are read in any case, since
 * poles are weighted by them.
 *
 * @param[in] loads  to be interpolated, sum of RITZ_LOADS_...
 * @param[in] scale  an eigenvalue of the component  [rad^2/s^2]
 * @return RITZ_ERR_ARGUMENT if there is no load, or D is not symmetric
 */
ritz_status ritz_rational_new(const ritz_request *request, int loads,
                              double scale, ritz_rational *out);

/** Whether the component has D or K4, so that responses are complex. */
bool ritz_rational_damped(const ritz_rational *R);

/**
 * The columns of @p first, and then real and imaginary parts of the responses
 * at the points, in their order, orthonormal in M + K / scale; dependent parts
 * are left out. A point whose response needs more columns than are left is
 * skipped.
 *
 * @param[in]  first  n x r, orthonormal in the same product; may have no column
 * @param[in]  most   columns in addition to those of @p first
 * @param[out] gave   probes->count: how many columns each response gave
 * @return RITZ_ERR_SINGULAR if a point is a pole
 * @cost   a complex LDL' factor for each change of s
 */
ritz_status ritz_rational_span(ritz_rational *R, const ritz_probes *probes,
                               const ritz_dense *first, int64_t most,
                               ritz_dense *out, int64_t *gave);

/** @p count probes, each with a direction of @p width zeros. */
ritz_status ritz_probes_new(int64_t count, int64_t width, ritz_probes *out);

void ritz_probes_free(ritz_probes *probes);
void ritz_rational_free(ritz_rational *R);

/**
 * Points and directions from the poles of a projected component. Each pole p,
 * Im p >= 0, of (T'MT, T'DT + damping, T'KT + i T'K4T) and its vector x,
 * x'(2 p M + D) x = 1, give a term of the response,
 *
 *     (C x) (x'B) / (s - p),     of H2 norm |C x| |x'B| / sqrt(2 |Re p|),
 *
 * by which poles are ordered, the largest first; uncontrollable and
 * unobservable ones are left out. B are all loads but outputs; if there are
 * only outputs, or none, B = C' or C = B'. Each pole gives a probe for each
 * group to be interpolated, in direction conj(F(-conj(s))'x).
 *
 * If the component has D or K4, the point of a pole is s = -conj(p), at least
 * 1e-4 |p| off the axis. If not, s^2 = -w^2 (1 - zeta), w^2 an eigenvalue and
 * zeta its ratio: half of the half-power distance below the resonance of a
 * component without damping, whose response there is real.
 *
 * @param[in] T  n x r, independent columns without rigid motion
 * @return RITZ_ERR_CONVERGENCE
 * @cost   O(r nnz + n r^2 + r^3)
 */
ritz_status ritz_dominant_probes(const ritz_rational *R,
                                 const ritz_damping *damping,
                                 const ritz_dense *T, ritz_probes *out);

/**
 * The basis of the method `tangential`.
 *
 * @param[out] probes  the responses in its span: at each point s, in direction
 *                     b of a group of loads; may be NULL
 */
ritz_status ritz_tangential_find(const ritz_request *request, ritz_basis *out,
                                 ritz_probes *probes);

#endif
