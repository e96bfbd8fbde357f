#include "testing.h"

#include "damage.h"
#include "folder.h"
#include "mat_samples.h"

#include <ritz/import.h>

#include <stdlib.h>

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
            damage_try(damage_read_matrices, at, n);
        for (int64_t n = 0; n < size; n += steps[k]) {
            char was = at[n];

            at[n] = (char)(was ^ (n % 3 ? 0x80 : 0x11));
            damage_try(damage_read_matrices, at, size);
            at[n] = (char)0xff;
            damage_try(damage_read_matrices, at, size);
            at[n] = was;
        }
        free(at);
    }
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_cut_and_no_spoiled_byte_is_believed_or_fatal),
};

TEST_MODULE(mat_damage, tests, mat_samples_make, folder_remove)
