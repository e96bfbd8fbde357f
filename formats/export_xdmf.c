/*
 * Shapes as XDMF [Clarke2007]: a small XML file, and beside it an HDF5 file of
 * that name with the numbers. Cells are drawn by their corners, as few readers
 * know others in a mixed mesh.
 */
#include "base/alloc.h"
#include "base/text.h"
#include "formats/certificate.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <string.h>

/* Numbers of cells in a mixed topology; lines bring their length along. */
static const struct code {
    ritz_cell kind;
    int64_t code;
} codes[] = {
    {RITZ_CELL_LINE, 2},  {RITZ_CELL_TRIANGLE, 4}, {RITZ_CELL_QUAD, 5},
    {RITZ_CELL_TETRA, 6}, {RITZ_CELL_WEDGE, 8},    {RITZ_CELL_HEXA, 9},
};

static int64_t code_of(int64_t kind)
{
    for (size_t k = 0; k < sizeof codes / sizeof *codes; k++)
        if (codes[k].kind == ritz_cell_shape_of(kind)->linear)
            return codes[k].code;
    return 0;
}

/* Cells one after the other, each behind its number; room if @p out is NULL. */
static int64_t list_cells(const ritz_elements *cells, int64_t *out)
{
    int64_t at = 0;

    for (int64_t k = 0; k < cells->count; k++) {
        int64_t corners = ritz_cell_shape_of(cells->kind[k])->corners;
        int64_t code = code_of(cells->kind[k]);
        int64_t head[] = {code, corners};
        int64_t heads = code == 0 ? 0 : code == 2 ? 2 : 1;

        for (int64_t i = 0; i < heads; i++, at++)
            if (out)
                out[at] = head[i];
        for (int64_t i = 0; i < corners; i++, at++)
            if (out)
                out[at] = cells->grid[cells->first[k] + i];
    }
    return at;
}

static ritz_status write_field(hid_t file, const char *word, int64_t j,
                               const ritz_shapes *s, const ritz_dense *of)
{
    char name[48];

    snprintf(name, sizeof name, "%s_%" PRId64, word, j + 1);
    return ritz_h5_write(file, name, H5T_IEEE_F64LE,
                         ritz_h5_table(s->num_points, 3),
                         ritz_dense_col(of, j));
}

static int64_t list_length(const ritz_shapes *s)
{
    return list_cells(&s->cells, NULL);
}

ritz_status ritz_xdmf_write_mesh(hid_t file, const ritz_shapes *s)
{
    const int64_t length = list_length(s);
    RITZ_OWN_ARRAY int64_t *list = NULL;

    RITZ_CHECK_NEW(list, length);
    (void)list_cells(&s->cells, list);
    RITZ_CHECK(ritz_h5_write(file, "points", H5T_IEEE_F64LE,
                             ritz_h5_table(s->num_points, 3), s->position));
    RITZ_CHECK(ritz_h5_write(file, "grids", H5T_STD_I64LE,
                             ritz_h5_vector(s->num_points), s->id));
    return ritz_h5_write(
        file, "cells", H5T_STD_I64LE,
        s->meshed ? ritz_h5_vector(length) : ritz_h5_table(length, 1), list);
}

static ritz_status write_heavy(hid_t file, const void *what)
{
    const ritz_shapes *s = what;

    RITZ_CHECK(ritz_xdmf_write_mesh(file, s));
    for (int64_t j = 0; j < s->count; j++) {
        RITZ_CHECK(write_field(file, "translations", j, s, &s->u));
        if (s->turn.val)
            RITZ_CHECK(write_field(file, "rotations", j, s, &s->turn));
    }
    return RITZ_OK;
}

/* A reference to a data set of the HDF5 file that belongs to this one. */
static void refer_to_set(FILE *file, const char *heavy, const char *type,
                         int64_t rows, int64_t columns, const char *name)
{
    fprintf(file, "<DataItem DataType=\"%s\" Precision=\"8\" Dimensions=\"",
            type);
    if (columns > 0)
        fprintf(file, "%" PRId64 " %" PRId64, rows, columns);
    else
        fprintf(file, "%" PRId64, rows);
    fputs("\" Format=\"HDF\">", file);
    ritz_xml_put(file, heavy);
    fprintf(file, ":/%s</DataItem>\n", name);
}

void ritz_xdmf_put_field(FILE *file, const char *heavy,
                         const ritz_xdmf_field *field)
{
    fputs("<Attribute Name=\"", file);
    ritz_xml_put(file, field->name);
    fprintf(file, "\" AttributeType=\"%s\" Center=\"%s\">\n", field->kind,
            field->centre);
    refer_to_set(file, heavy, field->type, field->rows, field->columns,
                 field->set);
    fputs("</Attribute>\n", file);
}

