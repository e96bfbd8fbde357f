/*
 * A reduced component as DMIG cards of NASTRAN's bulk data: stiffness, mass
 * and damping between the grids of its interface and scalar points, which are
 * the other coordinates.
 *
 *     DMIG     NAME  0   IFO  TIN  0               IFO 6 symmetric, 1 square;
 *     DMIG*    NAME  GJ  CJ                        TIN 2 real, double
 *     *        G1    C1  A1                        one line for each term
 *
 * Of a symmetric matrix only the lower triangle is written, since NASTRAN stops
 * if it finds both [MSC2012].
 *
 * NASTRAN-95 [Nastran1986] is different. It needs a mark in each continuation,
 * it stops at a number of double precision without a D, and it needs both
 * triangles: with one, the sum of the matrix and its own is unsymmetric.
 *
 * Forces of rigid motion are small differences of large entries, so
 * that rounding holds a free body, by springs of either sign. What rounding
 * does is measured on the rounded matrices and stated in the report and in the
 * file.
 */
#include "base/alloc.h"
#include "base/tolerances.h"
#include "formats/cards.h"
#include "formats/certificate.h"
#include "formats/large_field.h"
#include "formats/nastran_rows.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    COMMENT = 68,  /* columns of text behind "$ " */
    SYMMETRIC = 6, /* IFO */
    SQUARE = 1,
    MARKER_SIZE = 8 + 1,
};

/* How a matrix is called, and the case control commands that take it. */
typedef struct dmig_kind {
    const char *name, *card;
    const char *symmetric, *square; /* NULL: none takes an unsymmetric one */
} dmig_kind;

static const dmig_kind kinds[] = {
    {"K", "KAAX", "K2GG", "K2PP"},
    {"M", "MAAX", "M2GG", "M2PP"},
    {"D", "BAAX", "B2GG", "B2PP"},
    {"K4", "K4AAX", "K42GG", NULL},
};

/* A matrix before and after rounding. */
typedef struct dmig_matrix {
    const dmig_kind *kind;
    char name[16];  /* "KG1", of a load */
    dmig_kind load; /* of geometric stiffness, where `kind` points to it */
    bool symmetric;
    bool lower;      /* only the lower triangle is written */
    bool lettered;   /* numbers have a D */
    double averaged; /* relative asymmetry of a symmetric one, by rounding */
    ritz_dense exact, rounded;
    int64_t stored, changed; /* numbers written; those that differ */
    double change;           /* the largest, relative to the number */
} dmig_matrix;

typedef struct dmig_deck {
    const ritz_reduced *reduced;
    const ritz_export_request *request;
    const ritz_export_report *report;
    int64_t count; /* of matrices */
    dmig_matrix *matrix;
    ritz_nastran_rows rows;
    char *certificate;
} dmig_deck;

static void dmig_deck_free(dmig_deck *deck)
{
    for (int64_t k = 0; k < deck->count; k++) {
        ritz_dense_free(&deck->matrix[k].exact);
        ritz_dense_free(&deck->matrix[k].rounded);
    }
    ritz_nastran_rows_free(&deck->rows);
    RITZ_FREE(deck->matrix, deck->certificate);
}

/* ---- rounding ------------------------------------------------------------ */

static void print_number(const dmig_matrix *m, double x,
                         char text[static RITZ_LARGE_FIELD_SIZE])
{
    (m->lettered ? ritz_large_field_print_double
                 : ritz_large_field_print)(x, text);
}

/* Round A(i,j) to the digits of its field. Count the entries, and those that
 * rounding changes. */
static ritz_status round_entry(dmig_matrix *m, int64_t i, int64_t j)
{
    const double x = ritz_dense_col(&m->exact, j)[i];
    double *y = &ritz_dense_col(&m->rounded, j)[i];
    char text[RITZ_LARGE_FIELD_SIZE];

    RITZ_REFUSE_IF(!isfinite(x), RITZ_ERR_ARGUMENT,
                   "row %" PRId64 " of column %" PRId64
                   " of '%s' is not finite",
                   i + 1, j + 1, m->kind->name);
    print_number(m, x, text);
    RITZ_REFUSE_IF(!ritz_card_number(text, y), RITZ_ERR_ARGUMENT,
                   "%g of '%s' is too large for a field", x, m->kind->name);
    m->stored += x != 0.0;
    m->changed += *y != x;
    if (x != 0.0)
        m->change = fmax(m->change, fabs(*y / x - 1.0));
    return RITZ_OK;
}

