/*
 * Tangential interpolation by one projection [GugercinAntoulasBeattie2008],
 *
 *     span V = { Re, Im of v_j },   Z(s_j) v_j = F b_j,
 *     Z(s) = s^2 M + s D + K + i K4,
 *
 * F one kind of loads: inputs, say, or rows of outputs. The response of the
 * reduced component to F b_j at s_j is that of the full one at every dof, so
 * that H_r(s_j) b_j = H(s_j) b_j of inputs and b_j'H_r(s_j) = b_j'H(s_j) of
 * outputs; V'KV, V'MV and V'DV are as symmetric and definite as K, M and D.
 *
 * Points that are best in H2 mirror the poles of the reduced model, and b_j are
 * its residues. So points are moved to the mirror images of the resulting
 * poles, until they converge (iterative rational Krylov):
 *
 * - With D or K4, v_j is complex and costs two vectors, but a reduced component
 *   of N has N pairs of poles: the more dominant half gives the points,
 *   s_j = -conj(p_j), which is a choice and no optimum [Wyatt2012].
 * - With ratios alone, Z has no damping, v_j is real, and every pole has its
 *   point: next to the resonance, not mirrored, as nothing is damped there.
 *
 * The search begins at the most dominant of twice as many modes. Rigid motion,
 * which has no H2 norm, is kept in addition.
 */
#include "bases/tangential.h"

#include "base/alloc.h"
#include "base/tolerances.h"
#include "bases/columns.h"
#include "bases/space.h"
#include "linear/general.h"

#include <complex.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/*
 * Real bases of complex responses. Z(s) is symmetric, and one analysis of its
 * pattern serves all points. V = [Re v, Im v] spans v and its conjugate, so
 * that the projected model has the response of the full one at s and at its
 * conjugate, whatever else V spans: v = V y, and V'Z(s) V y = V'F b determines
 * y.
 */

/* Columns are the rows of C, Cv, Ca, at powers 0, 1, 2 of s. */
static ritz_status read_outputs(const ritz_io *io, ritz_rational_loads *out)
{
    const ritz_dense *const rows[] = {&io->C, &io->Cv, &io->Ca};

    out->count = io->num_outputs;
    for (int power = 0; power < 3; power++)
        if (ritz_dense_max(rows[power]) > 0.0)
            RITZ_CHECK(ritz_general_transpose(rows[power], &out->F[power]));
    return RITZ_OK;
}

static ritz_status read_loads(const ritz_request *request, int kind,
                              ritz_rational_loads *out)
{
    RITZ_OWN_ARRAY int64_t *dof = NULL;

    out->kind = kind;
    if (kind == RITZ_LOADS_OUTPUTS)
        return read_outputs(&request->component->io, out);
    RITZ_CHECK(ritz_loads_collect(request, kind, &out->F[0], &dof));
    out->count = out->F[0].ncol;
    return RITZ_OK;
}

static ritz_status read_groups(const ritz_request *request, int loads,
                               ritz_rational *R)
{
    static const int kinds[] = {RITZ_LOADS_ATTACHED, RITZ_LOADS_INPUTS,
                                RITZ_LOADS_OUTPUTS, RITZ_LOADS_DAMPERS};
    const int read = loads | RITZ_LOADS_INPUTS | RITZ_LOADS_OUTPUTS;
    bool any = false;

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        ritz_rational_loads *group = &R->group[R->num_groups];

        if (!(read & kinds[k]) || ritz_loads_count(request, kinds[k]) == 0)
            continue;
        R->num_groups++;
        group->first = R->num_loads;
        group->interpolated = loads & kinds[k];
        any = any || group->interpolated;
        RITZ_CHECK(read_loads(request, kinds[k], group));
        R->num_loads += group->count;
    }
    RITZ_REFUSE_IF(!any, RITZ_ERR_ARGUMENT,
                   "there is no load to respond to: attach a port, or give the "
                   "component inputs or outputs");
    return RITZ_OK;
}