void ritz_xdmf_put_mesh(FILE *file, const char *heavy, const ritz_shapes *s)
{
    fprintf(file,
            "<Topology TopologyType=\"%s\" NumberOfElements=\"%" PRId64
            "\"%s>\n",
            s->meshed ? "Mixed" : "Polyvertex", s->cells.count,
            s->meshed ? "" : " NodesPerElement=\"1\"");
    refer_to_set(file, heavy, "Int", list_length(s), s->meshed ? 0 : 1,
                 "cells");
    fputs("</Topology>\n<Geometry GeometryType=\"XYZ\">\n", file);
    refer_to_set(file, heavy, "Float", s->num_points, 3, "points");
    fputs("</Geometry>\n", file);
}

static void print_field(FILE *file, const char *heavy, const ritz_shapes *s,
                        int64_t j, const char *word, const char *beside)
{
    char set[48], name[RITZ_NAME_SIZE + 16];

    snprintf(set, sizeof set, "%s_%" PRId64, word, j + 1);
    snprintf(name, sizeof name, "%s%s", s->name[j], beside);
    ritz_xdmf_put_field(file, heavy,
                        &(ritz_xdmf_field){name, "Vector", "Node", "Float", set,
                                           s->num_points, 3});
}

/* The XML file, which refers to the HDF5 file by its name. */
typedef struct xdmf_pair {
    const ritz_shapes *shapes;
    const char *beside; /* path of the numbers */
    const char *certificate;
} xdmf_pair;

static ritz_status print_light(FILE *file, const void *what)
{
    const xdmf_pair *pair = what;
    const ritz_shapes *s = pair->shapes;
    const char *heavy = ritz_path_name(pair->beside);

    fputs("<?xml version=\"1.0\"?>\n", file);
    ritz_comment_put_xml(file, pair->certificate);
    fputs("<Xdmf Version=\"3.0\">\n<Domain>\n"
          "<Grid Name=\"shapes\" GridType=\"Uniform\">\n",
          file);
    ritz_xdmf_put_mesh(file, heavy, s);
    for (int64_t j = 0; j < s->count; j++) {
        print_field(file, heavy, s, j, "translations", "");
        if (s->turn.val)
            print_field(file, heavy, s, j, "rotations", ", rotations");
    }
    ritz_xdmf_put_field(file, heavy,
                        &(ritz_xdmf_field){"grid", "Scalar", "Node", "Int",
                                           "grids", s->num_points, 0});
    fputs("</Grid>\n</Domain>\n</Xdmf>\n", file);
    return RITZ_OK;
}

ritz_status ritz_xdmf_name_heavy(const char *output, char **out)
{
    char *heavy = NULL;

    /* readers split "FILE:SET" at the last ':' */
    RITZ_REFUSE_IF(strchr(ritz_path_name(output), ':'), RITZ_ERR_ARGUMENT,
                   "'%s' holds ':', which parts file and data set in XDMF",
                   output);
    RITZ_CHECK_NEW(heavy, (int64_t)strlen(output) + 4);
    strcpy(heavy, output); // NOLINT: there is room
    strcat(heavy, ".h5");  // NOLINT
    *out = heavy;
    return RITZ_OK;
}

/* Both drafts are complete before either gets its name. */
static ritz_status write_shapes(const ritz_export_object *object,
                                const ritz_export_request *request,
                                ritz_export_report *report)
{
    const ritz_shapes *shapes = object->shapes;
    RITZ_OWN(ritz_draft) heavy = {0}, light = {0};
    RITZ_OWN_ARRAY char *beside = NULL, *certificate = NULL;
    xdmf_pair pair = {shapes, NULL, NULL};

    RITZ_CHECK(ritz_xdmf_name_heavy(request->output, &beside));
    RITZ_CHECK(ritz_certificate(object, request->stamp, &certificate));
    pair.beside = beside;
    pair.certificate = certificate;
    RITZ_CHECK_IN(beside, ritz_draft_new(beside, &heavy));
    RITZ_CHECK_IN(request->output, ritz_draft_new(request->output, &light));
    RITZ_CHECK(ritz_sink_fill_h5(&heavy, write_heavy, shapes));
    RITZ_CHECK(ritz_sink_fill(&light, print_light, &pair));
    RITZ_CHECK(ritz_draft_publish_all(2, (ritz_draft *[]){&heavy, &light}));
    RITZ_CHECK(ritz_shapes_say(shapes, report));
    return ritz_export_say(report,
                           "the numbers are in %.190s, which must stay beside "
                           "it, and keep every bit",
                           beside);
}

const ritz_exporter ritz_exporter_xdmf = {
    .name = "xdmf",
    .summary = "shapes of modes or of columns for viewers (XDMF, HDF5)",
    .reference = "Clarke2007",
    .kind = "shapes",
    .takes = RITZ_EXPORT_SHAPES,
    .write = write_shapes,
};
