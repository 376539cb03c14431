"""What `sinew igtl-in` makes of messages, which are written here from OpenIGTLink's specification, byte by byte, with a checksum bit by
bit. Prints `ok NAME` or `not ok NAME` and what was seen. Each case has a thread, and a tool, of its own."""
import math
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
import time

results = {}
CASES = []


def crc(data):
    value = 0
    for byte in data:
        for bit in range(7, -1, -1):
            out = (value >> 63) ^ (byte >> bit & 1)
            value = (value << 1) & 0xFFFFFFFFFFFFFFFF
            if out:
                value ^= 0x42F0E1EBA9EA3693
    return value


def message(kind, name, content, stamp=0.0, meta=None, wrong=0):
    """Header version 1, or with metadata (a list of pairs) version 2."""
    body = content
    if meta is not None:
        head = struct.pack('>H', len(meta)) + b''.join(struct.pack('>HHI', len(k), 3, len(v)) for k, v in meta)
        text = b''.join(k + v for k, v in meta)
        body = struct.pack('>HHII', 12, len(head), len(text), 0) + content + head + text
    whole = int(stamp)
    return struct.pack('>H12s20sIIQQ', 1 if meta is None else 2, kind.encode(), name.encode(), whole, int((stamp - whole) * 2**32), len(body),
                       crc(body) ^ wrong) + body


def matrix(x=0., y=0., z=0., rotation=(1, 0, 0, 0, 1, 0, 0, 0, 1)):
    """3 x 4, columns first; the rotation's columns."""
    return struct.pack('>12f', *rotation, x, y, z)


def transform(name, stamp=0., x=0., **more):
    return message('TRANSFORM', name, matrix(x), stamp, **more)


class Server:
    def __init__(self):
        self.listening = socket.create_server(('127.0.0.1', 0))
        self.port = self.listening.getsockname()[1]

    def accept(self):
        self.listening.settimeout(10)
        peer = self.listening.accept()[0]
        peer.settimeout(10)
        return peer


def receive(peer, size):
    data = b''
    while len(data) < size:
        more = peer.recv(size - len(data))
        if not more:
            raise EOFError
        data += more
    return data


def receive_message(peer):
    head = receive(peer, 58)
    version, kind, name, _, size, check = struct.unpack('>H12s20sQQQ', head)
    body = receive(peer, size)
    return version, kind.rstrip(b'\0').decode(), body, crc(body) == check


class Tool:
    def __init__(self, *arguments, stdout=subprocess.PIPE):
        self.run = subprocess.Popen(['sinew-igtl-in', *arguments], stdout=stdout, stderr=subprocess.PIPE, text=True)
        self.said = []
        self.reader = threading.Thread(target=self.listen, daemon=True)
        self.reader.start()

    def listen(self):
        for line in self.run.stderr:
            self.said.append(line.rstrip('\n'))

    def wait_for(self, text, seconds=10):
        until = time.time() + seconds
        while time.time() < until:
            if any(text in line for line in list(self.said)):
                return True
            time.sleep(.005)
        return False

    def port(self):
        self.wait_for('listening at ')
        return int([line for line in self.said if 'listening at ' in line][0].rsplit(':', 1)[1])

    def line(self):
        return [float(word) for word in self.run.stdout.readline().split()]

    def end(self, stop=True):
        if stop and self.run.poll() is None:
            self.run.send_signal(signal.SIGTERM)
        try:
            self.rest = self.run.stdout.read() if self.run.stdout else ''
            status = self.run.wait(10)
        except subprocess.TimeoutExpired:
            self.run.kill()
            status = 'none'
        self.reader.join(5)
        self.all = '\n'.join(self.said)
        return status


def check(name, good, *seen):
    results.setdefault(threading.current_thread().name, []).append((bool(good), name, seen))


def near(line, wanted):
    return len(line) == len(wanted) and all(abs(a - b) < 1e-6 for a, b in zip(line, wanted))


