"""Find texts of a picture in SVG that overlap, or that leave the picture."""

LABEL_FAULTS = """(picture) => {
  const pen = document.createElement("canvas").getContext("2d");
  const inkOf = (text) => { // the box of a text without the room above and below its letters
    const { font } = getComputedStyle(text);
    pen.font = font;
    const { fontBoundingBoxAscent: up, fontBoundingBoxDescent: down, actualBoundingBoxAscent: high, actualBoundingBoxDescent: low } =
      pen.measureText(text.textContent);
    const { left, right, top, height } = text.getBoundingClientRect();
    const scale = height / (up + down);
    return { words: text.textContent.trim(), left, right, top: top + (up - high) * scale, bottom: top + (up + low) * scale };
  };
  const frame = picture.getBoundingClientRect();
  const labels = [...picture.querySelectorAll("text")]
    .filter((text) => text.textContent.trim() && text.checkVisibility({ visibilityProperty: true, opacityProperty: true }))
    .map(inkOf);
  const out = labels.filter(({ left, right, top, bottom }) =>
    left < frame.left - 2 || right > frame.right + 2 || top < frame.top - 2 || bottom > frame.bottom + 2);
  const over = labels.flatMap((one, i) => labels.slice(i + 1).filter((other) =>
    Math.min(one.right, other.right) - Math.max(one.left, other.left) > 2
    && Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top) > 2).map((other) => [one, other]));
  return [...out.map(({ words }) => `${words} leaves its picture`), ...over.map(([one, other]) => `${one.words} over ${other.words}`)];
}"""
"""Texts of a picture that overlap or leave it by more than two pixels. A text that is turned counts with its whole box."""
