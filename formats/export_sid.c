/*
 * Writes Standard Input Data of a flexible body [Wallrapp1994], as SIMPACK,
 * EMBSlib and FEMBeam read it [Waurich2022]. In the frame of the body, a node
 * with the position R is displaced to R + phi q and rotated by psi q.
 *
 * These readers disagree in three points:
 *
 *     m1( i, k, j)   row, mode, column, as in files of SIMPACK and EMBSlib;
 *                    those of FEMBeam have another order
 *     Ge             three columns for each mode, which all readers accept;
 *                    some files of EMBSlib have m columns for each axis
 *     Me             EMBSlib takes I whatever the file says, so modes are
 *                    scaled to unit modal mass
 *
 * Geometric stiffness K0 of a unit load adds to first-order terms, so that the
 * sum over loads of K0 q is added to Ke q: with w_ab the products of Oe,
 *
 *     Ct m1(:, k, a)  += K0t_a(:, k)       accelerations less gravity
 *     Cr m1(:, k, a)  += K0r_a(:, k)       angular accelerations
 *     Oe m1(:, k, ab) += K0w_ab(:, k)      angular velocities
 *     phi m1(a, k, :)  = -K0F_a(:, k)'     forces on the node, whose part in
 *     psi m1(a, k, :)  = -K0M_a(:, k)'     the equations of the modes is
 *                                          (phi' f), (psi' t)
 *
 * Entries of diagonal and unit matrices are all written, since some readers
 * ignore the code of the structure. Exponents have a D, the only letter that
 * EMBSlib reads.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/floating_report.h"
#include "formats/sid.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- the body ----------------------------------------------------------- */

void sid_body_free(sid_body *body)
{
    ritz_normal_body_free(&body->normal);
    ritz_sid_terms_free(&body->terms);
    ritz_stiffening_terms_free(&body->stiffening);
    *body = (sid_body){0};
}

/* m1 += K0 in column @p at of the @p columns of each mode. */
static ritz_status add_stiffness(const ritz_dense *K0, int64_t columns,
                                 int64_t at, ritz_taylor *t)
{
    const int64_t m = K0->nrow;

    if (!t->m1.val)
        RITZ_CHECK(ritz_dense_new(m, columns * m, &t->m1));
    for (int64_t k = 0; k < m; k++)
        for (int64_t l = 0; l < m; l++)
            ritz_dense_col(&t->m1, k * columns + at)[l] +=
                ritz_dense_col(K0, k)[l];
    return RITZ_OK;
}

/* Terms of the frame's motion; those of forces are terms of nodes. */
static ritz_status add_stiffening(sid_body *b)
{
    for (int64_t k = 0; k < b->stiffening.count; k++) {
        const ritz_stiffening_term *term = &b->stiffening.term[k];
        const int kind = term->kind;

        if (kind < RITZ_TURN)
            RITZ_CHECK(add_stiffness(&term->K0, 6, kind, &b->terms.Oe));
        else if (kind < RITZ_ACCEL)
            RITZ_CHECK(
                add_stiffness(&term->K0, 3, kind - RITZ_TURN, &b->terms.Cr));
        else if (kind < RITZ_FORCE)
            RITZ_CHECK(
                add_stiffness(&term->K0, 3, kind - RITZ_ACCEL, &b->terms.Ct));
    }
    return RITZ_OK;
}

ritz_status sid_body_of(const ritz_reduced *reduced,
                        const ritz_export_request *request, sid_body *out)
{
    static const double here[3] = {0.0, 0.0, 0.0};
    const ritz_floating_request wanted = ritz_floating_asked(request);
    RITZ_OWN(sid_body) b = {0};
    RITZ_OWN(ritz_dense) unit = {0};

    RITZ_CHECK(ritz_normal_body_of(reduced, &wanted, &b.normal));
    RITZ_CHECK(ritz_dense_identity(b.normal.num_modes, &unit));
    RITZ_CHECK(ritz_sid_terms_of(&b.normal.invariants, &unit, here, &b.terms));
    RITZ_CHECK(ritz_stiffening_terms_of(reduced, &b.normal.floating,
                                        &b.normal.U, request->stiffening,
                                        &b.stiffening));
    RITZ_CHECK(add_stiffening(&b));
    RITZ_MOVE(*out, b);
    return RITZ_OK;
}

/* ---- its file ----------------------------------------------------------- */

enum {
    /* bytes of the first line: EMBSlib reads two parts of 511 bytes and would
       look for key words in the rest */
    TITLE_SIZE = 1000,
    EMBSLIB_NODE = 99999 /* largest number of a node that EMBSlib stores */
};

/* Codes for the structure of m0. */
enum { STRUCTURE_ZERO = 0, STRUCTURE_DIAGONAL = 1, STRUCTURE_ANY = 3 };

