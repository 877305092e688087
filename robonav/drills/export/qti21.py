"""Items and tests in QTI 2.1, as Blackboard and others read it."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from ..markup import html
from ..question import Number, Order
from .answers import Option, number_text
from .elements import Element, child
from .items import Item

NAMESPACE = "http://www.imsglobal.org/xsd/imsqti_v2p1"
RESPONSE = "RESPONSE"


def assessment_test(files: Sequence[str], title: str) -> Element:
    """Return a test of items.

    Parameters
    ----------
    files : sequence of str
        The names of the items' files, beside the test's.
    title : str

    Returns
    -------
    Element

    Examples
    --------
    >>> [node.get("href") for node in assessment_test(["a.xml"], "Robots").iter("assessmentItemRef")]
    ['a.xml']
    """
    root = ElementTree.Element(
        "assessmentTest", xmlns=NAMESPACE, identifier="test", title=title
    )
    part = child(
        root,
        "testPart",
        identifier="part",
        navigationMode="nonlinear",
        submissionMode="simultaneous",
    )
    section = child(
        part, "assessmentSection", identifier="section", title=title, visible="true"
    )
    for file in files:
        name = file.removesuffix(".xml")
        child(section, "assessmentItemRef", identifier=name, href=file)
    return root


def assessment_item(item: Item) -> Element:
    """Return one item.

    Parameters
    ----------
    item : Item

    Returns
    -------
    Element

    Examples
    --------
    >>> from robonav.drills.export import drawn, selected
    >>> from robonav.drills.export.items import items
    >>> root = assessment_item(items(drawn(selected(drills=["td-error"])))[0])
    >>> root.find("responseDeclaration").get("baseType")
    'float'
    """
    root = ElementTree.Element(
        "assessmentItem",
        xmlns=NAMESPACE,
        identifier=item.name,
        title=item.title,
        adaptive="false",
        timeDependent="false",
    )
    asked = item.asked
    if isinstance(asked, Number):
        kind, cardinality, correct = "float", "single", [number_text(asked.answer)]
    elif isinstance(asked, Order):
        shown = sorted(asked.steps)
        kind, cardinality = "identifier", "ordered"
        correct = [_ident(shown.index(step)) for step in asked.steps]
    else:
        kind, cardinality = "identifier", "single"
        correct = [_ident(k) for k, option in enumerate(asked) if option.right]
    _declarations(root, item, kind, cardinality, correct)
    _body(root, item)
    _processing(root, asked, correct)
    _feedback(root, item)
    return root


def _html(node: Element, tag: str, text: str) -> None:
    """Add an element with HTML in it."""
    node.append(ElementTree.fromstring(f"<{tag}>{text}</{tag}>"))


def _ident(place: int) -> str:
    return f"answer_{place + 1}"


def _declarations(
    root: Element, item: Item, kind: str, cardinality: str, correct: Sequence[str]
) -> None:
    response = child(
        root,
        "responseDeclaration",
        identifier=RESPONSE,
        cardinality=cardinality,
        baseType=kind,
    )
    right = child(response, "correctResponse")
    for value in correct if cardinality == "ordered" else correct[:1]:
        child(right, "value", value)
    for name, default in (("SCORE", "0"), ("MAXSCORE", str(item.points))):
        outcome = child(
            root,
            "outcomeDeclaration",
            identifier=name,
            cardinality="single",
            baseType="float",
        )
        child(child(outcome, "defaultValue"), "value", default)
    for name in ("FEEDBACKBASIC", "FEEDBACK"):
        child(
            root,
            "outcomeDeclaration",
            identifier=name,
            cardinality="single",
            baseType="identifier",
        )


def _body(root: Element, item: Item) -> None:
    body, asked = child(root, "itemBody"), item.asked
    _html(body, "div", item.text)
    if isinstance(asked, Number):
        paragraph = child(body, "p")
        child(paragraph, "textEntryInteraction", responseIdentifier=RESPONSE)
        return
    if isinstance(asked, Order):
        kind, texts = "orderInteraction", sorted(asked.steps)
    else:
        kind, texts = "choiceInteraction", [option.text for option in asked]
    choices = child(body, kind, responseIdentifier=RESPONSE, shuffle="true")
    if kind == "choiceInteraction":
        choices.set("maxChoices", "1")
    for place, text in enumerate(texts):
        choice = child(choices, "simpleChoice", identifier=_ident(place))
        _html(choice, "p", html(text))


def _condition(asked: Number | list[Option] | Order, correct: Sequence[str]) -> Element:
    """When an answer is right."""
    if isinstance(asked, Number):
        tolerance = number_text(asked.tolerance)
        equal = ElementTree.Element(
            "equal", toleranceMode="absolute", tolerance=f"{tolerance} {tolerance}"
        )
        child(equal, "variable", identifier=RESPONSE)
        child(equal, "correct", identifier=RESPONSE)
        return equal
    if isinstance(asked, Order) or len(correct) == 1:
        match = ElementTree.Element("match")
        child(match, "variable", identifier=RESPONSE)
        child(match, "correct", identifier=RESPONSE)
        return match
    either = ElementTree.Element("or")
    for value in correct:
        match = child(either, "match")
        child(match, "variable", identifier=RESPONSE)
        child(match, "baseValue", value, baseType="identifier")
    return either


def _processing(
    root: Element, asked: Number | list[Option] | Order, correct: Sequence[str]
) -> None:
    processing = child(root, "responseProcessing")
    condition = child(processing, "responseCondition")
    right = child(condition, "responseIf")
    right.append(_condition(asked, correct))
    score = child(right, "setOutcomeValue", identifier="SCORE")
    child(score, "variable", identifier="MAXSCORE")
    for node, value in (
        (right, "correct"),
        (child(condition, "responseElse"), "incorrect"),
    ):
        outcome = child(node, "setOutcomeValue", identifier="FEEDBACKBASIC")
        child(outcome, "baseValue", value, baseType="identifier")
    if isinstance(asked, list):
        outcome = child(processing, "setOutcomeValue", identifier="FEEDBACK")
        child(outcome, "variable", identifier=RESPONSE)


def _feedback(root: Element, item: Item) -> None:
    """The explanation for everybody, and the hints for those who were wrong."""
    texts = [
        ("FEEDBACKBASIC", "correct", item.explanation),
        ("FEEDBACKBASIC", "incorrect", item.mistakes + item.explanation),
    ]
    if isinstance(item.asked, list):
        texts += [
            ("FEEDBACK", _ident(place), f"<p>{html(option.hint)}</p>")
            for place, option in enumerate(item.asked)
            if option.hint
        ]
    for outcome, ident, text in texts:
        feedback = child(
            root,
            "modalFeedback",
            outcomeIdentifier=outcome,
            identifier=ident,
            showHide="show",
        )
        _html(feedback, "div", text)
