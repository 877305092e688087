"""Execute those notebooks of the book that are not in the cache yet, as many at a time as there are cores.

This runs before a build, which then finds them executed. Sphinx alone would execute them one after the other. A
notebook that fails here is executed again by the build, which reports the error.
"""

from __future__ import annotations

import os

from jupyter_cache import get_cache
from jupyter_cache.executors import load_executor
from notebooks import notebook_pages
from package_digest import prepared_cache

LONGEST = 120  # seconds a cell may take, as in _config.yml


def main() -> None:
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # other notebooks use the other cores
    cache = get_cache(str(prepared_cache()))
    pages = [str(page) for page in notebook_pages()]
    for page in pages:
        cache.add_nb_to_project(
            page, read_data={"name": "myst_nb_md", "type": "plugin"}
        )
    done = load_executor("local-parallel", cache).run_and_cache(
        filter_uris=pages, timeout=LONGEST
    )
    print(
        f"{len(pages)} notebooks, {len(done.succeeded)} executed now, {len(done.excepted) + len(done.errored)} failed"
    )


if __name__ == "__main__":
    main()
