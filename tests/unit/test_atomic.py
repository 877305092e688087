"""Files are written completely or not at all, and what stands at the path keeps its nature."""

import os
import stat
import threading
from pathlib import Path

import pytest

from robonav.atomic import atomic_write


def write(path, text=b"new"):
    with atomic_write(path) as file:
        file.write(text)


def test_a_link_stays_a_link(tmp_path):
    target = tmp_path / "far" / "results.csv"
    target.parent.mkdir()
    target.write_bytes(b"old")
    link = tmp_path / "results.csv"
    link.symlink_to(target)
    write(link)
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


def test_permissions_are_kept_and_new_files_follow_the_umask(tmp_path):
    private, new = tmp_path / "grades.csv", tmp_path / "new.csv"
    private.touch(mode=0o600)
    write(private)
    assert stat.S_IMODE(private.stat().st_mode) == 0o600
    umask = os.umask(0o027)
    try:
        write(new)
    finally:
        os.umask(umask)
    assert stat.S_IMODE(new.stat().st_mode) == 0o640


def test_a_pipe_and_a_device_are_written_to(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=write, args=(pipe,))
    writer.start()
    assert pipe.read_bytes() == b"new"
    writer.join()
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    write(os.devnull)
    assert stat.S_ISCHR(Path(os.devnull).stat().st_mode)


def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "results.csv"
    write(path, b"old")
    with pytest.raises(TypeError):
        write(path, "no bytes")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_longest_name_can_be_written(tmp_path):
    path = tmp_path / ("x" * 251 + ".csv")
    write(path)
    assert path.read_bytes() == b"new"
