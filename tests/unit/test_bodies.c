/* Rigid bodies that a script moves: turns between keys, the motion that fits points, values of curves, files of poses,
 * lines that come live, and nonsense.
 */
// needs: tled/problem/script.c tled/problem/script_read.c tled/problem/script_nodes.c tled/problem/script_surface.c
// needs: tled/problem/script_move.c
// needs: tled/problem/script_levels.c tled/problem/script_muscles.c tled/problem/script_track.c tled/muscle/muscles.c
// needs: tled/muscle/expressions.c tled/muscle/activation.c
#include "place/pose_fit.h"
#include "tled/problem/moves.h"
#include "tled/problem/script.h"

#include "tap.h"

#include <string.h>

/* 3 x 3 x 3 nodes 1 cm apart; z = 0 belongs to jaw, z = 2 cm to skull, and is held by the surface skull too. */
static void make_model(model *m, bool bodies, err *e)
{
    *m = (model){0};
    model_axis_add(m, "node", 27, e);
    model_axis_add(m, "anchor", 1, e);
    double *p = model_add(m, "node.position", e)->f64;
    int32_t *anchor = model_add(m, "node.anchor", e)->i32;
    model_set_text(model_add(m, "anchor.name", e), 0, "skull", e);
    for (int i = 0; i < 27; i++) {
        p[3 * i] = .01 * (i % 3), p[3 * i + 1] = .01 * (i / 3 % 3), p[3 * i + 2] = .01 * (i / 9);
        anchor[i] = i / 9 == 2 ? 0 : -1;
    }
    if (!bodies)
        return;
    model_axis_add(m, "body", 2, e);
    model_set_text(model_add(m, "body.name", e), 0, "jaw", e);
    model_set_text(model_find(m, "body.name"), 1, "skull", e);
    int32_t *body = model_add(m, "node.body", e)->i32;
    for (int i = 0; i < 27; i++)
        body[i] = i / 9 == 1 ? -1 : i / 9 / 2;
}

static pose turn(double degrees, double x, double y, double z)
{
    const double half = degrees * acos(-1) / 360;
    return (pose){.quaternion = {x * sin(half), y * sin(half), z * sin(half), cos(half)}};
}

/* The largest difference of two quaternions, which are the same with all signs changed. */
static double gap(const double *a, const double *b)
{
    double same = 0, other = 0;
    for (int i = 0; i < 4; i++) {
        same = fmax(same, fabs(a[i] - b[i]));
        other = fmax(other, fabs(a[i] + b[i]));
    }
    return fmin(same, other);
}

static void test_slerp(void)
{
    static const double degrees[] = {1e-7, .01, 30, 90, 179.9}, share[] = {0, .125, 1. / 3, .5, .9, 1};
    double worst = 0, signs = 0;
    for (int d = 0; d < 5; d++)
        for (int s = 0; s < 6; s++) {
            const pose a = turn(20, .6, 0, .8), b = turn(20 + degrees[d], .6, 0, .8);
            const pose want = turn(20 + share[s] * degrees[d], .6, 0, .8), is = pose_slerp(&a, &b, share[s]);
            pose other = b;
            for (int i = 0; i < 4; i++)
                other.quaternion[i] = -b.quaternion[i];
            const pose back = pose_slerp(&a, &other, share[s]);
            worst = fmax(worst, gap(is.quaternion, want.quaternion));
            signs = fmax(signs, gap(is.quaternion, back.quaternion));
        }
    near_(worst, 0, 2e-14, "between two turns the angular velocity is constant, from 1e-7 to 179.9 degrees");
    near_(signs, 0, 1e-15, "the sign of a quaternion makes no difference");
    const pose from = {{1, 2, 3}, {0, 0, 0, 1}}, to = {{3, 2, -1}, {0, 0, 0, 1}}, half = pose_slerp(&from, &to, .5);
    ok(half.position[0] == 2 && half.position[1] == 2 && half.position[2] == 1, "positions go in a straight line");
}