static ritz_status round_matrix(dmig_matrix *m)
{
    const int64_t n = m->exact.nrow;

    RITZ_CHECK(ritz_dense_new(n, n, &m->rounded));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = m->lower ? j : 0; i < n; i++) {
            RITZ_CHECK(round_entry(m, i, j));
            if (m->lower)
                ritz_dense_col(&m->rounded, i)[j] =
                    ritz_dense_col(&m->rounded, j)[i];
        }
    return RITZ_OK;
}

/* ---- matrices ------------------------------------------------------------ */

/* Its row of the table, or that of a load. */
static void find_kind(const char *name, dmig_matrix *m)
{
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        if (strcmp(kinds[k].name, name) == 0)
            m->kind = &kinds[k];
    if (m->kind)
        return;
    snprintf(m->name, sizeof m->name, "%.15s", name);
    m->load = (dmig_kind){m->name, m->name, "K2GG", "K2PP"};
    m->kind = &m->load;
}

/* Every entry of an exported matrix is stored, column after column. */
static ritz_status take_matrix(const ritz_matrix *from, bool numbered,
                               dmig_matrix *m)
{
    const ritz_dense all = {from->A.nrow, from->A.ncol, from->A.val};

    find_kind(from->name, m);
    RITZ_CHECK(ritz_dense_copy(&all, &m->exact));
    m->averaged = ritz_dense_asymmetry(&m->exact);
    m->symmetric = m->averaged <= RITZ_SYMMETRIC;
    if (m->symmetric)
        ritz_dense_symmetrise(&m->exact);
    m->lower = m->symmetric && !numbered;
    m->lettered = numbered;
    RITZ_REFUSE_IF(!m->symmetric && !m->kind->square, RITZ_ERR_ARGUMENT,
                   "'%s' is not symmetric, and NASTRAN takes no such matrix",
                   from->name);
    RITZ_REFUSE_IF(!m->lower && !m->kind->square, RITZ_ERR_ARGUMENT,
                   "NASTRAN-95, for which --numbered is, takes no '%s'",
                   from->name);
    return round_matrix(m);
}

static ritz_status take_matrices(const ritz_export_object *object,
                                 ritz_export_report *report, dmig_deck *deck)
{
    RITZ_OWN(ritz_matrices) list = {0};

    RITZ_CHECK(ritz_export_damped(object, deck->request, "K,M,D,K4,KG", report,
                                  &list));
    RITZ_CHECK_NEW(deck->matrix, list.count);
    for (int64_t k = 0; k < list.count; k++)
        RITZ_CHECK(take_matrix(&list.matrix[k], deck->request->numbered,
                               &deck->matrix[deck->count++]));
    return RITZ_OK;
}

/* ---- what rounding does -------------------------------------------------- */

typedef struct dmig_audit {
    int64_t motions;      /* rigid ones, by the exact matrices */
    int64_t left;         /* still counted as rigid after rounding */
    double before, after; /* max|K r| / max|K| */
    double lowest;        /* eigenvalue over first flexible one, rounded */
    double rigid_hz, first_hz;
    double to_hz, change; /* of frequencies in the band */
    char indefinite[160]; /* why the rounded mass matrix is not positive
                             definite; "" if it is */
} dmig_audit;

/* max|A r| / max|A| over rigid modes r whose largest entry is 1. */
static ritz_status find_residual(const ritz_dense *A, const ritz_pairs *pairs,
                                 double *out)
{
    RITZ_OWN(ritz_dense) F = {0};
    const ritz_dense R = ritz_dense_part(&pairs->Phi, 0, pairs->num_rigid);
    const double size = ritz_dense_max(A);

    *out = 0.0;
    if (R.ncol == 0)
        return RITZ_OK;
    RITZ_CHECK(ritz_dense_mul(A, &R, &F));
    for (int64_t j = 0; size > 0.0 && j < R.ncol; j++)
        *out = fmax(*out, ritz_dense_col_max(&F, j) /
                              (ritz_dense_col_max(&R, j) * size));
    return RITZ_OK;
}

/* Modes are kept up to here; of the whole basis if none says. */
static double find_band(const ritz_columns *columns, const ritz_pairs *pairs)
{
    double most = 0.0;

    for (int64_t j = 0; j < columns->count; j++)
        most = fmax(most, columns->hertz[j]); /* which ignores NaN */
    if (most == 0.0 && pairs->Phi.ncol > 0)
        most = ritz_eigen_hertz(pairs->lambda[pairs->Phi.ncol - 1]);
    return most;
}

