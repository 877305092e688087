"""Three tiers of sandbox, from namespaces to a plain process, and the worker that runs in one.

========== ============================================ ==========================================================
official   Linux with bubblewrap                        own user, process, network and mount namespaces
restricted Linux as root where namespaces are refused   another user, Landlock, no new privileges
practice   anywhere                                     a process and a deadline; no mark is given from it
========== ============================================ ==========================================================

In all three tiers the worker limits its resources. On Linux it also forbids itself new processes and sockets
(``hardening``).
"""

from __future__ import annotations

import functools
import importlib.util
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, cast

import numpy as np

from . import frames, hardening
from .removal import remove

START_SECONDS = (
    60.0  # time that the worker has to start, before it runs any of the student's code
)
# The files of this folder that the sandbox contains.
STAGED = (
    "answers",
    "hardening",
    "frames",
    "notebook",
    "removal",
    "supervisor",
    "worker",
)
# The files of IPython that read the cells of a notebook; they import nothing but the standard library.
STAGED_IPYTHON = ("core/inputtransformer2.py", "utils/tokenutil.py")
# The shared libraries of the interpreter.
LOADER = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/etc/ld.so.cache")
CHUNK = 1 << 16  # bytes moved at once
HOME = "/submission"  # the only writable folder in the official tier; not /tmp, which may contain an environment
NOBODY = "65534"
NAMESPACES = (
    "--unshare-ipc",
    "--unshare-pid",
    "--unshare-net",
    "--unshare-cgroup-try",
    "--unshare-uts",
    "--hostname",
    "sandbox",
)
ENVIRONMENT = {
    "LANG": "C.UTF-8",
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
}
# The interpreter outside any virtual environment.
PYTHON = os.path.realpath(getattr(sys, "_base_executable", sys.executable))


@dataclass(frozen=True)
class Limits:
    """What a submission may use.

    Attributes
    ----------
    call_seconds, exercise_seconds : float
        Seconds by the clock for one call, and for all calls of one exercise.
    memory : int
        Bytes of memory.
    written : int
        Bytes of one written file.
    files : int
        Open files.
    """

    call_seconds: float = 5.0
    exercise_seconds: float = 30.0
    memory: int = 1 << 30
    written: int = 16 << 20
    files: int = 64

    def resources(self) -> dict[str, int]:
        """Return the limits under the names of the system's resource limits. The processor time is for one exercise."""
        seconds = int(self.exercise_seconds) + 1
        return {
            "AS": self.memory,
            "CPU": seconds,
            "FSIZE": self.written,
            "NOFILE": self.files,
            "CORE": 0,
        }


class SandboxFault(RuntimeError):
    """Raised when the sandbox itself fails. The submission is not to blame."""


class TimedOut(Exception):
    """Raised when no answer came before the deadline. The sandbox has been killed."""


class Garbled(Exception):
    """Raised when the sandbox sent something other than a frame."""


