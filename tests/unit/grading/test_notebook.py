"""What a function needs is taken from a notebook; nothing else of it runs."""

import json

import pytest

from robonav.grading.notebook import (
    broken,
    defines,
    definitions,
    parsed,
    sources,
    written_files,
)


def names(*cells, name="f"):
    """The names that the definition of ``f`` in these code cells, and all that it needs, leave behind."""
    space = {}
    exec(compile(definitions(cells, name), "notebook", "exec"), space)
    return {name: value for name, value in space.items() if not name.startswith("__")}


def test_functions_classes_imports_and_constants_are_taken():
    found = names(
        "import math as m\nfrom math import pi",
        "RATE = 0.5\nSIZES: tuple = (1, -2)",
        "class C: size = SIZES[0]",
        "def g(x): return C.size * x",
        "def f(x):\n    return m.sqrt(x) * RATE * g(1)",
    )
    assert found["f"](16) == 2
    assert set(found) == {"m", "RATE", "SIZES", "C", "g", "f"}


NEEDED = {
    "a power": ("X = 10**-2", 0.01),
    "several at once": ("X, Y = 1, 2", 1),
    "a number of numpy": ("import numpy as np\nX = np.inf", float("inf")),
    "an array": ("import numpy as np\nX = np.array(0.0)", 0),
    "a chain": ("A = 2\nB = A * 3\nX = B + A", 8),
    "a table filled in a loop": ("X = {}\nfor n in range(3):\n    X[n] = n * n", {0: 0, 1: 1, 2: 4}),
    "a list filled by a method": ("X = []\nX.append(3)", [3]),
    "an if": ("if 1 > 0:\n    X = 1\nelse:\n    X = 2", 1),
    "a try": ("try:\n    import no_such_library as X\nexcept ImportError:\n    X = 5", 5),
    "a function's result": ("def double(x): return 2 * x\nX = double(4)", 8),
    "changed later": ("X = 1\nX += 2", 3),
    "a call that fails": ("X = [1]\nX.remove(2)", [1]),
    "a shell line": ("X = !ls", None),
    "a magic": ("X = %timeit -o 1", None),
    "beside a timed statement": ("%time X = 4", 4),
}  # fmt: skip


@pytest.mark.parametrize("shape", NEEDED)
def test_a_value_that_the_function_uses_is_computed(shape):
    cell, value = NEEDED[shape]
    assert names("def f(): return X", cell, "1 / 0")["f"]() == value


def test_nothing_else_runs():
    assert set(
        names(
            "x = 1 / 0",
            "raise SystemExit",
            "print('here')",
            "while True: pass",
            "y = open('/etc/passwd')",
            "x, y = 1, 2",
            "import numpy as np\nnp.testing.assert_equal(1, 2)",
            "def f(x):\n    y = np.array(x)\n    return y",
            "f(1).sum()",
        )
    ) == {"np", "f"}


LINES = {
    "magics and shell lines": "%matplotlib inline\n!ls\ndef f(): return 1",
    "a question": "def f(): return 1\nf?\n?f\nf??",
    "a time": "%%time\ndef f(): return 1",
    "a capture with a magic in it": "%%capture out\n%precision 3\nf = lambda: 1",
    "a magic in the function": "def f():\n    %time x = 1\n    !ls\n    return x",
    "a shell line's value": "files = !ls\nout = %timeit -o 1\ndef f(): return 1",
    "prompts": ">>> def f():\n...     return 1",
    "an if": "if True:\n    def f(): return 1",
    "a try": "try:\n    def f(): return 1\nexcept ValueError:\n    pass",
    "the future": "import math\nfrom __future__ import annotations\ndef f(x: Unknown = 0): return 1",
    "the line that was handed out, below": (
        "def f():\n    return 1\n    raise NotImplementedError('f is yours to write')"
    ),
    "and above": "def f():\n    raise NotImplementedError('f is yours to write')\n    return 1",
    "and in a comment": "def f():\n    # raise NotImplementedError('f is yours to write')\n    return 1",
    "the function that was handed out, below": (
        "def f(): return 1\ndef f():\n    'Doc.'\n    raise NotImplementedError('f is yours to write')"
    ),
}  # fmt: skip


@pytest.mark.parametrize("shape", LINES)
def test_a_cell_is_read_as_ipython_reads_it(shape):
    assert names("def broken(", "%%bash\ndef f(): return 2", LINES[shape])["f"]() == 1


def test_a_function_as_handed_out_is_no_definition():
    stub = "def f():\n    'Doc.'\n    raise NotImplementedError('f is yours to write')"
    assert names(stub) == {}


def test_a_continued_line_is_no_magic():
    assert names("def f():\n    return 7 \\\n    % 4")["f"]() == 3


def test_a_file_that_a_cell_writes_is_found():
    cells = ["%%writefile a.py\nx = 1\n", "%%file -a 'b c.py'\ny", "%%time\nz"]
    assert list(written_files(cells)) == [
        ("a.py", "x = 1\n", False),
        ("b c.py", "y", True),
    ]


def test_a_definition_that_does_not_parse_is_told_from_none():
    cells = [
        "%matplotlib inline\nimport math",
        "x = (",
        "def improve(q):\n    return q.argmax(axis=1",
        "def f(): pass",
    ]
    assert (
        str(broken(cells, "improve"))
        == "'(' was never closed in line 2 of the cell that defines improve"
    )
    assert broken(cells, "impro") is broken(cells, "f") is broken(cells, "x") is None


def test_a_missing_library_is_passed_over():
    cells = "import no_such_library, math", "def f(): return no_such_library"
    assert set(names(*cells)) == {"f"}


def test_the_last_definition_counts():
    assert names("def f(): return 1", "def f(): return 2")["f"]() == 2


FORMATS = {
    "4": {
        "cells": [
            {"cell_type": "code", "source": ["def f():\n", "    return 1"]},
            {"cell_type": "markdown", "source": "def g"},
        ]
    },
    "3": {
        "nbformat": 3,
        "worksheets": [
            {"cells": [{"cell_type": "code", "input": "def f():\n    return 1"}]}
        ],
    },
}


@pytest.mark.parametrize("number", FORMATS)
def test_the_cells_of_each_format_are_found(number):
    (source,) = sources(json.dumps(FORMATS[number]).encode())
    assert source == "def f():\n    return 1"
    assert [defines(node, "f") for node in parsed(source)] == [True]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{}",
        b"[]",
        b'{"cells": 3}',
        b'{"cells": [{"cell_type": "code"}]}',
        b"[" * 100_000,
        b"\xff",
    ],
)
def test_what_is_no_notebook_is_named(content):
    with pytest.raises(ValueError, match="not a notebook"):
        sources(content)
