/* A process that is told to end removes the files that it noted, and still ends by the signal. */
#include "base/temporary.h"

#include "tap.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

static void touch(const char *path)
{
    close(open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600));
}

/* A child notes three files, drops one and gets the signal. */
static int child(char path[3][64], int number)
{
    err e = {0};
    for (int i = 0; i < 3; i++) {
        touch(path[i]);
        temporary_add(path[i], &e);
    }
    temporary_drop(path[1]);
    raise(number);
    return 1;
}

static void ended_by(const char *folder, int number)
{
    char path[3][64];
    int status = 0;
    for (int i = 0; i < 3; i++)
        snprintf(path[i], sizeof path[i], "%s/%d", folder, i);
    pid_t pid = fork();
    if (!pid)
        _exit(child(path, number));
    ok(waitpid(pid, &status, 0) == pid && WIFSIGNALED(status) && WTERMSIG(status) == number, "ends by signal %d",
       number);
    ok(access(path[0], F_OK) && access(path[2], F_OK), "what was noted is gone");
    ok(!access(path[1], F_OK), "what was dropped stays");
    unlink(path[1]);
}

int main(void)
{
    char folder[] = "/tmp/sinew-temporary-XXXXXX";
    if (!mkdtemp(folder))
        return 1;
    const int ends[] = {SIGINT, SIGTERM, SIGHUP};
    for (int i = 0; i < 3; i++) {
        signal(ends[i], SIG_DFL);
        ended_by(folder, ends[i]);
    }
    rmdir(folder);
    return done_testing();
}
