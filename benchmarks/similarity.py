"""How well copies are told from honest answers.

Run by hand: ``python benchmarks/similarity.py`` writes ``benchmarks/similarity.json``.

``solutions/honest`` holds thirty honest answers to each of ten exercises, all different and all right, and
``tests/unit/grading/similar`` translations of six of them between loops and arrays. The students of a class each have
one of the thirty answers to every exercise, drawn so that no two share one. Half of them like arrays and half like
loops, in all exercises, which makes honest students more alike than chance would. The answers that nobody in the class
has are the honest answers that come with the course; a class of thirty has all of them, and nothing comes with it.

Then one student, or two in a class of five or more, throws answers away, copies those of another and disguises them:
all, half of them, or each from one of several sources. In other classes a third person has some of the same answers
(these pairs count neither as copies nor as honest), or a ring of three to nine students hands in the same answers to
all ten exercises. Each class is drawn independently, and its number is its seed. Every pair but that of a copy and its
original is honest. The method is developed without the exercises in HELD_OUT, which tell how well it does on others.
"""

from __future__ import annotations

import argparse
import ast
import json
import random
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from robonav.grading.course import Course
from robonav.grading.fingerprints import Fingerprint, fingerprint
from robonav.grading.similarity import FEWEST, THRESHOLD, Pair, pairs, patchworks

ROOT = Path(__file__).parents[1]
TRANSLATED = ROOT / "tests/unit/grading/similar/translated"
EXERCISES = {
    "2.1": "backup",
    "2.2": "improve",
    "2.3": "bounds",
    "2.4": "track",
    "2.5": "targets",
    "2.6": "first_visits",
    "2.7": "battery",
    "3.1": "forward",
    "3.2": "encode",
    "3.5": "effective",
}
HELD_OUT = ("2.7", "3.1", "3.2", "3.5")
RINGS = (3, 4, 6, 9)
SIZES = (3, 5, 6, 8, 12, 30)
WAYS = 4  # of each disguise of an answer
THIRD = "third"  # a pair of a third person with one of two who copied
DISGUISES = ("recommented", "renamed", "reordered", "translated")
Functions = dict[str, dict[int, ast.Module]]


def functions(kind: str) -> Functions:
    """Return the answers of a kind, by exercise and number. Each is a module of its own."""
    found: Functions = {}
    for id, name in EXERCISES.items():
        tree = ast.parse(_path(kind, id, name).read_text("utf-8"))
        imports = [n for n in tree.body if isinstance(n, ast.Import | ast.ImportFrom)]
        found[id] = {
            int(node.name.rpartition("_")[2]): ast.Module([*imports, node], [])
            for node in tree.body
            if isinstance(node, ast.FunctionDef)
        }
    return found


def _path(kind: str, id: str, name: str) -> Path:
    """Return the file of the answers of a kind to an exercise."""
    if kind == "translated":
        return TRANSLATED / f"{name}.py"
    course = Course(ROOT)
    return course.solutions / "honest" / course.exercises[id].file


class Renamed(ast.NodeTransformer):
    """Gives every name of a function another one."""

    def __init__(self, tree: ast.Module, rng: random.Random) -> None:
        stored = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}  # fmt: skip
        stored |= {n.arg for n in ast.walk(tree) if isinstance(n, ast.arg)}
        inner = [n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)][1:]
        stored |= {node.name for node in inner}
        self.new = {name: f"{rng.choice('abcdefgh')}{n}" for n, name in enumerate(sorted(stored))}  # fmt: skip

    def visit_Name(self, node: ast.Name) -> ast.Name:
        node.id = self.new.get(node.id, node.id)
        return node

    def visit_arg(self, node: ast.arg) -> ast.arg:
        node.arg = self.new.get(node.arg, node.arg)
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        node.name = self.new.get(node.name, node.name)
        self.generic_visit(node)
        return node


