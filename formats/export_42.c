/*
 * A flexible body of 42, the spacecraft simulator of NASA [Stoneking2025], as
 * its InitFlexModes() reads it. With modes psi of translation and theta of
 * rotation, from the reference point of the body along its axes,
 *
 *     Pf = int psi        L_ij = int psi_i r_j
 *     Hf = int r x psi    N_ij = int psi_i' psi_j
 *
 * from which 42 makes all coupling of first and second order [Stoneking2010].
 * The reference point is the centre of mass, where 42 sets Pf and Hf to zero
 * (REFPT_CM), or the origin of the body's axes (REFPT_JOINT).
 *
 * 42 reads the text after the numbers of a line by "%[^\n]" into 80 bytes: each
 * line needs such a text, of at most 79 letters. 42 stops at "[EOF]"; the text
 * after it is for people. A second file has the nodes.
 */
#include "base/alloc.h"
#include "base/draft.h"
#include "base/text.h"
#include "formats/certificate.h"
#include "formats/normal_body.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_ROOM = 39 }; /* letters of a file's name that 42 stores */

typedef struct body_42 {
    const ritz_reduced *reduced;
    ritz_normal_body normal;
    bool at_centre; /* REFPT_CM */
    int64_t *node;  /* for each port, the index of its node; -1 if it has more
                       than one grid, and so is no joint */
    char *certificate;
} body_42;

static void body_42_free(body_42 *b)
{
    ritz_normal_body_free(&b->normal);
    free(b->node);
    free(b->certificate);
}

/* ---- the body ----------------------------------------------------------- */

/* With the reference point at the centre of mass, 42 takes Pf and Hf as zero.
   That is true of modes referred to mean axes only. */
static ritz_status find_body(const ritz_reduced *reduced,
                             const ritz_export_request *request, body_42 *b)
{
    const ritz_floating_request wanted = {
        request->frame ? request->frame : "centre", request->reference};

    b->reduced = reduced;
    b->at_centre = strcmp(wanted.frame, "centre") == 0;
    RITZ_CHECK(ritz_normal_body_of(reduced, &wanted, &b->normal));
    RITZ_REFUSE_IF(
        b->at_centre &&
            b->normal.floating.reference != RITZ_REFERENCE_MEAN_AXIS,
        RITZ_ERR_ARGUMENT,
        "at the centre of mass 42 takes modes of a free body that are referred "
        "to mean axes: name another frame, as --frame basic");
    return RITZ_OK;
}

/* A joint of 42 moves with one node, so only a port of one grid can be one. */
static ritz_status find_joints(body_42 *b)
{
    const ritz_reduced *reduced = b->reduced;
    const ritz_floating *f = &b->normal.floating;

    RITZ_CHECK_NEW(b->node, reduced->num_ports);
    for (int64_t k = 0; k < reduced->num_ports; k++) {
        const ritz_port_map *port = &reduced->port[k];

        b->node[k] = -1;
        for (int64_t i = 0; port->count > 0 && i < f->count; i++)
            if (f->id[i] == port->dof[0].grid)
                b->node[k] = i;
        for (int64_t i = 0; i < port->count; i++)
            if (port->dof[i].grid != port->dof[0].grid)
                b->node[k] = -1;
    }
    return RITZ_OK;
}

/* ---- the file of modes -------------------------------------------------- */

static void put_title(FILE *file, const char *title)
{
    fprintf(file, "*********  %s  *********\n", title);
}

static void put_count(FILE *file, int64_t count)
{
    fprintf(file, "%" PRId64 "   ! Number of non-zero elements\n", count);
}

static int64_t count_nonzeros(const ritz_dense *A)
{
    int64_t count = 0;

    for (int64_t i = 0; A->val && i < A->nrow * A->ncol; i++)
        count += A->val[i] != 0.0;
    return count;
}

/* Points whose modes are written: all nodes, or the joints. */
typedef struct point_list {
    const char *title, *name;
    int64_t count;
    const int64_t *node; /* index of each point's node; -1: its modes are 0;
                            NULL: point i is node i */
} point_list;

