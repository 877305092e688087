"""How well copies are told from honest answers.

Run by hand: ``python benchmarks/similarity.py`` writes ``benchmarks/similarity.json``.

``tests/unit/grading/similar`` holds twelve honest answers to each of ten exercises, all different and all right, and
translations of six of them between loops and arrays. A class has twelve students, each with one of the twelve answers
to every exercise, drawn so that no two students share one: six who like arrays and six who like loops, in all
exercises, which makes honest students more alike than chance would. Then two of them throw their answers away, copy
those of another and disguise them, all of them or half. Each class is drawn independently. Every pair but that of a
copy and its original is honest. The method is developed without the exercises in HELD_OUT, which tell how well it does
on others. In other classes a ring of three to nine students hand in the same answers to all ten exercises.

Classes of other sizes are drawn in the same way. In a class of thirty, two or three honest students have each of the
twelve answers to an exercise, so that honest pairs are more alike than in smaller ones. In further classes half of ten
exercises are copied, and a third person has three of the same answers; the pairs of the third person with the other two
count neither as copies nor as honest.
"""

from __future__ import annotations

import argparse
import ast
import json
import random
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from robonav.grading.course import Course
from robonav.grading.fingerprints import Fingerprint, fingerprint
from robonav.grading.similarity import FEWEST, THRESHOLD, Pair, pairs

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "tests/unit/grading/similar"
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
SIZES = (6, 8, 12, 30)
THIRD = "third"  # a pair of a third person with one of two who copied
DISGUISES = ("recommented", "renamed", "reordered", "translated")
Functions = dict[str, dict[int, ast.Module]]


def functions(kind: str) -> Functions:
    """Return the answers of a kind, by exercise and number. Each is a module of its own."""
    found: Functions = {}
    for id, name in EXERCISES.items():
        tree = ast.parse((FOLDER / kind / f"{name}.py").read_text("utf-8"))
        imports = [n for n in tree.body if isinstance(n, ast.Import | ast.ImportFrom)]
        found[id] = {
            int(node.name.rpartition("_")[2]): ast.Module([*imports, node], [])
            for node in tree.body
            if isinstance(node, ast.FunctionDef)
        }
    return found


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


def classes(
    number: int,
    exercises: int,
    pool: Sequence[str] = (),
    copied: int = 0,
    size: int = 12,
    shared: int = 0,
) -> Iterator[tuple[list[Pair], dict[tuple[str, str], str]]]:
    """Yield the compared pairs of random classes, and which of them are copies, with the disguise.

    A class has this number of students and of exercises of the pool. Of the exercises ``copied`` are copied, or all. A
    third person has ``shared`` of these answers too.
    """
    honest, translated, others = functions("honest"), functions("translated"), known()
    prints = {
        id: {k: fingerprint(tree, _main(tree)) for k, tree in found.items()}
        for id, found in honest.items()
    }
    for seed in range(number):
        rng = random.Random(seed)
        chosen = rng.sample(sorted(pool or EXERCISES), exercises)
        taken = chosen[: copied or exercises]
        order = {id: _by_taste(honest[id], rng, size) for id in chosen}
        people = rng.sample(range(size), 4)
        hows = rng.sample(DISGUISES, 2)
        copies: dict[tuple[str, str], str] = {}
        own: dict[tuple[int, str], Fingerprint] = {}
        for thief, victim, how in zip(people[:2], people[2:], hows, strict=True):
            copies[f"student {victim:02}", f"student {thief:02}"] = how
            for id in taken:
                if how == "translated":  # an answer with a translation changes place
                    k = rng.choice(sorted(translated[id]))
                    if k in order[id]:
                        order[id][order[id].index(k)] = order[id][victim]
                    order[id][victim] = k
                source = translated if how == "translated" else honest
                tree = source[id][order[id][victim]]
                own[thief, id] = disguised(tree, how, rng)
        # The victims' answers are settled only now.
        for thief, victim, how in zip(people[:2], people[2:], hows, strict=True):
            for id in taken if how != "translated" else ():
                own[thief, id] = disguised(honest[id][order[id][victim]], how, rng)
        if shared:
            thief, victim = people[0], people[2]
            third = rng.choice([n for n in range(size) if n not in people])
            for id in rng.sample(taken, shared):
                tree = honest[id][order[id][victim]]
                own[third, id] = disguised(tree, rng.choice(DISGUISES[:3]), rng)
            for other in (thief, victim):
                copies[f"student {third:02}", f"student {other:02}"] = THIRD
        answers = {
            f"student {n:02}": {
                id: own.get((n, id), prints[id][order[id][n]]) for id in chosen
            }
            for n in range(size)
        }
        yield pairs(answers, others), copies