ritz_status ritz_rational_new(const ritz_request *request, int loads,
                              double scale, ritz_rational *out)
{
    const ritz_component *component = request->component;
    const ritz_sparse *A[4] = {&component->M, &component->K};
    int64_t count = 2;
    RITZ_OWN(ritz_rational)
    R = {.component = component, .tolerance = request->tolerance};

    RITZ_REFUSE_IF(component->D.colptr &&
                       ritz_sparse_asymmetry(&component->D) > 0.0,
                   RITZ_ERR_ARGUMENT,
                   "D is not symmetric (gyroscopic?), which one-sided "
                   "interpolation cannot reproduce");
    RITZ_CHECK(read_groups(request, loads, &R));
    RITZ_CHECK(
        ritz_sparse_add(1.0, &component->M, 1.0 / scale, &component->K, &R.P));
    if (component->D.colptr)
        A[count++] = &component->D;
    if (component->K4.colptr)
        A[count++] = &component->K4;
    RITZ_CHECK(ritz_zldl_new(count, A, &R.Z));
    RITZ_MOVE(*out, R);
    return RITZ_OK;
}

/* Factor Z(s), unless it is factored at s already. */
static ritz_status factor_impedance(ritz_rational *R, double _Complex s)
{
    double _Complex c[4] = {s * s, 1.0};
    int count = 2;
    ritz_status status = RITZ_OK;

    if (R->factored && R->s == s)
        return RITZ_OK;
    R->factored = false;
    if (R->component->D.colptr)
        c[count++] = s;
    if (R->component->K4.colptr)
        c[count++] = cimag(s) > 0.0 ? (double _Complex)_Complex_I : 0.0;
    status = ritz_zldl_factor(R->Z, c);
    RITZ_REFUSE_IF(status == RITZ_ERR_SINGULAR, status,
                   "%g%+gi rad/s is a pole of the component, where nothing can "
                   "be interpolated",
                   creal(s), cimag(s));
    RITZ_CHECK(status);
    R->s = s;
    R->factored = true;
    return RITZ_OK;
}

/* v += F(s) b of a group. */
static void add_load(const ritz_rational_loads *group,
                     const ritz_interpolation_point *probe, double _Complex *v)
{
    double _Complex power = 1.0;

    for (int k = 0; k < 3; k++, power *= probe->s)
        for (int64_t j = 0; j < group->F[k].ncol; j++) {
            const double *f = ritz_dense_col(&group->F[k], j);
            double _Complex factor = power * probe->b[group->first + j];

            for (int64_t i = 0; i < group->F[k].nrow; i++)
                v[i] += factor * f[i];
        }
}

/* w := w / |w|, and |w| in the inner product P. */
static ritz_status normalise_vector(const ritz_rational *R, ritz_dense *w,
                                    double *size)
{
    RITZ_OWN(ritz_dense) Pw = {0};

    RITZ_CHECK(ritz_sparse_mul(&R->P, w, &Pw));
    *size = sqrt(fmax(ritz_dense_dot(w, 0, &Pw, 0), 0.0));
    for (int64_t i = 0; i<w->nrow && * size> 0.0; i++)
        w->val[i] /= *size;
    return RITZ_OK;
}

/* w := w - Q Q' P w. */
static ritz_status remove_span(const ritz_rational *R, const ritz_dense *Q,
                               ritz_dense *w)
{
    RITZ_OWN(ritz_dense) Pw = {0}, q = {0}, part = {0};

    RITZ_CHECK(ritz_sparse_mul(&R->P, w, &Pw));
    RITZ_CHECK(ritz_dense_mul_tn(Q, &Pw, &q));
    RITZ_CHECK(ritz_dense_mul(Q, &q, &part));
    ritz_dense_add(-1.0, &part, w);
    return RITZ_OK;
}

/*
 * Append the independent part of w, which is scaled so that the response it is
 * part of has length one; less than the tolerance counts as dependent. Twice is
 * enough for orthogonality [GiraudLangouRozloznik2005].
 */
static ritz_status append_vector(const ritz_rational *R, ritz_dense *w,
                                 ritz_dense *Q)
{
    double size = 0.0;
    double left = 1.0;

    for (int pass = 0; pass < 2 && left > R->tolerance; pass++) {
        RITZ_CHECK(remove_span(R, Q, w));
        RITZ_CHECK(normalise_vector(R, w, &size));
        left *= size;
    }
    if (left > R->tolerance)
        ritz_dense_put(w, 0, Q->ncol++, Q);
    return RITZ_OK;
}

