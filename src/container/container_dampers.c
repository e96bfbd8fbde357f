/* Group `dampers`: names, numbers, and influence vectors as columns of B. */
#include "container/container_parts.h"

#include "base/alloc.h"

/* The numbers of each damper, by where they lie in ritz_dampers. */
static const struct {
    const char *name;
    size_t offset; /* of a double * */
} numbers[] = {
    {"c", offsetof(ritz_dampers, c)},
    {"k", offsetof(ritz_dampers, k)},
    {"held_c", offsetof(ritz_dampers, held_c)},
    {"held_k", offsetof(ritz_dampers, held_k)},
};

enum { NUM_NUMBERS = sizeof numbers / sizeof *numbers };

static double *numbers_of(const ritz_dampers *dampers, int k)
{
    return *(double *const *)(const void *)((const char *)dampers +
                                            numbers[k].offset);
}

ritz_status ritz_part_write_dampers(hid_t at, const ritz_dampers *dampers)
{
    ritz_status status = RITZ_OK;
    ritz_h5_shape shape = ritz_h5_vector(dampers->count);
    hid_t group = 0;

    if (dampers->count == 0)
        return RITZ_OK;
    RITZ_TRY(ritz_h5_group(at, "dampers", &group));
    RITZ_TRY(
        ritz_part_write_words(group, "names", dampers->count, dampers->name));
    for (int k = 0; k < NUM_NUMBERS; k++)
        RITZ_TRY(ritz_h5_write(group, numbers[k].name, H5T_IEEE_F64LE, shape,
                               numbers_of(dampers, k)));
    RITZ_TRY(ritz_h5_write_dense(group, "B", &dampers->B));
done:
    ritz_h5_close(group);
    return ritz_context(status, "dampers");
}

static ritz_status read_all(hid_t group, int64_t n, ritz_dampers *out)
{
    ritz_status status = RITZ_OK;
    int64_t count = 0;
    ritz_dense B = {0};

    RITZ_TRY(ritz_h5_count(group, "names", &count));
    RITZ_TRY(ritz_h5_read_dense(group, "B", n, count, &B));
    RITZ_TRY(ritz_dampers_new(0, count, out));
    ritz_dense_free(&out->B);
    out->B = B;
    B = (ritz_dense){0};
    RITZ_TRY(ritz_part_read_words(group, "names", count, out->name));
    for (int k = 0; k < NUM_NUMBERS; k++)
        RITZ_TRY(ritz_h5_read_real(group, numbers[k].name,
                                   ritz_h5_vector(count), false,
                                   numbers_of(out, k)));
    RITZ_TRY(ritz_dampers_check(out, n));
done:
    ritz_dense_free(&B);
    return status;
}

ritz_status ritz_part_read_dampers(hid_t at, int64_t n, ritz_dampers *out)
{
    ritz_status status = RITZ_OK;
    ritz_dampers dampers = {0};
    hid_t group = 0;

    if (!ritz_h5_has(at, "dampers"))
        return RITZ_OK;
    RITZ_TRY(ritz_h5_enter(at, "dampers", &group));
    RITZ_TRY(read_all(group, n, &dampers));
    *out = dampers;
    dampers = (ritz_dampers){0};
done:
    ritz_dampers_free(&dampers);
    ritz_h5_close(group);
    return ritz_context(status, "dampers");
}
