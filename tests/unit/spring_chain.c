#include "spring_chain.h"

#include "base/alloc.h"
#include "masses.h"

#include <inttypes.h>
#include <stdio.h>

double spring_chain_mass(int64_t i)
{
    return 1.0 + 0.1 * (double)(7 * i % 5);
}

double spring_chain_stiffness(int64_t i)
{
    return 1000.0 * (1.0 + 0.2 * (double)(3 * i % 4));
}

/* The masses alone, at no place. */
static ritz_status row(int64_t n, bool is_free, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    double m[MASSES_MOST] = {0}, k[MASSES_MOST] = {0};

    RITZ_FAIL_IF(n > MASSES_MOST, RITZ_ERR_ARGUMENT, "the chain is too long");
    for (int64_t i = 0; i < n; i++) {
        m[i] = spring_chain_mass(i);
        k[i] = i == 0 && is_free ? 0.0 : spring_chain_stiffness(i);
    }
    RITZ_TRY(masses_component(n, m, k, NULL, out));
done:
    return status;
}

ritz_status spring_chain(int64_t n, bool is_free, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component chain = {0};

    RITZ_TRY(row(n, is_free, &chain));
    RITZ_NEW(chain.grids.id, n);
    RITZ_NEW(chain.grids.position, 3 * n);
    RITZ_NEW(chain.grids.frame, n);
    RITZ_NEW(chain.grids.axes, 9);
    chain.grids.count = n;
    chain.grids.num_frames = 1;
    for (int64_t k = 0; k < 3; k++)
        chain.grids.axes[4 * k] = 1.0;
    for (int64_t i = 0; i < n; i++) {
        chain.grids.id[i] = i + 1;
        chain.grids.position[3 * i] = (double)(i + 1);
    }
    RITZ_TRY(ritz_component_settle(&chain, false));
    *out = chain;
    chain = (ritz_component){0};
done:
    ritz_component_free(&chain);
    return status;
}

ritz_status spring_chain_damp(ritz_component *chain, int64_t count,
                              const int64_t *spring, double c, double k)
{
    ritz_status status = RITZ_OK;
    ritz_dampers dampers = {0};

    RITZ_TRY(ritz_dampers_new(chain->num_dofs, count, &dampers));
    for (int64_t j = 0; j < count; j++) {
        double *b = ritz_dense_col(&dampers.B, j);

        snprintf(dampers.name[j], RITZ_NAME_SIZE, "damper %" PRId64, spring[j]);
        dampers.c[j] = c;
        dampers.k[j] = k;
        b[spring[j]] = 1.0;
        if (spring[j] > 0)
            b[spring[j] - 1] = -1.0;
    }
    ritz_dampers_free(&chain->dampers);
    chain->dampers = dampers;
    dampers = (ritz_dampers){0};
done:
    ritz_dampers_free(&dampers);
    return status;
}

ritz_status chain_component(int64_t n, ritz_component *out)
{
    static const int64_t across[] = {2, 9, 17};
    const int64_t last = n - 1;
    ritz_status status = RITZ_OK;
    ritz_component chain = {0};

    RITZ_TRY(row(n, false, &chain));
    for (int64_t i = 0; i < n; i++)
        chain.dof[i].component = 0;
    RITZ_TRY(spring_chain_damp(&chain, 3, across, 150.0, -200.0));
    for (int64_t j = 0; j < 3; j++)
        snprintf(chain.dampers.name[j], RITZ_NAME_SIZE, "%c", (char)('a' + j));
    RITZ_TRY(masses_io(&chain, 1, &last, 1, &last));
    snprintf(chain.io.input[0], RITZ_NAME_SIZE, "f");
    snprintf(chain.io.output[0], RITZ_NAME_SIZE, "u");
    RITZ_TRY(ritz_component_settle(&chain, false));
    snprintf(chain.units, sizeof chain.units, "kg m s");
    *out = chain;
    chain = (ritz_component){0};
done:
    ritz_component_free(&chain);
    return status;
}

void chain_free(ritz_component *chain)
{
    chain->K.val[0] -= spring_chain_stiffness(0);
}
