/*
 * Reads collections and frames of VTK for pictures, but only as series_pvd.c
 * and export_vtu.c write them: one piece whose arrays are text. Of the arrays
 * with values of cells only the first is read.
 */
#include "base/alloc.h"
#include "base/text.h"

#include <ritz/export.h>

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- attributes and arrays ---------------------------------------------- */

/* The value of an attribute, which ends at the next quote. @p text is within
 * the element, before the attribute. NULL if the element does not have it. */
static const char *find_attribute(const char *text, const char *name)
{
    const size_t length = strlen(name);

    for (; *text && *text != '>'; text++)
        if (strncmp(text, name, length) == 0 && text[length] == '=' &&
            text[length + 1] == '"' && text[-1] == ' ')
            return text + length + 2;
    return NULL;
}

/* Read an attribute that counts points or cells. A count above the number of
 * bytes of the text is refused before anything is allocated for it. */
static ritz_status read_count(const char *element, const char *name,
                              const char *text, int64_t *out)
{
    const char *value = find_attribute(element, name);
    char *end = NULL;

    errno = 0;
    *out = value ? strtoll(value, &end, 10) : -1;
    RITZ_REFUSE_IF(*out < 0 || errno != 0 || *end != '"' ||
                       *out > (int64_t)strlen(text),
                   RITZ_ERR_FORMAT, "'%s' is no number of a frame", name);
    return RITZ_OK;
}

/* The text of the numbers of a DataArray; NULL if there is none of that
   name. */
static const char *find_array(const char *text, const char *name)
{
    const size_t length = strlen(name);

    while ((text = strstr(text, "<DataArray "))) {
        const char *value = find_attribute(text + 1, "Name");
        const char *open = strchr(text, '>');

        if (value && open && strncmp(value, name, length) == 0 &&
            value[length] == '"')
            return open + 1;
        text++;
    }
    return NULL;
}

static ritz_status read_reals(const char *at, const char *name, int64_t count,
                              bool nan_too, double *out)
{
    RITZ_REFUSE_IF(!at, RITZ_ERR_FORMAT, "there is no array '%s'", name);
    for (int64_t k = 0; k < count; k++) {
        char *end = NULL;

        out[k] = strtod(at, &end);
        RITZ_REFUSE_IF(end == at ||
                           !(isfinite(out[k]) || (nan_too && isnan(out[k]))),
                       RITZ_ERR_FORMAT,
                       "'%s' has not %" PRId64 " numbers as text", name, count);
        at = end;
    }
    at += strspn(at, " \t\r\n");
    RITZ_REFUSE_IF(*at != '<', RITZ_ERR_FORMAT,
                   "'%s' has more than %" PRId64 " numbers", name, count);
    return RITZ_OK;
}

static ritz_status read_wholes(const char *text, const char *name,
                               int64_t count, int64_t most, int64_t *out)
{
    const char *at = find_array(text, name);

    RITZ_REFUSE_IF(!at, RITZ_ERR_FORMAT, "there is no array '%s'", name);
    for (int64_t k = 0; k < count; k++) {
        char *end = NULL;

        errno = 0;
        out[k] = strtoll(at, &end, 10);
        RITZ_REFUSE_IF(end == at || errno != 0 || out[k] < 0 || out[k] > most,
                       RITZ_ERR_FORMAT,
                       "'%s' has not %" PRId64 " numbers up to %" PRId64, name,
                       count, most);
        at = end;
    }
    return RITZ_OK;
}

/* ---- a frame ------------------------------------------------------------ */

static ritz_status read_cells(const char *text, ritz_shapes *out)
{
    ritz_elements *cells = &out->cells;
    const int64_t n = cells->count, most = (int64_t)strlen(text);

    RITZ_CHECK_NEW(cells->kind, n);
    RITZ_CHECK_NEW(cells->first, n + 1);
    RITZ_CHECK(read_wholes(text, "offsets", n, most, cells->first + 1));
    RITZ_CHECK(read_wholes(text, "types", n, INT32_MAX, cells->kind));
    for (int64_t k = 0; k < n; k++)
        RITZ_REFUSE_IF(cells->first[k + 1] - cells->first[k] !=
                           ritz_cell_shape_of(cells->kind[k])->size,
                       RITZ_ERR_FORMAT,
                       "cell %" PRId64 " has not the points of its type",
                       k + 1);
    RITZ_CHECK_NEW(cells->grid, cells->first[n]);
    return read_wholes(text, "connectivity", cells->first[n],
                       out->num_points - 1, cells->grid);
}

