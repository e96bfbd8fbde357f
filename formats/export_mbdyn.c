/*
 * Writes a body for the modal joint of MBDyn: a text file .fem of record groups
 * [MBDyn2017], as release 1.5.3 and later read it. Written are the groups
 *
 *      1  counts            2  labels of nodes     5, 6, 7  their x, y, z
 *      8  modes: three translations and three rotations of each node
 *      9  modal mass       10  modal stiffness    13  modal damping
 *     11  masses of nodes
 *     19  stress stiffening, if terms of it are named [MBDyn2024]
 *
 * Group 19 is how many matrices follow, and of each its tag and its rows: K0 of
 *
 *     1 to 6    w_x^2 w_y^2 w_z^2 w_x w_y, w_y w_z, w_z w_x
 *     7 to 9    angular accelerations     10 to 12  accelerations less gravity
 *     12 + 6 (i - 1) + c   force (c 1 to 3) or moment (4 to 6) on the body at
 *                          interface node i of the joint
 *
 * each of the frame and along its axes: K0 times that is added to the modal
 * stiffness. Releases up to 1.7.3 stop at group 19.
 *
 * MBDyn computes the invariants of inertia as sums over the masses of group 11,
 * positions and modes. Masses at grids cannot give the invariants of a
 * consistent mass matrix. So grids have no mass here, and additional nodes have
 * the masses that give each invariant (formats/point_masses.c).
 *
 * Group 12, which has mass, centre and inertia, is not written, as they follow
 * from group 11. In a file with both, MBDyn 1.7.3 moves the nodes relative to
 * its `origin node`, but not the centre of group 12.
 *
 * A line that begins with "** RECORD GROUP " begins a group. All other lines
 * between groups are comments, of less than 8192 bytes: MBDyn stops at a longer
 * one.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/floating_report.h"
#include "formats/point_masses.h"
#include "formats/sink.h"
#include "formats/stiffening.h"

#include <inttypes.h>
#include <stdlib.h>

enum { COMMENT_WIDTH = 100, NUMBERS_A_LINE = 6 };

/* Labels of the additional nodes begin so, and differ from those of grids,
 * which are numbers. MBDyn allows no blank in a label. */
static const char point_label[] = "inertia";

typedef struct fem_file {
    ritz_floating body;
    ritz_point_masses points;
    ritz_stiffening_terms stiffening;
    char *certificate;
} fem_file;

static void fem_file_free(fem_file *fem)
{
    ritz_floating_free(&fem->body);
    ritz_point_masses_free(&fem->points);
    ritz_stiffening_terms_free(&fem->stiffening);
    free(fem->certificate);
}

/* ---- groups ------------------------------------------------------------- */

static void open_group(FILE *file, int number, const char *title)
{
    fprintf(file, "**\n** RECORD GROUP %d, %s\n", number, title);
}

/* Put number k of `count`, six in each line. */
static void put_number(FILE *file, int64_t k, int64_t count, double value)
{
    bool ends = (k + 1) % NUMBERS_A_LINE == 0 || k + 1 == count;

    fprintf(file, "%.17g%c", value, ends ? '\n' : ' ');
}

static void print_head(FILE *file, const fem_file *fem)
{
    fputs("** MBDyn MODAL DATA FILE\n", file);
    ritz_comment_put(file, "**   ", COMMENT_WIDTH, fem->certificate);
    open_group(file, 1, "HEADER");
    fprintf(file,
            "**   REVISION.  NODES.  NORMAL, ATTACHMENT, CONSTRAINT, REJECTED "
            "MODES.\nREV0 %" PRId64 " %" PRId64 " 0 0 0\n",
            fem->body.count + fem->points.count, fem->body.K.ncol);
}

static void print_labels(FILE *file, const fem_file *fem)
{
    open_group(file, 2, "FINITE ELEMENT NODE LIST");
    for (int64_t k = 0; k < fem->body.count; k++)
        fprintf(file, "%" PRId64 "\n", fem->body.id[k]);
    for (int64_t k = 0; k < fem->points.count; k++)
        fprintf(file, "%s%" PRId64 "\n", point_label, k + 1);
}

