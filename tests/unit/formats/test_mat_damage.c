#include "testing.h"

#include "folder.h"
#include "mat_samples.h"

#include <ritz/import.h>

#include <stdlib.h>

/* A bytes' copy as it is read; damage may be found or not, but no more. */
static void assert_bears(const char *at, int64_t size)
{
    ritz_matrices all = {0};
    char *copy = malloc((size_t)size + 1); /* so that ASan sees its end */

    assert_non_null(copy);
    memcpy(copy, at, (size_t)size);
    if (ritz_foreign_parse(copy, size, &all) == RITZ_OK)
        for (int64_t k = 0; k < all.count; k++)
            assert_ok(ritz_sparse_check(
                &all.matrix[k].A,
                all.matrix[k].A.colptr[all.matrix[k].A.ncol]));
    ritz_matrices_free(&all);
    free(copy);
}

static void no_cut_and_no_spoiled_byte_is_believed_or_fatal(void **state)
{
    /* HDF5 takes a millisecond for each under a sanitizer */
    static const int64_t steps[MAT_SAMPLES] = {7, 5, 131, 131};

    (void)state;
    for (int k = 0; k < MAT_SAMPLES; k++) {
        int64_t size = 0;
        char *at = NULL;

        assert_ok(
            ritz_bytes_read(folder_path(mat_samples[k].path), &size, &at));
        for (int64_t n = 0; n < size; n += steps[k])
            assert_bears(at, n);
        for (int64_t n = 0; n < size; n += steps[k]) {
            char was = at[n];

            at[n] = (char)(was ^ (n % 3 ? 0x80 : 0x11));
            assert_bears(at, size);
            at[n] = (char)0xff;
            assert_bears(at, size);
            at[n] = was;
        }
        free(at);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_cut_and_no_spoiled_byte_is_believed_or_fatal),
};

TEST_MODULE(mat_damage, tests, mat_samples_make, folder_remove)
