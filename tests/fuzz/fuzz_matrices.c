/* Files of matrices and decks, read from memory. */
#include "fuzz.h"

#include "base/alloc.h"

#include <ritz/import.h>

enum { MOST_READ = 8 }; /* matrices read of one file */

static void read_matrices(const ritz_format *format, const char *bytes,
                          int64_t size)
{
    ritz_foreign file = {.bytes = bytes, .size = size, .format = format};
    ritz_status status = ritz_foreign_list(&file);

    fuzz_judge(status);
    for (int64_t k = 0;
         status == RITZ_OK && k < file.listing.count && k < MOST_READ; k++) {
        RITZ_OWN(ritz_matrix) matrix = {0};

        fuzz_judge(ritz_foreign_take(&file, k, &matrix));
    }
    ritz_foreign_free(&file);
}

/* Call a reader on bytes that it recognises. */
static void read_as(const ritz_format *format, const char *bytes, int64_t size)
{
    if (format->recognise(bytes, size))
        read_matrices(format, bytes, size);
}

void fuzz_output4(const char *bytes, int64_t size)
{
    read_as(&ritz_format_output4, bytes, size);
}

void fuzz_matrix_market(const char *bytes, int64_t size)
{
    read_as(&ritz_format_matrix_market, bytes, size);
}

void fuzz_coordinates(const char *bytes, int64_t size)
{
    read_as(&ritz_format_coordinates, bytes, size);
}

void fuzz_harwell_boeing(const char *bytes, int64_t size)
{
    read_as(&ritz_format_harwell_boeing, bytes, size);
}

void fuzz_dmig(const char *bytes, int64_t size)
{
    read_as(&ritz_format_dmig, bytes, size);
}

void fuzz_matrix_input(const char *bytes, int64_t size)
{
    read_as(&ritz_format_matrix_input, bytes, size);
}

void fuzz_user_element(const char *bytes, int64_t size)
{
    read_as(&ritz_format_user_element, bytes, size);
}

/* Only MAT files of level 5: HDF5 is not robust to damaged bytes. */
void fuzz_mat(const char *bytes, int64_t size)
{
    enum { HEAD = 512 };
    static const char mark[] = "\211HDF\r\n\032\n";

    if (size < HEAD + 8 || memcmp(bytes + HEAD, mark, 8) != 0)
        read_as(&ritz_format_mat, bytes, size);
}

void fuzz_matrices(const char *bytes, int64_t size)
{
    (void)ritz_unread_find(bytes, size);
    for (int k = 0; ritz_formats[k]; k++)
        if (ritz_formats[k] != &ritz_format_mat &&
            ritz_formats[k]->recognise(bytes, size)) {
            read_matrices(ritz_formats[k], bytes, size);
            return;
        }
    read_matrices(NULL, bytes, size);
}

void fuzz_deck(const char *bytes, int64_t size)
{
    ritz_deck deck = {0};

    if (ritz_deck_recognise(bytes, size))
        fuzz_judge(ritz_deck_parse(NULL, bytes, size, NULL, &deck));
    ritz_deck_free(&deck);
}