class Reordered(ast.NodeTransformer):
    """Exchanges statements that do not need each other, and the sides of sums, products and comparisons."""

    def __init__(self, rng: random.Random) -> None:
        self.rng = rng

    def generic_visit(self, node: ast.AST) -> ast.AST:
        super().generic_visit(node)
        for field in ("body", "orelse"):
            body = getattr(node, field, None)
            if isinstance(body, list):
                for k in range(len(body) - 1):
                    if _independent(body[k], body[k + 1]) and self.rng.random() < 0.8:
                        body[k], body[k + 1] = body[k + 1], body[k]
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.BinOp:
        self.generic_visit(node)
        if isinstance(node.op, ast.Add | ast.Mult) and self.rng.random() < 0.5:
            node.left, node.right = node.right, node.left
        return node

    def visit_Compare(self, node: ast.Compare) -> ast.Compare:
        self.generic_visit(node)
        turned = {ast.Lt: ast.Gt, ast.Gt: ast.Lt, ast.LtE: ast.GtE, ast.GtE: ast.LtE}
        if len(node.ops) == 1 and type(node.ops[0]) in turned and self.rng.random() < 0.5:  # fmt: skip
            node.left, node.comparators[0] = node.comparators[0], node.left
            node.ops[0] = turned[type(node.ops[0])]()
        return node


def _independent(one: ast.stmt, other: ast.stmt) -> bool:
    if not all(isinstance(x, ast.Assign | ast.AugAssign) for x in (one, other)):
        return False
    (wrote, read), (wrote2, read2) = _names(one), _names(other)
    return not (wrote & (read2 | wrote2) or wrote2 & read)


def _names(node: ast.stmt) -> tuple[set[str], set[str]]:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]  # type: ignore[attr-defined]
    wrote = {n.id for target in targets for n in ast.walk(target) if isinstance(n, ast.Name)}  # fmt: skip
    return wrote, {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}


def disguised(tree: ast.Module, how: str, rng: random.Random) -> Fingerprint:
    """Return the fingerprint of a copy. The text is made from the syntax tree, so that comments and layout are gone."""
    copy = ast.parse(ast.unparse(tree))
    if how == "recommented":
        return fingerprint(ast.parse(_recommented(copy, rng)), _main(copy))
    if how != "renamed":
        copy = Reordered(rng).visit(copy)
    copy = ast.parse(ast.unparse(ast.fix_missing_locations(Renamed(copy, rng).visit(copy))))  # fmt: skip
    return fingerprint(copy, _main(copy))


def _recommented(tree: ast.Module, rng: random.Random) -> str:
    """Return the text with a docstring and a comment on each other line."""
    main = next(node for node in tree.body if isinstance(node, ast.FunctionDef))
    main.body.insert(0, ast.Expr(ast.Constant("All my own work.")))
    lines = []
    for line in ast.unparse(ast.fix_missing_locations(tree)).splitlines():
        lines += [f"{line}  # step {len(lines)}" if rng.random() < 0.5 and '"' not in line else line]  # fmt: skip
    return "\n".join(lines)


def _main(tree: ast.Module) -> str:
    return next(node.name for node in tree.body if isinstance(node, ast.FunctionDef))


def known() -> dict[str, list[Fingerprint]]:
    """Return the fingerprints of the stub and of both solutions, as the command uses them."""
    course, found = Course(ROOT), defaultdict(list)
    for id, name in EXERCISES.items():
        for place in (course.stubs, course.solutions, course.solutions / "otherwise"):
            text = (place / course.exercises[id].file).read_text("utf-8")
            found[id].append(fingerprint(ast.parse(text), name))
    return found