/* Component a of mode k at point i. */
static double mode_at(const ritz_dense *shape, const point_list *points,
                      int64_t k, int64_t i, int64_t a)
{
    const int64_t node = points->node ? points->node[i] : i;

    return node < 0 ? 0.0 : ritz_dense_col(shape, k)[3 * node + a];
}

static void put_shape(FILE *file, const char *title, const ritz_dense *shape,
                      const point_list *points)
{
    const int64_t per_mode = 3 * points->count;
    const int64_t all = shape->val ? shape->ncol * per_mode : 0;
    int64_t nonzeros = 0;

    for (int64_t e = 0; e < all; e++)
        nonzeros += mode_at(shape, points, e / per_mode, e % per_mode / 3,
                            e % 3) != 0.0;
    put_title(file, title);
    put_count(file, nonzeros);
    for (int64_t e = 0; e < all; e++) {
        const int64_t k = e / per_mode, i = e % per_mode / 3, a = e % 3;
        const double x = mode_at(shape, points, k, i, a);

        if (x != 0.0)
            fprintf(file,
                    "%" PRId64 " %" PRId64 " %" PRId64
                    " %.17g   ! [Mode] [%s] [Axis] Value\n",
                    k, i, a, x, points->name);
    }
}

static void put_diagonal(FILE *file, const char *title, int64_t count,
                         const double *value)
{
    put_title(file, title);
    put_count(file, count);
    for (int64_t k = 0; k < count; k++)
        fprintf(file, "%" PRId64 " %" PRId64 " %.17g   ! [Row] [Col] Value\n",
                k, k, value ? value[k] : 1.0);
}

static void put_damping(FILE *file, const ritz_dense *D)
{
    put_title(file, "Non-zero Damping Matrix Elements");
    put_count(file, count_nonzeros(D));
    for (int64_t j = 0; D->val && j < D->ncol; j++)
        for (int64_t i = 0; i < D->nrow; i++)
            if (ritz_dense_col(D, j)[i] != 0.0)
                fprintf(file,
                        "%" PRId64 " %" PRId64 " %.17g   ! [Row] [Col] Value\n",
                        i, j, ritz_dense_col(D, j)[i]);
}

/* Pf is rows 0 to 2 of the momenta of the modes, Hf is rows 3 to 5. */
static void put_momenta(FILE *file, const char *title,
                        const ritz_dense *momentum, int64_t first)
{
    put_title(file, title);
    for (int64_t k = 0; k < momentum->ncol; k++) {
        const double *p = ritz_dense_col(momentum, k) + first;

        fprintf(file, "%.17g %.17g %.17g   ! Mode %" PRId64 ", [x y z]\n", p[0],
                p[1], p[2], k);
    }
}

/* L[i][j][k] = X_j' m T_i(:,k) */
static void put_linear(FILE *file, const ritz_invariants *of, int64_t m)
{
    put_title(file, "Linear Modal Integral, L, 3 x 3 x Nf");
    put_count(file, count_nonzeros(&of->position));
    for (int64_t i = 0; i < 3; i++)
        for (int64_t k = 0; k < m; k++)
            for (int64_t j = 0; j < 3; j++) {
                double x = ritz_dense_col(&of->position, i * m + k)[j];

                if (x != 0.0)
                    fprintf(file,
                            "%" PRId64 " %" PRId64 " %" PRId64
                            " %.17g   ! [Row] [Col] [Mode] Value\n",
                            i, j, k, x);
            }
}

/* N[i][j][k][l] = T_i(:,k)' m T_j(:,l) */
static void put_angular(FILE *file, const ritz_invariants *of, int64_t m)
{
    put_title(file, "Angular Modal Integral, N, 3 x 3 x Nf x Nf");
    put_count(file, count_nonzeros(&of->product));
    for (int64_t col = 0; col < 3 * m; col++)
        for (int64_t row = 0; row < 3 * m; row++) {
            double x = ritz_dense_col(&of->product, col)[row];

            if (x != 0.0)
                fprintf(file,
                        "%" PRId64 " %" PRId64 " %" PRId64 " %" PRId64
                        " %.17g   ! [Row] [Col] [Mode] [Mode] Value\n",
                        row / m, col / m, row % m, col % m, x);
        }
}

