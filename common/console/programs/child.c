#include "console/programs/child.h"

#include "base/clock.h"
#include "base/thread.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

/* ---- where a tool lies */

static bool is_at(const char *folder, size_t n, const char *tool, char path[CHILD_PATH])
{
    const int size = snprintf(path, CHILD_PATH, "%.*s/%s", (int)n, folder, tool);
    return n && size < CHILD_PATH && !access(path, X_OK);
}

int child_find(const char *tool, char path[CHILD_PATH], err *e)
{
    char own[PATH_MAX];
    const ssize_t n = readlink("/proc/self/exe", own, sizeof own - 1);
    own[n > 0 ? n : 0] = '\0';
    const char *slash = strrchr(own, '/'), *list = getenv("PATH");
    if (slash && is_at(own, (size_t)(slash - own), tool, path))
        return 0;
    for (const char *p = list; p && *p; p += strcspn(p, ":"), p += *p == ':')
        if (is_at(p, strcspn(p, ":"), tool, path))
            return 0;
    return err_set(e, tool, 0, "there is no such tool beside sinew-console, nor on PATH");
}

/* ---- starting */

/* Descriptors that the child takes over, none below the four that they become. */
typedef struct ends {
    int in, out, errors, control;            /* the child's */
    int out_here, errors_here, control_here; /* ours */
} ends;

static void close_one(int *fd)
{
    if (*fd >= 0)
        close(*fd);
    *fd = -1;
}

static void close_theirs(ends *x)
{
    close_one(&x->in);
    close_one(&x->out);
    close_one(&x->errors);
    close_one(&x->control);
}

static void close_ours(ends *x)
{
    close_one(&x->out_here);
    close_one(&x->errors_here);
    close_one(&x->control_here);
}

/* Moves a descriptor up, out of the way of those that a child has. */
static int move_up(int fd)
{
    enum { LEAST = 10 };
    const int moved = fd < 0 ? -1 : fcntl(fd, F_DUPFD_CLOEXEC, LEAST);
    const int code = errno;
    if (fd >= 0)
        close(fd);
    errno = code;
    return moved;
}

static int make_pipe(int *reads, int *writes)
{
    int fd[2];
    if (pipe(fd))
        return -1;
    *reads = move_up(fd[0]);
    *writes = move_up(fd[1]);
    return *reads < 0 || *writes < 0 ? -1 : 0;
}

static int make_ends(ends *x, int in, err *e)
{
    *x = (ends){-1, -1, -1, -1, -1, -1, -1};
    x->in = move_up(in >= 0 ? in : open("/dev/null", O_RDONLY | O_CLOEXEC));
    if (x->in < 0 || make_pipe(&x->out_here, &x->out) || make_pipe(&x->errors_here, &x->errors) ||
        make_pipe(&x->control, &x->control_here) || fcntl(x->control_here, F_SETFL, O_NONBLOCK))
        return err_system(e, "a tool", errno, "cannot make its pipes");
    return 0;
}

/* In the child: only what a signal's handler may call, as other threads were running. */
static void become(const ends *x, pid_t parent, const char *path, char *const *argv)
{
    static const int handled[] = {SIGINT, SIGTERM, SIGPIPE, SIGCHLD, SIGXFSZ, SIGHUP, SIGQUIT};
    const int from[4] = {x->in, x->out, x->errors, x->control};
    sigset_t none;
    setpgid(0, 0);
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) || getppid() != parent)
        _exit(127);
    for (size_t i = 0; i < sizeof handled / sizeof *handled; i++)
        signal(handled[i], SIG_DFL);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    for (int i = 0; i < 4; i++)
        if (dup2(from[i], i) < 0)
            _exit(127);
    closefrom(4);
    execv(path, argv);
    _exit(127);
}

