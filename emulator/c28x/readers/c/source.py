"""A C file (preprocessed, parsed, its declarations read), and the names that several files share."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from emulator.c28x import build
from emulator.c28x.readers.c import headers
from emulator.c28x.readers.c.includes import Refused
from emulator.c28x.readers.c.kernel_headers import kernel
from emulator.c28x.readers.c.library_headers import OF_FLOAT, library
from emulator.c28x.readers.c.neighbour_files import NeighbourFiles
from emulator.c28x.readers.c.preprocessor import PreprocessorOptions, Unit, preprocess, preprocess_text
from emulator.c28x.readers.c.register_types import device
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import Module, Remark, SourceError, Symbol
from emulator.c28x.tree import Function, Variable, Where

if TYPE_CHECKING:
    from pycparser import c_ast

    from emulator.c28x.readers.c.declarations import CDeclarationReader

#: Frames for the deepest function; nested constructs have their own limits.
_FRAMES: Final = 8_000
#: Pragmas that place code or data.
_PLACING: Final = ("CODE_SECTION", "DATA_SECTION", "DATA_ALIGN", "SET_CODE_SECTION", "SET_DATA_SECTION", "LOCATION")


@dataclass(frozen=True)
class CSettings:
    """How C files are read: `-I`, `-D`, the ABI, and headers that the project generates."""

    include: Sequence[str | Path] = ()
    defines: Sequence[str] = ()
    #: "coff": `.bss` is not cleared, and double has 32 bits; "eabi": it is cleared, and double has 64 bits.
    abi: str = "coff"
    #: Name -> the text of a header that the project generates, if no folder has that header; None: not one of these.
    header: Callable[[str], str | None] = lambda name: None

    def __post_init__(self) -> None:
        if self.abi not in ("coff", "eabi"):
            raise ValueError(f"no ABI {self.abi}: coff or eabi")

    def options(self) -> PreprocessorOptions:
        """The options for the preprocessor."""
        return PreprocessorOptions(
            include=self.include, defines=self.defines, builtin=headers.of_the_device, fallback=self._last,
            standard=headers.of_c_itself, eabi=self.abi == "eabi",
        )  # fmt: skip

    def _last(self, name: str) -> str | None:
        """The text of a header that no folder has; None: there is none.  Raises Refused if the reason is known."""
        text = self.header(name) or headers.text(name)
        if text is None and (why := headers.hint(name)) is not None:
            raise Refused(why)
        return text


@dataclass
class CFile:
    """A C file that has been read."""

    module: Module
    reader: CDeclarationReader
    unit: Unit

    def undefined_names(self) -> set[str]:
        """Names that the file, or a header that is not ours, uses and that the file only declares."""
        used = {token.text for token in self.unit.tokens if not token.source.file.startswith("<")}
        return used & set(self.reader.linkage.declared)

    def asked_names(self) -> set[str]:
        """The undefined names without objects that the text only declares: a header may declare many."""
        names = self.undefined_names()
        objects = {name for name in names if isinstance(self.module.symbols.get(name), Variable)}
        counted = Counter(token.text for token in self.unit.tokens if token.text in objects)
        return names - {name for name, times in counted.items() if times == 1}


@dataclass
class CFiles:
    """The C files of an image, and the Python modules that define what they only declare."""

    settings: CSettings
    #: Reads the module that defines a library function; None: there is none.
    libraries: Callable[[str], Module | None] = lambda name: None
    #: Reads a C file that lies beside headers.
    bring: Callable[[Path], object] = lambda file: None
    files: dict[str, CFile] = field(default_factory=dict)
    _linked: int = 0
    _neighbours: NeighbourFiles = field(init=False)

    def __post_init__(self) -> None:
        self._neighbours = NeighbourFiles(self.settings.include)

    def searched_paths(self) -> set[str]:
        """The files that were read, and the folders in which headers were searched."""
        files = {file for read in self.files.values() for file in read.unit.files}
        return files | {str(Path(file).parent) for file in files} | {str(folder) for folder in self._neighbours.folders}

    def read(self, name: str, file: str, text: str | None = None) -> Module:
        """Read a C file; `text` is used if there is no file.  Raises SourceError; NoParser without pycparser."""
        options = self.settings.options()
        unit = preprocess(file, options) if text is None or Path(file).is_file() else (
            preprocess_text(text, file, options)
        )
        from emulator.c28x.readers.c.parser import parse

        try:
            tree = parse(unit.tokens)
        except SourceError as error:
            raise _hinted(error) from None
        from emulator.c28x.readers.c.declarations import CDeclarationReader
        from emulator.c28x.readers.c.types import Abi

        short = Path(file).name
        abi = Abi(self.settings.abi == "eabi")
        module = Module(name, file, text or "", short, double=abi.double)
        reader = CDeclarationReader(module, abi, self.find)
        self.files[name] = CFile(module, reader, unit)
        _remark_preprocessing(module, unit, tree)
        with reading(_FRAMES):
            try:
                reader.read(tree)
            except RecursionError:
                raise SourceError(file, 1, "a declaration nests too deeply to be translated") from None
        _mark_interrupts(module, unit)
        _fill_shared(module, unit)
        return module

    def find(self, name: str) -> Function | None:
        """The function `name` of this image, wherever it is defined; None: there is none."""
        for file in self.files.values():
            if name in file.reader.linkage.defined:
                symbol = file.module.symbols[name]
                if isinstance(symbol, Function):
                    return symbol
        module = _module_of_emulator(name) or self.libraries(name)
        found = module.symbols.get(name) if module is not None else None
        if isinstance(found, Function):
            return found
        return self.find(OF_FLOAT[name]) if name in OF_FLOAT else None

    def link(self, others: Iterable[Module]) -> list[Module]:
        """Resolve each name that a file only declares to its definition in another file, module or header.

        Returns the modules that this adds: definitions for our headers.  Raises SourceError for a name that two files
        define, and for an object that a file itself declares and none defines.
        """
        if self._linked == len(self.files):
            return []
        self._add_neighbour_files()
        added = self._behind_headers()
        self._linked = len(self.files)
        defined: dict[str, CFile] = {}
        for file in self.files.values():
            for name, where in file.reader.linkage.defined.items():
                first = defined.setdefault(name, file)
                if first is file or _one_object(first.module, file.module, name):
                    continue
                if not _inline(first, file, name):
                    at = first.reader.linkage.defined[name]
                    raise SourceError.at(where, f"{name} is defined twice: also at {at}")
        python = [module for module in others if module.name not in self.files]
        for file in self.files.values():
            undefined_names = file.undefined_names()
            for name, where in file.reader.linkage.declared.items():
                if name in file.reader.linkage.static:
                    used = file.module.symbols[name]
                    if isinstance(used, Function):
                        continue
                self._resolve(file, name, where, defined, python, used=name in undefined_names)
        return added

    def _add_neighbour_files(self) -> None:
        """Read C files beside headers if they define what the files use and none defines; repeat for these files."""
        asked: set[str] = set()
        while True:
            defined = {name for file in self.files.values() for name in file.reader.linkage.defined}
            names = {name for file in self.files.values() for name in file.asked_names()} - defined - asked
            if not names:
                return
            asked |= names
            # Sorted: a library reads the module that defines a name, and modules are linked in the order they are read.
            known = [n for n in sorted(names) if _module_of_emulator(n) is None and headers.definitions(n) is None]
            files = {self._neighbours.file(name) for name in known if self.libraries(name) is None}
            for path in sorted(path for path in files if path is not None):
                self.bring(path)

    def _behind_headers(self) -> list[Module]:
        """Read the definitions of names that our headers only declare, if the files use but do not define them."""
        defined = {name for file in self.files.values() for name in file.reader.linkage.defined}
        undefined_names = {name for file in self.files.values() for name in file.undefined_names()} - defined
        added = dict(filter(None, map(headers.definitions, sorted(undefined_names))))
        return [self.read(name, f"<{name}.c>", text) for name, text in added.items()]

    def _resolve(
        self, file: CFile, name: str, where: Where, defined: dict[str, CFile], python: Sequence[Module], *, used: bool
    ) -> None:  # fmt: skip
        mine = file.module.symbols[name]
        found: Symbol | None
        address = headers.linker_address(name)
        if isinstance(mine, Variable) and name not in defined and used and address is not None:
            # The linker defines it.  It has no type: each file declares one, and only uses the address.
            mine.address = address
            file.module.variables.append(mine)
            return
        if name in defined:
            found = defined[name].module.symbols[name]
        else:
            found = next((m.symbols[name] for m in python if name in m.own and name in m.symbols), None)
            if found is None and (used or _module_of_emulator(name)):  # a linker takes only what is used from a library
                found = self.find(name)
        if isinstance(mine, Function) and isinstance(found, Function):
            self._compare(file, mine, found, where)
            file.module.symbols[name] = found
        elif isinstance(mine, Variable) and isinstance(found, Variable):
            from emulator.c28x.readers.c.declarations import completes

            same = mine.ctype == found.ctype or build.same_type(mine.ctype, found.ctype)
            if not same and not completes(mine.ctype, found.ctype):
                message = f"{name} is declared as {mine.ctype} here and defined as {found.ctype} at "
                message += f"{found.declaration.file}:{found.declaration.line}"
                file.module.remarks.append(Remark(where, rule="prototype-mismatch", message=message, name=name))
            found.volatile = found.volatile or mine.volatile
            file.module.symbols[name] = found
        elif isinstance(mine, Variable) and where.file != file.module.file:
            file.reader.linkage.absent.add(name)
        elif isinstance(mine, Variable):
            raise SourceError.at(where, f"{name} is declared extern, and no file defines it")

    def _compare(self, file: CFile, mine: Function, found: Function, where: Where) -> None:
        """Make a remark about a declaration that differs from the definition."""
        from emulator.c28x.readers.c.declarations import compatible, signature

        if where.file.startswith("<") or compatible(mine.ctype, found.ctype):
            return
        message = f"declared as {signature(mine.name, mine.ctype)}, defined as {signature(found.name, found.ctype)}"
        file.module.remarks.append(Remark(where, rule="prototype-mismatch", message=message, name=mine.name))


def _module_of_emulator(name: str) -> Module | None:
    """The module of the emulator with a function of this name; None: there is none."""
    return next((m for m in (library(), kernel(), device()) if isinstance(m.symbols.get(name), Function)), None)


def _one_object(first: Module, second: Module, name: str) -> bool:
    """Whether two files define the same object tentatively (`int x;` in both).  If so, join the two definitions."""
    mine, other = first.symbols[name], second.symbols[name]
    if not isinstance(mine, Variable) or not isinstance(other, Variable) or mine.ctype != other.ctype:
        return False
    if mine.initialised and other.initialised:
        return False
    if other.initialised:
        first, second, mine, other = second, first, other, mine
    mine.volatile = mine.volatile or other.volatile
    second.symbols[name] = mine
    if other in second.variables:
        second.variables.remove(other)
    return True


def _inline(first: CFile, second: CFile, name: str) -> bool:
    """Whether a header defines a function `inline` for two files (ISO C99 6.7.4).  If so, keep that of the first."""
    if name not in first.reader.linkage.inline or name not in second.reader.linkage.inline:
        return False
    other = second.module.symbols[name]
    second.module.symbols[name] = first.module.symbols[name]
    if other in second.module.functions:
        second.module.functions.remove(other)
        second.module.own.remove(name)
    return True


#: In the name of a section: another processor writes there.
_SHARED: Final = re.compile(r"cla|cpu2|cputocpu|getbuffer|msgram", re.IGNORECASE)
_NO_TYPE: Final = re.compile(r"'(\w+)' is not a type")


def _hinted(error: SourceError) -> SourceError:
    """The parser's error about an unknown type, with a hint if its name is known."""
    found = _NO_TYPE.search(str(error))
    hint = headers.hint(found[1]) if found is not None else None
    return error if hint is None else SourceError(error.file, error.line, hint, error.column)


