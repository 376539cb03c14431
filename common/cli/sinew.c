/* sinew TOOL ARGS: the front command. It execs TOOL, or sinew-TOOL, from the folder that it lies in itself, so that
 * generic names (info, diff) stay off the PATH and `sinew bind` is never the shell's builtin.
 */
#include "base/near.h"
#include "cli/spelling.h"
#include "cli/tool.h"

#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MODELS, SIMULATION, RESULTS, ULTRASOUND, GROUPS };

static const char *const headings[GROUPS] = {"Models", "Simulation", "Results", "Ultrasound images"};

/* The tools, in the order of the data's way. */
static const struct {
    int group;
    const char *name, *file, *purpose;
} tools[] = {
    {MODELS, "voxelise", "voxelise", "closed surfaces to hexahedral elements"},
    {MODELS, "attach", "attach", "rigid nodes, contraction centres and fibres"},
    {MODELS, "bind", "bind", "surfaces to elements, to move with them"},
    {MODELS, "materials", "sinew-materials", "laws of tissue, their keys, and materials by name"},
    {SIMULATION, "tled-run", "tled-run", "total Lagrangian explicit dynamics"},
    {MODELS, "msds-mesh", "msds-mesh", "meshes of tetrahedra"},
    {SIMULATION, "msds-run", "msds-run", "press a probe on tetrahedra, by springs or finite elements"},
    {ULTRASOUND, "us-import", "us-import", "a volume from DICOM, sweeps, MetaImage"},
    {ULTRASOUND, "us-segment", "us-segment", "a part of a volume as a named label"},
    {ULTRASOUND, "us-surface", "us-surface", "closed surfaces of labels or intensities"},
    {ULTRASOUND, "us-slice", "us-slice", "ultrasound images of a volume, as a model deforms it"},
    {ULTRASOUND, "poses", "sinew-poses", "poses of a probe, from what it does, a line each"},
    {ULTRASOUND, "register", "sinew-register", "the motion that takes points to those that were touched"},
    {ULTRASOUND, "igtl-out", "sinew-igtl-out", "images, poses and surfaces for 3D Slicer (OpenIGTLink)"},
    {RESULTS, "deform", "sinew-deform", "an OBJ as the model's results move it"},
    {RESULTS, "results", "sinew-results", "stress, strain and energies of elements, in frames"},
    {RESULTS, "info", "sinew-info", "what a model contains"},
    {RESULTS, "diff", "sinew-diff", "where two models differ"},
    {RESULTS, "distance", "sinew-distance", "how far two surfaces are apart, by region"},
    {RESULTS, "export", "sinew-export", "VTU, Abaqus .inp, Gmsh .msh, OBJ"},
    {MODELS, "import", "sinew-import", "a mesh from Abaqus .inp, Gmsh .msh, VTU"},
    {RESULTS, "render", "sinew-render", "pictures"},
    {SIMULATION, "console", "sinew-console", "a page in a browser on models that move live"},
    {ULTRASOUND, "igtl-in", "sinew-igtl-in", "poses that other programs send by OpenIGTLink"},
};

enum { TOOLS = sizeof tools / sizeof *tools };

static void put_list(out *o)
{
    out_text(o, "usage: sinew TOOL [ARGUMENTS]\n\n"
                "Runs one of the tools of Sinew; 'sinew TOOL --help' has the options of each.\n");
    for (int g = 0; g < GROUPS; g++) {
        out_format(o, "\n%s:\n", headings[g]);
        for (int i = 0; i < TOOLS; i++)
            if (tools[i].group == g)
                out_format(o, "  %-13s  %s\n", tools[i].name, tools[i].purpose);
    }
    out_text(o, "\nCommon:\n  -h, --help     print this help; 'sinew help TOOL' prints that of a tool\n"
                "  -V, --version  print the version\n"
                "\nExample:\n  sinew info --get muscle.name face.sinew\n\nManual: man sinew, man 7 sinew\n");
}

static void put_version(out *o)
{
    out_text(o, "sinew (Sinew) " SINEW_VERSION "\n");
}

/* What the option tables of the other tools say of them: the manual's synopsis, completion. */
static void put_mdoc(out *o)
{
    out_text(o, ".Nm sinew\n.Ar TOOL\n.Op Ar ARGUMENTS\n.Nm sinew\n.Cm help\n.Op Ar TOOL\n.Nm sinew\n.Fl h | V\n");
}

/* A tool's name as a pattern of a shell's `case`: its American spelling is taken, too. */
static void put_pattern(const char *name, out *o)
{
    const char *american = spelling_american(name);
    out_text(o, name);
    if (american)
        out_format(o, "|%s", american);
}

/* The tool's own completion does the rest: its table tells it, so that `sinew bind`
 * has one though bash's bind has not. */
