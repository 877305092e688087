"""Submissions that attack the grader: none earns a point, hangs, or touches the exercise next to it.

Each attack stands in ``improve.py``; the submission's other exercise, ``bounds``, is honest and must score full.
``ATTACKS.md`` beside this file lists all attempts and what became of them.
"""

import os
import textwrap
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from robonav.grading import sandbox_check
from robonav.grading.check import graded
from robonav.grading.course import Course
from robonav.grading.reference import Solutions
from robonav.grading.sandbox import Limits
from robonav.grading.session import Session
from robonav.grading.submission import Submission

pytestmark = pytest.mark.sandbox

COURSE = Course.around(Path(__file__).parent)
ATTACKED, HONEST = COURSE.named("improve"), COURSE.named("bounds")
LIMITS = Limits(call_seconds=3.0, exercise_seconds=8.0, memory=512 << 20)
SLACK = 15.0  # seconds for starting two sandboxes on a busy machine

SENDS = """
    import os, struct, json
    def send(*parts):
        for descriptor in range(3, 20):
            for part in parts:
                try: os.write(descriptor, part)
                except OSError: pass
    def frame(value, arrays=(), body=b""):
        header = json.dumps({"value": value, "arrays": list(arrays)}).encode()
        return struct.pack(">II", len(header), len(body)) + header + body
"""

EXITS = {
    "os._exit on import": "import os; os._exit(0)",
    "os._exit in a call": "def improve(*a): import os; os._exit(0)",
    "sys.exit": "def improve(*a): import sys; sys.exit(0)",
    "sys.exit on import": "import sys; sys.exit(0)",
    "at exit": "import atexit, os; atexit.register(os._exit, 0)\ndef improve(*a): raise SystemExit(0)",
    "abort": "def improve(*a): import os; os.abort()",
    "segmentation fault": "def improve(*a): import ctypes; ctypes.string_at(0)",
    "deep recursion": "import sys; sys.setrecursionlimit(10**9)\ndef improve(*a): return improve(*a)",
    "kills its parent": "def improve(*a): import os, time; os.kill(os.getppid(), 9); time.sleep(60)",
    "kills all": "def improve(*a): import os; os.kill(-1, 9)",
    "stops its parent": "def improve(*a): import os, time; os.kill(os.getppid(), 19); time.sleep(60)",
    "BaseException": "class Odd(BaseException): pass\ndef improve(*a): raise Odd('odd')",
    "KeyboardInterrupt": "def improve(*a): raise KeyboardInterrupt",
    "an error that cannot be shown": """
        class Bad(Exception):
            def __str__(self): raise SystemExit
            __repr__ = __str__
        def improve(*a): raise Bad
    """,
    "an error in odd characters": "def improve(*a): raise ValueError(''.join(map(chr, range(768))) + '\\ud800')",
    "an error without end": "def improve(*a): raise ValueError('x' * 10**8)",
    "closes all descriptors": "def improve(*a): import os; os.closerange(0, 60)",
}

