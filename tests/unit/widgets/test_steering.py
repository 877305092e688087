"""Keys and gamepads as the page reads them."""

from __future__ import annotations

AHEAD, LEFT_30, LEFT_60, RIGHT_30, RIGHT_60, BACK = range(6)
KEYS = [
    ("ArrowUp", False, AHEAD),
    ("ArrowLeft", False, LEFT_30),
    ("ArrowLeft", True, LEFT_60),
    ("ArrowRight", False, RIGHT_30),
    ("ArrowRight", True, RIGHT_60),
    ("ArrowDown", True, BACK),
    ("a", False, None),
]
PADS = [
    ([0, 0], [], None),
    ([0.2, -0.3], [], None),  # a stick that hangs a little
    ([0, -1], [], AHEAD),
    ([0.2, -0.97], [], AHEAD),
    ([0.7, -0.7], [], RIGHT_30),
    ([-0.7, -0.7], [], LEFT_30),
    ([1, 0], [], RIGHT_60),
    ([-1, 0.1], [], LEFT_60),
    ([0.1, 1], [], BACK),
    ([0, 0], [12], AHEAD),
    ([0, 0], [13], BACK),
    ([0, 0], [14], LEFT_30),
    ([0, 0], [15], RIGHT_30),
    ([0, 0], [4], LEFT_60),
    ([0, 0], [5, 15], RIGHT_60),
    ([], [], None),
]


def test_keys(node):
    events = [{"key": key, "shiftKey": shift} for key, shift, _ in KEYS]
    got = node("steering", "return data.map(page.keyAction);", events)
    assert got == [action for *_, action in KEYS]


def test_gamepads(node):
    pads = [
        {"axes": axes, "buttons": [{"pressed": k in pressed} for k in range(16)]}
        for axes, pressed, _ in PADS
    ]
    got = node("steering", "return data.map(page.padAction);", pads)
    assert got == [action for *_, action in PADS]


def test_names_are_those_of_the_actions(node):
    names = node("steering", "return [0, 1, 2, 3, 4, 5].map(page.actionName);", None)
    assert names == ["ahead", "left 30°", "left 60°", "right 30°", "right 60°", "back"]
