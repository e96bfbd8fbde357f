/* The limit of memory that a user sets. */
#include "cli/cli.h"

#include <string.h>

/* Bytes of a size such as "22G"; 0 if the text is none. */
static int64_t read_size(const char *text)
{
    static const char letters[] = "KMGT";
    const size_t digits = strspn(text, "0123456789.");
    const char *rest = text + digits;
    const char *letter = *rest ? strchr(letters, *rest) : NULL;
    const double most = 0x1p62;
    char number[32];
    double size = 0.0;

    if (digits == 0 || digits >= sizeof number)
        return 0;
    memcpy(number, text, digits);
    number[digits] = '\0';
    if (!ritz_text_real(number, &size))
        return 0;
    for (const char *k = letters; letter && k <= letter; k++)
        size *= 1024.0;
    rest += letter != NULL;
    if (*rest && strcmp(rest, "B") != 0 && strcmp(rest, "iB") != 0)
        return 0;
    return size >= 1.0 && size < most ? (int64_t)size : 0;
}

bool cli_limit_memory(const char *text)
{
    const int64_t bytes = read_size(text);

    ritz_set_memory(bytes);
    return bytes > 0;
}
