/*
 * Writes a reduced component as an external superelement of NASTRAN, in three
 * files:
 *
 *     part.op4   KAA MAA BAA K4XX PA GPXX GDXX RVAX VA MUG1 ...
 *     part.asm   SEBULK, SECONCT, GRID, CORD2R, SPOINT: for the main bulk data
 *     part.pch   BEGIN SUPER, EXTRN, GRID, CORD2R, ASET, QSET1, SPOINT, DTI
 *
 * NASTRAN identifies the matrices by their order. So all are written; one that
 * the component does not have is 1 x 1 and zero. VA is a column of ones. Rows
 * are in the order of EXTRN, with numbers of grids and points ascending
 * [MSC2022].
 *
 * The order of the matrices is that in files of two versions of NASTRAN, and in
 * those of pyYeti [Widrick2024].
 */
#include "base/alloc.h"
#include "base/text.h"
#include "base/tolerances.h"
#include "formats/cards.h"
#include "formats/certificate.h"
#include "formats/large_field.h"
#include "formats/nastran_displacements.h"
#include "formats/nastran_rows.h"
#include "formats/sink.h"
#include "formats/small_field.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum {
    COMMENT = 68, /* columns of text behind "$ " */
    USUAL_ID = 101,
};

/* A grid or scalar point of the interface. */
typedef struct external_point {
    int64_t id;
    int64_t digits; /* directions, as 123456; 0 for a scalar point */
    int64_t grid;   /* index among the grids; -1 for a scalar point */
} external_point;

typedef struct external_element {
    const ritz_reduced *reduced;
    const ritz_export_report *report;
    int64_t id;
    ritz_nastran_rows rows;
    int64_t num_points;
    external_point *point; /* of the interface, ascending */
    int64_t num_frames;    /* displacement frames of grids of the interface */
    int64_t *frame;        /* for each frame of the component, the number of its
                              CORD2R; 0 if no grid of the interface has it */
    double rounded;        /* largest rounding error of positions and axes,
                              relative to the size of the vector */
    ritz_nastran_displacements outputs;
    ritz_nastran_elements stresses, forces;
    char *path[3]; /* .op4, .asm, .pch */
    char *certificate;
} external_element;

static void external_element_free(external_element *e)
{
    ritz_nastran_rows_free(&e->rows);
    ritz_nastran_displacements_free(&e->outputs);
    ritz_nastran_elements_free(&e->stresses);
    ritz_nastran_elements_free(&e->forces);
    RITZ_FREE(e->point, e->frame, e->path[0], e->path[1], e->path[2],
              e->certificate);
}

/* ---- interface ----------------------------------------------------------- */

static ritz_status list_points(external_element *e)
{
    const ritz_nastran_rows *rows = &e->rows;
    external_point *last = NULL;

    RITZ_CHECK_NEW(e->point, rows->num_interface);
    for (int64_t k = 0; k < rows->num_interface; k++) {
        const ritz_dof dof = rows->dof[rows->at[k]];

        if (!last || last->id != dof.grid) {
            last = &e->point[e->num_points++];
            last->id = dof.grid;
            last->grid = dof.component > 0
                             ? ritz_grids_find(&e->reduced->grids, dof.grid)
                             : -1;
            RITZ_REFUSE_IF(dof.component > 0 && last->grid < 0,
                           RITZ_ERR_ARGUMENT,
                           "grid %" PRId64 " has no position, and a "
                           "superelement is placed by those of its grids: "
                           "import the component with --bulk",
                           dof.grid);
        }
        last->digits = 10 * last->digits + dof.component;
    }
    return RITZ_OK;
}

/* Note the rounding error of a number in 16 columns, relative to `size`. */
static void round_number(external_element *e, double x, double size)
{
    char text[RITZ_LARGE_FIELD_SIZE];
    double y = 0.0;

    ritz_large_field_print(x, text);
    if (size > 0.0 && ritz_card_number(text, &y))
        e->rounded = fmax(e->rounded, fabs(y - x) / size);
}

