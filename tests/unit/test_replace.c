/* Outputs that fail late: what stood under the name stays, and nothing is left beside it. This program's fsync, close and
 * rename are its own, so that each can fail.
 */
#include "base/growing.h"
#include "base/out.h"
#include "base/outs.h"

#include "tap.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

/* The call that is to fail next; an object that must change, as the tests are told by no other way. */
static enum { NONE, FSYNC, CLOSE, RENAME, FOLDER } failing;
static int synced, named; /* files, folders */
static ino_t last_named;

int fsync(int fd)
{
    struct stat s;
    const bool folder = !fstat(fd, &s) && S_ISDIR(s.st_mode);
    *(folder ? &named : &synced) += 1;
    last_named = folder ? s.st_ino : last_named;
    errno = ENOSPC;
    return failing == (folder ? FOLDER : FSYNC) ? -1 : 0;
}

int close(int fd)
{
    int status = (int)syscall(SYS_close, fd);
    errno = status ? errno : EDQUOT;
    return failing == CLOSE ? -1 : status;
}

/* NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): the C library's names are its own */
int rename(const char *from, const char *to)
{
    errno = EACCES;
    return failing == RENAME ? -1 : renameat(AT_FDCWD, from, AT_FDCWD, to);
}

static int files_here(void)
{
    DIR *d = opendir(".");
    int n = 0;
    for (struct dirent *f; d && (f = readdir(d));)
        n += strcmp(f->d_name, ".") && strcmp(f->d_name, "..");
    if (d)
        closedir(d);
    return n;
}

static void put(const char *path, const char *text)
{
    err e = {0};
    out *o = out_open(path, false, &e);
    if (o)
        out_text(o, text);
    ok(o && !out_close(o, &e), "%s is written %s", strlen(path) < 40 ? path : "a long name", e.text);
}

static bool holds(const char *path, const char *text)
{
    char got[64] = {0};
    FILE *f = fopen(path, "r");
    if (!f)
        return false;
    size_t n = fread(got, 1, sizeof got - 1, f);
    fclose(f);
    return n == strlen(text) && !strcmp(got, text);
}

static void late_failures(void)
{
    static const char *const name[] = {"", "fsync", "close", "rename"};
    static const char *const want[] = {"", "cannot write: No space left", "cannot write: Disk quota exceeded",
                                       "cannot rename into place: Permission denied"};
    put("file", "old");
    ok(synced == 1 && named == 1, "what is written is known to be stored before it is renamed, and then its name");
    int before = files_here();
    for (int which = FSYNC; which <= RENAME; which++) {
        err e = {0};
        out *o = out_open("file", false, &e);
        if (o)
            out_text(o, "new");
        failing = which;
        bool failed = o && out_close(o, &e) == -1;
        failing = NONE;
        ok(failed && strstr(e.text, want[which]), "%s fails: %s", name[which], e.text);
        ok(holds("file", "old") && files_here() == before, "the old file stays, alone");
    }
    err e = {0};
    out *o = out_open("file", false, &e);
    out_text(o, "new");
    failing = FOLDER;
    ok(out_close(o, &e) == -1 && strstr(e.text, "file: is there, but its folder cannot be stored: No space left"),
       "a name that is not stored is told of: %s", e.text);
    failing = NONE;
    ok(holds("file", "new") && files_here() == before, "what it is of is whole");
    unlink("file");
}

/* Of many files that appear together the folder is stored once. */
static void together(void)
{
    static const char *const path[] = {"a", "b", "c", "folder/a", "folder/b"};
    outs all = {0};
    err e = {0};
    synced = named = 0;
    for (int i = 0; i < 5; i++) {
        out *o = outs_open(&all, path[i], &e);
        ok(o && (out_text(o, "x"), !out_close(o, &e)), "one of some files %s", e.text);
    }
    ok(synced == 5 && !named, "each is stored");
    ok(!outs_commit(&all, &e) && synced == 5 && named == 2, "and the names of two folders once");
    outs_free(&all);
    ok(holds("a", "x") && holds("folder/b", "x"), "all are there");
    for (int i = 0; i < 5; i++)
        unlink(path[i]);
}

/* A log by a link: its name stands in another folder, which is stored, once. */
static void grows(void)
{
    struct stat s;
    err e = {0};
    synced = named = 0;
    ok(!symlink("folder/log", "link"), "a link");
    growing *g = growing_open("link", 0, &e);
    ok(g && !growing_put(g, "x\n", 2, &e) && !growing_store(g, &e) && !growing_put(g, "y\n", 2, &e) &&
           !growing_store(g, &e) && synced == 2,
       "a log is stored %s", e.text);
    ok(named == 1 && !stat("folder", &s) && last_named == s.st_ino, "its name where it is");
    ok(!growing_close(g, &e) && holds("folder/log", "x\ny\n"), "and it is there");
    unlink("link");
    unlink("folder/log");
}

