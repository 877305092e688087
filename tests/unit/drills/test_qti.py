"""QTI packages: each answer against the question's own, and whole packages by a checker of somebody else."""

from __future__ import annotations

import io
import re
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest

from robonav.drills import Choice, Number, Order, Place, Table
from robonav.drills.export import Drawn, drawn, qti_zip, selected
from robonav.drills.export.items import Item, items
from robonav.drills.markup import html
from robonav.drills.markup import plain as plain_text
from robonav.drills.rounding import roundings

QTI = "{http://www.imsglobal.org/xsd/imsqti_v2p1}"
CANVAS = "{http://www.imsglobal.org/xsd/ims_qtiasiv1p2}"


@pytest.fixture(scope="module")
def bank() -> list[Drawn]:
    return drawn(selected(), seed=1, each=2)


@pytest.fixture(scope="module")
def made(bank: list[Drawn]) -> dict[str, Item]:
    return {item.name: item for item in items(bank)}


@pytest.fixture(scope="module")
def packages(bank: list[Drawn]) -> dict[str, zipfile.ZipFile]:
    return {
        platform: zipfile.ZipFile(io.BytesIO(qti_zip(bank, "Robots", platform)))
        for platform in ("canvas", "blackboard")
    }


@pytest.fixture(params=["canvas", "blackboard"])
def package(packages: dict[str, zipfile.ZipFile], request) -> zipfile.ZipFile:
    return packages[request.param]


@pytest.fixture(scope="module")
def canvas(packages: dict[str, zipfile.ZipFile]) -> dict[str, ElementTree.Element]:
    root = ElementTree.fromstring(packages["canvas"].read("questions/assessment.xml"))
    return {item.get("ident", ""): item for item in root.iter(f"{CANVAS}item")}


@pytest.fixture(scope="module")
def blackboard(packages: dict[str, zipfile.ZipFile]) -> dict[str, ElementTree.Element]:
    package = packages["blackboard"]
    roots = {
        name.split("/")[1].removesuffix(".xml"): ElementTree.fromstring(
            package.read(name)
        )
        for name in package.namelist()
        if name.endswith(".xml") and name.startswith("questions/")
    }
    del roots["test"]
    return roots


def texts(node: ElementTree.Element, path: str) -> list[str]:
    return ["".join(one.itertext()) for one in node.iterfind(path)]


def plain(content: str) -> str:
    """The letters of HTML."""
    return "".join(ElementTree.fromstring(f"<p>{content}</p>").itertext())


@pytest.mark.slow
def test_there_is_an_item_for_each_answer(bank, made, canvas, blackboard) -> None:
    count = sum(
        len(one.question.asked.rows) * len(one.question.asked.columns)
        if isinstance(one.question.asked, Table)
        else 1
        for one in bank
    )
    assert len(made) == len(canvas) == len(blackboard) == count
    assert set(made) == set(canvas) == set(blackboard)


def test_the_cells_of_a_table_are_asked_for_one_by_one(bank, made) -> None:
    for one in bank:
        if isinstance(one.question.asked, Table):
            right = [float(x) for row in one.question.asked.answer for x in row]
            fields = [
                item.asked for name, item in made.items() if name[:-2] == one.name
            ]
            assert [field.answer for field in fields] == right
            assert all(field.clear for field in fields)


def test_canvas_accepts_what_the_question_accepts(made, canvas) -> None:
    for name, item in made.items():
        node = canvas[name]
        right = node.findall(f".//{CANVAS}setvar/..")
        if isinstance(item.asked, Number):
            low = float(texts(node, f".//{CANVAS}vargte")[0])
            high = float(texts(node, f".//{CANVAS}varlte")[0])
            assert len(right) == 1  # another would count as right, too
            assert item.asked.judge((low + high) / 2).right
            assert high - low == pytest.approx(2 * item.asked.tolerance)
            assert not any(low <= wrong <= high for wrong in item.asked.wrong.values())
            continue
        labels = {
            label.get("ident"): "".join(label.itertext())
            for label in node.iter(f"{CANVAS}response_label")
        }
        chosen = [
            labels[condition.findtext(f".//{CANVAS}varequal") or ""]
            for condition in right
        ]
        if isinstance(item.asked, Order):
            assert chosen == [plain_text(step) for step in item.asked.steps]
        else:
            assert chosen == [html(one.text) for one in item.asked if one.right]


