"""Frames against what they must carry, and against bytes made to break them."""

import io
import json
import math
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from robonav.grading import frames
from robonav.grading.frames import FrameError

ARRAYS = st.sampled_from(frames.DTYPES).flatmap(
    lambda dtype: hnp.arrays(dtype, hnp.array_shapes(min_dims=0, min_side=0))
)
TEXT = st.text(st.characters(exclude_categories=["Cs"]))
LEAVES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**64 - 1),
    st.floats(allow_nan=True),
    TEXT,
    ARRAYS,
)
VALUES = st.recursive(
    LEAVES,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.lists(inner, max_size=4).map(tuple),
        st.dictionaries(TEXT, inner, max_size=4),
    ),
    max_leaves=12,
)


def same(one, other):
    """Equal in kind, dtype, shape and value, NaN equal to NaN."""
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return (
            one.dtype == other.dtype
            and one.shape == other.shape
            and one.tobytes() == other.tobytes()
        )
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, dict):
        return list(one) == list(other) and all(
            same(one[key], other[key]) for key in one
        )
    return one == other or (
        isinstance(one, float) and math.isnan(one) and math.isnan(other)
    )


def made(value, arrays=(), body=b""):
    """A frame with a header of one's own making."""
    header = json.dumps({"value": value, "arrays": list(arrays)}).encode()
    return frames.PREFIX.pack(len(header), len(body)) + header + body


@given(VALUES)
def test_what_goes_in_comes_out(value):
    assert same(frames.decode(frames.encode(value)), value)


@given(st.lists(VALUES, max_size=4))
def test_a_stream_keeps_frames_apart(values):
    stream = io.BytesIO(b"".join(map(frames.encode, values)))
    assert all(same(frames.read(stream), value) for value in values)
    with pytest.raises(EOFError):
        frames.read(stream)


@pytest.mark.parametrize(
    "scalar", [np.float32(0.5), np.int8(-3), np.bool_(True), np.float64("inf")]
)
def test_numpy_scalars_arrive_as_python_numbers(scalar):
    assert same(frames.decode(frames.encode(scalar)), scalar.item())


def test_memory_order_and_byte_order_do_not_matter():
    array = np.arange(6, dtype=">i4").reshape(2, 3)[:, ::-1].T
    back = frames.decode(frames.encode(array))
    assert back.dtype.str == "<i4"
    assert back.flags.writeable
    np.testing.assert_array_equal(back, array)


def test_a_subclass_of_ndarray_arrives_plain():
    class Always(np.ndarray):
        def __eq__(self, other):
            return True

    back = frames.decode(frames.encode(np.zeros(3).view(Always)))
    assert type(back) is np.ndarray


@pytest.mark.parametrize(
    "value",
    [
        object(),
        {1, 2},
        b"bytes",
        1 + 2j,
        {1: "a"},
        1 << 64,
        -(1 << 63) - 1,
        np.array([None]),
        np.array(["text"]),
        np.zeros(2, dtype="c16"),
        np.zeros((1,) * (frames.MOST_AXES + 1)),
        (n for n in range(3)),
        np.zeros(frames.MOST_ARRAYS + 1, dtype="i1"),
        "x" * (frames.MOST_HEADER + 1),
    ],
    ids=lambda value: type(value).__name__,
)
def test_nothing_else_is_sent(value):
    with pytest.raises(FrameError):
        frames.encode(value)


def test_a_list_that_holds_itself_is_refused():
    loop = []
    loop.append(loop)
    with pytest.raises(FrameError, match="deep"):
        frames.encode(loop)


@pytest.mark.parametrize(
    "frame",
    [
        b"",
        b"\0" * 7,
        frames.encode(1)[:-1],
        frames.encode(1) + b"x",
        frames.PREFIX.pack(1 << 31, 0),
        frames.PREFIX.pack(2, 0) + b"\xff\xff",
        made({"float": "1"}),
        made({"float": "nan", "more": 1}),
        made({"array": 0}),
        made([{"array": 0}] * 2, [["|i1", [1]]], b"x"),
        made([{"array": 1}, {"array": 0}], [["|i1", [1]]] * 2, b"xy"),
        made({"array": -1}, [["|i1", [1]]], b"x"),
        made({"array": True}, [["|i1", [1]], ["|i1", [1]]], b"xy"),
        made(1, [["|i1", [1]]]),
        made(1, [["|i1", [1 << 62, 1 << 62]]]),
        made(1, [["|i1", [0, 1 << 80]]]),
        made(1, [["|i1", [-1]]], b""),
        made(1, [["|i1", [True]]], b"x"),
        made(1, [["|i1", [1] * 33]], b"x"),
        made(1, [["|O8", [1]]], b"12345678"),
        made(1, [["|V1", [1]]], b"x"),
        made(1, [["|i1"]], b""),
        made(1, [], b"left over"),
        made("\ud800"),
        made({"dict": {"\udfff": 1}}),
        made({"dict": [[1, 2]]}),
        made({"set": [1]}),
        made({}),
        made(1 << 64),
    ],
)
def test_what_is_no_frame_is_refused(frame):
    with pytest.raises(FrameError):
        frames.decode(frame)


@pytest.mark.parametrize(
    "text",
    [
        b"NaN",
        b"1e999",
        b"[" * 200_000,
        b"1" * 10_000,
        b'{"value":1}',
        b'{"value":1,"arrays":{}}',
    ],
)
def test_a_header_that_is_no_header_is_refused(text):
    for header in (text, b'{"value":' + text + b',"arrays":[]}'):
        with pytest.raises(FrameError):
            frames.decode(frames.PREFIX.pack(len(header), 0) + header)


def test_depth_is_checked_on_arrival():
    tree = 1
    for _ in range(frames.MOST_DEPTH):
        tree = [tree]
    with pytest.raises(FrameError, match="deep"):
        frames.decode(made(tree))


def test_a_byte_that_is_no_truth_value_becomes_one():
    truth = frames.decode(made({"array": 0}, [["|b1", [3]]], b"\x00\x01\x07"))
    assert truth.view(np.uint8).tolist() == [0, 1, 1]


@settings(max_examples=500)
@given(st.binary(max_size=200))
def test_any_bytes_give_a_value_or_a_frame_error(junk):
    sized = frames.PREFIX.pack(len(junk), 0) + junk
    for frame in (junk, sized):
        with suppress(FrameError):
            frames.decode(frame)


JSON = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.floats(),
        st.text(),
        st.sampled_from(frames.DTYPES),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(
            st.sampled_from(["float", "tuple", "dict", "array", "other"]),
            inner,
            max_size=2,
        ),
    ),
    max_leaves=15,
)


@pytest.mark.slow
@settings(max_examples=500)
@given(JSON, JSON, st.binary(max_size=20))
def test_any_header_gives_a_value_or_a_frame_error(value, arrays, body):
    with suppress(FrameError):
        frames.encode(frames.decode(made(value, [arrays], body)))


@pytest.mark.slow
@settings(max_examples=300)
@given(VALUES, st.data())
def test_a_frame_with_changed_bytes_gives_a_value_or_a_frame_error(value, data):
    frame = bytearray(frames.encode(value))
    for _ in range(data.draw(st.integers(1, 4))):
        frame[data.draw(st.integers(0, len(frame) - 1))] = data.draw(
            st.integers(0, 255)
        )
    with suppress(FrameError):
        frames.decode(bytes(frame))
