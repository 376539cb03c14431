"""jobs.py BIN THREADS ROUNDS FACE.obj FOLDER cpu|cuda MM...: whole pipes from surfaces to a moving face, by stage, as CSV: voxelise, attach, bind, tled-run for .5 s of
model at nu .45 with both zygomatics at .1, and sinew deform; then all of them in one pipe. A stage reads a file and writes one. And a block of 524,288 nodes
(of 8,192 on the CPU) under a probe by msds-run; FRAMES: what the newer tools are given as --frames. Then frames by what is asked for, of the newer tools
alone: of the block, as msds-run tells them (-v), beside the solver; and of the face, model's seconds a second, from a run of 2 s more. And a batch of
BATCH [100] expressions of the first size, .3 s each, and of one step each, with the bytes of two of them beside runs alone. OLD=FOLDER of tools: those are run by turns with these, and each row has
the ratio of this round's times, which says more than seconds where a processor is shared. PRECISION: double or single [single].
Beside them, limits of the machine: the model of each size through a pipe, and to the disk; on a card, its context alone. Peak memory is at least that of a
Python that is about to become the tool, 12 MiB."""
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

MODEL_SECONDS = ".5"
MUSCLES = "muscle_zyg_xneg=.1,muscle_zyg_xpos=.1"
BATCH = int(os.environ.get("BATCH", "100"))


SAID = tempfile.TemporaryFile()  # what the tools say; their warnings are of no use here


def fail(text):
    SAID.seek(0)
    sys.exit("%sjobs.py: %s" % (SAID.read().decode(errors="replace"), text))


def job(command, source, target):
    """Runs a command from a file into a file; its seconds, and the most memory that it held at once, in bytes."""
    with open(source, "rb") as reads, open(target, "wb") as writes:
        began = time.monotonic()
        process = subprocess.Popen(command, stdin=reads, stdout=writes, stderr=SAID)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - began
        process.returncode = status
    if status:
        fail("status %d of %s" % (status, " ".join(command)))
    return seconds, usage.ru_maxrss * 1024


def pipe(commands, target):
    """Runs commands in a pipe, from nothing into a file; the seconds until the last has ended. Memory is told by stages."""
    began, stages, source = time.monotonic(), [], subprocess.DEVNULL
    with open(target, "wb") as writes:
        for command in commands:
            last = command is commands[-1]
            stages.append(subprocess.Popen(command, stdin=source, stdout=writes if last else subprocess.PIPE, stderr=SAID))
            if source != subprocess.DEVNULL:
                source.close()
            source = stages[-1].stdout
        for command, process in zip(commands, stages):
            if process.wait():
                fail("status %d of %s, in a pipe" % (process.returncode, " ".join(command)))
    return time.monotonic() - began, None


def same(one, other):
    with open(one, "rb") as a, open(other, "rb") as b:
        while True:
            x, y = a.read(1 << 20), b.read(1 << 20)
            if x != y:
                return False
            if not x:
                return True


def context():
    """Seconds of a process that makes a context on the first card and ends."""
    code = ("import ctypes as c; l = c.CDLL('libcuda.so.1'); p = c.c_void_p(); "
            "assert not l.cuInit(0); assert not l.cuDevicePrimaryCtxRetain(c.byref(p), 0)")
    began = time.monotonic()
    if subprocess.run([sys.executable, "-S", "-c", code]).returncode:
        fail("no context on the card")
    return time.monotonic() - began


def to_disk(path, copy):
    with open(path, "rb") as reads:
        data = reads.read()
    began = time.monotonic()
    with open(copy, "wb") as writes:
        writes.write(data)
        writes.flush()
        os.fsync(writes.fileno())
    return time.monotonic() - began


class Bench:
    def __init__(self, versions, rounds, folder):
        self.versions, self.rounds, self.folder = versions, rounds, folder
        self.of_frames = []  # rows for the end

    def path(self, name):
        return os.path.join(self.folder, name)

    def row(self, pipe_name, size, device, stage, version, took, ratios, memory, bytes_out):
        print("%s,%s,%s,%s,%s,%d,%.4f,%.4f,%s,%s,%s" % (
            pipe_name, size, device, stage, version, len(took), statistics.median(took), min(took),
            "%.3g" % statistics.median(ratios) if ratios else "", "%.0f" % (memory / 2 ** 20) if memory else "", bytes_out), flush=True)

    def compare(self, pipe_name, size, device, stage, run):
        """run(BIN, TARGET), by turns of the versions; each has its own target, and what is not the same in both is told."""
        took, memory = {v: [] for v, _ in self.versions}, {v: 0 for v, _ in self.versions}
        for _ in range(self.rounds):
            for version, tools in self.versions:
                seconds, held = run(tools, self.path(stage + "-" + version))
                took[version].append(seconds)
                memory[version] = max(memory[version], held or 0)
        ratios = [new / old for new, old in zip(took["new"], took["old"])] if "old" in took else []
        for version, _ in self.versions:
            out = self.path(stage + "-" + version)
            self.row(pipe_name, size, device, stage, version, took[version], ratios if version == "new" else [], memory[version], os.path.getsize(out))
        if "old" in took and not same(self.path(stage + "-old"), self.path(stage + "-new")):
            print("# %s at %s: the bytes of %s differ between the versions" % (pipe_name, size, stage), flush=True)
        return self.path(stage + "-new")

    def frames_row(self, pipe_name, size, device, what, frame, solver, rate, bytes_out):
        """ms a frame and of the solver in it, how many times the solver's time that is; or the model's seconds a second; bytes of a frame."""
        times = "%.3g" % (frame / solver) if solver else ""
        numbers = ["%.4g" % x if x != "" else "" for x in (frame, solver, rate)]
        self.of_frames.append("%s,%s,%s,\"%s\",%s,%s,%s,%s,%.0f" % (pipe_name, size, device, what, numbers[0], numbers[1], times, numbers[2], bytes_out))

    def limit(self, pipe_name, size, device, stage, run):
        self.row(pipe_name, size, device, stage, "machine", [run() for _ in range(self.rounds)], [], 0, "")


