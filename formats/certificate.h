/* The certificate of a model: how it was made and what is known of its errors,
 * as text that files of other programs carry in comments or metadata. */
#ifndef RITZ_FORMATS_CERTIFICATE_H
#define RITZ_FORMATS_CERTIFICATE_H

#include <ritz/export.h>

#include <stdio.h>

/**
 * Make the certificate of an object. It has a line, ended by '\n', for each of:
 * the method, the order and the band of the modes, the units, the damping, each
 * error with its limit, the SHA-256 of each input, the commands that made and
 * measured the model, and the command of the export. Control characters are
 * replaced by '?'. An object that is neither a reduced component nor a state
 * space has the lines of inputs and commands alone.
 *
 * @param[in]  object  `reduced` is certified too if it is given with shapes
 * @param[in]  stamp   inputs and command; NULL: not known
 * @param[out] out     the caller frees it
 */
ritz_status ritz_certificate(const ritz_export_object *object,
                             const ritz_stamp *stamp, char **out);

/**
 * Write a text as comment lines, each of which begins with @p before.
 *
 * @param[in] width  largest number of bytes of text in a line, at least 4.
 *                   Longer lines are broken after a blank if there is one, and
 *                   never within a letter of UTF-8. 0: no limit
 */
void ritz_comment_put(FILE *file, const char *before, int width,
                      const char *text);

/** Write a text as one XML comment. "--", which ends a comment, is written as
 * "- -", and markup as entities. */
void ritz_comment_put_xml(FILE *file, const char *text);

#endif
