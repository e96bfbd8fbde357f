#include "frame.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 6, NODE = 3 };

const frame_section frame_mcdaniel = {
    .rho = 1000.0, .area = 0.01, .inertia = 8.3e-6, .modulus = 1.5e4};

/* Put a 4 x 4 bending and a 2 x 2 axial matrix together, rows u v theta. */
static void fill(const double axial[2], const double bending[4][4],
                 double out[SIDE][SIDE])
{
    static const int bend[4] = {1, 2, 4, 5};

    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++)
            out[i][j] = 0.0;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)
            out[NODE * i][NODE * j] = axial[i == j ? 0 : 1];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out[bend[i]][bend[j]] = bending[i][j];
}

static void stiffness(double l, const frame_section *s, double out[SIDE][SIDE])
{
    double a = s->modulus * s->area / l;
    double b = s->modulus * s->inertia / (l * l * l);
    const double axial[2] = {a, -a};
    const double bending[4][4] = {
        {12 * b, 6 * l * b, -12 * b, 6 * l * b},
        {6 * l * b, 4 * l * l * b, -6 * l * b, 2 * l * l * b},
        {-12 * b, -6 * l * b, 12 * b, -6 * l * b},
        {6 * l * b, 2 * l * l * b, -6 * l * b, 4 * l * l * b},
    };

    fill(axial, bending, out);
}

static void mass(double l, const frame_section *s, double out[SIDE][SIDE])
{
    double a = s->rho * s->area * l / 6.0;
    double b = s->rho * s->area * l / 420.0;
    const double axial[2] = {2 * a, a};
    const double bending[4][4] = {
        {156 * b, 22 * l * b, 54 * b, -13 * l * b},
        {22 * l * b, 4 * l * l * b, 13 * l * b, -3 * l * l * b},
        {54 * b, 13 * l * b, 156 * b, -22 * l * b},
        {-13 * l * b, -3 * l * l * b, -22 * l * b, 4 * l * l * b},
    };

    fill(axial, bending, out);
}

/* Rows first .. first + n - 1 of the chain of one element matrix. */
static ritz_status assemble(int64_t elements, int64_t first, int64_t n,
                            const double element[SIDE][SIDE], ritz_sparse *out)
{
    ritz_status status = RITZ_OK;
    int64_t *row = NULL;
    int64_t *col = NULL;
    double *val = NULL;
    int64_t k = 0;

    RITZ_NEW(row, SIDE * SIDE * elements);
    RITZ_NEW(col, SIDE * SIDE * elements);
    RITZ_NEW(val, SIDE * SIDE * elements);
    for (int64_t e = 0; e < SIDE * SIDE * elements; e++) {
        int64_t i = e / SIDE % SIDE;
        int64_t j = e % SIDE;

        row[k] = NODE * (e / (SIDE * SIDE)) + i - first;
        col[k] = NODE * (e / (SIDE * SIDE)) + j - first;
        val[k] = element[i][j];
        if (row[k] >= 0 && row[k] < n && col[k] >= 0 && col[k] < n)
            k++;
    }
    RITZ_TRY(ritz_sparse_from_triplets(n, n, k, row, col, val, out));
done:
    free(row);
    free(col);
    free(val);
    return status;
}

static ritz_status place(int64_t elements, double l, double offset,
                         int64_t first_grid, ritz_grids *out)
{
    ritz_status status = RITZ_OK;

    out->count = elements + 1;
    out->num_frames = 1;
    RITZ_NEW(out->id, elements + 1);
    RITZ_NEW(out->frame, elements + 1);
    RITZ_NEW(out->position, 3 * (elements + 1));
    RITZ_NEW(out->axes, 9);
    for (int k = 0; k < 3; k++)
        out->axes[4 * k] = 1.0;
    for (int64_t g = 0; g <= elements; g++) {
        out->id[g] = first_grid + g;
        out->position[3 * g] = offset + (double)g * l;
    }
done:
    return status;
}

ritz_status frame_component(int64_t elements, double length_of_element,
                            const frame_section *section, bool clamp_left,
                            bool clamp_right, int64_t first_grid,
                            ritz_component *out)
{
    static const int64_t direction[NODE] = {1, 2, 6};
    ritz_status status = RITZ_OK;
    ritz_component beam = {.units = "none"};
    double element[SIDE][SIDE];
    int64_t first = clamp_left ? NODE : 0;
    int64_t n = NODE * (elements + 1) - first - (clamp_right ? NODE : 0);

    beam.num_dofs = n;
    RITZ_NEW(beam.dof, n);
    for (int64_t i = 0; i < n; i++)
        beam.dof[i] =
            (ritz_dof){first_grid + (first + i) / NODE, direction[i % NODE]};
    stiffness(length_of_element, section, element);
    RITZ_TRY(assemble(elements, first, n, element, &beam.K));
    mass(length_of_element, section, element);
    RITZ_TRY(assemble(elements, first, n, element, &beam.M));
    RITZ_TRY(place(elements, length_of_element, section->offset, first_grid,
                   &beam.grids));
    RITZ_TRY(ritz_component_settle(&beam, false));
    *out = beam;
    beam = (ritz_component){0};
done:
    ritz_component_free(&beam);
    return status;
}

ritz_status frame_io(ritz_component *beam, int64_t num_inputs,
                     const int64_t *input_row, int64_t num_outputs,
                     const int64_t *output_row)
{
    ritz_status status = RITZ_OK;
    ritz_io io = {0};

    RITZ_TRY(ritz_io_new(beam->num_dofs, num_inputs, num_outputs, &io));
    for (int64_t j = 0; j < num_inputs; j++) {
        (void)snprintf(io.input[j], RITZ_NAME_SIZE, "u%" PRId64, j + 1);
        ritz_dense_col(&io.B, j)[input_row[j]] = 1.0;
    }
    for (int64_t i = 0; i < num_outputs; i++) {
        (void)snprintf(io.output[i], RITZ_NAME_SIZE, "y%" PRId64, i + 1);
        ritz_dense_col(&io.C, output_row[i])[i] = 1.0;
    }
    ritz_io_free(&beam->io);
    beam->io = io;
    io = (ritz_io){0};
done:
    ritz_io_free(&io);
    return status;
}
