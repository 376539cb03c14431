/* The golden models of format version 1 (tests/golden/v1), damaged: cut at every byte, each of their bits flipped. In
 * binary every one is refused. In text every cut is refused, and from the heading of an array or unknown block to its
 * crc line a flip is refused or changes nothing (hexadecimal digits in upper case read the same). What stands outside,
 * metadata, provenance, axes, the lines of frames and of the end, has no checksum in text: a flip there may be read as
 * another value, and must only do no harm.
 */
#include "streams.h"
#include "tap.h"

static bytes golden(const char *name)
{
    char path[200];
    bytes b = {0};
    snprintf(path, sizeof path, "tests/golden/v1/%s", name);
    FILE *f = fopen(path, "rb");
    b.at = malloc(1 << 17);
    if (f && b.at)
        b.size = fread(b.at, 1, 1 << 17, f);
    if (f)
        fclose(f);
    ok(b.size && b.size < 1 << 17, "%s is there, of %zu bytes", path, b.size);
    return b;
}

/* Whether the stream is refused as bad input; a failure that a tool left in it is none. */
static bool refused_as_bad(const bytes *b, size_t size, err *e)
{
    return refused(b->at, size, e) && e->status == STATUS_BAD && *e->text && !e->silent;
}

static void cut_at_every_byte(const char *name)
{
    err e;
    size_t taken = 0;
    bytes b = golden(name);
    for (size_t n = 0; n < b.size; n++)
        taken += !refused_as_bad(&b, n, &e);
    ok(!taken, "%s is refused cut at each of its %zu bytes", name, b.size);
    free(b.at);
}

static void add_a_byte(const char *name)
{
    err e;
    size_t taken = 0;
    bytes b = golden(name);
    unsigned char *more = b.at ? realloc(b.at, b.size + 1) : NULL;
    for (int c = 0; more && c < 256; c++) {
        b.at = more;
        b.at[b.size] = (unsigned char)c;
        taken += !refused_as_bad(&b, b.size + 1, &e);
    }
    ok(more && !taken, "%s is refused with any byte after it", name);
    free(b.at);
}

static void flip(bytes *b, size_t bit)
{
    b->at[bit / 8] ^= (unsigned char)(1 << bit % 8);
}

static void flip_binary(const char *name)
{
    err e;
    size_t taken = 0;
    bytes b = golden(name);
    for (size_t bit = 0; bit < 8 * b.size; bit++) {
        flip(&b, bit);
        taken += !refused_as_bad(&b, b.size, &e);
        flip(&b, bit);
    }
    ok(b.size && !taken, "%s is refused with any of its %zu bits flipped", name, 8 * b.size);
    free(b.at);
}

static bool begins(const char *line, const char *word)
{
    return !strncmp(line, word, strlen(word));
}

/* covered[i]: the byte is between a heading and its crc line, both included. Returns how many are. */
static size_t find_covered(const bytes *b, bool *covered)
{
    bool under = false;
    size_t count = 0;
    for (size_t at = 0; at < b->size;) {
        const char *line = (const char *)b->at + at;
        size_t n = 1 + strcspn(line, "\n");
        bool last = begins(line, "crc ");
        under = under || begins(line, "array ") || begins(line, "block ");
        for (size_t i = at; i < at + n; i++)
            count += covered[i] = under;
        under = under && !last;
        at += n;
    }
    return count;
}

/* Whether what is read of it is what `plain`, its binary, holds. */
static bool reads_the_same(const bytes *b, const bytes *plain)
{
    err e = {0};
    bytes got = convert(b->at, b->size, false, &e);
    bool same = got.size == plain->size && got.size && !memcmp(got.at, plain->at, got.size);
    free(got.at);
    return same;
}

static void flip_text(const char *name, const char *binary)
{
    err e;
    size_t silent = 0, taken = 0;
    bytes b = golden(name), plain = golden(binary);
    b.at[b.size] = 0;
    bool *covered = calloc(b.size + 1, sizeof *covered);
    size_t count = covered ? find_covered(&b, covered) : 0;
    for (size_t bit = 0; covered && bit < 8 * b.size; bit++) {
        flip(&b, bit);
        int status = refused(b.at, b.size, &e);
        if (covered[bit / 8])
            silent += status ? e.status != STATUS_BAD || e.silent : !reads_the_same(&b, &plain);
        else
            taken += !status;
        flip(&b, bit);
    }
    ok(count && !silent, "%s: no flip of the %zu bits under checksums changes what is read", name, 8 * count);
    ok(covered && taken < 8 * (b.size - count), "%s: of the other %zu bits, %zu flips are read as something else", name,
       8 * (b.size - count), taken);
    free(covered);
    free(b.at);
    free(plain.at);
}

int main(void)
{
    static const char *const all[] = {"empty.text",     "empty.binary",     "types.text",    "types.binary",
                                      "failed.text",    "failed.binary",    "types.text.gz", "types.binary.gz",
                                      "failed.text.gz", "failed.binary.gz", "tet.binary"};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        cut_at_every_byte(all[i]);
    for (size_t i = 0; i < 6; i++)
        add_a_byte(all[i]);
    flip_binary("empty.binary");
    flip_binary("failed.binary");
    flip_binary("types.binary");
    flip_text("types.text", "types.binary");
    return done_testing();
}