static void compare_frequencies(const ritz_pairs *exact,
                                const ritz_pairs *rounded, dmig_audit *out)
{
    const int64_t first = exact->num_rigid;

    if (first >= exact->Phi.ncol || first >= rounded->Phi.ncol)
        return;
    out->first_hz = ritz_eigen_hertz(exact->lambda[first]);
    for (int64_t k = 0; k < first; k++)
        out->rigid_hz =
            fmax(out->rigid_hz, fabs(ritz_eigen_hertz(rounded->lambda[k])));
    out->lowest = rounded->lambda[0] / exact->lambda[first];
    for (int64_t k = first; k < exact->Phi.ncol && k < rounded->Phi.ncol; k++) {
        const double f = ritz_eigen_hertz(exact->lambda[k]);

        if (f <= out->to_hz || k == first)
            out->change = fmax(out->change,
                               fabs(ritz_eigen_hertz(rounded->lambda[k]) - f) /
                                   fmax(fabs(f), out->first_hz));
    }
}

/*
 * Find the eigenpairs of the rounded matrices. Rounding can make M indefinite,
 * if a motion has no mass. It changes M_ij by at most c |M_ij|, which is at
 * most c sqrt(M_ii M_jj). So M + n c diag(M) is positive semidefinite; its
 * frequencies differ by at most n c / 2, relative.
 */
static ritz_status find_rounded(const dmig_deck *deck, dmig_audit *audit,
                                ritz_pairs *out)
{
    const dmig_matrix *K = &deck->matrix[0], *M = &deck->matrix[1];
    const double share = (double)deck->rows.order * M->change;
    RITZ_OWN(ritz_dense) padded = {0};
    const ritz_status status = ritz_eigen_dense(&K->rounded, &M->rounded, out);

    if (status != RITZ_ERR_SINGULAR)
        return status;
    snprintf(audit->indefinite, sizeof audit->indefinite, "%s",
             ritz_error_message());
    RITZ_CHECK(ritz_dense_copy(&M->rounded, &padded));
    for (int64_t j = 0; j < deck->rows.order; j++)
        ritz_dense_col(&padded, j)[j] *= 1.0 + share;
    return ritz_eigen_dense(&K->rounded, &padded, out);
}

static ritz_status audit_rounding(const dmig_deck *deck, dmig_audit *out)
{
    const dmig_matrix *K = &deck->matrix[0]; /* always there, and first */
    const dmig_matrix *M = &deck->matrix[1];
    RITZ_OWN(ritz_pairs) exact = {0}, rounded = {0};
    dmig_audit audit = {0};

    RITZ_CHECK_IN("modes", ritz_eigen_dense(&K->exact, &M->exact, &exact));
    RITZ_CHECK_IN("modes of the rounded matrices",
                  find_rounded(deck, &audit, &rounded));
    audit.motions = exact.num_rigid;
    audit.left = rounded.num_rigid;
    RITZ_CHECK(find_residual(&K->exact, &exact, &audit.before));
    RITZ_CHECK(find_residual(&K->rounded, &exact, &audit.after));
    audit.to_hz = find_band(&deck->reduced->columns, &exact);
    compare_frequencies(&exact, &rounded, &audit);
    *out = audit;
    return RITZ_OK;
}

/* ---- report -------------------------------------------------------------- */

static ritz_status say_matrix(const dmig_matrix *m, ritz_export_report *report)
{
    const char *with = m->lower ? m->kind->symmetric : m->kind->square;
    const char *form =
        m->symmetric ? " (both triangles, IFO 1)" : " (unsymmetric, IFO 1)";

    if (m->symmetric && m->averaged > 0.0)
        RITZ_CHECK(ritz_export_say(
            report,
            "an asymmetry of %s by %.1e of its largest entry is averaged away",
            m->kind->name, m->averaged));
    return ritz_export_say(
        report,
        "%s is for %s = %s%s: %" PRId64 " of %" PRId64
        " numbers are rounded, by %.1e of themselves at most",
        m->kind->name, with, m->kind->card, m->lower ? "" : form, m->changed,
        m->stored, m->change);
}

