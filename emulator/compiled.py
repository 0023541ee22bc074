"""Uses the compiled build of these sources, if there is one that belongs to them.

`hil build` compiles the modules that take most of the time into extension modules, and with them the robot's firmware
(`part`).  Names and results are the same, at about five times the speed.  They lie in a folder of their own.  A
manifest there names every source that they may depend on, with its SHA-256.  If one source differs, the whole build is
ignored: so the program always runs the sources as they are.  What is compiled of a part of firmware has
a folder of its own, in one that is named after those sources: a part that was compiled with others is never found.
`HIL_PURE=1` ignores the build too.
"""

from __future__ import annotations

import json
import os
import sys
from hashlib import sha256
from importlib import import_module
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from sysconfig import get_config_var
from types import ModuleType
from typing import Any, Final

#: The folder of the packages.  Sources are named relative to it.
ROOT: Final = Path(__file__).parent.parent
#: In the folder of a build: which sources it was made from, and where its modules are.
MANIFEST: Final = "manifest.json"
#: The build for this interpreter; another one has its own beside it.
STORE: Final = Path(__file__).with_name("_compiled") / str(get_config_var("SOABI"))


class Finder(MetaPathFinder):
    """Finds modules by name in a fixed table."""

    def __init__(self, files: dict[str, str]) -> None:
        self.files = files

    def find_spec(self, fullname: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """The extension module of that name, if there is one."""
        file = self.files.get(fullname)
        return None if file is None else spec_from_file_location(fullname, file)


def digest(source: Path) -> str:
    """The digest that identifies a source."""
    return sha256(source.read_bytes()).hexdigest()


def parts_of(store: Path, sources: dict[str, str]) -> Path:
    """The folder of the parts of firmware that were compiled with these sources (name -> digest)."""
    return store / f"parts-{sha256(json.dumps(sources, sort_keys=True).encode()).hexdigest()[:16]}"


def find_build(store: Path = STORE, root: Path = ROOT) -> tuple[str, dict[str, str]]:
    """The state of the build in `store` ("none", "stale", "fresh"), and the paths of its modules if it is fresh."""
    try:
        manifest = json.loads((store / MANIFEST).read_text("utf-8"))
        sources = manifest["sources"]
        fresh = all(digest(root / name) == known for name, known in sources.items())
        files = {name: str(store / file) for name, file in manifest["modules"].items()}
        if fresh and all(map(os.path.exists, files.values())):
            parts = parts_of(store, sources).glob("*/*")
            return "fresh", files | {file.name.partition(".")[0]: str(file) for file in parts}
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
