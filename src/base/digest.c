/* SHA-256 by nettle: what was read is named by content. */
#include <ritz/base.h>

#include <nettle/sha2.h>

#include <errno.h>
#include <stdio.h>
#include <string.h>

static void write_digest(struct sha256_ctx *sum, char out[RITZ_DIGEST_SIZE])
{
    uint8_t digest[SHA256_DIGEST_SIZE];

    sha256_digest(sum, sizeof digest, digest);
    for (size_t k = 0; k < sizeof digest; k++)
        snprintf(out + 2 * k, 3, "%02x", (unsigned)digest[k]);
}

void ritz_digest_bytes(const void *bytes, size_t size,
                       char out[RITZ_DIGEST_SIZE])
{
    struct sha256_ctx sum;

    sha256_init(&sum);
    sha256_update(&sum, size, bytes);
    write_digest(&sum, out);
}

ritz_status ritz_digest_file(const char *path, char out[RITZ_DIGEST_SIZE])
{
    ritz_status status = RITZ_OK;
    struct sha256_ctx sum;
    uint8_t block[1 << 16];
    size_t size = 0;
    FILE *file = fopen(path, "rb");

    RITZ_FAIL_IF(!file, RITZ_ERR_FILE, "cannot open '%s': %s", path,
                 strerror(errno));
    sha256_init(&sum);
    while ((size = fread(block, 1, sizeof block, file)) > 0)
        sha256_update(&sum, size, block);
    RITZ_FAIL_IF(ferror(file), RITZ_ERR_FILE, "cannot read '%s': %s", path,
                 strerror(errno));
    write_digest(&sum, out);
done:
    if (file)
        fclose(file);
    return status;
}