/* Re v and Im v over the length of v; the larger first. */
static ritz_status split_complex(const ritz_rational *R,
                                 const double _Complex *v, ritz_dense part[2])
{
    int64_t n = R->component->num_dofs;
    double length[2] = {0.0, 0.0};
    double largest = DBL_MIN;
    double all = 0.0;

    for (int64_t i = 0; i < n; i++)
        largest = fmax(largest, cabs(v[i])); /* lest squares overflow */
    for (int64_t i = 0; i < n; i++) {
        part[0].val[i] = creal(v[i]) / largest;
        part[1].val[i] = cimag(v[i]) / largest;
    }
    for (int k = 0; k < 2; k++)
        RITZ_CHECK(normalise_vector(R, &part[k], &length[k]));
    all = fmax(hypot(length[0], length[1]), DBL_MIN);
    for (int k = 0; k < 2; k++)
        for (int64_t i = 0; i < n; i++)
            part[k].val[i] *= length[k] / all;
    if (length[1] > length[0]) {
        ritz_dense swap = part[0];

        part[0] = part[1];
        part[1] = swap;
    }
    return RITZ_OK;
}

/* Append both parts, or none if there may be no room for both. */
static ritz_status add_probe(ritz_rational *R,
                             const ritz_interpolation_point *probe,
                             int64_t room, ritz_dense *Q)
{
    int64_t n = R->component->num_dofs;
    int64_t parts = ritz_rational_damped(R) && cimag(probe->s) > 0.0 ? 2 : 1;
    RITZ_OWN_ARRAY double _Complex *v = NULL;
    RITZ_OWN(ritz_dense_pair) part = {0};

    if (room < parts)
        return RITZ_OK;
    RITZ_CHECK_NEW(v, n);
    RITZ_CHECK(ritz_dense_new(n, 1, &part[0]));
    RITZ_CHECK(ritz_dense_new(n, 1, &part[1]));
    add_load(&R->group[probe->group], probe, v);
    RITZ_CHECK(factor_impedance(R, probe->s));
    RITZ_CHECK(ritz_zldl_solve(R->Z, false, 1, v));
    RITZ_CHECK(split_complex(R, v, part));
    for (int64_t k = 0; k < 2 && k < room; k++)
        RITZ_CHECK(append_vector(R, &part[k], Q));
    return RITZ_OK;
}

ritz_status ritz_rational_span(ritz_rational *R, const ritz_probes *probes,
                               const ritz_dense *first, int64_t most,
                               ritz_dense *out, int64_t *gave)
{
    int64_t r = first->ncol;
    RITZ_OWN(ritz_dense) Q = {0};

    RITZ_CHECK(ritz_dense_new(R->component->num_dofs, r + most, &Q));
    ritz_dense_put(first, 0, 0, &Q);
    Q.ncol = r;
    for (int64_t k = 0; k < probes->count; k++) {
        int64_t before = Q.ncol;

        RITZ_CHECK(add_probe(R, &probes->item[k], r + most - before, &Q));
        gave[k] = Q.ncol - before;
    }
    return ritz_dense_copy(&Q, out);
}

void ritz_rational_free(ritz_rational *R)
{
    for (int k = 0; k < RITZ_RATIONAL_GROUPS; k++)
        for (int power = 0; power < 3; power++)
            ritz_dense_free(&R->group[k].F[power]);
    ritz_sparse_free(&R->P);
    ritz_zldl_free(&R->Z);
    *R = (ritz_rational){0};
}

enum {
    MOST_ROUNDS = 50,
    FREE_ROUNDS = 5, /* after them points follow those of before */
};

static const ritz_damping assumed = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};

typedef struct irka_search {
    const ritz_request *request;
    ritz_damping damping;
    bool assumed;     /* the damping, of which nothing is known */
    ritz_pairs modes; /* where the search begins */
    ritz_dense rigid; /* of the modes; borrowed */
    int64_t most;     /* vectors besides the rigid ones */
    ritz_rational R;
    ritz_dense T;       /* rigid and interpolating */
    ritz_probes probes; /* those that T interpolates */
    int loads;          /* kinds of loads that are interpolated,
                           RITZ_LOADS_... */
    int64_t left_out;   /* fixed probes without room */
    int rounds;
    double change;
} irka_search;

