"""What a public project has around its code: commands that exist, versions that agree, workflows that can be read."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
import yaml
from packaging.version import Version

from robonav import __version__

ROOT = Path(__file__).resolve().parents[2]
TARGETS = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8"), re.M))
WITH_COMMANDS = [
    "README.md",
    "CONTRIBUTING.md",
    "RELEASING.md",
    "Dockerfile",
    ".ci/run",
    ".devcontainer/devcontainer.json",
    ".github/workflows/ci.yml",
    ".github/workflows/pages.yml",
]


@pytest.mark.parametrize("name", WITH_COMMANDS)
def test_every_make_command_exists(name: str) -> None:
    text = (ROOT / name).read_text("utf-8")
    named = set(re.findall(r"(?:^ *|[`\"]|run: |RUN )make ([a-z-]+)", text, re.M))
    named |= set(re.findall(r'"make", "([a-z-]+)"', text))
    assert named or name == "RELEASING.md"
    assert named <= TARGETS


def test_the_two_commands_of_a_newcomer_come_first() -> None:
    commands = re.search(
        r"```\n(.*?)```", (ROOT / "README.md").read_text("utf-8"), re.S
    )
    assert commands
    assert re.findall(r"^make (\w+)", commands[1], re.M) == ["open", "test"]


def test_versions_agree() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    assert project["version"] == citation["version"] == __version__


@pytest.mark.parametrize("path", sorted(ROOT.glob(".github/workflows/*.yml")), ids=str)
def test_workflows_check_out_and_run_what_this_machine_runs(path: Path) -> None:
    jobs = yaml.safe_load(path.read_text("utf-8"))["jobs"]
    for job in jobs.values():
        steps = [step.get("uses", step.get("run", "")) for step in job["steps"]]
        assert steps[0].startswith("actions/checkout@")
        runs = (".ci/run", "make ", "python -m pytest ")
        assert any(step.startswith(runs) for step in steps)


def test_the_container_of_editors_is_the_image() -> None:
    about = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text("utf-8"))
    dockerfile = ROOT / ".devcontainer" / about["build"]["dockerfile"]
    text = dockerfile.read_text("utf-8")
    assert f"USER {about['remoteUser']}" in text
    copied = re.findall(r"^COPY (?:--\S+ )?(\S+) ", text, re.M)
    assert all((ROOT / source).exists() for source in copied)


def test_the_lowest_versions_are_versions_that_exist_for_this_machine() -> None:
    """Each library that the package needs has one lowest version, no newer than the one in use."""
    script = ROOT / ".ci" / "lowest-versions"
    made = subprocess.run([sys.executable, script, "formats"], capture_output=True, text=True, check=True)  # fmt: skip
    lowest = dict(line.split("==") for line in made.stdout.split())
    assert {"numpy", "numba", "torch", "gymnasium", "minari", "onnx"} <= set(lowest)
    for name, version in lowest.items():
        assert Version(metadata.version(name)) >= Version(version), name


def test_workflows_name_extras_that_exist() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"][
        "optional-dependencies"
    ]
    for path in ROOT.glob(".github/workflows/*.yml"):
        for named in re.findall(r'"\.\[([\w,]+)\]"', path.read_text("utf-8")):
            assert set(named.split(",")) <= set(extras)


@pytest.mark.parametrize("page", sorted(ROOT.glob("book/*.md")), ids=lambda p: p.stem)
def test_all_cells_of_a_page_name_the_same_language(page: Path) -> None:
    languages = re.findall(r"^`{3,}\{code-cell\} *(\S*)", page.read_text("utf-8"), re.M)
    assert set(languages) <= {"ipython3"}
