/*
 * Real bases of complex responses. Z(s) is symmetric, and one analysis of its
 * pattern serves all points. V = [Re v, Im v] spans v and its conjugate, so
 * that the projected model has the response of the full one at s and at its
 * conjugate, whatever else V spans: v = V y, and V'Z(s) V y = V'F b determines
 * y.
 */
#include "bases/rational.h"

#include "base/alloc.h"
#include "bases/loads.h"
#include "linear/general.h"

#include <complex.h>
#include <float.h>
#include <math.h>

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

bool ritz_rational_damped(const ritz_rational *R)
{
    return R->component->D.colptr || R->component->K4.colptr;
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
    RITZ_CHECK(ritz_zldl_solve(R->Z, 1, v));
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

ritz_status ritz_probes_new(int64_t count, int64_t width, ritz_probes *out)
{
    RITZ_OWN(ritz_probes) probes = {.count = count};

    RITZ_CHECK_NEW(probes.item, count);
    RITZ_CHECK_NEW(probes.b, count * width);
    for (int64_t k = 0; k < count; k++)
        probes.item[k].b = probes.b + k * width;
    RITZ_MOVE(*out, probes);
    return RITZ_OK;
}

void ritz_probes_free(ritz_probes *probes)
{
    RITZ_FREE(probes->item, probes->b);
    *probes = (ritz_probes){0};
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
