"""How long ``make slides`` takes after ``make book``: a deck of slides for each lecture.

python benchmarks/slides.py
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LIMIT = 180  # seconds


def main() -> None:
    argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    ).parse_args()
    if not (ROOT / "_build/html/index.html").is_file():
        raise SystemExit("The book is not built: run `make book` first.")
    with tempfile.TemporaryDirectory() as folder:
        began = time.perf_counter()
        subprocess.run(
            [sys.executable, str(ROOT / "book/_ext/make_slides.py")],
            env=os.environ | {"BOOK_SLIDES": folder},
            stdout=subprocess.DEVNULL,
            check=True,
        )
        seconds = time.perf_counter() - began
        decks = len(list(Path(folder).glob("*.html"))) - 1  # without the list of decks
    print(f"{decks} decks: {seconds:.1f} s (limit {LIMIT} s)")
    if seconds > LIMIT:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