def case(function):
    CASES.append(function)
    return function


@case
def poses():
    server = Server()
    tool = Tool('--transform', 'ProbeToReference', '--rate', '40', f'localhost:{server.port}')
    peer = server.accept()
    version, kind, body, sound = receive_message(peer)
    check('a tracker is asked for its tools', (version, kind, sound) == (1, 'STT_TDATA', True) and len(body) == 36, version, kind, body)
    check('every 25 ms, for 40 a second', struct.unpack('>I', body[:4])[0] == 25, body)
    # A quarter of a turn about x: the columns are x, z, -y. In RAS; half a turn about z makes it LPS.
    turned = (1, 0, 0, 0, 0, 1, 0, -1, 0)
    peer.sendall(message('TRANSFORM', 'ProbeToReference', matrix(10, 20, 30, turned), 1000.5))
    half = math.sqrt(.5)
    line = tool.line()
    check('a place in RAS mm is one in LPS m; and the first time is 0', near(line[:4], [0, -.01, -.02, .03]), line)
    # R = diag(-1, -1, 1) Rx(90): half a turn about z after a quarter about x, as quaternions (0 0 1 0) (s 0 0 s).
    wanted = [0, half, half, 0]
    check('the axes of the probe stay its own: the space is turned', near(line[4:], wanted) or near(line[4:], [-q for q in wanted]), line)
    peer.sendall(message('TRANSFORM', 'Other', matrix(1, 2, 3), 1001.))
    peer.sendall(message('IMAGE', 'Image', bytes(300000), 1001.) + message('TRANSFORM', 'ProbeToReference', matrix(1, 2, 3), 1001.75))
    line = tool.line()
    check('time goes on by the stamps; other poses and images are passed over', near(line[:4], [1.25, -.001, -.002, .003]), line)
    tool.run.send_signal(signal.SIGINT)
    check('in the end it is told to stop', receive_message(peer)[1] == 'STP_TDATA')
    check('SIGINT is a normal end, with counts', tool.end() == 0 and '2 poses; 1 connection' in tool.all, tool.all)


@case
def kinds():
    server = Server()
    tool = Tool('--transform', 'Stylus', '--space', 'lps', '-v', f'127.0.0.1:{server.port}')
    peer = server.accept()
    half = math.sqrt(.5)
    peer.sendall(message('RTS_TDATA', '', b'\1') + message('STRING', 'Log', struct.pack('>HH', 3, 5) + b'hello'))
    peer.sendall(message('STATUS', 'Tracker', struct.pack('>Hq20s', 13, 7, b'Warming') + b'the cameras warm up\0'))
    tools = b''.join(struct.pack('>20sBB', name, 2, 0) + matrix(x) for name, x in ((b'Probe', 1), (b'Stylus', 2)))
    peer.sendall(message('TDATA', 'Tracker', tools, 5.))
    check('a tool of TDATA, by its name, in LPS', near(tool.line(), [0, .002, 0, 0, 0, 0, 0, 1]))
    time.sleep(1.05)  # another kind of message is heard when the first one has ended
    position = struct.pack('>3f', 1, 2, 3)
    peer.sendall(message('POSITION', 'Stylus', position + struct.pack('>4f', 0, 0, half, half), 6.5))
    check('POSITION with a quaternion of four numbers', near(tool.line(), [1.5, .001, .002, .003, 0, 0, half, half]))
    peer.sendall(message('POSITION', 'Stylus', position + struct.pack('>3f', half, 0, 0), 7.))
    check('of three, w being what is left', near(tool.line(), [2, .001, .002, .003, half, 0, 0, half]))
    peer.sendall(message('POSITION', 'Stylus', position, 7.25))
    check('and none', near(tool.line(), [2.25, .001, .002, .003, 0, 0, 0, 1]))
    tool.end()
    check('a STATUS is told', f'127.0.0.1:{server.port}: status 13 (device not ready), Warming: the cameras warm up' in tool.all, tool.all)
    check('a STRING with -v', "'Log' says: hello" in tool.all, tool.all)
    check('that TDATA is refused too', 'refuses to send TDATA' in tool.all, tool.all)


