"""Formulas in type: the part of TeX that the drills use, and Matplotlib's mathtext for what is beyond it.

Mathtext takes about two milliseconds for a formula, which is too slow for a class of papers.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from .boxes import ITALIC, UPRIGHT, Box, Rule, Run, beside, letters, registered

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ϵ", "varepsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ",
    "sigma": "σ", "tau": "τ", "phi": "ϕ", "varphi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω",
    "ell": "ℓ",
}  # fmt: skip
SIGNS = {
    "Gamma": ("Γ", "ord"), "Delta": ("Δ", "ord"), "Theta": ("Θ", "ord"), "Lambda": ("Λ", "ord"), "Pi": ("Π", "ord"),
    "Sigma": ("Σ", "ord"), "Phi": ("Φ", "ord"), "Psi": ("Ψ", "ord"), "Omega": ("Ω", "ord"),
    "cdot": ("·", "bin"), "times": ("×", "bin"), "pm": ("±", "bin"), "mp": ("∓", "bin"),
    "leq": ("≤", "rel"), "le": ("≤", "rel"), "geq": ("≥", "rel"), "ge": ("≥", "rel"), "neq": ("≠", "rel"),
    "ne": ("≠", "rel"), "approx": ("≈", "rel"), "sim": ("∼", "rel"), "in": ("∈", "rel"), "to": ("→", "rel"),
    "rightarrow": ("→", "rel"), "leftarrow": ("←", "rel"), "mid": ("|", "rel"), "propto": ("∝", "rel"),
    "nabla": ("∇", "ord"), "partial": ("∂", "ord"), "infty": ("∞", "ord"), "|": ("‖", "ord"), "%": ("%", "ord"),
    "{": ("{", "open"), "}": ("}", "close"), "dots": ("…", "ord"), "ldots": ("…", "ord"), "cdots": ("⋯", "ord"),
    "sum": ("∑", "op"), "prod": ("∏", "op"), "lVert": ("‖", "open"), "rVert": ("‖", "close"),
    "circ": ("∘", "bin"), "top": ("⊤", "ord"), "ast": ("∗", "bin"),
}  # fmt: skip
WORDS = {"log", "ln", "exp", "max", "min", "sin", "cos", "tan", "arg", "Pr", "operatorname", "tanh"}  # fmt: skip
SPACES = {",": 0.167, ":": 0.222, ";": 0.278, " ": 0.25, "quad": 1.0, "!": -0.167}
CHARACTERS = {
    "-": ("−", "bin"), "+": ("+", "bin"), "*": ("∗", "bin"), "=": ("=", "rel"), "<": ("<", "rel"), ">": (">", "rel"),
    "(": ("(", "open"), "[": ("[", "open"), ")": (")", "close"), "]": ("]", "close"), ",": (",", "punct"),
    ";": (";", "punct"), ":": (":", "rel"), "'": ("′", "ord"),
}  # fmt: skip
SCRIPT = 0.72  # of the size of what it stands at
RAISED, LOWERED = 0.38, 0.17  # of the size
SHORT, LONG = (
    90.0,
    220.0,
)  # points: a short formula stays in one line, a long one breaks anywhere
TOKEN = re.compile(r"\\[a-zA-Z]+|\\.|\d+(?:\.\d+)?|\s+|.", re.DOTALL)


@dataclass(frozen=True)
class Atom:
    """A part of a formula with its kind, which says how far it stands from its neighbours.

    Attributes
    ----------
    kind : str
        "ord", "op", "bin", "rel", "open", "close", "punct", or "space".
    box : Box
        What is set.
    """

    kind: str
    box: Box


class _Unknown(Exception):
    """The formula has what only mathtext can set."""


@cache
def pieces(formula: str, size: float) -> tuple[tuple[float, Box, bool], ...]:
    r"""Return a formula as boxes, each with the gap in front of it and whether a line may break there.

    Parameters
    ----------
    formula : str
        TeX, without dollar signs.
    size : float
        In points.

    Returns
    -------
    tuple of (float, Box, bool)

    Examples
    --------
    >>> [breaks for _, _, breaks in pieces(r"G_0 = 4 + 0.5 \cdot 3 + 0.25 \cdot 2 = 6", 11.0)]
    [False, True, True]
    """
    try:
        tokens = TOKEN.findall(formula)
        atoms = _spaced(list(_atoms(tokens, size)))
    except _Unknown:
        return ((0.0, _mathtext(formula, size), False),)
    parts: list[tuple[float, Box, bool]] = []
    whole = _part(atoms, 0, len(atoms), size, False)
    if whole[1].width <= SHORT:
        return (whole,)
    start = 0
    for k in range(1, len(atoms) + 1):
        if k == len(atoms) or atoms[k].kind in ("rel", "bin", "op"):
            breaks = start > 0 and atoms[start].kind == "rel"
            parts.append(_part(atoms, start, k, size, breaks))
            start = k
    return tuple(_joined(parts))


def _part(
    atoms: list[Atom], start: int, end: int, size: float, breaks: bool
) -> tuple[float, Box, bool]:
    gaps = [_gap(atoms, k, size) for k in range(start, end)]
    box = beside([atom.box for atom in atoms[start:end]], [0.0, *gaps[1:]])
    return gaps[0], box, breaks


def _joined(
    parts: list[tuple[float, Box, bool]],
) -> list[tuple[float, Box, bool]]:
    """Join what may not be broken, unless it would be too long for a line."""
    joined: list[tuple[float, Box, bool]] = []
    for gap, box, breaks in parts:
        if joined and not breaks:
            before, other, broke = joined[-1]
            if other.width + gap + box.width <= LONG:
                joined[-1] = before, beside([other, box], [0.0, gap]), broke
                continue
            breaks = True
        joined.append((gap, box, breaks))
    return joined


def _gap(atoms: list[Atom], k: int, size: float) -> float:
    """The space in front of an atom."""
    if k == 0:
        return 0.0
    before, kind = atoms[k - 1].kind, atoms[k].kind
    if "space" in (before, kind):
        return 0.0
    if "rel" in (before, kind):
        return 0.278 * size
    if "bin" in (before, kind):
        return 0.222 * size
    if before == "punct":
        return 0.2 * size
    if before == "op" and kind != "open":
        return 0.167 * size
    return 0.167 * size if kind == "op" and before in ("ord", "close") else 0.0


def _spaced(atoms: list[Atom]) -> list[Atom]:
    """A sign at the beginning, or after another one, belongs to its number."""
    fixed: list[Atom] = []
    for atom in atoms:
        seen = [one for one in fixed if one.kind != "space"]
        alone = not seen or seen[-1].kind in ("bin", "rel", "open", "punct", "op")
        kind = "ord" if atom.kind == "bin" and alone else atom.kind
        fixed.append(Atom(kind, atom.box))
    return fixed


def _atoms(tokens: list[str], size: float) -> Iterator[Atom]:
    """Read tokens from the front until they are used up."""
    while tokens:
        if tokens[0].isspace():
            tokens.pop(0)
            continue
        atom = _atom(tokens, size)
        scripts = {}
        while tokens and tokens[0] in "^_":
            sign = tokens.pop(0)
            scripts[sign] = _line(_argument(tokens), SCRIPT * size)
        yield _with_scripts(atom, scripts, size) if scripts else atom


def _argument(tokens: list[str]) -> list[str]:
    """A group in braces, or one token."""
    while tokens and tokens[0].isspace():
        tokens.pop(0)
    if not tokens:
        raise _Unknown
    if tokens[0] != "{":
        return [tokens.pop(0)]
    depth = 0
    for k, token in enumerate(tokens):
        depth += (token == "{") - (token == "}")
        if depth == 0:
            group = tokens[1:k]
            del tokens[: k + 1]
            return group
    raise _Unknown


def _line(tokens: list[str], size: float) -> Box:
    atoms = _spaced(list(_atoms(tokens, size)))
    gaps = [0.7 * _gap(atoms, k, size) for k in range(len(atoms))]
    return beside([atom.box for atom in atoms], gaps)


def _atom(tokens: list[str], size: float) -> Atom:
    token = tokens.pop(0)
    if token.startswith("\\"):
        return _command(token[1:], tokens, size)
    if token == "{":
        tokens.insert(0, token)
        return Atom("ord", _line(_argument(tokens), size))
    if token in CHARACTERS:
        text, kind = CHARACTERS[token]
        return Atom(kind, letters(text, UPRIGHT, size))
    if token in "}^_&~":
        raise _Unknown
    italic = token.isalpha() and token.isascii()
    return Atom("ord", letters(token, ITALIC if italic else UPRIGHT, size))


def _command(name: str, tokens: list[str], size: float) -> Atom:
    if name in GREEK:
        return Atom("ord", letters(GREEK[name], ITALIC, size))
    if name in SIGNS:
        text, kind = SIGNS[name]
        return Atom(kind, letters(text, UPRIGHT, size))
    if name in SPACES:
        return Atom("space", Box(SPACES[name] * size))
    if name in ("left", "right"):
        return _atom(tokens, size)
    if name in ("text", "mathrm", "operatorname"):
        kind = "op" if name == "operatorname" else "ord"
        return Atom(kind, letters("".join(_argument(tokens)), UPRIGHT, size))
    if name in WORDS:
        return Atom("op", letters(name, UPRIGHT, size))
    if name in ("bar", "overline"):
        return Atom("ord", _barred(_line(_argument(tokens), size), size))
    if name == "sqrt" and (not tokens or tokens[0] != "["):
        root = letters("√", UPRIGHT, size)
        content = _line(_argument(tokens), size)
        barred = Rule(root.width, 0.78 * size, content.width, 0.05 * size)
        both = beside([root, content])
        return Atom(
            "ord",
            Box(both.width, both.runs, (*both.rules, barred), both.height, both.depth),
        )
    raise _Unknown


def _barred(box: Box, size: float) -> Box:
    bar = Rule(0.1 * box.width, 0.56 * size, 0.9 * box.width, 0.05 * size)
    return Box(box.width, box.runs, (*box.rules, bar), box.height, box.depth)


def _with_scripts(atom: Atom, scripts: dict[str, Box], size: float) -> Atom:
    base = atom.box
    above = scripts.get("^", Box(0.0)).moved(base.width + 0.03 * size, RAISED * size)
    below = scripts.get("_", Box(0.0)).moved(base.width, -LOWERED * size)
    return Atom(
        atom.kind,
        Box(
            base.width + max(above.width, below.width) + 0.04 * size,
            (*base.runs, *above.runs, *below.runs),
            (*base.rules, *above.rules, *below.rules),
            max(base.height, above.height),
            max(base.depth, below.depth),
        ),
    )


def _mathtext(formula: str, size: float) -> Box:
    """A formula as Matplotlib sets it."""
    from matplotlib import rc_context
    from matplotlib.font_manager import FontProperties
    from matplotlib.mathtext import MathTextParser

    with rc_context({"mathtext.fontset": "stix"}):
        set_ = MathTextParser("path").parse(
            f"${formula}$", dpi=72, prop=FontProperties(family="STIXGeneral", size=size)
        )
    runs = tuple(
        Run(x, y, chr(code), registered(Path(str(font.fname)).stem), glyph_size)
        for font, glyph_size, code, *_, x, y in set_.glyphs
    )
    rules = tuple(Rule(*map(float, rect)) for rect in set_.rects)
    return Box(float(set_.width), runs, rules, float(set_.height), float(set_.depth))