/* A matrix m0 + sum_k q_k m1_k. */
typedef struct sid_matrix {
    const char *name;
    int64_t order, nrow, ncol, num_modes;
    const double *m0; /* column j is at m0 + j step; NULL: zero */
    const double *m1; /* column j of mode k is at m1 + (k ncol + j) step; NULL:
                         zero */
    int64_t step;
    const double *diagonal; /* if not NULL, m0 is this diagonal matrix */
} sid_matrix;

typedef struct sid_text {
    FILE *file;
    const sid_body *body;
    const char *title; /* text after the counts of the first line */
    double *AP;        /* 3 x 3m, m1 of AP of the node that is written */
    double *room;      /* 6 (m + m m), for that node */
} sid_text;

static void put_number(FILE *file, double x)
{
    char text[40];
    char *mark = NULL;

    snprintf(text, sizeof text, "% .16E", x);
    mark = strchr(text, 'E');
    if (mark)
        *mark = 'D';
    fprintf(file, "=%s\n", text);
}

static void put_m0(FILE *file, int64_t i, int64_t j, double x)
{
    char key[64];

    if (x == 0.0)
        return;
    snprintf(key, sizeof key, "m0( %" PRId64 ", %" PRId64 ")", i + 1, j + 1);
    fprintf(file, "%26s%-22s", "", key);
    put_number(file, x);
}

static void put_m1(FILE *file, int64_t i, int64_t k, int64_t j, double x)
{
    char key[96];

    if (x == 0.0)
        return;
    snprintf(key, sizeof key, "m1( %" PRId64 ", %" PRId64 ", %" PRId64 ")",
             i + 1, k + 1, j + 1);
    fprintf(file, "%26s%-22s", "", key);
    put_number(file, x);
}

static void put_entries(FILE *file, const sid_matrix *A)
{
    for (int64_t i = 0; A->diagonal && i < A->nrow; i++)
        put_m0(file, i, i, A->diagonal[i]);
    for (int64_t j = 0; A->m0 && j < A->ncol; j++)
        for (int64_t i = 0; i < A->nrow; i++)
            put_m0(file, i, j, A->m0[j * A->step + i]);
    for (int64_t k = 0; A->m1 && k < A->num_modes; k++)
        for (int64_t j = 0; j < A->ncol; j++)
            for (int64_t i = 0; i < A->nrow; i++)
                put_m1(file, i, k, j, A->m1[(k * A->ncol + j) * A->step + i]);
}

static void put_matrix(FILE *file, int indent, const sid_matrix *A)
{
    const struct {
        const char *key;
        int64_t count;
    } head[] = {
        {"order", A->order},
        {"nrow", A->nrow},
        {"ncol", A->ncol},
        {"nq", A->num_modes},
        {"nqn", 0},
        {"structure", A->diagonal ? STRUCTURE_DIAGONAL
                      : A->m0     ? STRUCTURE_ANY
                                  : STRUCTURE_ZERO},
    };

    fprintf(file, "%*s%s\n", indent, "", A->name);
    for (size_t k = 0; k < sizeof head / sizeof *head; k++)
        fprintf(file, "%26s%-22s=%5" PRId64 "\n", "", head[k].key,
                head[k].count);
    put_entries(file, A);
    fprintf(file, "%*send %s\n", indent, "", A->name);
}

/* m1 of AP = I + skew(psi q): column a of mode k is psi_k x e_a. */
static void turn_node(const sid_body *b, int64_t node, double *AP)
{
    for (int64_t k = 0; k < b->normal.num_modes; k++) {
        const double *v = ritz_dense_col(&b->normal.turn, k) + 3 * node;

        for (int64_t a = 0; a < 3; a++) {
            int64_t c = (a + 1) % 3;
            int64_t d = (a + 2) % 3;

            AP[9 * k + 3 * a + a] = 0.0;
            AP[9 * k + 3 * a + c] = v[d];
            AP[9 * k + 3 * a + d] = -v[c];
        }
    }
}

/* Rows of a node in columns of 3. */
static const double *pick_node(const ritz_dense *A, int64_t node, double *out)
{
    for (int64_t k = 0; k < A->ncol; k++)
        memcpy(out + 3 * k, ritz_dense_col(A, k) + 3 * node, 3 * sizeof *out);
    return out;
}

/* m1 of phi, or of psi, in columns of 3: of loads of a kind on a node. NULL if
   there is none. */
static const double *load_node(const sid_body *b, int64_t id, int first,
                               double *m1)
{
    const ritz_stiffening_terms *s = &b->stiffening;
    const int64_t m = b->normal.num_modes;
    bool any = false;

    memset(m1, 0, (size_t)(3 * m * m) * sizeof *m1);
    for (int64_t n = 0; n < s->count; n++) {
        const int a = s->term[n].kind - first;

        if (a < 0 || a > 2 || s->term[n].grid != id)
            continue;
        any = true;
        for (int64_t e = 0; e < m * m; e++)
            m1[3 * e + a] = -s->term[n].K0.val[e];
    }
    return any ? m1 : NULL;
}

