#include "base/letter.h"

int ritz_letter_length(const char *text)
{
    const unsigned char *c = (const unsigned char *)text;
    int more = c[0] >= 0xF0 ? 3 : c[0] >= 0xE0 ? 2 : 1;

    if (c[0] < 0x80)
        return c[0] >= ' ' && c[0] != 0x7F;
    if (c[0] < 0xC2 || c[0] > 0xF4 || (c[0] == 0xC2 && c[1] < 0xA0))
        return 0; /* no first byte, or a control character above 0x7F */
    for (int k = 1; k <= more; k++)
        if (c[k] >> 6 != 2)
            return 0;
    return 1 + more;
}