def face_stages(tools, face, side, device, threads, precision):
    """What each stage is, by its name: a command that reads its standard input (voxelise: FACE)."""
    return [("voxelise", [tools + "/voxelise", "-q", "--threads", threads, "--unit", "mm", "-s", side, face]),
            ("attach", [tools + "/attach", "-q", "--threads", threads]),
            ("bind", [tools + "/bind", "-q", "--threads", threads]),
            ("tled-run", [tools + "/tled-run", "-q", "--threads", threads, "-d", device, "--precision", precision, "-m", "tissue.nu=0.45", "-c", MUSCLES,
                          "-t", MODEL_SECONDS]),
            ("deform", [tools + "/sinew", "deform", "-q", face])]


def bench_face(bench, face, side, device, threads, precision):
    """The model, with all that the run needs."""
    source, size, model = os.devnull, side + "mm", None
    for i, (stage, _) in enumerate(face_stages("", face, side, device, threads, precision)):
        source = bench.compare("face", size, device, stage, lambda tools, target, i=i, source=source: job(
            face_stages(tools, face, side, device, threads, precision)[i][1], source, target))
        if stage == "bind":
            model = source
            bench.limit("face", size, device, "copy by a pipe", lambda model=source: pipe([["cat", model], ["cat"]], bench.path("copy"))[0])
            bench.limit("face", size, device, "copy to disk", lambda model=source: to_disk(model, bench.path("copy")))
    bench.compare("face", size, device, "whole", lambda tools, target: pipe(
        [command for _, command in face_stages(tools, face, side, device, threads, precision)], target))
    return model


def bench_batch(bench, model, size, device, threads, precision):
    """Expressions of one model, all of them different. Outputs are taken away after each batch."""
    tools = bench.versions[-1][1]
    run = [tools + "/tled-run", "-q", "--threads", threads, "-d", device, "--precision", precision, "-m", "tissue.nu=0.45",
           "--frames", "surfaces:f32"]
    lines, alone = bench.path("lines"), bench.path("alone")

    def levels(i):
        return "muscle_zyg_xneg=%.4f,muscle_zyg_xpos=%.4f" % (.02 + .1 * i / BATCH, .12 - .1 * i / BATCH)

    for stage, end in ("one step each", "-n 1"), (".3 s each", "-t 0.3"):
        outputs = [bench.path("job%d" % i) for i in range(BATCH)]
        with open(lines, "w") as to:
            for i, output in enumerate(outputs):
                to.write("-c %s %s -o %s\n" % (levels(i), end, output))
        took, memory = job(run + ["--batch", lines], model, bench.path("said"))
        bench.row("face", size, device, "batch of %d; %s" % (BATCH, stage), "new", [took], [], memory, sum(os.path.getsize(o) for o in outputs))
        for i in 0, BATCH - 1:
            job(run + ["-c", levels(i)] + end.split(), model, alone)
            if not same(alone, outputs[i]):
                print("# %s at %s: the bytes of job %d of the batch are not those of a run alone" % ("face", size, i + 1), flush=True)
        for output in outputs:
            os.remove(output)


def bench_face_frames(bench, model, size_of, device, threads, precision):
    """Bound surfaces at 60 frames a second: how many of the model's seconds a run goes on by in one of the clock's."""
    tools = bench.versions[-1][1]
    out = bench.path("frames")

    def seconds(level, until):
        muscles = MUSCLES.replace("=.1", "=" + level)
        return job([tools + "/tled-run", "-q", "--threads", threads, "-d", device, "--precision", precision, "-m", "tissue.nu=0.45", "-c", muscles,
                    "--every", "0.0166666667", "-t", until, "--frames", "surfaces:f32"], model, out)[0]

    for level in ".1", ".2":
        rates = []
        for _ in range(bench.rounds):
            short = seconds(level, ".5")
            size = os.path.getsize(out)
            rates.append(2 / (seconds(level, "2.5") - short))
        size = (os.path.getsize(out) - size) / 120
        bench.frames_row("face", size_of, device, "level %s, surfaces:f32" % level, "", "", max(rates), size)


