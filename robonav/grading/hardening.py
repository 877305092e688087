"""Restrictions that a worker puts on itself before it runs a student's code: resources, system calls, files, user.

The worker cannot undo any of them. Linux on x86-64 and AArch64 offers all of them; on other systems each function does
as much as the system allows. This file uses the standard library only, because it also runs in the sandbox.
"""

from __future__ import annotations

import ctypes
import errno
import os
import platform
import random
import struct
from collections.abc import Iterable, Mapping

# Number of each refused call on (x86-64, AArch64). A worker needs no call that starts or changes a process, reads the
# memory or the open files of another one, opens a connection or changes a mount. It must not allocate memory that its
# limit does not count and that may exist longer than the worker. It must not change the mode, owner, times, attributes
# or locks of a file, which would work on files of the host that it can only read. It must not use up what all processes
# of a user share, or read the kernel's log. Calls that only x86-64 has are None on AArch64.
REFUSED: dict[str, tuple[int, int | None]] = {
    "fork": (57, None),
    "vfork": (58, None),
    "execve": (59, 221),
    "execveat": (322, 281),
    "ptrace": (101, 117),
    "process_vm_readv": (310, 270),
    "process_vm_writev": (311, 271),
    "socket": (41, 198),
    "socketpair": (53, 199),
    "mount": (165, 40),
    "umount2": (166, 39),
    "pivot_root": (155, 41),
    "chroot": (161, 51),
    "setns": (308, 268),
    "unshare": (272, 97),
    "bpf": (321, 280),
    "userfaultfd": (323, 282),
    "perf_event_open": (298, 241),
    "keyctl": (250, 219),
    "add_key": (248, 217),
    "request_key": (249, 218),
    "io_uring_setup": (425, 425),
    "kexec_load": (246, 104),
    "init_module": (175, 105),
    "finit_module": (313, 273),
    "open_by_handle_at": (304, 265),
    "shmget": (29, 194),
    "shmat": (30, 196),
    "semget": (64, 190),
    "msgget": (68, 186),
    "mq_open": (240, 180),
    "memfd_create": (319, 279),
    "memfd_secret": (447, 447),
    "setpriority": (141, 140),
    "sched_setscheduler": (144, 119),
    "sched_setparam": (142, 118),
    "sched_setaffinity": (203, 122),
    "sched_setattr": (314, 274),
    "ioprio_set": (251, 30),
    "io_setup": (206, 0),
    "pidfd_getfd": (438, 438),
    "kcmp": (312, 272),
    "process_madvise": (440, 440),
    "move_pages": (279, 239),
    "migrate_pages": (256, 238),
    "chmod": (90, None),
    "fchmod": (91, 52),
    "fchmodat": (268, 53),
    "fchmodat2": (452, 452),
    "chown": (92, None),
    "fchown": (93, 55),
    "lchown": (94, None),
    "fchownat": (260, 54),
    "utime": (132, None),
    "utimes": (235, None),
    "futimesat": (261, None),
    "utimensat": (280, 88),
    "truncate": (76, 45),
    "setxattr": (188, 5),
    "lsetxattr": (189, 6),
    "fsetxattr": (190, 7),
    "setxattrat": (463, 463),
    "removexattr": (197, 14),
    "lremovexattr": (198, 15),
    "fremovexattr": (199, 16),
    "removexattrat": (466, 466),
    "flock": (73, 32),
    "inotify_init": (253, None),
    "inotify_init1": (294, 26),
    "fanotify_init": (300, 262),
    "sync": (162, 81),
    "syncfs": (306, 267),
    "syslog": (103, 116),
}
# A lease makes everybody else wait who opens the file.
FCNTL, LEASES = (72, 25), (1024, 1026)
# Allowed for process 0, the caller, which can only lower its limits. Changed limits of the worker, its parent, would
# hold for the next exercise too.
PRLIMIT = (302, 261)
CLONE, CLONE3 = (56, 220), (435, 435)
CLONE_THREAD = 0x10000
# The column of each machine in the tables above, and its audit architecture.
MACHINES = {"x86_64": (0, 0xC000003E), "aarch64": (1, 0xC00000B7)}

LOAD, EQUAL, AT_LEAST, HAS_BITS, RETURN = 0x20, 0x15, 0x35, 0x45, 0x06
# a refused call returns the error number
ALLOW, KILL, REFUSE = (
    0x7FFF0000,
    0x80000000,
    0x00050000,
)
# offsets in struct seccomp_data
CALL, ARCHITECTURE, FIRST_ARGUMENT, SECOND_ARGUMENT = 0, 4, 16, 24

PR_SET_SECCOMP, PR_SET_NO_NEW_PRIVS, FILTER_MODE = 22, 38, 2
LANDLOCK_CREATE, LANDLOCK_ADD, LANDLOCK_RESTRICT = 444, 445, 446
# Landlock: execute, read a file, list a folder; all of its first version
READ, ALL_OF_IT, LIST = (
    0b1101,
    (1 << 13) - 1,
    0b1000,
)
# Users that no system assigns, and users that no container assigns, which has few.
USERS, CONTAINER_USERS = range(2_000_000, 4_000_000), range(62_000, 65_000)
OF_A_FILE = 0b111  # execute, write, read: the rights of a file; the others are rights of folders


def most_tasks() -> int:
    """Return how many processes and threads the user may have: few if it is this sandbox's, and else a safe number."""
    own = os.name == "posix" and any(
        os.getuid() in users for users in (USERS, CONTAINER_USERS)
    )
    return 64 if own else 4096


