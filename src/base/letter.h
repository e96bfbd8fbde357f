/* Letters of text that others wrote. */
#ifndef RITZ_BASE_LETTER_H
#define RITZ_BASE_LETTER_H

/**
 * Bytes of the letter of UTF-8 at @p text, which NUL ends.
 *
 * @return 0 at a control character, the end, or what is not UTF-8
 */
int ritz_letter_length(const char *text);

#endif
