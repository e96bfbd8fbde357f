/* Containers of bases. */
#include "model/container_parts.h"

ritz_status ritz_container_read_basis(const char *path, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    ritz_basis basis = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "basis", &file));
    RITZ_TRY(ritz_part_get_origin(file, &basis.origin));
    RITZ_TRY(ritz_h5_read_dense(file, "T", -1, -1, &basis.T));
    RITZ_TRY(ritz_part_read_columns(file, basis.T.nrow, basis.T.ncol,
                                    &basis.columns));
    *out = basis;
    basis = (ritz_basis){0};
done:
    ritz_basis_free(&basis);
    ritz_h5_close(file);
    return ritz_context(status, path);
}

ritz_status ritz_container_write_basis(const char *path,
                                       const ritz_basis *basis,
                                       const char *units,
                                       const ritz_stamp *stamp)
{
    ritz_status status = RITZ_OK;
    ritz_writer writer = {0};

    RITZ_TRY(ritz_writer_new(path, "basis", units, stamp, &writer));
    RITZ_TRY(ritz_part_set_origin(writer.file, &basis->origin));
    RITZ_TRY(ritz_h5_write_dense(writer.file, "T", &basis->T));
    RITZ_TRY(ritz_part_write_columns(writer.file, &basis->columns));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
