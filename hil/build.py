"""Makes the compiled build that `emulator/compiled.py` finds, by mypyc (part of mypy) and the C compiler.

Compiled is what the emulator spends its time in.  Not compiled is what must be Python to work: firmware, headers and
the translator (it reads sources), where the firmware stands (`emulator/c28x/sites.py`: interpreted code writes it at
every statement), findings, register descriptions (classes made at run time).
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Final

from emulator.compiled import ROOT, STORE, digest
from hil.extras import hint

PATTERNS: Final = (
    "emulator/clock.py",
    "emulator/cpu.py",
    "emulator/signal.py",
    "emulator/signals.py",
    "emulator/trace.py",
    "emulator/pin_mux.py",
    "emulator/registers/cell.py",
    "emulator/c28x/arithmetic.py",
    "emulator/c28x/heap_block.py",
    "emulator/c28x/memory.py",
    "emulator/peripherals/*.py",
    "emulator/devices/*.py",
    "emulator/sysbios/*.py",
    "emulator/sysbios/watch/*.py",
    "hil/world/*.py",
)
INTERPRETED: Final = ("__init__.py", "emulator/sysbios/headers.py", "hil/world/maps.py")
#: Whatever a compiled module may have taken a constant or a type from.
SOURCES: Final = ("emulator/**/*.py", "hil/world/*.py")
#: The library in which the modules really are.
GROUP: Final = "c2000_hil"


class BuildError(ValueError):
    """The build could not be made, and why, in one line."""


def _matching(root: Path, *patterns: str) -> list[str]:
    return sorted({path.relative_to(root).as_posix() for pattern in patterns for path in root.glob(pattern)})


def listed(root: Path = ROOT) -> list[str]:
    """The sources to compile, relative to `root`."""
    return [name for name in _matching(root, *PATTERNS) if not name.endswith(INTERPRETED)]


def translate(root: Path, target: Path) -> list[Any]:
    """C for the listed modules, in `target`, as extensions that setuptools can build."""
    try:
        from mypyc.build import mypycify
    except ImportError:
        raise BuildError(hint("mypyc")) from None
    options = ["--config-file=", "--ignore-missing-imports", f"--cache-dir={target / 'mypy'}"]
    try:
        with _in_folder(root), contextlib.redirect_stdout(sys.stderr):
            extensions: list[Any] = mypycify(
                [*options, *listed(root)], opt_level="2", debug_level="0", group_name=GROUP, multi_file=True,
                target_dir=str(target / "c"),
            )  # fmt: skip
    except SystemExit as error:
        raise BuildError(f"mypyc cannot translate the sources: {error}") from None
    return extensions


def build(root: Path = ROOT, store: Path = STORE, progress: Callable[[float], None] = lambda fraction: None) -> int:
    """Compile, and put the build in the place of the one before.  Returns how many modules it has.

    `progress` is told the fraction 0..1 of the C files that are compiled.
    """
    modules = listed(root)
    sources = {name: digest(root / name) for name in _matching(root, *SOURCES)}
    store.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="build-", dir=store.parent) as folder:
        work, made = Path(folder), Path(folder) / "made"
        extensions = translate(root, work)
        if any(digest(root / name) != known for name, known in sources.items()):
            raise BuildError("a source changed during the build: once more, please")
        _compile(extensions, work, made, progress)
        names = [name.removesuffix(".py").replace("/", ".") for name in modules]
        files = {e.name: _file(made, e.name) for e in extensions}
        if missing := set(names) - set(files):
            raise BuildError(f"mypyc left out {', '.join(sorted(missing))}")
        manifest = {"sources": sources, "modules": files}
        (made / "manifest.json").write_text(json.dumps(manifest, indent=1), "utf-8")
        clean(store)
        made.rename(store)  # running processes keep the files that they have
    return len(names)


def clean(store: Path = STORE) -> bool:
    """Remove the build for this interpreter; returns whether there was one."""
    if not store.exists():
        return False
    shutil.rmtree(store)
    return True


def _compile(extensions: list[Any], work: Path, made: Path, progress: Callable[[float], None]) -> None:
    try:
        from setuptools import Distribution
        from setuptools.command.build_ext import build_ext
        from setuptools.errors import BaseError
    except ImportError:
        raise BuildError(hint("setuptools")) from None

    class SideBySide(build_ext):
        def build_extensions(self) -> None:
            _build_extensions(self, progress)

    command = SideBySide(Distribution({"name": GROUP, "ext_modules": extensions}))
    command.build_lib, command.build_temp = str(made), str(work / "objects")
    command.finalize_options()
    try:
        with _in_folder(work):
            command.run()
    except BaseError as error:
        raise BuildError(f"the C compiler failed: {error}") from None


def _build_extensions(command: Any, progress: Callable[[float], None]) -> None:
    """One C file a core: setuptools compiles the hundred of one extension one after the other."""
    total, done = sum(len(extension.sources) for extension in command.extensions), 0
    compile_in_turn = command.compiler.compile

    def compile_side_by_side(sources: list[str], **options: Any) -> list[str]:
        nonlocal done
        objects: list[str] = []
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for made in pool.map(lambda source: compile_in_turn([source], **options), sources):
                objects += made
                done += 1
                progress(done / total)
        return objects

    command.compiler.compile = compile_side_by_side
    for extension in command.extensions:
        command.build_extension(extension)


def _file(made: Path, module: str) -> str:
    found = list(made.glob(module.replace(".", "/") + ".*"))
    if len(found) != 1:
        raise BuildError(f"the C compiler made no {module}")
    return found[0].relative_to(made).as_posix()


@contextlib.contextmanager
def _in_folder(folder: Path) -> Iterator[None]:
    """mypyc names modules by their path from here, and reads the command line for options of its own."""
    here, arguments = os.getcwd(), sys.argv
    os.chdir(folder)
    sys.argv = arguments[:1]
    try:
        yield
    finally:
        os.chdir(here)
        sys.argv = arguments