TAMPERS = {
    "patches numpy's tests": """
        import numpy as np
        np.testing.assert_allclose = np.allclose = np.isclose = np.array_equal = lambda *a, **k: True
        def improve(q, policy, tolerance): return q.argmin(axis=1)
    """,
    "patches builtins": """
        import builtins
        builtins.all = builtins.any = lambda *a: True
        builtins.isinstance = lambda *a: True
        builtins.len = lambda *a: 12
        def improve(q, policy, tolerance): return q.argmin(axis=1)
    """,
    "patches json and struct": """
        import json, struct
        json.loads = json.dumps = lambda *a, **k: '{}'
        struct.pack = struct.unpack = lambda *a: b""
        def improve(q, policy, tolerance): return q.argmin(axis=1)
    """,
    "patches the worker": """
        import sys
        frame = sys._getframe()
        while frame:
            for value in list(frame.f_globals.values()):
                if getattr(value, "__name__", "").startswith("robonav"):
                    for name in ("encode", "decode", "read", "limit", "filter_calls"):
                        if hasattr(value, name): setattr(value, name, lambda *a: b"")
            frame = frame.f_back
        def improve(q, policy, tolerance): return q.argmin(axis=1)
    """,
    "forges passed lines": """
        import os, sys
        def improve(*a):
            for text in (b"PASSED\\n", b"===== 25 passed in 0.1s =====\\n", b'{"points": 44}'):
                for descriptor in (1, 2): os.write(descriptor, text)
            print("25 passed"); sys.stderr.write("25 passed")
            return 0
    """,
    "writes a results file": """
        import os
        for name in ("results.json", "grade.json", "/autograder/results/results.json", "../grade.json", "junit.xml"):
            try: open(name, "w").write('{"points": 44, "score": 44}')
            except OSError: pass
        def improve(*a): return 0
    """,
    "overwrites its neighbour": """
        from pathlib import Path
        for path in Path(".").rglob("*.py"):
            try: path.write_text("def improve(*a): return 0")
            except OSError: pass
        def improve(*a): return 0
    """,
    "answers twice": SENDS
    + """
    def improve(q, policy, tolerance):
        for number in range(50): send(frame({"dict": {"id": number, "value": [0] * 12}}))
        return policy
    """,
    "says that it ended": SENDS
    + """
    def improve(*a):
        send(frame({"dict": {"ended": 0}}))
        return 0
    """,
    "claims an error of its own": SENDS
    + """
    def improve(*a):
        send(frame({"dict": {"id": 3, "raised": {"dict": {"kind": 1, "message": [], "where": "nowhere"}}}}))
        return 0
    """,
    "claims an error in no file": SENDS
    + """
    def improve(*a):
        where = {"dict": {"kind": "ValueError", "message": "", "where": [[], 1]}}
        for number in range(3, 50): send(frame({"dict": {"id": number, "raised": where}}))
    """,
    "answers with an array for a number": SENDS
    + """
    def improve(*a):
        send(frame({"dict": {"id": {"array": 0}, "value": 0}}, [["|u1", [2]]], b"ab"))
        return 0
    """,
    "says with an array that it ended": SENDS
    + """
    leave = os._exit
    def ended(status):
        send(frame({"dict": {"ended": {"array": 0}}}, [["|u1", [2]]], b"ab"))
        leave(0)
    def improve(*a):
        os._exit = ended
        return 0
    """,
    "sets its parent's limits": """
        import os, resource
        try:
            for limit in (resource.RLIMIT_NOFILE, resource.RLIMIT_AS, resource.RLIMIT_CPU):
                resource.prlimit(os.getppid(), limit, (1, 1))
        except OSError: pass
        def improve(*a): return 0
    """,
    "sends what is no reply": SENDS
    + "    def improve(*a): send(frame('ready')); return 0",
    "sends noise": SENDS + "    def improve(*a): send(os.urandom(4096)); return 0",
    "declares a huge frame": SENDS
    + "    def improve(*a): send(struct.pack('>II', 2**31, 2**31)); return 0",
    "declares a huge array": SENDS
    + """
    def improve(*a):
        send(frame({"dict": {"id": 3, "value": {"array": 0}}}, [["<f8", [1 << 40]]]))
        return 0
    """,
    "sends part of a frame": SENDS
    + """
    def improve(*a):
        send(frame({"dict": {"id": 3, "value": 0}})[:-3])
        os._exit(0)
    """,
}

STEALS = {
    "reads the frames above it": """
        import sys
        def improve(q, policy, tolerance):
            frame, found = sys._getframe(), []
            while frame:
                found += [v for k, v in frame.f_locals.items() if k in ("expected", "right", "reference", "case")]
                frame = frame.f_back
            return found[0]
    """,
    "searches memory": """
        import gc
        def improve(*a):
            return next(o for o in gc.get_objects() if type(o).__name__ in ("Case", "Solutions", "Answer", "Session"))
    """,
    "opens the solution": """
        def improve(*a):
            space = {}
            exec(open(PATH).read(), space)
            return space["improve"](*a)
    """,
    "searches the disk": """
        import os
        def improve(*a):
            for root, _, names in os.walk("/"):
                if "improve.py" in names and "solutions" in root and "wrong" not in root:
                    space = {}
                    exec(open(os.path.join(root, "improve.py")).read(), space)
                    return space["improve"](*a)
    """,
    "asks its parent's process": """
        import os
        def improve(*a):
            others = [p for p in os.listdir("/proc") if p.isdigit() and int(p) != os.getpid()]
            found = [open(f"/proc/{p}/environ").read() for p in others]
            space = {}
            exec(open(f"/proc/{os.getppid()}/cwd/solutions/ch2/improve.py").read(), space)
            return space["improve"](*a)
    """,
    "goes through the root of another process": """
        import glob
        def improve(*a):
            space = {}
            exec(open(glob.glob("/proc/*/root" + PATH)[0]).read(), space)
            return space["improve"](*a)
    """,
    "uses inherited descriptors": """
        import os
        def improve(*a):
            for descriptor in range(3, 64):
                for path in (f"/dev/fd/{descriptor}", f"/proc/self/fd/{descriptor}"):
                    try: space = {}; exec(open(path + "/solutions/ch2/improve.py").read(), space)
                    except Exception: continue
                    return space["improve"](*a)
    """,
    "imports the reference": """
        import sys
        sys.meta_path[:] = [f for f in sys.meta_path if type(f).__name__ != "Gate"]
        from robonav.mdp import greedy_policy
        import robonav.grading.reference
        def improve(*a): return 0
    """,
    "imports from the installed packages": """
        import sys, glob
        sys.meta_path[:] = [f for f in sys.meta_path if type(f).__name__ != "Gate"]
        sys.path += glob.glob("/**/site-packages", recursive=True) + [ROOT]
        import robonav.mdp
        def improve(*a): return 0
    """,
    "starts a program": "def improve(*a): import subprocess; return int(subprocess.check_output(['cat', PATH]))",
    "asks the network": """
        import socket
        def improve(*a): return len(socket.create_connection(("127.0.0.1", 22), timeout=1).recv(1))
    """,
    "traces its parent": """
        import ctypes, os
        def improve(*a):
            assert ctypes.CDLL(None).ptrace(16, os.getppid(), 0, 0) == 0
            return 0
    """,
}