/* Give numbers of CORD2R to the displacement frames of the interface. */
static ritz_status number_frames(external_element *e)
{
    const ritz_grids *grids = &e->reduced->grids;

    RITZ_CHECK_NEW(e->frame, grids->num_frames > 0 ? grids->num_frames : 1);
    for (int64_t k = 0; k < e->num_points; k++) {
        const int64_t g = e->point[k].grid;
        const double *at = g < 0 ? NULL : grids->position + 3 * g;
        double size = 0.0;

        for (int i = 0; at && i < 3; i++)
            size = fmax(size, fabs(at[i]));
        for (int i = 0; at && i < 3; i++)
            round_number(e, at[i], size);
        if (!at || grids->frame[g] == 0 || e->frame[grids->frame[g]] > 0)
            continue;
        for (int i = 0; i < 9; i++)
            round_number(e, grids->axes[9 * grids->frame[g] + i], 1.0);
        e->frame[grids->frame[g]] = e->rows.first_point + e->num_frames++;
    }
    RITZ_REFUSE_IF(e->rows.first_point + e->num_frames > RITZ_NASTRAN_MOST_ID,
                   RITZ_ERR_ARGUMENT,
                   "grids leave no numbers up to %d for %" PRId64
                   " displacement frames",
                   RITZ_NASTRAN_MOST_ID, e->num_frames);
    return RITZ_OK;
}

/* ---- matrices ------------------------------------------------------------ */

/* The matrices of the file, in their order, and the names of those that are
   matrices of the reduced component. */
static const struct {
    const char *name, *of;
    bool symmetric; /* NASTRAN takes only a symmetric matrix */
} members[] = {
    {"KAA", "K", true},     {"MAA", "M", true},      {"BAA", "D", false},
    {"K4XX", "K4", true},   {"PA", NULL, false},     {"GPXX", NULL, false},
    {"GDXX", NULL, false},  {"RVAX", NULL, false},   {"VA", NULL, false},
    {"MUG1", NULL, false},  {"MUG1O", NULL, false},  {"MES1", NULL, false},
    {"MES1O", NULL, false}, {"MEE1", NULL, false},   {"MEE1O", NULL, false},
    {"MGPF", NULL, false},  {"MGPFO", NULL, false},  {"MEF1", NULL, false},
    {"MEF1O", NULL, false}, {"MQG1", NULL, false},   {"MQG1O", NULL, false},
    {"MQMG1", NULL, false}, {"MQMG1O", NULL, false},
};
enum { NUM_MEMBERS = sizeof members / sizeof *members };

static const ritz_matrix *find_matrix(const ritz_matrices *list,
                                      const char *name)
{
    for (int64_t k = 0; name && k < list->count; k++)
        if (strcmp(list->matrix[k].name, name) == 0)
            return &list->matrix[k];
    return NULL;
}

/* Put rows and columns into the order of EXTRN.
 * @param[in] from  a matrix with all its entries stored */
static ritz_status order_matrix(const ritz_nastran_rows *rows,
                                const ritz_matrix *from, bool symmetric,
                                ritz_export_report *report, ritz_matrix *out)
{
    const int64_t n = rows->order;
    RITZ_OWN(ritz_dense) A = {0};
    double asymmetry = 0.0;

    RITZ_CHECK(ritz_dense_new(n, n, &A));
    for (int64_t j = 0; j < n; j++)
        for (int64_t i = 0; i < n; i++)
            ritz_dense_col(&A, j)[i] =
                from->A.val[n * rows->at[j] + rows->at[i]];
    asymmetry = ritz_dense_asymmetry(&A);
    out->symmetric = asymmetry <= RITZ_SYMMETRIC;
    RITZ_REFUSE_IF(symmetric && !out->symmetric, RITZ_ERR_ARGUMENT,
                   "'%s' is not symmetric, and NASTRAN takes no such "
                   "superelement",
                   from->name);
    if (out->symmetric)
        ritz_dense_symmetrise(&A);
    if (out->symmetric && asymmetry > 0.0)
        RITZ_CHECK(ritz_export_say(
            report,
            "an asymmetry of %s by %.1e of its largest entry is averaged away",
            from->name, asymmetry));
    return ritz_sink_store(&A, &out->A);
}

