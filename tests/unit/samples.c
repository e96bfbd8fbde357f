#include "samples.h"

#include "base/alloc.h"

#include <ritz/nested.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fill(ritz_dense *A, double first)
{
    for (int64_t k = 0; k < A->nrow * A->ncol; k++)
        A->val[k] = first + 0.125 * (double)k;
}

static ritz_status filled(int64_t n, int64_t m, double first, ritz_dense *out)
{
    ritz_status status = ritz_dense_new(n, m, out);

    if (status == RITZ_OK)
        fill(out, first);
    return status;
}

/* Symmetric and tridiagonal. */
static ritz_status chain(double scale, ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;

    RITZ_TRY(
        ritz_sparse_new(SAMPLE_DOFS, SAMPLE_DOFS, 3 * SAMPLE_DOFS - 2, out));
    for (int64_t j = 0; j < SAMPLE_DOFS; j++) {
        for (int64_t i = j - 1; i <= j + 1; i++) {
            if (i < 0 || i >= SAMPLE_DOFS)
                continue;
            out->rowind[count] = i;
            out->val[count++] = scale * (i == j ? 2.0 : -1.0 / (double)(i + j));
        }
        out->colptr[j + 1] = count;
    }
done:
    return status;
}

static ritz_status label(int64_t count, ritz_dof **out)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(*out, count);
    for (int64_t k = 0; k < count; k++)
        (*out)[k] = (ritz_dof){101 + k / 6, 1 + k % 6};
done:
    return status;
}

static ritz_status sample_io(int64_t n, ritz_io *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_io_new(n, 2, 3, out));
    snprintf(out->input[0], RITZ_NAME_SIZE, "torque");
    snprintf(out->input[1], RITZ_NAME_SIZE, "force at the tip");
    snprintf(out->output[0], RITZ_NAME_SIZE, "gyro");
    snprintf(out->output[1], RITZ_NAME_SIZE, "encoder");
    snprintf(out->output[2], RITZ_NAME_SIZE, "accelerometer");
    out->limit[1] = 1e-3;
    fill(&out->B, 1.0);
    fill(&out->C, 2.0);
    fill(&out->Cv, -3.0);
    fill(&out->Ca, 4.0);
done:
    return status;
}

static ritz_status sample_dampers(int64_t n, ritz_dampers *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_dampers_new(n, 2, out));
    snprintf(out->name[0], RITZ_NAME_SIZE, "strut");
    snprintf(out->name[1], RITZ_NAME_SIZE, "rotor/strut");
    for (int64_t k = 0; k < 2; k++) {
        out->c[k] = 150.0 + (double)k;
        out->k[k] = -200.0 + (double)k;
        out->held_c[k] = (double)k;
        out->held_k[k] = -2.0 * (double)k;
    }
    fill(&out->B, -5.0);
done:
    return status;
}

/* Four dofs, each of two others. */
static ritz_status sample_recovery(ritz_recovery *out)
{
    ritz_status status = RITZ_OK;
    int64_t row[8];
    int64_t col[8];
    double val[8];

    out->count = 4;
    RITZ_NEW(out->dof, 4);
    for (int64_t k = 0; k < 8; k++) {
        out->dof[k / 2] = (ritz_dof){901, 1 + k / 2};
        row[k] = k / 2;
        col[k] = 5 * k;
        val[k] = 0.5 + (double)k;
    }
    RITZ_TRY(
        ritz_sparse_from_triplets(4, SAMPLE_DOFS, 8, row, col, val, &out->G));
done:
    return status;
}

static ritz_status sample_grids(ritz_grids *out)
{
    static const double turned[9] = {0, 1, 0, -1, 0, 0, 0, 0, 1};
    ritz_status status = RITZ_OK;

    out->count = 3;
    out->num_frames = 2;
    RITZ_NEW(out->id, 3);
    RITZ_NEW(out->frame, 3);
    RITZ_NEW(out->position, 9);
    RITZ_NEW(out->axes, 18);
    for (int64_t k = 0; k < 3; k++) {
        out->id[k] = 101 + k;
        out->frame[k] = k == 1;
        out->position[3 * k] = 0.5 * (double)k;
        out->axes[4 * k] = 1.0;
    }
    memcpy(out->axes + 9, turned, sizeof turned);
done:
    return status;
}