static void put_node(const sid_text *t, int64_t node)
{
    static const double unit[3] = {1.0, 1.0, 1.0};
    const ritz_normal_body *body = &t->body->normal;
    const int64_t m = body->num_modes, id = body->floating.id[node];
    const double *place = body->floating.position + 3 * node;
    const bool turns = body->floating.rotates[node] && body->turn.val;
    double *room = t->room;
    const double *phi = pick_node(&body->shape, node, room);
    const double *psi =
        turns ? pick_node(&body->turn, node, room + 3 * m) : NULL;
    const double *force = load_node(t->body, id, RITZ_FORCE, room + 6 * m);
    const double *moment =
        load_node(t->body, id, RITZ_MOMENT, room + 6 * m + 3 * m * m);
    const sid_matrix of_node[] = {
        {"origin", 1, 3, 1, m, place, phi, 3, NULL},
        {"phi", force != NULL, 3, m, m, phi, force, 3, NULL},
        {"psi", moment != NULL, 3, m, m, psi, moment, 3, NULL},
        {"AP", 1, 3, 3, m, NULL, turns ? t->AP : NULL, 3, unit},
    };

    if (turns)
        turn_node(t->body, node, t->AP);
    fprintf(t->file, "%16s%-32s=%8" PRId64 "\n", "", "new node", id);
    fprintf(t->file, "%21s%-27s=    body ref\n", "", "rframe");
    for (size_t k = 0; k < sizeof of_node / sizeof *of_node; k++)
        put_matrix(t->file, 21, &of_node[k]);
    fprintf(t->file, "%16send node\n", "");
}

static void put_modes(FILE *file, const sid_body *b)
{
    fprintf(file, "%11srefmod\n%16s%-32s", "", "", "mass");
    put_number(file, b->terms.mass);
    fprintf(file, "%16s%-32s=%6" PRId64 "\n", "", "nelastq",
            b->normal.num_modes);
    for (int64_t k = 0; k < b->normal.num_modes; k++) {
        char key[32];

        snprintf(key, sizeof key, "ielastq (%4" PRId64 ")", k + 1);
        fprintf(file, "%16s%-32s= Eigen Mode %4" PRId64 " : %15.9g Hz\n", "",
                key, k + 1, b->normal.hertz[k]);
    }
    fprintf(file, "%11send refmod\n", "");
}

static sid_matrix from_taylor(const char *name, const ritz_taylor *t,
                              bool first, int64_t m)
{
    return (sid_matrix){.name = name,
                        .order = first,
                        .nrow = t->m0.nrow,
                        .ncol = t->m0.ncol,
                        .num_modes = m,
                        .m0 = t->m0.val,
                        .m1 = first ? t->m1.val : NULL,
                        .step = t->m0.nrow};
}

/* As in the published samples, Gr and Ge have no term of first order in q. */
static ritz_status put_terms(FILE *file, const sid_body *b)
{
    const ritz_sid_terms *t = &b->terms;
    const int64_t m = b->normal.num_modes;
    RITZ_OWN_ARRAY double *unit = NULL;
    const sid_matrix *of = NULL;

    RITZ_CHECK_NEW(unit, m);
    for (int64_t k = 0; k < m; k++)
        unit[k] = 1.0;
    of = (const sid_matrix[]){
        from_taylor("mdCM", &t->mdCM, true, m),
        from_taylor("J", &t->J, true, m),
        from_taylor("Ct", &t->Ct, t->Ct.m1.val != NULL, m),
        from_taylor("Cr", &t->Cr, true, m),
        {"Me", 0, m, m, m, NULL, NULL, m, unit},
        from_taylor("Gr", &t->Gr, false, m),
        from_taylor("Ge", &t->Ge, false, m),
        from_taylor("Oe", &t->Oe, true, m),
        {"ksigma", 0, m, 1, m, NULL, NULL, m, NULL},
        {"Ke", 0, m, m, m, NULL, NULL, m, b->normal.K},
        {"De", 0, m, m, m, b->normal.D.val, NULL, m, NULL},
        {0},
    };
    for (; of->name; of++)
        put_matrix(file, 11, of);
    return RITZ_OK;
}