class Drawn:
    """A class of students with their answers, of whom some copied.

    Parameters
    ----------
    order : dict of str to list of int
        The number of each student's honest answer, by exercise.
    """

    def __init__(self, order: dict[str, list[int]]) -> None:
        self.order = order
        # By thief and exercise: from whom an answer is copied, and the disguise.
        self.stolen: dict[tuple[int, str], tuple[int, str]] = {}

    def steal(self, thief: int, victim: int, ids: Sequence[str], how: str, rng: random.Random) -> None:  # fmt: skip
        """Let somebody copy answers. An answer that has a translation changes places with the victim's."""
        for id in ids:
            order = self.order[id]
            if how == "translated" and order[victim] not in TRANSLATIONS[id]:
                fixed = {order[whose] for (_, of), (whose, _) in self.stolen.items() if of == id}  # fmt: skip
                k = rng.choice(sorted(TRANSLATIONS[id].keys() - fixed))
                if k in order:
                    order[order.index(k)] = order[victim]
                order[victim] = k
            self.stolen[thief, id] = (victim, how)

    def answers(self, rng: random.Random) -> dict[str, dict[str, Fingerprint]]:
        """Return what each student hands in."""
        found: dict[str, dict[str, Fingerprint]] = {}
        for id, order in self.order.items():
            for n, k in enumerate(order):
                one = _print(id, k)
                if (n, id) in self.stolen:
                    victim, how = self.stolen[n, id]
                    one = _copy(id, order[victim], how, rng.randrange(WAYS))
                found.setdefault(named(n), {})[id] = one
        return found

    def known(self) -> dict[str, list[Fingerprint]]:
        """Return what the command knows: the stub, the solutions, and the honest answers that nobody here wrote."""
        return {
            id: [*_solutions()[id], *(_print(id, k) for k in HONEST[id] if k not in order)]
            for id, order in self.order.items()
        }  # fmt: skip

    def copies(self) -> dict[tuple[str, str], str]:
        """Return the pairs of thief and victim, with the disguise of the last answer."""
        return {
            (named(thief), named(victim)): how
            for (thief, _), (victim, how) in self.stolen.items()
        }


def named(number: int) -> str:
    """Return the name of a student."""
    return f"student {number:02}"


HONEST, TRANSLATIONS = functions("honest"), functions("translated")


@cache
def _print(id: str, number: int) -> Fingerprint:
    tree = HONEST[id][number]
    return fingerprint(tree, _main(tree))


@cache
def _copy(id: str, number: int, how: str, way: int) -> Fingerprint:
    """Return a copy of an answer in one of several ways of a disguise, or the answer itself without a disguise."""
    if not how:
        return _print(id, number)
    source = TRANSLATIONS if how == "translated" else HONEST
    return disguised(source[id][number], how, random.Random(f"{id} {number} {way}"))


@cache
def _solutions() -> dict[str, list[Fingerprint]]:
    return known()


def classes(
    number: int,
    exercises: int,
    pool: Sequence[str] = (),
    copied: int = 0,
    size: int = 12,
    sources: int = 1,
    shared: int = 0,
) -> Iterator[tuple[list[Pair], dict[tuple[str, str], str]]]:
    """Yield the compared pairs of random classes, and which of them are copies, with the disguise.

    A class has this number of students and of exercises of the pool. One student copies ``copied`` of them, or all,
    from as many ``sources``, from each another part. In a class of five or more, another one copies as many from one
    source. A third person has ``shared`` of the first one's answers too.
    """
    for seed in range(number):
        rng = random.Random(seed)
        ids = rng.sample(sorted(pool or EXERCISES), exercises)
        drawn = Drawn({id: _by_taste(id, rng, size) for id in ids})
        people = rng.sample(range(size), size)
        taken = ids[: copied or exercises]
        for k in range(sources):
            drawn.steal(people[0], people[k + 1], taken[k::sources], rng.choice(DISGUISES), rng)  # fmt: skip
        others = people[sources + 1 :]
        if len(others) >= 2:
            drawn.steal(others[0], others[1], taken, rng.choice(DISGUISES), rng)
        for id in rng.sample(taken, shared):
            drawn.steal(others[2], people[1], [id], rng.choice(DISGUISES[:3]), rng)
        copies = drawn.copies()
        for other in people[:2] if shared else ():
            copies[named(others[2]), named(other)] = THIRD
        yield pairs(drawn.answers(rng), drawn.known()), copies


def ringed(
    number: int, size: int, disguises: Sequence[str] = DISGUISES[:3]
) -> Iterator[tuple[list[Pair], set[str]]]:
    """Yield the compared pairs of random classes, and the ring in it. Without disguises its answers are equal."""
    for seed in range(number):
        rng = random.Random(seed)
        drawn = Drawn({id: _by_taste(id, rng, 12) for id in EXERCISES})
        ring = rng.sample(range(12), size)
        for thief in ring[1:]:
            how = rng.choice(disguises) if disguises else ""
            drawn.steal(thief, ring[0], list(EXERCISES), how, rng)
        yield pairs(drawn.answers(rng), drawn.known()), {named(n) for n in ring}