/* A line and a triangle of these grids. */
static ritz_status sample_elements(ritz_elements *out)
{
    static const int64_t grids[] = {102, 101, 101, 102, 103};
    ritz_status status = RITZ_OK;

    RITZ_NEW(out->kind, 2);
    RITZ_NEW(out->first, 3);
    RITZ_NEW(out->grid, 5);
    out->count = 2;
    out->kind[0] = RITZ_CELL_LINE;
    out->kind[1] = RITZ_CELL_TRIANGLE;
    out->first[1] = 2;
    out->first[2] = 5;
    memcpy(out->grid, grids, sizeof grids);
done:
    return status;
}

/* The second by name comes first: their order is not that of their names. */
static ritz_status sample_ports(ritz_component *out)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(out->port, 2);
    out->num_ports = 2;
    for (int64_t k = 0; k < 2; k++) {
        ritz_port *port = &out->port[k];

        snprintf(port->name, RITZ_NAME_SIZE, k == 0 ? "tip" : "base");
        RITZ_NEW(port->dofs.at, 3);
        port->dofs.count = 3;
        for (int64_t i = 0; i < 3; i++) {
            port->dofs.at[i] = 12 * k + 2 * i;
            port->origin[i] = 0.25 * (double)(i + k);
            port->axes[4 * i] = 1.0;
        }
    }
done:
    return status;
}

static ritz_status sample_loads(ritz_component *out)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(out->load, 2);
    out->num_loads = 2;
    snprintf(out->load[0].name, RITZ_NAME_SIZE, "spin");
    snprintf(out->load[1].name, RITZ_NAME_SIZE, "gravity");
    RITZ_TRY(chain(5.0, &out->load[0].KG));
    RITZ_TRY(chain(6.0, &out->load[1].KG));
done:
    return status;
}

ritz_status sample_component(bool full, ritz_component *out)
{
    ritz_status status = RITZ_OK;
    ritz_component component = {.num_dofs = SAMPLE_DOFS, .units = "kg m s"};

    RITZ_TRY(label(SAMPLE_DOFS, &component.dof));
    RITZ_TRY(chain(1.0, &component.M));
    if (full) {
        RITZ_TRY(chain(2.0, &component.K));
        RITZ_TRY(chain(3.0, &component.D));
        component.D.val[1] *= 3.0; /* unsymmetric, and kept so */
        RITZ_TRY(chain(4.0, &component.K4));
        RITZ_TRY(sample_loads(&component));
        RITZ_TRY(sample_grids(&component.grids));
        RITZ_TRY(sample_elements(&component.elements));
        RITZ_TRY(sample_ports(&component));
        RITZ_TRY(sample_io(SAMPLE_DOFS, &component.io));
        RITZ_TRY(sample_dampers(SAMPLE_DOFS, &component.dampers));
        RITZ_TRY(sample_recovery(&component.recovery));
        snprintf(component.damping, sizeof component.damping,
                 "modes 0.01 0.011 0.012 0.013 0.014 0.015 0.016 0.017 0.018 "
                 "0.019 0.02 0.021 0.022 0.023");
        component.digits = 16.0;
    }
    RITZ_TRY(ritz_component_settle(&component, false));
    component.asymmetry = full ? 3e-8 : 0.0;
    *out = component;
    component = (ritz_component){0};
done:
    ritz_component_free(&component);
    return status;
}

static const ritz_origin origin = {"craig-bampton", "modes 7",
                                   "CraigBampton1968", "dense LAPACK"};

static ritz_status sample_columns(ritz_columns *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_columns_new(SAMPLE_ORDER, out));
    for (int64_t j = 0; j < SAMPLE_ORDER; j++) {
        out->kind[j] = (ritz_column_kind)(j % (RITZ_COLUMN_SYSTEM + 1));
        out->dof[j] = j < 2 ? 3 * j : -1;
        if (j >= 2) {
            out->hertz[j] = 1.5 * (double)j;
            out->residual[j] = 1e-13 * (double)j;
        }
    }
done:
    return status;
}

