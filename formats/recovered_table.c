/* Writes the maxima over time of recovered quantities as a table of text. */
#include "base/alloc.h"
#include "formats/certificate.h"
#include "formats/sink.h"

#include <inttypes.h>
#include <stdlib.h>

typedef struct maxima_text {
    const ritz_recovered *recovered;
    const ritz_stamp *stamp;
    char *certificate;
} maxima_text;

static ritz_status print_rows(FILE *file, const void *what)
{
    const maxima_text *text = what;
    const ritz_recovered *all = text->recovered;

    if (text->stamp && text->stamp->interrupted)
        fprintf(file, "# interrupted: %s\n", text->stamp->interrupted);
    ritz_comment_put(file, "# ", 0, text->certificate);
    fputs("quantity\tplace\tpart\tvalue\tseconds\n", file);
    for (int64_t k = 0; k < all->num_quantities; k++) {
        const ritz_peaks *p = &all->quantity[k];

        for (int64_t i = 0; i < p->count; i++)
            fprintf(file, "%s\t%" PRId64 "\t%s\t%.17g\t%.17g\n", p->name,
                    p->place[i], p->part[i], p->value[i], p->seconds[i]);
    }
    return RITZ_OK;
}

ritz_status ritz_recovered_write(const char *path,
                                 const ritz_recovered *recovered,
                                 const ritz_reduced *reduced,
                                 const ritz_stamp *stamp)
{
    const ritz_export_object object = {.reduced = reduced};
    RITZ_OWN_ARRAY char *certificate = NULL;
    maxima_text text = {recovered, stamp, NULL};

    RITZ_CHECK(ritz_certificate(&object, stamp, &certificate));
    text.certificate = certificate;
    return ritz_sink_write(path, print_rows, &text);
}
