"""What is taken of a submission, and what is refused."""

import gzip
import os
import tracemalloc
import zipfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robonav.grading import submission
from robonav.grading.submission import Refused, Submission, load_submission, read


def zipped(folder, entries, name="work.zip"):
    with zipfile.ZipFile(folder / name, "w", zipfile.ZIP_DEFLATED) as archive:
        for entry, content in entries:
            archive.writestr(entry, content)
    return folder / name


def test_a_folder_gives_its_python_files_and_notebooks_alone(tmp_path):
    for name in (
        "ch2/a.py",
        "ch2.ipynb",
        "data.csv",
        ".git/b.py",
        "__pycache__/c.py",
        "venv/lib/d.py",
        ".hidden.py",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    assert read(tmp_path).files == {"ch2/a.py": b"ch2/a.py", "ch2.ipynb": b"ch2.ipynb"}


def test_a_zip_gives_the_same(tmp_path):
    path = zipped(
        tmp_path,
        [
            ("x/ch2/a.py", "a"),
            ("x/", ""),
            ("__MACOSX/x/._a.py", "?"),
            ("x/data.bin", "d"),
        ],
    )
    assert read(path).files == {"x/ch2/a.py": b"a"}


def test_names_and_contents_make_the_digest():
    digests = {
        Submission(files).digest
        for files in ({}, {"a.py": b""}, {"b.py": b""}, {"a.py": b"b"}, {"a.pyb": b""})
    }
    assert len(digests) == 5
    assert (
        Submission({"a.py": b"1", "b.py": b"2"}).digest
        == Submission({"b.py": b"2", "a.py": b"1"}).digest
    )


def test_a_link_that_leaves_is_not_followed_and_named(tmp_path):
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside/a.py").write_text("secret")
    (tmp_path / "in").mkdir()
    (tmp_path / "in/b.py").write_text("mine")
    (tmp_path / "in/more").symlink_to(tmp_path / "outside")
    (tmp_path / "in/c.py").symlink_to(tmp_path / "outside/a.py")
    (tmp_path / "in/d.py").symlink_to("../outside/a.py")
    loaded = read(tmp_path / "in")
    assert loaded.files == {"b.py": b"mine"}
    assert [problem.split()[0] for problem in loaded.problems] == ["c.py", "d.py"]
    (tmp_path / "whole").symlink_to(tmp_path / "outside")
    with pytest.raises(Refused, match="link"):
        read(tmp_path / "whole")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_a_pipe_is_refused_and_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.py")
    with pytest.raises(Refused, match="not a regular file"):
        read(tmp_path)


@pytest.mark.parametrize(
    "name",
    [
        "../a.py",
        "/etc/a.py",
        "x/../../a.py",
        "C:\\a.py",
        "C:a.py",
        "x\\..\\a.py",
    ],
)
def test_a_zip_that_leaves_its_folder_is_refused(tmp_path, name):
    entry = zipfile.ZipInfo("placeholder")
    entry.filename = name
    with pytest.raises(Refused):
        read(zipped(tmp_path, [(entry, "x")]))


def test_a_name_that_not_every_system_can_write_is_changed(tmp_path):
    (taken,) = read(zipped(tmp_path, [("ab: c\td.py", "x")])).files
    assert taken == "ab_ c_d.py"
    (taken,) = read(zipped(tmp_path, [("d" * 300 + ".py", "x")], "long.zip")).files
    assert taken == "d" * 77 + ".py"


def test_a_link_in_a_zip_is_refused(tmp_path):
    entry = zipfile.ZipInfo("a.py")
    entry.external_attr = 0o120777 << 16
    with pytest.raises(Refused, match="link"):
        read(zipped(tmp_path, [(entry, "/etc/passwd")]))


@pytest.mark.slow
def test_too_much_is_not_taken(tmp_path):
    bomb = zipped(tmp_path, [("a.py", b"0" * (200 << 20))])
    assert bomb.stat().st_size < 1 << 20
    with pytest.raises(Refused, match="more than 8 MB"):
        read(bomb)
    many = [(f"x/{n}.py", "") for n in range(submission.MOST_FILES + 1)]
    loaded = read(zipped(tmp_path, [*many, ("a.py", "")], "many.zip"))
    assert len(loaded.files) == submission.MOST_FILES
    assert "a.py" in loaded.files  # the outer folders are read first
    assert loaded.problems == ("more than 200 Python files and notebooks",)


@pytest.mark.parametrize("kind", ["zip", pytest.param("tar", marks=pytest.mark.slow)])
def test_an_archive_of_a_few_bytes_is_not_unpacked_to_gigabytes(tmp_path, kind):
    """Neither at once, nor in many parts, nor in archives within archives."""
    if kind == "zip":
        inner = zipped(tmp_path, [("a.py", b"0" * (200 << 20))], "inner.zip")
        parts = [(f"{n}.zip", inner.read_bytes()) for n in range(50)]
        path = zipped(tmp_path, parts, "bomb.zip")
    else:
        path = tmp_path / "bomb.tar.gz"
        path.write_bytes(gzip.compress(b"\0" * (200 << 20)))
    assert path.stat().st_size < 1 << 24
    tracemalloc.start()
    with pytest.raises(Refused, match="more than"):
        read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 300 << 20


@pytest.mark.slow
def test_a_zip_whose_table_of_contents_is_endless_is_not_read(tmp_path):
    path = zipped(tmp_path, [("a.py", "x = 1")])
    content = bytearray(path.read_bytes())
    content[-10:-6] = (100 << 20).to_bytes(4, "little")  # the table's size
    with path.open("wb") as file:
        file.write(b"\0" * (120 << 20) + content)
    with pytest.raises(Refused, match="table of contents is too large"):
        read(path)


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_the_same_file_many_times_is_as_much(tmp_path):
    """Each of a few bytes packed, and of megabytes to unpack; the last one alone would be kept."""
    loaded = read(zipped(tmp_path, [("a.py", b"0" * (1 << 20))] * 9))
    assert "more than 8 MB of files" in loaded.problems[0]
    assert read(zipped(tmp_path, [("a.py", b"first"), ("a.py", b"last")])).files == {
        "a.py": b"last"
    }


@pytest.mark.parametrize(
    "kind",
    [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA],
)
def test_a_zip_may_be_packed_in_any_way_and_is_refused_where_it_is_damaged(
    tmp_path, kind
):
    with zipfile.ZipFile(tmp_path / "A.ZIP", "w", kind) as archive:
        archive.writestr("a.py", "x = 1\n" * 50)
    assert read(tmp_path / "A.ZIP").files == {"a.py": b"x = 1\n" * 50}
    content = bytearray((tmp_path / "A.ZIP").read_bytes())
    content[45:55] = b"\xff" * 10
    (tmp_path / "A.ZIP").write_bytes(content)
    with pytest.raises(Refused, match="cannot be read"):
        read(tmp_path / "A.ZIP")


@pytest.mark.parametrize("lost", [".", "ch2"])
def test_a_folder_that_cannot_be_read_is_refused_and_not_empty(
    tmp_path, monkeypatch, lost
):
    (tmp_path / "anna/ch2").mkdir(parents=True)
    (tmp_path / "anna/ch2/a.py").write_text("")

    def locked(enter):
        def tried(path):
            if Path(path) == tmp_path / "anna" / lost:
                raise PermissionError(13, "Permission denied", str(path))
            return enter(path)

        return tried

    for name in ("scandir", "listdir"):
        monkeypatch.setattr(os, name, locked(getattr(os, name)))
    with pytest.raises(Refused, match="cannot be read: Permission denied"):
        read(tmp_path / "anna")


@pytest.mark.parametrize("content", [b"", b"no zip", b"PK\x03\x04" + b"\0" * 40])
def test_a_broken_zip_is_refused(tmp_path, content):
    (tmp_path / "a.zip").write_bytes(content)
    assert isinstance(load_submission(tmp_path / "a.zip"), Refused)


@given(st.data())
def test_a_damaged_zip_is_read_or_refused(tmp_path_factory, data):
    path = zipped(
        tmp_path_factory.mktemp("zip"),
        [("ch2/a.py", "x = 1\n" * 50), ("b.ipynb", "{}")],
    )
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 5))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(
            st.integers(0, 255)
        )
    path.write_bytes(content)
    assert isinstance(load_submission(path), Submission | Refused)


def test_what_is_no_submission_is_named(tmp_path):
    with pytest.raises(
        ValueError, match="must be a folder, a zip, a notebook or a Python file"
    ):
        read(tmp_path / "nothing")
    (tmp_path / "essay.docx").write_text("")
    with pytest.raises(ValueError, match=r"essay\.docx"):
        read(tmp_path / "essay.docx")