@case
def loss():
    server = Server()
    tool = Tool('--transform', 'ProbeToTracker', '--timeout', '.2', '--protocol', '3', f'127.0.0.1:{server.port}')
    peer = server.accept()
    version, kind, body, _ = receive_message(peer)
    check('with protocol 3, a peer is spoken to so', (version, kind, body[:2]) == (2, 'GET_STATUS', b'\0\x0c'), version, kind, body)
    fine, hidden = [(b'TransformStatus', b'OK')], [(b'TransformValid', b'0'), (b'TransformStatus', b'OUT_OF_VIEW')]
    for k in range(3):
        peer.sendall(transform('ProbeToTracker', 10 + .01 * k, k, meta=hidden if k else fine))
    tool.line()
    check('a pose that PLUS says is out of view is lost', tool.wait_for('ProbeToTracker: not tracked: it is OUT_OF_VIEW; the last pose stays'))
    peer.sendall(transform('ProbeToTracker', 10.1, 5))
    check('it is no line', near(tool.line()[:2], [.1, -.005]) and tool.wait_for('tracked again after'))
    peer.sendall(message('TRANSFORM', 'ProbeToTracker', bytes(48), 10.2))
    check('a matrix of zeros is none', tool.wait_for('its matrix is 0'))
    peer.sendall(transform('ProbeToTracker', 10.3, 5) + message('TRANSFORM', 'ProbeToTracker', matrix(math.nan), 10.4))
    check('nor is one that is not finite', tool.wait_for('its numbers are not finite'))
    peer.sendall(transform('ProbeToTracker', 10.5, 5))
    check('silence is a loss', tool.wait_for('ProbeToTracker: no pose for 0.'))
    time.sleep(.3)
    peer.sendall(transform('ProbeToTracker', 11, 5))
    tool.wait_for('tracked again after 0.5 s')
    status = tool.end()
    told = [line for line in tool.said if 'stays' in line]
    check('each loss is told once', status == 0 and len(told) == 4 and tool.all.count('tracked again') == 4, status, tool.all)
    check('and counted', '5 poses; 4 not tracked' in tool.all, tool.all)


@case
def wrong():
    server = Server()
    tool = Tool('--transform', 'Probe', f'127.0.0.1:{server.port}')
    peer = server.accept()
    peer.sendall(transform('Probe', 1, 1) + transform('Probe', 2, 2, wrong=1) + transform('Probe', 2, 2, wrong=5))
    peer.sendall(message('TRANSFORM', 'Probe', bytes(20)) + message('POSITION', 'Probe', bytes(16)) + message('TDATA', 'T', bytes(71)))
    peer.sendall(message('TRANSFORM', 'Probe', struct.pack('>12f', 2, 0, 0, 0, 2, 0, 0, 0, 2, 1, 2, 3), 2.))
    peer.sendall(transform('Probe', 3, 3))
    check('wrong messages are skipped', near(tool.line()[:2], [0, -.001]) and near(tool.line()[:2], [2, -.003]))
    peer.sendall(transform('Probe', 4, 4)[:70])
    peer.close()
    check('a half message is told', tool.wait_for('the connection has ended inside a message; trying to connect again'))
    peer = server.accept()
    peer.sendall(transform('Probe', 5, 5))
    check('it connects again', near(tool.line()[:2], [4, -.005]) and tool.wait_for('connected again after'))
    peer.sendall(struct.pack('>H12s20sQQQ', 1, b'TRANSFORM', b'Probe', 0, 2**63, 0))
    check('a body of 2^63 bytes', tool.wait_for("TRANSFORM 'Probe': a body of 9223372036854775808 bytes; expected"))
    peer = server.accept()
    peer.sendall(transform('Probe', 6, 6) + b'GET / HTTP/1.1\r\n' * 6)
    tool.line()
    check('garbage', tool.wait_for('no OpenIGTLink: the version of a header is 18245; expected 1 or 2; trying to connect again'))
    server.accept()
    status = tool.end()
    check('a checksum, once', tool.all.count('the checksum is') == 1, tool.all)
    check('a content that is too short', "TRANSFORM 'Probe': a content of 20 bytes; expected at least 48" in tool.all, tool.all)
    check('a matrix with scale', 'Probe: a matrix with scale' in tool.all, tool.all)
    check('all are counted', status == 0 and '4 poses; 6 wrong messages skipped; 2 of these for their checksums; 4 connections' in tool.all, tool.all)


