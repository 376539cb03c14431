/* A process that is told to end removes the files that it noted, and still ends by the signal: whichever thread gets
 * it, and whenever. */
#include "base/temporary.h"

#include "tap.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static int make(const void *context, const char *path)
{
    (void)context;
    return open(path, O_WRONLY | O_CREAT | O_EXCL, 0600);
}

/* A signal comes when the file is there, and not noted yet. */
static int make_and_raise(const void *context, const char *path)
{
    const int fd = make(NULL, path);
    kill(getpid(), *(const int *)context);
    return fd;
}

/* A child notes three files, drops one and gets the signal: after that, or as the last of them is made. */
static int child(char path[3][64], int number, bool within)
{
    err e = {0};
    alarm(180);
    for (int i = 0; i < 3; i++)
        temporary_make(path[i], make, NULL, &e);
    temporary_drop(path[1]);
    if (within) {
        unlink(path[2]);
        temporary_make(path[2], make_and_raise, &number, &e);
    } else {
        raise(number);
    }
    return 1;
}

static void ended_by(const char *folder, int number, bool within)
{
    char path[3][64];
    int status = 0;
    for (int i = 0; i < 3; i++)
        snprintf(path[i], sizeof path[i], "%s/%d", folder, i);
    pid_t pid = fork();
    if (!pid)
        _exit(child(path, number, within));
    ok(waitpid(pid, &status, 0) == pid && WIFSIGNALED(status) && WTERMSIG(status) == number, "ends by signal %d%s",
       number, within ? ", within the making of a file" : "");
    ok(access(path[0], F_OK) && access(path[2], F_OK), "what was noted is gone");
    ok(!access(path[1], F_OK), "what was dropped stays");
    unlink(path[1]);
}

static void *wait_for_ever(void *unused)
{
    for (;;)
        pause();
    return unused;
}

/* Files come and go in one thread, while another takes the signal. */
static void by_another(const char *folder)
{
    char path[64];
    int status = 0;
    snprintf(path, sizeof path, "%s/file", folder);
    fflush(stdout);
    pid_t pid = fork();
    if (!pid) {
        sigset_t all, before;
        pthread_t thread;
        err e = {0};
        alarm(180);
        pthread_create(&thread, NULL, wait_for_ever, NULL);
        sigfillset(&all);
        pthread_sigmask(SIG_BLOCK, &all, &before);
        for (;;) {
            temporary_make(path, make, NULL, &e);
            unlink(path);
            temporary_drop(path);
        }
    }
    usleep(2000);
    kill(pid, SIGTERM);
    ok(waitpid(pid, &status, 0) == pid && WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM && access(path, F_OK),
       "a signal to another thread");
    unlink(path);
}

int main(void)
{
    char folder[] = "/tmp/sinew-temporary-XXXXXX";
    if (!mkdtemp(folder))
        return 1;
    const int ends[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGXFSZ, SIGALRM, SIGUSR1, SIGPIPE};
    for (int i = 0; i < (int)(sizeof ends / sizeof *ends); i++) {
        signal(ends[i], SIG_DFL);
        ended_by(folder, ends[i], false);
        ended_by(folder, ends[i], true);
    }
    for (int i = 0; i < 8; i++)
        by_another(folder);
    err e = {0};
    char path[64];
    snprintf(path, sizeof path, "%s/none/file", folder);
    ok(temporary_make(path, make, NULL, &e) == -1 && errno == ENOENT && !e.status, "what cannot be made is not noted");
    ok(!rmdir(folder), "nothing is left");
    return done_testing();
}
