"""Go through the widgets of a page by Tab: the focus follows the visual order, is seen, and comes out again."""

from __future__ import annotations

from playwright.sync_api import Page

STILL = "*, *::before, *::after { transition: none !important; }"  # looks are compared at once
START = """(widget) => {
  const shown = (part) => {
    const { outline, boxShadow, borderColor, backgroundColor, textDecoration } = getComputedStyle(part);
    return [outline, boxShadow, borderColor, backgroundColor, textDecoration].join();
  };
  const looks = (element) => [element, element.closest("label"), element.nextElementSibling]
    .map((part) => shown(part ?? element)).join("|");
  const reached = (element) => { // one radio button of a group takes the focus: the chosen one, or else the first
    if (element.type !== "radio") return true;
    const group = [...widget.querySelectorAll(`input[type=radio][name="${element.name}"]`)];
    return element === (group.find(({ checked }) => checked) ?? group[0]);
  };
  const stops = [...widget.querySelectorAll("a[href], button, input, select, textarea, summary, [tabindex]")]
    .filter((each) => each.tabIndex >= 0 && !each.matches(":disabled") && each.checkVisibility() && reached(each));
  const ends = ["before", "after"].map((where) => {
    const end = document.createElement("button");
    end.textContent = where;
    widget[where](end);
    return end;
  });
  const visited = [];
  const listen = ({ target }) => {
    const { left, right, top, bottom } = target.getBoundingClientRect();
    visited.push({ target, seen: looks(target), left, right, top: top + scrollY, bottom: bottom + scrollY });
  };
  window.tabbed = { widget, stops, ends, visited, listen, plain: new Map(stops.map((stop) => [stop, looks(stop)])) };
  ends[0].focus();
  document.addEventListener("focusin", listen);
  return stops.length;
}"""
FAULTS = """() => {
  const { widget, stops, ends, visited, listen, plain } = window.tabbed;
  document.removeEventListener("focusin", listen);
  const nameOf = (element) => {
    const name = element.getAttribute("aria-label") || element.labels?.[0]?.innerText || element.innerText;
    return (name || element.outerHTML).slice(0, 60);
  };
  const last = visited.at(-1)?.target ?? ends[0];
  const inside = visited.filter(({ target }) => widget.contains(target));
  const reached = new Set(inside.map(({ target }) => target));
  const faults = last === ends[1] ? [] : [`the focus does not come out after ${nameOf(last)}`];
  for (const stop of stops) if (!reached.has(stop)) faults.push(`never reached: ${nameOf(stop)}`);
  for (const { target, seen } of inside) if (seen === plain.get(target)) faults.push(`not seen: ${nameOf(target)}`);
  inside.slice(1).forEach((b, k) => {
    const a = inside[k];
    const above = b.bottom <= a.top + 2 && b.left < a.right - 2;
    const overlap = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    const inRow = overlap > 0.6 * Math.min(a.bottom - a.top, b.bottom - b.top);
    if (above || (inRow && b.right <= a.left + 2)) faults.push(`${nameOf(b.target)} stands before ${nameOf(a.target)}`);
  });
  ends.forEach((end) => end.remove());
  return faults;
}"""


def focus_faults(page: Page) -> list[str]:
    """What is wrong when Tab goes through each widget of the page, from before it to behind it."""
    page.add_style_tag(content=STILL)
    found = []
    for widget in page.locator(".robonav").all():
        for _ in range(widget.evaluate(START) + 1):
            page.keyboard.press("Tab")
        found += page.evaluate(FAULTS)
    return found
