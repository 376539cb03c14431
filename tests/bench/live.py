"""live.py BIN [THREADS [CSV]]: the chain as it is used live: a pose goes into a FIFO, msds-run solves, us-slice draws, and the clock is stopped when
the last byte of the image has come out of the pipe. 20 x 10 x 10 nodes, 512 x 512 pixels, 256^3 voxels of noise. Prints CSV: latency from pose
to image, and images a second when the next pose goes in as soon as an image is out, and when three are always under way. Then the same by --live, 60
poses a second, at 32 x 16 x 16 nodes: latency in ms, and in multiply-adds of one processor, as the probe in the CSV of bench_slice took them.
Then the face at 2.5 mm (the real one where its data are; FACE=FILE: another model) by tled-run --live for 10 s, in single precision and with nu .45,
while its muscles contract and let go, and on a card at 1.25 mm where there is one: simulated time to real time. FACE_ONLY=cpu or cuda: only that."""
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(root, "tests", "long"))
from face_model import make_face, names_in

bin, threads = os.path.abspath(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "2"
poses, ahead = 300, 3


def read_image(stream):
    for _ in range(4):
        stream.readline()
    return stream.read(512 * 512)


def pose(i):
    return "%d .08 .04 %.9f 0 0 0 1\n" % (i, .0001 * min(i % 200, 200 - i % 200))


def run(method, folder, mesh, volume, under_way):
    fifo = os.path.join(folder, "poses-%s-%d" % (method, under_way))
    os.mkfifo(fifo)
    solver = subprocess.Popen([bin + "/msds-run", "-q", "--method", method, "--probe", "linear:4cm,1cm", "--poses", fifo, "--threads", threads],
                              stdin=open(mesh, "rb"), stdout=subprocess.PIPE)
    slicer = subprocess.Popen([bin + "/us-slice", "--size", "512x512", "-q", "--depth", "8cm", "--width", "16cm", "--threads", threads, volume],
                              stdin=solver.stdout, stdout=subprocess.PIPE)
    solver.stdout.close()
    sent, took = [], []
    with open(fifo, "w", buffering=1) as to:
        for i in range(under_way + 1):
            to.write(pose(i))
            sent.append(time.monotonic())
        for i in range(poses):
            if len(read_image(slicer.stdout)) != 512 * 512:
                sys.exit("live.py: an image is missing")
            took.append(time.monotonic() - sent[i])
            to.write(pose(i + under_way + 1))
            sent.append(time.monotonic())
            if i == 20:
                began = time.monotonic()
        seconds = time.monotonic() - began
    slicer.stdout.read()
    if slicer.wait() or solver.wait():
        sys.exit("live.py: a tool failed")
    took = sorted(took[21:])
    print("%s,%s,%d,%d,%.3f,%.3f,%.3f,%.0f" % (method, threads, under_way + 1, poses, 1e3 * took[0], 1e3 * took[len(took) // 2],
                                             1e3 * took[len(took) * 95 // 100], (poses - 21) / seconds))


def live_pose(i):
    return "%.9f %.9f .04 %.9f 0 0 0 1\n" % (i / 60, .08 + 1e-6 * i, .0001 * min(i % 100, 100 - i % 100))


def shown(stream, sent, took):
    """Reads images; of each that is the first of a pose, how long that took: the x of its first pixel tells which pose it is."""
    last = -1
    while stream.readline():
        place = stream.readline().split()
        stream.readline(), stream.readline()
        if len(stream.read(512 * 512)) != 512 * 512:
            return
        came, i = time.monotonic(), round((float(place[2]) - .16 / 1024) / 1e-6)
        if last < i < len(sent):
            took.append(came - sent[i])
            last = i


def run_live(method, folder, mesh, volume):
    fifo = os.path.join(folder, "live-" + method)
    os.mkfifo(fifo)
    solver = subprocess.Popen([bin + "/msds-run", "-q", "--live", "--method", method, "--probe", "linear:4cm,1cm", "--poses", fifo, "--threads", threads],
                              stdin=open(mesh, "rb"), stdout=subprocess.PIPE)
    slicer = subprocess.Popen([bin + "/us-slice", "-q", "--live", "--size", "512x512", "--depth", "8cm", "--width", "16cm", "--threads", threads,
                               volume], stdin=solver.stdout, stdout=subprocess.PIPE)
    solver.stdout.close()
    sent, took = [], []
    reader = threading.Thread(target=shown, args=(slicer.stdout, sent, took))
    reader.start()
    with open(fifo, "w", buffering=1) as to:
        due = time.monotonic()
        for i in range(poses):
            sent.append(time.monotonic())
            to.write(live_pose(i))
            due += 1 / 60
            time.sleep(max(0, due - time.monotonic()))
    solver.send_signal(signal.SIGINT)
    reader.join(60)
    if slicer.wait() or solver.wait():
        sys.exit("live.py: a tool failed")
    took = sorted(took[20:])
    middle = took[len(took) // 2]
    print("%s,%s,%d,%d,%.3f,%.3f,%.3f,%s" % (method, threads, poses, len(took) + 20, 1e3 * took[0], 1e3 * middle, 1e3 * took[len(took) * 95 // 100],
                                             "%.3g" % (middle * rate) if rate else ""))


def run_face(folder, side, device):
    model, fifo = make_face(bin, root, folder, side), os.path.join(folder, "face-" + device)
    muscles, seconds = names_in(bin, model, "muscle.name"), 10
    command = [bin + "/tled-run", "-d", device, "--precision", "single", "--threads", threads, "--live", "-t", str(seconds), "--control", fifo]
    for material in names_in(bin, model, "material.name"):
        command += ["-m", material + ".nu=0.45"]
    os.mkfifo(fifo)
    solver = subprocess.Popen(command, stdin=open(model, "rb"), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    with open(fifo, "w", buffering=1) as to:
        signal.signal(signal.SIGPIPE, signal.SIG_IGN)
        try:
            for i in range(4 * seconds):
                for muscle in muscles:
                    to.write("now contract %s %g\n" % (muscle, .2 * (i % 4 == 0)))
                time.sleep(.25)
            said = solver.communicate(timeout=300)[1]
        except BrokenPipeError:
            said = solver.communicate(timeout=300)[1]
    elements, ratio = re.search(r"(\d+) elements", said), re.search(r"(\d+) frames in ([\d.]+) s, (\S+) of real time", said)
    if solver.returncode or not elements or not ratio:
        sys.exit("live.py: a face: status %s\n%s" % (solver.returncode, said))
    print("%s,%s,%s,%s,%s,%s,%s" % ((device, threads, side, elements.group(1)) + ratio.groups()))


def run_faces(folder):
    print("face,threads,side_mm,elements,frames,seconds,of_real_time", flush=True)
    only = os.environ.get("FACE_ONLY")
    if only != "cuda":
        run_face(folder, "2.5", "cpu")
    if only == "cuda" or (not only and os.path.exists("/proc/driver/nvidia/version")):
        run_face(folder, "1.25", "cuda")


def probe_rate(path):
    """Multiply-adds a second, of one processor."""
    with open(path) as file:
        return next((float(line.rsplit(",", 1)[1]) for line in file if line.startswith('"probe: multiply-add",')), 0)


rate = probe_rate(sys.argv[3]) if len(sys.argv) > 3 else 0
if os.environ.get("FACE_ONLY"):
    with tempfile.TemporaryDirectory() as folder:
        run_faces(folder)
    sys.exit(0)
with tempfile.TemporaryDirectory() as folder:
    volume, mesh = os.path.join(folder, "noise.nrrd"), os.path.join(folder, "mesh.sinew")
    with open(volume, "wb") as to:
        to.write(b"NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 256 256 256\nspace directions: (0.625,0,0) "
                 b"(0,0.3125,0) (0,0,0.3125)\nencoding: raw\nspace origin: (0.3125,0.15625,0.15625)\n\n" + os.urandom(256 ** 3))
    subprocess.run([bin + "/msds-mesh", "-q", "--nodes", "20x10x10", "--size", "16cm,8cm,8cm", "--fix", "zmax", "-o", mesh], check=True)
    print("method,threads,poses_under_way,images,least_ms,median_ms,p95_ms,images_a_second")
    for method in "msds", "fem":
        for under_way in 1, ahead:
            run(method, folder, mesh, volume, under_way)
    subprocess.run([bin + "/msds-mesh", "-q", "--nodes", "32x16x16", "--size", "16cm,8cm,8cm", "--fix", "zmax", "-o", mesh], check=True)
    print("live,threads,poses,shown,least_ms,median_ms,p95_ms,median_multiply_adds")
    for method in "msds", "fem", "exact":
        run_live(method, folder, mesh, volume)
    run_faces(folder)
