"""The worker runs a student's code in the sandbox. It answers each of the grader's requests with one frame.

The grader sends the submission's files once, and the worker says ``ready``. Then, for each exercise, the grader asks
to ``find`` a function, to ``load`` it, to ``call`` it any number of times, and to ``end``. It may also ask which
notebooks are ``damaged``. Each exercise gets a fresh copy of the files in its own folder and, where the system can
fork, its own child process. A child that crashes or damages its folder does not affect the next one, and numpy is
imported only once. A child knows the arguments of its calls but no right answer.
"""

from __future__ import annotations

import contextlib
import errno
import importlib.abc
import io
import os
import select
import signal
import sys
import traceback
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

from . import answers, frames, hardening, notebook
from .removal import empty

ALLOWED = {"numpy", *sys.stdlib_module_names}
MOST_ENTRIES = 10_000  # files and folders of one exercise
MOST_TEXT = 2_000  # characters of an error message, and of what one call prints


class Printed(io.StringIO):
    """What a student's code prints during one call, up to a number of characters."""

    def write(self, text: str) -> int:
        """Keep the text if there is room for it."""
        if left := MOST_TEXT - self.tell():
            super().write(str(text)[:left])
        return len(text)


class Gate(importlib.abc.MetaPathFinder):
    """Refuse modules that graded code may not import, with a clear message.

    Parameters
    ----------
    own : set of str
        The names of the submission's own modules.
    """

    def __init__(self, own: set[str]) -> None:
        self.allowed = ALLOWED | own

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: Any = None
    ) -> None:
        """Raise a ModuleNotFoundError for a module that is not allowed."""
        top = name.partition(".")[0]
        if top == "robonav":
            raise ModuleNotFoundError(
                "robonav cannot be imported here: the exercise asks for your own answer",
                name=name,
            )
        if top not in self.allowed:
            raise ModuleNotFoundError(
                f"{top} cannot be imported here: use only Python's standard library and numpy",
                name=name,
            )


def main() -> None:
    """Serve the grader on the standard streams until they close."""
    requests, replies = _take_streams()
    opening = frames.read(requests)
    files = {name: content.tobytes() for name, content in opening["files"].items()}
    with contextlib.suppress(ImportError):
        notebook.transformer()
    own = {part.removesuffix(".py") for name in files for part in name.split("/")}
    _close_the_gate(own | answers.modules_of_cells(files.values()))
    hardening.limit(opening["limits"])
    hardening.limit({"NPROC": hardening.most_tasks()})
    frames.write(replies, "ready")
    home = Path.cwd()
    try:
        while True:
            request = frames.read(requests)
            os.chdir(_unpacked(home, files))
            if opening["fork"]:
                status = _serve_in_child(
                    requests, replies, request, opening["show"], home
                )
                os.chdir(home)
                # Before the reply, so that the time for this belongs to the exercise that wrote the files.
                empty(home)
                frames.write(replies, {"ended": status})
            else:
                _serve(requests, replies, request, opening["show"])
    except (EOFError, BrokenPipeError):
        os._exit(0)  # nothing is left to clean up


def _take_streams() -> tuple[BinaryIO, BinaryIO]:
    """Reserve the standard streams for frames. The output of a student's code is discarded."""
    requests, replies = (
        os.fdopen(os.dup(0), "rb", buffering=0),
        os.fdopen(os.dup(1), "wb"),
    )
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)
    return requests, replies


def _unpacked(home: Path, files: Mapping[str, bytes]) -> Path:
    """Write the files to a new folder. Its random name cannot be guessed, so no earlier code can have created it."""
    folder = home / os.urandom(8).hex()
    folder.mkdir()
    for name, content in files.items():
        _tried((folder / name).parent.mkdir, parents=True, exist_ok=True)
        _tried((folder / name).write_bytes, content)
    return folder


def _tried(do: Callable[..., Any], *arguments: Any, **options: Any) -> None:
    """Call ``do`` and ignore errors (a zip may hold both "a" and "a/b"), except that of a full disk."""
    try:
        do(*arguments, **options)
    except OSError as error:
        if error.errno == errno.ENOSPC:
            raise


