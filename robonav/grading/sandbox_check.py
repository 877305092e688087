"""Find the sandbox tiers that work on this machine, by running a submission that attempts forbidden actions."""

from __future__ import annotations

import functools

from . import sandbox
from .sandbox import Limits

TIERS = ("official", "restricted", "practice")

CANARY = b'''
def canary(path):
    """What succeeded of everything that must not."""
    import fcntl, os, resource, socket
    import decimal, fractions, random  # modules of the standard library must be there

    def limits():
        resource.setrlimit(resource.RLIMIT_AS, (1 << 62, 1 << 62))

    def lock():
        with open(os.__file__) as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)

    def be_root():
        if os.getuid() != 0:
            raise OSError

    attempts = {
        "reads": lambda: open(path),
        "forks": os.fork,
        "connects": socket.socket,
        "writes": lambda: open("/var/tmp/robonav-canary", "w"),
        "raises its limits": limits,
        "is root": be_root,
        "changes a device": lambda: os.chmod(os.devnull, 0o666),
        "locks a file of the host": lock,
        "sees the host's processes": lambda: os.listdir("/proc"),
    }
    succeeded = []
    for name, attempt in attempts.items():
        try:
            attempt()
        except (OSError, ValueError):
            continue
        succeeded.append(name)
    return succeeded
'''


@functools.cache
def fault(tier: str, python: str | None = None) -> str | None:
    """Return the reason why the tier cannot be trusted on this machine, or None if it can."""
    try:
        worker = sandbox.start(tier, {"canary.py": CANARY}, Limits(), python=python)
    except sandbox.SandboxFault as error:
        return str(error)
    try:
        worker.ask(
            {"id": 1, "do": "load", "path": "canary.py", "name": "canary"},
            sandbox.START_SECONDS,
        )
        reply = worker.ask(
            {"id": 2, "do": "call", "args": [__file__]}, sandbox.START_SECONDS
        )
    except (sandbox.TimedOut, EOFError, sandbox.Garbled) as error:
        return f"the {tier} sandbox does not answer: {error!r}"
    finally:
        worker.kill()
    if tier == "practice" and "value" in reply:
        return None
    return (
        None
        if reply == {"id": 2, "value": [], "changed": [], "printed": ""}
        else f"the {tier} sandbox lets out: {reply}"
    )


def best() -> str:
    """Return the strictest tier that works on this machine."""
    for tier in TIERS:
        if fault(tier) is None:
            return tier
    raise sandbox.SandboxFault("; ".join(str(fault(tier)) for tier in TIERS))
