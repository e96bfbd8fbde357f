/*
 * Shapes as a VTK unstructured grid in XML, all of it text [Schroeder2006]: one
 * vector field for each shape, and the number of each grid.
 */
#include "base/draft.h"
#include "formats/sink.h"

#include <errno.h>
#include <inttypes.h>
#include <string.h>

static void begin(FILE *file, const char *type, const char *name, int width)
{
    fprintf(file, "<DataArray type=\"%s\" Name=\"", type);
    ritz_xml_put(file, name);
    fprintf(file, "\" NumberOfComponents=\"%d\" format=\"ascii\">\n", width);
}

static void end(FILE *file)
{
    fputs("</DataArray>\n", file);
}

static void print_vectors(FILE *file, const char *name, int64_t count,
                          const double *values)
{
    begin(file, "Float64", name, 3);
    for (int64_t k = 0; k < count; k++)
        fprintf(file, "%.17g %.17g %.17g\n", values[3 * k], values[3 * k + 1],
                values[3 * k + 2]);
    end(file);
}

static void print_wholes(FILE *file, const char *name, int64_t count,
                         const int64_t *values)
{
    begin(file, "Int64", name, 1);
    for (int64_t k = 0; k < count; k++)
        fprintf(file, "%" PRId64 "%c", values[k], k % 16 == 15 ? '\n' : ' ');
    fputc('\n', file);
    end(file);
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

static void print_grid(FILE *file, const ritz_shapes *s)
{
    const ritz_elements *cells = &s->cells;

    fprintf(file,
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
            "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n"
            "<Piece NumberOfPoints=\"%" PRId64 "\" NumberOfCells=\"%" PRId64
            "\">\n",
            s->num_points, cells->count);
    print_fields(file, s);
    fputs("<Points>\n", file);
    print_vectors(file, "Points", s->num_points, s->position);
    fputs("</Points>\n<Cells>\n", file);
    print_wholes(file, "connectivity", cells->first[cells->count], cells->grid);
    print_wholes(file, "offsets", cells->count, cells->first + 1);
    print_wholes(file, "types", cells->count, cells->kind);
    fputs("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n", file);
}

static ritz_status write(const ritz_shapes *shapes,
                         const ritz_export_request *request,
                         ritz_export_report *report)
{
    ritz_status status = RITZ_OK;
    ritz_draft draft = {0};
    FILE *file = NULL;
    bool whole = true;

    RITZ_TRY(ritz_draft_new(request->output, &draft));
    file = fopen(draft.name, "w");
    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot write '%s': %s", draft.name,
                 strerror(errno));
    print_grid(file, shapes);
    whole = !ferror(file);
    whole = fclose(file) == 0 && whole;
    file = NULL;
    RITZ_FAIL_IF(!whole, RITZ_ERR_FILE,
                 "'%s' cannot be written to its end, is the disk full?",
                 request->output);
    RITZ_TRY(ritz_draft_publish(&draft));
    RITZ_TRY(ritz_shapes_say(shapes, report));
done:
    if (file)
        fclose(file);
    ritz_draft_free(&draft);
    return status;
}

const ritz_exporter ritz_exporter_vtu = {
    .name = "vtu",
    .summary = "shapes of modes or of columns for viewers (VTK, XML)",
    .reference = "Schroeder2006",
    .kind = "shapes",
    .uses = RITZ_EXPORT_SHAPES,
    .write_shapes = write,
};