class Worker:
    """A worker in its sandbox. It handles one request at a time.

    Parameters
    ----------
    process : subprocess.Popen
        The process of the worker, with pipes for the requests and replies.
    end : callable
        Kills everything in the sandbox.
    forks : bool
        Whether the worker runs each exercise in a child process.
    """

    def __init__(
        self, process: subprocess.Popen[bytes], end: Callable[[], None], *, forks: bool
    ) -> None:
        self._process, self._end, self.forks = process, end, forks
        self._requests, self._replies = (
            cast(BinaryIO, process.stdin),
            cast(BinaryIO, process.stdout),
        )
        if os.name == "posix":
            os.set_blocking(self._requests.fileno(), False)
            os.set_blocking(self._replies.fileno(), False)

    def ask(self, request: Any, seconds: float) -> Any:
        """Send a request and return the worker's next frame.

        Raises
        ------
        TimedOut
            If the whole frame did not arrive within ``seconds``. The sandbox has then been killed.
        EOFError
            If the worker closed its stream.
        Garbled
            If the worker sent something other than a frame.
        FrameError
            If the request cannot be written as a frame.
        """
        frame = frames.encode(request)
        try:
            return (
                self._exchange(frame, seconds)
                if os.name == "posix"
                else self._exchange_watched(frame, seconds)
            )
        except frames.FrameError as error:
            raise Garbled(str(error)) from None
        except TimedOut:
            self.kill()
            raise
        except OSError:
            raise EOFError("the worker closed its stream") from None

    def _exchange(self, frame: bytes, seconds: float) -> Any:
        """Send and receive with one deadline for all bytes, however slowly they arrive."""
        deadline = time.monotonic() + seconds
        requests, replies = self._requests.fileno(), self._replies.fileno()

        def wait(reading: Sequence[int], writing: Sequence[int]) -> None:
            left = deadline - time.monotonic()
            if left <= 0 or not any(select.select(reading, writing, [], left)):
                raise TimedOut

        def exactly(size: int) -> bytes:
            received = bytearray()
            while len(received) < size:
                wait([replies], [])
                if not (part := os.read(replies, min(size - len(received), CHUNK))):
                    raise EOFError("the worker closed its stream")
                received += part
            return bytes(received)

        rest = memoryview(frame)
        while rest:
            wait([], [requests])
            with suppress(BlockingIOError):
                rest = rest[os.write(requests, rest[:CHUNK]) :]
        return frames.receive(exactly, frames.MOST_ANSWER)

    def _exchange_watched(self, frame: bytes, seconds: float) -> Any:
        """Send and receive on systems that cannot wait for a pipe: a timer kills the worker, which ends the stream."""
        struck = threading.Event()

        def strike() -> None:
            struck.set()
            self._end()

        watchdog = threading.Timer(seconds, strike)
        watchdog.start()
        rest = memoryview(frame)
        try:
            while rest:
                rest = rest[self._requests.write(rest) :]
            return frames.read(self._replies)
        except (OSError, EOFError):
            if struck.is_set():
                raise TimedOut from None
            raise
        finally:
            watchdog.cancel()

    def end(self) -> None:
        """Close the requests. The worker then ends by itself, or is killed after half a second."""
        with suppress(OSError):
            self._requests.close()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(0.5)
        self.kill()

    def kill(self) -> None:
        """Kill everything in the sandbox. If the sandbox has ended already, nothing happens."""
        self._end()
        self._process.wait()
        for stream in (self._requests, self._replies):
            with suppress(OSError):
                stream.close()


def start(
    tier: str,
    files: Mapping[str, bytes],
    limits: Limits,
    *,
    python: str | None = None,
    show: bool = False,
) -> Worker:
    """Start a worker in a sandbox. The worker has the files of the submission and has run none of them yet.

    Parameters
    ----------
    tier : str
        "official", "restricted" or "practice".
    files : mapping of str to bytes
        The content of each file of the submission.
    limits : Limits
        What the submission may use.
    python : str, optional
        The interpreter; by default the one of this process, outside any virtual environment.
    show : bool
        Whether replies carry what the student's code printed.

    Returns
    -------
    Worker

    Raises
    ------
    SandboxFault
        If the sandbox does not start.
    """
    try:
        worker = {
            "official": _official,
            "restricted": _restricted,
            "practice": _practice,
        }[tier](python or PYTHON, limits)
    except (OSError, subprocess.SubprocessError) as error:
        raise SandboxFault(f"the {tier} sandbox cannot be started: {error}") from error
    contents = {
        name: np.frombuffer(content, np.uint8) for name, content in files.items()
    }
    resources = limits.resources() if worker.forks else {}
    try:
        answer = worker.ask(
            {
                "files": contents,
                "limits": resources,
                "fork": worker.forks,
                "show": show,
            },
            START_SECONDS,
        )
    except (TimedOut, EOFError, Garbled) as error:
        answer = error
    if answer != "ready":
        worker.kill()
        raise SandboxFault(f"the {tier} sandbox did not start its worker: {answer!r}")
    return worker


def _official(python: str, limits: Limits) -> Worker:
    """Start a worker in namespaces of its own, made by bubblewrap."""
    process = _spawn(_in_namespaces(python, limits, "worker.main()"))
    return Worker(process, process.kill, forks=True)