static double fit_error(const model *m, const pose *at, const int32_t *node, int64_t count, pose *found)
{
    double u[81], worst = 0;
    const double *x = model_find(m, "node.position")->f64;
    for (int i = 0; i < 27; i++) {
        pose_apply(at, x + 3 * i, u + 3 * i);
        for (int a = 0; a < 3; a++)
            u[3 * i + a] -= x[3 * i + a];
    }
    *found = pose_fit(x, u, node, count);
    for (int64_t i = 0; i < count; i++) {
        double y[3];
        pose_apply(found, x + 3 * node[i], y);
        for (int a = 0; a < 3; a++)
            worst = fmax(worst, fabs(y[a] - x[3 * node[i] + a] - u[3 * node[i] + a]));
    }
    return worst;
}

static void test_fit(const model *m)
{
    static const double axis[][3] = {{1, 0, 0}, {0, .6, .8}, {-.48, .6, .64}};
    static const int32_t all[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 10, 26}, line[] = {0, 1, 2}, one[] = {4};
    double worst = 0, turned = 0;
    for (int d = -180; d < 180; d += 36)
        for (int k = 0; k < 3; k++) {
            pose at = turn(d, axis[k][0], axis[k][1], axis[k][2]), found;
            memcpy(at.position, (double[]){.3, -.1, .02}, sizeof at.position);
            worst = fmax(worst, fit_error(m, &at, all, 11, &found));
            turned = fmax(turned, gap(found.quaternion, at.quaternion));
        }
    near_(worst, 0, 1e-15, "the motion of points is found again");
    near_(turned, 0, 1e-13, "and its turn");
    pose at = turn(30, 1, 0, 0), found;
    near_(fit_error(m, &at, line, 3, &found), 0, 1e-16, "of points on an axis: what they did");
    near_(gap(found.quaternion, (double[]){0, 0, 0, 1}), 0, 1e-9, "is told without a turn about it");
    near_(fit_error(m, &at, one, 1, &found), 0, 1e-16, "of one point: where it went");
    at = pose_none();
    fit_error(m, &at, all, 11, &found);
    ok(!memcmp(&found, &at, sizeof at), "of what did not move: nothing, exactly");
}

static int read_text(script *s, const model *m, const char *text, bool poses, const pose *place, err *e)
{
    in *source = in_memory(text, strlen(text), "s.txt", e);
    int status = -1;
    if (source)
        status = poses ? script_read_poses(s, source, m, place, e) : script_read(s, source, m, e);
    in_close(source);
    return status;
}

/* What node n of the model is displaced by, if the first curve is a move. */
static void moved(const script *s, const model *m, double time, int n, double u[3])
{
    double value[60];
    script_values(s, time, value);
    for (int a = 0; a < 3; a++)
        u[a] = moves_to(value, MOVES_BODY, a, model_find(m, "node.position")->f64 + 3 * (int64_t)n);
}

static void test_values(const model *m)
{
    script s = {0};
    err e = {0};
    double u[3];
    const double r = sqrt(.5);
    ok(!read_text(&s, m,
                  "1 move jaw 0,0,0 0,0,0,1 about 1cm,0,0\n"
                  "3 move jaw 0,2mm,0 0,0,0.70710678,0.70710678 about 10mm,0,0\n",
                  false, NULL, &e),
       "a script that moves the jaw: %s", e.text);
    ok(s.curves == 4 && s.curve[0].verb == SCRIPT_MOVE && s.curve[3].verb == SCRIPT_TURN && s.curve[0].node_count == 9,
       "a move is four curves, and the body's nodes");
    near_(script_end(&s), 3, 0, "it ends with its last key");
    moved(&s, m, .5, 2, u);
    ok(u[0] == 0 && u[1] == 0 && u[2] == 0, "before its first key the body is at rest");
    moved(&s, m, 2, 1, u);
    near_(u[0], 0, 1e-17, "half way, the point that it turns about");
    near_(u[1], .001, 1e-17, "has gone half its way");
    moved(&s, m, 2, 2, u);
    near_(u[0], .01 * (r - 1), 1e-16, "and 1 cm from it, x is that of 45 degrees");
    near_(u[1], .01 * r + .001, 1e-16, "and y");
    moved(&s, m, 1 + 2. / 3, 2, u);
    near_(u[0], .01 * (cos(acos(-1) / 6) - 1), 1e-16, "a third of the way is 30 degrees");
    moved(&s, m, 4, 2, u);
    near_(u[0], -.01, 1e-16, "after the last key it stays");
    near_(u[1], .012, 1e-16, "as it was put");
    script_free(&s);
}

