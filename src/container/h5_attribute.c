/* Attributes, and texts of any length. */
#include "container/h5.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_h5_set(hid_t at, const char *name, hid_t type,
                        ritz_h5_shape shape, const void *values)
{
    ritz_status status = RITZ_OK;
    hid_t memory = H5Tget_native_type(type, H5T_DIR_ASCEND);
    hid_t space = H5Screate_simple(shape.rank, shape.dims, NULL);
    hid_t attribute =
        H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT);

    RITZ_FAIL_IF(attribute < 0 || H5Awrite(attribute, memory, values) < 0,
                 RITZ_ERR_FILE, "cannot write attribute '%s'", name);
done:
    ritz_h5_close(attribute);
    ritz_h5_close(space);
    ritz_h5_close(memory);
    return status;
}

ritz_status ritz_h5_get(hid_t at, const char *name, hid_t type, int64_t count,
                        void *values)
{
    ritz_status status = RITZ_OK;
    hid_t memory = 0;
    hid_t attribute = H5Aopen(at, name, H5P_DEFAULT);
    hid_t space = attribute < 0 ? -1 : H5Aget_space(attribute);
    hid_t on_file = attribute < 0 ? -1 : H5Aget_type(attribute);

    RITZ_FAIL_IF(space < 0 || on_file < 0, RITZ_ERR_FORMAT, "no attribute '%s'",
                 name);
    RITZ_FAIL_IF(H5Sget_simple_extent_npoints(space) != count, RITZ_ERR_FORMAT,
                 "attribute '%s' is not of %" PRId64 " values", name, count);
    RITZ_TRY(ritz_h5_match(name, on_file, type, &memory));
    RITZ_FAIL_IF(H5Aread(attribute, memory, values) < 0, RITZ_ERR_FORMAT,
                 "cannot read attribute '%s'", name);
done:
    ritz_h5_close(memory);
    ritz_h5_close(on_file);
    ritz_h5_close(space);
    ritz_h5_close(attribute);
    return status;
}

ritz_status ritz_h5_set_text(hid_t at, const char *name, const char *text)
{
    hid_t type = ritz_h5_string(strlen(text) + 1);
    ritz_status status = ritz_h5_set(at, name, type, ritz_h5_scalar(), text);

    ritz_h5_close(type);
    return status;
}

ritz_status ritz_h5_get_text(hid_t at, const char *name, size_t size, char *out)
{
    hid_t type = ritz_h5_string(size);
    ritz_status status = ritz_h5_get(at, name, type, 1, out);

    ritz_h5_close(type);
    return status;
}

/* A data set of the plain name would meet other members: "long_inputs". */
typedef char long_name[RITZ_NAME_SIZE];

static const char *name_long(const char *name, long_name out)
{
    snprintf(out, sizeof(long_name), "long_%s", name);
    return out;
}

ritz_status ritz_h5_set_texts(hid_t at, const char *name, int64_t count,
                              char *const *text)
{
    ritz_status status = RITZ_OK;
    hid_t type = 0;
    long_name other;
    char *block = NULL; /* all of them, each padded to the longest */
    int64_t size = 1;

    for (int64_t k = 0; k < count; k++)
        if ((int64_t)strlen(text[k]) >= size)
            size = (int64_t)strlen(text[k]) + 1;
    RITZ_NEW(block, count * size);
    for (int64_t k = 0; k < count; k++)
        memcpy(block + k * size, text[k], strlen(text[k]));
    type = ritz_h5_string((size_t)size);
    if (count * size < RITZ_H5_LONG)
        RITZ_TRY(ritz_h5_set(at, name, type, ritz_h5_vector(count), block));
    else
        RITZ_TRY(ritz_h5_write(at, name_long(name, other), type,
                               ritz_h5_vector(count), block));
done:
    free(block);
    ritz_h5_close(type);
    return status;
}

/* Number of texts and room that each takes, wherever they are. */
static ritz_status measure_texts(hid_t at, const char *name, int64_t *count,
                                 size_t *size)
{
    ritz_status status = RITZ_OK;
    bool short_ones = H5Aexists(at, name) > 0;
    hid_t place = 0;
    hid_t space = 0;
    hid_t type = 0;
    hid_t file = 0;
    hsize_t present = 0;
    ritz_h5_shape shape = {0};
    long_name other;

    if (short_ones)
        place = H5Aopen(at, name, H5P_DEFAULT);
    else
        RITZ_TRY(
            ritz_h5_open_set(at, name_long(name, other), 1, &shape, &place));
    space = short_ones ? H5Aget_space(place) : H5Dget_space(place);
    type = short_ones ? H5Aget_type(place) : H5Dget_type(place);
    file = H5Iget_file_id(at);
    H5Fget_filesize(file, &present);
    RITZ_FAIL_IF(H5Tget_class(type) != H5T_STRING ||
                     H5Tis_variable_str(type) != 0,
                 RITZ_ERR_FORMAT, "'%s' is not text of fixed length", name);
    *count = H5Sget_simple_extent_npoints(space);
    *size = H5Tget_size(type);
    RITZ_FAIL_IF(*count < 0 || *size < 1 || *size > present ||
                     (hsize_t)*count > present / *size,
                 RITZ_ERR_FORMAT, "'%s' declares more than the file holds",
                 name);
done:
    ritz_h5_close(file);
    ritz_h5_close(type);
    ritz_h5_close(space);
    ritz_h5_close(place);
    return status;
}

/* Cut a block of padded texts into texts of their own. */
static ritz_status cut(const char *block, size_t size, int64_t count,
                       char ***out)
{
    ritz_status status = RITZ_OK;
    char **text = NULL;

    RITZ_NEW(text, count);
    for (int64_t k = 0; k < count; k++) {
        const char *from = block + (size_t)k * size;
        size_t length = strnlen(from, size);

        RITZ_NEW(text[k], (int64_t)length + 1);
        memcpy(text[k], from, length);
    }
    *out = text;
    text = NULL;
done:
    ritz_h5_free_texts(count, text);
    return status;
}

ritz_status ritz_h5_get_texts(hid_t at, const char *name, int64_t *count,
                              char ***out)
{
    ritz_status status = RITZ_OK;
    char *block = NULL;
    size_t size = 0;
    hid_t type = 0;
    long_name other;

    RITZ_TRY(measure_texts(at, name, count, &size));
    RITZ_NEW(block, *count * (int64_t)size);
    type = ritz_h5_string(size);
    if (H5Aexists(at, name) > 0)
        RITZ_TRY(ritz_h5_get(at, name, type, *count, block));
    else
        RITZ_TRY(ritz_h5_read(at, name_long(name, other), type,
                              ritz_h5_vector(*count), block));
    RITZ_TRY(cut(block, size, *count, out));
done:
    free(block);
    ritz_h5_close(type);
    return status;
}

void ritz_h5_free_texts(int64_t count, char **text)
{
    for (int64_t k = 0; k < count && text; k++)
        free(text[k]);
    free(text);
}
