"""QTI packages: a zip of XML files and pictures with a manifest, as learning platforms import them."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping, Sequence
from xml.etree import ElementTree

from . import qti12, qti21
from .elements import Element, child
from .items import Item, items
from .selection import Drawn

PLATFORMS = ("canvas", "blackboard")
FOLDER = "questions"
START_OF_ZIP = (1980, 1, 1, 0, 0, 0)  # the same questions make the same file
NAMESPACE = "http://www.imsglobal.org/xsd/imscp_v1p1"


def qti_zip(
    questions: Sequence[Drawn], title: str = "Robot learning", platform: str = "canvas"
) -> bytes:
    """Return questions as a QTI package: version 1.2 for Canvas, version 2.1 for Blackboard and others.

    A number becomes a numerical item, a choice or a place in a picture a multiple choice, a table an item for each of
    its cells, and an order an ordering item, or in Canvas a matching one. The worked explanation and the hints of usual
    mistakes are the feedback. Pictures are in the package.

    Parameters
    ----------
    questions : sequence of Drawn
    title : str, default "Robot learning"
        The title of the quiz.
    platform : str, default "canvas"
        "canvas" or "blackboard".

    Returns
    -------
    bytes
        The zip file.

    Raises
    ------
    ValueError
        If the platform is another one.

    Examples
    --------
    >>> from robonav.drills.export import drawn, selected
    >>> package = qti_zip(drawn(selected(drills=["td-error"])))
    >>> zipfile.ZipFile(io.BytesIO(package)).namelist()
    ['imsmanifest.xml', 'questions/assessment.xml']
    """
    if platform not in PLATFORMS:
        raise ValueError(
            f"platform must be one of {', '.join(PLATFORMS)}, got {platform}"
        )
    made = items(questions)
    documents = (
        {"assessment.xml": qti12.assessment(made, title)}
        if platform == "canvas"
        else _documents_21(made, title)
    )
    pictures = {item.file: item.picture for item in made if item.picture}
    manifest = _manifest(documents, {item.name: item for item in made}, platform)
    files = {"imsmanifest.xml": _xml(manifest)}
    files |= {f"{FOLDER}/{name}": _xml(root) for name, root in documents.items()}
    files |= {f"{FOLDER}/{name}": content for name, content in pictures.items()}
    return _zip(files)


def _documents_21(made: Sequence[Item], title: str) -> dict[str, Element]:
    documents = {f"{item.name}.xml": qti21.assessment_item(item) for item in made}
    return {"test.xml": qti21.assessment_test(list(documents), title), **documents}


def _manifest(
    documents: Mapping[str, Element], made: Mapping[str, Item], platform: str
) -> Element:
    """What is in the package, and which file needs which."""
    manifest = ElementTree.Element("manifest", xmlns=NAMESPACE, identifier="manifest")
    metadata = child(manifest, "metadata")
    schema, version = (
        ("IMS Content", "1.1.3") if platform == "canvas" else ("QTIv2.1", "2.0")
    )
    child(metadata, "schema", schema)
    child(metadata, "schemaversion", version)
    child(manifest, "organizations")
    resources = child(manifest, "resources")
    pictures = [item for item in made.values() if item.picture]
    for name in documents:
        stem = name.removesuffix(".xml")
        needed = [f"{stem}-picture"] if stem in made and made[stem].picture else []
        kind = "imsqti_item_xmlv2p1"
        if name == "test.xml":
            kind, needed = "imsqti_test_xmlv2p1", list(made)
        elif name == "assessment.xml":
            kind, needed = "imsqti_xmlv1p2", [f"{one.name}-picture" for one in pictures]
        _resource(resources, stem, name, kind, needed)
    for item in pictures:
        _resource(resources, f"{item.name}-picture", item.file, "webcontent", [])
    return manifest


def _resource(
    resources: Element, ident: str, file: str, kind: str, needed: Sequence[str]
) -> None:
    path = f"{FOLDER}/{file}"
    resource = child(resources, "resource", identifier=ident, type=kind, href=path)
    child(resource, "file", href=path)
    for other in needed:
        child(resource, "dependency", identifierref=other)


def _xml(root: Element) -> bytes:
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


def _zip(files: Mapping[str, bytes]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(
                zipfile.ZipInfo(name, START_OF_ZIP), content, zipfile.ZIP_DEFLATED
            )
    return buffer.getvalue()