static void put_shapes(FILE *file, const body_42 *b)
{
    const ritz_normal_body *n = &b->normal;
    const point_list list[] = {
        {"Joint Node Mode Shapes", "Joint", b->reduced->num_ports, b->node},
        {"Analysis Node Mode Shapes", "Node", n->floating.count, NULL},
    };

    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        put_title(file, list[k].title);
        put_shape(file, "Non-zero Translation Mode Shape (PSI) Elements",
                  &n->shape, &list[k]);
        put_shape(file, "Non-zero Rotation Mode Shape (THETA) Elements",
                  &n->turn, &list[k]);
    }
}

/*
 * Mass properties, to be copied into the spacecraft file line by line. With
 * REFPT_CM the origin of the body's axes is the basic origin and moments of
 * inertia are about the centre of mass. With REFPT_JOINT both are at the origin
 * of the frame.
 */
static void put_mass(FILE *file, const body_42 *b)
{
    const ritz_floating *f = &b->normal.floating;
    const double *R = b->normal.invariants.rigid;
    double c[3];

    for (int a = 0; a < 3; a++)
        c[a] = b->at_centre ? f->origin[a] : f->inertia.centre[a];
    fprintf(file,
            "\nIn the spacecraft file:\n"
            "%s ! Mass Props referenced to REFPT_CM or REFPT_JOINT\n"
            "%.17g ! Mass\n%.17g %.17g %.17g ! Moments of Inertia\n"
            "%.17g %.17g %.17g ! Products of Inertia (xy,xz,yz)\n"
            "%.17g %.17g %.17g ! Location of mass center\n",
            b->at_centre ? "REFPT_CM" : "REFPT_JOINT", f->inertia.mass,
            R[3 + 6 * 3], R[4 + 6 * 4], R[5 + 6 * 5], -R[3 + 6 * 4],
            -R[3 + 6 * 5], -R[4 + 6 * 5], c[0], c[1], c[2]);
}

static void put_rest(FILE *file, const body_42 *b)
{
    put_mass(file, b);
    fputs("\nJoints:\n", file);
    for (int64_t k = 0; k < b->reduced->num_ports; k++) {
        const ritz_port_map *port = &b->reduced->port[k];

        if (b->node[k] >= 0)
            fprintf(file, "%" PRId64 " is port %s, grid %" PRId64 "\n", k,
                    port->name, port->dof[0].grid);
        else
            fprintf(file, "%" PRId64 " is none: port %s is not of one grid\n",
                    k, port->name);
    }
    fputc('\n', file);
    fputs(b->certificate, file);
}

static ritz_status print_flex(FILE *file, const void *what)
{
    const body_42 *b = what;
    const ritz_normal_body *n = &b->normal;
    int64_t m = n->num_modes;

    fputs("<<<<<<<<<<<<<<  Flexible Body Inputs for 42  >>>>>>>>>>>>>>>>>>>\n",
          file);
    fprintf(file,
            "Ritz %.32s, %s   ! Description\n"
            "%" PRId64 "   ! Number of Flex Modes\n",
            ritz_version(), b->at_centre ? "REFPT_CM" : "REFPT_JOINT", m);
    put_title(file, "Initial Modal States x, u");
    for (int64_t k = 0; k < m; k++)
        fprintf(file, "0.0 0.0   ! Mode %" PRId64 " x, u\n", k);
    put_shapes(file, b);
    put_diagonal(file, "Non-zero Mass Matrix Elements", m, NULL);
    put_diagonal(file, "Non-zero Stiffness Matrix Elements", m, n->K);
    put_damping(file, &n->D);
    put_momenta(file, "Linear Momentum Modal Integral, Pf, 3 x Nf",
                &n->invariants.momentum, 0);
    put_momenta(file, "Angular Momentum Modal Integral, Hf, 3 x Nf",
                &n->invariants.momentum, 3);
    put_linear(file, &n->invariants, m);
    put_angular(file, &n->invariants, m);
    fputs("[EOF]\n", file);
    put_rest(file, b);
    return RITZ_OK;
}

