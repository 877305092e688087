"""The supervisor of the restricted tier. It stays root, runs the worker as another user, and kills all its processes.

``sandbox`` starts it on Linux as root where namespaces are refused. It ends when the worker ends, or when the grader's
end of the lifeline (a pipe) closes, so that no process remains when the grader was killed.
"""

from __future__ import annotations

import os
import select
import signal
from collections.abc import Sequence
from contextlib import suppress

from . import hardening, worker


def supervise(
    user: int,
    lifeline: int,
    readable: Sequence[str],
    hidden: Sequence[str],
    folder: str,
) -> None:
    """Run the worker as ``user``, who sees only ``readable`` without ``hidden``, and ``folder``, until it ends."""
    if (child := os.fork()) == 0:
        try:
            os.close(lifeline)
            hardening.become(user)
            seen, listed = [], []
            for path in readable:
                below = hardening.all_but(path, hidden)
                seen += below[0]
                listed += below[1]
            if hardening.restrict_files(seen, [folder, os.devnull], listed):
                worker.main()
        finally:
            os._exit(0)
    os.close(0)
    os.close(1)
    select.select([lifeline, os.pidfd_open(child)], [], [])
    _end_all_of(user)
    os.waitpid(child, 0)


def _end_all_of(user: int) -> None:
    """Kill every process of the user with one system call, which no process can escape by forking."""
    if (killer := os.fork()) == 0:
        os.setresuid(user, user, user)
        with suppress(ProcessLookupError):
            os.kill(-1, signal.SIGKILL)
        os._exit(0)
    os.waitpid(killer, 0)