def limit(amounts: Mapping[str, int]) -> None:
    """Set resource limits, soft and hard, by their names in ``resource`` without RLIMIT_, such as ``AS`` in bytes."""
    if os.name != "posix":
        return
    import resource

    for name, amount in amounts.items():
        number = getattr(resource, f"RLIMIT_{name}")
        hard = resource.getrlimit(number)[1]
        if hard != resource.RLIM_INFINITY:
            amount = min(amount, hard)
        resource.setrlimit(number, (amount, amount))


def filter_program(machine: str) -> bytes:
    """Return the seccomp filter as classic BPF: it refuses ``REFUSED`` and new processes, and allows the rest."""
    column, architecture = MACHINES[machine]

    def step(code: int, value: int, then: int = 0, otherwise: int = 0) -> bytes:
        return struct.pack("=HBBI", code, then, otherwise, value)

    refuse = step(RETURN, REFUSE | errno.EPERM)
    program = [
        step(LOAD, ARCHITECTURE),
        step(EQUAL, architecture, then=1),
        step(RETURN, KILL),
        step(LOAD, CALL),
    ]
    if machine == "x86_64":
        # the 32-bit ABI, whose calls have other numbers
        program += [
            step(AT_LEAST, 0x40000000, otherwise=1),
            refuse,
        ]
    for numbers in REFUSED.values():
        if (number := numbers[column]) is not None:
            program += [step(EQUAL, number, otherwise=1), refuse]
    # A filter cannot read the flags of clone3, which are behind a pointer. Without clone3 the C library uses clone.
    program += [
        step(EQUAL, CLONE3[column], otherwise=1),
        step(RETURN, REFUSE | errno.ENOSYS),
    ]
    program += [step(EQUAL, FCNTL[column], otherwise=5), step(LOAD, SECOND_ARGUMENT)]
    program += [step(EQUAL, LEASES[0], then=1), step(EQUAL, LEASES[1], otherwise=1)]
    program += [refuse, step(RETURN, ALLOW)]
    program += [step(EQUAL, PRLIMIT[column], otherwise=4), step(LOAD, FIRST_ARGUMENT)]
    program += [step(EQUAL, 0, then=1), refuse, step(RETURN, ALLOW)]
    program += [step(EQUAL, CLONE[column], otherwise=3), step(LOAD, FIRST_ARGUMENT)]
    program += [step(HAS_BITS, CLONE_THREAD, then=1), refuse, step(RETURN, ALLOW)]
    return b"".join(program)


def filter_calls() -> bool:
    """Install the system call filter. Return whether this machine supports it."""
    if platform.system() != "Linux" or platform.machine() not in MACHINES:
        return False
    program = filter_program(platform.machine())
    buffer = ctypes.create_string_buffer(program, len(program))
    described = struct.pack("@HP", len(program) // 8, ctypes.addressof(buffer))
    _gain_nothing()
    return ctypes.CDLL(None).prctl(PR_SET_SECCOMP, FILTER_MODE, described, 0, 0) == 0


def all_but(folder: str, hidden: Iterable[str]) -> tuple[list[str], list[str]]:
    """Return what may be read of a folder so that ``hidden`` folders in it may not, and which folders may be listed.

    Landlock can allow folders, but cannot refuse a folder inside one that it allows.
    """
    inside = [one for one in hidden if one.startswith(folder + os.sep)]
    if not inside:
        return [folder], []
    readable, listed = [], [folder]
    for entry in os.scandir(folder):
        if entry.path not in inside and not entry.is_symlink():
            below = all_but(entry.path, inside)
            readable += below[0]
            listed += below[1]
    return readable, listed


def restrict_files(
    readable: Iterable[str], writable: Iterable[str], listed: Iterable[str] = ()
) -> bool:
    """Hide all other folders and files from this process with Landlock. Return whether this kernel supports it."""
    call = ctypes.CDLL(None, use_errno=True).syscall
    rules = call(LANDLOCK_CREATE, struct.pack("=Q", ALL_OF_IT), ctypes.c_size_t(8), 0)
    if rules < 0:
        return False
    granted = ((readable, READ), (writable, ALL_OF_IT), (listed, LIST))
    for paths, rights in granted:
        for path in paths:
            if not os.path.exists(path):
                continue
            descriptor = os.open(path, os.O_PATH | os.O_CLOEXEC)
            allowed = rights if os.path.isdir(path) else rights & OF_A_FILE
            call(LANDLOCK_ADD, rules, 1, struct.pack("=Qi", allowed, descriptor), 0)
            os.close(descriptor)
    _gain_nothing()
    done = call(LANDLOCK_RESTRICT, rules, 0)
    os.close(rules)
    return done == 0


def unused_user() -> int:
    """Return the number of a user that owns nothing, and that exists in this container."""
    with open("/proc/self/uid_map") as file:
        last = max(
            int(start) + int(length) for start, _, length in map(str.split, file)
        )
    users = USERS if last > USERS.stop else CONTAINER_USERS
    return random.SystemRandom().choice(users)


def become(user: int) -> None:
    """Change to a user and a group that own no files. Only root can do this."""
    os.setgroups([])
    os.setresgid(user, user, user)
    os.setresuid(user, user, user)
    _gain_nothing()


def _gain_nothing() -> None:
    if ctypes.CDLL(None).prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
        raise OSError("the kernel cannot promise that no privileges are gained")
