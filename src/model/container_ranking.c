/* Containers of rankings. */
#include "model/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

static const ritz_text_member members[] = {
    {"by", offsetof(ritz_ranking, by)},
    {"reference", offsetof(ritz_ranking, reference)},
    {NULL, 0},
};

/* Each mode has one place. */
static ritz_status check_order(const ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    bool *placed = NULL;

    RITZ_NEW(placed, ranking->count);
    for (int64_t k = 0; k < ranking->count; k++) {
        int64_t mode = ranking->order[k];

        RITZ_FAIL_IF(placed[mode], RITZ_ERR_FORMAT,
                     "mode %" PRId64 " is in 'order' twice", mode);
        placed[mode] = true;
    }
done:
    free(placed);
    return status;
}

/* Modes that are coupled, if any pair was found. */
static ritz_status read_coupling(hid_t file, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;

    RITZ_TRY(ritz_part_get_real(file, "coupling", true, 1, &ranking->coupling));
    RITZ_TRY(ritz_h5_get(file, "coupled", H5T_STD_I64LE, 2, ranking->coupled));
    for (int k = 0; k < 2; k++)
        RITZ_FAIL_IF(!isnan(ranking->coupling) && ranking->coupling > 0.0 &&
                         (ranking->coupled[k] < 0 ||
                          ranking->coupled[k] >= ranking->count),
                     RITZ_ERR_FORMAT, "'coupled' is not a pair of modes");
done:
    return status;
}

static ritz_status read_all(hid_t file, ritz_ranking *ranking)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape modes;
    int64_t m = 0;

    RITZ_TRY(ritz_part_get_members(file, members, ranking));
    RITZ_TRY(ritz_h5_count(file, "hertz", &m));
    ranking->count = m;
    modes = ritz_h5_vector(m);
    RITZ_NEW(ranking->hertz, m);
    RITZ_NEW(ranking->zeta, m);
    RITZ_NEW(ranking->value, m);
    RITZ_NEW(ranking->order, m);
    RITZ_TRY(ritz_h5_read_real(file, "hertz", modes, false, ranking->hertz));
    RITZ_TRY(ritz_h5_read_real(file, "zeta", modes, false, ranking->zeta));
    RITZ_TRY(ritz_h5_read_real(file, "value", modes, false, ranking->value));
    RITZ_TRY(ritz_part_read_whole(file, "order", m, 0, m - 1, ranking->order));
    RITZ_TRY(check_order(ranking));
    RITZ_TRY(ritz_h5_count(file, "system_value", &ranking->num_system));
    RITZ_NEW(ranking->system_value, ranking->num_system);
    RITZ_TRY(ritz_h5_read_real(file, "system_value",
                               ritz_h5_vector(ranking->num_system), false,
                               ranking->system_value));
    RITZ_TRY(read_coupling(file, ranking));
done:
    return status;
}

ritz_status ritz_container_read_ranking(const char *path, ritz_ranking *out)
{
    ritz_status status = RITZ_OK;
    ritz_ranking ranking = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "ranking", &file));
    RITZ_TRY(read_all(file, &ranking));
    *out = ranking;
    ranking = (ritz_ranking){0};
done:
    ritz_ranking_free(&ranking);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

ritz_status ritz_container_write_ranking(const char *path,
                                         const ritz_ranking *ranking,
                                         const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};
    ritz_h5_shape modes = ritz_h5_vector(ranking->count);
    hid_t file = 0;

    RITZ_TRY(ritz_writer_new(path, "ranking", "", stamp, &writer));
    file = writer.file;
    RITZ_TRY(ritz_part_set_members(file, members, ranking));
    RITZ_TRY(ritz_part_set_real(file, "coupling", 1, &ranking->coupling));
    RITZ_TRY(ritz_h5_set(file, "coupled", H5T_STD_I64LE, ritz_h5_vector(2),
                         ranking->coupled));
    RITZ_TRY(
        ritz_h5_write(file, "hertz", H5T_IEEE_F64LE, modes, ranking->hertz));
    RITZ_TRY(ritz_h5_write(file, "zeta", H5T_IEEE_F64LE, modes, ranking->zeta));
    RITZ_TRY(
        ritz_h5_write(file, "value", H5T_IEEE_F64LE, modes, ranking->value));
    RITZ_TRY(
        ritz_h5_write(file, "order", H5T_STD_I64LE, modes, ranking->order));
    RITZ_TRY(ritz_h5_write(file, "system_value", H5T_IEEE_F64LE,
                           ritz_h5_vector(ranking->num_system),
                           ranking->system_value));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