static void print_positions(FILE *file, const fem_file *fem)
{
    static const char *const title[3] = {
        "NODAL X COORDINATES", "NODAL Y COORDINATES", "NODAL Z COORDINATES"};

    for (int a = 0; a < 3; a++) {
        open_group(file, 5 + a, title[a]);
        for (int64_t k = 0; k < fem->body.count; k++)
            fprintf(file, "%.17g\n", fem->body.position[3 * k + a]);
        for (int64_t k = 0; k < fem->points.count; k++)
            fprintf(file, "%.17g\n", ritz_dense_col(&fem->points.field, a)[k]);
    }
}

static void print_modes(FILE *file, const fem_file *fem)
{
    const ritz_floating *body = &fem->body;
    int64_t m = body->K.ncol;

    open_group(file, 8, "NON-ORTHOGONALIZED MODE SHAPES");
    for (int64_t j = 0; j < m; j++) {
        const double *u = ritz_dense_col(&body->shape, j);
        const double *turn =
            body->turn.val ? ritz_dense_col(&body->turn, j) : NULL;

        fprintf(file, "**    NORMAL MODE SHAPE #  %" PRId64 "\n", j + 1);
        for (int64_t k = 0; k < body->count; k++)
            for (int a = 0; a < 6; a++)
                put_number(file, a, 6,
                           a < 3  ? u[3 * k + a]
                           : turn ? turn[3 * k + a - 3]
                                  : 0.0);
        for (int64_t k = 0; k < fem->points.count; k++)
            for (int a = 0; a < 6; a++)
                put_number(
                    file, a, 6,
                    a < 3 ? ritz_dense_col(&fem->points.field, 3 + a * m + j)[k]
                          : 0.0);
    }
}

/* MBDyn reads matrices by rows. */
static void print_rows(FILE *file, const ritz_dense *A)
{
    for (int64_t i = 0; i < A->nrow; i++)
        for (int64_t j = 0; j < A->ncol; j++)
            put_number(file, j, A->ncol, ritz_dense_col(A, j)[i]);
}

static void print_matrix(FILE *file, int group, const char *title,
                         const ritz_dense *A)
{
    if (!A->val)
        return;
    open_group(file, group, title);
    print_rows(file, A);
}

/* Tag of a term in group 19. */
static int64_t find_tag(const ritz_stiffening_terms *s,
                        const ritz_stiffening_term *term)
{
    int64_t node = 0;

    if (term->kind < RITZ_FORCE)
        return term->kind + 1;
    while (s->grid[node] != term->grid)
        node++;
    return RITZ_FORCE + 6 * node + (term->kind - RITZ_FORCE) + 1;
}

/* No comment may be within the group. */
static void print_stiffening(FILE *file, const ritz_stiffening_terms *s)
{
    if (s->count == 0)
        return;
    open_group(file, 19, "MODAL STRESS STIFFENING MATRICES");
    fprintf(file, "%" PRId64 "\n", s->count);
    for (int64_t k = 0; k < s->count; k++) {
        fprintf(file, "%" PRId64 "\n", find_tag(s, &s->term[k]));
        print_rows(file, &s->term[k].K0);
    }
}

static void print_masses(FILE *file, const fem_file *fem)
{
    open_group(file, 11, "DIAGONAL OF LUMPED MASS MATRIX");
    for (int64_t k = 0; k < fem->body.count; k++)
        fputs("0 0 0 0 0 0\n", file);
    for (int64_t k = 0; k < fem->points.count; k++) {
        double m = fem->points.mass[k];

        fprintf(file, "%.17g %.17g %.17g 0 0 0\n", m, m, m);
    }
}

static ritz_status print_file(FILE *file, const void *what)
{
    const fem_file *fem = what;

    print_head(file, fem);
    print_labels(file, fem);
    print_positions(file, fem);
    print_modes(file, fem);
    print_matrix(file, 9, "MODAL MASS MATRIX", &fem->body.M);
    print_matrix(file, 10, "MODAL STIFFNESS MATRIX", &fem->body.K);
    print_masses(file, fem);
    print_matrix(file, 13, "MODAL DAMPING MATRIX", &fem->body.D);
    print_stiffening(file, &fem->stiffening);
    fputs("**\n** END OF FILE\n", file);
    return RITZ_OK;
}

