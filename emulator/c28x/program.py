"""The modules of a firmware image: how they are found, read, and overlaid with corrections.

A module is read, never imported.  Its text is parsed; its imports lead to other firmware modules and to headers
(modules whose functions are `@extern`); every name gets an entry in a table of symbols.  Files are found by their
paths, so no `__init__.py` is executed.  A reader is imported with the first file of its language; a program from the
cache needs none.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from emulator.c28x.ctypes import DOUBLE, FLOAT, INT, CType, FloatType
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import EnumType, Module, NoModule, NotAlike, SourceError
from emulator.c28x.tree import Function, Variable, Where

if TYPE_CHECKING:
    from emulator.c28x.readers.c.source import CFiles
    from emulator.c28x.readers.python.reach import Reach


class Program:
    """The modules asked for, and all modules that they lead to.

    `overlays`: module -> the module whose functions and objects replace those of the same name, if they concern one of
    the corrections in `fixes` (see `readers/python/preprocessor.py`).

    For C files: `include` are folders of headers (`-I`), `defines` macros (`-D`), `abi` is "coff" or "eabi".  `header`
    returns the text of a header that the project generates.  `instead`: module -> the C file that replaces it.
    `library` returns the name of the module that defines a function which a C file only declares.

    `like`: a translated program that differs only in its corrections.  What these do not reach is taken from it.
    """

    def __init__(
        self, names: Iterable[str] = (), *, overlays: Mapping[str, str] | None = None, fixes: Set[str] = frozenset(),
        include: Sequence[str | Path] = (), defines: Sequence[str] = (), abi: str = "coff",
        header: Callable[[str], str | None] = lambda name: None, instead: Mapping[str, str] | None = None,
        library: Callable[[str], str | None] = lambda name: None, like: Program | None = None,
    ) -> None:  # fmt: skip
        """Read the declarations.  Raises SourceError; NotAlike if `like` is of no use."""
        self.modules: dict[str, Module] = {}
        self.overlays = dict(overlays or {}) if fixes else {}
        self.fixes = fixes
        self.instead = dict(instead or {})
        self.library = library
        self._c_settings: dict[str, Any] = {"include": include, "defines": defines, "abi": abi, "header": header}
        self._c: CFiles | None = None
        self._bases = {overlay: base for base, overlay in self.overlays.items()}
        self._translated: set[Module] = set()
        #: The overlay of each module that has one.
        self._laid: dict[str, Module] = {}
        #: Function, or object with an initialiser -> the file-scope objects to which it makes a pointer.
        self._exposed: dict[Function | Variable, frozenset[Variable]] = {}
        self._like = like
        self._reached: Reach = {} if like is None else like.reached_by(self.fixes)
        for name in (*names, *self._reached):
            self.module(name)
        self.modules = {name: self.modules[name] for name in (*self._reached, *self.modules)}

    def reached_by(self, fixes: Set[str]) -> Reach:
        """For each module the names that may mean something else with `fixes`.

        Raises NotAlike for C files, and if most functions are among them.
        """
        from emulator.c28x.readers.python.reach import reach

        if self._c is not None:
            raise NotAlike

        def named(name: str, importer: str) -> str:
            return self._named(name, importer)[0]

        reached = reach([*self.modules.items(), *self._laid.items()], self.fixes ^ fixes, named)
        functions = [f.name in reached[name] for name, module in self.modules.items() for f in module.functions]
        if 2 * sum(functions) > len(functions):
            raise NotAlike
        return reached

    def module(self, name: str, importer: str = "") -> Module:
        """The module called `name`, or the one in the file `name` (`*.py`, `*.c`).  It is read on first use.

        The search begins in the folder of `importer`, the file that imports it, as with `#include "..."`.
        """
        name, file = self._named(name, importer)
        known = self.modules.get(name)
        if known is not None:
            if file is not None and known.file != str(file):
                raise ValueError(f"two modules are called {name}: {known.file} and {file}")
            return known
        if self._like is not None:
            return self._module_like(name, self._like)
        module = self.add(name, *_source(file or find_module(name)))
        if name in self.overlays and name not in self.instead:
            from emulator.c28x.readers.python import source as python

            file_and_text = _source(find_module(self.overlays[name]))
            self._laid[name] = python.lay_over(module, *file_and_text, self.fixes, self.module)
        return module

    def _named(self, name: str, importer: str) -> tuple[str, Path | None]:
        """The name of the module that `importer` calls `name`, and its file if that is known without a search."""
        file = _neighbour(name, importer)
        if file is not None and name.endswith(SUFFIXES):
            name = file.stem
        name = self._bases.get(name, name)
        if name in self.instead:
            file = Path(self.instead[name])
        return name, file

    def _module_like(self, name: str, like: Program) -> Module:
        """The module of `like`, with those names read again that this program's corrections reach."""
        old, names = like.modules[name], self._reached[name]
        if not names:
            self.modules[name] = old
            self._translated.add(old)
            return old
        from emulator.c28x.readers.python import source as python

        module = self.modules[name] = python.new_module(name, old.file, old.text)
        module.symbols |= {known: symbol for known, symbol in old.symbols.items() if known not in names}
        python.read(module, self.module, names)
        if name in like._laid:
            laid = like._laid[name]
            self._laid[name] = python.lay_over(module, laid.file, laid.text, self.fixes, self.module, names)
        python.take_over(module, old, self._laid.get(name), names)
        return module

    def add(self, name: str, file: str, text: str) -> Module:
        """Read a module from its text; the ending of `file` selects the reader.  Raises SourceError."""
        if file.lower().endswith(".c"):
            module = self.modules[name] = self.c_files().read(name, file, text)
            return module
        from emulator.c28x.readers.python import source as python

        module = python.new_module(name, file, text)
        self.modules[name] = module
        python.read(module, self.module)
        return module

    def c_files(self) -> CFiles:
        """The C files of the image.  Raises NoParser if the extra `[c]` is not installed."""
        if self._c is None:
            from emulator.c28x.readers.c.source import CFiles, CSettings

            def library(name: str) -> Module | None:
                wanted = self.library(name)
                if wanted is None:
                    return None
                new = wanted not in self.modules
                module = self.module(wanted)
                module.brought = module.brought or new
                return module

            def require(file: Path) -> None:
                if str(file) not in {module.file for module in self.modules.values()}:
                    self.add(f"{file.parent.name}.{file.stem}", *_source(file)).brought = True

            self._c = CFiles(CSettings(**self._c_settings), library, require)
        return self._c

    @reading(0)
    def translate(self) -> list[Module]:
        """Read every body and initialiser into its tree.  Returns the modules that define functions or objects.

        Raises SourceError for a construct outside the language; NotAlike if `like` is of no use.
        """
        if self._c is not None:
            self.modules |= {module.name: module for module in self._c.link(list(self.modules.values()))}
        firmware = [module for module in self.modules.values() if module.functions or module.variables]
        waiting = [module for module in firmware if module not in self._translated]
        objects = [variable for module in firmware for variable in module.variables] if self.overlays else []
        known = _exposed(objects)  # by the bodies of `like`
        try:
            for module in waiting:
                for function in module.functions:
                    if function in module.bodies:  # else it is taken from `like`
                        self._read_body(module, function)
                        self._exposed[function] = _exposed(objects)
            for module in waiting:
                for variable in module.variables:
                    if variable in module.initialisers:
                        variable.initial = module.initialisers[variable]()
                        self._exposed[variable] = _exposed(objects)
        finally:
            for variable in known:
                variable.escapes = True
        self._expose(firmware, known)
        self._translated.update(waiting)
        return firmware

    def _read_body(self, module: Module, function: Function) -> None:
        try:
            module.bodies[function]()
        except RecursionError:
            message = f"{function.name} nests too deeply to be translated: use locals, or a function for a part"
            raise SourceError(module.unit(function.name).file, function.line, message) from None

    def _expose(self, firmware: list[Module], known: Set[Variable]) -> None:
        """Mark the objects that bodies and initialisers expose.  Raises NotAlike if others of `like` are marked."""
        if self._like is not None:
            own = {each for module in firmware for each in (*module.functions, *module.variables)}
            everything = self._like._exposed | self._exposed
            self._exposed = {each: exposed for each, exposed in everything.items() if each in own}
        exposed = {variable for each in self._exposed.values() for variable in each}
        if self._like is not None:
            theirs = {variable for module in self._like.modules.values() for variable in module.variables}
            if exposed & theirs != known:
                raise NotAlike
        for variable in exposed - known:
            variable.escapes = True

    def digests(self) -> dict[str, str]:
        """The digest of every file that was read, and of the folders in which C headers were searched."""
        units = [unit for module in self.modules.values() for unit in (module, *module.units.values())]
        names = {unit.file for unit in units}
        if self._c is not None:
            names |= self._c.searched_paths()
        return {name: digest(name) for name in sorted(names) if not name.startswith("<")}

    @property
    def double(self) -> FloatType:
        """What its C files call `double`, which depends on the ABI."""
        return DOUBLE if any(module.double == DOUBLE for module in self.modules.values()) else FLOAT

    def __getstate__(self) -> dict[str, Any]:
        """The state of a translated program: only its modules."""
        return {"modules": self.modules}


