#include "mass_row.h"

#include "masses.h"
#include "testing.h"

/* Masses of 1 to 2, springs about 100, in a row; k[0] = 0 sets them free. */
static void row_of_masses(double ground, double *m, double *k, double *c)
{
    for (int64_t i = 0; i < MASS_ROW; i++) {
        m[i] = 1.0 + 0.25 * (double)((7 * i) % 5);
        k[i] = 100.0 + 20.0 * (double)((3 * i) % 4);
        c[i] = 0.0;
    }
    k[0] = ground;
}

ritz_component mass_row(double ground)
{
    static const int64_t in[] = {2, 9};
    static const int64_t out[] = {0, 5, 11};
    double m[MASS_ROW], k[MASS_ROW], c[MASS_ROW];
    ritz_component component = {0};

    row_of_masses(ground, m, k, c);
    assert_ok(masses_component(MASS_ROW, m, k, NULL, &component));
    assert_ok(masses_io(&component, 2, in, 3, out));
    return component;
}

ritz_gramians_request mass_row_rayleigh(const ritz_component *component,
                                        double a, double b)
{
    return (ritz_gramians_request){
        .component = component,
        .engine = RITZ_ENGINE_LOW_RANK,
        .damping = {.kind = RITZ_DAMPING_RAYLEIGH, .a = a, .b = b}};
}

/* Masses 3 and 8 are none; one is pushed, the other is seen. */
ritz_component mass_row_massless(int64_t pushed)
{
    static const int64_t out[] = {0, 8};
    const int64_t in[] = {pushed, 10};
    double m[MASS_ROW], k[MASS_ROW], c[MASS_ROW];
    ritz_component component = {0};

    row_of_masses(100.0, m, k, c);
    m[3] = m[8] = 0.0;
    assert_ok(masses_component(MASS_ROW, m, k, NULL, &component));
    assert_ok(masses_io(&component, 2, in, 2, out));
    return component;
}