static void test_poses(const model *m)
{
    script one = {0}, other = {0}, placed = {0};
    err e = {0};
    double u[3], v[3], worst = 0;
    const pose none = pose_none();
    pose place = turn(90, 0, 0, 1);
    place.position[0] = 1;
    ok(!read_text(&one, m, "0 move jaw 1mm,0,0 0,0,0,1\n2 move jaw 0,2mm,0 0.6,0,0,0.8\n", false, NULL, &e) &&
           !read_text(&other, m, "jaw 0 0.001 0 0 0 0 0 1\njaw 2 0 0.002 0 0.6 0 0 0.8 # open\n", true, &none, &e),
       "a script, and a file of poses: %s", e.text);
    for (int i = 0; i < 12; i++) {
        moved(&one, m, .25 * i, 7, u);
        moved(&other, m, .25 * i, 7, v);
        worst = fmax(worst, memcmp(u, v, sizeof u) ? 1 : 0);
    }
    ok(worst == 0, "say the same");
    ok(!read_text(&placed, m, "jaw 0 0 0 0 0 0 0 1\njaw 1 0 0.1 0 0 0 0 1\n", true, &place, &e), "poses in a frame");
    moved(&placed, m, 1, 3, u);
    near_(u[0], .1, 1e-16, "in which the model is turned: y there is x here");
    near_(u[1], 0, 1e-16, "and not y");
    script_free(&one);
    script_free(&other);
    script_free(&placed);
}

static int now_line(script *s, const model *m, const char *text, const script_now *now, bool *anew, err *e)
{
    char copy[200];
    keyfile k = {.name = "live"};
    snprintf(copy, sizeof copy, "%s", text);
    keyfile_take(&k, copy, (int64_t)strlen(copy), 1, e);
    return script_take_now(s, m, &k, now, anew, e);
}

static void test_live(const model *m)
{
    script s = {0};
    err e = {0};
    bool anew = false;
    double u[3], v[3], all[81];
    for (int i = 0; i < 81; i++)
        all[i] = i % 3 == 1 ? .004 : 0;
    ok(!now_line(&s, m, "now move jaw 0,1mm,0 0,0,0.6,0.8 about 1cm,0,0", &(script_now){1, 2, all}, &anew, &e) && anew,
       "live, a body moves: %s", e.text);
    moved(&s, m, 1, 5, u);
    near_(u[1], .004, 1e-7, "from where its nodes are");
    moved(&s, m, 2, 1, u);
    near_(u[1], .001, 1e-17, "to where the line says");
    anew = false;
    moved(&s, m, 1.5, 5, u);
    ok(!now_line(&s, m, "now move jaw 0,0,0 0,0,0,1 about 0,2cm,0", &(script_now){1.5, 2.5, all}, &anew, &e) && !anew,
       "a later line changes values alone: %s", e.text);
    moved(&s, m, 1.5, 5, v);
    ok(fabs(u[0] - v[0]) < 1e-7 && fabs(u[1] - v[1]) < 1e-7, "from where the body was then, about whatever point");
    script_release_all(&s, &(script_now){2, 3, NULL});
    moved(&s, m, 2, 5, u);
    moved(&s, m, 3, 5, v);
    ok(!memcmp(u, v, sizeof u), "where tissue breaks, it stays where it is");
    script_forget_all(&s, &(script_now){4, 5, NULL});
    moved(&s, m, 5, 5, u);
    ok(u[0] == 0 && u[1] == 0 && u[2] == 0, "or goes back to rest");
    ok(now_line(&s, m, "now move jaw 0,0,0 0,0,0,0", &(script_now){5, 6, NULL}, &anew, &e) &&
           strstr(e.text, "a quaternion of length 0"),
       "live, nonsense is refused: %s", e.text);
    moved(&s, m, 6, 5, u);
    ok(u[0] == 0 && s.curves == 4, "and changes nothing");
    script_free(&s);
}

