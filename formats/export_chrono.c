/*
 * Writes the matrices of a component for Project Chrono [Chrono2025], where
 * they are a load between bodies and shafts. The file is text that a few lines
 * of C++ or another language can read:
 *
 *     # comments: the certificate
 *     frames K
 *     GRID X Y Z            K lines: interface frames at rest, basic axes
 *     modes N
 *     HERTZ                 N lines: with all frames held; 0: no stiffness
 *     M                     6 K + N lines of as many numbers; then K and D
 *
 * Coordinates are six small motions of each frame, translations before
 * rotations, and then modes. Numbers have 17 digits.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/sink.h"
#include "model/interface_form.h"

#include <inttypes.h>
#include <stdlib.h>

typedef struct chrono_load {
    ritz_interface_form form;
    double *hertz; /* of the modes */
    char *certificate;
} chrono_load;

static void chrono_load_free(chrono_load *load)
{
    ritz_interface_form_free(&load->form);
    RITZ_FREE(load->hertz, load->certificate);
}

static int64_t count_modes(const chrono_load *load)
{
    return load->form.K.ncol - RITZ_FRAME_MOTIONS * load->form.count;
}

/* Frequencies with all frames held. The form itself has none where it kept the
   columns of the basis. */
static ritz_status list_frequencies(chrono_load *load)
{
    const int64_t m = count_modes(load);
    RITZ_OWN(ritz_pairs) pairs = {0};

    RITZ_CHECK_NEW(load->hertz, m);
    if (m == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_interface_form_modes(&load->form, &pairs));
    for (int64_t k = pairs.num_rigid; k < pairs.Phi.ncol; k++)
        load->hertz[k] = ritz_eigen_hertz(pairs.lambda[k]);
    return RITZ_OK;
}

static ritz_status put_load(FILE *file, const void *what)
{
    const chrono_load *load = what;
    const ritz_interface_form *form = &load->form;

    ritz_comment_put(file, "# ", 0, load->certificate);
    fprintf(file, "frames %" PRId64 "\n", form->count);
    for (int64_t k = 0; k < form->count; k++)
        fprintf(file, "%" PRId64 " %.17g %.17g %.17g\n", form->grid[k],
                form->position[3 * k], form->position[3 * k + 1],
                form->position[3 * k + 2]);
    fprintf(file, "modes %" PRId64 "\n", count_modes(load));
    for (int64_t k = 0; k < count_modes(load); k++)
        fprintf(file, "%.17g\n", load->hertz[k]);
    fputs("M\n", file);
    ritz_rows_put(file, &form->M, form->K.ncol);
    fputs("K\n", file);
    ritz_rows_put(file, &form->K, form->K.ncol);
    fputs("D\n", file);
    ritz_rows_put(file, &form->D, form->K.ncol);
    return RITZ_OK;
}

static ritz_status say_load(const chrono_load *load,
                            const ritz_reduced *reduced,
                            ritz_export_report *report)
{
    ritz_interface_ground ground = {0};

    RITZ_CHECK(ritz_interface_form_ground(&load->form, &ground));
    RITZ_CHECK(ritz_export_say(
        report, "%" PRId64 " interface %s and %" PRId64 " modes; all digits",
        load->form.count, load->form.count == 1 ? "frame" : "frames",
        count_modes(load)));
    if (ground.holds)
        RITZ_CHECK(ritz_export_say(report,
                                   "the ground holds the body: rigid motion "
                                   "has %.3g Hz",
                                   ground.rigid_hz));
    if (reduced->K4.val)
        RITZ_CHECK(ritz_export_say(report, "structural damping is left out"));
    return ritz_export_say(report,
                           "the matrices are for small motions about the "
                           "frames at rest; inputs, outputs and shapes are "
                           "left out");
}

static ritz_status write_load(const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    RITZ_OWN(chrono_load) load = {0};

    RITZ_CHECK(
        ritz_interface_form_of(object->reduced, request->ports, &load.form));
    RITZ_CHECK(list_frequencies(&load));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &load.certificate));
    RITZ_CHECK(ritz_sink_write(request->output, put_load, &load));
    return say_load(&load, object->reduced, report);
}

const ritz_exporter ritz_exporter_chrono = {
    .name = "chrono",
    .summary = "matrices of frames and modes for Project Chrono, text",
    .reference = "Chrono2025",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_PORTS,
    .write = write_load,
};