def surface_of(path, rows, columns):
    """A sheet across the block, as a vessel's wall would lie in it: m."""
    with open(path, "w") as to:
        for i in range(rows):
            for k in range(columns):
                to.write("v %.9f %.9f %.9f\n" % (.01 + .14 * i / (rows - 1), .01 + .06 * k / (columns - 1), .03 + .004 * (i % 7) / 7))
        for i in range(rows - 1):
            for k in range(1, columns):
                a = i * columns + k
                to.write("f %d %d %d %d\n" % (a, a + 1, a + columns + 1, a + columns))


def told(command, model, target):
    """What msds-run -v tells of its frames, ms: in all, and the solver's part."""
    with open(model, "rb") as reads, open(target, "wb") as writes:
        ran = subprocess.run(command, stdin=reads, stdout=writes, stderr=subprocess.PIPE)
    words = ran.stderr.decode(errors="replace").rsplit("a frame took", 1)
    if ran.returncode or len(words) != 2:
        fail("status %d of %s" % (ran.returncode, " ".join(command)))
    said = words[1].split()
    return float(said[0]), float(said[6])


def bench_block_frames(bench, model, run, device, nodes):
    tools = bench.versions[-1][1]
    surface, bound, out = bench.path("sheet.obj"), bench.path("bound"), bench.path("frames")
    surface_of(surface, 141, 71)
    job([tools + "/sinew", "bind", "-q", "--unit", "m", surface], model, bound)
    for method, option in (("springs", "msds"), ("20 CG", "fem")):
        for choice in ("all", "displacement:f32", "surfaces", "surfaces:f32"):
            least = (float("inf"), 0)
            for _ in range(bench.rounds):
                frames = [] if choice == "all" else ["--frames", choice]
                least = min(least, told([tools + "/msds-run", "-v", "--method", option] + run + frames, bound, out))
            size = (os.path.getsize(out) - os.path.getsize(bound)) / 60
            bench.frames_row("block", nodes, device, "%s, %s" % (method, choice), least[0], least[1], "", size)


def bench_block(bench, nodes, device, threads):
    """Sixty poses that press a probe 6 mm into a block."""
    poses = bench.path("poses")
    with open(poses, "w") as to:
        for i in range(60):
            to.write("%.6f .08 .04 %.9f 0 0 0 1\n" % (i / 60, .04 + .006 * (1 - i / 30) if i < 30 else .034))
    model = bench.compare("block", nodes, device, "msds-mesh", lambda tools, target: job(
        [tools + "/msds-mesh", "-q", "--nodes", nodes, "--size", "16cm,8cm,4cm"], os.devnull, target))
    frames = ["--frames", os.environ["FRAMES"]] if os.environ.get("FRAMES") else []
    run = ["--threads", threads, "-d", device, "--probe", "linear:4cm,1cm", "--poses", poses]
    newest = bench.versions[-1][1]
    bench.compare("block", nodes, device, "msds-run", lambda tools, target: job(
        [tools + "/msds-run", "-q", "--method", "msds"] + run + (frames if tools == newest else []), model, target))
    return model, run


def main():
    if len(sys.argv) < 8 or sys.argv[6] not in ("cpu", "cuda"):
        sys.exit(__doc__.split(":")[0])
    tools, threads, rounds, face, folder, device = sys.argv[1:7]
    precision = os.environ.get("PRECISION", "single")
    versions = [("new", os.path.abspath(tools))]
    if os.environ.get("OLD"):
        versions.insert(0, ("old", os.path.abspath(os.environ["OLD"])))
    os.makedirs(folder, exist_ok=True)
    bench = Bench(versions, int(rounds), os.path.abspath(folder))
    print("pipe,size,device,stage,version,rounds,median_s,least_s,times_old,peak_MiB,bytes")
    try:
        if device == "cuda":
            bench.limit("machine", "", device, "context alone", context)
        for side in sys.argv[7:]:
            model = bench_face(bench, os.path.abspath(face), side, device, threads, precision)
            if device == "cuda":
                bench_face_frames(bench, model, side + "mm", device, threads, precision)
            if side == sys.argv[7]:
                bench_batch(bench, model, side + "mm", device, threads, precision)
        nodes = "128x64x64" if device == "cuda" else "32x16x16"
        block, run = bench_block(bench, nodes, device, threads)
        bench_block_frames(bench, block, run, device, nodes)
        print("pipe,size,device,frames,frame_ms,solver_ms,times_solver,model_s_a_s,bytes_a_frame")
        print("\n".join(bench.of_frames))
    finally:
        shutil.rmtree(folder)


main()
