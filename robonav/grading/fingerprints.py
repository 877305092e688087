"""What a function looks like when names, order and layout are taken away, and what it computes from what.

Two views of an answer are compared. Its *structure* is the set of its statements and expressions in which all names are
equal: it survives other names, another order and other comments. Its *flow* says which operation is applied to which
arguments of the exercise: it also survives a translation between loops and arrays, because ``p @ v`` and a loop that
adds up ``p[t] * v[t]`` are both a sum of products of the same two arguments.
"""

from __future__ import annotations

import ast
import copy
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import cast

MOST_NODES = 20_000  # of an answer that is compared
MOST_TIMES = 3  # that a feature counts in one answer
ALIASES = {
    "amax": "max", "maximum": "max", "nanmax": "max", "fmax": "max",
    "amin": "min", "minimum": "min", "nanmin": "min", "fmin": "min",
    "nansum": "sum", "fsum": "sum", "add": "sum", "cumsum": "sum", "average": "mean",
    "absolute": "abs", "fabs": "abs", "nanargmax": "argmax", "index": "argmax",
    "argsort": "sort", "sorted": "sort", "subtract": "sub", "multiply": "mul",
    "divide": "div", "true_divide": "div", "negative": "neg", "power": "pow",
}  # fmt: skip
PRODUCTS = {"dot", "matmul", "inner", "einsum", "tensordot", "vdot"}
KEPT = {
    "max", "min", "sum", "mean", "abs", "argmax", "argmin", "sort", "sub", "mul", "div", "neg", "pow", "exp", "log",
    "sqrt", "floor", "ceil", "round", "clip", "tanh", "sin", "cos", "hypot", "atan2", "arctan2", "prod", "any", "all",
    "diff", "median", "std", "var", "unique", "set", "isnan", "solve", "inv", "norm", "heappush", "heappop",
}  # fmt: skip
# What these return holds no value of their arguments.
SHAPES = {
    "len", "range", "arange", "zeros", "ones", "empty", "zeros_like", "ones_like", "empty_like", "indices", "eye",
}  # fmt: skip
OPERATORS: dict[type[ast.AST], str] = {
    ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.Div: "div", ast.Pow: "pow", ast.Mod: "mod",
    ast.FloorDiv: "floor", ast.BitAnd: "and", ast.And: "and", ast.BitOr: "or", ast.Or: "or", ast.BitXor: "xor",
}  # fmt: skip
COMPARISONS: dict[type[ast.AST], tuple[str, bool]] = {
    ast.Lt: ("lt", False), ast.Gt: ("lt", True), ast.LtE: ("le", False), ast.GtE: ("le", True),
    ast.Eq: ("eq", False), ast.NotEq: ("eq", False), ast.In: ("in", False), ast.NotIn: ("in", False),
}  # fmt: skip

Feature = tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Fingerprint:
    """The two views of an answer.

    Attributes
    ----------
    structure, flow : Counter of tuple
        How often each feature occurs.
    lines : dict of int to set of tuple
        The structure's features by line of the source.
    """

    structure: Counter[Feature]
    flow: Counter[Feature]
    lines: dict[int, set[Feature]]


def fingerprint(tree: ast.Module, name: str) -> Fingerprint:
    """Return the fingerprint of the function ``name`` and of the functions beside it.

    Examples
    --------
    >>> loop = "def f(p, v):\\n    t = 0\\n    for i in range(len(p)):\\n        t += p[i] * v[i]\\n    return t"
    >>> one = fingerprint(ast.parse(loop), "f")
    >>> other = fingerprint(ast.parse("def f(a, b):\\n    return a @ b"), "f")
    >>> sorted(one.flow & other.flow)[0]
    ('mul', '0', '1')
    """
    if sum(1 for _ in ast.walk(tree)) > MOST_NODES:
        raise ValueError("the answer is too long to be compared")
    plain = _Plain().visit(copy.deepcopy(tree))
    structure, lines = Counter[Feature](), dict[int, set[Feature]]()
    for statement in _statements(plain):
        found = list(_shapes(statement))
        structure.update(found)
        for line in range(statement.lineno, (statement.end_lineno or 0) + 1):
            lines.setdefault(line, set()).update(found)
    return Fingerprint(
        _capped(structure), _capped(_Flow(plain, name).features()), lines
    )


def _capped(counts: Counter[Feature]) -> Counter[Feature]:
    return Counter({feature: min(number, MOST_TIMES) for feature, number in counts.items()})  # fmt: skip


