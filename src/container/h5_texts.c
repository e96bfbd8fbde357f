/* Lists of texts of any length, as attributes or, where they are long, sets. */
#include "container/h5.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A data set `inputs` would clash with the group, hence "long_inputs". */
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

/* Number of texts and bytes of each, in an attribute or a data set. */
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

/* Copy each padded text of a block into a string of its own. */
static ritz_status cut_texts(const char *block, size_t size, int64_t count,
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
    RITZ_MOVE(*out, text);
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
    RITZ_TRY(cut_texts(block, size, *count, out));
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