def _in_namespaces(python: str, limits: Limits, code: str) -> list[str]:
    """Return a command that runs ``code`` in namespaces of its own, never as root and never as the owner of a file."""
    if os.geteuid() == 0:
        code = f"hardening.become({hardening.unused_user()})\n{code}"
    command = _bubblewrap(python, limits.written)
    return [*command, "--", *_python(python, "/grader", code)]


def _restricted(python: str, limits: Limits) -> Worker:
    """Start a worker as another user that Landlock lets read only what it needs."""
    if os.name != "posix" or os.geteuid() != 0:
        raise OSError("only root can give the worker another user")
    user, folder = hardening.unused_user(), tempfile.mkdtemp()
    os.chown(folder, user, user)
    reader, lifeline = os.pipe()
    readable = [*LOADER, *_interpreter(python), *_numpy(), _stage(), "/dev/urandom"]
    seen = list(dict.fromkeys(map(os.path.realpath, readable)))
    hidden = list(map(os.path.realpath, _package_folders(python)))
    code = f"supervisor.supervise({user}, {reader}, {seen}, {hidden}, {folder!r})"
    process = _spawn(_python(python, _stage(), code), folder=folder, keep=[reader])
    os.close(reader)

    def end() -> None:
        nonlocal lifeline
        if lifeline >= 0:
            os.close(lifeline)
            lifeline = -1
        process.wait()
        remove(Path(folder))

    return Worker(process, end, forks=True)


def _practice(python: str, limits: Limits) -> Worker:
    """Start a worker as a plain process in a temporary folder."""
    folder = tempfile.mkdtemp()
    process = _spawn(_python(python, _stage(), "worker.main()"), folder=folder)

    def end() -> None:
        if os.name == "posix":
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
        process.kill()
        process.wait()
        remove(Path(folder))

    return Worker(process, end, forks=sys.platform == "linux")


def _spawn(
    command: Sequence[str], *, folder: str | None = None, keep: Sequence[int] = ()
) -> subprocess.Popen[bytes]:
    """Start a process with pipes, in a session of its own, with the few environment variables that it needs."""
    environment = ENVIRONMENT if os.name == "posix" else {**os.environ, **ENVIRONMENT}
    return subprocess.Popen(
        command,
        bufsize=0,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        cwd=folder,
        env=environment,
        pass_fds=keep,
        start_new_session=True,
    )


def _python(python: str, stage: str, code: str) -> list[str]:
    """Return a command that runs ``code`` with the staged files and numpy, but without site-packages."""
    path = [stage, *{os.path.dirname(folder) for folder in _numpy()}]
    return [python, "-I", "-S", "-B", "-c", f"import sys; sys.path += {path!r}\n"
            f"from robonav.grading import hardening, supervisor, worker\n{code}"]  # fmt: skip


def _bubblewrap(python: str, writable: int) -> list[str]:
    """Return the bubblewrap command: libraries, interpreter, numpy and worker are read-only, and HOME is small."""
    command = [_bwrap(), "--die-with-parent", *NAMESPACES, *_user_options()]
    for path in _folders_above([*LOADER, *_interpreter(python), *_numpy()]):
        command += ["--perms", "0755", "--dir", path]
    for path in LOADER:
        command += (
            ["--symlink", os.readlink(path), path]
            if os.path.islink(path)
            else ["--ro-bind-try", path, path]
        )
    for path in _interpreter(python):
        command += ["--ro-bind", path, path]
    for path in _package_folders(python):
        command += ["--perms", "0555", "--size", "4096", "--tmpfs", path]
    for path in _numpy():
        command += ["--ro-bind", path, path]
    command += ["--ro-bind", _stage(), "/grader"]
    # No other device: /dev/null belongs to root, who is nobody inside, so that nobody inside can change it.
    command += ["--size", "4096", "--tmpfs", "/dev"]
    command += ["--dev-bind", os.devnull, os.devnull]
    command += ["--perms", "0777", "--size", str(writable), "--tmpfs", HOME]
    for path in ("/", "/dev", *_package_folders(python)):
        command += ["--remount-ro", path]
    return [*command, "--chdir", HOME]


