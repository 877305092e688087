"""Archives of arrays: written whole, read with one error for each thing that can be wrong."""

import numpy as np
import pytest

from robonav.archive import Damaged, Pickled, read_archive, write_archive


@pytest.mark.parametrize("compressed", [True, False])
def test_round_trip(tmp_path, compressed):
    arrays = {"format": np.array("a 1"), "b.c": np.arange(6.0).reshape(2, 3)}
    write_archive(tmp_path / "a.npz", arrays, compressed=compressed)
    found = read_archive(tmp_path / "a.npz")
    assert found.keys() == arrays.keys()
    for name, array in arrays.items():
        np.testing.assert_array_equal(found[name], array)


def test_no_file(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_archive(tmp_path / "a.npz")


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"text"])
def test_damaged_file(tmp_path, content):
    (tmp_path / "a.npz").write_bytes(content)
    with pytest.raises(Damaged):
        read_archive(tmp_path / "a.npz")


def test_single_array_is_no_archive(tmp_path):
    np.save(tmp_path / "a.npy", np.arange(3))
    with pytest.raises(Damaged):
        read_archive(tmp_path / "a.npy")


def test_pickled_object(tmp_path):
    np.savez(tmp_path / "a.npz", a=np.array([{}], dtype=object))
    with pytest.raises(Pickled):
        read_archive(tmp_path / "a.npz")
