/* Text that is safe in XML, and what exporters of shapes say alike. */
#ifndef RITZ_FORMATS_XML_H
#define RITZ_FORMATS_XML_H

#include <ritz/export.h>

#include <stdio.h>

/** @p text with markup as entities and control characters as '?'. */
void ritz_xml_put(FILE *file, const char *text);

/** Points, cells, shapes, and what was left out. */
ritz_status ritz_shapes_say(const ritz_shapes *shapes,
                            ritz_export_report *report);

#endif