def _exposed(objects: list[Variable]) -> frozenset[Variable]:
    """The objects that were exposed since the last call."""
    found = frozenset(variable for variable in objects if variable.escapes)
    for variable in found:
        variable.escapes = False
    return found


def digest(name: str) -> str:
    """A digest of the content of a file, or of the names in a folder; empty if it cannot be read."""
    try:
        content = "\n".join(sorted(os.listdir(name))).encode() if os.path.isdir(name) else Path(name).read_bytes()
    except OSError:
        return ""
    return hashlib.sha256(content).hexdigest()


#: The folder of Python's standard library.
_LIBRARY: Final = Path(os.__file__).resolve().parent
#: Endings of files with a reader of their own.
SUFFIXES: Final = (".py", ".c", ".C")


def find_module(name: str) -> Path:
    """The file of an importable module, found without an import.  Raises NoModule.

    The search of Python itself would execute the `__init__.py` of every package on the way.
    """
    top, *rest = name.split(".")
    for folder in folders(top):
        path = folder.joinpath(*rest)
        for file in (path / "__init__.py", path.with_name(f"{path.name}.py")) if rest else (path / "__init__.py",):
            if file.is_file():
                return _of_firmware(name, file.resolve())
    for entry in sys.path if not rest else ():
        file = Path(entry, f"{top}.py")
        if file.is_file():
            return _of_firmware(name, file.resolve())
    if top in sys.stdlib_module_names:
        raise NoModule(f"{name} is a module of Python's library: nothing of it runs on the chip")
    raise NoModule(f"no module {name}: a firmware module must be importable, or be named by its file")


