"""Makes the compiled build that `emulator/compiled.py` finds, by mypyc (part of mypy) and the C compiler.

Compiled is what the emulator spends its time in (`PATTERNS`); `STAYS` says of everything else why it stays Python, and
`interpreted` which functions those are.
"""

from __future__ import annotations

import ast
import contextlib
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from emulator.c28x.link import Linked
from emulator.c28x.symbols import Module
from emulator.c28x.typed_text import typed_text
from emulator.compiled import MANIFEST, ROOT, STORE, digest, find_build, program_name, programs_of
from firmware_model.corrections import ALL
from firmware_model.image import link
from hil.extras import has, hint
from hil.robot.board import RobotBoard

PATTERNS: Final = (
    "emulator/clock.py",
    "emulator/cpu.py",
    "emulator/noise.py",
    "emulator/signal.py",
    "emulator/signals.py",
    "emulator/trace.py",
    "emulator/pin_mux.py",
    "emulator/registers/cell.py",
    "emulator/registers/checks.py",
    "emulator/registers/hook.py",
    "emulator/registers/taps.py",
    "emulator/c28x/arithmetic.py",
    "emulator/c28x/findings.py",
    "emulator/c28x/heap_block.py",
    "emulator/c28x/memory.py",
    "emulator/c28x/position.py",
    "emulator/c28x/runtime.py",
    "emulator/peripherals/*.py",
    "emulator/devices/*.py",
    "emulator/sysbios/*.py",
    "emulator/sysbios/watch/*.py",
    "hil/world/*.py",
)
INTERPRETED: Final = ("__init__.py", "emulator/sysbios/headers.py", "hil/world/maps.py")
#: Why a source that is not listed stays Python.
STAYS: Final = {
    "translates firmware, and what it makes is kept": (
        "emulator/c28x/build/*.py", "emulator/c28x/emit/*.py", "emulator/c28x/passes/*.py",
        "emulator/c28x/readers/**/*.py", "emulator/c28x/cache.py", "emulator/c28x/compile.py",
        "emulator/c28x/compiled_program.py", "emulator/c28x/ctypes.py", "emulator/c28x/declarations.py",
        "emulator/c28x/float_division.py", "emulator/c28x/language.py", "emulator/c28x/program.py",
        "emulator/c28x/rts.py", "emulator/c28x/symbols.py", "emulator/c28x/tree.py", "emulator/c28x/tree_queries.py",
        "emulator/c28x/typed_text.py",
        "emulator/sysbios/headers.py",
    ),
    "works while a chip is made, or where its program starts and ends": (
        "emulator/**/__init__.py", "emulator/blocks.py", "emulator/chip.py", "emulator/compiled.py",
        "emulator/connections.py", "emulator/device_*.py", "emulator/image.py", "emulator/pin_functions.py",
        "emulator/register_writes.py", "emulator/seed.py", "emulator/system.py", "emulator/c28x/link.py",
        "hil/world/__init__.py", "hil/world/maps.py",
    ),
    "describes registers: their classes are made at run time": ("emulator/registers/*.py",),
    "works when something is found, or counted": (
        "emulator/rules/*.py", "emulator/c28x/coverage.py", "emulator/c28x/sites.py",
    ),
    "what firmware calls beside the chip: the library of C, frames of CAN; not compiled so far": (
        "emulator/c28x/called_as.py", "emulator/c28x/intrinsics.py", "emulator/c28x/iq_arithmetic.py",
        "emulator/c28x/objects.py", "emulator/c28x/rts_*.py", "emulator/c28x/varargs.py",
        "emulator/can_bus.py",
    ),
}  # fmt: skip
#: When firmware does.
FIRMWARE_STAYS: Final = (
    "firmware: compiled for a run of the whole robot; Python made from its source when it is debugged or counted, and "
    "on any other board"
)
#: What every error of a build ends with.
STILL: Final = "without a compiled build everything runs in plain Python, at about a fifth of the pace"
#: Whatever a compiled module may have taken a constant or a type from.
SOURCES: Final = ("emulator/**/*.py", "hil/world/*.py")
#: The library in which the modules of the emulator really are.  Each program of firmware has one of its own.
GROUP: Final = "c2000_hil"
#: What a build keeps of mypyc's work: with it a further program is translated without the emulator.
KEPT: Final = "translated"


class BuildError(ValueError):
    """The build could not be made: why, and what works without it, in one line."""

    def __init__(self, why: str) -> None:
        super().__init__(f"{why}; {STILL}")


@dataclass(frozen=True, slots=True)
class Interpreted:
    """Functions of a source that a compiled build leaves to the interpreter, and why."""

    #: Relative to `ROOT` where it lies there.
    file: str
    functions: tuple[str, ...]
    reason: str


def _matching(root: Path, *patterns: str) -> list[str]:
    return sorted({path.relative_to(root).as_posix() for pattern in patterns for path in root.glob(pattern)})


def listed(root: Path = ROOT) -> list[str]:
    """The sources to compile, relative to `root`."""
    return [name for name in _matching(root, *PATTERNS) if not name.endswith(INTERPRETED)]


