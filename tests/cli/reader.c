/* A reader that stops early, for the tests of what fails: `reader BYTES [ignored] COMMAND...` runs the command
 * with a pipe of one page for its standard output, reads so many bytes of it, closes it, and says how the command
 * ended: "exit 1", "signal 13". With `ignored`, the command finds SIGPIPE ignored. `reader blocks FILE` prints
 * where each block of a binary model ends.
 */
#define _GNU_SOURCE /* F_SETPIPE_SZ */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MAGIC = 16, HEAD = 16, CRC = 4 };

static int blocks(const char *path)
{
    unsigned char head[HEAD];
    uint64_t length;
    FILE *f = fopen(path, "rb");
    if (!f)
        return 1;
    long at = MAGIC;
    printf("%ld\n", at);
    while (!fseek(f, at, SEEK_SET) && fread(head, HEAD, 1, f) == 1) {
        memcpy(&length, head + 8, sizeof length);
        at += HEAD + (long)length + CRC;
        printf("%ld\n", at);
    }
    fclose(f);
    return 0;
}

static void run(int out, int reading, int ignored, char **command)
{
    signal(SIGPIPE, ignored ? SIG_IGN : SIG_DFL);
    dup2(out, STDOUT_FILENO);
    close(out);
    close(reading);
    execvp(command[0], command);
    _exit(127);
}

int main(int argc, char **argv)
{
    int ends[2], status = 0, ignored = argc > 3 && !strcmp(argv[2], "ignored");
    static char bytes[4096];
    if (argc == 3 && !strcmp(argv[1], "blocks"))
        return blocks(argv[2]);
    if (argc < 3 || pipe(ends))
        return 2;
    fcntl(ends[1], F_SETPIPE_SZ, 4096);
    pid_t child = fork();
    if (!child)
        run(ends[1], ends[0], ignored, argv + 2 + ignored);
    close(ends[1]);
    for (long long left = atoll(argv[1]); left > 0;) {
        ssize_t n = read(ends[0], bytes, left < (long long)sizeof bytes ? (size_t)left : sizeof bytes);
        if (n <= 0 && errno != EINTR)
            break;
        left -= n > 0 ? n : 0;
        if (!n)
            break;
    }
    close(ends[0]);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (WIFSIGNALED(status))
        printf("signal %d\n", WTERMSIG(status));
    else
        printf("exit %d\n", WEXITSTATUS(status));
    return 0;
}
