"""Whether others read the question banks: Canvas's own importer, and the published schemas of QTI 1.2.1 and 2.1.

Canvas turns QTI 1.2 into QTI 2.1 with the QTI Migration Tool, and reads answers from what that writes. This script
does the first with the tool itself and the second by the same rules, and compares each answer with the drill's own.
Get both programs first:

    git clone https://github.com/instructure/QTIMigrationTool
    git clone https://github.com/oat-sa/qti-sdk
    python benchmarks/question_banks.py --importer QTIMigrationTool --schemas qti-sdk
"""

from __future__ import annotations

import argparse
import io
import re
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

from lxml import etree

from robonav.drills import Number, Order
from robonav.drills.export import drawn, qti_zip, selected
from robonav.drills.export.items import Item, items
from robonav.drills.markup import html, plain

QTI = "{http://www.imsglobal.org/xsd/imsqti_v2p1}"
SCHEMAS = "src/qtism/data/storage/xml/schemes"
Node = etree._Element


def text(node: Node) -> str:
    return "".join(node.itertext()).strip()


def number_as_canvas_reads_it(root: Node) -> tuple[float, float]:
    """The exact answer, and how far an answer may be off: the upper limit less the exact answer."""
    either = next(root.iter(f"{QTI}or"))
    exact = next(either.iter(f"{QTI}stringMatch")).find(f"{QTI}baseValue")
    upper = either.find(f".//{QTI}customOperator[@class='varlte']/{QTI}baseValue")
    assert exact is not None
    assert upper is not None
    return float(text(exact)), float(text(upper)) - float(text(exact))


def answers_that_score(root: Node) -> Iterator[tuple[str, str]]:
    """Which choice counts in which field."""
    for condition in root.iter(f"{QTI}responseIf", f"{QTI}responseElseIf"):
        match = condition.find(f"{QTI}match")
        scores = condition.find(f"{QTI}setOutcomeValue[@identifier='SCORE']")
        if match is not None and scores is not None:
            field, choice = match
            yield field.get("identifier", ""), text(choice)


def choice_as_canvas_reads_it(root: Node) -> list[str]:
    shown = {
        one.get("identifier"): text(one) for one in root.iter(f"{QTI}simpleChoice")
    }
    return [shown[choice] for _, choice in answers_that_score(root)]


def order_as_canvas_reads_it(root: Node) -> list[str]:
    right = dict(answers_that_score(root))
    steps = []
    for field in root.iter(f"{QTI}choiceInteraction"):
        wanted = right[field.get("responseIdentifier", "")]
        steps += [
            text(one)
            for one in field.iter(f"{QTI}simpleChoice")
            if one.get("identifier") == wanted
        ]
    return steps


def is_read_right(item: Item, root: Node) -> bool:
    asked = item.asked
    if isinstance(asked, Number):
        exact, margin = number_as_canvas_reads_it(root)
        near = asked.judge(exact).right and abs(exact - asked.answer) < 1e-5
        return near and abs(margin - asked.tolerance) < 1e-5
    if isinstance(asked, Order):
        return order_as_canvas_reads_it(root) == [plain(step) for step in asked.steps]
    right = [html(option.text) for option in asked if option.right]
    return choice_as_canvas_reads_it(root) == right


def imported(package: Path, importer: Path) -> dict[str, Node]:
    """The items that Canvas's importer writes."""
    target = package.with_name("imported")
    options = ["--ucvars", "--nogui", "--overwrite", f"--cpout={target}"]
    run = subprocess.run(
        [sys.executable, importer / "migrate.py", *options, package],
        capture_output=True,
        text=True,
        check=False,
    )
    if run.returncode:
        raise SystemExit(f"the importer failed:\n{run.stdout}{run.stderr}")
    return {
        path.stem: etree.parse(path).getroot()
        for path in (target / "assessmentItems").glob("*.xml")
    }


def without_namespace(document: bytes) -> etree._Element:
    """A document as the document type definition knows it."""
    return etree.fromstring(re.sub(rb' xmlns="[^"]*"', b"", document))


def valid(name: str, package: zipfile.ZipFile, path: str, check: Callable) -> bool:
    """Print how many of the package's files of this kind follow a schema."""
    names = [one for one in package.namelist() if re.fullmatch(path, one)]
    errors = {one: check(package.read(one)) for one in names}
    wrong = {one: error for one, error in errors.items() if error}
    print(f"{name:46s} {len(names) - len(wrong):5d} of {len(names)} follow it")
    for one, error in list(wrong.items())[:5]:
        print(f"    {one}: {error}")
    return not wrong


def against(schema: etree.DTD | etree.XMLSchema, root: etree._Element) -> str:
    return "" if schema.validate(root) else str(schema.error_log.last_error)


def parsed_schema(path: Path) -> etree.XMLSchema:
    return etree.XMLSchema(etree.parse(path))


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--importer", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--schemas", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--each", type=int, default=5, help="questions of each drill")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    bank = drawn(selected(), seed=arguments.seed, each=arguments.each)
    packages = {
        platform: zipfile.ZipFile(io.BytesIO(qti_zip(bank, platform=platform)))
        for platform in ("canvas", "blackboard")
    }
    schemas = arguments.schemas / SCHEMAS
    dtd = etree.DTD(arguments.importer / "schemas/ims_qtiasiv1p2p1.dtd")
    qti21 = parsed_schema(schemas / "qtiv2p1/imsqti_v2p1.xsd")
    packaging = parsed_schema(schemas / "imscp_v1p1.xsd")
    passed = valid(
        "QTI 1.2.1, for Canvas",
        packages["canvas"],
        r"questions/assessment\.xml",
        lambda content: against(dtd, without_namespace(content)),
    )
    passed &= valid(
        "QTI 2.1, for Blackboard",
        packages["blackboard"],
        r"questions/.*\.xml",
        lambda content: against(qti21, etree.fromstring(content)),
    )
    for platform, package in packages.items():
        passed &= valid(
            f"IMS content packaging, {platform}",
            package,
            r"imsmanifest\.xml",
            lambda content: against(packaging, etree.fromstring(content)),
        )
    with tempfile.TemporaryDirectory() as folder:
        package = Path(folder, "package")
        packages["canvas"].extractall(package)
        read = imported(package, arguments.importer.resolve())
    made = {item.name: item for item in items(bank)}
    right = sum(
        name in read and is_read_right(item, read[name]) for name, item in made.items()
    )
    print(f"{'Answers, read by the importer of Canvas':46s} {right:5d} of {len(made)}")
    if not passed or right < len(made):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
