/* Outputs that fail late: what stood under the name stays, and nothing is left beside it. This program's fsync, close,
 * rename, open and linkat are its own, so that each can fail; all is tried where files need no name, where they do, and
 * where what has none gets none.
 */
#define _GNU_SOURCE /* O_TMPFILE */
#include "base/out.h"
#include "base/temporary.h"
#include "cli/outs.h"
#include "live/growing.h"

#include "tap.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

/* The call that is to fail next; an object that must change, as the tests are told by no other way. */
static enum { NONE, FSYNC, CLOSE, RENAME, FOLDER } failing;
static int synced, named; /* files, folders */
static ino_t last_named;

/* What the file system is like: has files without a name; or not; or gives them none. */
static enum { NAMELESS, NAMED, UNLINKED, LIKES } like;
static int nameless, linked;

static const char *taken_over; /* the name that another process's file gets just before a lock is had */

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

/* NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name) */
int open(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    const mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(more, mode_t) : 0;
    va_end(more);
    const bool without = (flags & O_TMPFILE) == O_TMPFILE;
    if (without && like == NAMED) {
        errno = EOPNOTSUPP;
        return -1;
    }
    nameless += without;
    return openat(AT_FDCWD, path, flags, mode);
}

/* NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): the C library's names are its own */
int flock(int fd, int how)
{
    if (taken_over) {
        unlink(taken_over);
        syscall(SYS_close, openat(AT_FDCWD, taken_over, O_CREAT | O_EXCL | O_RDWR, 0600));
        taken_over = NULL;
    }
    return (int)syscall(SYS_flock, fd, how);
}

