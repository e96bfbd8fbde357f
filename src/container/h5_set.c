/* Data sets: how they are cut into chunks, and what is believed of them. */
#include "container/h5.h"

enum {
    SMALL = 64,         /* values that lie in the object header */
    SMALL_BYTES = 8192, /* and bytes */
    CHUNK = 65536,      /* values, half of HDF5's chunk cache */
    CHUNK_BYTES = 524288,
    ACROSS = 16,           /* columns in a chunk of a tall matrix */
    FEW_CHUNKS = 1024,     /* that any data set may have */
    SMALLEST_CHUNK = 4096, /* values, on the average of more */
};

ritz_h5_shape ritz_h5_scalar(void)
{
    return (ritz_h5_shape){0, {1}};
}

ritz_h5_shape ritz_h5_vector(int64_t n)
{
    return (ritz_h5_shape){1, {(hsize_t)n}};
}

ritz_h5_shape ritz_h5_table(int64_t n, int64_t m)
{
    return (ritz_h5_shape){2, {(hsize_t)n, (hsize_t)m}};
}

ritz_h5_shape ritz_h5_stack(int64_t n, int64_t m, int64_t k)
{
    return (ritz_h5_shape){3, {(hsize_t)n, (hsize_t)m, (hsize_t)k}};
}

static hsize_t least(hsize_t a, hsize_t b)
{
    return a < b ? a : b;
}

/* n cut into the fewest pieces of at most `most`, about equal: their size. */
static hsize_t piece(hsize_t n, hsize_t most)
{
    hsize_t pieces = (n + most - 1) / most;

    return (n + pieces - 1) / pieces;
}

/*
 * Chunks of up to `most` values. Of a tall matrix they are 16 columns wide, so
 * that neither a row nor a column takes in much beside what is asked for; of a
 * wide one as many columns as fit. Further dimensions are not cut.
 */
static ritz_h5_shape cut(const ritz_h5_shape *shape, hsize_t most)
{
    ritz_h5_shape chunk = *shape;
    hsize_t across = shape->rank == 2 ? least(shape->dims[1], ACROSS) : 1;

    if (shape->rank == 3)
        across = shape->dims[1] * shape->dims[2];
    chunk.dims[0] = piece(shape->dims[0], most > across ? most / across : 1);
    if (shape->rank == 2) {
        most = most > chunk.dims[0] ? most / chunk.dims[0] : 1;
        chunk.dims[1] = piece(shape->dims[1], most);
    }
    return chunk;
}

hsize_t ritz_h5_volume(const ritz_h5_shape *shape, hsize_t most)
{
    hsize_t count = 1;

    for (int k = 0; k < shape->rank; k++)
        if (shape->dims[k] == 0)
            return 0;
    for (int k = 0; k < shape->rank; k++) {
        if (shape->dims[k] > most / count)
            return most + 1;
        count *= shape->dims[k];
    }
    return count;
}

