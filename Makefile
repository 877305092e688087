# make open, make book, make lab, make check, make test and make test-all each set up .venv if it is missing. They need Python 3.11 or later.
#
#   PYTHON   the interpreter for .venv
#   PIP_OPTIONS   options of every pip install, for instance an extra index with PyTorch's CPU builds
#   PYTEST_OPTIONS, LAB_OPTIONS   options of pytest and of JupyterLab
#   ADDRESS   the address of the book on the web; its notebooks then install the package from there
#   REPOSITORY   the address of the sources; pages then link to them

SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:

PYTHON ?= python3
PIP_OPTIONS ?=
PYTEST_OPTIONS ?=
LAB_OPTIONS ?=
export BOOK_ADDRESS := $(ADDRESS)
export REPOSITORY
# Without the compiled files of the last run, each process of the tests begins some seconds later.
unexport PYTHONDONTWRITEBYTECODE

BIN := .venv/bin
INSTALLED := .venv/.installed
TORCH := $(shell grep '^torch==' requirements.lock)
PROCESSES = $(shell $(BIN)/python -c 'import os; print(os.cpu_count() + 1)')
export define FIRST_STEPS
import gymnasium
import robonav
robot = gymnasium.make("robonav/Navigation-v0")
robot.reset(seed=0)
robot.step(0)
robots = gymnasium.make_vec("robonav/Navigation-v0", 2, vectorization_mode="vector_entry_point")
robots.reset(seed=0)
robots.step([0, 0])
endef
EXTRAS := book,lab,grading,exams,cluster,tests,benchmarks,formats,clients,team,body

.PHONY: help open install book pdf slides check test test-all lab lock clean
help:
	@echo "make open   build the book and open it in the browser"
	@echo "make test   run the checks and the tests, all but those marked exhaustive, in some ten minutes"
	@echo "make test-all run the exhaustive tests too: every experiment again, every page in the dark"
	@echo "make book   build the book into _build/html"
	@echo "make pdf    print the built book to _build/robonav.pdf; needs Chromium"
	@echo "make slides make a deck of slides for each chapter page in _build/slides, from the built book"
	@echo "make check  run lint, types, doctests and quick tests, in at most two minutes"
	@echo "make lab    open JupyterLab on the notebooks"
	@echo "make install set up .venv, which every other command does when it is needed"
	@echo "make lock   write requirements.lock from the newest versions that pyproject.toml allows"
	@echo "make clean  remove everything that was built, except .venv"

# PyTorch comes first, because the resolver may choose another build, which is gigabytes larger.
# The last command compiles the simulator and keeps the result beside its sources, so that nobody waits for it later.
# The editable installation is a path, not an import hook: Python would otherwise take a clone's folder named robonav,
# seen from the folder above it, for the package.
$(INSTALLED): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "robonav needs Python 3.11 or later; set PYTHON=")'
	$(BIN)/python -m pip --version >/dev/null 2>&1 || $(PYTHON) -m venv --clear .venv
	$(BIN)/python -m pip install --quiet $(PIP_OPTIONS) '$(TORCH)'
	$(BIN)/python -m pip install --quiet $(PIP_OPTIONS) -r requirements.lock
	$(BIN)/python -m pip install --quiet --no-deps --editable . --config-settings editable_mode=compat
	$(BIN)/python -c "$$FIRST_STEPS"
	touch $@

install: $(INSTALLED)

open: book
	$(BIN)/python -m webbrowser "file://$(CURDIR)/_build/html/index.html"

# The notebooks' kernels have an IPython profile of their own, so that a user's profile cannot change the book. It leaves
# out a warning of each kernel, that its messages are not encrypted: they do not leave this machine.
book: export IPYTHONDIR := $(CURDIR)/_build/ipython
book: $(INSTALLED)
	@mkdir -p "$$IPYTHONDIR/profile_default"
	@echo 'c.IPKernelApp.log_level = "ERROR"' > "$$IPYTHONDIR/profile_default/ipython_kernel_config.py"
	$(BIN)/python book/_ext/execute_notebooks.py
	$(BIN)/jupyter-book build . -W --keep-going -n --all
	$(BIN)/python book/_ext/check_site.py

pdf: book
	$(BIN)/python book/_ext/print_book.py _build/robonav.pdf

slides: $(INSTALLED)
	test -e _build/html/index.html || $(MAKE) book
	$(BIN)/python book/_ext/make_slides.py

# Lint, types, doctests, and the tests that need no browser, no sandbox and no long run. mypy runs beside the tests.
check: $(INSTALLED)
	@failed=0; report=$$(mktemp); \
	$(BIN)/mypy > "$$report" 2>&1 & types=$$!; \
	$(BIN)/ruff check || failed=1; \
	$(BIN)/ruff format --check || failed=1; \
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n auto --dist worksteal -q --hypothesis-profile quick \
	  -m "not slow and not browser and not sandbox and not exhaustive" \
	  robonav tests/unit tests/book/test_tools.py $(PYTEST_OPTIONS) || failed=1; \
	wait $$types || failed=1; \
	cat "$$report"; rm "$$report"; \
	echo "make check took $$SECONDS seconds"; \
	exit $$failed

# There is one process more than there are cores, because many tests wait for a browser or for a time limit, and each
# process has one thread. It takes its share of the tests in order, and then part of another's, so that tests which share
# a fixture mostly run in the same process. Tests marked long begin before all others. A test that takes longer than ten
# minutes hangs: its process ends, after it has printed where it was, and the test counts as failed.
HANGS := -o faulthandler_timeout=600 -o faulthandler_exit_on_timeout=true
test: WHICH := not exhaustive
test-all: WHICH :=
test test-all: $(INSTALLED)
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	@command -v chromium chromium-browser google-chrome >/dev/null || echo "Chromium is missing: tests in a browser are skipped"
	@command -v bwrap >/dev/null || echo "bubblewrap is missing: tests of the strongest sandbox are skipped"
	@command -v node >/dev/null || echo "Node is missing: tests of the widgets' JavaScript are skipped"
	@test -e _build/html/index.html || echo "The book is not built: tests of its pages are skipped; run make book first"
	OMP_NUM_THREADS=1 $(BIN)/python -m pytest -n $(PROCESSES) --dist worksteal -rs $(HANGS) -m "$(WHICH)" $(PYTEST_OPTIONS)

# The notebooks are copies in plain Markdown, so changes to them change no page of the book.
lab: $(INSTALLED)
	$(BIN)/python book/_ext/notebooks.py _build/lab
	$(BIN)/jupyter lab --notebook-dir=_build/lab $(LAB_OPTIONS)

# The environment is new, so that it contains no package installed by hand. The file has versions only, so that it works
# with every index.
lock:
	rm -rf _build/lock && $(PYTHON) -m venv _build/lock
	_build/lock/bin/python -m pip install --quiet $(PIP_OPTIONS) '$(TORCH)'
	_build/lock/bin/python -m pip install --quiet $(PIP_OPTIONS) '.[$(EXTRAS)]'
	{ sed '/^[^#]/,$$d' requirements.lock; \
	  _build/lock/bin/python -m pip freeze --exclude robonav-book | sed 's/+[a-z0-9.]*$$//'; } > _build/requirements.lock
	mv _build/requirements.lock requirements.lock
	rm -rf _build/lock

clean:
	rm -rf _build