def _user_options() -> list[str]:
    """Return bubblewrap's options for the user inside.

    An ordinary user gets a user namespace. In a namespace of root's, the worker would own root's files, such as the
    host's devices. There the sandbox has none, and only the right to become another user.
    """
    if os.geteuid() == 0:
        rights = ["--cap-add", "CAP_SETUID", "--cap-add", "CAP_SETGID"]
        return ["--cap-drop", "ALL", *rights]
    options = ["--unshare-user", "--uid", NOBODY, "--gid", NOBODY, "--cap-drop", "ALL"]
    if _bubblewrap_can("--disable-userns"):
        options += ["--disable-userns"]
    return options


@functools.cache
def _bwrap() -> str:
    """Return the path of bubblewrap. A relative folder in PATH could be a folder of submissions."""
    folders = filter(os.path.isabs, os.environ.get("PATH", "").split(os.pathsep))
    found = shutil.which("bwrap", path=os.pathsep.join(folders))
    if found is None:
        raise OSError("bubblewrap is not installed")
    return found


@functools.cache
def _bubblewrap_can(option: str) -> bool:
    """Whether the installed bubblewrap knows an option."""
    return (
        option
        in subprocess.run([_bwrap(), "--help"], capture_output=True, text=True).stdout
    )


@functools.cache
def _interpreter(python: str) -> list[str]:
    """Return the paths of the interpreter, its standard library and its shared library."""
    code = "import os, sys; print(sys.base_prefix, os.path.dirname(os.__file__), sep='\\n')"
    answer = subprocess.run(
        [python, "-I", "-S", "-c", code], capture_output=True, text=True, check=True
    ).stdout
    prefix, library = answer.splitlines()
    return [python, library, *map(str, Path(prefix).glob("lib/libpython*.so*"))]


def _folders_above(paths: Sequence[str]) -> list[str]:
    """Return the folders that the sandbox must have for these paths. They may be closed to the worker on the host."""
    above = {folder for path in paths for folder in Path(path).parents}
    there = [folder for folder in LOADER if os.path.isdir(folder)]
    return sorted(str(folder) for folder in above if not _is_in(folder, there))


def _is_in(path: Path, folders: Sequence[str]) -> bool:
    return any(path.is_relative_to(folder) for folder in folders)


def _numpy() -> list[str]:
    """Return the folders of numpy and of its shared libraries."""
    folder = Path(np.__file__).parent
    beside = folder.parent / "numpy.libs"
    return [str(folder), *([str(beside)] if beside.is_dir() else [])]


@functools.cache
def _package_folders(python: str) -> list[str]:
    """Return the folders of installed packages that the sandbox must hide. One of them may contain robonav."""
    visible = {
        Path(path)
        for path in (*LOADER, *_interpreter(python))
        if os.path.isdir(path) and not os.path.islink(path)
    }
    patterns = (
        "python3*/site-packages",
        "python3*/dist-packages",
        "site-packages",
        "dist-packages",
    )
    found = {
        folder
        for root in visible
        for pattern in patterns
        for folder in root.glob(pattern)
    }
    return sorted(str(folder) for folder in found)


@functools.cache
def _staged() -> tempfile.TemporaryDirectory[str]:
    """Copy the files that the sandbox needs to a temporary folder that every user can read."""
    folder = tempfile.TemporaryDirectory(prefix="robonav-grader-")
    package = Path(folder.name, "robonav", "grading")
    package.mkdir(parents=True)
    for name in STAGED:
        shutil.copy(Path(__file__).with_name(f"{name}.py"), package)
    if (ipython := importlib.util.find_spec("IPython")) and ipython.origin:
        for name in STAGED_IPYTHON:
            copied = Path(folder.name, "IPython", name)
            copied.parent.mkdir(parents=True)
            # A package of its own: where another IPython is on the path, it may be one that the worker cannot read.
            for folder_above in (copied.parent, copied.parent.parent):
                (folder_above / "__init__.py").touch()
            shutil.copy(Path(ipython.origin).parent / name, copied)
    for path in [folder.name, *map(str, Path(folder.name).rglob("*"))]:
        os.chmod(path, 0o755)
    return folder


def _stage() -> str:
    """Return a folder with copies of only those files of this package that the sandbox needs."""
    return _staged().name