static void irka_search_free(irka_search *s)
{
    ritz_pairs_free(&s->modes);
    ritz_rational_free(&s->R);
    ritz_dense_free(&s->T);
    ritz_probes_free(&s->probes);
}

/* The requested damping, else the component's, else a usual value. */
static ritz_status choose_damping(irka_search *s)
{
    const ritz_component *component = s->request->component;

    RITZ_CHECK(ritz_request_damping(s->request, &s->damping));
    s->assumed = s->damping.kind == RITZ_DAMPING_NONE && !component->D.colptr &&
                 !component->K4.colptr && s->request->choice.num_shifts == 0;
    if (s->assumed)
        s->damping = assumed;
    return RITZ_OK;
}

/* Flexible modes up to the requested frequency. */
static int64_t count_modes(const ritz_pairs *modes, double up_to_hz)
{
    int64_t k = modes->num_rigid;

    while (k < modes->Phi.ncol &&
           ritz_eigen_hertz(modes->lambda[k]) <= up_to_hz)
        k++;
    return k - modes->num_rigid;
}

/* Rigid modes, and twice as many flexible ones as vectors are requested. */
static ritz_status find_modes(irka_search *s)
{
    const ritz_request *request = s->request;
    const ritz_component *component = request->component;
    int64_t wanted = request->modes;
    const ritz_span span = {
        .modes = wanted > 0   ? 2 * wanted
                 : wanted < 0 ? -1
                              : 1,
        .up_to_hz = 2.0 * request->up_to_hz,
    };
    ritz_pairs *modes = &s->modes;
    int64_t flexible = 0;

    RITZ_CHECK(ritz_lowest_modes("modes to begin with", "K", &component->K,
                                 &component->M, &span, NULL, modes));
    if (wanted < 0)
        wanted = count_modes(modes, request->up_to_hz);
    flexible = component->num_dofs - modes->num_rigid;
    s->most = wanted < flexible ? wanted : flexible;
    if (modes->Phi.ncol == modes->num_rigid)
        s->most = 0;
    RITZ_REFUSE_IF(s->most + modes->num_rigid == 0, RITZ_ERR_ARGUMENT,
                   "no vector is asked for, and there is no rigid mode");
    s->rigid = ritz_dense_part(&modes->Phi, 0, modes->num_rigid);
    return RITZ_OK;
}

/* Each load to be interpolated, by itself, at each given point. */
static ritz_status list_given(const irka_search *s, ritz_probes *out)
{
    const ritz_choice *choice = &s->request->choice;
    int64_t loads = 0;
    int64_t at = 0;

    for (int64_t g = 0; g < s->R.num_groups; g++)
        loads += s->R.group[g].interpolated ? s->R.group[g].count : 0;
    RITZ_CHECK(
        ritz_probes_new(choice->num_shifts * loads, s->R.num_loads, out));
    for (int64_t k = 0; k < choice->num_shifts; k++)
        for (int64_t g = 0; g < s->R.num_groups; g++) {
            const ritz_rational_loads *group = &s->R.group[g];

            for (int64_t j = 0; group->interpolated && j < group->count; j++) {
                ritz_interpolation_point *probe = &out->item[at++];

                probe->s = (double _Complex)_Complex_I *
                           (2.0 * RITZ_PI * choice->shift_hz[k]);
                probe->group = g;
                probe->b[group->first + j] = 1.0;
            }
        }
    return RITZ_OK;
}

/* T from probes; probes that gave no column are dropped. */
static ritz_status span_probes(irka_search *s, ritz_probes *probes)
{
    RITZ_OWN(ritz_dense) T = {0};
    RITZ_OWN_ARRAY int64_t *gave = NULL;
    int64_t kept = 0;

    RITZ_CHECK_NEW(gave, probes->count);
    RITZ_CHECK(ritz_rational_span(&s->R, probes, &s->rigid, s->most, &T, gave));
    for (int64_t k = 0; k < probes->count; k++)
        if (gave[k] > 0)
            probes->item[kept++] = probes->item[k];
    s->left_out = probes->count - kept;
    probes->count = kept;
    ritz_probes_free(&s->probes);
    RITZ_MOVE(s->probes, *probes);
    ritz_dense_replace(&s->T, &T);
    return RITZ_OK;
}