/* NOLINTNEXTLINE(readability-inconsistent-declaration-parameter-name): the C library's names are its own */
int linkat(int from_folder, const char *from, int to_folder, const char *to, int flags)
{
    errno = EPERM;
    linked++;
    return like == UNLINKED ? -1 : (int)syscall(SYS_linkat, from_folder, from, to_folder, to, flags);
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
    ok(synced == (like == UNLINKED ? 2 : 1) && named == 1,
       "what is written is known to be stored before it is renamed, and then its name");
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
    ok(!outs_commit(&all, &e) && synced == (like == UNLINKED ? 10 : 5) && named == 2,
       "and the names of two folders once");
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

/* The name of a file of a process; ours is the like of it. */
static const char *name_of(char name[TEMPORARY_NAME], pid_t pid, long long number)
{
    char host[9];
    temporary_name(name);
    snprintf(host, sizeof host, "%.8s", name + strlen(".sinew-"));
    snprintf(name, TEMPORARY_NAME, ".sinew-%s-%ld-%lld.tmp", host, (long)pid, number);
    return name;
}

/* The number after those that the three names to come take themselves. */
static long long next_number(void)
{
    char name[TEMPORARY_NAME];
    temporary_name(name);
    return atoll(strrchr(name, '-') + 1) + 4;
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
    put("file", "old");
    const long long next = next_number();
    for (int i = 0; i < 3; i++)
        fclose(fopen(name_of(taken, getpid(), next + i), "w"));
    put("file", "x");
    ok(holds("file", "x") && files_here() == 4, "names that are taken are passed by");
    for (int i = 0; i < 3; i++)
        unlink(name_of(taken, getpid(), next + i));
    unlink("file");
}

/* The pid of a process that is gone. */
static pid_t gone(void)
{
    const pid_t child = fork();
    if (!child)
        _exit(0);
    waitpid(child, NULL, 0);
    return child;
}

static bool is_there(const char *path)
{
    struct stat s;
    return !lstat(path, &s);
}

/* Whether a file can be locked by someone who opens it. */
static bool is_free(const char *path)
{
    const int fd = openat(AT_FDCWD, path, O_RDWR | O_CLOEXEC);
    const bool is = fd >= 0 && !flock(fd, LOCK_EX | LOCK_NB);
    ok(fd >= 0 && (is || errno == EWOULDBLOCK), "%s is there", path);
    close(fd);
    return is;
}

/* The one temporary file here. */
static bool find_temporary(char name[256])
{
    int n = 0;
    DIR *d = opendir(".");
    for (struct dirent *f; d && (f = readdir(d));)
        if (!strncmp(f->d_name, ".sinew-", 7) && !n++)
            snprintf(name, 256, "%s", f->d_name);
    if (d)
        closedir(d);
    return n == 1;
}

/* A file with a name is locked while it is written: that, and no pid, is what a sweep from elsewhere sees of it. */
static void locks(void)
{
    err e = {0};
    char name[256] = "";
    if (like != NAMED)
        return;
    out *o = out_open("file", false, &e);
    ok(o && find_temporary(name) && !is_free(name), "a file that is written is locked: %s", name);
    out_close(o, &e);
    ok(!e.status && !find_temporary(name), "until it is in its place");
    unlink("file");
}

/* What another user's process left is another user's. */
static void others(const char *here)
{
    char left[TEMPORARY_NAME];
    if (geteuid()) {
        skip(1, "not root: no file can be another user's");
        rmdir("others");
        return;
    }
    ok(!chdir("others"), "a folder that was not swept before");
    fclose(fopen(name_of(left, gone(), 7), "w"));
    ok(!chown(left, 65534, 65534), "a file of another user's");
    like = NAMED;
    put("file", "x");
    ok(is_there(left), "stays, though its process is gone");
    ok(!chown(left, 0, 0) && !unlink(left) && !unlink("file") && !chdir(here) && !rmdir("others"), "and that is all");
}

/* The name went to another file between the sweep's opening what it saw and locking that. */
static void taken(const char *here)
{
    char left[TEMPORARY_NAME];
    ok(!chdir("taken"), "a folder that was not swept before");
    fclose(fopen(name_of(left, gone(), 7), "w"));
    taken_over = left;
    temporary_sweep("");
    ok(!taken_over && is_there(left), "another file that has the name now stays");
    ok(!unlink(left) && !chdir(here) && !rmdir("taken"), "and that is all");
}

/* What processes left that were killed goes when the next one makes such a file there; nothing else does. */
static void sweeps(const char *here, const char *folder)
{
    char left[TEMPORARY_NAME], alive[TEMPORARY_NAME], locked[TEMPORARY_NAME], link[TEMPORARY_NAME];
    char other[TEMPORARY_NAME] = ".sinew-00000000-", longer[TEMPORARY_NAME + 1];
    const pid_t pid = gone();
    ok(!chdir(folder), "a folder that was not swept before");
    fclose(fopen(name_of(left, pid, 7), "w"));
    fclose(fopen(name_of(alive, getppid(), 7), "w"));
    const int fd = openat(AT_FDCWD, name_of(locked, pid, 8), O_CREAT | O_RDWR, 0600);
    ok(fd >= 0 && !flock(fd, LOCK_EX), "a file that is locked");
    ok(!symlink("nowhere", name_of(link, pid, 9)), "a link");
    snprintf(other + 16, sizeof other - 16, "%s", left + 16);
    fclose(fopen(other, "w"));
    snprintf(longer, sizeof longer, "%sx", left);
    fclose(fopen(longer, "w"));
    put("file", "old"); /* the first may need no name */
    put("file", "new");
    ok(!is_there(left), "what a process left that is gone goes");
    ok(is_there(alive) && is_there(locked) && is_there(link) && is_there(other) && is_there(longer) &&
           files_here() == 6,
       "what is alive, locked, a link, another host's or none of ours stays");
    close(fd);
    const char *const all[] = {"file", alive, locked, link, other, longer};
    for (int i = 0; i < 6; i++)
        unlink(all[i]);
    ok(!chdir("..") && !rmdir(folder) && !chdir(here), "and that is all");
}

/* More files at once than there are descriptors: some wait under a name. */
static void scarce(void)
{
    enum { COUNT = 40 };
    char name[16];
    outs all = {.most = 10};
    err e = {0};
    int good = 0;
    for (int i = 0; i < COUNT; i++) {
        snprintf(name, sizeof name, "f%d", i);
        if (i == 17)
            put(name, "old");
        out *o = outs_open(&all, name, &e);
        good += o && (out_text(o, name), !out_close(o, &e));
    }
    const int left = like == NAMELESS || like == UNLINKED ? COUNT - 10 : COUNT;
    ok(good == COUNT && files_here() == left + 1, "%d files %s, %d names", good, e.text, files_here());
    ok(!outs_commit(&all, &e) && files_here() == COUNT, "all take their places %s", e.text);
    outs_free(&all);
    for (int i = 0; i < COUNT; i++) {
        snprintf(name, sizeof name, "f%d", i);
        good -= holds(name, name);
        unlink(name);
    }
    ok(!good && !files_here(), "each has what was written to it");
}

/* A new file goes to its place without another name, and keeps to umask; one that is replaced hands its permissions
 * on. */
static void modes(void)
{
    struct stat s;
    const mode_t before = umask(027);
    const int was = linked;
    put("file", "x");
    ok(!stat("file", &s) && (s.st_mode & 07777) == 0640, "a new file's permissions");
    const int links = like == NAMED ? 0 : 2;
    ok(linked - was == (like == NAMELESS ? 1 : links), "%d links", linked - was);
    ok(!chmod("file", 0604), "others");
    put("file", "y");
    ok(!stat("file", &s) && (s.st_mode & 07777) == 0604 && holds("file", "y"), "are kept");
    umask(before);
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
        alarm(180); /* it ends by this where it hangs */
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

static void all_of_it(void)
{
    late_failures();
    names();
    links();
    modes();
    scarce();
    mkdir("folder", 0700);
    together();
    grows();
    chmod(".", 0711);
    unreadable();
    rmdir("folder");
}

int main(void)
{
    static const char *const work[] = {"nameless", "named", "unlinked"}, *const swept[] = {"swept0", "swept1",
                                                                                           "swept2"};
    char folder[] = "/tmp/sinew-replace-XXXXXX";
    if (!mkdtemp(folder) || chdir(folder))
        return 1;
    for (int i = 0; i < LIKES; i++) /* at first: a folder that is swept is known by its inode */
        ok(!mkdir(work[i], 0700) && !mkdir(swept[i], 0700), "folders");
    ok(!mkdir("others", 0700) && !mkdir("taken", 0700), "folders");
    const int fd = open(".", O_TMPFILE | O_RDWR, 0600);
    const bool can = fd >= 0;
    close(fd);
    chmod(".", 0711);
    for (int i = 0; i < LIKES; i++) {
        like = can ? i : NAMED;
        nameless = synced = named = 0;
        ok(!chdir(work[i]), "%s", work[i]);
        all_of_it();
        ok(!chdir(".."), "back");
        locks();
        sweeps(folder, swept[i]);
        ok(like == NAMED ? !nameless : nameless > 50, "%d files without a name", nameless);
        ok(!rmdir(work[i]), "nothing is left");
    }
    others(folder);
    taken(folder);
    if (!can)
        skip(1, "no files without a name here");
    ok(!chdir("/") && !rmdir(folder), "the folder is empty");
    ok(at_closed_pipe(as_it_is) == SIGPIPE, "a closed pipe ends the process by SIGPIPE");
    ok(at_closed_pipe(ignored) == SIGPIPE, "where SIGPIPE was ignored, too");
    ok(at_closed_pipe(blocked) == SIGPIPE, "and where it was blocked");
    return done_testing();
}
