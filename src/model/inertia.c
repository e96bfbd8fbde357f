/*
 * Mass properties from the mass matrix: with rigid motions R = [T, Theta] of
 * unit translations and unit rotations about the basic origin,
 *
 *     R'MR = |  m I     -m c~ |     c the centre of mass, c~ x = c x x,
 *            |  m c~     J_o  |     J_c = J_o - m (c'c I - c c')
 */
#include <ritz/reduced.h>

#include <math.h>

/* R'MR, 6 x 6. */
static ritz_status condense(const ritz_component *component, ritz_dense *out)
{
    ritz_status status = RITZ_OK;
    const double origin[3] = {0.0, 0.0, 0.0};
    ritz_dense R = {0};

    RITZ_TRY(ritz_rigid_geometry(component, origin, &R));
    RITZ_TRY(ritz_sparse_condense(&component->M, &R, out));
done:
    ritz_dense_free(&R);
    return status;
}

/* The mean over the translations that there are: a plane model has two. */
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
 * c_i is seen by two translations, j and k; where only one of them is in the
 * model, as in a plane one, that one alone tells.
 */
static double centre(const ritz_dense *A, double m, int i)
{
    int j = (i + 1) % 3;
    int k = (i + 2) % 3;
    bool see_j = ritz_dense_col(A, j)[j] > 0.0;
    bool see_k = ritz_dense_col(A, k)[k] > 0.0;
    double sum = (see_j ? ritz_dense_col(A, 3 + k)[j] : 0.0) -
                 (see_k ? ritz_dense_col(A, 3 + j)[k] : 0.0);

    return see_j || see_k ? sum / (m * (see_j + see_k)) : 0.0;
}

/* Whether the model moves as an inertia about i and j needs it to. */
static bool is_seen(const ritz_dense *A, int i, int j)
{
    for (int k = 0; k < 3; k++)
        if (k != i && k != j && !(ritz_dense_col(A, k)[k] > 0.0))
            return false;
    return true;
}

/* Inertias that the model's translations cannot show are left at zero. */
static void read_off(const ritz_dense *A, ritz_inertia *inertia)
{
    double m = mean_mass(A);
    double *c = inertia->centre;
    double square = 0.0;

    inertia->mass = m;
    inertia->known = m > 0.0;
    if (!inertia->known)
        return;
    for (int i = 0; i < 3; i++) {
        c[i] = centre(A, m, i);
        square += c[i] * c[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (is_seen(A, i, j))
                inertia->tensor[3 * i + j] =
                    ritz_dense_col(A, 3 + j)[3 + i] -
                    m * ((i == j ? square : 0.0) - c[i] * c[j]);
}

ritz_status ritz_inertia_of(const ritz_component *component, ritz_inertia *out)
{
    ritz_status status = RITZ_OK;
    ritz_dense A = {0};

    *out = (ritz_inertia){0};
    if (component->grids.count > 0) {
        RITZ_TRY(condense(component, &A));
        read_off(&A, out);
    }
done:
    ritz_dense_free(&A);
    return status;
}