ritz_status sample_basis(ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    ritz_basis basis = {.origin = origin};

    RITZ_TRY(filled(SAMPLE_DOFS, SAMPLE_ORDER, -7.0, &basis.T));
    RITZ_TRY(filled(SAMPLE_DOFS, SAMPLE_ORDER, 8.0, &basis.W));
    basis.states = true;
    snprintf(basis.damping, sizeof basis.damping, "modal 0.02");
    basis.among_hz = 12.5;
    basis.bound = 6.25;
    basis.num_hankel = 3;
    RITZ_NEW(basis.hankel, 3);
    for (int64_t k = 0; k < 3; k++)
        basis.hankel[k] = 4.0 - (double)k;
    RITZ_TRY(sample_columns(&basis.columns));
    *out = basis;
    basis = (ritz_basis){0};
done:
    ritz_basis_free(&basis);
    return status;
}

static ritz_status sample_maps(ritz_reduced *out)
{
    ritz_status status = RITZ_OK;

    RITZ_NEW(out->port, 2);
    out->num_ports = 2;
    for (int64_t k = 0; k < 2; k++) {
        ritz_port_map *port = &out->port[k];

        snprintf(port->name, RITZ_NAME_SIZE, k == 0 ? "tip" : "base");
        port->count = 6;
        RITZ_TRY(label(6, &port->dof));
        RITZ_NEW(port->position, 18);
        RITZ_TRY(filled(6, SAMPLE_ORDER, (double)k, &port->map));
        port->position[4] = port->origin[1] = 0.75;
        port->axes[0] = port->axes[4] = port->axes[8] = 1.0;
    }
done:
    return status;
}

static ritz_status sample_measures(ritz_measures *out)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_measures_add(out, "frequency-relative", 2e-3, 1e-2,
                               "mode 7, 3.41 Hz"));
    RITZ_TRY(ritz_measures_add(out, "response-relative-bound", HUGE_VAL,
                               nan(""), NULL));
done:
    return status;
}

ritz_status sample_reduced(bool full, ritz_reduced *out)
{
    ritz_status status = RITZ_OK;
    const int64_t r = SAMPLE_ORDER;
    ritz_reduced reduced = {
        .origin = origin, .num_dofs = SAMPLE_DOFS, .units = "kg m s"};

    RITZ_TRY(filled(r, r, 1.0, &reduced.K));
    RITZ_TRY(filled(r, r, 2.0, &reduced.M));
    RITZ_TRY(sample_columns(&reduced.columns));
    if (full) {
        RITZ_TRY(filled(r, r, 3.0, &reduced.D));
        RITZ_TRY(filled(r, r, 9.0, &reduced.K4));
        RITZ_TRY(sample_dampers(r, &reduced.dampers));
        RITZ_TRY(filled(SAMPLE_DOFS, r, 4.0, &reduced.T));
        RITZ_TRY(label(SAMPLE_DOFS, &reduced.dof));
        RITZ_TRY(sample_grids(&reduced.grids));
        RITZ_TRY(sample_elements(&reduced.elements));
        RITZ_TRY(sample_recovery(&reduced.recovery));
        RITZ_TRY(sample_maps(&reduced));
        RITZ_TRY(sample_io(r, &reduced.io));
        RITZ_TRY(sample_measures(&reduced.estimates));
        RITZ_TRY(sample_measures(&reduced.errors));
        reduced.inertia =
            (ritz_inertia){12.5, {1, 2, 3}, {4, 0, 0, 0, 5, 0, 0, 0, 6}, true};
        snprintf(reduced.damping, RITZ_NAME_SIZE, "rayleigh 0.1 1e-5");
        reduced.nested.smallest = 2;
        RITZ_TRY(ritz_nested_note(&reduced, 7, "mac-bound", 0.75));
        RITZ_TRY(ritz_nested_note(&reduced, 3, "frequency-relative", 0.25));
    }
    *out = reduced;
    reduced = (ritz_reduced){0};
done:
    ritz_reduced_free(&reduced);
    return status;
}