static ritz_status print_nodes(FILE *file, const void *what)
{
    const body_42 *b = what;
    const ritz_floating *f = &b->normal.floating;

    fputs("<<<<<<<<<<<<<<<<  Body Node Inputs for 42  >>>>>>>>>>>>>>>>>>>>>\n",
          file);
    fprintf(file,
            "Ritz %.32s   ! Description\n%" PRId64 "   ! Number of Nodes\n",
            ritz_version(), f->count);
    fputs("******************* Node Location, Comment *********************\n",
          file);
    for (int64_t k = 0; k < f->count; k++) {
        double x[3];

        for (int a = 0; a < 3; a++)
            x[a] = f->position[3 * k + a] + (b->at_centre ? f->origin[a] : 0.0);
        fprintf(file, "%.17g %.17g %.17g   \"grid %" PRId64 "\"\n", x[0], x[1],
                x[2], f->id[k]);
    }
    return RITZ_OK;
}

/* ---- exporter ----------------------------------------------------------- */

static ritz_status write_files(const body_42 *b, const char *flex,
                               const char *nodes)
{
    RITZ_OWN(ritz_draft) first = {0}, second = {0};

    RITZ_CHECK_IN(flex, ritz_draft_new(flex, &first));
    RITZ_CHECK_IN(nodes, ritz_draft_new(nodes, &second));
    RITZ_CHECK(ritz_sink_fill(&first, print_flex, b));
    RITZ_CHECK(ritz_sink_fill(&second, print_nodes, b));
    return ritz_draft_publish_all(2, (ritz_draft *[]){&first, &second});
}

static ritz_status say_losses(const body_42 *b, const char *nodes,
                              ritz_export_report *report)
{
    const char *name = ritz_path_name(nodes);
    int64_t joints = 0;

    for (int64_t k = 0; k < b->reduced->num_ports; k++)
        joints += b->node[k] >= 0;
    RITZ_CHECK(
        ritz_export_say(report, "17 digits; nodes are in %.200s", nodes));
    RITZ_CHECK(ritz_export_say(
        report,
        "%s; %lld of %lld ports are joints, numbered from 0 in their order",
        b->at_centre ? "REFPT_CM" : "REFPT_JOINT", (long long)joints,
        (long long)b->reduced->num_ports));
    RITZ_CHECK(ritz_export_say(
        report, "mass, inertia and the certificate follow '[EOF]', where 42 "
                "reads no more; inputs and outputs are left out"));
    if (strlen(name) > NAME_ROOM || strchr(name, ' '))
        RITZ_CHECK(ritz_export_say(
            report,
            "warning: 42 takes names of files of at most %d letters, "
            "without blanks",
            (int)NAME_ROOM));
    return RITZ_OK;
}

static ritz_status write_42(const ritz_export_object *object,
                            const ritz_export_request *request,
                            ritz_export_report *report)
{
    static const char suffix[] = ".nodes";
    const size_t length = strlen(request->output);
    RITZ_OWN_ARRAY char *nodes = NULL;
    RITZ_OWN(body_42) b = {0};

    RITZ_CHECK(find_body(object->reduced, request, &b));
    RITZ_CHECK(find_joints(&b));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &b.certificate));
    RITZ_CHECK_NEW(nodes, (int64_t)(length + sizeof suffix));
    memcpy(nodes, request->output, length);
    memcpy(nodes + length, suffix, sizeof suffix);
    RITZ_CHECK(write_files(&b, request->output, nodes));
    RITZ_CHECK(ritz_normal_body_say(b.reduced, &b.normal, report));
    return say_losses(&b, nodes, report);
}

const ritz_exporter ritz_exporter_42 = {
    .name = "42",
    .summary = "a flexible body for 42, NASA's spacecraft simulator",
    .reference = "Stoneking2025",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_FRAME,
    .write = write_42,
};
