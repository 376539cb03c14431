"""live.py BIN [THREADS]: the chain as it is used live: a pose goes into a FIFO, msds-run solves, us-slice draws, and the clock is stopped when
the last byte of the image has come out of the pipe. 20 x 10 x 10 nodes, 512 x 512 pixels, 256^3 voxels of noise. Prints CSV: latency from pose
to image, and images a second when the next pose goes in as soon as an image is out, and when three are always under way."""
import os
import subprocess
import sys
import tempfile
import time

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
