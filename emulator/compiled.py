"""Uses the compiled build of these sources, if there is one that belongs to them.

`hil build` compiles the modules that take most of the time into extension modules, and with them the robot's firmware
(`part`).  Names and results are the same, at about five times the speed.  They lie in a folder of their own.  A
manifest there names every source that they may depend on, with its SHA-256.  If one source differs, the whole build is
ignored: so the program always runs the sources as they are.  What is compiled of a part of firmware has
a folder of its own, in one that is named after those sources: a part that was compiled with others is never found.
`HIL_PURE=1` ignores the build too.
"""

from __future__ import annotations

import ctypes
import json
import os
import sys
from hashlib import sha256
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from sysconfig import get_config_var
from types import ModuleType
from typing import Any, Final

#: The folder of the packages.  Sources are named relative to it.
ROOT: Final = Path(__file__).parent.parent
#: In the folder of a build: which sources it was made from, its modules, and the library that they are in.
MANIFEST: Final = "manifest.json"
#: The build for this interpreter; another one has its own beside it.
STORE: Final = Path(__file__).with_name("_compiled") / str(get_config_var("SOABI"))


class Finder(MetaPathFinder):
    """Finds compiled modules: `files` has, for each by its name, the library that it is in."""

    def __init__(self, files: dict[str, str]) -> None:
        self.files = files
        self._libraries = {_library_name(file): file for file in files.values()}
        self._made: dict[str, ModuleType] = {}

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """A library, or a module that is in one."""
        if fullname in self._libraries:
            return spec_from_file_location(fullname, self._libraries[fullname])
        file = self.files.get(fullname)
        return None if file is None else ModuleSpec(fullname, _InLibrary(_library_name(file), self._made), origin=file)


class _InLibrary(Loader):
    """Makes modules that are in a library of mypyc.

    mypyc writes an extension module for each, which does only this.  The 160 of them would take the C compiler 13 s.
    """

    def __init__(self, library: str, made: dict[str, ModuleType]) -> None:
        self.library = library
        #: The modules that were made.  They live as long as the process: the library keeps only their addresses.
        self._made = made

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        """The module, after its own statements have run."""
        if spec.name in self._made:  # somebody has taken it out of `sys.modules`
            return self._made[spec.name]
        library = import_module(self.library)
        if hasattr(library, "ensure_deps"):  # it takes something from another library
            prepare = ctypes.PYFUNCTYPE(ctypes.c_int)(self._address(library.ensure_deps, "ensure_deps"))
            if prepare() < 0:
                raise ImportError(f"{self.library} does not fit the libraries that it needs", name=spec.name)
        name = f"init_{spec.name.replace('.', '___')}"
        made: ModuleType = ctypes.PYFUNCTYPE(ctypes.py_object)(self._address(getattr(library, name), name))()
        self._made[spec.name] = made
        return made

    def exec_module(self, module: ModuleType) -> None:
        """Nothing is left to do."""

    def _address(self, capsule: Any, name: str) -> int:
        """The function of the library that a capsule holds."""
        take = ctypes.pythonapi.PyCapsule_GetPointer
        take.restype, take.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
        address: int = take(capsule, f"{self.library}.{name}".encode())
        return address


def _library_name(file: str) -> str:
    """The name under which a library is imported."""
    return os.path.basename(file).partition(".")[0]


def digest(source: Path) -> str:
    """The digest that identifies a source."""
    return sha256(source.read_bytes()).hexdigest()


def parts_of(store: Path, sources: dict[str, str]) -> Path:
    """The folder of the parts of firmware that were compiled with these sources (name -> digest)."""
    return store / f"parts-{sha256(json.dumps(sources, sort_keys=True).encode()).hexdigest()[:16]}"


def find_build(store: Path = STORE, root: Path = ROOT) -> tuple[str, dict[str, str]]:
    """The state of the build in `store` ("none", "stale", "fresh"); if it is fresh, its modules and their libraries."""
    try:
        manifest = json.loads((store / MANIFEST).read_text("utf-8"))
        sources = manifest["sources"]
        fresh = all(digest(root / name) == known for name, known in sources.items())
        library = str(store / manifest["library"])
        if fresh and os.path.exists(library):
            parts = parts_of(store, sources).glob("*/*")
            return "fresh", dict.fromkeys(manifest["modules"], library) | {p.parent.name: str(p) for p in parts}
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        pass  # no manifest, a source that is gone, a file of another form
    return ("stale" if store.exists() else "none"), {}


def install() -> str:
    """Import from the build before the sources.

    Returns how this process runs: "compiled", "pure", or "stale" (pure, because the build does not fit the sources).
    """
    if os.environ.get("HIL_PURE", "0") not in ("", "0"):
        return "pure"
    state, files = find_build()
    if state != "fresh":
        return "stale" if state == "stale" else "pure"
    sys.meta_path.insert(0, Finder(files))
    return "compiled"


def part_name(identity: str) -> str:
    """The name of the module with a part of firmware, which `c28x/typed_text.py` identifies."""
    return f"part_{identity[:16]}"


def part(identity: str) -> ModuleType | None:
    """The module with a part of firmware.

    None if the build has none, or is not used, or if a debugger is there: it stops in the firmware's own lines only
    where they are interpreted.
    """
    if sys.gettrace() is not None or "pydevd" in sys.modules:
        return None
    name = part_name(identity)
    built = any(isinstance(finder, Finder) and name in finder.files for finder in sys.meta_path)
    return import_module(name) if built else None


#: How this process runs.
MODE: Final = install()
#: Each way in words.
BUILDS: Final = {
    "compiled": "compiled build", "pure": "pure Python",
    "stale": "pure Python (the compiled build is of other sources)",
}  # fmt: skip
