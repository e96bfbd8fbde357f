/*
 * Shapes as a VTK unstructured grid in XML, all of it text [Schroeder2006]: one
 * vector field for each shape, and the number of each grid.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <math.h>

static void begin_array(FILE *file, const char *type, const char *name,
                        int width)
{
    fprintf(file, "<DataArray type=\"%s\" Name=\"", type);
    ritz_xml_put(file, name);
    fprintf(file, "\" NumberOfComponents=\"%d\" format=\"ascii\">\n", width);
}

static void end_array(FILE *file)
{
    fputs("</DataArray>\n", file);
}

static void print_vectors(FILE *file, const char *name, int64_t count,
                          const double *values)
{
    begin_array(file, "Float64", name, 3);
    for (int64_t k = 0; k < count; k++)
        fprintf(file, "%.17g %.17g %.17g\n", values[3 * k], values[3 * k + 1],
                values[3 * k + 2]);
    end_array(file);
}

static void print_wholes(FILE *file, const char *name, int64_t count,
                         const int64_t *values)
{
    begin_array(file, "Int64", name, 1);
    for (int64_t k = 0; k < count; k++)
        fprintf(file, "%" PRId64 "%c", values[k], k % 16 == 15 ? '\n' : ' ');
    fputc('\n', file);
    end_array(file);
}

static void print_fields(FILE *file, const ritz_shapes *s)
{
    fputs("<PointData>\n", file);
    for (int64_t j = 0; j < s->count; j++) {
        char name[RITZ_NAME_SIZE + 16];

        print_vectors(file, s->name[j], s->num_points,
                      ritz_dense_col(&s->u, j));
        if (!s->turn.val)
            continue;
        snprintf(name, sizeof name, "%s, rotations", s->name[j]);
        print_vectors(file, name, s->num_points, ritz_dense_col(&s->turn, j));
    }
    print_wholes(file, "grid", s->num_points, s->id);
    fputs("</PointData>\n", file);
}

/* A cell without a value has "nan". */
static void print_cell_fields(FILE *file, const ritz_shapes *s)
{
    const int64_t count = s->cells.count;

    if (s->num_fields == 0)
        return;
    fputs("<CellData>\n", file);
    for (int64_t k = 0; k < s->num_fields; k++) {
        begin_array(file, "Float64", s->field[k], 1);
        for (int64_t i = 0; i < count; i++) {
            double value = s->of_cell[k * count + i];

            if (isnan(value))
                fputs("nan\n", file);
            else
                fprintf(file, "%.17g\n", value);
        }
        end_array(file);
    }
    if (s->cells.id)
        print_wholes(file, "element", count, s->cells.id);
    fputs("</CellData>\n", file);
}

ritz_status ritz_vtu_print(FILE *file, const void *what)
{
    const ritz_vtu_parts *parts = what;
    const ritz_shapes *s = parts->shapes;
    const ritz_elements *cells = &s->cells;

    fputs("<?xml version=\"1.0\"?>\n", file);
    ritz_comment_put_xml(file, parts->certificate);
    fprintf(file,
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
            "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
            "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfCells=\"%" PRId64
            "\">\n",
            s->num_points, cells->count);
    print_fields(file, s);
    print_cell_fields(file, s);
    fputs("<Points>\n", file);
    print_vectors(file, "Points", s->num_points, s->position);
    fputs("</Points>\n<Cells>\n", file);
    print_wholes(file, "connectivity", cells->first[cells->count], cells->grid);
    print_wholes(file, "offsets", cells->count, cells->first + 1);
    print_wholes(file, "types", cells->count, cells->kind);
    fputs("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n", file);
    return RITZ_OK;
}

static ritz_status write_shapes(const ritz_export_object *object,
                                const ritz_export_request *request,
                                ritz_export_report *report)
{
    RITZ_OWN_ARRAY char *certificate = NULL;
    ritz_vtu_parts parts = {object->shapes, NULL};

    RITZ_CHECK(ritz_certificate(object, request->stamp, &certificate));
    parts.certificate = certificate;
    RITZ_CHECK(ritz_sink_write(request->output, ritz_vtu_print, &parts));
    RITZ_CHECK(ritz_shapes_say(object->shapes, report));
    return ritz_export_say(report, "17 digits, which keep every bit");
}

const ritz_exporter ritz_exporter_vtu = {
    .name = "vtu",
    .summary = "shapes of modes or of columns for viewers (VTK, XML)",
    .reference = "Schroeder2006",
    .kind = "shapes",
    .takes = RITZ_EXPORT_SHAPES,
    .write = write_shapes,
};