/* Read the first array in <CellData>, if there is one. */
static ritz_status read_field(const char *text, ritz_shapes *out)
{
    const char *from = strstr(text, "<CellData>");
    const char *element = from ? strstr(from, "<DataArray ") : NULL;
    const char *name = element ? find_attribute(element + 1, "Name") : NULL;
    const char *open = name ? strchr(name, '>') : NULL;
    int length = 0;

    if (!open)
        return RITZ_OK;
    RITZ_CHECK_NEW(out->field, 1);
    RITZ_CHECK_NEW(out->of_cell, out->cells.count);
    while (length < RITZ_FIELD_NAME_SIZE - 1 && name[length] != '"')
        length++;
    snprintf(out->field[0], RITZ_FIELD_NAME_SIZE, "%.*s", length, name);
    out->num_fields = 1;
    return read_reals(open + 1, out->field[0], out->cells.count, true,
                      out->of_cell);
}

ritz_status ritz_frame_parse(const char *text, ritz_shapes *out)
{
    RITZ_OWN(ritz_shapes) frame = {.count = 1};
    const char *piece = strstr(text, "<Piece ");
    int64_t n = 0;

    RITZ_REFUSE_IF(!piece, RITZ_ERR_FORMAT,
                   "is no unstructured grid of VTK as text");
    RITZ_CHECK(read_count(piece, "NumberOfPoints", text, &frame.num_points));
    RITZ_CHECK(read_count(piece, "NumberOfCells", text, &frame.cells.count));
    n = 3 * frame.num_points;
    RITZ_REFUSE_IF(n == 0, RITZ_ERR_FORMAT, "holds no points");
    RITZ_CHECK_NEW(frame.position, n);
    RITZ_CHECK(ritz_dense_new(n, 1, &frame.u));
    RITZ_CHECK(read_reals(find_array(text, "Points"), "Points", n, false,
                          frame.position));
    RITZ_CHECK(read_reals(find_array(text, "displacement"), "displacement", n,
                          false, frame.u.val));
    RITZ_CHECK(read_cells(text, &frame));
    RITZ_CHECK(read_field(text, &frame));
    RITZ_MOVE(*out, frame);
    return RITZ_OK;
}

ritz_status ritz_frame_read(const char *path, ritz_shapes *out)
{
    RITZ_OWN_ARRAY char *text = NULL;

    RITZ_CHECK(ritz_text_read(path, &text));
    return ritz_context(ritz_frame_parse(text, out), path);
}

/* ---- a collection ------------------------------------------------------- */

bool ritz_collection_recognise(const char *text)
{
    const char *root = strstr(text, "<VTKFile ");

    return root && find_attribute(root + 1, "type") &&
           strncmp(find_attribute(root + 1, "type"), "Collection\"", 11) == 0;
}

ritz_status ritz_collection_next(const char **text, double *seconds,
                                 char name[RITZ_COLLECTION_NAME], bool *more)
{
    const char *element = strstr(*text, "<DataSet ");
    const char *time = element ? find_attribute(element + 1, "timestep") : NULL;
    const char *file = element ? find_attribute(element + 1, "file") : NULL;
    size_t length = file ? strcspn(file, "\"") : 0;

    *more = element;
    if (!element)
        return RITZ_OK;
    *text = element + 1;
    RITZ_REFUSE_IF(
        !time || !file || length == 0 || length >= RITZ_COLLECTION_NAME ||
            file[0] == '/' ||
            (strstr(file, "..") && strstr(file, "..") < file + length) ||
            memchr(file, '&', length),
        RITZ_ERR_FORMAT,
        "a data set without a time, or without a file beside the "
        "list");
    *seconds = strtod(time, NULL);
    RITZ_REFUSE_IF(!isfinite(*seconds), RITZ_ERR_FORMAT,
                   "a time is not finite");
    memcpy(name, file, length);
    name[length] = '\0';
    return RITZ_OK;
}
