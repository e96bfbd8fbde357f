/* Text that others wrote: its letters, and paths. */
#ifndef RITZ_BASE_TEXT_H
#define RITZ_BASE_TEXT_H

#include <ritz/base.h>

/**
 * Bytes of the letter of UTF-8 at @p text, which NUL ends.
 *
 * @return 0 at a control character, the end, or what is not UTF-8
 */
int ritz_letter_length(const char *text);

/** The folder of a path: "." if it names none. The caller frees @p out. */
ritz_status ritz_path_folder(const char *path, char **out);

#endif
