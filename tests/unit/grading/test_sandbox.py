"""The sandbox's own promises, tier by tier; attacks on it are in test_attacks."""

import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

from robonav.grading import hardening, sandbox, sandbox_check
from robonav.grading.sandbox import Limits, SandboxFault, TimedOut

pytestmark = pytest.mark.sandbox

ECHO = {"ch2/echo.py": b"def echo(*values): return values"}
LOAD = {"id": 1, "do": "load", "path": "ch2/echo.py", "name": "echo"}


def probed():
    """Tiers that can run here, the official one always, with an interpreter that each can read."""
    yield "official", None
    yield "practice", None
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        yield from [
            ("restricted", python)
            for python in (None, "/usr/bin/python3")
            if not sandbox_check.fault("restricted", python)
        ][:1]


@pytest.fixture(params=list(probed()), ids=lambda param: param[0])
def start(request):
    tier, python = request.param
    if fault := sandbox_check.fault(tier, python):
        pytest.skip(fault)
    workers = []

    def starter(files=ECHO, limits=None):
        workers.append(sandbox.start(tier, files, limits or Limits(), python=python))
        return workers[-1]

    yield starter
    for worker in workers:
        worker.kill()


def loaded(worker, source=None):
    assert worker.ask(LOAD, 30) == {
        "id": 1,
        "value": None,
        "changed": [],
        "printed": "",
    }
    return worker


def ask(worker, *arguments, seconds=30.0):
    return worker.ask({"id": 2, "do": "call", "args": list(arguments)}, seconds)


def test_values_cross_unchanged(start):
    worker = loaded(start())
    reply = ask(
        worker, 1, [2.5, "three"], np.arange(4, dtype=np.int16), {"five": (None, True)}
    )
    one, two, array, five = reply["value"]
    assert (one, two, five) == (1, [2.5, "three"], {"five": (None, True)})
    assert array.dtype == np.int16


def test_every_exercise_has_a_process_of_its_own(start):
    source = b"import os, builtins\nn = getattr(builtins, 'n', 0) + 1\nbuiltins.n = n\ndef echo(): return n, os.getpid()"  # noqa: E501
    worker = start({"ch2/echo.py": source})
    seen = []
    for _ in range(3):
        seen.append(ask(loaded(worker))["value"])
        assert worker.ask({"do": "end"}, 30) == {"ended": 0}
    assert [n for n, _ in seen] == [1, 1, 1]


def test_what_an_exercise_leaves_behind_is_gone_when_it_has_ended(
    monkeypatch, tmp_path
):
    """Its removal takes no time of the next one."""
    if not sandbox.sys.platform.startswith("linux"):
        pytest.skip("only where the worker can fork")
    monkeypatch.setattr(sandbox.tempfile, "tempdir", str(tmp_path))
    worker = sandbox.start(
        "practice",
        {"ch2/echo.py": b"def echo():\n    open('../left', 'w').close()"},
        Limits(),
    )
    ask(loaded(worker))
    assert list(tmp_path.rglob("left"))
    assert worker.ask({"do": "end"}, 30) == {"ended": 0}
    assert not [*tmp_path.rglob("left"), *tmp_path.rglob("echo.py")]
    worker.kill()


DEEP = b"""
import os
def echo():
    for n in range(1500):
        os.mkdir("deep", 0o300)
        os.chdir("deep")
        open("file", "w").close()
    os.symlink("/", "link")
"""


@pytest.fixture
def temporary(monkeypatch):
    """A folder for temporary files that every user can reach, as tmp_path is not."""
    sandbox._stage()  # which stays for all tests
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        monkeypatch.setattr(sandbox.tempfile, "tempdir", folder)
        yield Path(folder)
        monkeypatch.undo()


def test_folders_in_folders_in_folders_are_removed(start, temporary):
    """However deep they are and whatever their modes: at the end of an exercise, and of a submission."""
    worker = loaded(start({"ch2/echo.py": DEEP}))
    assert ask(worker)["value"] is None
    assert worker.ask({"do": "end"}, 30) == {"ended": 0}
    loaded(worker)
    assert ask(worker)["value"] is None
    worker.kill()
    left = [path for path in temporary.iterdir() if "grader" not in path.name]
    assert left == []