static ritz_status sample_configuration(bool full, int64_t k,
                                        ritz_configuration *out)
{
    ritz_status status = RITZ_OK;
    const int64_t e = SAMPLE_ORDER;

    snprintf(out->at, RITZ_NAME_SIZE, "clock=%d,cone=0", 60 * (int)k);
    out->rank = 3;
    out->num_rigid = 1;
    RITZ_TRY(filled(e, e, 1.0, &out->K));
    RITZ_TRY(filled(e, e, 2.0, &out->M));
    RITZ_NEW(out->lambda, e);
    for (int64_t j = 0; j < e; j++)
        out->lambda[j] = (double)(j * j);
    RITZ_NEW(out->P, 2);
    out->num_blocks = 2;
    RITZ_TRY(filled(5, e, 3.0, &out->P[0]));
    RITZ_TRY(filled(7, e, 4.0, &out->P[1]));
    RITZ_NEW(out->setting, 2);
    if (!full)
        goto done;
    out->num_settings = 2;
    out->setting[0] = 60.0 * (double)k;
    RITZ_TRY(filled(e, e, 5.0, &out->D));
    RITZ_TRY(filled(e, e, 6.0, &out->K4));
    RITZ_TRY(filled(6, e, 7.0, &out->momentum));
    for (int j = 0; j < 36; j++)
        out->rigid[j] = 0.25 * j;
    RITZ_TRY(sample_dampers(e, &out->dampers));
    RITZ_TRY(sample_io(e, &out->io));
    RITZ_TRY(sample_measures(&out->errors));
done:
    return status;
}

ritz_status sample_system(bool full, ritz_system *out)
{
    ritz_status status = RITZ_OK;
    ritz_system system = {.name = "dual-spin spacecraft, cruise",
                          .num_components = 2,
                          .num_sweeps = full ? 2 : 0,
                          .band_hz = {0.0, 10.0},
                          .damping = "bands 0 5 0.002 5 20 0.005",
                          .units = "kg m s"};
    int64_t configurations = full ? 3 : 1;

    RITZ_NEW(system.component, 2);
    RITZ_NEW(system.order, 2);
    RITZ_NEW(system.order_full, 2);
    RITZ_NEW(system.sweep, 2);
    snprintf(system.component[0], RITZ_NAME_SIZE, "stator");
    snprintf(system.component[1], RITZ_NAME_SIZE, "rotor");
    snprintf(system.sweep[0], RITZ_NAME_SIZE, "clock");
    snprintf(system.sweep[1], RITZ_NAME_SIZE, "cone");
    system.order[0] = 5;
    system.order[1] = 7;
    system.order_full[0] = 3000;
    system.order_full[1] = 120000;
    RITZ_NEW(system.configuration, configurations);
    for (int64_t k = 0; k < configurations; k++) {
        system.num_configurations++;
        RITZ_TRY(sample_configuration(full, k, &system.configuration[k]));
    }
    *out = system;
    system = (ritz_system){0};
done:
    ritz_system_free(&system);
    return status;
}

ritz_status sample_response(ritz_response *out)
{
    ritz_status status = RITZ_OK;
    ritz_response response = {.count = 20,
                              .num_inputs = 2,
                              .num_outputs = 3,
                              .method = "modal",
                              .damping = "modal 0.002"};

    RITZ_NEW(response.hertz, 20);
    RITZ_NEW(response.input, 2);
    RITZ_NEW(response.output, 3);
    RITZ_NEW(response.H, 120);
    snprintf(response.input[0], RITZ_NAME_SIZE, "torque");
    snprintf(response.input[1], RITZ_NAME_SIZE, "force");
    snprintf(response.output[0], RITZ_NAME_SIZE, "z");
    snprintf(response.output[1], RITZ_NAME_SIZE, "y");
    snprintf(response.output[2], RITZ_NAME_SIZE, "x");
    for (int k = 0; k < 20; k++)
        response.hertz[k] = 0.5 * k;
    for (int k = 0; k < 120; k++) {
        double *H = (double *)&response.H[k]; /* real, imaginary */

        H[0] = k;
        H[1] = -0.25 * k;
    }
    snprintf(response.interpolation, RITZ_NAME_SIZE, "cubic");
    response.tolerance = 1e-3;
    RITZ_NEW(response.singular, 40);
    response.num_singular = 2;
    for (int k = 0; k < 40; k++)
        response.singular[k] = 300.0 - k;
    response.singular_peak[0] = 0.125;
    response.singular_peak[1] = 300.5;
    *out = response;
    response = (ritz_response){0};
done:
    ritz_response_free(&response);
    return status;
}

