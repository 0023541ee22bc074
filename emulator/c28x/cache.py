"""Compiled programs kept on disk, so that what has not changed is not translated again.

The key of a program contains the request, the `CompileOptions` and the state of the translator.  A kept program is used
only if every source file is unchanged, and reading each register still has the same effect.  If an entry cannot be read
or written, the program is compiled.  A program with corrections takes what these do not reach from another one that the
process compiled.

The folder is the user's own cache (`HIL_CACHE`, else `XDG_CACHE_HOME`, else `~/.cache`); its files are trusted as the
user's programs are.  `HIL_CACHE=off` keeps nothing.
"""

from __future__ import annotations

import copyreg
import hashlib
import io
import marshal
import os
import pickle
import sys
import tempfile
import zlib
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from emulator.c28x.compiled_program import Compiled
from emulator.c28x.ctypes import CType
from emulator.c28x.options import CompileOptions
from emulator.c28x.program import Program, digest, folders
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import EnumType, Module, NotAlike, SourceError, Symbol
from emulator.c28x.tree import Function

#: How many programs the folder keeps: the most recently used ones.  An audit of the robot makes 150, most of them with
#: one correction; a kept program of the robot has 0.1 MB.
MAX_PROGRAMS: Final = 256
#: How many of them a process keeps in memory.
IN_MEMORY: Final = 32
#: For how many requests a process keeps programs to take over functions from, and how many: they keep their trees.
ALIKE: Final = 8
ALIKE_EACH: Final = 2
PACKAGE: Final = Path(__file__).resolve().parent.parent
#: Folders that a translation depends on in addition to the firmware, and whether their subfolders count too.
TRANSLATOR: Final = (("", False), ("c28x", True), ("registers", False), ("sysbios", False))


#: A source file: path, size, time of the last change in ns.
File = tuple[str, int, int]


@reading(0)
def compiled(asked: dict[str, Any], options: CompileOptions, looked_at: Callable[[str, str], bool]) -> Compiled:
    """The program `Program(**asked)`, compiled: from the cache, or compiled now and stored there.

    Raises what `Program` and `compile_program` raise.
    """
    file = _file(asked, options)
    if file is not None:
        known = _load(str(file), *_signature(file))
        if known is not None and known.fits(looked_at):
            with suppress(OSError):
                os.utime(file)
            return known.compiled
    made = _make(asked, options, looked_at)
    if file is not None:
        stamped = {_real(path) for path, _, _ in (*_translator_files(), *_package_files(asked))}
        digests = {name: known for name, known in made.digests.items() if _real(name) not in stamped}
        _keep(file, CachedProgram(made.compiled, digests, made.looked_at))
    return made.compiled


def _make(asked: dict[str, Any], options: CompileOptions, looked_at: Callable[[str, str], bool]) -> CachedProgram:
    """Translate a program.  Most of one with corrections is as in one that this process made with others."""
    from emulator.c28x.compile import compile_program  # most runs find their program and do not need the translator

    asked_for: dict[tuple[str, str], bool] = {}

    def remembered(block: str, register: str) -> bool:
        answer = asked_for[block, register] = looked_at(block, register)
        return answer

    fixes = frozenset(asked.get("fixes", ()))
    described = _described({**asked, "fixes": ()}, replace(options, static=False)) if fixes else ""
    alike = _alike(described) if described else []
    nearest = min(alike, key=lambda each: len(each.compiled.program.fixes ^ fixes), default=None)
    if nearest is not None and nearest.fits(looked_at):
        like = nearest.compiled
        with suppress(NotAlike, SourceError):  # the errors of a whole program are raised below
            program = Program(**asked, like=like.program)
            compiled = compile_program(program, options, remembered, like)
            return CachedProgram(compiled, nearest.digests, nearest.looked_at | asked_for)
    program = Program(**asked)
    made = CachedProgram(compile_program(program, options, remembered), program.digests(), asked_for)
    if described and len(alike) < ALIKE_EACH:
        with suppress(NotAlike):
            program.reached_by(program.fixes)  # what this finds in the sources is kept for the next programs
            alike.append(made)
    return made