static ritz_status make_ones(int64_t n, ritz_matrix *out)
{
    RITZ_OWN(ritz_dense) ones = {0};

    RITZ_CHECK(ritz_dense_new(n, 1, &ones));
    for (int64_t i = 0; i < n; i++)
        ones.val[i] = 1.0;
    return ritz_sink_store(&ones, &out->A);
}

static ritz_status store_rows(const ritz_nastran_elements *elements,
                              const ritz_nastran_rows *rows, ritz_matrix *out)
{
    RITZ_OWN(ritz_dense) A = {0};

    RITZ_CHECK(ritz_nastran_elements_matrix(elements, rows, &A));
    return ritz_sink_store(&A, &out->A);
}

static ritz_status make_members(const external_element *e,
                                const ritz_matrices *list,
                                ritz_export_report *report, ritz_matrices *out)
{
    RITZ_CHECK_NEW(out->matrix, NUM_MEMBERS);
    for (; out->count < NUM_MEMBERS; out->count++) {
        const char *name = members[out->count].name;
        const ritz_matrix *from = find_matrix(list, members[out->count].of);
        ritz_matrix *to = &out->matrix[out->count];

        snprintf(to->name, sizeof to->name, "%s", name);
        if (from) {
            RITZ_CHECK(order_matrix(&e->rows, from,
                                    members[out->count].symmetric, report, to));
        } else if (strcmp(name, "VA") == 0) {
            RITZ_CHECK(make_ones(e->rows.order, to));
        } else if (strcmp(name, "MUG1") == 0 && e->outputs.count > 0) {
            RITZ_CHECK(ritz_sink_store(&e->outputs.A, &to->A));
        } else if (strcmp(name, "MES1") == 0 && e->stresses.count > 0) {
            RITZ_CHECK(store_rows(&e->stresses, &e->rows, to));
        } else if (strcmp(name, "MEF1") == 0 && e->forces.count > 0) {
            RITZ_CHECK(store_rows(&e->forces, &e->rows, to));
        } else {
            to->symmetric = true; /* one zero */
            RITZ_CHECK(ritz_sparse_new(1, 1, 0, &to->A));
        }
    }
    return RITZ_OK;
}

/* ---- cards --------------------------------------------------------------- */

static void put_comment(FILE *file, const char *text)
{
    ritz_comment_put(file, "$ ", COMMENT, text);
}

static void put_certificate(FILE *file, const external_element *e)
{
    put_comment(file, e->certificate);
    for (int64_t k = 0; k < e->report->count; k++)
        put_comment(file, e->report->line[k]);
}

static int64_t count_modes(const external_element *e)
{
    return e->rows.order - e->rows.num_interface;
}

/* The scalar points of the interface, and those of modal coordinates. */
static void put_points(FILE *file, const external_element *e)
{
    for (int64_t k = 0; k < e->num_points; k++)
        if (e->point[k].digits == 0) {
            ritz_small_card card = ritz_small_begin(file, "SPOINT");

            ritz_small_id(&card, e->point[k].id);
            ritz_small_end(&card);
        }
    if (count_modes(e) > 0) {
        ritz_small_card card = ritz_small_begin(file, "SPOINT");

        ritz_small_range(&card, e->rows.first_point, count_modes(e));
        ritz_small_end(&card);
    }
}

