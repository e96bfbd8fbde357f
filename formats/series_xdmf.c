/*
 * Writes a series as XDMF [Clarke2007]: an XML file with a grid for each time,
 * all with the same mesh, and next to it an HDF5 file with the numbers, which
 * is written frame by frame.
 */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

typedef struct xdmf {
    const ritz_shapes *mesh; /* borrowed */
    ritz_draft heavy;
    char *beside; /* path of the numbers */
    hid_t file;
} xdmf;

static void name_set(const char *word, int64_t frame, int64_t field,
                     char out[RITZ_NAME_SIZE])
{
    if (field < 0)
        snprintf(out, RITZ_NAME_SIZE, "%s_%06" PRId64, word, frame);
    else
        snprintf(out, RITZ_NAME_SIZE, "%s_%" PRId64 "_%06" PRId64, word,
                 field + 1, frame);
}

static ritz_status begin(const char *path, const ritz_shapes *mesh,
                         ritz_series *series)
{
    xdmf *x = NULL;

    RITZ_CHECK_NEW(x, 1);
    series->own = x;
    x->mesh = mesh;
    RITZ_CHECK(ritz_xdmf_name_heavy(path, &x->beside));
    RITZ_CHECK_IN(x->beside, ritz_draft_new(x->beside, &x->heavy));
    RITZ_CHECK(ritz_h5_create(x->heavy.name, &x->file));
    return ritz_context(ritz_xdmf_write_mesh(x->file, mesh), x->beside);
}

static ritz_status write_points(const xdmf *x, const char *word, int64_t frame,
                                const ritz_dense *of)
{
    char name[RITZ_NAME_SIZE];

    name_set(word, frame, -1, name);
    return ritz_h5_write(x->file, name, H5T_IEEE_F64LE,
                         ritz_h5_table(x->mesh->num_points, 3), of->val);
}

static ritz_status frame(ritz_series *series, const ritz_shapes *shapes)
{
    const xdmf *x = series->own;
    const int64_t cells = x->mesh->cells.count;
    char name[RITZ_NAME_SIZE];

    RITZ_CHECK_IN(x->beside,
                  write_points(x, "translations", series->count, &shapes->u));
    if (shapes->turn.val)
        RITZ_CHECK_IN(x->beside, write_points(x, "rotations", series->count,
                                              &shapes->turn));
    for (int64_t k = 0; k < shapes->num_fields; k++) {
        name_set("field", series->count, k, name);
        RITZ_CHECK_IN(x->beside, ritz_h5_write(x->file, name, H5T_IEEE_F64LE,
                                               ritz_h5_vector(cells),
                                               shapes->of_cell + k * cells));
    }
    return RITZ_OK;
}

static void print_frame(FILE *file, const char *heavy,
                        const ritz_series *series, int64_t k)
{
    const xdmf *x = series->own;
    const ritz_shapes *mesh = x->mesh;
    char set[RITZ_NAME_SIZE];

    fprintf(file, "<Grid GridType=\"Uniform\">\n<Time Value=\"%.17g\"/>\n",
            series->seconds[k]);
    ritz_xdmf_put_mesh(file, heavy, mesh);
    name_set("translations", k, -1, set);
    ritz_xdmf_put_field(file, heavy,
                        &(ritz_xdmf_field){"displacement", "Vector", "Node",
                                           "Float", set, mesh->num_points, 3});
    name_set("rotations", k, -1, set);
    if (mesh->turn.val)
        ritz_xdmf_put_field(file, heavy,
                            &(ritz_xdmf_field){"displacement, rotations",
                                               "Vector", "Node", "Float", set,
                                               mesh->num_points, 3});
    for (int64_t j = 0; j < mesh->num_fields; j++) {
        name_set("field", k, j, set);
        ritz_xdmf_put_field(file, heavy,
                            &(ritz_xdmf_field){mesh->field[j], "Scalar", "Cell",
                                               "Float", set, mesh->cells.count,
                                               0});
    }
    fputs("</Grid>\n", file);
}

static ritz_status print_light(FILE *file, const void *what)
{
    const ritz_series *series = what;
    const xdmf *x = series->own;
    const char *folder = strrchr(x->beside, '/');
    const char *heavy = folder ? folder + 1 : x->beside;

    fputs("<?xml version=\"1.0\"?>\n", file);
    ritz_comment_put_xml(file, series->comment);
    fputs("<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"motion\" "
          "GridType=\"Collection\" CollectionType=\"Temporal\">\n",
          file);
    for (int64_t k = 0; k < series->count; k++)
        print_frame(file, heavy, series, k);
    fputs("</Grid>\n</Domain>\n</Xdmf>\n", file);
    return RITZ_OK;
}

/* The HDF5 file keeps the name that begin() gave it, whatever `path` is. */
static ritz_status finish(ritz_series *series, const char *path)
{
    xdmf *x = series->own;
    RITZ_OWN(ritz_draft) light = {0};

    RITZ_CHECK_IN(x->beside, ritz_h5_finish(&x->file));
    RITZ_CHECK_IN(path, ritz_draft_new(path, &light));
    RITZ_CHECK(ritz_sink_fill(&light, print_light, series));
    return ritz_draft_publish_all(2, (ritz_draft *[]){&x->heavy, &light});
}

static void end(ritz_series *series)
{
    xdmf *x = series->own;

    if (x->file > 0)
        (void)ritz_h5_finish(&x->file);
    ritz_draft_free(&x->heavy);
    RITZ_FREE(x->beside, x);
}

const ritz_series_format ritz_series_format_xdmf = {
    .name = "xdmf",
    .summary = "an XML file, and all numbers in an HDF5 file beside it",
    .reference = "Clarke2007",
    .begin = begin,
    .frame = frame,
    .finish = finish,
    .end = end,
};