def test_blackboard_accepts_what_the_question_accepts(made, blackboard) -> None:
    for name, item in made.items():
        node = blackboard[name]
        right = texts(node, f"{QTI}responseDeclaration/{QTI}correctResponse/{QTI}value")
        if isinstance(item.asked, Number):
            equal = node.find(f".//{QTI}equal")
            assert equal is not None
            assert item.asked.judge(float(right[0])).right
            below, above = map(float, equal.get("tolerance", "").split())
            assert [below, above] == pytest.approx([item.asked.tolerance] * 2)
            continue
        shown = {
            choice.get("identifier"): "".join(choice.itertext())
            for choice in node.iter(f"{QTI}simpleChoice")
        }
        steps = item.asked.steps if isinstance(item.asked, Order) else None
        wanted = (
            [html(step) for step in steps]
            if steps
            else [html(one.text) for one in item.asked if one.right][:1]
        )
        assert [shown[one] for one in right] == [plain(one) for one in wanted]


def test_an_order_is_not_given_away(made, canvas, blackboard) -> None:
    for name, item in made.items():
        if isinstance(item.asked, Order):
            alphabetical = sorted(item.asked.steps)
            first = canvas[name].find(f".//{CANVAS}render_choice")
            assert first is not None
            assert texts(first, f".//{CANVAS}mattext") == [
                plain_text(step) for step in alphabetical
            ]
            assert texts(blackboard[name], f".//{QTI}simpleChoice") == [
                plain(html(step)) for step in alphabetical
            ]


def test_a_matching_item_of_canvas_shows_no_tags_and_no_signs_of_formulas(
    made, canvas
) -> None:
    orders = [name for name, item in made.items() if isinstance(item.asked, Order)]
    shown = [
        text
        for name in orders
        for text in texts(canvas[name], f".//{CANVAS}response_label//{CANVAS}mattext")
    ]
    assert any("−" in text for text in shown)
    assert not [text for text in shown if re.search(r"[<>$\\`*]", text)]


def test_plain_text_refuses_a_formula_with_commands() -> None:
    with pytest.raises(ValueError, match=r"cannot show the formula \\gamma"):
        plain_text(r"The value is $\gamma$.")


def test_every_item_has_its_explanation_and_hints(made, canvas, blackboard) -> None:
    for name, item in made.items():
        shown = {
            node.get("ident"): "".join(node.itertext())
            for node in canvas[name].iter(f"{CANVAS}itemfeedback")
        }
        assert item.explanation in shown["general_fb"]
        linked = {
            node.get("linkrefid")
            for node in canvas[name].iter(f"{CANVAS}displayfeedback")
        }
        assert linked == set(shown)
        feedback = blackboard[name].findall(f"{QTI}modalFeedback")
        assert len(feedback) >= 2
        if isinstance(item.asked, list) and any(one.hint for one in item.asked):
            assert len(shown) > 1
            assert len(feedback) > 2


def test_decimals_and_roundings_are_said(bank, made, canvas, blackboard) -> None:
    questions = {one.name: one.question for one in bank}
    rounded = 0
    for name, item in made.items():
        question = questions.get(name) or questions[name[:-2]]
        if question.decimals:
            assert f"Give {question.decimals}." in item.text
        if not isinstance(item.asked, Number):
            continue
        for node in (canvas[name], blackboard[name]):
            shown = "".join(node.itertext())
            for number in roundings(item.asked.answer, item.asked.tolerance):
                hint = item.asked.judge(number).hint
                assert html(hint) in shown or plain(html(hint)) in shown
                rounded += "rounded too far" in hint
    assert rounded > 50


def test_blocks_do_not_stand_in_paragraphs(blackboard) -> None:
    """The schema of QTI 2.1 forbids it."""
    for node in blackboard.values():
        for paragraph in node.iter(f"{QTI}p"):
            inside = {child.tag.removeprefix(QTI) for child in paragraph.iter()}
            assert not inside & {"ol", "ul", "div", "table", "pre"}
            assert len(paragraph.findall(f".//{QTI}p")) == 0


def test_pictures_are_in_the_package(package, bank) -> None:
    pictures = {name for name in package.namelist() if name.endswith(".png")}
    assert len(pictures) >= sum(bool(one.question.picture) for one in bank)
    for name in pictures:
        assert package.read(name).startswith(b"\x89PNG")


