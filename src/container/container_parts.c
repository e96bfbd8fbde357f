/* Members of the simplest kinds: numbers, names, lists of them. */
#include "container/container_parts.h"

#include "base/alloc.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

ritz_status ritz_part_set_members(hid_t at, const ritz_text_member *member,
                                  const void *object)
{
    for (; member->name; member++)
        RITZ_CHECK(ritz_h5_set_text(at, member->name,
                                    (const char *)object + member->offset));
    return RITZ_OK;
}

ritz_status ritz_part_get_members(hid_t at, const ritz_text_member *member,
                                  void *object)
{
    for (; member->name; member++)
        RITZ_CHECK(ritz_h5_get_text(at, member->name, RITZ_NAME_SIZE,
                                    (char *)object + member->offset));
    return RITZ_OK;
}

ritz_status ritz_part_set_whole(hid_t at, const char *name, int64_t value)
{
    return ritz_h5_set(at, name, H5T_STD_I64LE, ritz_h5_scalar(), &value);
}

ritz_status ritz_part_get_whole(hid_t at, const char *name, int64_t *out)
{
    return ritz_h5_get(at, name, H5T_STD_I64LE, 1, out);
}

ritz_status ritz_part_set_real(hid_t at, const char *name, int64_t count,
                               const double *values)
{
    return ritz_h5_set(at, name, H5T_IEEE_F64LE,
                       count == 1 ? ritz_h5_scalar() : ritz_h5_vector(count),
                       values);
}

ritz_status ritz_part_get_real(hid_t at, const char *name, bool nan_allowed,
                               int64_t count, double *out)
{
    RITZ_CHECK(ritz_h5_get(at, name, H5T_IEEE_F64LE, count, out));
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(!isfinite(out[k]) && !(nan_allowed && isnan(out[k])),
                       RITZ_ERR_FORMAT, "attribute '%s' is not finite", name);
    return RITZ_OK;
}

ritz_status ritz_part_get_size(hid_t at, const char *name, int64_t least,
                               int64_t most, int64_t *out)
{
    RITZ_CHECK(ritz_part_get_whole(at, name, out));
    RITZ_REFUSE_IF(*out < least || *out > most, RITZ_ERR_FORMAT,
                   "attribute '%s' is %" PRId64 ", not in %" PRId64
                   "..%" PRId64,
                   name, *out, least, most);
    return RITZ_OK;
}

static int compare(const void *a, const void *b)
{
    return strcmp(a, b);
}

/* Each is a name that a link can have, and no two are the same. */
static ritz_status check_names(int64_t count, const ritz_name *names)
{
    ritz_status status = RITZ_OK;
    ritz_name *sorted = NULL;

    RITZ_NEW(sorted, count);
    for (int64_t k = 0; k < count; k++) {
        status = ritz_name_copy(names[k], sorted[k]);
        RITZ_FAIL_IF(status != RITZ_OK, RITZ_ERR_FORMAT,
                     "name %" PRId64 ", '%.40s', cannot be one", k + 1,
                     names[k]);
    }
    qsort(sorted, (size_t)count, sizeof *sorted, compare);
    for (int64_t k = 1; k < count; k++)
        RITZ_FAIL_IF(strcmp(sorted[k - 1], sorted[k]) == 0, RITZ_ERR_FORMAT,
                     "'%s' is there twice", sorted[k]);
done:
    free(sorted);
    return status;
}

ritz_status ritz_part_write_words(hid_t at, const char *name, int64_t count,
                                  const ritz_name *words)
{
    ritz_status status = RITZ_OK;
    hid_t type = ritz_h5_string(RITZ_NAME_SIZE);
    ritz_name *clean = NULL; /* bytes behind a NUL would differ between runs */

    RITZ_NEW(clean, count);
    for (int64_t k = 0; k < count; k++)
        memcpy(clean[k], words[k], strnlen(words[k], RITZ_NAME_SIZE - 1));
    RITZ_TRY(ritz_h5_write(at, name, type, ritz_h5_vector(count), clean));
done:
    free(clean);
    ritz_h5_close(type);
    return status;
}

ritz_status ritz_part_read_words(hid_t at, const char *name, int64_t count,
                                 ritz_name *out)
{
    hid_t type = ritz_h5_string(RITZ_NAME_SIZE);
    ritz_status status =
        ritz_h5_read(at, name, type, ritz_h5_vector(count), out);

    ritz_h5_close(type);
    return status;
}

ritz_status ritz_part_write_names(hid_t at, const char *name, int64_t count,
                                  const ritz_name *names)
{
    RITZ_CHECK_IN(name, check_names(count, names));
    return ritz_part_write_words(at, name, count, names);
}

ritz_status ritz_part_read_names(hid_t at, const char *name, int64_t count,
                                 ritz_name *out)
{
    RITZ_CHECK(ritz_part_read_words(at, name, count, out));
    RITZ_CHECK_IN(name, check_names(count, out));
    return RITZ_OK;
}

ritz_status ritz_part_read_whole(hid_t at, const char *name, int64_t count,
                                 int64_t least, int64_t most, int64_t *out)
{
    RITZ_CHECK(
        ritz_h5_read(at, name, H5T_STD_I64LE, ritz_h5_vector(count), out));
    for (int64_t k = 0; k < count; k++)
        RITZ_REFUSE_IF(out[k] < least || out[k] > most, RITZ_ERR_FORMAT,
                       "value %" PRId64 " of '%s' is %" PRId64
                       ", not in %" PRId64 "..%" PRId64,
                       k + 1, name, out[k], least, most);
    return RITZ_OK;
}

ritz_status ritz_part_write_dense(hid_t at, const char *name,
                                  const ritz_dense *A)
{
    return A->val ? ritz_h5_write_dense(at, name, A) : RITZ_OK;
}

ritz_status ritz_part_read_dense(hid_t at, const char *name, int64_t n,
                                 int64_t m, ritz_dense *out)
{
    return ritz_h5_has(at, name) ? ritz_h5_read_dense(at, name, n, m, out)
                                 : RITZ_OK;
}