def interpreted(firmware: Iterable[Module], root: Path = ROOT) -> list[Interpreted]:
    """What stays interpreted of the emulator, the world and the modules of a firmware, by source."""
    compiled = set(listed(root))
    reasons = {name: why for why, patterns in STAYS.items() for name in _matching(root, *patterns)}
    core = [
        Interpreted(name, tuple(functions_of(root / name)), reasons[name])
        for name in _matching(root, *SOURCES) if name not in compiled
    ]  # fmt: skip
    own = [
        Interpreted(_from(root, module.file), tuple(f.name for f in module.functions), FIRMWARE_STAYS)
        for module in firmware
    ]
    return [each for each in (*core, *own) if each.functions]


def functions_of(source: Path) -> Iterator[str]:
    """The functions of a Python source, methods as `Class.name`; those within functions belong to them."""
    waiting: list[tuple[str, ast.AST]] = [("", ast.parse(source.read_bytes()))]
    for within, node in waiting:
        for inner in ast.iter_child_nodes(node):
            if isinstance(inner, ast.ClassDef):
                waiting.append((f"{within}{inner.name}.", inner))
            elif isinstance(inner, ast.FunctionDef):
                yield within + inner.name


def _from(root: Path, file: str) -> str:
    return Path(file).relative_to(root).as_posix() if Path(file).is_relative_to(root) else file


def programs(own: Iterable[Path] = ()) -> dict[str, Linked]:
    """Each program of the robot that is compiled, by its identity.

    They are its firmware, the same with all corrections, and its firmware with the C files `own`, if there are any:
    each as it runs, and as it is watched.  Raises ValueError for C files that cannot be linked.
    """
    own = list(own)
    # First the files that may be wrong: that is told before anything takes its time.
    variants: list[tuple[list[str], list[Path]]] = [*([([], own)] if own else []), ([], []), ([ALL], [])]
    linked = [
        link(RobotBoard(), charge_by_call=True, fixes=fixes, firmware=files, watch=watch).linked
        for fixes, files in variants for watch in (False, True)
    ]  # fmt: skip
    return {each.identity: each for each in linked}


def translate(root: Path, target: Path, programs: Mapping[str, Linked]) -> list[Any]:
    """C for the listed modules and for programs, in `target`, as extensions that setuptools can build.

    What mypyc finds translated in `target` it does not translate again.
    """
    from mypyc.build import mypycify

    core = listed(root)
    options = ["--config-file=", "--ignore-missing-imports", f"--cache-dir={target / 'mypy'}"]
    try:
        with (
            tempfile.TemporaryDirectory() as folder, _in_folder(root), contextlib.redirect_stdout(sys.stderr)
        ):  # fmt: skip
            own = [Path(folder) / f"{program_name(identity)}.py" for identity in programs]
            for file, program in zip(own, programs.values(), strict=True):
                file.write_text(typed_text(program.compiled, program.first), "utf-8")
            extensions: list[Any] = mypycify(
                [*options, *core, *map(str, own)], opt_level="2", debug_level="0", multi_file=True,
                target_dir=str(target / "c"),
                separate=[(core, GROUP), *(([str(file)], _group(file.stem)) for file in own)],
            )  # fmt: skip
    except SystemExit as error:
        raise BuildError(f"mypyc cannot translate the sources: {error}") from None
    return extensions


def _group(program: str) -> str:
    return f"c2000_{program}"


def build(
    own: Iterable[Path] = (), *, root: Path = ROOT, store: Path = STORE,
    progress: Callable[[float], None] = lambda fraction: None,
) -> int:  # fmt: skip
    """Compile what is not compiled yet.  Returns how many modules that was.

    If a source of the emulator has changed, that is everything, and the new build takes the place of the one before.
    Else it is the programs that the build does not have, which are put beside the others.  `own` are the C files of
    `programs`.  `progress` is told the fraction 0..1 of the C files that are compiled.
    """
    sources = {name: digest(root / name) for name in _matching(root, *SOURCES)}
    wanted = {program_name(identity): (identity, program) for identity, program in programs(own).items()}
    state, known = find_build(store, root)
    fresh = state == "fresh" and (store / KEPT).exists()
    if fresh:
        wanted = {name: each for name, each in wanted.items() if name not in known}
        if not wanted:
            return 0
    modules = [] if fresh else [name.removesuffix(".py").replace("/", ".") for name in listed(root)]
    store.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="build-", dir=store.parent) as folder:
        work, made = Path(folder), Path(folder) / "made"
        _try_tools(work)
        if fresh:
            shutil.copytree(store / KEPT, work / KEPT)
        extensions = translate(root, work / KEPT, dict(wanted.values()))
        if any(digest(root / name) != before for name, before in sources.items()):
            raise BuildError("a source changed during the build: run hil build again")
        by_name = {e.name: e for e in extensions}
        parts = {name: (f"{_group(name)}__mypyc", name) for name in wanted}
        ours = [part for both in parts.values() for part in both]
        core = [] if fresh else [name for name in by_name if name not in ours]
        if missing := {*modules, *ours} - set(by_name):
            raise BuildError(f"mypyc did not compile {', '.join(sorted(missing))}")
        for name in ours:
            # As fast as with -O2 (0.99 of the CPU time, five pairs), in 0.6 of the compiler's time.
            by_name[name].extra_compile_args.append("-O1")
        _compile([by_name[name] for name in (*core, *ours)], work, made, progress)
        place = programs_of(made, sources)
        for name, both in parts.items():
            (place / name).mkdir(parents=True)
            for part in both:
                file = made / _file(made, part)
                file.rename(place / name / file.name)
        # Running processes keep the files that they have.
        if fresh:
            _put_beside(place, programs_of(store, sources))
        else:
            manifest = {"sources": sources, "modules": {name: _file(made, name) for name in core}}
            (made / MANIFEST).write_text(json.dumps(manifest, indent=1), "utf-8")
            (work / KEPT).rename(made / KEPT)
            clean(store)
            made.rename(store)
    return len(modules) + len(parts)


