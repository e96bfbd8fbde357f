#include "formats/sink.h"

#include "base/draft.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

ritz_status ritz_sink_write(const char *path,
                            ritz_status (*write)(FILE *file, const void *what),
                            const void *what)
{
    ritz_status status = RITZ_OK;
    ritz_draft draft = {0};
    FILE *file = NULL;
    int failed = 0;

    RITZ_TRY_IN(path, ritz_draft_new(path, &draft));
    file = fopen(draft.name, "wb");
    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot write '%s': %s", path,
                 strerror(errno));
    RITZ_TRY(write(file, what));
    failed = ferror(file);
    failed = fclose(file) != 0 || failed;
    file = NULL;
    RITZ_FAIL_IF(failed, RITZ_ERR_FILE, "cannot write all of '%s': %s", path,
                 strerror(errno));
    RITZ_TRY(ritz_draft_publish(&draft));
done:
    if (file)
        fclose(file);
    ritz_draft_free(&draft);
    return status;
}

ritz_status ritz_sink_check(const ritz_matrix *m)
{
    for (int64_t j = 0; j < m->A.ncol; j++)
        for (int64_t p = m->A.colptr[j]; p < m->A.colptr[j + 1]; p++)
            RITZ_REFUSE_IF(!isfinite(m->A.val[p]) ||
                               (m->imaginary && !isfinite(m->imaginary[p])),
                           RITZ_ERR_ARGUMENT,
                           "row %" PRId64 " of column %" PRId64
                           " of '%s' is not finite",
                           m->A.rowind[p] + 1, j + 1, m->name);
    return RITZ_OK;
}
