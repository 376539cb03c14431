/* Poses: TUM lines, changes of method, what is refused and where; frames of PLUS sequences, composed, turned from an
 * image's frame to the probe's, left out where they were not tracked.
 */
#include "probe/poses.h"

#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Reads all events of a text into list; returns how many, or -1 with e filled. */
static int read_with(const char *text, const char *transform, poses_event *list, int most, int64_t *skipped, err *e)
{
    poses p = {0};
    int count = 0, more = -1;
    in *s = in_memory(text, strlen(text), "p", e);
    if (s && !poses_open(&p, s, transform, e))
        while ((more = poses_next(&p, &list[count < most ? count : most - 1], e)) > 0)
            count++;
    if (skipped)
        *skipped = p.frames.skipped;
    in_close(s);
    return more < 0 ? -1 : count;
}

static int read_all(const char *text, poses_event *list, int most, err *e)
{
    return read_with(text, NULL, list, most, NULL, e);
}

static void lines(void)
{
    poses_event v[8];
    err e = {0};
    double r[9];
    int n = read_all("# time tx ty tz qx qy qz qw\n\n0 1 2 3 0 0 0 1\nmethod msds # now\n"
                     "0.5 0 0 0 0.7071 0 0 0.7071\r\nmethod fem\n5e-1 0 0 0 0 0 0 -1",
                     v, 8, &e);
    ok(n == 5, "five events, the last line without its end: %d %s", n, e.text);
    ok(v[0].kind == POSES_POSE && v[1].kind == POSES_CONTROL && v[3].kind == POSES_CONTROL && v[4].kind == POSES_POSE,
       "poses, and controls between them");
    ok(v[0].line == 3 && v[0].time == 0 && v[0].at.position[2] == 3 && v[0].at.quaternion[3] == 1,
       "a pose, and its line");
    near_(v[2].at.quaternion[0] * v[2].at.quaternion[0] + v[2].at.quaternion[3] * v[2].at.quaternion[3], 1, 1e-15,
          "a quaternion is made of length 1");
    pose_matrix(v[2].at.quaternion, r);
    near_(r[5], -1, 1e-12, "a quarter turn about x takes z to -y");
    near_(r[7], 1, 1e-12, "and y to z");
    ok(v[4].time == .5, "two poses may be of one time");
    ok(read_all("", v, 8, &e) == 0 && read_all("# no more\n", v, 8, &e) == 0, "no pose is no error here");
}

static void refuse(const char *text, const char *want)
{
    poses_event v[8];
    err e = {0};
    int n = read_all(text, v, 8, &e);
    ok(n == -1 && strstr(e.text, want), "%s", e.text[0] ? e.text : text);
}

static void refused_lines(void)
{
    refuse("0 0 0 0 0 0 0 1\n1 nan 0 0 0 0 0 1\n", "p:2: 'nan' is not a finite number");
    refuse("0 inf 0 0 0 0 0 1\n", "p:1: 'inf' is not a finite number");
    refuse("0 1e999 0 0 0 0 0 1\n", "p:1: '1e999' is not a finite number");
    refuse("0 0 0 0 0 0 0 0\n", "p:1: a quaternion of length 0; expected 1, to within 0.01");
    refuse("0 0 0 0 0 0 0.2 1\n", "p:1: a quaternion of length 1.0198");
    refuse("0 0 0 0 1e300 1e300 0 1\n", "p:1: a quaternion of length inf");
    refuse("1 0 0 0 0 0 0 1\n\n0.5 0 0 0 0 0 0 1\n",
           "p:3: time 0.5 comes after 1; expected times that do not decrease");
    refuse("1 0 0 0 0 0 0\n", "p:1: 7 words");
    refuse("1 0 0 0 0 0 0 1 2\n", "p:1: 9 words");
    refuse("1,0,0,0,0,0,0,1\n", "p:1: 1 words");
    refuse("0 0 0 0 0 0 0 1\n0 0 0\001 0 0 0 1\n", "p:2: control character 0x01");
}

/* A header of two images of 5 columns: identity and a transform, in mm. */
#define HEAD    "ObjectType = Image\nNDims = 3\nDimSize = 5 4 2\n"
#define TAIL    "ElementDataFile = LOCAL\n\001\002 not text"
#define UNIT    "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"
#define QUARTER "0 -2 0 10 2 0 0 20 0 0 2 30 0 0 0 1" /* x to y, y to -x, pixels of 2 mm */