class _Plain(ast.NodeTransformer):
    """Takes away what says nothing: docstrings, imports, annotations, decorators."""

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.AST:
        self.generic_visit(node)
        node.returns, node.decorator_list = None, []
        if ast.get_docstring(node) is not None:
            node.body = node.body[1:]
        node.body = node.body or [ast.Pass()]
        return ast.fix_missing_locations(node)

    def visit_arg(self, node: ast.arg) -> ast.AST:
        node.annotation = None
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.AST | None:
        if node.value is None:
            return None
        new = ast.Assign([node.target], node.value)
        return ast.fix_missing_locations(ast.copy_location(new, node))

    def visit_Expr(self, node: ast.Expr) -> ast.AST | None:
        return (
            None if isinstance(node.value, ast.Constant) else self.generic_visit(node)
        )

    def visit_Import(self, node: ast.Import) -> None:
        return None

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        return None


def _statements(tree: ast.AST) -> Iterator[ast.stmt]:
    for node in ast.walk(tree):
        if isinstance(node, ast.stmt):
            yield node


def _shapes(statement: ast.stmt) -> Iterator[Feature]:
    """Yield a statement, without the statements inside it, and its expressions, with all names made equal."""
    if isinstance(statement, ast.FunctionDef | ast.ClassDef):
        return
    parts = [
        child
        for child in ast.iter_child_nodes(statement)
        if not isinstance(child, ast.stmt)
    ]
    inner = [_shape(part) for part in parts]
    yield ("statement", type(statement).__name__, *(text for text, _ in inner))
    for part in parts:
        for node in ast.walk(part):
            text, size = _shape(node)
            if size >= 4:
                yield "expression", text


def _shape(node: ast.AST) -> tuple[str, int]:
    """Return a node as text with equal names, and the number of its nodes."""
    if isinstance(node, ast.Name):
        return "v", 1
    if isinstance(node, ast.Constant):
        return repr(node.value)[:40], 1
    if isinstance(node, ast.expr_context):
        return "", 0
    size, texts = 1, list[str]()
    for child in ast.iter_child_nodes(node):
        text, number = _shape(child)
        size += number
        texts.append(text)
    kind = type(node).__name__
    if isinstance(node, ast.Attribute):
        kind = f".{node.attr}"
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Mult):
        texts = [texts[1], *sorted((texts[0], texts[2]))]
    if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Gt | ast.GtE):
        texts = [
            {"Gt()": "Lt()", "GtE()": "LtE()"}[texts[1]],
            texts[2],
            texts[0],
            *texts[3:],
        ]
    elif isinstance(node, ast.Compare):
        texts = [texts[1], texts[0], *texts[2:]]
    return f"{kind}({','.join(texts)})", size