static void *listen_to(void *context)
{
    child *c = context;
    FILE *lines = fdopen(c->errors, "r");
    char line[CHILD_SAID];
    if (!lines) {
        close(c->errors);
        return NULL;
    }
    while (fgets(line, sizeof line, lines)) {
        line[strcspn(line, "\n")] = '\0';
        if (*line)
            c->plan.said(c->plan.context, c->plan.tool, line);
    }
    fclose(lines);
    return NULL;
}

static int start(child *c, ends *x, const char *path, err *e)
{
    const pid_t parent = getpid();
    c->pid = fork();
    if (!c->pid)
        become(x, parent, path, c->plan.argv);
    if (c->pid < 0) {
        c->pid = 0;
        return err_system(e, c->plan.tool, errno, "cannot start it");
    }
    setpgid(c->pid, c->pid); /* whoever of the two is first; the other fails, or does it again */
    c->out = x->out_here;
    c->errors = x->errors_here;
    c->control = x->control_here;
    x->out_here = x->errors_here = x->control_here = -1;
    const int code = thread_start(&c->listener, listen_to, c);
    c->listens = !code;
    if (!code)
        return 0;
    close(c->errors);
    child_end(c, 0);
    close_one(&c->out);
    return err_system(e, c->plan.tool, code, "cannot start a thread");
}

int child_start(child *c, const child_plan *plan, err *e)
{
    char path[CHILD_PATH];
    ends x;
    *c = (child){.plan = *plan, .out = -1, .control = -1, .errors = -1};
    if (child_find(plan->tool, path, e)) {
        if (plan->in >= 0)
            close(plan->in);
        return -1;
    }
    const int failed = make_ends(&x, plan->in, e) || start(c, &x, path, e) ? -1 : 0;
    close_theirs(&x);
    close_ours(&x);
    return failed;
}

/* ---- telling, ending */

int child_tell(child *c, const char *line, err *e)
{
    char text[PIPE_BUF + 1]; /* what a pipe takes whole */
    const int n = snprintf(text, sizeof text, "%s\n", line);
    if (n >= (int)sizeof text)
        return err_set(e, NULL, 0, "a line of %d bytes for %s; expected at most %d", n, c->plan.tool, PIPE_BUF);
    if (!c->pid || c->control < 0)
        return 0;
    if (write(c->control, text, (size_t)n) == n) {
        c->stuck = false;
        return 0;
    }
    if (c->stuck || errno == EPIPE) /* its end is told elsewhere */
        return 0;
    c->stuck = true;
    return err_set(e, NULL, 0, "%s does not read its lines; '%.60s' and what follows is lost until it does",
                   c->plan.tool, line);
}

bool child_has_ended(child *c)
{
    if (!c->pid)
        return true;
    const pid_t got = waitpid(c->pid, &c->status, WNOHANG);
    if (got == 0 || (got < 0 && errno == EINTR))
        return false;
    c->pid = 0;
    return true;
}

void child_how(const child *c, char *to, size_t size)
{
    if (WIFSIGNALED(c->status))
        snprintf(to, size, "was killed by signal %d", WTERMSIG(c->status));
    else
        snprintf(to, size, "ended with status %d", WEXITSTATUS(c->status));
}

void child_pause(const child *c, bool on)
{
    if (c->pid)
        kill(c->pid, on ? SIGSTOP : SIGCONT);
}

void child_ask(const child *c)
{
    if (!c->pid)
        return;
    kill(c->pid, SIGTERM);
    kill(c->pid, SIGCONT);
}

void child_end(child *c, double seconds)
{
    const double until = clock_now() + seconds;
    while (!child_has_ended(c) && clock_now() < until)
        clock_sleep(.005);
    if (c->pid) {
        kill(c->pid, SIGKILL);
        while (waitpid(c->pid, &c->status, 0) < 0 && errno == EINTR)
            ;
        c->pid = 0;
    }
    if (c->listens)
        pthread_join(c->listener, NULL);
    c->listens = false;
    if (c->plan.tool) /* of a zeroed child it is 0 */
        close_one(&c->control);
}