def _put_beside(made: Path, place: Path) -> None:
    """Put each program that was made beside the others, unless another build has just done so."""
    for program in made.iterdir():
        try:
            program.rename(place / program.name)
        except FileNotFoundError:
            raise BuildError("another build has taken the place of this one: run hil build again") from None
        except OSError:
            if not (place / program.name).exists():
                raise


def wheel(target: Path, *, root: Path = ROOT, store: Path = STORE) -> Path:
    """The wheel of this checkout with its compiled build in it, in the folder `target`: for this Python and system.

    What `KEPT` has is left out.  Raises BuildError if there is no build of these sources, or no checkout.
    """
    if not (root / "pyproject.toml").exists():
        raise BuildError(f"a wheel is made of a checkout, and {root} is none: it has no pyproject.toml")
    if find_build(store, root)[0] != "fresh":
        raise BuildError("a wheel takes the compiled build, and there is none of these sources: run hil build first")
    if not has("wheel"):
        raise BuildError(hint("wheel"))
    target.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="wheel-", dir=target) as folder:
        work = Path(folder)
        _run("pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(work), str(root))
        (pure,) = work.glob("*.whl")
        _run("wheel", "unpack", str(pure), "--dest", str(work))
        pure.unlink()
        (unpacked,) = (path for path in work.iterdir() if path.is_dir())
        shutil.copytree(store, unpacked / store.relative_to(root), ignore=shutil.ignore_patterns(KEPT))
        (about,) = unpacked.glob("*.dist-info/WHEEL")
        about.write_text(about.read_text("utf-8").replace("Root-Is-Purelib: true", "Root-Is-Purelib: false"), "utf-8")
        _run("wheel", "pack", str(unpacked), "--dest-dir", str(work))
        python = f"cp{sys.version_info.major}{sys.version_info.minor}"
        system = re.sub("[-.]", "_", sysconfig.get_platform())
        tags = ("--python-tag", python, "--abi-tag", python, "--platform-tag", system)
        _run("wheel", "tags", "--remove", *tags, str(work / pure.name))
        (made,) = work.glob("*.whl")
        return made.rename(target / made.name)


def _run(module: str, *arguments: str) -> None:
    """Run `python -m module`.  Raises BuildError with the end of what it said if it fails."""
    done = subprocess.run([sys.executable, "-m", module, *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        raise BuildError(f"{module} failed: {' '.join((done.stderr or done.stdout).split()[-30:])}")


def clean(store: Path = STORE) -> bool:
    """Remove the build for this interpreter; returns whether there was one."""
    if not store.exists():
        return False
    shutil.rmtree(store)
    return True


def _try_tools(work: Path) -> None:
    """Raise BuildError unless all that a build takes is there: said before the minute that the translation needs."""
    for package in ("mypyc", "setuptools"):
        if not has(package):
            raise BuildError(hint(package))
    from setuptools import Extension

    source = work / "probe.c"
    source.write_text("#include <Python.h>\nPyMODINIT_FUNC PyInit_probe(void) { return NULL; }\n", "ascii")
    _compile([Extension("probe", [str(source)])], work, work / "probe", lambda fraction: None)


def _compile(extensions: list[Any], work: Path, made: Path, progress: Callable[[float], None]) -> None:
    from setuptools import Distribution
    from setuptools.command.build_ext import build_ext
    from setuptools.errors import BaseError, CCompilerError

    class SideBySide(build_ext):
        def build_extensions(self) -> None:
            if self.compiler.compiler_type == "unix":
                for extension in extensions:  # else a product and a sum become one operation where there is one (ARM)
                    extension.extra_compile_args.append("-ffp-contract=off")
                    # Each C file of a library defines the table of the other one that it uses: one table for all.
                    extension.extra_compile_args.append("-fcommon")
            _build_extensions(self, progress)

    command = SideBySide(Distribution({"name": GROUP, "ext_modules": extensions}))
    command.build_lib, command.build_temp = str(made), str(work / "objects")
    command.finalize_options()
    try:
        with _in_folder(work):
            command.run()
    except (BaseError, CCompilerError) as error:  # the second is no kind of the first
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