/* ---- exporter ----------------------------------------------------------- */

static ritz_status say_points(const ritz_point_masses *points,
                              ritz_export_report *report)
{
    RITZ_CHECK(ritz_export_say(report,
                               "nodes %s1 to %s%" PRId64
                               " are not grids of the deck: their masses give "
                               "MBDyn the inertia of the body and of its modes",
                               point_label, point_label, points->count));
    if (points->num_negative > 0)
        RITZ_CHECK(ritz_export_say(
            report,
            "%" PRId64 " of their masses are negative: rotations of grids have "
            "inertia that no positive masses give (%.2g of the largest)",
            points->num_negative, -points->least));
    return RITZ_OK;
}

/* An interface node of MBDyn takes its orientation from its grid. */
static ritz_status say_rotations(const ritz_floating *body,
                                 ritz_export_report *report)
{
    int64_t without = 0;

    for (int64_t k = 0; k < body->count; k++)
        without += !body->rotates[k];
    if (without == 0)
        return RITZ_OK;
    return ritz_export_say(
        report,
        "%" PRId64 " of %" PRId64 " grids without rotations: an interface "
        "node there turns with the frame, as if the body were rigid",
        without, body->count);
}

/* What group 19 asks of the joint. */
static ritz_status say_stiffening(const ritz_reduced *reduced,
                                  const ritz_stiffening_terms *s,
                                  ritz_export_report *report)
{
    char grids[128] = "";
    size_t used = 0;

    RITZ_CHECK(ritz_stiffening_terms_say(reduced, s, report));
    if (s->count == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_export_say(
        report, "record group 19 is for MBDyn after 1.7.3, which takes it with "
                "'use automatic differentiation' in its control data"));
    for (int64_t k = 0; k < s->num_grids && used < sizeof grids; k++)
        used += (size_t)snprintf(grids + used, sizeof grids - used,
                                 "%s%" PRId64, k > 0 ? ", " : "", s->grid[k]);
    RITZ_REFUSE_IF(used >= sizeof grids, RITZ_ERR_ARGUMENT,
                   "forces and moments are of too many grids");
    if (s->num_grids == 0)
        return RITZ_OK;
    return ritz_export_say(report,
                           "its forces and moments count interface nodes: "
                           "those of the joint must begin with grids %s, in "
                           "this order",
                           grids);
}

static ritz_status say_losses(const ritz_reduced *reduced, const fem_file *fem,
                              ritz_export_report *report)
{
    RITZ_CHECK(say_stiffening(reduced, &fem->stiffening, report));
    RITZ_CHECK(say_points(&fem->points, report));
    RITZ_CHECK(say_rotations(&fem->body, report));
    RITZ_CHECK(ritz_floating_say_damping(reduced, &fem->body, report));
    if (fem->body.D.val)
        RITZ_CHECK(ritz_export_say(report,
                                   "the joint takes damping of the file by "
                                   "'damping from file'"));
    RITZ_CHECK(ritz_export_say(report, "17 digits, which keep every bit"));
    return ritz_export_say(report,
                           "inputs, outputs, ports and units are left out: the "
                           "file has no place for them but comments");
}

static ritz_status write_body(const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    const ritz_floating_request frame = ritz_floating_asked(request);
    RITZ_OWN(fem_file) fem = {0};

    RITZ_CHECK(ritz_floating_of(object->reduced, &frame, &fem.body));
    RITZ_CHECK(ritz_point_masses_of(&fem.body.inertia, &fem.body.invariants,
                                    &fem.body.M, &fem.points));
    RITZ_CHECK(ritz_stiffening_terms_of(object->reduced, &fem.body, &fem.body.U,
                                        request->stiffening, &fem.stiffening));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &fem.certificate));
    RITZ_CHECK(ritz_sink_write(request->output, print_file, &fem));
    RITZ_CHECK(ritz_floating_say(&fem.body, report));
    return say_losses(object->reduced, &fem, report);
}

const ritz_exporter ritz_exporter_mbdyn = {
    .name = "mbdyn",
    .summary = "a body for the modal joint of MBDyn (.fem)",
    .reference = "MBDyn2017",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_FRAME | RITZ_EXPORT_STIFFENING,
    .write = write_body,
};
