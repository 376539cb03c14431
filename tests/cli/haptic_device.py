# A haptic device for tests/cli/haptics.t: haptic_device.py SOCKET POSES LINES [BODY]. A mass that a hand's spring pulls into
# tissue, in simulated time: it writes a pose to the FIFO, waits for the line of that pose, and goes on by 1/60 s in steps of 1 ms by
# F(x) = F0 - K (x - x0), as HAPTICS in msds-run(1) has it. All lines go to the file LINES; where it comes to is printed.
# BODY: the hand's way is in a body that is turned by 90 degrees about x.
import socket
import sys
import time

MASS, HAND, GRIP = .1, 300, 2
turned = len(sys.argv) > 4


def place(v):
    """From the model's axes to those of poses."""
    return [v[0], -v[2], v[1]] if turned else v


start, goal = place([.04, .04, .061]), place([.042, .04, .051])
turn = '0.70710678118654752 0 0 -0.70710678118654752' if turned else None
# The probe looks along -z of the model: 1 0 0 0; in the turned body this is that after a quarter turn about x.
facing = '0.70710678118654752 0 0 -0.70710678118654752' if turned else '1 0 0 0'

s = socket.socket(socket.AF_UNIX)
s.connect(sys.argv[1])
lines = s.makefile()
poses = open(sys.argv[2], 'w', buffering=1)
log = open(sys.argv[3], 'w')
x, v = list(start), [0, 0, 0]
before = 0
for frame in range(70):
    sent = time.monotonic()
    poses.write('%d %.9g %.9g %.9g %s\n' % (frame, *x, facing))
    while True:
        line = next(lines)
        log.write(line)
        word = line.split()
        assert word[0] == 'haptic' and len(word) == 54, line
        n = [float(w) for w in word[1:]]
        came, made = n[1], n[2]
        at, force, k = n[4:7], n[11:14], [n[17 + 6 * i:23 + 6 * i] for i in range(6)]
        assert before <= made <= time.monotonic(), 'made at %f' % made
        before = made
        if came >= sent:
            break
    assert came <= made and max(abs(a - b) for a, b in zip(at, x)) < 1e-8, 'a line of another pose'
    gone = min(1, frame / 15)
    for _ in range(16):
        f = [force[i] - sum(k[i][j] * (x[j] - at[j]) for j in range(3)) for i in range(3)]
        if sum(a * b for a, b in zip(f, force)) < 0:
            f = [0, 0, 0]
        for i in range(3):
            v[i] += (f[i] + HAND * (start[i] + gone * (goal[i] - start[i]) - x[i]) - GRIP * v[i]) / MASS / 1000
            x[i] += v[i] / 1000
speed = sum(a * a for a in v) ** .5
pull = [HAND * (goal[i] - x[i]) for i in range(3)]
size = sum(a * a for a in pull) ** .5
off = sum((pull[i] + force[i]) ** 2 for i in range(3)) ** .5 / size
print('rest' if speed < 2e-3 else 'moves at %g m/s' % speed,
      'balance' if off < .03 else 'off by %g' % off,
      'pressed' if size > .3 else 'touched with %g N' % size)
