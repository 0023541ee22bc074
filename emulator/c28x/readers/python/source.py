"""A module in C-shaped Python: its text parsed, its declarations read, corrected functions laid over it."""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Callable, Set
from functools import lru_cache
from typing import Any, Final

from emulator.c28x.build.scope import BLOCK_NESTING, EXPRESSION_NESTING
from emulator.c28x.readers.python.declarations import ANCHOR, DeclarationReader
from emulator.c28x.readers.python.preprocessor import fixed_ids, preprocess
from emulator.c28x.readers.python.types import TypeReader
from emulator.c28x.symbols import Module, SourceError
from emulator.c28x.tree import Function, Variable

#: Finds the module that an import names, for the file that imports it.
Finder = Callable[[str, str], Module]


def new_module(name: str, file: str, text: str) -> Module:
    """A module without its declarations: a comment `# us.c: Read_Distance` names the C file that it mirrors."""
    anchors = ANCHOR.findall(text)
    return Module(name, file, text, anchors[0][0] if anchors else name.rsplit(".", 1)[-1] + ".c")


def read(module: Module, find: Finder) -> None:
    """Read the declarations of `module` from its text.  Raises SourceError."""
    tree = parse(module)
    DeclarationReader(module, tree, find).read()


def lay_over(base: Module, file: str, text: str, fixes: Set[str], find: Finder) -> None:
    """Put the corrected functions of an overlay in the place of the faithful ones; both share one scope.

    `FIXED` is looked at in what is laid over, and nowhere else.
    """
    overlay = Module(
        base.name, file, text, base.c_file, base.symbols, base.own, base.variables, base.functions, base.bodies,
        base.initialisers, base.remarks,
    )  # fmt: skip
    parsed = parse(overlay)
    known = {function.name for function in base.functions}
    body: list[ast.stmt] = []
    for node, ids in zip(parsed.body, _ids(file, text), strict=True):
        if isinstance(node, ast.FunctionDef) and node.name in known and not ids & fixes:
            continue
        body += _decided(overlay, node, fixes) if ids else [node]
    before = dict(base.symbols)
    DeclarationReader(overlay, ast.Module(body, []), find, overlay=True).read()
    for name in {**before, **base.symbols}:  # also what `del` took away behind a corrected function
        old, symbol = before.get(name), base.symbols.get(name)
        if old is symbol or not isinstance(symbol, Function | Variable | None):
            continue
        if symbol in base.functions or symbol in base.variables:
            base.units[name] = overlay
        if isinstance(old, Function) and old in base.functions:
            base.functions.remove(old)
        elif isinstance(old, Variable) and old in base.variables:
            base.variables.remove(old)


def parse(module: Module) -> ast.Module:
    """The syntax tree of a module's text, not to be changed: others read it too.

    Raises SourceError for what is not Python, or nests too deeply.
    """
    return (_kept if len(module.text) <= _KEPT_LENGTH else _parsed)(module.file, module.text)


def _decided(overlay: Module, node: ast.stmt, fixes: Set[str]) -> list[ast.stmt]:
    """A statement at file scope with every `FIXED` in it decided.  Raises SourceError."""
    try:
        return preprocess(ast.Module([_copy(node)], []), fixes).body
    except ValueError as error:
        message, place = error.args
        raise TypeReader(overlay).error(place, message) from None


def _copy(node: Any) -> Any:
    """A tree of its own."""
    if isinstance(node, list):
        return [_copy(inner) for inner in node]
    if not isinstance(node, ast.AST):
        return node
    copied = type(node)()
    for name, value in vars(node).items():
        setattr(copied, name, _copy(value) if isinstance(value, list | ast.AST) else value)
    return copied


@lru_cache(maxsize=32)
def _ids(file: str, text: str) -> list[frozenset[str]]:
    """The corrections that each statement at file scope mentions."""
    return [frozenset(fixed_ids(node)) for node in ast.parse(text, file).body]


def _parsed(file: str, text: str) -> ast.Module:
    module = new_module("", file, text)
    try:
        tree = ast.parse(text, file)
    except SyntaxError as error:
        message = f"not Python: {error.msg}"
        raise SourceError(module.file, error.lineno or 1, message, error.offset or 0) from None
    except ValueError as error:  # null bytes
        raise SourceError(module.file, 1, f"not Python: {error}") from None
    except (RecursionError, MemoryError):
        raise SourceError(module.file, _longest_line(module.text), _too_deep()) from None
    _check_nesting(module, tree)
    try:
        compile(tree, module.file, "exec", dont_inherit=True)  # finds what the grammar allows and Python does not
    except SyntaxError as error:
        message = f"not Python: {error.msg}"
        raise SourceError(module.file, error.lineno or 1, message, error.offset or 0) from None
    return tree


#: Texts whose trees are kept: those of an image, none of which is as long as this.
_kept = lru_cache(maxsize=48)(_parsed)
_KEPT_LENGTH: Final = 100_000


def _too_deep() -> str:
    return f"more than {EXPRESSION_NESTING} operators or calls nested within each other: use a local for a part"


def _check_nesting(module: Module, tree: ast.Module) -> None:
    """Refuse what nests more deeply than the translator follows."""
    waiting: list[tuple[ast.AST, int, int]] = [(tree, 0, 0)]
    while waiting:
        node, expressions, blocks = waiting.pop()
        expressions = expressions + 1 if isinstance(node, ast.expr) else 0
        blocks += isinstance(node, ast.If | ast.For | ast.While | ast.Match)
        if expressions > EXPRESSION_NESTING:
            raise TypeReader(module).error(node, _too_deep())
        if blocks > BLOCK_NESTING:
            message = f"more than {BLOCK_NESTING} blocks nested within each other: write a function"
            raise TypeReader(module).error(node, message)
        waiting.extend((inner, expressions, blocks) for inner in ast.iter_child_nodes(node))


def _longest_line(text: str) -> int:
    """Where the statement with the most words begins: the one that Python's parser gave up on, most likely."""
    longest = first = count = best = 0
    try:
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            first = first or token.start[0]
            count += 1
            if token.type == tokenize.NEWLINE:
                if count > longest:
                    longest, best = count, first
                first = count = 0
    except (tokenize.TokenError, SyntaxError):
        pass
    return best