/* A folder that takes names but may not be read, to whoever this is: root may read all. */
static void unreadable(void)
{
    const bool root = !geteuid();
    ok(!chmod("folder", 0333), "a folder that may not be read");
    if (root && seteuid(65534)) {
        skip(2, "nobody else to be");
        return;
    }
    put("folder/file", "x");
    ok((!root || !seteuid(0)) && !chmod("folder", 0700) && holds("folder/file", "x"), "it takes a file");
    unlink("folder/file");
}

static void names(void)
{
    char longest[256], too_long[257], taken[64];
    memset(longest, 'n', 255);
    memset(too_long, 'n', 256);
    longest[255] = too_long[256] = 0;
    put(longest, "x");
    ok(holds(longest, "x"), "a name as long as names may be");
    unlink(longest);

    err e = {0};
    ok(!out_open(too_long, false, &e) && strstr(e.text, "File name too long"), "a longer one is refused at once");
    e = (err){0};
    ok(!out_open("new/", false, &e) && strstr(e.text, "Is a directory"), "so is a folder's: %s", e.text);

    /* What a killed process of the same number left. */
    for (int i = 0; i < 3; i++) {
        snprintf(taken, sizeof taken, ".sinew-%ld-%d.tmp", (long)getpid(), i);
        fclose(fopen(taken, "w"));
    }
    put("file", "x");
    ok(holds("file", "x") && files_here() == 4, "names that are taken are passed by");
    for (int i = 0; i < 3; i++) {
        snprintf(taken, sizeof taken, ".sinew-%ld-%d.tmp", (long)getpid(), i);
        unlink(taken);
    }
    unlink("file");
}

static void links(void)
{
    struct stat s;
    mkdir("folder", 0700);
    ok(!symlink("folder/there", "link") && !symlink("link", "link2") && !symlink("loop", "loop"), "links");
    put("link2", "x");
    ok(holds("folder/there", "x") && !lstat("link2", &s) && S_ISLNK(s.st_mode) && !lstat("link", &s) &&
           S_ISLNK(s.st_mode),
       "a link to nothing stays a link: what it names is made");
    put("link2", "y");
    ok(holds("folder/there", "y"), "and then replaced");
    err e = {0};
    ok(!out_open("loop", false, &e) && strstr(e.text, "Too many levels"), "a loop of links: %s", e.text);
    unlink("folder/there");
    rmdir("folder");
    e = (err){0};
    ok(!out_open("link", false, &e) && strstr(e.text, "No such file"), "a link to no folder: %s", e.text);
    unlink("link");
    unlink("link2");
    unlink("loop");
    ok(!files_here(), "nothing is left");
}

/* How a process ends that writes to a pipe that nobody reads. */
static int at_closed_pipe(void (*before)(void))
{
    int pipes[2], status = 0;
    if (pipe(pipes))
        return -1;
    syscall(SYS_close, pipes[0]);
    fflush(stdout);
    pid_t child = fork();
    if (!child) {
        err e = {0};
        alarm(20); /* it ends by this where it hangs */
        before();
        dup2(pipes[1], STDOUT_FILENO);
        out *o = out_open(NULL, false, &e);
        out_text(o, "x");
        _exit(out_close(o, &e) ? 1 : 0);
    }
    syscall(SYS_close, pipes[1]);
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) ? WTERMSIG(status) : -1;
}

static void as_it_is(void)
{
}

static void ignored(void)
{
    signal(SIGPIPE, SIG_IGN);
}

static void blocked(void)
{
    sigset_t only;
    sigemptyset(&only);
    sigaddset(&only, SIGPIPE);
    sigprocmask(SIG_BLOCK, &only, NULL);
}

int main(void)
{
    char folder[] = "/tmp/sinew-replace-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder))
        return 1;
    late_failures();
    names();
    links();
    mkdir("folder", 0700);
    together();
    grows();
    chmod(".", 0711);
    unreadable();
    rmdir("folder");
    ok(!chdir("/") && !rmdir(folder), "the folder is empty");
    ok(at_closed_pipe(as_it_is) == SIGPIPE, "a closed pipe ends the process by SIGPIPE");
    ok(at_closed_pipe(ignored) == SIGPIPE, "where SIGPIPE was ignored, too");
    ok(at_closed_pipe(blocked) == SIGPIPE, "and where it was blocked");
    return done_testing();
}
