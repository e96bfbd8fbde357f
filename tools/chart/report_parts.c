/* Small parts of the page. */
#include "chart/report_parts.h"

#include <stdlib.h>
#include <string.h>

ritz_status report_subjects(const records *all, int64_t *count,
                            const char ***out)
{
    ritz_status status = RITZ_OK;
    const char **list = calloc((size_t)all->count + 1, sizeof *list);
    int64_t n = 0;

    RITZ_FAIL_IF(!list, RITZ_ERR_MEMORY, "no memory for records");
    for (int64_t k = 0; k < all->count; k++) {
        const record *r = &all->item[k];
        int64_t i = 0;

        if (!r->errors || r->order < 0 || !*r->method)
            continue;
        while (i < n && strcmp(list[i], r->subject) != 0)
            i++;
        if (i == n)
            list[n++] = r->subject;
    }
    RITZ_FAIL_IF(n == 0, RITZ_ERR_ARGUMENT,
                 "no record has a method, an order and errors: those of "
                 "ritz-verify and ritz-fit do");
    *count = n;
    *out = list;
    list = NULL;
done:
    free(list);
    return status;
}

/* Three bytes are four letters; two are three and a '='. */
static void encode(const unsigned char bytes[32], char out[45])
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnop"
                                  "qrstuvwxyz0123456789+/";
    int n = 0;

    for (int k = 0; k < 32; k += 3) {
        unsigned word = (unsigned)bytes[k] << 16 |
                        (k + 1 < 32 ? (unsigned)bytes[k + 1] << 8 : 0) |
                        (k + 2 < 32 ? (unsigned)bytes[k + 2] : 0);

        for (int i = 0; i < 4; i++) {
            out[n] = '=';
            if (k + i <= 32)
                out[n] = letters[word >> (18 - 6 * i) & 63];
            n++;
        }
    }
    out[n] = '\0';
}

void report_hash(const char *const *lines, char out[64])
{
    char digest[RITZ_DIGEST_SIZE];
    unsigned char bytes[32];
    char text[45];
    char *all = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&all, &size);

    out[0] = '\0';
    if (!file)
        return;
    for (int64_t k = 0; lines[k]; k++)
        fputs(lines[k], file);
    fclose(file);
    ritz_digest_bytes(all, size, digest);
    free(all);
    for (size_t k = 0; k < sizeof bytes; k++) {
        char pair[] = {digest[2 * k], digest[2 * k + 1], '\0'};

        bytes[k] = (unsigned char)strtoul(pair, NULL, 16);
    }
    encode(bytes, text);
    snprintf(out, 64, "sha256-%s", text);
}
