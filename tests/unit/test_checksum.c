/* Checksums against zlib's: every short length, every place in a word, long pieces cut anywhere, and bits that flip. */
#include "base/checksum.h"

#include "tap.h"

#include <stdint.h>
#include <stdlib.h>
#include <zlib.h>

enum { SIZE = 70000 };

static uint32_t next(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(*state >> 33);
}

static uint32_t by_zlib(uint32_t crc, const unsigned char *bytes, size_t size)
{
    return (uint32_t)crc32(crc, bytes, (uInt)size);
}

int main(void)
{
    unsigned char *bytes = malloc(SIZE);
    uint64_t seed = 5;
    int64_t wrong = 0;
    for (size_t i = 0; bytes && i < SIZE; i++)
        bytes[i] = (unsigned char)next(&seed);
    ok(bytes && checksum_add(0, "123456789", 9) == 0xcbf43926, "the check value");
    for (size_t size = 0; size < 2700; size++)
        for (size_t at = 0; at < 17; at++)
            wrong += checksum_add(0, bytes + at, size) != by_zlib(0, bytes + at, size);
    ok(!wrong, "every length to 2700 at every place to 17: %d differ", (int)wrong);
    for (int n = 0; n < 500; n++) {
        size_t from = next(&seed) % SIZE, size = next(&seed) % (SIZE - from), cut = size ? next(&seed) % size : 0;
        uint32_t crc = next(&seed), want = by_zlib(crc, bytes + from, size);
        wrong += checksum_add(crc, bytes + from, size) != want;
        wrong += checksum_add(checksum_add(crc, bytes + from, cut), bytes + from + cut, size - cut) != want;
    }
    ok(!wrong, "long pieces after any others, whole and cut: %d differ", (int)wrong);
    uint32_t whole = checksum_add(0, bytes, SIZE);
    for (int n = 0; n < 500; n++) {
        uint32_t at = next(&seed) % SIZE, bit = 1u << next(&seed) % 8;
        bytes[at] = (unsigned char)(bytes[at] ^ bit);
        wrong += checksum_add(0, bytes, SIZE) == whole;
        bytes[at] = (unsigned char)(bytes[at] ^ bit);
    }
    ok(!wrong, "any one bit matters: %d did not", (int)wrong);
    ok(checksum_add(whole, NULL, 0) == whole && checksum_add(whole, bytes, 0) == whole, "nothing changes nothing");
    free(bytes);
    return done_testing();
}
