#include "cli/spelling.h"

#include <ctype.h>
#include <string.h>

/* Words of options, their values, and names of arrays. */
static const struct {
    const char *american, *british;
} words[] = {
    {"center", "centre"}, {"centers", "centres"},   {"color", "colour"},
    {"fiber", "fibre"},   {"mixfiber", "mixfibre"}, {"voxelize", "voxelise"},
};

enum { WORDS = sizeof words / sizeof *words };

/* How many letters text begins with, of n bytes. */
static size_t letters(const char *text, size_t n)
{
    size_t i = 0;
    while (i < n && isalpha((unsigned char)text[i]))
        i++;
    return i;
}

static const char *british_of(const char *word, size_t n)
{
    for (int i = 0; i < WORDS; i++)
        if (strlen(words[i].american) == n && !memcmp(words[i].american, word, n))
            return words[i].british;
    return NULL;
}

bool spelling_british(const char *typed, size_t n, char *to, size_t size)
{
    bool changed = false;
    size_t used = 0;
    for (size_t at = 0; at < n;) {
        size_t length = letters(typed + at, n - at);
        const char *british = length ? british_of(typed + at, length) : NULL;
        const char *put = british ? british : typed + at;
        length = length ? length : 1;
        const size_t more = british ? strlen(british) : length;
        if (used + more >= size)
            return false;
        memcpy(to + used, put, more);
        used += more;
        at += length;
        changed = changed || british;
    }
    if (size)
        to[used] = 0;
    return changed;
}

const char *spelling_american(const char *word)
{
    for (int i = 0; i < WORDS; i++)
        if (!strcmp(words[i].british, word))
            return words[i].american;
    return NULL;
}