/* Distance of two points, infinite between groups. */
static double probe_distance(const ritz_interpolation_point *a,
                             const ritz_interpolation_point *b)
{
    return a->group == b->group ? cabs(a->s - b->s) : HUGE_VAL;
}

/*
 * Move the nearest counterpart of each previous point to the front. As long as
 * points are free, only the most dominant are considered, as many as there were
 * before. Returns the largest relative change.
 */
static double match_probes(const ritz_probes *before, bool is_free,
                           ritz_probes *probes)
{
    double worst = 0.0;

    if (probes->count < before->count)
        return HUGE_VAL;
    for (int64_t k = 0; k < before->count; k++) {
        const ritz_interpolation_point *old = &before->item[k];
        int64_t among = is_free ? before->count : probes->count;
        int64_t best = k;
        ritz_interpolation_point found;

        for (int64_t j = k + 1; j < among; j++)
            if (probe_distance(old, &probes->item[j]) <
                probe_distance(old, &probes->item[best]))
                best = j;
        found = probes->item[best];
        memmove(probes->item + k + 1, probes->item + k,
                (size_t)(best - k) * sizeof found);
        probes->item[k] = found;
        worst = fmax(worst, probe_distance(old, &found) / cabs(old->s));
    }
    return worst;
}

/*
 * Move the points according to the poles that they gave, until they converge.
 */
static ritz_status iterate_points(irka_search *s)
{
    int64_t r = s->rigid.ncol;
    RITZ_OWN(ritz_probes) probes = {0};
    RITZ_OWN(ritz_dense) V = {0};

    s->change = HUGE_VAL;
    RITZ_CHECK(ritz_dense_columns(&s->modes.Phi, r, s->modes.Phi.ncol - r, &V));
    for (s->rounds = 0;; s->rounds++) {
        RITZ_CHECK(ritz_dominant_probes(&s->R, &s->damping, &V, &probes));
        if (s->rounds > 0)
            s->change =
                match_probes(&s->probes, s->rounds <= FREE_ROUNDS, &probes);
        if (s->change <= RITZ_POINTS_SETTLED || s->rounds == MOST_ROUNDS)
            break;
        RITZ_CHECK(span_probes(s, &probes));
        ritz_dense_free(&V);
        RITZ_CHECK(ritz_dense_columns(&s->T, r, s->T.ncol - r, &V));
    }
    return RITZ_OK;
}

static ritz_status take_given(irka_search *s)
{
    RITZ_OWN(ritz_probes) probes = {0};

    for (int64_t k = 0; k < s->request->choice.num_shifts; k++)
        RITZ_REFUSE_IF(s->rigid.ncol > 0 &&
                           s->request->choice.shift_hz[k] == 0.0,
                       RITZ_ERR_ARGUMENT,
                       "the component can move freely, so that 0 Hz is a pole "
                       "of it: give an expansion point above 0");
    RITZ_CHECK(list_given(s, &probes));
    return span_probes(s, &probes);
}

/* The first kind of load that there is: inputs, outputs or attached dofs. */
static int choose_loads(const ritz_request *request)
{
    if (ritz_loads_count(request, RITZ_LOADS_INPUTS) > 0)
        return RITZ_LOADS_INPUTS;
    if (ritz_loads_count(request, RITZ_LOADS_OUTPUTS) > 0)
        return RITZ_LOADS_OUTPUTS;
    return RITZ_LOADS_ATTACHED;
}

static ritz_status interpolate_response(irka_search *s)
{
    const ritz_request *request = s->request;

    s->loads = request->choice.loads;
    if (s->most == 0)
        return ritz_dense_copy(&s->rigid, &s->T);
    if (s->loads == 0)
        s->loads = choose_loads(request);
    RITZ_CHECK(ritz_rational_new(request, s->loads,
                                 s->modes.lambda[s->modes.num_rigid], &s->R));
    RITZ_CHECK(request->choice.num_shifts > 0 ? take_given(s)
                                              : iterate_points(s));
    RITZ_REFUSE_IF(
        s->probes.count == 0 && s->left_out > 0 && s->most == 1,
        RITZ_ERR_ARGUMENT,
        "one vector cannot hold the real and the imaginary part of a "
        "response: ask for 2 or more");
    RITZ_REFUSE_IF(s->probes.count == 0, RITZ_ERR_ARGUMENT,
                   "no flexible mode is controllable by the loads, or none is "
                   "observable at an output");
    return RITZ_OK;
}

