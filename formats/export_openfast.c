/*
 * A superelement for the module ExtPtfm of OpenFAST [OpenFAST2025]: the mass,
 * stiffness and damping matrices of a component that one grid joins to the
 * tower. The first six coordinates are the motion of that grid along basic
 * axes, the others are modes while it is held. If constraint modes move that
 * grid along basic axes already, every bit of the matrices is kept.
 *
 * Release 5 reads matrices behind the line that names them, and weights;
 * releases 2.3 to 4 skip a line in between, and read loads over time.
 * Lines that begin with "! " are comments to both, and tell how the component
 * was made and what is known of its errors.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "formats/certificate.h"
#include "formats/sink.h"
#include "model/interface_form.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

enum { DIRECTIONS = RITZ_FRAME_MOTIONS };

typedef struct superelement {
    const ritz_reduced *reduced;
    bool weighs; /* release 5: the file has weights */
    ritz_interface_form form;
    char *certificate;
} superelement;

static void superelement_free(superelement *s)
{
    ritz_interface_form_free(&s->form);
    free(s->certificate);
}

/* ---- the interface ------------------------------------------------------ */

/* Find the six coordinates of one grid, or refuse and say how to get them. */
static ritz_status find_interface(const ritz_reduced *reduced,
                                  const char *ports, ritz_interface_form *form)
{
    RITZ_CHECK(ritz_interface_form_of(reduced, ports, form));
    RITZ_REFUSE_IF(
        form->count != 1, RITZ_ERR_ARGUMENT,
        "OpenFAST holds a superelement by the six directions of one grid, and "
        "its ports have %" PRId64 " grids: tie what is joined to one grid by "
        "an RBE2 in the deck and import that grid as the port, or name one "
        "port with --port",
        form->count);
    return RITZ_OK;
}

static ritz_status fill_superelement(const ritz_reduced *reduced,
                                     const char *ports, superelement *out)
{
    RITZ_CHECK(ritz_export_demand_si(reduced->units, "OpenFAST"));
    return find_interface(reduced, ports, &out->form);
}

/* ---- its file ----------------------------------------------------------- */

/* The first line is a comment, the second one names the format. */
static void print_head(FILE *file, const superelement *s)
{
    fprintf(file,
            "! superelement for the module ExtPtfm\n! Flex 5 Format\n"
            "! kg m s; six motions of grid %" PRId64
            " along basic axes, then %" PRId64 " modes\n",
            s->form.grid[0], s->form.K.ncol - DIRECTIONS);
    if (!s->form.D.val)
        fputs("! the damping matrix is zero\n", file);
    ritz_comment_put(file, "! ", 0, s->certificate);
}

static void put_zeros(FILE *file, int64_t count)
{
    for (int64_t k = 0; k < count; k++)
        fputs(k > 0 ? " 0" : "0", file);
    fputc('\n', file);
}

/* Rows of A, or of zeros if A is {0}. */
static void print_matrix(FILE *file, const superelement *s, const char *title,
                         const ritz_dense *A)
{
    int64_t n = s->form.K.ncol;

    fprintf(file, "!%s\n", title);
    if (!s->weighs)
        fprintf(file, "!Dimension: %" PRId64 "\n", n);
    ritz_rows_put(file, A, n);
}

/* Zero loads and wave elevation at the times 0 and 1, which also hold after. */
static void print_loads(FILE *file, int64_t n)
{
    fprintf(file,
            "!Loading and Wave Elevation (N, m)\n!Dimension: 1 time column - "
            "%" PRId64 " force columns - 1 wave elevation column\n",
            n);
    for (int t = 0; t < 2; t++) {
        fprintf(file, "%d ", t);
        put_zeros(file, n + 1);
    }
}

static ritz_status print_file(FILE *file, const void *what)
{
    const superelement *s = what;
    int64_t n = s->form.K.ncol;

    print_head(file, s);
    fprintf(file, "!Dimension: %" PRId64 "\n", n);
    if (!s->weighs)
        fputs("!Time increment in simulation: 1\n"
              "!Total simulation time in file: 1\n",
              file);
    print_matrix(file, s, "Mass Matrix (kg, m)", &s->form.M);
    print_matrix(file, s, "Stiffness Matrix (N, m)", &s->form.K);
    print_matrix(file, s, "Damping Matrix (N, m, s)", &s->form.D);
    if (s->weighs) {
        fputs("!Weight constant (N, m)\n", file);
        put_zeros(file, n);
        print_matrix(file, s, "Weight stiffness (N, m)", &(ritz_dense){0});
    } else {
        print_loads(file, n);
    }
    return RITZ_OK;
}

/* ---- exporters ---------------------------------------------------------- */

static ritz_status say_losses(const superelement *s, ritz_export_report *report)
{
    const ritz_reduced *reduced = s->reduced;

    if (*reduced->damping)
        RITZ_CHECK(ritz_export_say(report, "damping '%.200s' is in the matrix",
                                   reduced->damping));
    if (reduced->K4.val)
        RITZ_CHECK(ritz_export_say(report, "structural damping left out"));
    RITZ_CHECK(ritz_export_say(
        report, s->weighs ? "self-weight is left out: its vector and its "
                            "stiffness are zero"
                          : "loads and wave elevation are zero at all times"));
    RITZ_CHECK(ritz_export_say(
        report,
        "grid %lld is to be the platform reference point of ElastoDyn, "
        "and basic axis z the vertical",
        (long long)s->form.grid[0]));
    return ritz_export_say(report, "inputs, outputs and shapes are left out: "
                                   "the file has no place for them");
}

static ritz_status write_superelement(const ritz_export_object *object,
                                      const ritz_export_request *request,
                                      bool weighs, ritz_export_report *report)
{
    RITZ_OWN(superelement) s = {.weighs = weighs};

    s.reduced = object->reduced;
    RITZ_CHECK(ritz_certificate(object, request->stamp, &s.certificate));
    RITZ_CHECK(fill_superelement(object->reduced, request->ports, &s));
    RITZ_CHECK(ritz_sink_write(request->output, print_file, &s));
    RITZ_CHECK(ritz_export_say(
        report,
        "six directions of grid %lld and %lld modes; matrices with all digits",
        (long long)s.form.grid[0], (long long)s.form.K.ncol - DIRECTIONS));
    return say_losses(&s, report);
}

static ritz_status write_weighing(const ritz_export_object *object,
                                  const ritz_export_request *request,
                                  ritz_export_report *report)
{
    return write_superelement(object, request, true, report);
}

static ritz_status write_loaded(const ritz_export_object *object,
                                const ritz_export_request *request,
                                ritz_export_report *report)
{
    return write_superelement(object, request, false, report);
}

const ritz_exporter ritz_exporter_openfast = {
    .name = "openfast",
    .summary = "a superelement for OpenFAST 5 (ExtPtfm)",
    .reference = "OpenFAST2025",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_PORTS,
    .write = write_weighing,
};

const ritz_exporter ritz_exporter_openfast_4 = {
    .name = "openfast-4",
    .summary = "a superelement for OpenFAST 2.3 to 4 (FlexASCII)",
    .reference = "OpenFAST2025",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_PORTS,
    .write = write_loaded,
};
