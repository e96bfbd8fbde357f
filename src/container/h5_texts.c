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
    RITZ_OWN(hid_t) type = 0;
    RITZ_OWN_ARRAY char *block = NULL; /* of texts padded to the longest */
    long_name other;
    int64_t size = 1;

    for (int64_t k = 0; k < count; k++)
        if ((int64_t)strlen(text[k]) >= size)
            size = (int64_t)strlen(text[k]) + 1;
    RITZ_CHECK_NEW(block, count * size);
    for (int64_t k = 0; k < count; k++)
        memcpy(block + k * size, text[k], strlen(text[k]));
    type = ritz_h5_string((size_t)size);
    if (count * size < RITZ_H5_LONG)
        return ritz_h5_set(at, name, type, ritz_h5_vector(count), block);
    return ritz_h5_write(at, name_long(name, other), type,
                         ritz_h5_vector(count), block);
}

/* Number of texts and bytes of each, in an attribute or a data set. */
static ritz_status measure_texts(hid_t at, const char *name, int64_t *count,
                                 size_t *size)
{
    bool short_ones = H5Aexists(at, name) > 0;
    RITZ_OWN(hid_t) texts = 0, space = 0, type = 0, file = 0;
    hsize_t present = 0;
    ritz_h5_shape shape = {0};
    long_name other;

    if (short_ones)
        texts = H5Aopen(at, name, H5P_DEFAULT);
    else
        RITZ_CHECK(
            ritz_h5_open_set(at, name_long(name, other), 1, &shape, &texts));
    space = short_ones ? H5Aget_space(texts) : H5Dget_space(texts);
    type = short_ones ? H5Aget_type(texts) : H5Dget_type(texts);
    file = H5Iget_file_id(at);
    H5Fget_filesize(file, &present);
    RITZ_REFUSE_IF(H5Tget_class(type) != H5T_STRING ||
                       H5Tis_variable_str(type) != 0,
                   RITZ_ERR_FORMAT, "'%s' is not text of fixed length", name);
    *count = H5Sget_simple_extent_npoints(space);
    *size = H5Tget_size(type);
    RITZ_REFUSE_IF(*count < 0 || *size < 1 || *size > present ||
                       (hsize_t)*count > present / *size,
                   RITZ_ERR_FORMAT, "'%s' declares more than the file holds",
                   name);
    return RITZ_OK;
}

/* Copy each of the padded texts of a block. */
static ritz_status cut_texts(const char *block, size_t size, int64_t count,
                             ritz_texts *out)
{
    RITZ_OWN(ritz_texts) texts = {.count = count};

    RITZ_CHECK_NEW(texts.text, count);
    for (int64_t k = 0; k < count; k++) {
        const char *from = block + (size_t)k * size;
        size_t length = strnlen(from, size);

        RITZ_CHECK_NEW(texts.text[k], (int64_t)length + 1);
        memcpy(texts.text[k], from, length);
    }
    RITZ_MOVE(*out, texts);
    return RITZ_OK;
}

ritz_status ritz_h5_get_texts(hid_t at, const char *name, ritz_texts *out)
{
    RITZ_OWN_ARRAY char *block = NULL;
    RITZ_OWN(hid_t) type = 0;
    int64_t count = 0;
    size_t size = 0;
    long_name other;

    RITZ_CHECK(measure_texts(at, name, &count, &size));
    RITZ_CHECK_NEW(block, count * (int64_t)size);
    type = ritz_h5_string(size);
    if (H5Aexists(at, name) > 0)
        RITZ_CHECK(ritz_h5_get(at, name, type, count, block));
    else
        RITZ_CHECK(ritz_h5_read(at, name_long(name, other), type,
                                ritz_h5_vector(count), block));
    return cut_texts(block, size, count, out);
}

void ritz_texts_free(ritz_texts *texts)
{
    for (int64_t k = 0; k < texts->count && texts->text; k++)
        free(texts->text[k]);
    free(texts->text);
    *texts = (ritz_texts){0};
}