/* Remark on how the points were found, and on their limits. */
static void add_remark(const irka_search *s, ritz_basis *basis)
{
    bool given = s->request->choice.num_shifts > 0;
    int64_t missing = s->most + s->rigid.ncol - basis->T.ncol;

    if (s->most == 0)
        return;
    if (given)
        ritz_remark_add(basis, "; ", "%" PRId64 " response(s) interpolated",
                        s->probes.count);
    else if (s->change <= RITZ_POINTS_SETTLED)
        ritz_remark_add(basis, "; ", "points settled after %d round(s)",
                        s->rounds);
    else
        ritz_remark_add(basis, "; ",
                        "points did not settle in %d rounds, the last moved "
                        "them by %.1e; interpolation is exact where they were",
                        s->rounds, s->change);
    if (s->assumed)
        ritz_remark_add(basis, "; ", "damping modal 0.01 assumed for them");
    if (given && s->left_out > 0)
        ritz_remark_add(basis, "; ", "%" PRId64 " more have no room",
                        s->left_out);
    if (missing > 0)
        ritz_remark_add(basis, "; ", "%" PRId64 " vector(s) fewer than asked",
                        missing);
    ritz_remark_dampers(s->request, s->loads, basis);
}

ritz_status ritz_tangential_find(const ritz_request *request, ritz_basis *out,
                                 ritz_probes *probes)
{
    RITZ_OWN(irka_search) s = {.request = request};
    RITZ_OWN(ritz_basis) basis = {0};
    RITZ_OWN(ritz_dofs) rest = {0};

    /* refuses attached dofs that are out of range or repeated */
    RITZ_CHECK(ritz_dofs_complement(&request->attached,
                                    request->component->num_dofs, &rest));
    RITZ_CHECK(choose_damping(&s));
    RITZ_CHECK(find_modes(&s));
    RITZ_CHECK(interpolate_response(&s));
    RITZ_CHECK(ritz_columns_new(s.T.ncol, &basis.columns));
    RITZ_MOVE(basis.T, s.T);
    for (int64_t j = 0; j < basis.T.ncol; j++)
        basis.columns.kind[j] = RITZ_COLUMN_KRYLOV;
    for (int64_t j = 0; j < s.rigid.ncol; j++) {
        ritz_columns_label_rigid(j, &basis.columns);
        basis.columns.residual[j] = s.modes.residual[j];
    }
    snprintf(basis.origin.engine, sizeof basis.origin.engine, "MUMPS LDL'");
    add_remark(&s, &basis);
    RITZ_MOVE(*out, basis);
    if (probes)
        RITZ_MOVE(*probes, s.probes);
    return RITZ_OK;
}

static ritz_status make_tangential(const ritz_request *request, ritz_basis *out)
{
    if (request->space)
        return ritz_tangential_of_space(request, out);
    return ritz_tangential_find(request, out, NULL);
}

const ritz_method ritz_method_tangential = {
    .name = "tangential",
    .summary =
        "responses at mirrored poles, a search in H2 (second-order IRKA)",
    .reference = "Wyatt2012",
    .when = "few inputs and outputs that drive few of many modes",
    .cost = "a complex factor a point and round, some 2 to 50 rounds",
    .holds = "the response at its points, in its directions; from above",
    .fails = "light damping where all modes count: modes are better in H2",
    .uses = RITZ_USES_MODES | RITZ_USES_ATTACHED | RITZ_USES_SHIFTS |
            RITZ_USES_LOADS | RITZ_USES_DAMPING | RITZ_USES_SPACE,
    .only_named = RITZ_NAMED_FOR_COMPONENTS | RITZ_NAMED_FOR_SCENES,
    .make = make_tangential,
};
