/* Files, reports and XML that exporters share. */
#ifndef RITZ_FORMATS_SINK_H
#define RITZ_FORMATS_SINK_H

#include <ritz/export.h>
#include <ritz/import.h>

#include <stdio.h>

/**
 * Let @p write put @p what into a draft of @p path, then give it its name.
 *
 * @return RITZ_ERR_FILE if not all of it could be written; what @p write says
 */
ritz_status ritz_sink_write(const char *path,
                            ritz_status (*write)(FILE *file, const void *what),
                            const void *what);

/** Refuse a matrix that holds a value that is not finite, naming it. */
ritz_status ritz_sink_check(const ritz_matrix *m);

/** @p text with markup as entities and control characters as '?'. */
void ritz_xml_put(FILE *file, const char *text);

/** Points, cells, shapes, and what was left out. */
ritz_status ritz_shapes_say(const ritz_shapes *shapes,
                            ritz_export_report *report);

#endif
