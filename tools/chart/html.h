/* Text that others wrote, made fit for markup. */
#ifndef RITZ_TOOLS_CHART_HTML_H
#define RITZ_TOOLS_CHART_HTML_H

#include <stdio.h>

/**
 * Write text into markup, between tags or in a quoted attribute: what markup
 * reads is escaped, control characters become spaces, and bytes that are not
 * UTF-8 question marks.
 */
void html_text(FILE *file, const char *text);

/**
 * Write markup with text in it, as printf would: only what stands for "%s" is
 * escaped. It knows "%s", "%ld", "%g", "%.3g" and "%%".
 */
[[gnu::format(printf, 2, 3)]] void html_print(FILE *file, const char *format,
                                              ...);

/** Write one letter as markup. @return bytes of text it took */
int html_symbol(FILE *file, const char *text);

/** Write one letter, or what stands for it. @return bytes of text it took */
int html_letter(FILE *file, const char *text);

/** Write text as one plain line: only control characters and wrong bytes go. */
void html_line(FILE *file, const char *text);

#endif
