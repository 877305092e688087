"""XML elements, as all formats of question banks are made of them."""

from __future__ import annotations

from xml.etree import ElementTree

Element = ElementTree.Element


def child(node: Element, tag: str, text: str = "", **attributes: str) -> Element:
    """Add an element to another one, and return it.

    Examples
    --------
    >>> root = Element("manifest")
    >>> child(root, "schema", "QTIv2.1", lang="en").text
    'QTIv2.1'
    >>> ElementTree.tostring(root)
    b'<manifest><schema lang="en">QTIv2.1</schema></manifest>'
    """
    added = ElementTree.SubElement(node, tag, attributes)
    added.text = text or None
    return added