static void put_numbers(FILE *file, int count, const double *x)
{
    char text[RITZ_LARGE_FIELD_SIZE];

    for (int i = 0; i < count; i++) {
        ritz_large_field_print(x[i], text);
        fprintf(file, "%16s", text);
    }
    fputc('\n', file);
}

/* CORD2R is given by the origin, a point on axis 3 and a point on axis 1. */
static void put_frame(FILE *file, int64_t id, const double *axes)
{
    const double point[9] = {0.0,     0.0,     0.0,     axes[6], axes[7],
                             axes[8], axes[0], axes[1], axes[2]};

    fprintf(file, "%-8s%16" PRId64 "%16d", "CORD2R*", id, 0);
    put_numbers(file, 2, point);
    fprintf(file, "%-8s", "*");
    put_numbers(file, 4, point + 2);
    fprintf(file, "%-8s", "*");
    put_numbers(file, 3, point + 6);
}

static void put_grid(FILE *file, const external_element *e, int64_t g)
{
    const ritz_grids *grids = &e->reduced->grids;
    const double *at = grids->position + 3 * g;
    char text[RITZ_LARGE_FIELD_SIZE];

    fprintf(file, "%-8s%16" PRId64 "%16d", "GRID*", grids->id[g], 0);
    put_numbers(file, 2, at);
    ritz_large_field_print(at[2], text);
    fprintf(file, "%-8s%16s%16" PRId64 "\n", "*", text,
            e->frame[grids->frame[g]]);
}

/* The frames and grids of the interface, which both decks contain. */
static void put_geometry(FILE *file, const external_element *e)
{
    const ritz_grids *grids = &e->reduced->grids;

    for (int64_t f = 1; f < grids->num_frames; f++)
        if (e->frame[f] > 0)
            put_frame(file, e->frame[f], grids->axes + 9 * f);
    for (int64_t k = 0; k < e->num_points; k++)
        if (e->point[k].grid >= 0)
            put_grid(file, e, e->point[k].grid);
}

/* The cards are SEBULK SEID EXTOP4 - MANUAL - - UNIT and SECONCT SEID 0 with
 * pairs of numbers, one in each model. Both are the same here. NASTRAN also
 * reads ranges there, but some other readers do not. */
static ritz_status put_assembly(FILE *file, const void *what)
{
    const external_element *e = what;
    ritz_small_card card = {0};

    put_comment(file, "external superelement: for the main bulk data\n");
    put_certificate(file, e);
    card = ritz_small_begin(file, "SEBULK");
    ritz_small_id(&card, e->id);
    ritz_small_text(&card, "EXTOP4");
    ritz_small_text(&card, "");
    ritz_small_text(&card, "MANUAL");
    ritz_small_text(&card, "");
    ritz_small_text(&card, "");
    ritz_small_id(&card, e->id);
    ritz_small_end(&card);
    card = ritz_small_begin(file, "SECONCT");
    ritz_small_id(&card, e->id);
    ritz_small_id(&card, 0);
    ritz_small_skip(&card);
    for (int64_t k = 0; k < e->num_points; k++) {
        ritz_small_id(&card, e->point[k].id);
        ritz_small_id(&card, e->point[k].id);
    }
    for (int64_t k = 0; k < count_modes(e); k++) {
        ritz_small_id(&card, e->rows.first_point + k);
        ritz_small_id(&card, e->rows.first_point + k);
    }
    ritz_small_end(&card);
    put_geometry(file, e);
    put_points(file, e);
    return RITZ_OK;
}

static void put_rows(FILE *file, const external_element *e)
{
    ritz_small_card card = ritz_small_begin(file, "EXTRN");

    for (int64_t k = 0; k < e->num_points; k++) {
        ritz_small_id(&card, e->point[k].id);
        ritz_small_id(&card, e->point[k].digits);
    }
    for (int64_t k = 0; k < count_modes(e); k++) {
        ritz_small_id(&card, e->rows.first_point + k);
        ritz_small_id(&card, 0);
    }
    ritz_small_end(&card);
}