ritz_status ritz_h5_create_set(hid_t at, const char *name, hid_t type,
                               ritz_h5_shape shape, ritz_h5_shape *chunk,
                               hid_t *out)
{
    ritz_status status = RITZ_OK;
    hsize_t size = H5Tget_size(type);
    hsize_t count = ritz_h5_volume(&shape, INT64_MAX);
    hid_t space = H5Screate_simple(shape.rank, shape.dims, NULL);
    hid_t plan = H5Pcreate(H5P_DATASET_CREATE);

    H5Pset_obj_track_times(plan, false);
    *chunk = shape;
    if (count <= SMALL && count * size <= SMALL_BYTES) {
        H5Pset_layout(plan, H5D_COMPACT);
    } else {
        *chunk = cut(&shape, least(CHUNK, CHUNK_BYTES / size + 1));
        H5Pset_chunk(plan, shape.rank, chunk->dims);
        H5Pset_fletcher32(plan);
    }
    *out = H5Dcreate2(at, name, type, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    RITZ_FAIL_IF(*out < 0, RITZ_ERR_FILE, "cannot create '%s'", name);
done:
    ritz_h5_close(plan);
    ritz_h5_close(space);
    return status;
}

/* Go on to the next chunk, the last dimension first; false after the last. */
static bool advance(const ritz_h5_shape *shape, const ritz_h5_shape *chunk,
                    hsize_t at[RITZ_H5_RANK])
{
    for (int k = shape->rank - 1; k >= 0; k--) {
        at[k] += chunk->dims[k];
        if (at[k] < shape->dims[k])
            return true;
        at[k] = 0;
    }
    return false;
}

/*
 * Each chunk is there, with its checksum. The index of chunks has none, and one
 * that is lost from it would read as zeros. HDF5 1.10 finds each by looking
 * through all, hence there must not be too many.
 */
static bool is_whole(hid_t set, const ritz_h5_shape *shape,
                     const ritz_h5_shape *chunk)
{
    hsize_t count = ritz_h5_volume(shape, INT64_MAX);
    hsize_t chunks = 1;
    hsize_t at[RITZ_H5_RANK] = {0};
    bool whole = true;

    for (int k = 0; k < shape->rank; k++)
        chunks *= (shape->dims[k] + chunk->dims[k] - 1) / chunk->dims[k];
    whole = chunks <= FEW_CHUNKS + count / SMALLEST_CHUNK;
    while (whole) {
        unsigned skipped = 0;
        haddr_t place = HADDR_UNDEF;
        hsize_t size = 0;

        H5Dget_chunk_info_by_coord(set, at, &skipped, &place, &size);
        whole = place != HADDR_UNDEF && skipped == 0;
        if (!advance(shape, chunk, at))
            break;
    }
    return whole;
}

/* No filter but the checksum: neither compression nor anybody's plug-in. */
static bool is_plain(hid_t plan)
{
    bool plain = true;

    for (int k = 0; k < H5Pget_nfilters(plan); k++) {
        size_t none = 0;
        unsigned flags = 0;

        plain = plain && H5Pget_filter2(plan, (unsigned)k, &flags, &none, NULL,
                                        0, NULL, NULL) == H5Z_FILTER_FLETCHER32;
    }
    return plain && H5Pget_external_count(plan) <= 0;
}

/* Neither a data set nor its chunks declare more than lies in the file. */
static bool borne_out(hid_t set, hid_t plan, const ritz_h5_shape *shape)
{
    hid_t type = H5Dget_type(set);
    hid_t file = H5Iget_file_id(set);
    hsize_t stored = H5Dget_storage_size(set);
    hsize_t size = H5Tget_size(type);
    hsize_t present = 0;
    H5D_layout_t layout = H5Pget_layout(plan);
    ritz_h5_shape chunk = *shape;
    bool held = false;

    H5Fget_filesize(file, &present);
    ritz_h5_close(file);
    ritz_h5_close(type);
    if (ritz_h5_volume(shape, 1) == 0)
        return true;
    held = size > 0 && stored <= present &&
           ritz_h5_volume(shape, stored / size) <= stored / size;
    if (layout != H5D_CHUNKED)
        return held && (layout == H5D_COMPACT || layout == H5D_CONTIGUOUS);
    return held && H5Pget_chunk(plan, shape->rank, chunk.dims) == shape->rank &&
           ritz_h5_volume(&chunk, 1) > 0 &&
           ritz_h5_volume(&chunk, stored / size) <= stored / size &&
           is_whole(set, shape, &chunk);
}

ritz_status ritz_h5_open_set(hid_t at, const char *name, int rank,
                             ritz_h5_shape *shape, hid_t *out)
{
    ritz_status status = RITZ_OK;
    hid_t set = ritz_h5_has(at, name) ? H5Dopen2(at, name, H5P_DEFAULT) : -1;
    hid_t space = set < 0 ? -1 : H5Dget_space(set);
    hid_t plan = set < 0 ? -1 : H5Dget_create_plist(set);

    RITZ_FAIL_IF(space < 0 || plan < 0 ||
                     H5Sget_simple_extent_ndims(space) != rank,
                 RITZ_ERR_FORMAT, "no data set '%s' of %d dimension%s", name,
                 rank, rank == 1 ? "" : "s");
    shape->rank = rank;
    H5Sget_simple_extent_dims(space, shape->dims, NULL);
    RITZ_FAIL_IF(!is_plain(plan), RITZ_ERR_FORMAT,
                 "'%s' is compressed, or lies in another file", name);
    RITZ_FAIL_IF(!borne_out(set, plan, shape), RITZ_ERR_FORMAT,
                 "'%s' declares more values than the file holds", name);
    *out = set;
    set = 0;
done:
    ritz_h5_close(plan);
    ritz_h5_close(space);
    ritz_h5_close(set);
    return status;
}

ritz_h5_shape ritz_h5_pieces(hid_t set, const ritz_h5_shape *shape)
{
    hid_t plan = H5Dget_create_plist(set);
    ritz_h5_shape chunk = *shape;

    if (H5Pget_layout(plan) == H5D_CHUNKED)
        H5Pget_chunk(plan, shape->rank, chunk.dims);
    else if (ritz_h5_volume(shape, CHUNK) > CHUNK)
        chunk.dims[0] = /* whole rows, which lie side by side */
            piece(shape->dims[0],
                  shape->dims[1] < CHUNK ? CHUNK / shape->dims[1] : 1);
    for (int k = 0; k < shape->rank; k++)
        chunk.dims[k] = least(chunk.dims[k], shape->dims[k]);
    ritz_h5_close(plan);
    return chunk;
}

ritz_status ritz_h5_shape_of(hid_t at, const char *name, int rank,
                             ritz_h5_shape *out)
{
    hid_t set = 0;
    ritz_status status = ritz_h5_open_set(at, name, rank, out, &set);

    ritz_h5_close(set);
    return status;
}

ritz_status ritz_h5_count(hid_t at, const char *name, int64_t *out)
{
    ritz_h5_shape shape = {0};
    ritz_status status = ritz_h5_shape_of(at, name, 1, &shape);

    if (status == RITZ_OK)
        *out = (int64_t)shape.dims[0];
    return status;
}
