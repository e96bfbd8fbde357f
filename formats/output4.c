/* NASTRAN OUTPUT4, whichever way it is spelled. */
#include "formats/output4.h"

static bool is_output4(const char *bytes, int64_t size)
{
    return ritz_output4_is_binary(bytes, size) ||
           ritz_output4_is_text(bytes, size);
}

static ritz_status list_spelling(const ritz_foreign *file, bool check,
                                 ritz_listing *out)
{
    if (ritz_output4_is_binary(file->bytes, file->size))
        return ritz_output4_list_binary(file, check, out);
    return ritz_output4_list_text(file, check, out);
}

/* Of a damaged file all values are read, to find where the damage begins. */
static ritz_status list_file(const ritz_foreign *file, ritz_listing *out)
{
    ritz_status status = list_spelling(file, false, out);

    if (status == RITZ_ERR_FORMAT) {
        out->count = 0;
        status = list_spelling(file, true, out);
    }
    RITZ_CHECK(status);
    RITZ_REFUSE_IF(out->count == 0, RITZ_ERR_FORMAT, "holds no matrix");
    return RITZ_OK;
}

static ritz_status read_matrix(const ritz_foreign *file,
                               const ritz_listed *which, ritz_matrix *out)
{
    if (ritz_output4_is_binary(file->bytes, file->size))
        return ritz_output4_read_binary(file, which, out);
    return ritz_output4_read_text(file, which, out);
}

const ritz_format ritz_format_output4 = {
    .name = "output4",
    .summary = "NASTRAN OUTPUT4, text or binary, dense or sparse",
    .reference = "MSC2014",
    .recognise = is_output4,
    .list = list_file,
    .read = read_matrix,
};