static ritz_status say_free(const dmig_audit *audit, ritz_export_report *report)
{
    RITZ_CHECK(ritz_export_say(
        report,
        "%" PRId64 " rigid motions r, of largest entry 1: max|K r| / max|K| "
        "is %.1e, before rounding %.1e",
        audit->motions, audit->after, audit->before));
    if (audit->first_hz > 0.0)
        RITZ_CHECK(ritz_export_say(
            report,
            "their lowest eigenvalue becomes %.1e of the first flexible one, "
            "which is at %.6g Hz",
            audit->lowest, audit->first_hz));
    if (audit->left < audit->motions)
        RITZ_CHECK(ritz_export_say(
            report,
            "warning: the body is no longer free: rounding holds %" PRId64
            " of %" PRId64 " rigid motions, at up to %.3g Hz; output4 keeps "
            "all digits",
            audit->motions - audit->left, audit->motions, audit->rigid_hz));
    return RITZ_OK;
}

static ritz_status say_audit(const dmig_audit *audit,
                             ritz_export_report *report)
{
    if (audit->motions > 0)
        RITZ_CHECK(say_free(audit, report));
    else
        RITZ_CHECK(ritz_export_say(report, "no motion is rigid: the body is "
                                           "held by its own stiffness"));
    if (*audit->indefinite)
        RITZ_CHECK(ritz_export_say(
            report, "warning: rounded, the %s; output4 keeps all digits",
            audit->indefinite));
    if (audit->first_hz > 0.0)
        RITZ_CHECK(ritz_export_say(
            report,
            "frequencies up to %.6g Hz change by %.1e of themselves at most",
            audit->to_hz, audit->change));
    return RITZ_OK;
}

static ritz_status say_losses(const dmig_deck *deck, ritz_export_report *report)
{
    RITZ_CHECK(ritz_nastran_rows_say_ports(&deck->rows, deck->reduced,
                                           "is left out: it was not attached",
                                           report));
    return ritz_export_say(report, "left out, as DMIG has no place for them: "
                                   "shapes of other grids, inputs and "
                                   "outputs, inertia");
}

/* ---- the file ------------------------------------------------------------ */

static void put_comment(FILE *file, const char *text)
{
    ritz_comment_put(file, "$ ", COMMENT, text);
}

/* Where the grids are: the model that takes the matrices has them. */
static void put_places(FILE *file, const dmig_deck *deck)
{
    const ritz_grids *grids = &deck->reduced->grids;
    int64_t last = 0;
    char text[4 * RITZ_NAME_SIZE];

    for (int64_t k = 0; k < deck->rows.num_interface; k++) {
        const int64_t id = deck->rows.dof[deck->rows.at[k]].grid;
        const int64_t g = ritz_grids_find(grids, id);

        if (id == last || g < 0)
            continue;
        snprintf(text, sizeof text, "grid %" PRId64 " at %.9g %.9g %.9g%s", id,
                 grids->position[3 * g], grids->position[3 * g + 1],
                 grids->position[3 * g + 2],
                 grids->frame[g] > 0 ? ", with axes of its own (CD)" : "");
        put_comment(file, text);
        last = id;
    }
}

/* Continuations: a mark in columns 73 to 80, and again where the next line
   begins, or nothing but the star. */
typedef struct dmig_marks {
    bool numbered;
    int64_t count;
    char mark[MARKER_SIZE]; /* with which the next line begins */
} dmig_marks;