static void sequence(void)
{
    static const char text[] =
        HEAD "Seq_Frame0000_ImageToReferenceTransform = " UNIT "\nSeq_Frame0000_ImageToReferenceTransformStatus = OK\n"
             "Seq_Frame0000_Timestamp = 1.5\nSeq_Frame0000_ImageStatus = OK\n"
             "Seq_Frame0001_ImageToReferenceTransform = " QUARTER "\nSeq_Frame0001_Timestamp = 2\n" TAIL;
    poses_event v[4];
    err e = {0};
    double r[9];
    int n = read_all(text, v, 4, &e);
    ok(n == 2, "a sequence of two frames %s", e.text);
    ok(v[0].kind == POSES_POSE && v[0].time == 1.5 && v[1].time == 2, "their times");
    near_(v[0].at.position[0], .002, 1e-15, "the middle of the first row of pixels, in m");
    near_(v[0].at.position[1], 0, 0, "its first row");
    pose_matrix(v[0].at.quaternion, r);
    ok(fabs(r[0] - 1) < 1e-15 && fabs(r[5] - 1) < 1e-15 && fabs(r[7] + 1) < 1e-15,
       "+x along the columns, +z down the rows, +y against the normal");
    near_(v[1].at.position[0], .010, 1e-15, "the second: moved,");
    near_(v[1].at.position[1], .024, 1e-15, "and turned, with pixels of 2 mm");
    pose_matrix(v[1].at.quaternion, r);
    ok(fabs(r[3] - 1) < 1e-12 && fabs(r[2] + 1) < 1e-12, "its columns run along y, its depth along -x");
}

static void composed(void)
{
    static const char text[] =
        HEAD "Seq_Frame0007_ProbeToTrackerTransform = 1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n"
             "Seq_Frame0007_ReferenceToTrackerTransform = 0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1\n"
             "Seq_Frame0007_Timestamp = 1\nSeq_Frame0008_ProbeToTrackerTransform = " UNIT "\n"
             "Seq_Frame0008_ProbeToTrackerTransformStatus = INVALID\n"
             "Seq_Frame0008_ReferenceToTrackerTransform = " UNIT "\nSeq_Frame0008_Timestamp = 2\n"
             "Seq_Frame0009_ProbeToTrackerTransform = " UNIT "\nSeq_Frame0009_ReferenceToTrackerTransform = " UNIT "\n"
             "Seq_Frame0009_ProbeToTrackerTransformStatus = OK\nSeq_Frame0009_Timestamp = 3\n" TAIL;
    poses_event v[4];
    err e = {0};
    int64_t skipped;
    double r[9];
    int n = read_with(text, NULL, v, 4, &skipped, &e);
    ok(n == 2 && skipped == 1, "a frame that was not tracked is left out, and counted %s", e.text);
    near_(v[0].at.position[0], -.002, 1e-15, "probe to reference by way of the tracker: x");
    near_(v[0].at.position[1], -.004, 1e-15, "y");
    near_(v[0].at.position[2], -.003, 1e-15, "z");
    pose_matrix(v[0].at.quaternion, r);
    near_(r[1], 1, 1e-15, "and its rotation, turned back");
    ok(read_with(text, "ProbeToTracker", v, 4, &skipped, &e) == 2 && v[0].at.position[0] == .005,
       "another, by its name");
    ok(read_with(text, "ReferenceToProbe", v, 4, &skipped, &e) == 2, "or inverted");
    ok(read_with(text, "Probe", v, 4, NULL, &e) == -1 && e.status == STATUS_USAGE, "%s", e.text);
    e = (err){0};
    ok(read_with(text, "StylusToTracker", v, 4, NULL, &e) == -1 &&
           strstr(e.text, "p:6: frame 7 does not say where Stylus is in Tracker") &&
           strstr(e.text, "among: 'ProbeToTracker, ReferenceToTracker'"),
       "%s", e.text);
}

