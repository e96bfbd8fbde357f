/* Writes a series, the shapes of a component over time, frame by frame. */
#include "base/alloc.h"
#include "formats/certificate.h"

#include <ritz/export.h>

#include <stdlib.h>
#include <string.h>

ritz_status ritz_series_begin(const ritz_series_format *format,
                              const char *path, const ritz_moving *moving,
                              const ritz_stamp *stamp, ritz_series *out)
{
    const ritz_export_object object = {.reduced = moving->reduced};

    *out = (ritz_series){.format = format};
    RITZ_CHECK(ritz_certificate(&object, stamp, &out->comment));
    return format->begin(path, &moving->frame, out);
}

ritz_status ritz_series_frame(ritz_series *series, double seconds,
                              const ritz_shapes *frame)
{
    RITZ_CHECK_ROOM(series->seconds, series->count, series->room);
    series->seconds[series->count] = seconds;
    RITZ_CHECK(series->format->frame(series, frame));
    series->count++;
    return RITZ_OK;
}

ritz_status ritz_series_finish(ritz_series *series, const char *path)
{
    return series->format->finish(series, path);
}

void ritz_series_free(ritz_series *series)
{
    if (series->own)
        series->format->end(series);
    RITZ_FREE(series->seconds, series->comment);
    *series = (ritz_series){0};
}