static ritz_status print_file(FILE *file, const void *what)
{
    sid_text t = *(const sid_text *)what;
    const sid_body *b = t.body;
    const int64_t m = b->normal.num_modes;
    RITZ_OWN_ARRAY double *AP = NULL, *room = NULL;

    RITZ_CHECK_NEW(AP, 9 * m);
    RITZ_CHECK_NEW(room, 6 * (m + m * m));
    t.file = file;
    t.AP = AP;
    t.room = room;
    fprintf(file, "%5" PRId64 " %3" PRId64 "    :No. nodes, No. modes:%s\n",
            b->normal.floating.count, b->normal.num_modes, t.title);
    fputs(" part\n      new modal                                 =\n", file);
    put_modes(file, b);
    fprintf(file, "%11sframe\n", "");
    for (int64_t node = 0; node < b->normal.floating.count; node++)
        put_node(&t, node);
    fprintf(file, "%11send frame\n", "");
    RITZ_CHECK(put_terms(file, b));
    fputs("      end modal\n end part\n", file);
    return RITZ_OK;
}

/* ---- its title ---------------------------------------------------------- */

/* Lines of the certificate with bars between them. A line that does not fit is
   left out. */
typedef struct title {
    char text[TITLE_SIZE];
    int64_t lines, kept;
} title;

static void add_line(title *t, const char *line, size_t length)
{
    const size_t used = strlen(t->text);

    t->lines++;
    /* counts take 64 bytes, a bar takes 3 */
    if (used + length + 64 + 3 > sizeof t->text)
        return;
    t->kept++;
    snprintf(t->text + used, sizeof t->text - used, "%s%.*s",
             used > 0 ? " | " : "", (int)length, line);
}

enum { TURNS = 3 };

/* When a line is added: how the model was made and from which inputs first,
   measured errors next, and then what may be left out rather than these. */
static int turn_of(const char *line)
{
    static const struct {
        const char *begin;
        int turn;
    } turns[] = {{"error, measured: ", 1},
                 {"error, estimated: ", 2},
                 {"made by: ", 2},
                 {"command: ", 2}};

    for (size_t k = 0; k < sizeof turns / sizeof *turns; k++)
        if (strncmp(line, turns[k].begin, strlen(turns[k].begin)) == 0)
            return turns[k].turn;
    return 0;
}

static ritz_status make_title(const ritz_export_object *object,
                              const ritz_export_request *request,
                              const sid_body *b, title *t)
{
    char frame[128];
    char *lines = NULL;

    snprintf(frame, sizeof frame,
             "reference %s, %s geometric stiffening, Ge by modes",
             ritz_frame_condition_name(b->normal.floating.reference),
             b->stiffening.count > 0 ? "with" : "no");
    add_line(t, frame, strlen(frame));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &lines));
    for (int turn = 0; turn < TURNS; turn++)
        for (const char *at = lines; *at;) {
            const size_t length = strcspn(at, "\n");

            if (turn_of(at) == turn)
                add_line(t, at, length);
            at += length + (at[length] == '\n');
        }
    free(lines);
    return RITZ_OK;
}

/* ---- exporter ----------------------------------------------------------- */

static ritz_status say_losses(const ritz_reduced *reduced, const sid_body *b,
                              const title *t, ritz_export_report *report)
{
    const ritz_floating *f = &b->normal.floating;

    RITZ_CHECK(ritz_export_say(report, "17 digits, which keep every bit"));
    RITZ_CHECK(ritz_stiffening_terms_say(reduced, &b->stiffening, report));
    RITZ_CHECK(ritz_export_say(
        report,
        "%sinputs, outputs and ports are left out; Gr and Ge do not change "
        "with deformation",
        b->stiffening.count > 0 ? "" : "geometric stiffening, "));
    if (t->kept < t->lines)
        RITZ_CHECK(ritz_export_say(
            report,
            "the first line has room for %lld of %lld lines of the "
            "certificate",
            (long long)t->kept, (long long)t->lines));
    if (f->id[f->count - 1] > EMBSLIB_NODE) /* the largest, as ids ascend */
        RITZ_CHECK(ritz_export_say(
            report,
            "warning: EMBSlib has room for node numbers of five "
            "digits, and grid %lld has more",
            (long long)f->id[f->count - 1]));
    return RITZ_OK;
}

static ritz_status write_sid(const ritz_export_object *object,
                             const ritz_export_request *request,
                             ritz_export_report *report)
{
    RITZ_OWN(sid_body) b = {0};
    title t = {0};
    sid_text text = {.body = &b, .title = t.text};

    RITZ_CHECK(sid_body_of(object->reduced, request, &b));
    RITZ_CHECK(make_title(object, request, &b, &t));
    RITZ_CHECK(ritz_sink_write(request->output, print_file, &text));
    RITZ_CHECK(ritz_normal_body_say(object->reduced, &b.normal, report));
    return say_losses(object->reduced, &b, &t, report);
}

const ritz_exporter ritz_exporter_sid = {
    .name = "sid",
    .summary = "a flexible body as Standard Input Data (SIMPACK, EMBSlib)",
    .reference = "Wallrapp1994",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_FRAME | RITZ_EXPORT_STIFFENING,
    .write = write_sid,
};
