"""A module in C-shaped Python: parse its text, read its declarations, apply an overlay of corrections."""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Callable, Set
from functools import lru_cache
from typing import Any, Final

from emulator.c28x.build.scope import BLOCK_NESTING, EXPRESSION_NESTING
from emulator.c28x.readers.python.declarations import ANCHOR, PythonDeclarationReader
from emulator.c28x.readers.python.hints import spelling
from emulator.c28x.readers.python.preprocessor import fixed_ids, preprocess
from emulator.c28x.readers.python.reach import declared
from emulator.c28x.readers.python.types import PythonTypeReader, source_lines
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import Module, SourceError
from emulator.c28x.tree import Function, Variable

#: The most terms of a sum: with more, Python's parser needs more stack than some systems have.
LONGEST_SUM: Final = 6000
#: The most `elif`s of an `if`: with many more, Python's parser fails.
LONGEST_CHAIN: Final = 1000
#: (name, importing file) -> the module that an import names.
Finder = Callable[[str, str], Module]


def new_module(name: str, file: str, text: str) -> Module:
    """A module without its declarations.  A comment `# us.c: Read_Distance` in it names the C file that it mirrors."""
    anchors = ANCHOR.findall(text)
    return Module(name, file, text, anchors[0][0] if anchors else name.rsplit(".", 1)[-1] + ".c")


def read(module: Module, find: Finder, names: Set[str] | None = None) -> None:
    """Read the declarations of `module` from its text, or only those of `names`.  Raises SourceError."""
    tree = parse(module)
    if names is not None:
        tree = ast.Module(_about(tree.body, names), [])
    PythonDeclarationReader(module, tree, find).read()


def _about(body: list[ast.stmt], names: Set[str]) -> list[ast.stmt]:
    """The statements at file scope that declare one of `names`; imports only of these."""
    found: list[ast.stmt] = []
    for node in body:
        match node:
            case ast.ImportFrom(module=module, names=aliases, level=level):
                wanted = [alias for alias in aliases if alias.name == "*" or (alias.asname or alias.name) in names]
                if wanted:
                    found.append(ast.copy_location(ast.ImportFrom(module, wanted, level), node))
            case ast.If(test=test, body=inner) if not declared(node):  # if TYPE_CHECKING
                found.append(ast.copy_location(ast.If(test, _about(inner, names), []), node))
            case _ if not declared(node).isdisjoint(names):
                found.append(node)
    return found