static void put_bash(out *o)
{
    out_text(o, "_sinew_complete_sinew() {\n"
                "    local word=${COMP_WORDS[COMP_CWORD]} sinew=${COMP_WORDS[0]} tool=${COMP_WORDS[1]} name\n"
                "    if [[ $COMP_CWORD -eq 1 || $COMP_CWORD -eq 2 && $tool == help ]]; then\n"
                "        COMPREPLY=($(compgen -W '");
    for (int i = 0; i < TOOLS; i++)
        out_format(o, "%s ", tools[i].name);
    out_text(o, "help --help --version' -- \"$word\"))\n"
                "        return\n"
                "    fi\n"
                "    case $tool in\n");
    for (int i = 0; i < TOOLS; i++) {
        out_text(o, "    ");
        put_pattern(tools[i].name, o);
        out_format(o, ") name=%s ;;\n", tools[i].file);
    }
    out_text(o, "    *) return ;;\n"
                "    esac\n"
                "    name=_sinew_complete_${name//-/_}\n"
                "    declare -F \"$name\" >/dev/null || eval \"$(command \"$sinew\" \"$tool\" --table bash 2>/dev/null "
                "| sed '$d')\"\n"
                "    COMP_WORDS=(\"${COMP_WORDS[@]:1}\")\n"
                "    COMP_CWORD=$((COMP_CWORD - 1))\n"
                "    declare -F \"$name\" >/dev/null && \"$name\"\n"
                "}\n"
                "complete -o default -F _sinew_complete_sinew sinew\n");
}

static void put_zsh(out *o)
{
    out_text(o, "#compdef sinew\nlocal -a tools\ntools=(");
    for (int i = 0; i < TOOLS; i++)
        out_format(o, "\n    \"%s:%s\"", tools[i].name, tools[i].purpose);
    out_text(o, "\n    'help:the options of a tool' --help --version)\n"
                "if (( CURRENT == 2 )) || [[ CURRENT -eq 3 && $words[2] == help ]]; then\n"
                "    _describe -t commands tool tools\n"
                "    return\n"
                "fi\n"
                "local tool=$words[2]\n"
                "(( $+functions[_sinew-$tool] )) && tool=sinew-$tool\n"
                "shift words\n"
                "(( CURRENT-- ))\n"
                "if (( $+functions[_$tool] )); then _$tool; else _default; fi\n");
}

/* Standard output gets what put writes. */
static int answer(void (*put)(out *o))
{
    err e = {0};
    signal(SIGXFSZ, SIG_IGN); /* as tool_begin() has it */
    out *o = out_open(NULL, false, &e);
    if (o)
        put(o);
    if (!o || out_close(o, &e))
        fprintf(stderr, "sinew: %s\n", e.text);
    return e.status;
}

static int table(const char *kind)
{
    if (!strcmp(kind, "mdoc"))
        return answer(put_mdoc);
    if (!strcmp(kind, "bash"))
        return answer(put_bash);
    if (!strcmp(kind, "zsh"))
        return answer(put_zsh);
    fprintf(stderr, "sinew: --table '%s': expected mdoc, bash or zsh\n", kind);
    return STATUS_USAGE;
}

static int unknown(const char *name)
{
    const char *names[TOOLS];
    for (int i = 0; i < TOOLS; i++)
        names[i] = tools[i].name;
    int near = near_name(name, names, TOOLS);
    if (near >= 0)
        fprintf(stderr, "sinew: no tool '%s'; did you mean '%s'?\n", name, names[near]);
    else
        fprintf(stderr, "sinew: no tool '%s'; try sinew --help\n", name);
    return STATUS_USAGE;
}

/* Only returns where it fails. */
static int run(const char *file, char **argv)
{
    enum { NAME = 64 };
    char path[PATH_MAX + NAME]; /* one alone: the stack may be of 32 KiB */
    ssize_t n = readlink("/proc/self/exe", path, PATH_MAX);
    if (n < 0) {
        fprintf(stderr, "sinew: cannot find its own folder: %s\n", strerror(errno));
        return STATUS_BAD;
    }
    while (n && path[n - 1] != '/')
        n--;
    snprintf(path + n, NAME, "%s", file);
    execv(path, argv);
    fprintf(stderr, "sinew: cannot run %s: %s\n", path, strerror(errno));
    return STATUS_BAD;
}

static int find_exactly(const char *name)
{
    for (int i = 0; i < TOOLS; i++)
        if (!strcmp(name, tools[i].name) || !strcmp(name, tools[i].file))
            return i;
    return -1;
}

/* The tool of that name, in either spelling, or -1. */
static int find(const char *name)
{
    char british[32];
    int found = find_exactly(name);
    if (found < 0 && spelling_british(name, strlen(name), british, sizeof british))
        found = find_exactly(british);
    return found;
}

/* sinew help [TOOL]: the list of tools, or the tool's own help. */
static int help(int argc, char **argv)
{
    if (argc > 3) {
        fprintf(stderr, "sinew: help %s: extra operand '%s'; expected one tool\n", argv[2], argv[3]);
        return STATUS_USAGE;
    }
    if (argc == 2 || !strcmp(argv[2], "sinew") || !strcmp(argv[2], "help") || !strcmp(argv[2], "--help"))
        return answer(put_list);
    int found = find(argv[2]);
    char option[] = "--help";
    char *asked[] = {argv[2], option, NULL};
    return found < 0 ? unknown(argv[2]) : run(tools[found].file, asked);
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fputs("sinew: missing tool; try sinew --help\nusage: sinew TOOL [ARGUMENTS]\n", stderr);
        return STATUS_USAGE;
    }
    if (!strcmp(argv[1], "-h") || !strcmp(argv[1], "--help"))
        return answer(put_list);
    if (!strcmp(argv[1], "help"))
        return help(argc, argv);
    if (!strcmp(argv[1], "-V") || !strcmp(argv[1], "--version"))
        return answer(put_version);
    if (!strcmp(argv[1], "--table") && argc == 3)
        return table(argv[2]);
    int found = find(argv[1]);
    return found < 0 ? unknown(argv[1]) : run(tools[found].file, argv + 1);
}