MANY = b"""
import os
def echo():
    n = 0
    while True:
        os.close(os.open(f"file{n}", os.O_CREAT))
        n += 1
"""


def test_files_that_only_fill_the_system_s_memory_are_not_made_without_end():
    """A file system in memory counts the bytes of files, not the files."""
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    worker = loaded(sandbox.start("official", {"ch2/echo.py": MANY}, Limits()))
    try:
        assert ask(worker) == {"ended": -9}
    finally:
        worker.kill()


def test_what_landlock_must_hide_in_a_folder_that_it_allows(tmp_path):
    for name in ("lib/site-packages/robonav", "lib/json", "lib/deep/dist-packages"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "lib/link").symlink_to(tmp_path)
    library = str(tmp_path / "lib")
    hidden = [f"{library}/site-packages", f"{library}/deep/dist-packages"]
    readable, listed = hardening.all_but(library, hidden)
    assert readable == [f"{library}/json"]
    assert sorted(listed) == [library, f"{library}/deep"]
    assert hardening.all_but("/elsewhere", hidden) == (["/elsewhere"], [])


def test_a_deadline_ends_everything_at_once(start):
    worker = loaded(start({"ch2/echo.py": b"def echo():\n    while True: pass"}))
    begin = time.monotonic()
    with pytest.raises(TimedOut):
        ask(worker, seconds=0.3)
    assert time.monotonic() - begin < 5
    assert worker._process.poll() is not None


def test_memory_files_and_their_number_are_limited(start):
    source = b"""
def echo(what):
    if what == "memory":
        return len(bytearray(900 << 20))
    if what == "size":
        with open("large", "wb") as file:
            for _ in range(32): file.write(b"x" * (1 << 20)); file.flush()
    if what == "number":
        files = [open(f"file{n}", "w") for n in range(200)]
"""
    limits = Limits(memory=600 << 20)
    worker = loaded(start({"ch2/echo.py": source}, limits))
    assert ask(worker, "memory")["raised"]["kind"] == "MemoryError"
    assert ask(worker, "number")["raised"]["kind"] == "OSError"
    assert ask(worker, "size").get("raised", {"kind": "OSError"})["kind"] == "OSError"


def test_what_is_printed_goes_nowhere(start):
    worker = loaded(
        start(
            {
                "ch2/echo.py": b"import os\nprint('x' * 10**6)\ndef echo():\n    os.write(1, b'y' * 10**6)\n    return 1"  # noqa: E501
            }
        )
    )
    assert ask(worker) == {"id": 2, "value": 1, "changed": [], "printed": ""}


CHANGES = """
import fcntl, os
def changes():
    # What succeeded, at places that can be seen and are not the worker's own.
    own, done = OWN, []
    def locked(path, lock):
        with open(path) as file: lock(file)
    attempts = {
        "chmod": lambda p: os.chmod(p, 0o777, follow_symlinks=True),
        "chown": lambda p: os.lchown(p, os.getuid(), os.getgid()),
        "utime": lambda p: os.utime(p, (1, 1)),
        "truncate": lambda p: os.truncate(p, 0),
        "setxattr": lambda p: os.setxattr(p, "user.x", b"x"),
        "removexattr": lambda p: os.removexattr(p, "user.x"),
        "write": lambda p: os.path.isfile(p) and open(p, "r+") or 1 / 0,
        "create": lambda p: os.mkdir(os.path.join(p, "x")),
        "lease": lambda p: os.path.isfile(p) and locked(p, lambda f: fcntl.fcntl(f, 1024, fcntl.F_WRLCK)) or 1 / 0,
        "touch": os.utime,
        "flock": lambda p: locked(p, lambda f: fcntl.flock(f, fcntl.LOCK_EX | fcntl.LOCK_NB)),
    }
    for name in ALLOWED: del attempts[name]
    for place, folders, names in os.walk("/"):
        if place.startswith(own):
            folders.clear()
            continue
        if place.count("/") > 3:
            folders[:], names[:] = folders[:3], names[:3]  # enough of the libraries
        for path in [place, *(os.path.join(place, n) for n in names)]:
            for name, attempt in attempts.items():
                try: attempt(path)
                except (OSError, ZeroDivisionError): continue
                done.append([name, path])
    for descriptor in range(64):
        for name, attempt in {"fchmod": lambda d: os.fchmod(d, 0o666), "fchown": lambda d: os.fchown(d, 0, 0)}.items():
            try: attempt(descriptor)
            except OSError: continue
            if os.path.exists("/dev/null") and os.path.samestat(os.fstat(descriptor), os.stat("/dev/null")):
                done.append([name, descriptor])
    return done[:20]
"""