def _mark_interrupts(module: Module, unit: Unit) -> None:
    """`#pragma INTERRUPT(function)` is another way to write `interrupt` (SPRU514, "The INTERRUPT Pragma")."""
    for pragma in unit.pragmas:
        word, _, arguments = pragma.text.partition("(")
        function = module.symbols.get(arguments.partition(")")[0].partition(",")[0].strip())
        if word.strip() == "INTERRUPT" and isinstance(function, Function):
            function.interrupt = True


def _fill_shared(module: Module, unit: Unit) -> None:
    """Objects in memory that the CLA or the second CPU writes are 0 at first: this file need not write them.

    Such memory is known by the name of its section, as TI's command files have it: `Cla1ToCpuMsgRAM`, `CLADataLS0`,
    `GETBUFFER`, `CPU2TOCPU1RAM`.
    """
    from emulator.c28x.readers.c.declarations import zeros

    for pragma in unit.pragmas:
        word, _, arguments = pragma.text.partition("(")
        name, _, section = arguments.partition(",")
        shared = module.symbols.get(name.strip()) if word.strip() == "DATA_SECTION" else None
        if isinstance(shared, Variable) and shared in module.variables and _SHARED.search(section):
            module.initialisers.setdefault(shared, partial(zeros, shared.ctype, pragma.where))


def _remark_preprocessing(module: Module, unit: Unit, tree: c_ast.FileAST) -> None:
    """Make remarks about pragmas that are not modelled, and about what the preprocessor remarked."""
    for remark in unit.remarks:
        where = remark.where
        before = [node for node in tree.ext if node.coord.file == where.file and node.coord.line <= where.line]
        declared = getattr(before[-1], "decl", None) if before else None  # only a function's definition has one
        function = declared.name if declared is not None else ""
        module.remarks.append(Remark(where, remark.rule, remark.message, remark.name, function))
    for pragma in unit.pragmas:
        word, _, arguments = pragma.text.partition("(")
        word, name = word.strip(), arguments.split(",")[0].strip()
        if word == "DATA_SECTION":
            module.placed.add(name)
        # The blocks of the chip have their addresses here too.
        if word in _PLACING and pragma.where.file == unit.file and not headers.is_block(name):
            message = f"#pragma {pragma.text.rstrip('; ')} is ignored: where code and data lie is not modelled"
            module.remarks.append(Remark(pragma.where, rule="pragma-ignored", message=message, name=word))
