/*
 * |H| from a force at the end of a free rod to the displacement there, damped
 * by 1 % of critical in every mode, at twenty frequencies.
 */
#include "rod.h"

#include <complex.h>
#include <stdio.h>

int main(void)
{
    ritz_component rod = {0};
    ritz_response response = {0};
    const ritz_damping damping = {.kind = RITZ_DAMPING_MODAL, .zeta = 0.01};
    const ritz_grid grid = {.from_hz = 0.001, .to_hz = 0.02, .count = 20};
    ritz_status status = rod_component(200, &rod);

    if (status == RITZ_OK)
        status = ritz_response_of(ritz_model_of_component(&rod, &damping),
                                  &ritz_response_engine_modal, 0.0, 0.0, &grid,
                                  &response);
    if (status == RITZ_OK) {
        puts("       Hz          |H|");
        for (int64_t k = 0; k < response.count; k++)
            printf("%9.6f  %11.5e\n", response.hertz[k], cabs(response.H[k]));
    } else {
        fprintf(stderr, "response: %s\n", ritz_error_message());
    }
    ritz_response_free(&response);
    ritz_component_free(&rod);
    return status == RITZ_OK ? 0 : 1;
}
