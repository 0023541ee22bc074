"""The modules of a firmware image: found, read and laid over, each with the declarations of its file.

A module is read, not imported: its text is parsed, its imports are followed to other firmware modules and to headers
(modules whose functions are `@extern`), and every name ends in a table of symbols.
"""

from __future__ import annotations

import ast
import importlib.util
from collections.abc import Iterable, Mapping, Set
from pathlib import Path

from emulator.c28x.ctypes import StructType
from emulator.c28x.declarations import ANCHOR, DeclarationReader
from emulator.c28x.preprocessor import fixed_ids, preprocess
from emulator.c28x.symbols import Module, NoModule, SourceError
from emulator.c28x.tree import Function, Variable


class Program:
    """All modules reachable from the ones asked for.

    `overlays` names, for a module, the module whose functions and objects replace those of the same name, as far as
    they concern one of the corrections in `fixes` (see `preprocessor.py`).
    """

    def __init__(
        self, names: Iterable[str] = (), *, overlays: Mapping[str, str] | None = None, fixes: Set[str] = frozenset()
    ) -> None:
        self.modules: dict[str, Module] = {}
        self.overlays = dict(overlays or {}) if fixes else {}
        self.fixes = fixes
        self._bases = {overlay: base for base, overlay in self.overlays.items()}
        for name in names:
            self.module(name)

    def module(self, name: str, beside: str = "") -> Module:
        """The module called `name`, or in the file `name` (`*.py`), read on first use.

        As with `#include "..."`, the folder of the file `beside`, which asks for it, is looked in first.
        """
        file = _neighbour(name, beside)
        if file is not None and name.endswith(".py"):
            name = file.stem
        name = self._bases.get(name, name)
        known = self.modules.get(name)
        if known is not None:
            if file is not None and known.file != str(file):
                raise ValueError(f"two modules are called {name}: {known.file} and {file}")
            return known
        module = self.add(name, *(_source(name) if file is None else (str(file), file.read_text(encoding="utf-8"))))
        if name in self.overlays:
            self._lay_over(module, *_source(self.overlays[name]))
        return module

    def _lay_over(self, base: Module, file: str, text: str) -> None:
        """Put the corrected functions in the place of the faithful ones; both share one scope."""
        tree = _parse(file, text)
        concerned = {
            node.name
            for node in tree.body
            if isinstance(node, ast.FunctionDef) and (node.name not in base.bodies or fixed_ids(node) & self.fixes)
        }
        try:
            tree = preprocess(tree, self.fixes)
        except ValueError as error:
            message, node = error.args
            raise SourceError(file, node.lineno, message) from None
        tree.body = [node for node in tree.body if not isinstance(node, ast.FunctionDef) or node.name in concerned]
        overlay = Module(
            base.name, file, text, tree, base.c_file, base.symbols, base.variables, base.functions, base.bodies
        )
        before = dict(base.symbols)
        DeclarationReader(overlay, self.module, overlay=True).read()
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

    def add(self, name: str, file: str, text: str) -> Module:
        """Read a module from its text.  Raises SourceError."""
        tree = _parse(file, text)
        anchors = ANCHOR.findall(text)
        c_file = anchors[0][0] if anchors else name.rsplit(".", 1)[-1] + ".c"
        module = Module(name, file, text, tree, c_file)
        self.modules[name] = module
        DeclarationReader(module, self.module).read()
        return module


def _source(name: str) -> tuple[str, str]:
    """File and text of an importable module.  Raises ValueError."""
    try:
        spec = importlib.util.find_spec(name)
    except ModuleNotFoundError:
        spec = None
    if spec is None or spec.origin is None or not spec.has_location:
        raise NoModule(f"no module {name}: a firmware module must be importable, or be named by its file")
    with open(spec.origin, encoding="utf-8") as source:
        return spec.origin, source.read()


def _neighbour(name: str, beside: str) -> Path | None:
    """The file that `name` is, or that stands for it in the folder of `beside`; None if there is none."""
    if name.endswith(".py"):
        file = Path(name).resolve()
        if not file.is_file():
            raise NoModule(f"no file {name}")
        return file
    file = Path(beside).parent / f"{name.replace('.', '/')}.py"
    return file.resolve() if beside and file.is_file() else None


def _parse(file: str, text: str) -> ast.Module:
    try:
        tree = ast.parse(text, file)
        compile(tree, file, "exec", dont_inherit=True)  # finds what the grammar allows and Python does not
        return tree
    except SyntaxError as error:
        raise SourceError(file, error.lineno or 0, f"not Python: {error.msg}") from None


def struct_named(program: Program, name: str) -> StructType | None:
    """The structure called `name` in any module."""
    for module in program.modules.values():
        symbol = module.symbols.get(name)
        if isinstance(symbol, StructType):
            return symbol
    return None
