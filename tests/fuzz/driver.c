/* A fuzz target without libFuzzer: runs it once on each file named, or in a folder named, in the
 * order of their names. So what was found once is tried by `make check` with any compiler. Says
 * nothing; a target that finds something aborts.
 */
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The bytes are copied to a block of just their size, so that a sanitizer sees a read past them. */
static int try_file(const char *path)
{
    enum { MOST = 1 << 22 };
    FILE *f = fopen(path, "rb");
    uint8_t *all = malloc(MOST), *bytes = NULL;
    size_t size = f && all ? fread(all, 1, MOST, f) : MOST;
    int bad = !f || !all || ferror(f) || size == MOST || !(bytes = malloc(size ? size : 1));
    if (!bad) {
        memcpy(bytes, all, size);
        LLVMFuzzerTestOneInput(bytes, size);
    } else {
        fprintf(stderr, "%s: cannot be read\n", path);
    }
    if (f)
        fclose(f);
    free(all);
    free(bytes);
    return bad;
}

static int visible(const struct dirent *one)
{
    return one->d_name[0] != '.';
}

static int try_folder(const char *path)
{
    struct dirent **list;
    char name[4096];
    int bad = 0, count = scandir(path, &list, visible, alphasort);
    if (count < 0)
        return try_file(path);
    for (int i = 0; i < count; i++) {
        snprintf(name, sizeof name, "%s/%s", path, list[i]->d_name);
        bad |= try_file(name);
        free(list[i]);
    }
    free(list);
    return bad;
}

int main(int argc, char **argv)
{
    int bad = argc < 2;
    for (int i = 1; i < argc; i++)
        bad |= try_folder(argv[i]);
    return bad;
}
