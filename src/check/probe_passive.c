/* Whether energy can come out of the interface, and where it does. */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "check/audit_parts.h"
#include "linear/general.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of |G|: what rounding of a response may leave. */
static const double rounding = 1e-9;

ritz_status ritz_collocated_of_modes(const ritz_prober *it,
                                     ritz_collocated *out)
{
    ritz_status status = RITZ_OK;
    const ritz_first_order *modes = &it->modes;
    int64_t m = modes->count, first = m - modes->num_rigid;
    ritz_collocated model = {0};
    ritz_dense LPhi = {0};
    int64_t p = 0;

    RITZ_TRY(ritz_dense_mul(&it->L, &modes->Phi, &LPhi));
    RITZ_TRY(ritz_probe_energy_matrix(modes, &model.A));
    RITZ_TRY(ritz_dense_new(first + m, LPhi.nrow, &model.B));
    RITZ_NEW(model.name, LPhi.nrow);
    for (int64_t i = 0; i < LPhi.nrow; i++) {
        double size = 0.0;

        for (int64_t j = 0; j < m; j++)
            size = hypot(size, ritz_dense_col(&LPhi, j)[i]);
        if (size == 0.0) /* moves without mass: it only stores */
            continue;
        for (int64_t j = 0; j < m; j++)
            ritz_dense_col(&model.B, p)[first + j] =
                ritz_dense_col(&LPhi, j)[i] / size;
        memcpy(model.name[p++], it->row[i], sizeof *model.name);
    }
    model.B.ncol = p;
    RITZ_NEW(model.power, p);
    RITZ_TRY(ritz_general_transpose(&model.B, &model.C));
    RITZ_TRY(ritz_dense_new(p, p, &model.D));
    *out = model;
    model = (ritz_collocated){0};
done:
    ritz_dense_free(&LPhi);
    ritz_collocated_free(&model);
    return status;
}

void ritz_collocated_free(ritz_collocated *model)
{
    ritz_dense_free(&model->A);
    ritz_dense_free(&model->B);
    ritz_dense_free(&model->C);
    ritz_dense_free(&model->D);
    free(model->power);
    free(model->name);
    *model = (ritz_collocated){0};
}

/* "tip as a displacement, root as a velocity": what pairs are taken for. */
static void name_pairs(const ritz_collocated *pairs,
                       char where[RITZ_WHERE_SIZE])
{
    static const char *const quantity[] = {"acceleration", "velocity",
                                           "displacement"};

    where[0] = '\0';
    for (int64_t i = 0; i < pairs->B.ncol; i++) {
        char text[RITZ_WHERE_SIZE];

        snprintf(text, sizeof text, "%s (%s)", pairs->name[i],
                 quantity[pairs->power[i] + 1]);
        ritz_auditor_list(where, text);
    }
}

static ritz_status say_passivity(ritz_prober *it, const ritz_collocated *model)
{
    ritz_passivity found = {0};
    char where[RITZ_WHERE_SIZE] = "";

    RITZ_CHECK(ritz_passivity_of(model, &found));
    if (found.value >= -rounding) {
        if (it->space)
            name_pairs(model, where);
        ritz_prober_say(it, "passivity", found.value, -rounding, RITZ_PASS,
                        where, "no energy comes out at any frequency met");
        return RITZ_OK;
    }
    snprintf(where, sizeof where, "%.6g Hz, %s", found.hertz,
             model->name[found.port]);
    ritz_prober_say(it, "passivity", found.value, -rounding, RITZ_WARN, where,
                    "energy comes out of the interface: with some passive "
                    "neighbour it can be unstable");
    return RITZ_OK;
}

ritz_status ritz_probe_passive(ritz_prober *it)
{
    static const char name[] = "passivity";
    ritz_status status = RITZ_OK;
    ritz_collocated model = {0};

    if (!it->usable)
        return RITZ_OK;
    if (it->space && it->pairs.B.ncol == 0) {
        ritz_prober_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                        "not applicable: no input and output of one name");
    } else if (it->space) {
        RITZ_TRY(say_passivity(it, &it->pairs));
    } else if (it->L.nrow == 0) {
        ritz_prober_say(it, name, nan(""), nan(""), RITZ_PASS, "",
                        "not applicable: no port and no input");
    } else if (it->definite) {
        ritz_prober_say(it, name, 0.0, 0.0, RITZ_PASS, "",
                        "proven: M, K and D are semidefinite, and forces act "
                        "where velocities are met");
    } else {
        RITZ_TRY(ritz_collocated_of_modes(it, &model));
        RITZ_TRY(say_passivity(it, &model));
    }
done:
    ritz_collocated_free(&model);
    return status;
}