/* "*R" and six digits to the base 36, of which no two are equal. */
static void next_mark(dmig_marks *marks)
{
    static const char figure[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    int64_t rest = marks->count++;

    snprintf(marks->mark, sizeof marks->mark, "*R000000");
    for (int k = MARKER_SIZE - 2; k > 1; k--, rest /= 36)
        marks->mark[k] = figure[rest % 36];
}

/* @param[in] name  NULL: a continuation */
static void put_line(FILE *file, dmig_marks *marks, const char *name,
                     const char *fields, bool more)
{
    if (!name)
        name = marks->numbered ? marks->mark : "*";
    fprintf(file, "%-8s", name);
    if (!marks->numbered || !more) {
        fprintf(file, "%s\n", fields);
        return;
    }
    next_mark(marks);
    fprintf(file, "%-64s%s\n", fields, marks->mark);
}

/* The next term of column j from place k on: the diagonal, so that each dof
   occurs, and all others but zeros; the order where there is none. */
static int64_t next_term(const dmig_deck *deck, const dmig_matrix *m, int64_t j,
                         int64_t k)
{
    while (k < deck->rows.order && deck->rows.at[k] != j &&
           ritz_dense_col(&m->exact, j)[deck->rows.at[k]] == 0.0)
        k++;
    return k;
}

static void put_column(FILE *file, const dmig_deck *deck, const dmig_matrix *m,
                       int64_t col, dmig_marks *marks)
{
    const int64_t j = deck->rows.at[col];
    const ritz_dof of = deck->rows.dof[j];
    int64_t k = next_term(deck, m, j, m->lower ? col : 0);
    char fields[4 * RITZ_LARGE_FIELD_SIZE], number[RITZ_LARGE_FIELD_SIZE];

    snprintf(fields, sizeof fields, "%-16s%16" PRId64 "%16" PRId64,
             m->kind->card, of.grid, of.component);
    put_line(file, marks, "DMIG*", fields, true);
    while (k < deck->rows.order) {
        const int64_t i = deck->rows.at[k];

        k = next_term(deck, m, j, k + 1);
        print_number(m, ritz_dense_col(&m->exact, j)[i], number);
        snprintf(fields, sizeof fields, "%16" PRId64 "%16" PRId64 "%16s",
                 deck->rows.dof[i].grid, deck->rows.dof[i].component, number);
        put_line(file, marks, NULL, fields, k < deck->rows.order);
    }
}

/* Geometric stiffness is added by as much as there is of its load. */
static void put_commands(FILE *file, const dmig_deck *deck)
{
    char text[4 * RITZ_NAME_SIZE];

    put_comment(file, "case control:");
    for (int64_t k = 0; k < deck->count; k++) {
        const dmig_matrix *m = &deck->matrix[k];

        if (m->kind == &m->load)
            continue;
        snprintf(text, sizeof text, "  %s = %s",
                 m->lower ? m->kind->symmetric : m->kind->square,
                 m->kind->card);
        put_comment(file, text);
    }
    for (int64_t j = 0; j < deck->reduced->num_loads; j++) {
        snprintf(text, sizeof text, "KG%" PRId64 " is of a unit of load '%s'%s",
                 j + 1, deck->reduced->load[j].name,
                 deck->request->numbered ? ""
                                         : ": K2GG = KAAX, X*KGn at X of it");
        put_comment(file, text);
    }
}

static ritz_status put_deck(FILE *file, const void *what)
{
    const dmig_deck *deck = what;
    const int64_t points = deck->rows.order - deck->rows.num_interface;
    dmig_marks marks = {.numbered = deck->request->numbered};

    put_comment(file, deck->certificate);
    for (int64_t k = 0; k < deck->report->count; k++)
        put_comment(file, deck->report->line[k]);
    put_commands(file, deck);
    put_places(file, deck);
    if (points == 1)
        fprintf(file, "SPOINT  %8" PRId64 "\n", deck->rows.first_point);
    else if (points > 1)
        fprintf(file, "SPOINT  %8" PRId64 "%8s%8" PRId64 "\n",
                deck->rows.first_point, "THRU",
                deck->rows.first_point + points - 1);
    for (int64_t k = 0; k < deck->count; k++) {
        const dmig_matrix *m = &deck->matrix[k];

        fprintf(file, "DMIG    %-8s%8d%8d%8d%8d\n", m->kind->card, 0,
                m->lower ? SYMMETRIC : SQUARE, 2, 0);
        for (int64_t col = 0; col < deck->rows.order; col++)
            put_column(file, deck, m, col, &marks);
    }
    return RITZ_OK;
}

static ritz_status write_deck(const ritz_export_object *object,
                              const ritz_export_request *request,
                              ritz_export_report *report)
{
    RITZ_OWN(dmig_deck)
    deck = {.reduced = object->reduced, .request = request, .report = report};
    dmig_audit audit = {0};

    RITZ_CHECK(ritz_certificate(object, request->stamp, &deck.certificate));
    RITZ_CHECK(ritz_nastran_rows_new(deck.reduced, "DMIG", &deck.rows));
    RITZ_CHECK(take_matrices(object, report, &deck));
    RITZ_CHECK(audit_rounding(&deck, &audit));
    RITZ_CHECK(ritz_nastran_rows_say(&deck.rows, report));
    for (int64_t k = 0; k < deck.count; k++)
        RITZ_CHECK(say_matrix(&deck.matrix[k], report));
    RITZ_CHECK(say_audit(&audit, report));
    RITZ_CHECK(say_losses(&deck, report));
    return ritz_sink_write(request->output, put_deck, &deck);
}

const ritz_exporter ritz_exporter_dmig = {
    .name = "dmig",
    .summary = "NASTRAN DMIG cards, with an audit of their digits",
    .reference = "Nastran1986",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_NUMBERED | RITZ_EXPORT_LOADS,
    .write = write_deck,
};