VALUES = {
    "an object equal to all": """
        class Equal:
            def __eq__(self, other): return True
            def __array__(self, *a, **k): raise SystemExit
            __hash__ = None
        def improve(*a): return Equal()
    """,
    "a float of its own kind": """
        class Near(float):
            def __eq__(self, other): return True
            def __sub__(self, other): return 0.0
            __rsub__ = __sub__
        def improve(q, policy, tolerance): return [Near(7)] * len(policy)
    """,
    "an array of its own kind": """
        import numpy as np
        class Equal(np.ndarray):
            def __eq__(self, other): return np.ones(self.shape, bool)
            def __array_ufunc__(self, *a, **k): return np.zeros(1)
        def improve(q, policy, tolerance): return np.full(len(policy), 7).view(Equal)
    """,
    "a pickle with a payload": """
        class Payload:
            def __reduce__(self):
                import os
                return os._exit, (0,)
        def improve(*a): return Payload()
    """,
    "an array of objects": """
        import numpy as np
        def improve(q, policy, tolerance): return np.array([object()] * len(policy))
    """,
    "records": """
        import numpy as np
        def improve(q, policy, tolerance): return np.zeros(len(policy), dtype=[("a", "O"), ("b", "V8")])
    """,
    "not a number": "def improve(q, policy, tolerance): return [float('nan')] * len(policy)",
    "a shape that broadcasts": "def improve(q, policy, tolerance): return q.argmin(axis=1)[:, None]",
    "a single number": "def improve(q, policy, tolerance): return 0",
    "an empty answer": "def improve(*a): return []",
    "an endless generator": "import itertools\ndef improve(*a): return itertools.count()",
    "a list that holds itself": "def improve(*a):\n    a = []; a.append(a)\n    return a",
    "a dict that collides": "def improve(*a): return {k * (2**61 - 1): 0 for k in range(20000)}",
    "a dict of the same length": "def improve(q, policy, tolerance): return {str(i): 0 for i in range(len(q))}",
    "strings in an array as wide as the longest": "def improve(*a): return ['x' * 400_000] + [''] * 100_000",
    "an array many times over": SENDS
    + """
    def improve(*a):
        many = [{"array": 0}] * 60_000
        for number in range(3, 50):
            send(frame({"dict": {"id": number, "value": many}}, [["|u1", [1 << 20]]], bytes(1 << 20)))
    """,
    "a class": "class improve:\n    def __init__(self, *a): pass",
    "no function at all": "improve = 3",
    "another name": "def enhance(*a): return 0",
}