static void put_sets(FILE *file, const external_element *e)
{
    ritz_small_card card = {0};

    for (int64_t k = 0; k < e->num_points; k++) {
        card = ritz_small_begin(file, "ASET");
        ritz_small_id(&card, e->point[k].id);
        ritz_small_id(&card, e->point[k].digits);
        ritz_small_end(&card);
    }
    if (count_modes(e) == 0)
        return;
    card = ritz_small_begin(file, "QSET1");
    ritz_small_id(&card, 0);
    ritz_small_range(&card, e->rows.first_point, count_modes(e));
    ritz_small_end(&card);
}

/* The tables that name the rows of MUG1, MES1 and MEF1. */
static void put_tables(FILE *file, const external_element *e)
{
    const int64_t columns = e->rows.order;

    if (e->outputs.count > 0)
        ritz_nastran_table_put(file, "displacement", e->outputs.A.nrow, columns,
                               e->outputs.count, e->outputs.entry);
    if (e->stresses.count > 0)
        ritz_nastran_table_put(file, "stress", e->stresses.num_rows, columns,
                               e->stresses.count, e->stresses.entry);
    if (e->forces.count > 0)
        ritz_nastran_table_put(file, "force", e->forces.num_rows, columns,
                               e->forces.count, e->forces.entry);
}

static ritz_status put_part(FILE *file, const void *what)
{
    const external_element *e = what;

    put_comment(file, "external superelement: behind the main bulk data, in "
                      "front of ENDDATA\n");
    put_certificate(file, e);
    fprintf(file, "BEGIN SUPER%8" PRId64 "\n", e->id);
    put_rows(file, e);
    put_geometry(file, e);
    put_sets(file, e);
    put_points(file, e);
    put_tables(file, e);
    return RITZ_OK;
}

/* ---- report -------------------------------------------------------------- */

static ritz_status say_files(const external_element *e,
                             ritz_export_report *report)
{
    RITZ_CHECK(ritz_export_say(report,
                               "superelement %" PRId64
                               ": ASSIGN INPUTT4='%.80s' UNIT=%" PRId64
                               " in the file management section",
                               e->id, ritz_path_name(e->path[0]), e->id));
    return ritz_export_say(
        report,
        "INCLUDE '%.80s' in the main bulk data, INCLUDE '%.80s' behind it",
        ritz_path_name(e->path[1]), ritz_path_name(e->path[2]));
}

static ritz_status say_geometry(const external_element *e,
                                ritz_export_report *report)
{
    if (e->num_frames > 0)
        RITZ_CHECK(ritz_export_say(
            report,
            "displacement axes of grids are CORD2R %" PRId64 " to %" PRId64
            ", new numbers",
            e->rows.first_point, e->rows.first_point + e->num_frames - 1));
    return ritz_export_say(report,
                           "positions and axes are rounded to 16 columns, by "
                           "%.1e of themselves at most",
                           e->rounded);
}

static ritz_status say_outputs(const external_element *e,
                               ritz_export_report *report)
{
    if (e->outputs.count > 0)
        RITZ_CHECK(ritz_export_say(report,
                                   "displacements of the %" PRId64
                                   " grids and points of ports and recovery "
                                   "are MUG1, named by TUG1",
                                   e->outputs.count));
    RITZ_CHECK(ritz_nastran_elements_say(&e->outputs.recovered, "displacement",
                                         "MUG1", report));
    RITZ_CHECK(
        ritz_nastran_elements_say(&e->stresses, "stress", "MES1", report));
    RITZ_CHECK(ritz_nastran_elements_say(&e->forces, "force", "MEF1", report));
    RITZ_CHECK(ritz_nastran_rows_say_ports(
        &e->rows, e->reduced,
        "was not attached: the files hold its displacements only", report));
    return ritz_export_say(report, "left out, as a superelement has no place "
                                   "for them: inputs and outputs, inertia, "
                                   "other shapes");
}