def _of_firmware(name: str, file: Path) -> Path:
    """`file`, the file of module `name`.  Raises NoModule for a module of Python's own library."""
    if name.split(".", 1)[0] in sys.stdlib_module_names and _LIBRARY in file.parents:
        raise NoModule(f"{name} is a module of Python's library: nothing of it runs on the chip")
    return file


def folders(package: str) -> list[Path]:
    """The folders of a top-level package."""
    known = sys.modules.get(package)
    if known is not None:
        return [Path(folder) for folder in getattr(known, "__path__", ())]
    try:
        spec = importlib.util.find_spec(package)  # a name without dots: this executes no code of the package
    except (ImportError, ValueError):
        spec = None
    return [Path(folder) for folder in (spec.submodule_search_locations or ())] if spec is not None else []


def _source(file: Path) -> tuple[str, str]:
    """File name and text.  C may be Latin-1, as Windows writes it.  Raises SourceError for Python that is not UTF-8."""
    try:
        return str(file), file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        if file.suffix.lower() == ".c":
            return str(file), file.read_text(encoding="latin-1")
        before = file.read_bytes()[: error.start]
        where = Where(str(file), before.count(b"\n") + 1, len(before) - before.rfind(b"\n"))
        raise SourceError.at(where, "not UTF-8 text: save the file as UTF-8") from None


def _neighbour(name: str, importer: str) -> Path | None:
    """The file called `name`, or the file of module `name` beside `importer`; None: there is none.  Raises NoModule."""
    if name.endswith(SUFFIXES):
        file = Path(name).resolve()
        if not file.is_file():
            raise NoModule(f"no file {name}")
        return file
    file = Path(importer).parent / f"{name.replace('.', '/')}.py"
    return file.resolve() if importer and file.is_file() else None


def type_named(program: Program, name: str) -> CType | None:
    """The type called `name` in any module: a structure, a union, a typedef; an enumeration is an int."""
    for module in program.modules.values():
        symbol = module.symbols.get(name)
        if isinstance(symbol, CType):
            return symbol
        if isinstance(symbol, EnumType):
            return INT
    return None