@lru_cache(maxsize=ALIKE)
def _alike(described: str) -> list[CachedProgram]:
    """A list for programs of a request that differ in their corrections only."""
    return []


@dataclass(frozen=True)
class CachedProgram:
    """A compiled program, with the sources and register properties that it depends on."""

    compiled: Compiled
    digests: dict[str, str]
    looked_at: dict[tuple[str, str], bool]

    def fits(self, looked_at: Callable[[str, str], bool]) -> bool:
        """Whether its sources and the effects of reading registers are unchanged."""
        return all(digest(name) == known for name, known in self.digests.items()) and all(
            looked_at(*register) == known for register, known in self.looked_at.items()
        )


def _folder() -> Path | None:
    """Where programs are kept; None: nowhere."""
    own = os.environ.get("HIL_CACHE")
    if own == "off":
        return None
    if own:
        return Path(own)
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        return (Path(base) if base else Path.home() / ".cache") / "c2000-hil"
    except RuntimeError:  # the user has no home folder
        return None


def _file(asked: dict[str, Any], options: CompileOptions) -> Path | None:
    """The file of a request; None if the cache is off, or a function in the request has no name."""
    folder = _folder()
    described = _described(asked, options)
    if folder is None or not described:
        return None
    packages = _state(_package_files(asked))
    request = repr((described, os.getcwd(), sys.version, _translator(), packages))
    return folder / f"{hashlib.sha256(request.encode()).hexdigest()[:32]}.program"


def _described(asked: Mapping[str, Any], options: CompileOptions) -> str:
    """The request as text; empty if a function in it has no name."""
    described = []
    for name, value in sorted({**asked, **vars(options)}.items()):
        if callable(value):
            if not hasattr(value, "__module__") or "<" in value.__qualname__:
                return ""
            value = (value.__module__, value.__qualname__)
        elif isinstance(value, set | frozenset):
            value = sorted(value)
        elif isinstance(value, Mapping):
            value = sorted(value.items())
        elif not isinstance(value, str | int | bool):
            value = list(map(str, value))
        described.append((name, value))
    return repr(described)


@lru_cache(maxsize=1)
def _translator() -> str:
    """The state of the translator's own files: a change makes other programs.  It is read once per process."""
    return _state(_translator_files())


def _translator_files() -> list[File]:
    return [file for folder, below in TRANSLATOR for file in _sources(os.path.join(PACKAGE, folder), below)]


def _package_files(asked: Mapping[str, Any]) -> list[File]:
    """The files of the packages that define the functions in a request: their results may depend on any of them."""
    functions = [value for value in asked.values() if callable(value)]
    # The results of a method depend on the package that its object names.
    packages = {getattr(getattr(f, "__self__", None), "package", f.__module__.partition(".")[0]) for f in functions}
    return [file for package in sorted(packages) for folder in folders(package) for file in _sources(str(folder))]


def _sources(folder: str, below: bool = True) -> list[File]:
    """The Python files of a folder, and of all `below` it."""
    files: list[File] = []
    waiting = [folder]
    while waiting:
        with os.scandir(waiting.pop()) as entries:
            for entry in entries:
                if entry.name.endswith(".py"):
                    state = entry.stat()
                    files.append((entry.path, state.st_size, state.st_mtime_ns))
                elif below and entry.name != "__pycache__" and entry.is_dir():
                    waiting.append(entry.path)
    return files


#: The path of a file with links resolved, asked for once: a process makes many programs of the same files.
_real = lru_cache(maxsize=4096)(os.path.realpath)


def _state(files: list[File]) -> str:
    """A digest of the names, sizes and times of files."""
    return hashlib.sha256(marshal.dumps(sorted(files), 0)).hexdigest()  # 0: no references, no interned strings