class _Flow:
    """Which operation is applied to values that come from which arguments of the exercise."""

    def __init__(self, tree: ast.Module, name: str) -> None:
        self.tree = tree
        functions = {
            node.name: node
            for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef)
        }
        self.functions = functions
        main = functions.get(name)
        self.sources: dict[str, set[int]] = {}
        self.made: dict[
            str, set[str]
        ] = {}  # operations that a variable's value comes from
        self.fixed = set[str]()
        if main is not None:
            for number, argument in enumerate(main.args.args):
                self.sources[argument.arg] = {number}
                self.fixed.add(argument.arg)
        for _ in range(4):  # until nothing changes, or nearly so
            before = {name: len(found) for name, found in self.sources.items()}
            self._spread(tree.body, set())
            if before == {name: len(found) for name, found in self.sources.items()}:
                break

    def features(self) -> Counter[Feature]:
        """Return how often each operation is applied to values of the same origin."""
        found = Counter[Feature]()
        for node in ast.walk(self.tree):
            for operation, operands in self._operations(node):
                origins = [self._origin(operand) for operand in operands]
                found[(operation, *origins)] += 1
                for operand in operands:
                    for inner in self._tops(operand):
                        found[("of", operation, inner, self._origin(operand))] += 1
                        # Also without the origin, which a translation may change.
                        found[("of", operation, inner)] += 1
        return found

    def _spread(self, body: Iterable[ast.stmt], condition: set[int]) -> None:
        """Note where the values of all variables come from."""
        for node in body:
            if isinstance(node, ast.Assign):
                for target in node.targets:
                    self._bind(target, node.value, condition)
            elif isinstance(node, ast.AugAssign):
                self._bind(node.target, node.value, condition)
            elif isinstance(node, ast.For):
                self._bind(node.target, node.iter, condition, each=True)
            elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
                called = node.value.func
                if isinstance(called, ast.Attribute):
                    for argument in node.value.args:
                        self._bind(called.value, argument, condition)
            for comprehension in self._comprehensions(node):
                self._bind(
                    comprehension.target, comprehension.iter, condition, each=True
                )
            for call in self._own(node):
                if isinstance(call, ast.Call) and _called(call) in self.functions:
                    inner = self.functions[_called(call)].args.args
                    for own, given in zip(inner, call.args, strict=False):
                        if own.arg not in self.fixed:
                            self._add(own.arg, self._of(given), set(self._tops(given)))
            within = condition
            if isinstance(node, ast.If | ast.While):
                within = condition | self._of(node.test)
            for name in ("body", "orelse", "finalbody"):
                self._spread(getattr(node, name, []), within)

    def _comprehensions(self, node: ast.stmt) -> Iterator[ast.comprehension]:
        for inner in self._own(node):
            if isinstance(inner, ast.comprehension):
                yield inner

    def _own(self, node: ast.stmt) -> Iterator[ast.AST]:
        """Yield what belongs to a statement and not to the statements in it."""
        waiting = [x for x in ast.iter_child_nodes(node) if not isinstance(x, ast.stmt)]
        while waiting:
            inner = waiting.pop()
            yield inner
            waiting += ast.iter_child_nodes(inner)

    def _bind(
        self,
        target: ast.AST,
        value: ast.AST,
        condition: set[int],
        *,
        each: bool = False,
    ) -> None:
        if isinstance(target, ast.Tuple | ast.List):
            values: Sequence[ast.AST] = [value] * len(target.elts)
            if isinstance(value, ast.Tuple | ast.List) and len(value.elts) == len(target.elts):  # fmt: skip
                values = value.elts
            elif each and isinstance(value, ast.Call):
                called = _called(value)
                if called == "zip" and len(value.args) == len(target.elts):
                    values = value.args
                elif called == "enumerate" and len(target.elts) == 2:
                    values = [ast.Constant(0), value.args[0]] if value.args else values
            for one, its in zip(target.elts, values, strict=True):
                self._bind(one, its, condition, each=each)
        elif isinstance(target, ast.Starred | ast.Subscript | ast.Attribute):
            self._bind(target.value, value, condition)
        elif isinstance(target, ast.Name) and target.id not in self.fixed:
            self._add(target.id, self._of(value) | condition, set(self._tops(value)))
        elif isinstance(target, ast.Name):
            self.made.setdefault(target.id, set()).update(self._tops(value))

    def _add(self, name: str, origin: set[int], tops: set[str]) -> None:
        self.sources.setdefault(name, set()).update(origin)
        self.made.setdefault(name, set()).update(tops)

    def _of(self, node: ast.AST) -> set[int]:
        """Return the arguments that a value comes from."""
        if isinstance(node, ast.Name):
            return self.sources.get(node.id, set())
        if isinstance(node, ast.Attribute) and node.attr in (
            "shape",
            "size",
            "ndim",
            "dtype",
        ):
            return set()
        if isinstance(node, ast.BinOp) and (repeated := _repeated(node)):
            return self._of(repeated)
        if isinstance(node, ast.Call):
            called = _called(node)
            if called in SHAPES:
                return set()
            if called in self.functions:
                return {n for argument in node.args for n in self._of(argument)}
        return {n for child in ast.iter_child_nodes(node) for n in self._of(child)}

    def _origin(self, node: ast.AST) -> str:
        return ",".join(map(str, sorted(self._of(node))))

    def _tops(self, node: ast.AST) -> Iterator[str]:
        """Yield the operation that makes a value, seen through names, indices and conversions."""
        if isinstance(node, ast.Name):
            yield from self.made.get(node.id, set())
        elif isinstance(node, ast.Subscript | ast.Starred):
            yield from self._tops(node.value)
        elif isinstance(node, ast.List | ast.Tuple):
            for element in node.elts:
                yield from self._tops(element)
        elif isinstance(node, ast.ListComp | ast.GeneratorExp):
            yield from self._tops(node.elt)
        else:
            operations = [name for name, _ in self._operations(node)]
            yield from operations
            if not operations and isinstance(node, ast.Call):
                inner = [*node.args]
                if isinstance(node.func, ast.Attribute):
                    inner.append(node.func.value)
                for argument in inner:
                    yield from self._tops(argument)

    def _operations(self, node: ast.AST) -> Iterator[tuple[str, list[ast.AST]]]:
        """Yield the operations of a node, with the same names for loops and arrays."""
        if isinstance(node, ast.BinOp):
            if _repeated(node):
                return
            if isinstance(node.op, ast.MatMult):
                yield from _product([node.left, node.right])
            elif name := OPERATORS.get(type(node.op)):
                yield name, self._ordered(name, [node.left, node.right])
        elif isinstance(node, ast.AugAssign):
            name = OPERATORS.get(type(node.op), "")
            if name == "add":
                yield "sum", [node.value]
            elif name:
                yield name, self._ordered(name, [node.target, node.value])
        elif isinstance(node, ast.BoolOp):
            yield OPERATORS[type(node.op)], self._ordered("and", [*node.values])
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            if not isinstance(node.operand, ast.Constant):
                yield "neg", [node.operand]
        elif isinstance(node, ast.Compare):
            left: ast.AST = node.left
            for operator, right in zip(node.ops, node.comparators, strict=True):
                if type(operator) in COMPARISONS:
                    name, turned = COMPARISONS[type(operator)]
                    pair = [right, left] if turned else [left, right]
                    yield name, self._ordered(name, pair)
                left = right
        elif isinstance(node, ast.If | ast.IfExp | ast.While):
            yield "choose", [node.test]
        elif isinstance(node, ast.comprehension):
            for test in node.ifs:
                yield "choose", [test]
        elif isinstance(node, ast.Subscript):
            if self._of(node.slice):
                yield "at", [node.value, node.slice]
        elif isinstance(node, ast.Call):
            yield from self._call(node)
        elif isinstance(node, ast.Constant) and _telling(node.value):
            yield f"constant {node.value!r}"[:60], []
        elif isinstance(node, ast.Return) and node.value is not None:
            yield "return", [node.value]

    def _call(self, node: ast.Call) -> Iterator[tuple[str, list[ast.AST]]]:
        called = _called(node)
        name = ALIASES.get(called, called)
        operands: list[ast.AST] = [*node.args]
        if isinstance(node.func, ast.Attribute) and self._is_value(node.func.value):
            operands.insert(0, node.func.value)
        if name in PRODUCTS:
            yield from _product(
                [x for x in operands if not isinstance(x, ast.Constant)]
            )
        elif name == "mean" and operands:
            yield "sum", operands[:1]
            yield "div", [operands[0], ast.Constant(1)]
        elif name == "where" and len(operands) == 3:
            yield "choose", [operands[0]]
        elif name in KEPT and operands:
            given = [x for x in operands if not isinstance(x, ast.Constant)][:2]
            yield name, self._ordered(name, given)

    def _is_value(self, node: ast.AST) -> bool:
        """Whether a method is called of a value, and not a function of a module."""
        return not isinstance(node, ast.Name) or node.id in self.sources

    def _ordered(self, name: str, operands: list[ast.AST]) -> list[ast.AST]:
        """Return the operands, of an operation that may exchange them in a fixed order."""
        if name in ("add", "mul", "eq", "and", "or", "xor", "max", "min"):
            return sorted(operands, key=self._origin)
        return operands


def _product(factors: list[ast.AST]) -> Iterator[tuple[str, list[ast.AST]]]:
    """Yield a product and the sum over it."""
    if factors:
        first, last = cast(ast.expr, factors[0]), cast(ast.expr, factors[-1])
        yield "mul", sorted([first, last], key=ast.dump)
        yield "sum", [ast.BinOp(first, ast.Mult(), last)]


def _repeated(node: ast.BinOp) -> ast.List | None:
    """Return the list that is repeated a number of times, as in ``[0] * n``."""
    sides = (node.left, node.right) if isinstance(node.op, ast.Mult) else ()
    return next((side for side in sides if isinstance(side, ast.List)), None)


def _called(node: ast.Call) -> str:
    if isinstance(node.func, ast.Attribute):
        return node.func.attr
    return node.func.id if isinstance(node.func, ast.Name) else ""


def _telling(value: object) -> bool:
    """Whether a constant is not one that everybody writes."""
    if value is None or isinstance(value, bool):
        return False
    if isinstance(value, int | float | complex):
        return value not in (0, 1, 2, -1, 3)
    return isinstance(value, str)