@case
def choices():
    def several(*names, arguments=()):
        server = Server()
        tool = Tool(*arguments, f'127.0.0.1:{server.port}')
        return tool, server.accept(), names

    def sends(peer, names, stamp):
        for name in names:
            peer.sendall(transform(name, stamp, len(name)))

    first = several('StylusToReference', 'ProbeToReference')
    ambiguous = several('StylusTip', 'Needle', 'StylusTip')
    only = several('Needle')
    second = several('ProbeToTracker', 'Needle')
    absent = several('StylusTip', 'Needle', arguments=('--transform', 'Probe'))
    long = several('ProbeOfTheFirstPersonToReference', arguments=('--transform', 'ProbeOfTheFirstPersonToReference'))
    long[1].sendall(message('TRANSFORM', 'ProbeOfTheFirstPerso', matrix(7), 1.))
    long[1].sendall(message('TRANSFORM', 'ProbeOfTheFirstPerso', matrix(8), 2., [(b'IGTL_DEVICE_NAME', b'ProbeOfTheFirstPersonToReference')]))
    check('a name that a header has cut', near(long[0].line()[:2], [0, -.007]))
    check('is whole in the metadata', near(long[0].line()[:2], [1, -.008]))
    sends(first[1], first[2], 1)
    check('ProbeToReference is taken at once', near(first[0].line()[:2], [0, -.016]) and first[0].wait_for('taken, of: StylusToReference'))
    for k in range(24):
        for _, peer, names in (ambiguous, only, second, absent):
            try:
                sends(peer, names, 1 + k / 10)
            except OSError:
                pass
        time.sleep(.05)
    status = ambiguous[0].end(stop=False)
    check('of several, one has to be named', status == 1 + 1 and 'several poses are sent: StylusTip, Needle; expected --transform NAME'
          in ambiguous[0].all, status, ambiguous[0].all)
    check('the only one is taken', near(only[0].line()[1:2], [-.006]) and only[0].wait_for('Needle is taken'))
    check('ProbeToTracker, of several', near(second[0].line()[1:2], [-.014]) and second[0].wait_for('ProbeToTracker is taken, of'))
    check('a name that does not come: what does', absent[0].wait_for("no 'Probe' has come; there are: StylusTip, Needle"))
    for tool, _, _ in (long, first, only, second, absent):
        tool.end()


@case
def comes_and_goes():
    server = Server()
    port = server.port
    server.listening.close()
    tool = Tool('--transform', 'Probe', f'127.0.0.1:{port}')
    check('nothing listens yet: told', tool.wait_for(f'127.0.0.1:{port}: cannot connect: Connection refused; trying until it listens'))
    time.sleep(.25)
    server.listening = socket.create_server(('127.0.0.1', port))
    peer = server.accept()
    peer.sendall(transform('Probe', 100, 1))
    tool.line()
    peer.close()
    tool.wait_for('the connection has ended; trying to connect again')
    peer = server.accept()
    peer.sendall(transform('Probe', 50, 2) + transform('Probe', 50.5, 3))
    lines = [tool.line(), tool.line()]
    check('a sender that begins anew: times go on', 0 < lines[0][0] < 5 and near([lines[1][0] - lines[0][0]], [.5]), lines)
    status = tool.end()
    check('told once', status == 0 and tool.all.count('cannot connect') == 1 and tool.all.count('time stamps jump') == 1, tool.all)
    check('and counted', '3 poses; 1 jumps of time stamps; 2 connections' in tool.all, tool.all)


