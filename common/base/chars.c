#include "base/chars.h"

/* The length of the well-formed UTF-8 character at p (not NUL), or 0. */
static int utf8_length(const unsigned char *p)
{
    if (p[0] < 0x80)
        return 1;
    int more = p[0] >= 0xc2 && p[0] < 0xe0 ? 1 : p[0] >= 0xe0 && p[0] < 0xf0 ? 2 : p[0] >= 0xf0 && p[0] < 0xf5 ? 3 : 0;
    for (int i = 1; i <= more; i++)
        if ((p[i] & 0xc0) != 0x80)
            return 0;
    bool overlong = (p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xf0 && p[1] < 0x90);
    bool surrogate = p[0] == 0xed && p[1] > 0x9f;
    bool past = p[0] == 0xf4 && p[1] > 0x8f;
    return more && !overlong && !surrogate && !past ? more + 1 : 0;
}

bool chars_utf8(const char *text)
{
    const unsigned char *p = (const unsigned char *)text;
    while (*p) {
        int n = utf8_length(p);
        if (!n)
            return false;
        p += n;
    }
    return true;
}

void chars_mend(char *text)
{
    unsigned char *p = (unsigned char *)text;
    while (*p) {
        int n = utf8_length(p);
        if (!n)
            *p = '?';
        p += n ? n : 1;
    }
}