@pytest.mark.parametrize(
    "start", list(probed())[::2], ids=lambda one: one[0], indirect=True
)
def test_nothing_of_the_host_can_be_changed(start):
    """In the practice tier, which has no namespaces, this would try the files of this machine."""
    source = f"ALLOWED = []\n{CHANGES}\ndef echo(): return changes()".replace(
        "OWN", "os.path.dirname(os.getcwd())"
    )
    worker = loaded(start({"ch2/echo.py": source.encode()}))
    assert ask(worker, seconds=60)["value"] == []


def test_nothing_of_the_host_can_be_changed_without_the_filter_either():
    """The worker owns nothing. The filter alone refuses locks, and the time of writing, which any user may set."""
    if fault := sandbox_check.fault("official"):
        pytest.skip(fault)
    source = CHANGES.replace("OWN", "os.getcwd()")
    code = f"ALLOWED = ['touch', 'flock']\n{source}\nprint(os.getuid() != 0, changes())"
    command = sandbox._in_namespaces(sandbox.PYTHON, Limits(), code)
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    assert ran.stdout == "True []\n"


def test_one_processor_is_enough_for_numpy(start):
    source = b"""
import os, numpy as np
def echo(): return os.environ["OPENBLAS_NUM_THREADS"], float((np.eye(300) @ np.eye(300)).sum())
"""
    assert ask(loaded(start({"ch2/echo.py": source})))["value"] == ("1", 300.0)


def test_a_module_out_of_reach_is_named(start):
    for module, says in (
        ("robonav.mdp", "the exercise asks for your own"),
        ("scipy", "standard library and numpy"),
    ):
        worker = start({"ch2/echo.py": f"import {module}\ndef echo(): pass".encode()})
        raised = worker.ask(LOAD, 30)["raised"]
        assert raised["kind"] == "ModuleNotFoundError"
        assert says in raised["message"]
        assert raised["where"] == ["ch2/echo.py", 1]


def test_a_submission_may_be_several_files(start):
    files = {
        "ch2/echo.py": b"from shared import twice\nimport helpers.more\ndef echo(x): return twice(x) + helpers.more.one"
    }
    files |= {
        "shared.py": b"def twice(x): return 2 * x",
        "helpers/more.py": b"one = 1",
        "random.py": b"raise SystemExit",
    }
    assert ask(loaded(start(files)), 4)["value"] == 9


def test_a_request_that_is_no_frame_is_our_own_fault(start):
    worker = loaded(start())
    with pytest.raises(ValueError, match="a value of type object"):
        ask(worker, object())


def test_where_pipes_cannot_be_waited_for_a_watchdog_keeps_the_deadline(monkeypatch):
    """As on Windows."""
    worker = sandbox.start(
        "practice",
        {"ch2/echo.py": b"import time\ndef echo(s): time.sleep(s); return s"},
        Limits(),
    )
    monkeypatch.setattr(worker, "_exchange", worker._exchange_watched)
    for stream in (worker._requests, worker._replies):
        os.set_blocking(stream.fileno(), True)
    assert ask(loaded(worker), 0)["value"] == 0
    with pytest.raises(TimedOut):
        ask(worker, 60, seconds=0.3)
    assert worker._process.poll() is not None