def test_blackboard_s_files_follow_a_schema_of_qti_21(bank, packages) -> None:
    etree = pytest.importorskip("lxml.etree")
    schema = etree.RelaxNG(etree.parse(Path(__file__).with_name("qti21.rng")))
    package = packages["blackboard"]
    names = [name for name in package.namelist() if re.search(r"/.*\.xml$", name)]
    assert len(names) > len(bank)
    for name in names:
        schema.assertValid(etree.fromstring(package.read(name)))
    wrong = etree.fromstring(package.read("questions/td-error-1.xml"))
    wrong.append(wrong[0])  # a declaration behind the text
    assert not schema.validate(wrong)


def test_another_checker_finds_nothing(package, tmp_path) -> None:
    checker = pytest.importorskip("qti_package_maker.common.package_integrity")
    path = tmp_path / "bank.zip"
    with zipfile.ZipFile(path, "w") as copy:
        for name in package.namelist():
            copy.writestr(name, package.read(name))
    assert checker.check_package(str(path)) == []


NAMED = {"ident", "title", "respident", "linkrefid", "identifier", "outcomeIdentifier"}
NAMED |= {"responseIdentifier", "minvalue", "maxvalue", "tolerance"}


def shape(item: ElementTree.Element, *, without: set[str]) -> set[str]:
    """What an item is made of: elements in elements, and attributes with those values that are not its own."""
    found = set()
    places = [item]
    while places:
        place = places.pop()
        tag = place.tag.split("}")[-1]
        for name, value in place.attrib.items():
            if "}" not in name:
                found.add(f"{tag} {name}" + ("" if name in NAMED else f"={value}"))
        for part in place:
            inner = part.tag.split("}")[-1]
            if inner not in without:
                found.add(f"{tag} > {inner}")
                places.append(part)
    return found


def by_another_writer(item: Item) -> ElementTree.Element:
    """A question of this kind as qti-package-maker writes it for Canvas. It accepts ASCII only."""
    types = pytest.importorskip("qti_package_maker.assessment_items.item_types")
    writer = pytest.importorskip("qti_package_maker.engines.canvas_qti_v1_2.write_item")
    if isinstance(item.asked, Number):
        other = types.NUM(item.name, item.asked.answer, item.asked.tolerance)
    elif isinstance(item.asked, Order):
        numbers = [str(k + 1) for k in range(len(item.asked.steps))]
        other = types.MATCH(item.name, numbers, [f"step {k}" for k in numbers])
    else:
        options = [f"option {k}" for k in range(len(item.asked))]
        other = types.MC(item.name, options, options[0])
    other.item_number = 1
    return getattr(writer, other.item_type)(other)


def test_another_writer_makes_canvas_s_items_of_the_same_parts(made, canvas) -> None:
    """Apart from feedback, which it does not write. What it adds to ours has no meaning for the answer."""
    feedback = {"itemfeedback", "displayfeedback", "other"}
    kinds = set()
    for name, item in made.items():
        other = by_another_writer(item)
        ours = shape(canvas[name], without=feedback)
        theirs = shape(other, without=set())
        assert ours - theirs <= {
            "mattext texttype=text/html",
            "mattext texttype=text/plain",  # in matching items
            "respcondition continue=Yes",  # of feedback
            "respcondition continue=No",
            "response_lid rcardinality=Single",
        }
        assert {part for part in theirs - ours if ">" in part} == set()
        entries = [
            [entry.text for entry in root.iter() if entry.tag.endswith("fieldentry")]
            for root in (canvas[name], other)
        ]
        assert entries[0][0] == entries[1][0]  # the type of the question
        kinds.add(entries[0][0])
        if isinstance(item.asked, Number):
            limits = [
                [
                    float(limit.text or "nan")
                    for limit in root.iter()
                    if limit.tag.endswith(("varequal", "vargte", "varlte"))
                ]
                for root in (canvas[name], other)
            ]
            assert limits[0] == pytest.approx(limits[1], rel=1e-6, abs=1e-6)
    assert len(kinds) == 3


def test_same_seed_same_file() -> None:
    chosen = selected(pages=["dynamic-programming"])
    assert qti_zip(drawn(chosen, 5)) == qti_zip(drawn(chosen, 5))
    assert qti_zip(drawn(chosen, 5)) != qti_zip(drawn(chosen, 6))


def test_a_platform_is_known_or_refused() -> None:
    with pytest.raises(ValueError, match="platform must be one of canvas, blackboard"):
        qti_zip(drawn(selected(drills=["td-error"])), platform="sakai")


def test_kinds_of_answers_all_occur(bank) -> None:
    kinds = {type(one.question.asked) for one in bank}
    assert kinds == {Number, Choice, Place, Order, Table}
