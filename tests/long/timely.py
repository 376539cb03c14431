"""timely.py: results as TAP, and whether what was sent was seen in time, beside what this machine adds to any delay."""
import statistics
import threading
import time

RATE = 60  # Hz: of what is sent
counted = {"tests": 0, "failures": 0}


def ok(passed, name):
    counted["tests"] += 1
    counted["failures"] += not passed
    print("%sok %d - %s" % ("" if passed else "not ", counted["tests"], name), flush=True)
    return passed


def diag(text):
    print("".join("# %s\n" % line for line in text.rstrip().split("\n")), end="", flush=True)


class Metronome(threading.Thread):
    """How late this process is woken, s: what the machine, if it does other work too, adds to any delay that is measured here."""

    def __init__(self):
        super().__init__(daemon=True)
        self.late = []
        self.start()

    def run(self):
        while True:
            due = time.monotonic() + .01
            time.sleep(.01)
            self.late.append(time.monotonic() - due)

    def slack(self, share):
        """Of the tools' threads, of which several follow each other."""
        late = sorted(self.late) or [0]
        return .005 + 6 * late[min(len(late) - 1, int(len(late) * share))]


def share_of(numbers, share):
    return sorted(numbers)[min(len(numbers) - 1, int(len(numbers) * share))]


def frame_of(apart):
    """The length of the frame that is being made at a time at random, s."""
    return sum(length * length for length in apart) / sum(apart)


def timely(name, waits, frames, slack):
    """Whether what was sent was seen in time. waits: of each, the s until it or what was sent after it was seen, and the s that the frame took that was
    being made when it came, with the one that has it: the longest that it may have waited. frames: for each program that it passed, s between frames."""
    if not ok(len(waits) > 10 and min(len(apart) for apart in frames) > 4, "%s: %d were sent and seen" % (name, len(waits))):
        return
    took, each = [wait for wait, _ in waits], [max(1 / RATE, frame_of(apart)) for apart in frames]
    usual, most = slack(.5), slack(.95)  # once: each sorts all that the metronome has
    middle, late = statistics.median(took), sum(wait > may + most for wait, may in waits)
    diag("%s: ms until it is seen: median %.1f, 95 %% %.1f, largest %.1f; a frame in %s; this machine may add %.1f, and %.1f to the largest" %
         (name, 1e3 * middle, 1e3 * share_of(took, .95), 1e3 * max(took), " and ".join("%.1f" % (1e3 * length) for length in each),
          1e3 * usual, 1e3 * most))
    ok(late <= .02 * len(waits), "%s: each is in the frame after the one that was being made: %d of %d are not" % (name, late, len(waits)))
    ok(middle <= 1.5 * sum(each) + usual, "%s: the median is within half a frame and one: %.1f ms" % (name, 1e3 * middle))