def _signature(file: Path) -> tuple[int, int]:
    """Size and inode of a file: they tell a new file with the same name apart."""
    try:
        found = file.stat()
    except OSError:
        return (0, 0)
    return (found.st_size, found.st_ino)


@lru_cache(maxsize=IN_MEMORY)
def _load(file: str, size: int, inode: int) -> CachedProgram | None:
    """A kept program; None if it is missing or damaged.  Images of one process share it, so it must not be changed."""
    if not size:
        return None
    try:
        found = pickle.loads(zlib.decompress(Path(file).read_bytes()))
    except Exception:  # a damaged file can raise anything: treat it as missing
        return None
    return found if isinstance(found, CachedProgram) else None


class _Pickler(pickle.Pickler):
    """Pickles only what is needed after the code has been generated.

    A watched program still needs its trees.  Every C file has all types and functions of its headers: equal ones are
    stored once.  The name of a type means the one in the first module that has it (`type_named`).
    """

    def __init__(self, file: io.BytesIO, compiled: Compiled) -> None:
        super().__init__(file, pickle.HIGHEST_PROTOCOL)
        self.functions = {each.function for each in compiled.functions}
        self.types: set[str] = set()
        self.first: dict[bytes, CType | EnumType] = {}
        # By exact classes, not by `reducer_override`, which is asked for every object: a fifth of the time.
        own: dict[type[Any], Callable[[Any], Any]] = dict.fromkeys((EnumType, *_subclasses(CType)), self._type)
        own[Module] = self._module
        if not compiled.options.watch:
            own[Function] = _without_body
        self.dispatch_table = copyreg.dispatch_table | own

    def _type(self, obj: CType | EnumType) -> Any:
        first = self.first.setdefault(pickle.dumps(obj), obj)
        return obj.__reduce_ex__(pickle.HIGHEST_PROTOCOL) if first is obj else (_itself, (first,))

    def _module(self, module: Module) -> Any:
        state = module.__getstate__()
        state["symbols"] = {name: s for name, s in state["symbols"].items() if self._is_looked_at(name, s)}
        return object.__new__, (Module,), state

    def _is_looked_at(self, name: str, symbol: Symbol) -> bool:
        if isinstance(symbol, Function):
            return symbol in self.functions
        if isinstance(symbol, CType):
            known = name in self.types
            self.types.add(name)
            return not known
        return True


def _subclasses(of: type[Any]) -> list[type[Any]]:
    return [each for sub in of.__subclasses__() for each in (sub, *_subclasses(sub))]


def _without_body(function: Function) -> Any:
    return object.__new__, (Function,), {**function.__getstate__(), "body": []}


def _itself(ctype: CType) -> CType:
    return ctype


def _keep(file: Path, kept: CachedProgram) -> None:
    """Write a program to its file, completely or not at all; delete the oldest files beyond `MAX_PROGRAMS`."""
    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(max(limit, 20_000))
    temporary = ""
    try:
        file.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        buffer = io.BytesIO()
        _Pickler(buffer, kept.compiled).dump(kept)
        content = zlib.compress(buffer.getvalue(), 1)  # a sixth; loading takes 1.5 ms longer
        descriptor, temporary = tempfile.mkstemp(dir=file.parent, suffix=".part")
        with os.fdopen(descriptor, "wb") as target:
            target.write(content)
        os.replace(temporary, file)
        with os.scandir(file.parent) as entries:
            programs = [entry for entry in entries if entry.name.endswith(".program")]
        if len(programs) > MAX_PROGRAMS:
            programs.sort(key=lambda entry: entry.stat().st_mtime_ns)
            for old in programs[:-MAX_PROGRAMS]:
                os.unlink(old)
    except (OSError, pickle.PicklingError, TypeError, AttributeError, RecursionError):
        with suppress(OSError):
            if temporary:
                os.unlink(temporary)
    finally:
        sys.setrecursionlimit(limit)