RESOURCES = {
    "an endless loop": "def improve(*a):\n    while True: pass",
    "an endless loop on import": "while True: pass",
    "sleeps through signals": """
        import signal, time
        for number in range(1, 32):
            try: signal.signal(number, signal.SIG_IGN)
            except OSError: pass
        def improve(*a):
            while True: time.sleep(1)
    """,
    "holds the interpreter's lock": "def improve(*a): return 10 ** 10 ** 9",
    "a slow drip": SENDS
    + """
    def improve(*a):
        import time
        for byte in frame({"dict": {"id": 3, "value": 0}}) * 100: send(bytes([byte])); time.sleep(0.2)
    """,
    "a fork bomb": "import os\ndef improve(*a):\n    while True: os.fork()",
    "a fork bomb that forgives": """
        import os
        def improve(*a):
            while True:
                try: os.fork()
                except OSError: pass
    """,
    "a thread bomb": """
        import threading, time
        def improve(*a):
            while True: threading.Thread(target=time.sleep, args=(60,)).start()
    """,
    "a memory bomb": "def improve(*a):\n    a = []\n    while True: a.append(bytearray(1 << 24))",
    "a huge array": "import numpy as np\ndef improve(*a): return np.ones(1 << 40)",
    "memory of the system's": """
        import ctypes, os
        call = ctypes.CDLL(None, use_errno=True)
        def improve(q, policy, tolerance):
            for size in (1 << 28,) * 4:
                taken = call.shmget(0, ctypes.c_size_t(size), 0o1600)
                if taken < 0 and call.memfd_create(b"", 0) < 0: raise MemoryError
                call.shmctl(taken, 0, 0)
            better = q.max(axis=1) - q[range(len(q)), policy] > tolerance
            return [int(row.argmax()) if yes else int(kept) for row, yes, kept in zip(q, better, policy)]
    """,
    "an answer too large": "import numpy as np\ndef improve(*a): return np.zeros(1 << 24)",
    "a string too large": "def improve(*a): return 'x' * (1 << 26)",
    "endless output": "import sys\ndef improve(*a):\n    while True: sys.stdout.write('x' * 65536)",
    "endless answers": SENDS
    + "    def improve(*a):\n        while True: send(b'x' * 65536)",
    "a full disk": """
        def improve(*a):
            files = []
            while True:
                files.append(open(f"file{len(files)}", "wb"))
                files[-1].write(b"x" * (1 << 20)); files[-1].flush()
    """,
    "many small files": """
        def improve(*a):
            n = 0
            while True:
                open(f"small{n}", "w").close(); n += 1
    """,
    "a process left behind": """
        import os, subprocess, sys
        try:
            if os.fork() == 0:
                os.setsid()
                while True: pass
        except OSError: pass
        def improve(*a): return 0
    """,
    "a lock on its input": """
        import threading
        def improve(*a): threading.Lock().acquire(); threading.Event().wait()
    """,
}

GAMES = {
    "answers the first case again": """
        known = []
        def improve(q, policy, tolerance):
            if not known: known.append(q.argmax(axis=1))
            return known[0]
    """,
    "changes its inputs": """
        def improve(q, policy, tolerance):
            q[:] = 0; policy[:] = 0
            return policy
    """,
    "gives its inputs back": "def improve(q, policy, tolerance): return q",
}

FORGERIES = {
    "says that it changed an argument that is none": SENDS
    + """
    def improve(*a):
        came = {"value": {"array": 0}, "changed": [-1000, True, 10**9], "printed": ""}
        for number in range(3, 50): send(frame({"dict": {"id": number, **came}}, [["<i8", [8]]], bytes(64)))
    """,
    "raises an error in no line": SENDS
    + """
    def improve(*a):
        error = {"dict": {"kind": "<b>" * 9000, "message": "=1+1", "where": {"array": 0}}}
        for number in range(3, 50):
            send(frame({"dict": {"id": number, "raised": error, "printed": ""}}, [["|u1", [1]]], b"a"))
    """,
    "says twice which request it answers": SENDS
    + """
    def improve(*a):
        for number in range(3, 50):
            reply = b'{"id":0,"id":%d,"value":0,"changed":[],"printed":""}' % number
            header = b'{"value":{"dict":' + reply + b'},"arrays":[],"arrays":[]}'
            send(struct.pack(">II", len(header), 0) + header)
    """,
    "sends a header nested without end": SENDS
    + """
    def improve(*a):
        header = b'{"value":' + b'[' * 400_000 + b']' * 400_000 + b',"arrays":[]}'
        send(struct.pack(">II", len(header), 0) + header)
    """,
    "sends a number of a million digits": SENDS
    + """
    def improve(*a):
        header = b'{"value":' + b'9' * 1_000_000 + b',"arrays":[]}'
        send(struct.pack(">II", len(header), 0) + header)
    """,
}

