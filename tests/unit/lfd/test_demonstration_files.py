"""Demonstrations in files: round trips, and errors for files that are damaged or of another format."""

import os
import zipfile

import numpy as np
import pytest

from robonav.lfd import (
    demonstrate,
    learn_policy,
    load_demonstrations,
    save_demonstrations,
)
from robonav.robot import neighbour_slip, random_worlds


@pytest.fixture(scope="module")
def demonstrations():
    return demonstrate(random_worlds(6, 8, 2, seed=11), slip=neighbour_slip(0.2))


@pytest.fixture
def written(demonstrations, tmp_path):
    path = tmp_path / "drives.npz"
    save_demonstrations(path, demonstrations)
    return path


def changed(path, **arrays):
    """The file again with some arrays replaced, or left out where None."""
    with np.load(path) as archive:
        held = {name: archive[name] for name in archive.files} | arrays
    np.savez(path, **{name: array for name, array in held.items() if array is not None})


def test_round_trip(demonstrations, written):
    back = load_demonstrations(written)
    for name in ("trajectory", "actions", "poses", "outcome"):
        assert np.array_equal(getattr(back, name), getattr(demonstrations, name))
        assert getattr(back, name).dtype == getattr(demonstrations, name).dtype
    for name in ("ranges", "walls", "target_region", "target_seen"):
        assert np.array_equal(
            getattr(back.sensing, name), getattr(demonstrations.sensing, name)
        )
    assert back.speed == demonstrations.speed
    assert back.worlds.digest() == demonstrations.worlds.digest()
    mine, again = (
        learn_policy(demonstrations, iterations=20),
        learn_policy(back, iterations=20),
    )
    assert np.array_equal(mine.network.weights[0], again.network.weights[0])


def test_no_trajectories_round_trip(tmp_path):
    save_demonstrations(tmp_path / "none.npz", demonstrate(random_worlds(0, 3, seed=1)))
    assert len(load_demonstrations(tmp_path / "none.npz")) == 0


def test_equal_demonstrations_give_equal_arrays_without_objects(written):
    with zipfile.ZipFile(written) as archive:
        assert not any(
            b"'O'" in archive.read(name)[:128] for name in archive.namelist()
        )


def test_another_version(written):
    changed(written, format=np.array("robonav demonstrations 2"))
    with pytest.raises(
        ValueError,
        match=r"drives.npz has the format 'robonav demonstrations 2', expected '.* 1'",
    ):
        load_demonstrations(written)


def test_a_foreign_file(tmp_path, written):
    np.savez(tmp_path / "other.npz", poses=np.zeros(3))
    with pytest.raises(ValueError, match=r"other\.npz has the format ''"):
        load_demonstrations(tmp_path / "other.npz")
    np.save(tmp_path / "one.npy", np.zeros(3))
    for name, content in [("text.npz", b"robonav"), ("empty.npz", b"")]:
        (tmp_path / name).write_bytes(content)
    for name in ("text.npz", "empty.npz", "one.npy"):
        with pytest.raises(
            ValueError, match=f"{name} is damaged, or is not an npz archive"
        ):
            load_demonstrations(tmp_path / name)


def test_no_file(tmp_path):
    with pytest.raises(FileNotFoundError):
        load_demonstrations(tmp_path / "nowhere.npz")


def test_cut_off_and_scrambled_files(written):
    whole, rng = written.read_bytes(), np.random.default_rng(1)
    for _ in range(60):
        written.write_bytes(whole[: rng.integers(len(whole))])
        with pytest.raises(ValueError, match=r"drives\.npz is damaged"):
            load_demonstrations(written)
    for _ in range(60):
        scrambled = bytearray(whole)
        for place in rng.integers(len(whole), size=20):
            scrambled[place] ^= int(rng.integers(1, 256))
        written.write_bytes(scrambled)
        with pytest.raises(
            ValueError, match=r"\Adrives\.npz [^\n]+\Z"
        ):  # zip keeps a checksum of everything
            load_demonstrations(written)


class Intruder:
    def __reduce__(self):
        return os.mkdir, ("intruder",)


@pytest.mark.parametrize("name", ["actions", "speed", "worlds.kinds", "more"])
def test_pickled_objects_are_never_loaded(written, tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    changed(written, **{name: np.array([Intruder()], dtype=object)})
    with pytest.raises(
        ValueError,
        match=r"drives\.npz holds a pickled object, which could run code and is never loaded",
    ):
        load_demonstrations(written)
    assert not (tmp_path / "intruder").exists()


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"poses": None}, "drives.npz differs from .* in poses"),
        ({"more": np.zeros(2)}, "drives.npz differs from .* in more"),
        ({"actions": np.zeros(3)}, "ranges must have shape"),
        ({"outcome": np.zeros(6, int)}, "outcome must lie in 1..3, got 0..0"),
        ({"outcome": np.ones(2, int)}, "outcome must have shape"),
        ({"speed": np.array(-1.0)}, "speed must be greater than 0"),
        ({"speed": np.zeros(2)}, "does not hold demonstrations"),
        ({"speed": np.array("fast")}, "speed must be a number"),
        ({"worlds.shapes": np.zeros(1)}, "worlds: shapes must have shape"),
        ({"trajectory": np.array("x")}, "trajectory must be an array of numbers"),
    ],
)
def test_impossible_values_are_errors(written, arrays, message):
    changed(written, **arrays)
    with pytest.raises(ValueError, match=message) as caught:
        load_demonstrations(written)
    assert str(caught.value).startswith("drives.npz")
    assert "\n" not in str(caught.value)


def test_ranges_out_of_range(written, demonstrations):
    changed(written, ranges=demonstrations.sensing.ranges + 1)
    with pytest.raises(ValueError, match=r"ranges must lie in 0\.\.10"):
        load_demonstrations(written)


def test_nothing_half_written(demonstrations, tmp_path, monkeypatch):
    def fails(file, **arrays):
        file.write(b"half")
        raise OSError("no space left")

    monkeypatch.setattr(np, "savez_compressed", fails)
    with pytest.raises(OSError, match="no space left"):
        save_demonstrations(tmp_path / "drives.npz", demonstrations)
    assert list(tmp_path.iterdir()) == []


def test_the_format_may_be_written_as_bytes(written, demonstrations):
    changed(written, format=np.array(b"robonav demonstrations 1"))
    assert len(load_demonstrations(written)) == len(demonstrations)
    changed(written, format=np.array(b"\xff"))
    with pytest.raises(ValueError, match=r"drives\.npz has the format"):
        load_demonstrations(written)


@pytest.mark.parametrize("place", [-0.001, 100.001, 1000.0])
def test_poses_off_the_map_are_refused(written, demonstrations, place):
    poses = demonstrations.poses.copy()
    poses[3, 1] = place
    changed(written, poses=poses)
    with pytest.raises(ValueError, match=r"poses must have x and y in 0\.\.100, got"):
        load_demonstrations(written)
