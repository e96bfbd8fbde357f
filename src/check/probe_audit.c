/* All checks of the stability probe, one after the other. */
#include "check/probe_parts.h"

#include "base/alloc.h"
#include "check/audit_parts.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Columns that a line names, and the least share of the largest. */
enum { SHOWN = 3 };
static const double worth_naming = 0.3;

void ritz_prober_say(ritz_prober *it, const char *name, double value,
                     double limit, ritz_verdict verdict, const char *where,
                     const char *says, ...)
{
    ritz_check check = {.value = value, .limit = limit, .verdict = verdict};
    va_list values;

    snprintf(check.name, sizeof check.name, "%s", name);
    va_start(values, says);
    ritz_audit_add(&it->audit, RITZ_PROBE_MOST, &check, where, says, values);
    va_end(values);
}

/* "column 3 constraint, grid 101 T3", "column 7 normal, 12.3 Hz" */
static void name_column(const ritz_reduced *reduced, int64_t j,
                        char text[RITZ_NAME_SIZE])
{
    const ritz_columns *columns = &reduced->columns;
    char beside[RITZ_DOF_NAME_SIZE + 4] = "";
    char dof[RITZ_DOF_NAME_SIZE];
    int64_t row = columns->dof[j];

    if (row >= 0 && reduced->dof && row < reduced->num_dofs)
        snprintf(beside, sizeof beside, ", %s",
                 ritz_dof_name(reduced->dof[row], dof));
    else if (isfinite(columns->hertz[j]))
        snprintf(beside, sizeof beside, ", %.4g Hz", columns->hertz[j]);
    snprintf(text, RITZ_NAME_SIZE, "column %lld %s%.36s", (long long)j + 1,
             ritz_column_name(columns->kind[j]), beside);
}

/* Share of coordinate j: energies compare, lengths and angles do not. */
static double share(const ritz_prober *it, const double *motion, int64_t j)
{
    double m = fabs(ritz_dense_col(&it->model.M, j)[j]);
    double k = fabs(ritz_dense_col(&it->model.K, j)[j]);

    return fabs(motion[j]) * sqrt(m > 0.0 ? m : k);
}

void ritz_prober_where(const ritz_prober *it, const double *motion,
                       char where[RITZ_WHERE_SIZE])
{
    double largest = HUGE_VAL;
    double below = HUGE_VAL;

    where[0] = '\0';
    if (!it->reduced || it->reduced->columns.count != it->model.K.nrow)
        return;
    for (int shown = 0; shown < SHOWN; shown++) {
        char text[RITZ_NAME_SIZE];
        double best = 0.0;
        int64_t at = -1;

        for (int64_t j = 0; j < it->model.K.nrow; j++) {
            double s = share(it, motion, j);

            if (s < below && s > best) {
                best = s;
                at = j;
            }
        }
        if (shown == 0)
            largest = best;
        if (at < 0 || best < worth_naming * largest)
            return;
        name_column(it->reduced, at, text);
        ritz_auditor_list(where, text);
        below = best;
    }
}

ritz_status ritz_probe_poles(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    ritz_probe probe = {0};
    ritz_dense A = {0};
    char text[2 * RITZ_NAME_SIZE];
    double growth = 0.0;

    if (!it->usable)
        return RITZ_OK;
    if (it->reduced) {
        /* rigid positions are left out: their double pole is defective */
        RITZ_TRY(ritz_probe_energy_matrix(&it->modes, &A));
        RITZ_TRY(ritz_probe_judge(&A, &probe));
    } else {
        RITZ_TRY(ritz_probe_states(it->space, &probe));
    }
    growth = probe.radius > 0.0 ? probe.pole[0] / probe.radius : 0.0;
    it->stable = probe.verdict != RITZ_UNSTABLE;
    ritz_probe_print(&probe, text);
    if (!it->stable)
        ritz_prober_say(it, "poles", growth, probe.tolerance, RITZ_FAIL, "",
                        "%s", text);
    else
        ritz_prober_say(it, "poles", growth, probe.tolerance, RITZ_PASS, text,
                        "%s",
                        probe.verdict == RITZ_STABLE
                            ? "all are left of the axis"
                            : "on the axis: rigid motion, or no damping");
done:
    ritz_dense_free(&A);
    return status;
}

static void free_prober(ritz_prober *it)
{
    ritz_structure_free(&it->model);
    ritz_first_order_free(&it->modes);
    ritz_dense_free(&it->L);
    free(it->row);
    ritz_collocated_free(&it->pairs);
    ritz_audit_free(&it->audit);
}

/* Structural damping, of harmonic motion alone, has a check of its own. */
static ritz_status take_reduced(ritz_prober *it)
{
    ritz_status status = RITZ_OK;
    const ritz_reduced *reduced = it->reduced;
    ritz_dampers dampers = {0};

    RITZ_TRY(ritz_damping_parse(reduced->damping, &it->damping));
    RITZ_TRY(ritz_dense_copy(&reduced->K, &it->model.K));
    RITZ_TRY(ritz_dense_copy(&reduced->M, &it->model.M));
    if (reduced->D.val)
        RITZ_TRY(ritz_dense_copy(&reduced->D, &it->model.D));
    RITZ_TRY(ritz_dampers_copy(&reduced->dampers, &dampers));
    RITZ_TRY(ritz_dampers_install(&dampers, &it->model.K, &it->model.D));
    RITZ_TRY(ritz_prober_interface(it));
done:
    ritz_dampers_free(&dampers);
    return status;
}

typedef ritz_status (*probe_check)(ritz_prober *it);

static ritz_status run(ritz_prober *it, const probe_check *checks,
                       ritz_audit *out)
{
    RITZ_CHECK_NEW(it->audit.check, RITZ_PROBE_MOST);
    for (; *checks; checks++)
        RITZ_CHECK((*checks)(it));
    *out = it->audit;
    it->audit = (ritz_audit){0};
    return RITZ_OK;
}

ritz_status ritz_probe_audit_reduced(const ritz_reduced *reduced,
                                     ritz_audit *out)
{
    static const probe_check checks[] = {
        ritz_probe_definite_mass,
        ritz_probe_definite_stiffness,
        ritz_probe_definite_damping,
        ritz_probe_definite_structural,
        ritz_probe_poles,
        ritz_probe_growth,
        ritz_probe_passive,
        ritz_probe_locked,
        ritz_probe_sprung,
        ritz_probe_joined,
        NULL,
    };
    ritz_status status = RITZ_OK;
    ritz_prober it = {.reduced = reduced, .usable = true, .definite = true};

    RITZ_TRY(take_reduced(&it));
    RITZ_TRY(run(&it, checks, out));
done:
    free_prober(&it);
    return status;
}

ritz_status ritz_probe_audit_states(const ritz_state_space *model,
                                    ritz_audit *out)
{
    static const probe_check checks[] = {
        ritz_probe_poles,  ritz_probe_growth, ritz_probe_passive,
        ritz_probe_locked, ritz_probe_sprung, NULL,
    };
    ritz_status status = RITZ_OK;
    ritz_prober it = {.space = model, .usable = true};

    RITZ_TRY(ritz_collocated_of_space(model, &it.pairs));
    RITZ_TRY(run(&it, checks, out));
done:
    free_prober(&it);
    return status;
}
