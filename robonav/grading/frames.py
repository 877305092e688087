"""Frames: the only data that pass between the grader and a student's code.

A frame is a prefix with two sizes, a JSON header, and the raw bytes of its arrays one after another. It can hold
numbers, strings, ``None``, lists, tuples, dicts with strings as keys, and plain arrays, but nothing that could run code
when it is read. Other keys are refused, because a dict of many whole numbers chosen to collide takes minutes to build.
Every size is checked before memory is allocated. This file imports only numpy, because it also runs in the sandbox.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Callable, Iterator, Sequence
from typing import Any, BinaryIO

import numpy as np

PREFIX = struct.Struct(">II")  # bytes of the header, bytes of all arrays together
MOST_HEADER = 1 << 20
MOST_ARRAYS = 1 << 26
MOST_ANSWER = (
    1 << 22
)  # bytes of the arrays in an answer, of which the grader keeps many
MOST_DEPTH = 16
MOST_AXES = 8
DTYPES = (
    "|b1",
    "|i1",
    "|u1",
    "<i2",
    "<u2",
    "<i4",
    "<u4",
    "<i8",
    "<u8",
    "<f2",
    "<f4",
    "<f8",
)
UNUSUAL = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}


class FrameError(ValueError):
    """Raised for bytes that are not a frame, or for a value that a frame cannot hold."""


def encode(value: Any) -> bytes:
    """Encode a value as one frame.

    Raises
    ------
    FrameError
        If the value contains any other type, is nested too deeply, or is too large.
    """
    arrays: list[np.ndarray] = []
    tree = _to_tree(value, arrays, MOST_DEPTH)
    header = {
        "value": tree,
        "arrays": [[array.dtype.str, array.shape] for array in arrays],
    }
    text = json.dumps(header, allow_nan=False, separators=(",", ":")).encode()
    body = b"".join(array.tobytes() for array in arrays)
    _check_sizes(len(text), len(body))
    return PREFIX.pack(len(text), len(body)) + text + body


def decode(frame: bytes) -> Any:
    """Decode one whole frame. This inverts ``encode``, except that numpy scalars become Python numbers.

    Raises
    ------
    FrameError
        If the bytes are not exactly one well-formed frame.
    """
    if len(frame) < PREFIX.size:
        raise FrameError("the frame is shorter than its prefix")
    sizes = _check_sizes(*PREFIX.unpack_from(frame))
    if len(frame) != PREFIX.size + sum(sizes):
        raise FrameError(
            f"the frame should hold {sum(sizes)} bytes, it holds {len(frame) - PREFIX.size}"
        )
    header = _parse(frame[PREFIX.size : PREFIX.size + sizes[0]])
    arrays = _to_arrays(header["arrays"], memoryview(frame)[PREFIX.size + sizes[0] :])
    waiting = iter(enumerate(arrays))
    value = _from_tree(header["value"], waiting, MOST_DEPTH)
    if next(waiting, None):
        raise FrameError("an array is not used by the value")
    return value


def differing(values: Sequence[Any], encoded: Sequence[bytes]) -> list[int]:
    """Return the places of the values that are no longer what they were when they were encoded."""
    return [
        place
        for place, (value, frame) in enumerate(zip(values, encoded, strict=True))
        if _encoded(value) != frame
    ]


def _encoded(value: Any) -> bytes | None:
    try:
        return encode(value)
    except FrameError:
        return None


def write(stream: BinaryIO, value: Any) -> None:
    """Send one frame."""
    stream.write(encode(value))
    stream.flush()


def read(stream: BinaryIO) -> Any:
    """Receive one frame. Raises EOFError if the stream ends first."""
    return receive(lambda size: _exactly(stream, size))


def receive(exactly: Callable[[int], bytes], most: int = MOST_ARRAYS) -> Any:
    """Receive one frame with a function that returns a given number of bytes.

    The function is never asked for more bytes than a frame may have, with at most ``most`` in its arrays.
    """
    prefix = exactly(PREFIX.size)
    header, arrays = PREFIX.unpack(prefix)
    sizes = _check_sizes(header, arrays, most)
    return decode(prefix + exactly(sum(sizes)))


def _exactly(stream: BinaryIO, size: int) -> bytes:
    parts = bytearray()
    while len(parts) < size:
        part = stream.read(size - len(parts))
        if not part:
            raise EOFError("the stream ended")
        parts += part
    return bytes(parts)


def _check_sizes(header: int, arrays: int, most: int = MOST_ARRAYS) -> tuple[int, int]:
    if header > MOST_HEADER or arrays > most:
        raise FrameError(f"{header + arrays} bytes are too many for one frame")
    return header, arrays


def _to_tree(value: Any, arrays: list[np.ndarray], depth: int) -> Any:
    """Convert a value to JSON types. A type that JSON lacks becomes an object whose one key names the type."""
    if depth == 0:
        raise FrameError(f"nested more than {MOST_DEPTH} deep")
    if isinstance(value, np.generic):
        value = value.item()
    match value:
        case None | bool() | str():
            return value
        case int():
            if not -(1 << 63) <= value < 1 << 64:
                raise FrameError("a whole number of more than 64 bits")
            return int(value)
        case float():
            return (
                float(value) if math.isfinite(value) else {"float": str(float(value))}
            )
        case list():
            return [_to_tree(item, arrays, depth - 1) for item in value]
        case tuple():
            return {"tuple": [_to_tree(item, arrays, depth - 1) for item in value]}
        case dict() if all(isinstance(key, str) for key in value):
            return {
                "dict": {
                    key: _to_tree(item, arrays, depth - 1)
                    for key, item in value.items()
                }
            }
        case np.ndarray():
            plain = np.asarray(value)
            plain = plain.astype(plain.dtype.newbyteorder("<"), copy=False)
            if plain.dtype.str not in DTYPES or plain.ndim > MOST_AXES:
                raise FrameError(
                    f"an array of dtype {plain.dtype} and {plain.ndim} axes"
                )
            arrays.append(plain)
            return {"array": len(arrays) - 1}
    # a dict is refused only for its keys
    raise FrameError(f"a value of type {type(value).__name__}")


def _parse(text: bytes) -> dict[str, Any]:
    try:
        header = json.loads(text.decode(), parse_constant=_no_constant)
    except (ValueError, RecursionError) as error:
        raise FrameError(f"the header is not JSON: {error}") from None
    if (
        not isinstance(header, dict)
        or set(header) != {"value", "arrays"}
        or not isinstance(header["arrays"], list)
    ):
        raise FrameError("the header must hold a value and its arrays")
    return header


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is not JSON")


def _to_arrays(described: list[Any], body: memoryview) -> list[np.ndarray]:
    arrays, start = [], 0
    for entry in described:
        match entry:
            case [str(dtype), [*shape]] if (
                dtype in DTYPES
                and len(shape) <= MOST_AXES
                and all(type(n) is int and n >= 0 for n in shape)
            ):
                end = start + math.prod(shape) * np.dtype(dtype).itemsize
            case _:
                raise FrameError(
                    "an array's description must be a known dtype and a shape"
                )
        if end > len(body):
            raise FrameError("an array is declared larger than the bytes that came")
        try:
            flat = np.frombuffer(body[start:end], dtype if dtype != "|b1" else "|u1")
            # astype copies, and turns any byte into True or False
            arrays.append(flat.astype(dtype).reshape(shape))
        except ValueError:
            # a shape such as (0, 2**63) needs no bytes, but numpy refuses it
            raise FrameError("an array's shape is beyond numpy's") from None
        start = end
    if start != len(body):
        raise FrameError("bytes are left over after the last array")
    return arrays


def _from_tree(tree: Any, arrays: Iterator[tuple[int, np.ndarray]], depth: int) -> Any:
    """Rebuild the value. Each array is used once and in order, so the value is no larger than the frame."""
    if depth == 0:
        raise FrameError(f"nested more than {MOST_DEPTH} deep")
    match tree:
        case None | bool():
            return tree
        case int() if -(1 << 63) <= tree < 1 << 64:
            return tree
        case float() if math.isfinite(tree):
            return tree
        case str() if _is_text(tree):
            return tree
        case list():
            return [_from_tree(item, arrays, depth - 1) for item in tree]
        case {"float": str(name), **rest} if not rest and name in UNUSUAL:
            return UNUSUAL[name]
        case {"tuple": [*items], **rest} if not rest:
            return tuple(_from_tree(item, arrays, depth - 1) for item in items)
        case {"dict": dict(items), **rest} if not rest and all(map(_is_text, items)):
            return {
                key: _from_tree(item, arrays, depth - 1) for key, item in items.items()
            }
        case {"array": int(index), **rest} if not rest and type(index) is int:
            number, array = next(arrays, (None, None))
            if index == number:
                return array
    raise FrameError("the header contains something that is not a value")


def _is_text(value: str) -> bool:
    """Whether the string can be written to a file. JSON can contain a lone surrogate, which UTF-8 cannot encode."""
    return not any("\ud800" <= character <= "\udfff" for character in value)