static void refuse(const model *m, const char *text, bool poses, const char *want)
{
    const pose none = pose_none();
    script s = {0};
    err e = {0};
    const int status = read_text(&s, m, text, poses, &none, &e);
    ok(status && strstr(e.text, want), "%s", e.text[0] ? e.text : text);
    script_free(&s);
}

static void test_refusals(const model *m, const model *without)
{
    static const char still[] = "0 move jaw 0,0,0 0,0,0,1 about 1,0,0\n";
    char two[200];
    refuse(m, "0 move jawe 0,0,0 0,0,0,1\n", false, "s.txt:1: unknown body 'jawe'; did you mean 'jaw'?");
    refuse(without, "0 move jaw 0,0,0 0,0,0,1\n", false, "s.txt:1: 'jaw': the model has no rigid bodies");
    refuse(m, "\n0 move jaw 0,0,0 0,0,0,0\n", false, "s.txt:2: a quaternion of length 0; expected 1, to within 0.01");
    refuse(m, "0 move jaw 0,0,0 0,0,1,1\n", false, "s.txt:1: a quaternion of length 1.41421");
    refuse(m, "0 move jaw 0,0,0 0,0,1\n", false, "s.txt:1: '0,0,1'; expected QX,QY,QZ,QW");
    refuse(m, "0 move jaw 0,0,nan 0,0,0,1\n", false, "s.txt:1: '0,0,nan'; expected X,Y,Z: lengths");
    refuse(m, "0 move jaw 0,0,0\n", false, "s.txt:1: 4 words; expected TIME move BODY X,Y,Z QX,QY,QZ,QW [about");
    refuse(m, "0 move jaw 0,0,0 0,0,0,1 about\n", false, "s.txt:1: 6 words; expected TIME move");
    refuse(m, "0 move jaw 0,0,0 0,0,0,1 around 0,0,0\n", false, "s.txt:1: 'around'; expected about X,Y,Z");
    refuse(m, "0 move jaw 0,0,0 0,0,0,1 about 0,0\n", false, "s.txt:1: '0,0'; expected X,Y,Z: a point");
    snprintf(two, sizeof two, "%s1 move jaw 0,0,0 0,0,0,1\n", still);
    refuse(m, two, false, "s.txt:2: 'jaw' turns about another point than in line 1");
    refuse(m, "1 move jaw 0,0,0 0,0,0,1\n0.5 move jaw 0,0,0 0,0,0,1\n", false, "s.txt:2: time 0.5 s comes after 1 s");
    refuse(m, "0 displace skull 0,0,0\n0 move skull 0,0,0 0,0,0,1\n", false, "is displaced by line 1 too");
    refuse(m, "jaw 0 0 0 0 0 0 0\n", true, "s.txt:1: 8 words; expected BODY time tx ty tz qx qy qz qw");
    refuse(m, "jaw 0 0 0 0 0 0 0 0\n", true, "s.txt:1: a quaternion of length 0");
    refuse(m, "jaw -1 0 0 0 0 0 0 1\n", true, "s.txt:1: time -1 s; expected times from 0 on");
    refuse(m, "jaw 1 0 0 0 0 0 0 1\njaw 0 0 0 0 0 0 0 1\n", true, "s.txt:2: time 0 s comes after 1 s");
    refuse(m, "nose 1 0 0 0 0 0 0 1\n", true, "s.txt:1: unknown body 'nose'");
    refuse(m, "# nothing\n", true, "s.txt: nothing in it; expected lines BODY time");
    script s = {0};
    err e = {0};
    const pose none = pose_none();
    ok(!read_text(&s, m, still, false, NULL, &e) && read_text(&s, m, "jaw 0 0 0 0 0 0 0 1\n", true, &none, &e) &&
           strstr(e.text, "s.txt:1: 'jaw' is moved by line 1 of the script too; expected one of them"),
       "%s", e.text);
    script_free(&s);
}

int main(void)
{
    model m, without;
    err e = {0};
    make_model(&m, true, &e);
    make_model(&without, false, &e);
    test_slerp();
    test_fit(&m);
    test_values(&m);
    test_poses(&m);
    test_live(&m);
    test_refusals(&m, &without);
    model_free(&m);
    model_free(&without);
    return done_testing();
}