SHARED = {
    "threads with tiny stacks": """
        import threading, time
        threading.stack_size(32768)
        def improve(*a):
            while True: threading.Thread(target=time.sleep, args=(60,)).start()
    """,
    "a lease on a file of the host": """
        import fcntl, os
        def improve(*a): fcntl.fcntl(open(os.__file__), 1024, fcntl.F_RDLCK); return 0
    """,
    "takes its parent's open files": """
        import ctypes, os
        def improve(*a):
            call = ctypes.CDLL(None).syscall
            parent = call(434, os.getppid(), 0)
            return max(call(438, parent, number, 0) for number in range(8))
    """,
    "32-bit system calls": """
        import ctypes, mmap
        def improve(*a):
            code = mmap.mmap(-1, 4096, prot=7)
            code.write(bytes.fromhex("b802000000cd80c3"))
            return ctypes.CFUNCTYPE(ctypes.c_int)(ctypes.addressof(ctypes.c_char.from_buffer(code)))()
    """,
    "reads the packages of the host": """
        import glob
        def improve(*a):
            for path in glob.glob("/usr/lib/python3*/dist-packages/**/*.py", recursive=True):
                return int(bool(open(path).read()))
    """,
}  # fmt: skip

# Folders without end: on a disk, nothing but the time limit ends it, and the removal takes long.
IN_MEMORY = {
    "many empty folders": """
        import os
        def improve(*a):
            n = 0
            while True: os.mkdir(f"folder{n}"); n += 1
    """,
}

# What is tried where: values are judged by the same code in every tier; a plain process sees the disk, and may signal
# its owner's processes.
KINDS = {
    "official": (
        EXITS,
        TAMPERS,
        FORGERIES,
        STEALS,
        VALUES,
        RESOURCES,
        SHARED,
        IN_MEMORY,
        GAMES,
    ),
    "restricted": (EXITS, FORGERIES, STEALS, RESOURCES, SHARED),
    "practice": (EXITS, TAMPERS),
}
NOT_IN_PRACTICE = {"kills all"}


def tiers():
    """Each tier that can run here, and an interpreter that it can read; the official one always."""
    yield "official", None
    for python in (None, "/usr/bin/python3"):
        if (
            hasattr(os, "geteuid")
            and os.geteuid() == 0
            and sandbox_check.fault("restricted", python) is None
        ):
            yield "restricted", python
            break
    yield "practice", None


def cases():
    for tier, python in tiers():
        for name, source in {
            name: source for kind in KINDS[tier] for name, source in kind.items()
        }.items():
            if tier != "practice" or name not in NOT_IN_PRACTICE:
                yield pytest.param(tier, python, source, id=f"{tier}-{name}")


def submitted(source):
    constants = f"PATH = {str(COURSE.solutions / ATTACKED.file)!r}\nROOT = {str(COURSE.root)!r}\n"
    honest = (COURSE.solutions / HONEST.file).read_bytes()
    return Submission(
        {
            ATTACKED.file: (constants + textwrap.dedent(source)).encode(),
            HONEST.file: honest,
        }
    )


def attack(tier, python, source):
    """Grades of the attacked and the honest exercise, and the seconds they took."""
    session = Session(submitted(source), tier, limits=LIMITS, python=python)
    start = time.monotonic()
    try:
        grades = [
            graded(COURSE, exercise, session, Solutions(COURSE))
            for exercise in (ATTACKED, HONEST)
        ]
    finally:
        session.close()
    return *grades, time.monotonic() - start


@pytest.fixture(scope="module")
def attacks(request):
    """The attacks that were selected, several at once: most of their time is waiting for a deadline."""
    selected = [
        item.callspec.params
        for item in request.session.items
        if "attacks" in getattr(item, "fixturenames", ())
    ]
    with ThreadPoolExecutor(4) as pool:
        yield {
            tuple(p.values()): pool.submit(attack, p["tier"], p["python"], p["source"])
            for p in selected
        }


@pytest.mark.parametrize(("tier", "python", "source"), list(cases()))
def test_an_attack_earns_nothing_and_harms_nobody(tier, python, source, attacks):
    if tier == "official" and (fault := sandbox_check.fault(tier)):
        pytest.skip(fault)
    attacked, honest, seconds = attacks[tier, python, source].result()
    assert attacked["state"] not in ("correct", "partial", "grader-fault"), attacked[
        "feedback"
    ]
    assert attacked["points"] == 0
    assert honest["state"] == "correct", honest["feedback"]
    assert seconds < LIMITS.exercise_seconds + SLACK