ritz_status sample_simulation(ritz_simulation *out)
{
    ritz_status status = RITZ_OK;
    ritz_simulation s = {.count = 70,
                         .num_inputs = 1,
                         .num_outputs = 2,
                         .integrator = "trapezoidal",
                         .hold = "first",
                         .step = 0.025,
                         .order = 12,
                         .damping = "modal 0.002"};
    double **const energy[] = {&s.kinetic, &s.potential, &s.dissipated, &s.work,
                               &s.balance};

    RITZ_NEW(s.seconds, 70);
    RITZ_NEW(s.input, 1);
    RITZ_NEW(s.output, 2);
    RITZ_NEW(s.u, 70);
    RITZ_NEW(s.y, 140);
    snprintf(s.input[0], RITZ_NAME_SIZE, "torque");
    snprintf(s.output[0], RITZ_NAME_SIZE, "z");
    snprintf(s.output[1], RITZ_NAME_SIZE, "y");
    for (int k = 0; k < 70; k++) {
        s.seconds[k] = 0.025 * k;
        s.u[k] = 1.5 - k;
        s.y[2 * k] = 3.25 * k;
        s.y[2 * k + 1] = -1e-3 * k;
    }
    for (int j = 0; j < 5; j++) {
        RITZ_NEW(*energy[j], 70);
        for (int k = 0; k < 70; k++)
            (*energy[j])[k] = j + 0.01 * k;
    }
    *out = s;
    s = (ritz_simulation){0};
done:
    ritz_simulation_free(&s);
    return status;
}

ritz_status sample_ranking(ritz_ranking *out)
{
    const int64_t modes = 70;
    ritz_status status = RITZ_OK;
    ritz_ranking ranking = {.by = "hankel",
                            .reference = "Gawronski2004",
                            .count = modes,
                            .num_system = 2 * modes,
                            .at = "clock=60",
                            .damping = "modal 0.002",
                            .total = 2.5,
                            .coupling = nan("")};

    RITZ_NEW(ranking.cluster, modes);
    RITZ_TRY(ritz_ranking_parts(2, &ranking));
    for (int64_t k = 0; k < 2 * modes; k++)
        ranking.parts.val[k] = -0.5 * (double)k;
    for (int64_t k = 0; k < modes; k++)
        ranking.cluster[k] = k - k % 2;
    for (size_t k = 0; k < 2; k++) {
        ranking.whole[k] = nan("");
        RITZ_TRY(ritz_name_copy(k > 0 ? "gyro" : "tip", ranking.part[k]));
    }
    RITZ_NEW(ranking.hertz, modes);
    RITZ_NEW(ranking.zeta, modes);
    RITZ_NEW(ranking.value, modes);
    RITZ_NEW(ranking.order, modes);
    RITZ_NEW(ranking.system_value, 2 * modes);
    for (int64_t k = 0; k < modes; k++) {
        ranking.hertz[k] = 1.0 + (double)k;
        ranking.zeta[k] = 0.002 + 1e-5 * (double)k;
        ranking.value[k] = 1.0 / (1.0 + (double)((k * 29) % modes));
        ranking.order[k] = (k * 29) % modes; /* 29 and 70 share no factor */
        ranking.system_value[2 * k] = 1.0 / (1.0 + (double)k);
        ranking.system_value[2 * k + 1] = 1.0 / (1.5 + (double)k);
    }
    *out = ranking;
    ranking = (ritz_ranking){0};
done:
    ritz_ranking_free(&ranking);
    return status;
}

/* E is upper triangular, and so not singular. */
ritz_status sample_state_space(bool full, ritz_state_space *out)
{
    ritz_status status = RITZ_OK;
    const int64_t n = SAMPLE_ORDER;
    ritz_io io = {0};
    ritz_state_space model = {0};

    RITZ_TRY(full ? sample_io(n, &io) : ritz_io_new(n, 0, 0, &io));
    RITZ_TRY(ritz_state_space_new(n, &io, &model));
    model.origin = origin;
    snprintf(model.units, sizeof model.units, "kg m s");
    fill(&model.A, 1.0);
    fill(&model.B, 2.0);
    fill(&model.C, -3.0);
    fill(&model.D, 4.0);
    if (full) {
        RITZ_TRY(filled(n, n, 5.0, &model.E));
        for (int64_t j = 0; j < n; j++)
            for (int64_t i = j + 1; i < n; i++)
                ritz_dense_col(&model.E, j)[i] = 0.0;
        RITZ_TRY(sample_measures(&model.estimates));
        snprintf(model.damping, sizeof model.damping, "modal 0.02");
        model.columns.kind[0] = RITZ_COLUMN_RIGID;
        model.columns.hertz[0] = 0.0;
    }
    *out = model;
    model = (ritz_state_space){0};
done:
    ritz_io_free(&io);
    ritz_state_space_free(&model);
    return status;
}