static void refused_sequences(void)
{
#define POSE "Seq_Frame0000_ProbeToTrackerTransform = "
#define TIME "Seq_Frame0000_Timestamp = 1\n"
    refuse(HEAD POSE "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0\n" TIME TAIL,
           "p:4: 'ProbeToTrackerTransform'; expected 16 finite numbers");
    refuse(HEAD POSE "nan 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n" TIME TAIL, "expected 16 finite numbers");
    refuse(HEAD POSE "1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\n" TIME TAIL, "expected 0 0 0 1 as the last");
    refuse(HEAD POSE "1 0 0 0 1 1 0 0 0 0 1 0 0 0 0 1\n" TIME TAIL, "ProbeToTracker is not a rotation");
    refuse(HEAD POSE "-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n" TIME TAIL, "ProbeToTracker is not a rotation");
    refuse(HEAD POSE "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1\n" TIME TAIL, "ProbeToTracker is not a rotation");
    refuse(HEAD POSE UNIT "\n" TAIL, "p:4: frame 0 has no Timestamp");
    refuse(HEAD POSE UNIT "\n" POSE UNIT "\n" TIME TAIL,
           "p:5: 'ProbeToTrackerTransform'; expected each transform of a frame once");
    refuse(HEAD POSE UNIT "\nSeq_Frame0000_Timestamp = soon\n" TAIL, "p:5: Timestamp; expected a finite number");
    refuse(HEAD TIME TAIL, "does not say where Image or Probe is in Reference or Tracker");
    refuse(HEAD "Seq_Frame0001_Timestamp = 1\n" TIME TAIL, "p:5: a frame that comes after a later one");
    refuse(HEAD POSE UNIT "\n" TIME "Seq_Frame0001_ProbeToTrackerTransform = " UNIT
                          "\nSeq_Frame0001_Timestamp = 0.5\n" TAIL,
           "p:7: time 0.5 comes after 1");
    refuse("ObjectType = Image\nSeq_Frame0000_ImageToReferenceTransform = " UNIT "\n" TIME TAIL,
           "p:3: the width of the images is not known");
}

static void nrrd(void)
{
    poses_event v[4];
    err e = {0};
    int n = read_all("NRRD0004\n# made\ntype: unsigned char\nsizes: 5 4 1\nkinds: domain domain list\n"
                     "Seq_Frame0000_ImageToReferenceTransform:=" UNIT "\nSeq_Frame0000_Timestamp:=7\n\n\001\002",
                     v, 4, &e);
    ok(n == 1 && v[0].time == 7 && v[0].at.position[0] == .002, "the same in a NRRD header %s", e.text);
}

/* A line that has come is an event, whether or not the next one is on its way. */
static void live(void)
{
    static const char line[] = "1 0 0 0 0 0 0 1\n";
    char path[64];
    int end[2];
    err e = {0};
    poses p;
    poses_event v = {0};
    if (pipe(end)) {
        ok(false, "a pipe");
        return;
    }
    bool whole = write(end[1], line, strlen(line)) == (ssize_t)strlen(line);
    snprintf(path, sizeof path, "/dev/fd/%d", end[0]);
    in *s = in_open(path, &e);
    alarm(180);
    ok(whole && s && !poses_open(&p, s, NULL, &e) && poses_next(&p, &v, &e) == 1 && v.time == 1,
       "an event comes before the next line does %s", e.text);
    alarm(0);
    close(end[1]);
    ok(poses_next(&p, &v, &e) == 0, "then the end");
    in_close(s);
    close(end[0]);
}

static void real(void)
{
    const char *shared = getenv("SINEW_SHARED");
    char path[4096];
    snprintf(path, sizeof path, "%s/data/ultrasound/BoneUltrasound_L14.igs.mha", shared ? shared : "../shared");
    err e = {0};
    poses p;
    poses_event v = {0}, last = {0};
    int n = 0;
    in *s = in_open(path, &e);
    if (!s) {
        skip(2, "no shared data");
        return;
    }
    if (!poses_open(&p, s, "ProbeToTracker", &e))
        for (; poses_next(&p, &v, &e) > 0; n++)
            last = v;
    ok(n == 21 && !e.status && p.frames.skipped == 0, "a sweep of 21 frames %s", e.text);
    ok(last.time == 234.261100 && fabs(last.at.position[0] - .258961) < 1e-12, "the last of them");
    in_close(s);
}

int main(void)
{
    lines();
    refused_lines();
    sequence();
    composed();
    refused_sequences();
    nrrd();
    live();
    real();
    return done_testing();
}
