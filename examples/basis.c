/*
 * A component of 201 dofs, in a Craig-Bampton basis of two interface dofs and
 * thirty fixed-interface modes: the frequencies of the reduced component beside
 * those of a free rod, f_k = k / (2 l).
 */
#include "rod.h"

#include <math.h>
#include <stdio.h>

int main(void)
{
    enum { ELEMENTS = 200, MODES = 30, SHOWN = 5 };
    ritz_component rod = {0};
    ritz_basis basis = {0};
    ritz_reduced reduced = {0};
    ritz_pairs modes = {0};
    ritz_request request = RITZ_REQUEST_NONE;
    ritz_status status = rod_component(ELEMENTS, &rod);

    request.component = &rod;
    request.modes = MODES;
    if (status == RITZ_OK)
        status = ritz_component_attached(&rod, NULL, &request.attached);
    if (status == RITZ_OK)
        status = ritz_basis_make(ritz_method_find("craig-bampton"), &request,
                                 &basis);
    if (status == RITZ_OK)
        status = ritz_reduce(&rod, &basis, &reduced);
    if (status == RITZ_OK)
        status = ritz_eigen_dense(&reduced.K, &reduced.M, &modes);
    if (status == RITZ_OK) {
        puts("mode  reduced Hz  rod Hz");
        for (int64_t k = 1; k <= SHOWN; k++)
            printf("%4d  %10.7f  %9.7f\n", (int)k,
                   sqrt(modes.lambda[k]) / (2.0 * 3.14159265358979),
                   (double)k / (2.0 * ELEMENTS));
    } else {
        fprintf(stderr, "basis: %s\n", ritz_error_message());
    }
    ritz_pairs_free(&modes);
    ritz_reduced_free(&reduced);
    ritz_basis_free(&basis);
    ritz_dofs_free(&request.attached);
    ritz_component_free(&rod);
    return status == RITZ_OK ? 0 : 1;
}
