"""Find texts of a picture in SVG that overlap, or that leave the picture."""

LABEL_FAULTS = """(picture) => {
  const pen = document.createElement("canvas").getContext("2d");
  const inkOf = (text) => { // the box of a text without the room above and below its letters
    pen.font = getComputedStyle(text).font;
    const ink = pen.measureText(text.textContent);
    const { left, right, top, height } = text.getBoundingClientRect();
    const scale = height / (ink.fontBoundingBoxAscent + ink.fontBoundingBoxDescent);
    const line = top + ink.fontBoundingBoxAscent * scale;
    const [upper, lower] = [line - ink.actualBoundingBoxAscent * scale, line + ink.actualBoundingBoxDescent * scale];
    return { words: text.textContent.trim(), left, right, top: upper, bottom: lower };
  };
  const seen = { visibilityProperty: true, opacityProperty: true };
  const labels = [...picture.querySelectorAll("text")]
    .filter((text) => text.textContent.trim() && text.checkVisibility(seen)).map(inkOf);
  const frame = picture.getBoundingClientRect();
  const out = labels.filter(({ left, right, top, bottom }) =>
    left < frame.left - 2 || right > frame.right + 2 || top < frame.top - 2 || bottom > frame.bottom + 2);
  const meet = (one, other) => Math.min(one.right, other.right) - Math.max(one.left, other.left) > 2
    && Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top) > 2;
  const over = labels.flatMap((one, i) => labels.slice(i + 1).filter((other) => meet(one, other))
    .map((other) => `${one.words} over ${other.words}`));
  return [...out.map(({ words }) => `${words} leaves its picture`), ...over];
}"""
"""Texts of a picture that overlap or leave it by more than two pixels."""
