/*
 * Writes the data of the block "Reduced Order Flexible Solid" of Simscape
 * Multibody [SimscapeSolid2024] as a MAT file. The coordinates are six small
 * motions of each interface frame, translations before rotations, along the
 * basic axes, and then modes. The variables are
 *
 *     P            k x 3, origins of the interface frames
 *     Q            k x 4, their unit quaternions: all axes are the basic ones
 *     K, M, C      stiffness, mass and damping, of order 6 k + modes
 *     frames       names of the interface frames, port and grid
 *     units, certificate   text
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/mat_sheet.h"
#include "model/interface_form.h"

#include <inttypes.h>
#include <stdlib.h>

typedef struct flexible_solid {
    ritz_interface_form form;
    double *origin, *turn; /* P and Q, column-major */
    char (*name)[RITZ_NAME_SIZE];
    char *certificate;
    ritz_interface_ground ground;
} flexible_solid;

static void flexible_solid_free(flexible_solid *s)
{
    ritz_interface_form_free(&s->form);
    RITZ_FREE(s->origin, s->turn, s->name, s->certificate);
}

/* Name a frame "PORT grid 5". A long name of a port is shortened. */
static void name_frame(const ritz_interface_form *form, int64_t k,
                       char out[RITZ_NAME_SIZE])
{
    char grid[32];
    const int length =
        snprintf(grid, sizeof grid, " grid %" PRId64, form->grid[k]);

    snprintf(out, RITZ_NAME_SIZE, "%.*s%s", RITZ_NAME_SIZE - 1 - length,
             form->port[k], grid);
}

static ritz_status list_frames(flexible_solid *s)
{
    const int64_t count = s->form.count;

    RITZ_CHECK_NEW(s->origin, 3 * count);
    RITZ_CHECK_NEW(s->turn, 4 * count);
    RITZ_CHECK_NEW(s->name, count);
    for (int64_t k = 0; k < count; k++) {
        for (int64_t i = 0; i < 3; i++)
            s->origin[i * count + k] = s->form.position[3 * k + i];
        s->turn[k] = 1.0;
        name_frame(&s->form, k, s->name[k]);
    }
    return RITZ_OK;
}

static ritz_status put_matrix(ritz_mat_sheet *sheet, const char *name,
                              const ritz_dense *A)
{
    return A->val ? ritz_mat_put_real(sheet, name, A->nrow, A->ncol, A->val)
                  : RITZ_OK;
}

static ritz_status write_file(const char *path, const ritz_reduced *reduced,
                              const flexible_solid *s)
{
    const int64_t count = s->form.count;
    RITZ_OWN(ritz_mat_sheet) sheet = {0};

    RITZ_CHECK(ritz_mat_sheet_open(path, &sheet));
    RITZ_CHECK(ritz_mat_put_real(&sheet, "P", count, 3, s->origin));
    RITZ_CHECK(ritz_mat_put_real(&sheet, "Q", count, 4, s->turn));
    RITZ_CHECK(put_matrix(&sheet, "K", &s->form.K));
    RITZ_CHECK(put_matrix(&sheet, "M", &s->form.M));
    RITZ_CHECK(put_matrix(&sheet, "C", &s->form.D));
    RITZ_CHECK(ritz_mat_put_names(&sheet, "frames", count, s->name));
    RITZ_CHECK(ritz_mat_put_text(&sheet, "units", reduced->units));
    RITZ_CHECK(ritz_mat_put_text(&sheet, "certificate", s->certificate));
    return ritz_mat_sheet_publish(&sheet, NULL);
}

static ritz_status say_coordinates(const flexible_solid *s,
                                   ritz_export_report *report)
{
    const int64_t motions = RITZ_FRAME_MOTIONS * s->form.count;

    RITZ_CHECK(ritz_export_say(
        report, "%" PRId64 " interface %s and %" PRId64 " modes; all digits",
        s->form.count, s->form.count == 1 ? "frame" : "frames",
        s->form.K.ncol - motions));
    for (int64_t k = 0; k < s->form.count; k++)
        RITZ_CHECK(ritz_export_say(
            report, "frame %" PRId64 ": port %s at %.9g %.9g %.9g", k + 1,
            s->name[k], s->form.position[3 * k], s->form.position[3 * k + 1],
            s->form.position[3 * k + 2]));
    return ritz_export_say(report,
                           "rigid motions at %.2g Hz at most, the first "
                           "flexible mode at %.6g Hz",
                           s->ground.rigid_hz, s->ground.flexible_hz);
}

static ritz_status say_losses(const flexible_solid *s,
                              const ritz_reduced *reduced,
                              ritz_export_report *report)
{
    if (s->ground.holds)
        RITZ_CHECK(ritz_export_say(
            report, "warning: the ground holds the body, and Simscape lets "
                    "its solids move freely: import it without supports"));
    if (s->form.num_loose > 0)
        RITZ_CHECK(ritz_export_say(
            report,
            "%" PRId64 " modes have no stiffness while the frames are "
            "held, as those of a hinge",
            s->form.num_loose));
    if (reduced->K4.val)
        RITZ_CHECK(ritz_export_say(report, "structural damping is left out"));
    return ritz_export_say(report, "inputs, outputs and shapes of other grids "
                                   "are left out: the block has no place for "
                                   "them");
}

static ritz_status write_solid(const ritz_export_object *object,
                               const ritz_export_request *request,
                               ritz_export_report *report)
{
    const ritz_reduced *reduced = object->reduced;
    RITZ_OWN(flexible_solid) s = {0};

    RITZ_CHECK(ritz_interface_form_of(reduced, request->ports, &s.form));
    RITZ_CHECK(ritz_interface_form_ground(&s.form, &s.ground));
    RITZ_CHECK(list_frames(&s));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &s.certificate));
    RITZ_CHECK_IN(request->output, write_file(request->output, reduced, &s));
    RITZ_CHECK(say_coordinates(&s, report));
    return say_losses(&s, reduced, report);
}

const ritz_exporter ritz_exporter_simscape = {
    .name = "simscape",
    .summary = "a reduced-order flexible solid for Simscape Multibody, MAT",
    .reference = "SimscapeSolid2024",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_PORTS,
    .write = write_solid,
};
