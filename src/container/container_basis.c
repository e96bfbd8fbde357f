/* Containers of bases. */
#include "base/alloc.h"
#include "container/container_parts.h"

/* A basis of states says so by its attribute `states`. */
static ritz_status write_states(hid_t file, const ritz_basis *basis)
{
    RITZ_CHECK(ritz_part_write_dense(file, "W", &basis->W));
    if (basis->num_hankel > 0) {
        RITZ_CHECK(ritz_h5_write(file, "hankel", H5T_IEEE_F64LE,
                                 ritz_h5_vector(basis->num_hankel),
                                 basis->hankel));
        RITZ_CHECK(ritz_part_set_real(file, "bound", 1, &basis->bound));
    }
    if (basis->states)
        RITZ_CHECK(ritz_part_set_whole(file, "states", 1));
    if (!basis->states && !basis->W.val)
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_set_text(file, "damping", basis->damping));
    if (basis->among_hz > 0.0)
        RITZ_CHECK(ritz_part_set_real(file, "among_hz", 1, &basis->among_hz));
    return RITZ_OK;
}

static ritz_status read_hankel(hid_t file, ritz_basis *basis)
{
    if (!ritz_h5_has(file, "hankel"))
        return RITZ_OK;
    RITZ_CHECK(ritz_h5_count(file, "hankel", &basis->num_hankel));
    RITZ_CHECK_NEW(basis->hankel, basis->num_hankel);
    RITZ_CHECK(ritz_h5_read_real(file, "hankel",
                                 ritz_h5_vector(basis->num_hankel), false,
                                 basis->hankel));
    for (int64_t k = 0; k < basis->num_hankel; k++)
        RITZ_REFUSE_IF(basis->hankel[k] < 0.0 ||
                           (k > 0 && basis->hankel[k] > basis->hankel[k - 1]),
                       RITZ_ERR_FORMAT, "'hankel' does not descend to zero");
    RITZ_CHECK(ritz_part_get_real(file, "bound", true, 1, &basis->bound));
    RITZ_REFUSE_IF(basis->bound < 0.0, RITZ_ERR_FORMAT,
                   "'bound' is %g, which bounds no error", basis->bound);
    return RITZ_OK;
}

static ritz_status read_states(hid_t file, ritz_basis *basis)
{
    const ritz_dense *T = &basis->T;
    int64_t one = 0;

    RITZ_CHECK(ritz_part_read_dense(file, "W", T->nrow, T->ncol, &basis->W));
    RITZ_CHECK(read_hankel(file, basis));
    basis->states = H5Aexists(file, "states") > 0;
    if (basis->states)
        RITZ_CHECK(ritz_part_get_size(file, "states", 1, 1, &one));
    if (basis->states || basis->W.val)
        RITZ_CHECK(ritz_h5_get_text(file, "damping", sizeof basis->damping,
                                    basis->damping));
    if (H5Aexists(file, "among_hz") > 0)
        RITZ_CHECK(
            ritz_part_get_real(file, "among_hz", false, 1, &basis->among_hz));
    return RITZ_OK;
}

ritz_status ritz_container_read_basis(const char *path, ritz_basis *out)
{
    ritz_status status = RITZ_OK;
    ritz_basis basis = {0};
    hid_t file = 0;

    RITZ_TRY(ritz_part_open(path, "basis", &file));
    RITZ_TRY(ritz_part_get_origin(file, &basis.origin));
    RITZ_TRY(ritz_h5_read_dense(file, "T", -1, -1, &basis.T));
    RITZ_TRY(read_states(file, &basis));
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
    RITZ_TRY(write_states(writer.file, basis));
    RITZ_TRY(ritz_part_write_columns(writer.file, &basis->columns));
    RITZ_TRY(ritz_writer_finish(&writer));
done:
    ritz_writer_free(&writer);
    return ritz_context(status, path);
}