@case
def stamps():
    server = Server()
    tool = Tool('--transform', 'Probe', f'127.0.0.1:{server.port}')
    peer = server.accept()
    for stamp in (100, 100.5, 100.25, 100.4, 101, 5000, 5000.5):
        peer.sendall(transform('Probe', stamp, stamp))
    lines = [tool.line() for _ in range(5)]
    times = [line[0] for line in lines]
    check('a stamp before the last one is skipped', near(times[:3], [0, .5, 1]), times)
    check('one that is far ahead is a jump', 1 <= times[3] < 2 and near([times[4] - times[3]], [.5]), times)
    status = tool.end()
    check('both are told', status == 0 and 'a time stamp is 0.25 s before the last one' in tool.all and re.search(
        r'time stamps jump by 489[89]', tool.all), tool.all)
    tool = Tool('--transform', 'Probe', f'127.0.0.1:{server.port}')
    peer = server.accept()
    peer.sendall(transform('Probe'))
    first = tool.line()
    time.sleep(.1)
    peer.sendall(transform('Probe'))
    second = tool.line()
    tool.end()
    check('without stamps: when they came', first[0] == 0 and .1 <= second[0] < .6, first, second)


@case
def listening():
    tool = Tool('--transform', 'Probe', '--listen', '0')
    port = tool.port()
    peers = [socket.create_connection(('127.0.0.1', port)) for _ in range(100)]
    taken = Tool('--listen', str(port))
    status = taken.end(stop=False)
    check('a port that is taken', status == 1 and f'127.0.0.1:{port}: cannot listen: Address already in use' in taken.all, status, taken.all)
    peers[40].sendall(transform('Probe', 1, 1))
    line = tool.line()
    peers[70].sendall(transform('Probe', 1.1, 2))
    check('a second sender of the same pose is left out', near(line[:2], [0, -.001]) and tool.wait_for('sends Probe too; it is left out'))
    peers[3].sendall(b'x' * 100)
    check('one that sends garbage is told', tool.wait_for('no OpenIGTLink'))
    peers[40].close()
    tool.wait_for('the connection has ended')
    peers[70].sendall(transform('Probe', 1.2, 3))
    check('when the first has gone, the second is heard', near(tool.line()[:2], [.2, -.003]))
    for peer in peers:
        peer.close()
    until = time.time() + 5
    while sum('ended' in line or 'OpenIGTLink' in line for line in tool.said) < 100 and time.time() < until:
        time.sleep(.01)
    status = tool.end()
    check('100 programs: a line for each that comes and goes', status == 0 and tool.all.count(': connected') == 100 and sum(
        'ended' in line or 'OpenIGTLink' in line for line in tool.said) == 100 and '100 connections' in tool.all, status, tool.all[-600:])


@case
def slow():
    server = Server()
    tool = Tool('--transform', 'Probe', f'127.0.0.1:{server.port}')
    peer = server.accept()
    body = transform('Probe', 1)
    many = 3000
    for k in range(many):
        peer.sendall(body[:34] + struct.pack('>II', 1, int(k / many * 2**32)) + body[42:])
        if k == many - 1:
            time.sleep(.2)
    lines = tool.run.stdout
    times = []
    while not times or times[-1] < (many - 1) / many - 1e-4:
        times.append(float(lines.readline().split()[0]))
    status = tool.end()
    check('a reader that is slow: poses are dropped, and the newest comes next', 20 < len(times) < 400 and times == sorted(times), len(times))
    check('which is counted', status == 0 and f'{many - len(times)} dropped, as their reader was slow' in tool.all, tool.all)
    # The same with a reader that goes away.
    tool = Tool('--transform', 'Probe', f'127.0.0.1:{server.port}')
    peer = server.accept()
    tool.run.stdout.close()
    tool.run.stdout = None
    status = tool.end(stop=False)
    check('a reader that goes away: a quiet end', status == 0 and len(tool.said) <= 1, status, tool.all)


