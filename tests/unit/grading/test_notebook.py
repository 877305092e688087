"""Definitions are taken from a notebook; nothing else of it runs."""

import ast
import json

import pytest

from robonav.grading.notebook import broken, definitions


def names(*cells):
    """The names that the definitions of these code cells leave behind when they are run."""
    notebook = {"cells": [{"cell_type": "code", "source": cell} for cell in cells]}
    space = {}
    exec(compile(definitions(json.dumps(notebook).encode()), "notebook", "exec"), space)
    return {name: value for name, value in space.items() if not name.startswith("__")}


def test_functions_classes_imports_and_constants_are_taken():
    found = names(
        "import math as m\nfrom math import pi",
        "RATE = 0.5\nSIZES: tuple = (1, -2)",
        "def f(x):\n    return m.sqrt(x) * RATE",
    )
    assert found["f"](16) == 2
    assert found["SIZES"] == (1, -2)
    assert set(found) == {"m", "pi", "RATE", "SIZES", "f"}


def test_nothing_else_runs():
    assert (
        names(
            "x = 1 / 0",
            "raise SystemExit",
            "print('here')",
            "while True: pass",
            "y = open('/etc/passwd')",
            "x, y = 1, 2",
        )
        == {}
    )


def test_magics_and_cells_that_do_not_parse_do_no_harm():
    found = names(
        "%matplotlib inline\n!ls\ndef f(): return 1",
        "%%bash\ndef g(): pass",
        "def broken(",
        "def h():\n    return 7 \\\n    % 4",
    )
    assert found["f"]() == 1
    assert found["h"]() == 3
    assert set(found) == {"f", "h"}


def test_a_cell_that_is_timed_is_python_still():
    assert set(
        names("%%time\ndef f(): return 1", "%%capture out\n%precision 3\ng = lambda: 2")
    ) == {"f", "g"}


def test_a_definition_that_does_not_parse_is_told_from_none():
    cells = [
        "%matplotlib inline\nimport math",
        "x = (",
        "def improve(q):\n    return q.argmax(axis=1",
        "def f(): pass",
    ]
    notebook = json.dumps(
        {"cells": [{"cell_type": "code", "source": cell} for cell in cells]}
    ).encode()
    assert (
        str(broken(notebook, "improve"))
        == "'(' was never closed in line 2 of the cell that defines improve"
    )
    assert (
        broken(notebook, "impro")
        is broken(notebook, "f")
        is broken(notebook, "x")
        is None
    )


def test_a_missing_library_is_passed_over():
    assert set(names("import no_such_library\nimport math", "def f(): return 1")) == {
        "math",
        "f",
    }


def test_the_last_definition_counts():
    assert names("def f(): return 1", "def f(): return 2")["f"]() == 2


def test_lists_of_lines_are_a_source_too():
    notebook = {
        "cells": [
            {"cell_type": "code", "source": ["def f():\n", "    return 1"]},
            {"cell_type": "markdown", "source": "def g"},
        ]
    }
    assert [
        node.name
        for node in definitions(json.dumps(notebook).encode()).body
        if isinstance(node, ast.FunctionDef)
    ] == ["f"]


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
        definitions(content)