def _by_taste(id: str, rng: random.Random, size: int) -> list[int]:
    """Return which answer each of ``size`` students has: those with fewer loops first, and in each half at random."""
    loops = _loops(id)
    by_loops = sorted(loops, key=lambda number: (loops[number], rng.random()))
    half = len(by_loops) // 2
    first = rng.sample(by_loops[:half], size // 2)
    return first + rng.sample(by_loops[half:], size - size // 2)


@cache
def _loops(id: str) -> dict[int, int]:
    """Return the number of loops in each honest answer."""
    return {
        number: sum(
            isinstance(node, ast.For | ast.While | ast.comprehension)
            for node in ast.walk(tree)
        )
        for number, tree in HONEST[id].items()
    }


def measured(
    number: int,
    exercises: int,
    pool: Sequence[str] = (),
    copied: int = 0,
    size: int = 12,
    sources: int = 1,
    shared: int = 0,
) -> dict[str, Any]:
    """Return the shares of copies and of honest pairs that are reported, and of thieves and honest students."""
    found, total = Counter[str](), Counter[str]()
    drawn = classes(number, exercises, pool, copied, size, sources, shared)
    for compared, copies in drawn:
        for pair in compared:
            names = (pair.first, pair.second)
            kind = copies.get(names, copies.get(names[::-1], "honest"))
            total[kind] += 1
            found[kind] += pair.score >= THRESHOLD
        several = {one.student for one in patchworks(compared)}
        thieves = Counter(thief for thief, _ in copies)
        involved = {name for names in copies for name in names}
        for name in {name for pair in compared for name in (pair.first, pair.second)}:
            kind = "honest student" if name not in involved else "in one pair"
            if not shared or kind == "honest student":
                kind = "patchwork" if thieves[name] > 1 else kind
                total[kind] += 1
                found[kind] += name in several
    return {
        "students": size,
        "exercises": exercises,
        "copied": copied or exercises,
        "sources": sources,
        "classes": number,
        "reported": {k: round(found[k] / total[k], 4) for k in sorted(total)},
        "of": dict(sorted(total.items())),
    }


def ring_measured(number: int, size: int) -> dict[str, Any]:
    """Return the shares of a ring's pairs and of honest pairs that are reported."""
    found, total = Counter[str](), Counter[str]()
    for compared, ring in ringed(number, size):
        for pair in compared:
            kind = "ring" if {pair.first, pair.second} <= ring else "honest"
            total[kind] += 1
            found[kind] += pair.reported
    return {
        "ring": size,
        "classes": number,
        "reported": {k: round(found[k] / total[k], 4) for k in sorted(total)},
        "pairs": dict(sorted(total.items())),
    }


def _classes_of(size: int, number: int) -> int:
    """Return how many classes of a size are drawn: fewer large ones, which have more pairs."""
    return max(1, number * 12 // max(size, 4) // (3 if size > 12 else 1))


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--classes", type=int, default=300)
    parser.add_argument("--out", type=Path, default=ROOT / "benchmarks/similarity.json")
    options = parser.parse_args()
    number = options.classes
    by_size = {size: _classes_of(size, number) for size in SIZES}
    held = len(HELD_OUT)
    result = {
        "threshold": THRESHOLD,
        "fewest": FEWEST,
        "classes": number,
        "all copied": [measured(number, k) for k in (1, 2, 3, 4, 6, 8, 10)],
        "half copied": [measured(number, k, copied=k // 2) for k in (6, 10)],
        "held out": [
            measured(number, held, HELD_OUT),
            measured(number, held, HELD_OUT, copied=held // 2),
            measured(number, held, HELD_OUT, sources=2),
            measured(by_size[30], held, HELD_OUT, size=30),
        ],
        "sizes": [
            {
                "students": size,
                "all": measured(many, 6, size=size),
                "half": measured(many, 6, copied=3, size=size),
                "two sources": measured(many, 6, size=size, sources=2),
            }
            for size, many in by_size.items()
        ],
        "each from another": [
            measured(many, 4, size=size, sources=4)
            for size, many in by_size.items()
            if size > 4
        ],
        "a third person": [
            measured(many, 10, copied=5, size=size, shared=3)
            for size, many in by_size.items()
            if size > 4
        ],
        "rings": [ring_measured(max(1, number // 4), size) for size in RINGS],
    }
    options.out.write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