@case
def files():
    server = Server()
    path = os.path.join(os.environ['T'], 'poses.tum')
    tool = Tool('--transform', 'Probe', '-o', path, f'127.0.0.1:{server.port}')
    peer = server.accept()
    peer.sendall(b''.join(transform('Probe', 1 + k / 10, k) for k in range(5)) + message('STATUS', '', struct.pack('>Hq20s', 4, 0, b'') + b'x'))
    tool.wait_for('status 4')
    before = os.path.exists(path)
    status = tool.end()
    text = open(path).read().splitlines()
    check('a file has all poses, and appears when it is whole', status == 0 and not before and len(text) == 5, status, text)
    check('of which the last', text[4] == '0.400000 -0.004 0 0 0 0 1 0', text)
    tool = Tool('--transform', 'Probe', f'127.0.0.1:{server.port}', stdout=open('/dev/full', 'w'))
    peer = server.accept()
    peer.sendall(transform('Probe', 1))
    status = tool.end(stop=False)
    check('a full disk', status == 1 and 'cannot write the poses: No space left on device' in tool.all, status, tool.all)


@case
def lists():
    server = Server()
    tool = Tool('--list', '.5', f'127.0.0.1:{server.port}')
    peer = server.accept()
    tools = b''.join(struct.pack('>20sBB', name, 2, 0) + matrix() for name in (b'Probe', b'Stylus'))
    for k in range(10):
        peer.sendall(transform('NeedleToTracker', k) + message('TDATA', 'Tracker', tools) + message('IMAGE', 'Image', bytes(100)))
        time.sleep(.02)
    status = tool.end(stop=False)
    rows = [row.split() for row in tool.rest.splitlines()[1:]]
    check('a list of what is sent', status == 0 and [(row[0], row[2], row[3]) for row in rows] == [
        ('TRANSFORM', '10', 'NeedleToTracker'), ('TDATA', '10', 'Probe'), ('TDATA', '10', 'Stylus'), ('IMAGE', '10', 'Image')], rows, tool.all)
    check('with how often', all(20 < float(row[1]) < 60 for row in rows), rows)
    tool = Tool('--list', '.1', '--listen', '0')
    check('of nothing', tool.end(stop=False) == 1 and 'nothing has connected' in tool.all, tool.all)


@case
def no_openigtlink():
    server = Server()
    tool = Tool(f'127.0.0.1:{server.port}')
    peer = server.accept()
    peer.sendall(b'SSH-2.0-OpenSSH_9.2p1 Debian-2+deb12u3 and so on and so forth\r\n')
    status = tool.end(stop=False)
    check('a port of another kind ends it', status == 1 and f'127.0.0.1:{server.port}: no OpenIGTLink' in tool.all, status, tool.all)


def main():
    threads = [threading.Thread(target=function, name=function.__name__) for function in CASES if not sys.argv[1:] or function.__name__ in sys.argv]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    for thread in threads:
        for good, name, seen in results.get(thread.name, []):
            print(f'{"ok" if good else "not ok"} {thread.name}: {name}')
            if not good:
                for one in seen:
                    for line in str(one).splitlines():
                        print('# ' + line)
        print(f'{"not ok" if thread.is_alive() or not results.get(thread.name) else "ok"} {thread.name}: came to its end')


def died(problem):
    results.setdefault(problem.thread.name, []).append((False, 'died', (repr(problem.exc_value), )))


threading.excepthook = died
main()
sys.stdout.flush()
os._exit(0)