def ringed(
    number: int, size: int, disguises: Sequence[str] = DISGUISES[:3]
) -> Iterator[tuple[list[Pair], set[str]]]:
    """Yield the compared pairs of random classes, and the ring in it. Without disguises its answers are equal."""
    honest, others = functions("honest"), known()
    for seed in range(number):
        rng = random.Random(seed)
        order = {id: _by_taste(honest[id], rng) for id in EXERCISES}
        ring = rng.sample(range(12), size)
        answers: dict[str, dict[str, Fingerprint]] = {}
        for n in range(12):
            how = rng.choice(disguises) if n in ring and disguises else ""
            for id in EXERCISES:
                tree = honest[id][order[id][ring[0] if n in ring else n]]
                one = disguised(tree, how, rng) if how else fingerprint(tree, _main(tree))  # fmt: skip
                answers.setdefault(f"student {n:02}", {})[id] = one
        yield pairs(answers, others), {f"student {n:02}" for n in ring}


def _by_taste(
    found: dict[int, ast.Module], rng: random.Random, size: int = 12
) -> list[int]:
    """Return which answer each of ``size`` students has: those with fewer loops first, and in each half at random.

    A class that is larger than the number of answers draws them again.
    """
    loops = {
        number: sum(
            isinstance(node, ast.For | ast.While | ast.comprehension)
            for node in ast.walk(tree)
        )
        for number, tree in found.items()
    }
    by_loops = sorted(found, key=lambda number: (loops[number], rng.random()))
    half = len(by_loops) // 2
    return _drawn(by_loops[:half], size // 2, rng) + _drawn(
        by_loops[half:], size - size // 2, rng
    )


def _drawn(numbers: Sequence[int], many: int, rng: random.Random) -> list[int]:
    """Return this many of the numbers in random order, each as often as any other."""
    drawn = list[int]()
    while len(drawn) < many:
        drawn += rng.sample(numbers, len(numbers))
    return drawn[:many]


def measured(
    number: int,
    exercises: int,
    pool: Sequence[str] = (),
    copied: int = 0,
    size: int = 12,
    shared: int = 0,
) -> dict[str, Any]:
    """Return the shares of copies and of honest pairs that are reported."""
    found, total = Counter[str](), Counter[str]()
    for compared, copies in classes(number, exercises, pool, copied, size, shared):
        for pair in compared:
            names = (pair.first, pair.second)
            kind = copies.get(names, copies.get(names[::-1], "honest"))
            total[kind] += 1
            found[kind] += pair.score >= THRESHOLD
    return {
        "students": size,
        "exercises": exercises,
        "copied": copied or exercises,
        "reported": {k: round(found[k] / total[k], 4) for k in sorted(total)},
        "pairs": dict(sorted(total.items())),
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


def _classes_by_size(number: int) -> dict[int, int]:
    """Return how many classes of each size are drawn: fewer large ones, which take longer."""
    return {size: max(1, number // (2 if size <= 12 else 10)) for size in SIZES}


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--classes", type=int, default=300)
    parser.add_argument("--out", type=Path, default=ROOT / "benchmarks/similarity.json")
    options = parser.parse_args()
    number = options.classes
    result = {
        "threshold": THRESHOLD,
        "fewest": FEWEST,
        "classes": number,
        "all copied": [measured(number, k) for k in (1, 2, 3, 4, 6, 8, 10)],
        "half copied": measured(number, 10, copied=5),
        "held out": measured(number, len(HELD_OUT), HELD_OUT),
        "sizes": [
            {"classes": many} | measured(many, 6, size=size)
            for size, many in _classes_by_size(number).items()
        ],
        "a third person": [
            {"classes": many} | measured(many, 10, copied=5, size=size, shared=3)
            for size, many in _classes_by_size(number).items()
        ],
        "rings": [ring_measured(max(1, number // 4), size) for size in RINGS],
    }
    options.out.write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
