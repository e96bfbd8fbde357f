/*
 * Mass properties from the mass matrix: with rigid motions R = [T, Theta] of
 * unit translations and unit rotations about the basic origin,
 *
 *     R'MR = |  m I     -m c~ |     c the centre of mass, c~ x = c x x,
 *            |  m c~     J_o  |     J_c = J_o - m (c'c I - c c')
 */
#include "base/alloc.h"
#include "model/equations.h"

#include <ritz/model.h>

#include <math.h>

static const double origin[3];

/* Mean over the translations of the model: a plane model has two. */
static double mean_mass(const ritz_dense *A)
{
    double sum = 0.0;
    int count = 0;

    for (int i = 0; i < 3; i++)
        if (ritz_dense_col(A, i)[i] > 0.0) {
            sum += ritz_dense_col(A, i)[i];
            count++;
        }
    return count > 0 ? sum / count : 0.0;
}

/*
 * Two translations, j and k, give c_i; where only one of them is in the
 * model, as in a plane one, that one alone is used.
 */
static double read_centre(const ritz_dense *A, double m, int i)
{
    int j = (i + 1) % 3;
    int k = (i + 2) % 3;
    bool has_j = ritz_dense_col(A, j)[j] > 0.0;
    bool has_k = ritz_dense_col(A, k)[k] > 0.0;
    double sum = (has_j ? ritz_dense_col(A, 3 + k)[j] : 0.0) -
                 (has_k ? ritz_dense_col(A, 3 + j)[k] : 0.0);

    return has_j || has_k ? sum / (m * (has_j + has_k)) : 0.0;
}

/* Whether the model has the translations that inertia (i, j) is read from. */
static bool has_translations(const ritz_dense *A, int i, int j)
{
    for (int k = 0; k < 3; k++)
        if (k != i && k != j && !(ritz_dense_col(A, k)[k] > 0.0))
            return false;
    return true;
}

/* Inertias that the model's translations do not determine stay zero. */
void ritz_inertia_read(const ritz_dense *A, ritz_inertia *inertia)
{
    double m = mean_mass(A);
    double *c = inertia->centre;
    double square = 0.0;

    inertia->mass = m;
    inertia->known = m > 0.0;
    if (!inertia->known)
        return;
    for (int i = 0; i < 3; i++) {
        c[i] = read_centre(A, m, i);
        square += c[i] * c[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (has_translations(A, i, j))
                inertia->tensor[3 * i + j] =
                    ritz_dense_col(A, 3 + j)[3 + i] -
                    m * ((i == j ? square : 0.0) - c[i] * c[j]);
}

ritz_status ritz_inertia_momenta(const ritz_component *component,
                                 ritz_dense *out)
{
    RITZ_OWN(ritz_dense) R = {0};

    if (component->grids.count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_rigid_geometry(component, origin, &R));
    return ritz_sparse_condense(&component->M, &R, out);
}

ritz_status ritz_inertia_of(const ritz_component *component, ritz_inertia *out)
{
    RITZ_OWN(ritz_dense) A = {0};

    *out = (ritz_inertia){0};
    RITZ_CHECK(ritz_inertia_momenta(component, &A));
    if (A.val)
        ritz_inertia_read(&A, out);
    return RITZ_OK;
}
