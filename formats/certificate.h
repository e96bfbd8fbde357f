/* The certificate of a model: how it was made and what is known of its errors,
 * as text that files of other programs carry in comments or metadata. */
#ifndef RITZ_FORMATS_CERTIFICATE_H
#define RITZ_FORMATS_CERTIFICATE_H

#include <ritz/export.h>

#include <stdio.h>

/**
 * Method, order, band of its modes, units, damping, errors with their limits,
 * SHA-256 of each input, the command that made the model and measured it, with
 * its band, and that of the export; a line each, ended by '\n', control
 * characters replaced by '?'. Of an object that is neither a reduced component
 * nor a state space, inputs and command alone.
 *
 * @param[in]  object  shapes may have a reduced component beside them
 * @param[in]  stamp   inputs and command; NULL: not known
 * @param[out] out     the caller frees it
 */
ritz_status ritz_certificate(const ritz_export_object *object,
                             const ritz_stamp *stamp, char **out);

/**
 * Put lines of text as comments, each behind @p before.
 *
 * @param[in] width  bytes of text a line, at least 4: what is longer goes on in
 *                   the next line, cut behind a blank if there is one, and
 *                   never within a letter; 0: any number
 */
void ritz_comment_put(FILE *file, const char *before, int width,
                      const char *text);

/** Put it as an XML comment, whose "--" becomes "- -"; markup is replaced by
 * entities. */
void ritz_comment_put_xml(FILE *file, const char *text);

#endif
