"""Moodle XML, read back by a parser of somebody else and by Moodle's own expressions for embedded answers."""

from __future__ import annotations

import base64
import html as entities
import re
from xml.etree import ElementTree

import pytest

from robonav.drills import DRILLS, Choice, Number, Order, Place, Table
from robonav.drills.export import Drawn, drawn, moodle_xml, selected
from robonav.drills.markup import html

TYPES = {
    Number: "numerical",
    Choice: "multichoice",
    Place: "multichoice",
    Order: "ordering",
    Table: "cloze",
}
# As in question/type/multianswer/questiontype.php of Moodle.
NUMBER = r"-?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:[eE][-+]?[0-9]+)?"
ANSWER = (
    r"(?:=|%-?[0-9]+%)?.+?(?<!\\)(?<!&)(?<!&amp;)(?=[~#}]|$)(?:#.*?(?<!\\)(?=[~}]|$))?"
)
FIELD = re.compile(rf"\{{([0-9]*):(?:NUMERICAL|NM):({ANSWER}(?:~{ANSWER})*)\}}")


@pytest.fixture(scope="module")
def bank() -> list[Drawn]:
    return drawn(selected(), seed=1, each=2)


@pytest.fixture(scope="module")
def nodes(bank: list[Drawn]) -> list[ElementTree.Element]:
    quiz = ElementTree.fromstring(moodle_xml(bank))
    return [node for node in quiz if node.get("type") != "category"]


def text(node: ElementTree.Element, path: str) -> str:
    return (node.findtext(f"{path}/text") or "").strip()


@pytest.mark.slow
def test_every_question_is_there_with_its_type(bank, nodes) -> None:
    assert [node.get("type") for node in nodes] == [
        TYPES[type(one.question.asked)] for one in bank
    ]
    assert len({text(node, "name") for node in nodes}) == len(nodes)
    assert all(text(node, "generalfeedback") for node in nodes)


def test_numbers_have_their_tolerance_and_hints(bank, nodes) -> None:
    for one, node in zip(bank, nodes, strict=True):
        asked = one.question.asked
        if not isinstance(asked, Number):
            continue
        answers = node.findall("answer")
        right = [answer for answer in answers if answer.get("fraction") == "100"]
        assert [float(text(answer, ".")) for answer in right] == pytest.approx(
            [asked.answer]
        )
        usual = 1 + len(asked.wrong)
        allowed = [float(answer.findtext("tolerance") or 0) for answer in answers]
        assert allowed[:usual] == pytest.approx([asked.tolerance] * usual)
        assert allowed[usual:] == [0] * (len(answers) - usual)
        for answer in answers[1:]:
            hint = asked.judge(float(text(answer, "."))).hint
            assert html(hint) == text(answer, "feedback")
        for answer in answers[usual:]:
            assert "rounded too far" in text(answer, "feedback")


def test_the_decimals_that_count_are_said_in_every_question(bank, nodes) -> None:
    said = 0
    for one, node in zip(bank, nodes, strict=True):
        said += bool(one.question.decimals)
        asked = text(node, "questiontext")
        assert (f"Give {one.question.decimals}." in asked) == bool(
            one.question.decimals
        )
    assert said > 50


def test_choices_mark_what_is_right(bank, nodes) -> None:
    for one, node in zip(bank, nodes, strict=True):
        asked = one.question.asked
        if isinstance(asked, Choice | Place):
            marked = [answer.get("fraction") for answer in node.findall("answer")]
            shown = asked.options if isinstance(asked, Choice) else asked.places
            assert marked == [
                "100" if asked.judge(option).right else "0" for option in shown
            ]


def test_tables_as_moodle_reads_them(bank, nodes) -> None:
    for one, node in zip(bank, nodes, strict=True):
        asked = one.question.asked
        if not isinstance(asked, Table):
            continue
        fields = FIELD.findall(text(node, "questiontext"))
        right = [number for row in asked.answer for number in row]
        assert len(fields) == len(right)
        for (weight, answers), number in zip(fields, right, strict=True):
            first, *others = answers.split("~")
            assert weight == "1"
            value, tolerance = first.removeprefix("=").split(":")
            assert float(value) == pytest.approx(float(number), abs=1e-8)
            assert float(tolerance) == pytest.approx(asked.tolerance)
            for other in others:
                found = re.fullmatch(rf"%0%({NUMBER}):({NUMBER})#(.*)", other)
                assert found
                assert abs(float(found[1]) - number) > asked.tolerance
                assert re.search(r"[.?]$", entities.unescape(found[3]))


def test_orders_are_complete(bank, nodes) -> None:
    for one, node in zip(bank, nodes, strict=True):
        if isinstance(one.question.asked, Order):
            steps = [answer.get("fraction") for answer in node.findall("answer")]
            assert steps == [str(k + 1) for k in range(len(one.question.asked.steps))]


def test_pictures_are_in_the_file(bank, nodes) -> None:
    for one, node in zip(bank, nodes, strict=True):
        files = node.findall("questiontext/file")
        assert len(files) == bool(one.question.picture)
        for file in files:
            assert base64.b64decode(file.text or "").startswith(b"\x89PNG")
            assert f'src="@@PLUGINFILE@@/{file.get("name")}"' in text(
                node, "questiontext"
            )


def test_another_parser_finds_the_same(bank) -> None:
    parser = pytest.importorskip("moodle_xml_parser.parser")
    found = parser.parse_string(moodle_xml(bank))
    kinds = [TYPES[type(one.question.asked)] for one in bank]
    assert len(found["multichoice"]) == kinds.count("multichoice")
    assert len(found["cloze"]) == kinds.count("cloze")
    tables = [one for one in bank if isinstance(one.question.asked, Table)]
    for one, question in zip(tables, found["cloze"], strict=True):
        right = [
            float(option.answer.split(":")[0])
            for gap in question.gaps
            if gap.sub_type == "NUMERICAL"  # formulas have braces, too
            for option in gap.options
            if option.score == 100
        ]
        expected = [float(x) for row in one.question.asked.answer for x in row]
        assert right == pytest.approx(expected, abs=1e-8)


def test_categories_are_the_pages_of_the_book() -> None:
    quiz = ElementTree.fromstring(moodle_xml(drawn(selected(chapters=[5])), "Robots"))
    names = [
        text(node, "category") for node in quiz.findall("question[@type='category']")
    ]
    pages = dict.fromkeys(drill.page for drill in selected(chapters=[5]))
    assert names == [f"$course$/top/Robots/Chapter 5/{page}" for page in pages]
    assert set(pages) < {drill.page for drill in DRILLS.values()}
