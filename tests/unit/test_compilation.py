"""Kernels that call kernels of other files are compiled again when those files change."""

import os
import subprocess
import sys
import warnings
from pathlib import Path
from types import ModuleType

import pytest

from robonav.compilation import compiler, warn_without_cache


def add_one(x):
    return x + 1


@pytest.fixture
def cache_key(tmp_path):
    """The key under which a kernel is cached that uses a file with the given text."""

    def key(text):
        file = tmp_path / "used.py"
        file.write_text(text)
        used = ModuleType("used")
        used.__file__ = str(file)
        kernel = compiler(used)(add_one)
        kernel(1)
        codegen = kernel.targetctx.codegen()
        return kernel._cache._index_key(kernel.signatures[0], codegen)

    return key


def test_cache_key_of_a_used_file(cache_key):
    before = cache_key("x = 1")
    assert cache_key("x = 1") == before
    assert cache_key("x = 2") != before


def test_kernel_of_its_own_file():
    assert compiler()(add_one)(2) == 3


@pytest.mark.slow
@pytest.mark.long
def test_no_index_leaves_its_array(tmp_path):
    script = Path(__file__).with_name("compiled_on_random_inputs.py")
    checked = os.environ | {
        "NUMBA_BOUNDSCHECK": "1",
        "NUMBA_CACHE_DIR": str(tmp_path),
    }
    run = subprocess.run(
        [sys.executable, script], env=checked, capture_output=True, text=True
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.split()[-1] == "train"


def test_without_a_folder_for_the_cache_one_warning_names_the_remedy(monkeypatch):
    monkeypatch.setattr("robonav.compilation.FunctionCache.__init__", cannot_cache)
    warn_without_cache.cache_clear()
    with pytest.warns(UserWarning, match="Set NUMBA_CACHE_DIR"):
        assert compiler()(add_one)(2) == 3
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert compiler(signature="i8(i8)")(add_one)(3) == 4


def cannot_cache(self, function):
    raise RuntimeError(f"cannot cache function {function.__name__}: no locator")
