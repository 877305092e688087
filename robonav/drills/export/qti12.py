"""Items in QTI 1.2, as Canvas reads it.

The vocabulary is that of Canvas's own exports. Canvas takes each condition of a numerical item for a right answer, so
hints of wrong numbers stand in the feedback for all wrong answers. In a matching item Canvas shows what is matched as
it is written, tags included, so it is plain text there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from xml.etree import ElementTree

from ..markup import html, plain
from ..question import Number, Order
from .answers import Option, number_text
from .elements import Element, child
from .items import Item

NAMESPACE = "http://www.imsglobal.org/xsd/ims_qtiasiv1p2"
RESPONSE = "response1"
ANY = ""  # a condition that every answer meets
_Writer = Callable[[Item, Element, Element], dict[str, str]]


def assessment(items: Sequence[Item], title: str) -> Element:
    """Return items as one QTI 1.2 assessment.

    Parameters
    ----------
    items : sequence of Item
    title : str

    Returns
    -------
    Element

    Examples
    --------
    >>> from robonav.drills.export import drawn, selected
    >>> from robonav.drills.export.items import items
    >>> root = assessment(items(drawn(selected(drills=["td-error"]))), "Robots")
    >>> [item.get("ident") for item in root.iter("item")]
    ['td-error-1']
    """
    root = ElementTree.Element("questestinterop", xmlns=NAMESPACE)
    test = child(root, "assessment", ident="assessment", title=title)
    section = child(test, "section", ident="root_section")
    section.extend(_item(item) for item in items)
    return root


def _html(node: Element, text: str) -> None:
    _material(node, text, "text/html")


def _material(node: Element, text: str, kind: str) -> None:
    child(child(node, "material"), "mattext", text, texttype=kind)


def _item(item: Item) -> Element:
    node = ElementTree.Element("item", ident=item.name, title=item.title)
    kind, write = _kind(item)
    fields = child(child(node, "itemmetadata"), "qtimetadata")
    for label, entry in (
        ("question_type", kind),
        ("points_possible", str(item.points)),
    ):
        field = child(fields, "qtimetadatafield")
        child(field, "fieldlabel", label)
        child(field, "fieldentry", entry)
    presentation = child(node, "presentation")
    _html(presentation, item.text)
    processing = child(node, "resprocessing")
    outcomes = child(processing, "outcomes")
    child(
        outcomes,
        "decvar",
        maxvalue="100",
        minvalue="0",
        varname="SCORE",
        vartype="Decimal",
    )
    _condition(processing, shows="general_fb")
    feedback = {"general_fb": item.explanation}
    feedback |= write(item, presentation, processing)
    if item.mistakes:
        _condition(processing, shows="general_incorrect_fb")
        feedback["general_incorrect_fb"] = item.mistakes
    for name, text in feedback.items():
        _html(child(child(node, "itemfeedback", ident=name), "flow_mat"), text)
    return node


def _kind(item: Item) -> tuple[str, _Writer]:
    if isinstance(item.asked, Number):
        return "numerical_question", _number
    if isinstance(item.asked, Order):
        return "matching_question", _order
    return "multiple_choice_question", _choice


def _condition(
    processing: Element,
    ident: str = ANY,
    answer: str = ANY,
    *,
    score: str = "",
    adds: bool = False,
    shows: str = "",
) -> Element:
    """A condition on the answer, and what happens if it holds."""
    last = bool(score) and not adds
    condition = child(
        processing, "respcondition", **{"continue": "No" if last else "Yes"}
    )
    variable = child(condition, "conditionvar")
    if ident:
        child(variable, "varequal", answer, respident=ident)
    elif not score:
        child(variable, "other")
    if score:
        child(
            condition,
            "setvar",
            score,
            action="Add" if adds else "Set",
            varname="SCORE",
        )
    if shows:
        child(condition, "displayfeedback", feedbacktype="Response", linkrefid=shows)
    return variable


def _number(item: Item, presentation: Element, processing: Element) -> dict[str, str]:
    asked = item.asked
    assert isinstance(asked, Number)
    response = child(
        presentation, "response_str", ident=RESPONSE, rcardinality="Single"
    )
    field = child(response, "render_fib", fibtype="Decimal")
    child(field, "response_label", ident="answer1")
    either = child(_condition(processing, score="100"), "or")
    child(either, "varequal", number_text(asked.answer), respident=RESPONSE)
    within = child(either, "and")
    low, high = asked.answer - asked.tolerance, asked.answer + asked.tolerance
    child(within, "vargte", number_text(low), respident=RESPONSE)
    child(within, "varlte", number_text(high), respident=RESPONSE)
    return {}


def _labels(response: Element, texts: Sequence[str], kind: str) -> None:
    choices = child(response, "render_choice")
    for number, text in enumerate(texts, start=1):
        label = child(choices, "response_label", ident=_ident(number))
        _material(label, text, kind)


def _ident(number: int) -> str:
    return str(1000 + number)


def _choice(item: Item, presentation: Element, processing: Element) -> dict[str, str]:
    asked = item.asked
    assert isinstance(asked, list)
    response = child(
        presentation, "response_lid", ident=RESPONSE, rcardinality="Single"
    )
    _labels(response, [html(option.text) for option in asked], "text/html")
    feedback = {}
    numbered: list[tuple[str, Option]] = [
        (_ident(k), option) for k, option in enumerate(asked, start=1)
    ]
    for ident, option in numbered:
        if option.hint:
            feedback[f"{ident}_fb"] = f"<p>{html(option.hint)}</p>"
            _condition(processing, RESPONSE, ident, shows=f"{ident}_fb")
    for ident, option in numbered:
        if option.right:
            _condition(processing, RESPONSE, ident, score="100")
    return feedback


def _order(item: Item, presentation: Element, processing: Element) -> dict[str, str]:
    """Canvas has no order in QTI 1.2: each place in the order is matched with its step."""
    asked = item.asked
    assert isinstance(asked, Order)
    shown = sorted(asked.steps)
    for place, step in enumerate(asked.steps, start=1):
        ident = f"response_{place}"
        response = child(presentation, "response_lid", ident=ident)
        _html(response, f"Step {place}")
        _labels(response, [plain(one) for one in shown], "text/plain")
        right = _ident(shown.index(step) + 1)
        part = f"{100 / len(shown):.2f}"
        _condition(processing, ident, right, score=part, adds=True)
    return {}
