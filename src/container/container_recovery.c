/* Group `recovery`: dofs that constraints eliminated, and what they follow. */
#include "container/container_parts.h"

ritz_status ritz_part_write_recovery(hid_t at, const ritz_recovery *recovery)
{
    ritz_status status = RITZ_OK;
    hid_t group = 0;

    if (recovery->count == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(at, "recovery", &group));
    RITZ_TRY(ritz_part_write_labels(group, recovery->count, recovery->dof));
    RITZ_TRY(ritz_h5_write_sparse(group, "G", &recovery->G));
done:
    ritz_h5_close(group);
    return ritz_context(status, "recovery");
}

ritz_status ritz_part_read_recovery(hid_t at, int64_t n, const ritz_dof *dof,
                                    ritz_recovery *out)
{
    ritz_status status = RITZ_OK;
    ritz_recovery recovery = {0};
    hid_t group = 0;

    if (!ritz_h5_has(at, "recovery"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, "recovery", &group));
    RITZ_TRY(ritz_part_read_labels(group, &recovery.count, &recovery.dof));
    RITZ_FAIL_IF(recovery.count == 0, RITZ_ERR_FORMAT, "it names no dofs");
    RITZ_TRY(ritz_h5_read_sparse(group, "G", &recovery.G));
    RITZ_TRY(ritz_recovery_check(&recovery, n, dof));
    *out = recovery;
    recovery = (ritz_recovery){0};
done:
    ritz_recovery_free(&recovery);
    ritz_h5_close(group);
    return ritz_context(status, "recovery");
}
