"""Programs wrong in a single point: what ``mutation_campaign`` lets loose on the tests."""

from __future__ import annotations

import ast
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

_COMPARISONS: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn,
    ast.NotIn: ast.In}
_OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Add, ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd, ast.BitXor: ast.BitAnd, ast.LShift: ast.RShift, ast.RShift: ast.LShift}
_FUNCTIONS = {"any": "all", "all": "any", "min": "max", "max": "min"}

#: A constant shows what it is by the expression around it, where it is one of these.
_TELLING = (ast.BinOp, ast.Compare, ast.Call, ast.keyword, ast.Subscript, ast.Slice, ast.UnaryOp)

#: What stands in these is for people, or for the type checker.
_NOT_RUN = (ast.JoinedStr, ast.Raise, ast.Assert)


@dataclass(frozen=True)
class Mutant:
    """One point of a file made wrong.

    ``file``    its path from the root of the project
    ``line``    and ``text``, that line as it is
    ``change``  what was changed to what
    ``key``     tells it from all others, and stays when lines are added or removed elsewhere
    """

    file: str
    line: int
    text: str
    change: str
    key: str
    _place: tuple[int, int] = field(repr=False)  # in the file's bytes
    _wrong: str = field(repr=False)

    def of(self, source: bytes) -> bytes:
        """The whole file, wrong."""
        begin, end = self._place
        return source[:begin] + self._wrong.encode() + source[end:]


def mutants_of(root: Path, file: str) -> list[Mutant]:
    """Every mutant of a Python file, in the order of the text."""
    return list(_File(file, (root / file).read_bytes()).mutants())


class _File:
    def __init__(self, file: str, source: bytes) -> None:
        self._file = file
        self._lines = source.splitlines(keepends=True)
        self._begins = [0]
        for line in self._lines:
            self._begins.append(self._begins[-1] + len(line))
        self._tree = ast.parse(source)
        self._parents = {child: parent for parent in ast.walk(self._tree)
                         for child in ast.iter_child_nodes(parent)}
        self._made = Counter[str]()

    def mutants(self) -> Iterator[Mutant]:
        for node in self._run(self._tree):
            yield from self._of(node)

    def _run(self, node: ast.AST) -> Iterator[ast.AST]:
        """The node and all below it that has a meaning when the program runs."""
        match node:
            case ast.keyword("reset_less" | "frozen", ast.Constant(value=True)):
                return  # no fault: reset where it need not be, or what nobody changes
        yield node
        for name, value in ast.iter_fields(node):
            if name in ("annotation", "returns"):
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and not isinstance(child, _NOT_RUN):
                    yield from self._run(child)

    def _of(self, node: ast.AST) -> Iterator[Mutant]:
        match node:
            case ast.Constant(value=bool() as value):
                yield self._constant(node, not value)
            case ast.Constant(value=int() as value):
                yield self._constant(node, value + 1)
                if value:
                    yield self._constant(node, value - 1)
            case ast.Compare(left, operators, others):
                for place, (operator, other) in enumerate(zip(operators, others, strict=True)):
                    these = [*operators[:place], _COMPARISONS[type(operator)](),
                             *operators[place + 1:]]
                    yield self._mutant(node, ast.Compare(left, these, others), other.lineno)
            case ast.BinOp(left, operator, right) if type(operator) in _OPERATORS:
                wrong = ast.BinOp(left, _OPERATORS[type(operator)](), right)
                yield self._mutant(node, wrong, right.lineno)
            case ast.BoolOp(operator, values):
                opposite = ast.Or() if isinstance(operator, ast.And) else ast.And()
                yield self._mutant(node, ast.BoolOp(opposite, values), values[1].lineno)
            case ast.UnaryOp(ast.Invert() | ast.Not() | ast.USub(), operand):
                yield self._mutant(node, operand, node.lineno)
            case ast.If(test=test) | ast.IfExp(test=test):
                for always in (True, False):
                    yield self._mutant(test, ast.Constant(always), test.lineno)
            case ast.Call():
                yield from self._of_call(node)

    def _of_call(self, call: ast.Call) -> Iterator[Mutant]:
        match call:
            case ast.Call(ast.Attribute(_, "If" | "Elif"), [test]):
                for always in (1, 0):
                    yield self._mutant(test, ast.Constant(always), test.lineno)
            case ast.Call(ast.Name("Mux") as name, [choice, one, other]):
                yield self._mutant(call, ast.Call(name, [choice, other, one], []), call.lineno)
            case ast.Call(ast.Name(name), arguments, keywords) if name in _FUNCTIONS:
                wrong = ast.Call(ast.Name(_FUNCTIONS[name]), arguments, keywords)
                yield self._mutant(call, wrong, call.lineno)
            case ast.Call(ast.Attribute(value, "any" | "all" as name), [], []):
                wrong = ast.Call(ast.Attribute(value, _FUNCTIONS[name]), [], [])
                yield self._mutant(call, wrong, call.lineno)
            case ast.Call(ast.Attribute(_, "eq")):
                # An assignment of hardware, left out.
                parent = self._parents[call]
                if isinstance(parent, ast.List):
                    yield self._mutant(call, ast.Starred(ast.Tuple([])), call.lineno)
                elif isinstance(parent, ast.AugAssign):
                    yield self._mutant(call, ast.List([]), call.lineno)

    def _constant(self, node: ast.Constant, value: int) -> Mutant:
        parent = self._parents[node]
        if not isinstance(parent, _TELLING):
            return self._mutant(node, ast.Constant(value), node.lineno)
        right = ast.unparse(parent)
        before, node.value = node.value, value
        try:
            wrong = ast.unparse(parent)
        finally:
            node.value = before
        return self._mutant(node, ast.Constant(value), node.lineno, f"{right} → {wrong}")

    def _mutant(self, node: ast.expr, wrong: ast.expr, line: int, change: str = "") -> Mutant:
        text = ast.unparse(wrong)
        begin = self._begins[node.lineno - 1] + node.col_offset
        assert node.end_lineno is not None and node.end_col_offset is not None
        end = self._begins[node.end_lineno - 1] + node.end_col_offset
        change = change or f"{ast.unparse(node)} → {text}"
        line_text = self._lines[line - 1].decode().strip()
        key = f"{self._file}: {line_text}: {change}"
        self._made[key] += 1
        return Mutant(self._file, line, line_text, change, f"{key} ({self._made[key]})",
                      (begin, end), text if isinstance(wrong, ast.Starred) else f"({text})")