def test_without_fork_one_process_serves_one_exercise(monkeypatch):
    """As on macOS and Windows."""
    monkeypatch.setattr(sandbox.sys, "platform", "darwin")
    worker = sandbox.start("practice", ECHO, Limits())
    assert not worker.forks
    assert ask(loaded(worker), 1)["value"] == (1,)
    worker.kill()


@pytest.mark.parametrize("tier", ["official", "restricted", "practice"])
def test_an_interpreter_that_is_none_is_a_fault_of_the_sandbox(tier):
    with pytest.raises(SandboxFault):
        sandbox.start(tier, ECHO, Limits(), python="/bin/false")


def test_the_probe_finds_a_sandbox_that_leaks(monkeypatch):
    """A practice worker that is passed off as the official tier does what it must not."""
    monkeypatch.setattr(sandbox, "_official", sandbox._practice)
    sandbox_check.fault.cache_clear()
    assert "lets out" in sandbox_check.fault("official")
    sandbox_check.fault.cache_clear()


def test_importing_the_grader_is_light():
    code = "import sys, robonav.grading.run, robonav.grading.classroom; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.split()
    assert not {"torch", "numba", "matplotlib"} & set(loaded)


def run_filter(program, machine, call, first_argument=0, second=0):
    """A small interpreter of classic BPF: what the kernel would do with a system call."""
    data = {0: call, 4: hardening.MACHINES[machine][1], 16: first_argument, 24: second}
    steps = [
        struct.unpack_from("=HBBI", program, at) for at in range(0, len(program), 8)
    ]
    at = accumulator = 0
    while True:
        code, then, otherwise, value = steps[at]
        match code:
            case hardening.LOAD:
                accumulator = data[value]
            case hardening.RETURN:
                return value
            case _:
                tests = {
                    hardening.EQUAL: accumulator == value,
                    hardening.AT_LEAST: accumulator >= value,
                }
                tests[hardening.HAS_BITS] = bool(accumulator & value)
                at += then if tests[code] else otherwise
        at += 1


@pytest.mark.parametrize("machine", list(hardening.MACHINES))
def test_the_filter_refuses_leases_on_files_of_the_host(machine):
    program = hardening.filter_program(machine)
    call = hardening.FCNTL[hardening.MACHINES[machine][0]]
    for operation in (0, 1, 2, 3, 4, 6, 1030, 1031):
        assert run_filter(program, machine, call, second=operation) == hardening.ALLOW
    for operation in (1024, 1026):
        assert (
            run_filter(program, machine, call, second=operation) == hardening.REFUSE | 1
        )


@pytest.mark.parametrize("machine", list(hardening.MACHINES))
def test_the_filter_refuses_what_it_lists_and_nothing_else(machine):
    program, column = hardening.filter_program(machine), hardening.MACHINES[machine][0]
    refused = {numbers[column] for numbers in hardening.REFUSED.values()} - {None}
    clone, clone3 = hardening.CLONE[column], hardening.CLONE3[column]
    for call in range(460):
        result = run_filter(program, machine, call)
        if call in refused | {clone}:
            assert result == hardening.REFUSE | 1, call
        elif call == clone3:
            assert result == hardening.REFUSE | 38
        else:
            assert result == hardening.ALLOW, call
    assert (
        run_filter(program, machine, clone, hardening.CLONE_THREAD | 0x3D0F00)
        == hardening.ALLOW
    )
    assert (
        run_filter(program, machine, hardening.PRLIMIT[column], 4321)
        == hardening.REFUSE | 1
    )
    if machine == "x86_64":
        assert run_filter(program, machine, 0x40000000 + 59) == hardening.REFUSE | 1


def test_another_architecture_is_killed():
    program = hardening.filter_program("x86_64")
    wrong = {**hardening.MACHINES, "x86_64": (0, 0x40000003)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(hardening, "MACHINES", wrong)
        assert run_filter(program, "x86_64", 0) == hardening.KILL