def lay_over(
    base: Module, file: str, text: str, fixes: Set[str], find: Finder, names: Set[str] | None = None
) -> Module:  # fmt: skip
    """Replace faithful functions by the corrected ones of an overlay, or only those of `names`; returns the overlay.

    Both share one scope.  `FIXED` has an effect only in the overlay.
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
        for each in [node] if names is None else _about([node], names):
            body += _decided(overlay, each, fixes) if ids else [each]
    before = dict(base.symbols)
    PythonDeclarationReader(overlay, ast.Module(body, []), find, overlay=True).read()
    for name in {**before, **base.symbols}:  # also names that a `del` after a corrected function removes
        old, symbol = before.get(name), base.symbols.get(name)
        if old is symbol or not isinstance(symbol, Function | Variable | None):
            continue
        if symbol in base.functions or symbol in base.variables:
            base.units[name] = overlay
            if name not in before:
                base.added.add(name)
        if isinstance(old, Function) and old in base.functions:
            base.functions.remove(old)
        elif isinstance(old, Variable) and old in base.variables:
            base.variables.remove(old)
    return overlay


def take_over(module: Module, old: Module, overlay: Module | None, names: Set[str]) -> None:
    """Complete `module`, of which only `names` were read, with the rest of `old`: it is in the order of the source."""
    kept = {name: symbol for name, symbol in old.symbols.items() if name not in names}
    for name in module.symbols.keys() - kept.keys() - names:  # an import brings it, and a correction deletes it
        del module.symbols[name]
    module.symbols.update(kept)
    if overlay is not None:
        module.units |= {name: overlay for name in old.units if name not in names}
    module.added |= old.added - names
    module.remarks += [r for r in old.remarks if names.isdisjoint((r.name, r.function))]

    def place(name: str, line: int, column: int = 0) -> tuple[bool, int, int]:
        return name in module.units, line, column

    module.functions += [function for function in old.functions if function.name not in names]
    module.functions.sort(key=lambda f: place(f.name, f.line))
    module.variables += [v for v in old.variables if _of(v) not in names]
    module.variables.sort(
        key=lambda v: (v.declaration.function != "", *place(_of(v), v.declaration.line, v.declaration.column))
    )


def _of(variable: Variable) -> str:
    """The name at file scope with which an object is declared: a `static` local is declared with its function."""
    return variable.declaration.function or variable.declaration.name


def parse(module: Module) -> ast.Module:
    """The syntax tree of a module's text.  It is shared, so it must not be changed.

    Raises SourceError for text that is not Python, or nests too deeply.
    """
    return _tree(module.file, module.text)


def _tree(file: str, text: str) -> ast.Module:
    return (_kept if len(text) <= _KEPT_LENGTH else _read)(file, text)


def _decided(overlay: Module, node: ast.stmt, fixes: Set[str]) -> list[ast.stmt]:
    """A statement at file scope with every `FIXED` in it decided.  Raises SourceError."""
    try:
        return preprocess(ast.Module([_copy(node)], []), fixes).body
    except ValueError as error:
        message, place = error.args
        raise PythonTypeReader(overlay).error(place, message) from None


def _copy(node: Any) -> Any:
    """A deep copy of a tree."""
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
    return [frozenset(fixed_ids(node)) for node in _tree(file, text).body]


def _read(file: str, text: str) -> ast.Module:
    module = new_module("", file, text)
    for number, line in enumerate(source_lines(module.text), 1):
        if "\0" in line:
            message = "not Python: a character of value 0 is no text"
            raise SourceError(module.file, number, message, line.index("\0") + 1)
    try:
        try:
            return _parsed(module)
        except RecursionError:  # it may be only a long sum
            with reading(LONGEST_SUM // 3):
                return _parsed(module)
    except SyntaxError as error:
        number = max(1, error.lineno or 1)
        lines = source_lines(module.text)
        message = f"not Python: {error.msg}{spelling(lines[min(number, len(lines)) - 1], error.msg)}"
        raise SourceError(module.file, number, message, max(1, error.offset or 1)) from None
    except SourceError:
        raise
    except ValueError as error:  # such as half of a surrogate pair
        raise SourceError(module.file, 1, f"not Python: {error}", 1) from None
    except (RecursionError, MemoryError):
        number = _long_chain(module.text)
        if number:
            raise SourceError(module.file, number, _too_long(), 1) from None
        raise SourceError(module.file, _longest_line(module.text), _too_deep(), 1) from None


def _parsed(module: Module) -> ast.Module:
    tree = ast.parse(module.text, module.file)
    _check_nesting(module, tree)
    try:
        compile(tree, module.file, "exec", dont_inherit=True)  # finds errors that the grammar does not
    except RecursionError:
        compile(module.text, module.file, "exec", dont_inherit=True)  # a text may be three times as deep as a tree
    return tree


#: A cache of trees, for texts up to this length: no text of an image is as long.
_kept = lru_cache(maxsize=48)(_read)
_KEPT_LENGTH: Final = 100_000


def _inner(node: ast.AST) -> list[ast.AST]:
    """The nodes directly below a node."""
    found: list[ast.AST] = []
    for value in vars(node).values():
        if isinstance(value, list):
            found += [inner for inner in value if isinstance(inner, ast.AST)]
        elif isinstance(value, ast.AST):
            found.append(value)
    return found


def _too_long() -> str:
    return f"an if with more than {LONGEST_CHAIN} elif: write a match, or a table and a loop"


def _long_chain(text: str) -> int:
    """The line of the first `elif` with too many before it; 0 if there is none."""
    chains: dict[int, int] = {}  # indentation -> elifs of the `if` there
    for number, line in enumerate(source_lines(text), 1):
        code = line.lstrip(" \t")
        if not code or code.startswith("#"):
            continue
        depth, goes_on = len(line) - len(code), code.startswith("elif")
        chains = {d: n for d, n in chains.items() if d < depth or (d == depth and goes_on)}
        if goes_on:
            chains[depth] = chains.get(depth, 0) + 1
            if chains[depth] > LONGEST_CHAIN:
                return number
    return 0


def _too_deep() -> str:
    return f"more than {EXPRESSION_NESTING} operators or calls nested within each other: use a local for a part"


def _check_nesting(module: Module, tree: ast.Module) -> None:
    """Raises SourceError for a tree that nests more deeply than the translator supports."""
    waiting: list[tuple[ast.AST, int, int, int]] = [(tree, 0, 0, 0)]
    while waiting:
        node, expressions, blocks, chained = waiting.pop()
        expressions = expressions + 1 if isinstance(node, ast.expr) else 0
        blocks += isinstance(node, ast.If | ast.For | ast.While | ast.Match)
        chained = chained + 1 if isinstance(node, ast.If) else 0
        if chained > LONGEST_CHAIN + 1:  # the `if` itself is not an elif
            raise PythonTypeReader(module).error(node, _too_long())
        if expressions > EXPRESSION_NESTING:
            raise PythonTypeReader(module).error(node, _too_deep())
        if blocks > BLOCK_NESTING:
            message = f"more than {BLOCK_NESTING} blocks nested within each other: write a function"
            raise PythonTypeReader(module).error(node, message)
        for inner in _inner(node):
            on = isinstance(node, ast.BinOp) and inner is node.left and isinstance(inner, ast.BinOp)
            goes_on = isinstance(node, ast.If) and len(node.orelse) == 1 and inner is node.orelse[0]
            # The terms of a sum are not deeper than the sum; an elif is not deeper than its if.
            elif_ = goes_on and isinstance(inner, ast.If)
            waiting.append((inner, expressions - on, blocks - elif_, chained if elif_ else 0))


def _longest_line(text: str) -> int:
    """The first line of the statement with the most tokens: most likely the one on which Python's parser failed."""
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
    return max(1, best)