/* ---- files --------------------------------------------------------------- */

/* Name part.asm and part.pch after part.op4. */
static ritz_status name_files(const char *output, external_element *e)
{
    static const char *const suffix[] = {".op4", ".asm", ".pch"};
    const size_t length = strlen(output);

    RITZ_REFUSE_IF(length < 5 || strcasecmp(output + length - 4, ".op4") != 0 ||
                       output[length - 5] == '/',
                   RITZ_ERR_ARGUMENT,
                   "'%s' does not end with .op4: a superelement is the files "
                   "NAME.op4, NAME.asm and NAME.pch, and takes the name of "
                   "the first",
                   output);
    for (int k = 0; k < 3; k++) {
        RITZ_CHECK_COPY(e->path[k], output, (int64_t)length + 1);
        if (k > 0)
            memcpy(e->path[k] + length - 4, suffix[k], 4);
    }
    return RITZ_OK;
}

static ritz_status write_files(const external_element *e,
                               const ritz_matrices *list,
                               const ritz_output4_style *style)
{
    RITZ_OWN(ritz_draft) op4 = {0}, assembly = {0}, part = {0};

    RITZ_CHECK_IN(e->path[0], ritz_draft_new(e->path[0], &op4));
    RITZ_CHECK_IN(e->path[1], ritz_draft_new(e->path[1], &assembly));
    RITZ_CHECK_IN(e->path[2], ritz_draft_new(e->path[2], &part));
    RITZ_CHECK(ritz_output4_fill(&op4, list->count, list->matrix, style));
    RITZ_CHECK(ritz_sink_fill(&assembly, put_assembly, e));
    RITZ_CHECK(ritz_sink_fill(&part, put_part, e));
    return ritz_draft_publish_all(3, (ritz_draft *[]){&op4, &assembly, &part});
}

static ritz_status write_element(const ritz_export_object *object,
                                 const ritz_export_request *request,
                                 ritz_export_report *report)
{
    RITZ_OWN(external_element)
    e = {.reduced = object->reduced,
         .report = report,
         .id = request->id > 0 ? request->id : USUAL_ID};
    RITZ_OWN(ritz_matrices) list = {0}, ordered = {0};
    ritz_output4_style style = {0};

    RITZ_CHECK(name_files(request->output, &e));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &e.certificate));
    RITZ_CHECK(ritz_nastran_rows_new(e.reduced, "a superelement", &e.rows));
    RITZ_CHECK(list_points(&e));
    RITZ_CHECK(number_frames(&e));
    RITZ_CHECK(ritz_nastran_displacements_new(e.reduced, &e.rows, &e.outputs));
    RITZ_CHECK(ritz_nastran_elements_new(e.reduced, "stress", &e.stresses));
    RITZ_CHECK(ritz_nastran_elements_new(e.reduced, "force", &e.forces));
    RITZ_CHECK(ritz_export_damped(object, request, "K,M,D,K4", report, &list));
    RITZ_CHECK(make_members(&e, &list, report, &ordered));
    RITZ_CHECK(ritz_output4_style_of(request, report, &style));
    RITZ_CHECK(ritz_nastran_rows_say(&e.rows, report));
    RITZ_CHECK(say_geometry(&e, report));
    RITZ_CHECK(say_outputs(&e, report));
    RITZ_CHECK(say_files(&e, report));
    return write_files(&e, &ordered, &style);
}

const ritz_exporter ritz_exporter_superelement = {
    .name = "superelement",
    .summary = "NASTRAN external superelement: .op4, .asm and .pch",
    .reference = "MSC2022",
    .kind = "reduced",
    .takes = RITZ_EXPORT_REDUCED | RITZ_EXPORT_STYLE | RITZ_EXPORT_ID |
             RITZ_EXPORT_ROWS,
    .write = write_element,
};