def _close_the_gate(own: set[str]) -> None:
    """Make robonav's modules, and all others that are not allowed, impossible to import."""
    for name in [
        name for name in sys.modules if name.partition(".")[0] in ("robonav", "IPython")
    ]:
        del sys.modules[name]
    sys.meta_path.insert(0, Gate(own))


def _serve_in_child(
    requests: BinaryIO,
    replies: BinaryIO,
    request: dict[str, Any],
    show: bool,
    home: Path,
) -> int:
    """Serve one exercise in a child process and return its exit code."""
    if (child := os.fork()) == 0:
        status = 1
        try:
            hardening.filter_calls()
            _serve(requests, replies, request, show)
            status = 0
        finally:
            os._exit(status)
    _watch(child, home)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status)


def _watch(child: int, home: Path) -> None:
    """Wait for a child process, and kill it if it fills the system's memory with files.

    A file system in memory counts the bytes of files, but not the files. On a disk they do no such harm.
    """
    if not os.path.ismount(home):
        return
    try:
        ended = os.pidfd_open(child)
    except OSError:  # a kernel before 5.3
        return
    while not select.select([ended], [], [], 0.1)[0]:
        state = os.statvfs(home)
        if state.f_files - state.f_ffree > MOST_ENTRIES:
            os.kill(child, signal.SIGKILL)
    os.close(ended)


def _serve(
    requests: BinaryIO, replies: BinaryIO, request: dict[str, Any], show: bool
) -> None:
    """Answer requests until one says ``end``."""
    functions: dict[str, Any] = {}
    while request["do"] != "end":
        printed = Printed()
        with contextlib.redirect_stdout(printed if show else sys.stdout):
            reply = {"id": request["id"], **_answer(request, functions)}
        reply["printed"] = printed.getvalue()
        try:
            frame = frames.encode(reply)
        # Encoding calls methods of the returned object, which are the student's code and may raise anything.
        except BaseException as error:
            raised = {"id": request["id"], "raised": _described(error), "printed": ""}
            frame = frames.encode(raised)
        replies.write(frame)
        replies.flush()
        request = frames.read(requests)


def _answer(request: dict[str, Any], functions: dict[str, Any]) -> dict[str, Any]:
    """Find a function, load it or call it, and return its value or a description of the error."""
    try:
        if request["do"] == "find":
            found = _found(Path.cwd(), request["chapter"], request["name"])
            return {"value": found, "changed": []}
        if request["do"] == "damaged":
            return {"value": answers.damaged(Path.cwd()), "changed": []}
        if request["do"] == "load":
            module = answers.load(Path.cwd(), request["path"], request["name"])
            functions["f"] = getattr(module, request["name"], None)
            defined = hasattr(module, request["name"])
            return {"value": None if defined else "undefined", "changed": []}
        sent = [frames.encode(argument) for argument in request["args"]]
        value = functions["f"](*request["args"])
        return {"value": value, "changed": frames.differing(request["args"], sent)}
    except BaseException as error:  # also SystemExit: a student's code must not end the worker as if all were well
        return {"raised": _described(error)}


def _found(folder: Path, chapter: str, name: str) -> dict[str, str]:
    """Return where the answer to an exercise is, before any code of the student runs."""
    found = answers.find(folder, chapter, name)
    if not found.path and found.problem:
        raise found.problem
    return {"path": found.path, "origin": found.origin, "unwritten": found.unwritten}


def _described(error: BaseException) -> dict[str, Any]:
    """Describe an error: its type, its message, and the last line of the student's code in its traceback."""
    try:
        message = str(error)[:MOST_TEXT].encode("utf-8", "replace").decode()
    except BaseException:
        message = ""
    own = str(Path.cwd()) + os.sep
    steps = [
        step
        for step in traceback.extract_tb(error.__traceback__)
        if step.filename.startswith(own)
    ]
    where = (
        [steps[-1].filename.removeprefix(own), steps[-1].lineno or 0] if steps else None
    )
    return {"kind": type(error).__name__, "message": message, "where": where}
