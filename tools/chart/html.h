/* Text of users, written into markup. */
#ifndef RITZ_TOOLS_CHART_HTML_H
#define RITZ_TOOLS_CHART_HTML_H

#include <stdio.h>

/**
 * Write text between tags or into a quoted attribute: characters that markup
 * interprets are escaped, control characters become spaces, and bytes that are
 * not UTF-8 question marks.
 */
void html_text(FILE *file, const char *text);

/**
 * Write markup as printf would, the texts of "%s" escaped. It knows "%s",
 * "%ld", "%g", "%.3g" and "%%".
 */
[[gnu::format(printf, 2, 3)]] void html_print(FILE *file, const char *format,
                                              ...);

/** Write one letter as markup. @return bytes of text it took */
int html_symbol(FILE *file, const char *text);

/** Write one letter, ' ' or '?' for what is none. @return bytes of text it
 * took */
int html_letter(FILE *file, const char *text);

/** Write text as one plain line, without control characters and wrong bytes. */
void html_line(FILE *file, const char *text);

#endif