#define WRITE(function, kind, sample)                                          \
    static ritz_status function(const char *path, const ritz_stamp *stamp)     \
    {                                                                          \
        ritz_##kind object = {0};                                              \
        ritz_status status = sample;                                           \
                                                                               \
        if (status == RITZ_OK)                                                 \
            status = ritz_container_write_##kind(path, &object, stamp);        \
        ritz_##kind##_free(&object);                                           \
        return status;                                                         \
    }

#define COPY(kind)                                                             \
    static ritz_status copy_##kind(const char *from, const char *to,           \
                                   const ritz_stamp *stamp)                    \
    {                                                                          \
        ritz_##kind object = {0};                                              \
        ritz_status status = ritz_container_read_##kind(from, &object);        \
                                                                               \
        if (status == RITZ_OK)                                                 \
            status = ritz_container_write_##kind(to, &object, stamp);          \
        ritz_##kind##_free(&object);                                           \
        return status;                                                         \
    }

WRITE(make_component, component, sample_component(true, &object))
WRITE(bare_component, component, sample_component(false, &object))
WRITE(make_reduced, reduced, sample_reduced(true, &object))
WRITE(bare_reduced, reduced, sample_reduced(false, &object))
WRITE(make_system, system, sample_system(true, &object))
WRITE(bare_system, system, sample_system(false, &object))
WRITE(make_response, response, sample_response(&object))
WRITE(bare_response, response, RITZ_OK)
WRITE(make_ranking, ranking, sample_ranking(&object))
WRITE(bare_ranking, ranking, RITZ_OK)
WRITE(make_simulation, simulation, sample_simulation(&object))
WRITE(bare_simulation, simulation, RITZ_OK)
WRITE(make_state_space, state_space, sample_state_space(true, &object))
WRITE(bare_state_space, state_space, sample_state_space(false, &object))
COPY(component)
COPY(reduced)
COPY(system)
COPY(response)
COPY(ranking)
COPY(state_space)
COPY(simulation)

static ritz_status make_basis(const char *path, const ritz_stamp *stamp)
{
    ritz_basis basis = {0};
    ritz_status status = sample_basis(&basis);

    if (status == RITZ_OK)
        status = ritz_container_write_basis(path, &basis, "kg m s", stamp);
    ritz_basis_free(&basis);
    return status;
}

static ritz_status bare_basis(const char *path, const ritz_stamp *stamp)
{
    ritz_basis basis = {0};
    ritz_status status = ritz_basis_new(3, 0, &basis);

    if (status == RITZ_OK)
        status = ritz_container_write_basis(path, &basis, "", stamp);
    ritz_basis_free(&basis);
    return status;
}

static ritz_status copy_basis(const char *from, const char *to,
                              const ritz_stamp *stamp)
{
    ritz_basis basis = {0};
    ritz_summary summary = {0};
    ritz_status status = ritz_container_read_basis(from, &basis);

    if (status == RITZ_OK)
        status = ritz_container_summary(from, &summary);
    if (status == RITZ_OK)
        status = ritz_container_write_basis(to, &basis, summary.units, stamp);
    ritz_summary_free(&summary);
    ritz_basis_free(&basis);
    return status;
}

const sample_kind sample_kinds[SAMPLE_KINDS] = {
    {"component", make_component, bare_component, copy_component},
    {"basis", make_basis, bare_basis, copy_basis},
    {"reduced", make_reduced, bare_reduced, copy_reduced},
    {"system", make_system, bare_system, copy_system},
    {"response", make_response, bare_response, copy_response},
    {"ranking", make_ranking, bare_ranking, copy_ranking},
    {"state-space", make_state_space, bare_state_space, copy_state_space},
    {"simulation", make_simulation, bare_simulation, copy_simulation},
};
