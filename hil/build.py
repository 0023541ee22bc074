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
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from threading import Lock
from typing import Any, Final

from emulator.c28x.symbols import Module
from emulator.c28x.typed_text import ProgramPart, typed_text
from emulator.compiled import MANIFEST, ROOT, STORE, digest, find_build, part_name, parts_of
from firmware_model.corrections import ALL
from firmware_model.image import link
from hil.collector import uncollected
from hil.extras import has, hint
from hil.robot.board import RobotBoard

PATTERNS: Final = (
    "emulator/clock.py",
    "emulator/cpu.py",
    "emulator/device_reports.py",
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
    "emulator/c28x/varargs.py",
    "emulator/c28x/watcher.py",
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
        "emulator/c28x/float_division.py", "emulator/c28x/language.py", "emulator/c28x/options.py",
        "emulator/c28x/program.py", "emulator/c28x/rts.py", "emulator/c28x/symbols.py", "emulator/c28x/tree.py",
        "emulator/c28x/tree_queries.py", "emulator/c28x/typed_text.py",
        "emulator/sysbios/headers.py",
    ),
    "works while a chip is made, or where its program starts and ends": (
        "emulator/**/__init__.py", "emulator/blocks.py", "emulator/chip.py", "emulator/compiled.py",
        "emulator/connections.py", "emulator/device_defines.py", "emulator/device_functions.py", "emulator/device_h.py",
        "emulator/image.py", "emulator/interrupt_flags.py",
        "emulator/latched_flags.py", "emulator/object_values.py", "emulator/pin_functions.py",
        "emulator/register_writes.py", "emulator/registers_by_address.py", "emulator/seed.py", "emulator/system.py",
        "emulator/xbar_users.py", "emulator/c28x/link.py", "hil/world/__init__.py", "hil/world/maps.py",
    ),
    "describes registers: their classes are made at run time": ("emulator/registers/*.py",),
    "works when something is found, or counted": (
        "emulator/rules/*.py", "emulator/c28x/coverage.py", "emulator/c28x/sites.py",
    ),
    "what firmware calls beside the chip: the library of C, frames of CAN; not compiled so far": (
        "emulator/c28x/called_as.py", "emulator/c28x/intrinsics.py", "emulator/c28x/iq_arithmetic.py",
        "emulator/c28x/number_text.py", "emulator/c28x/objects.py", "emulator/c28x/rts_*.py",
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
#: The library in which the modules of the emulator really are.  Each part of firmware has one of its own.
GROUP: Final = "c2000_hil"
#: What a build keeps of its work: with it a further part of firmware is translated and compiled alone.
KEPT: Final = "translated"
#: Within that, the objects of mypyc's own library, which every library here contains.
OBJECTS: Final = "objects"

#: Compiled with `-O2`, as mypyc's own library: each has 0.4 % or more of a mission's instructions, ideal, realistic or
#: watched.  All else has `-O1`: it takes the compiler 0.6 of the CPU time.
HOT: Final = (
    "emulator/clock.py", "emulator/noise.py", "emulator/signals.py", "emulator/trace.py",
    "emulator/c28x/arithmetic.py", "emulator/c28x/memory.py", "emulator/c28x/runtime.py",
    "emulator/registers/cell.py", "emulator/registers/taps.py",
    "emulator/peripherals/adc.py", "emulator/peripherals/pie.py", "emulator/peripherals/spi.py",
    "emulator/devices/lv_maxsonar_analog.py", "emulator/devices/nxt_motor.py",
    "emulator/sysbios/handles.py", "emulator/sysbios/scheduler.py", "emulator/sysbios/stack.py",
    "emulator/sysbios/watch/accesses.py", "emulator/sysbios/watch/calls.py", "emulator/sysbios/watch/gates.py",
    "emulator/sysbios/watch/kernel_watch.py", "emulator/sysbios/watch/races.py",
    "emulator/sysbios/watch/threads.py", "emulator/sysbios/watch/transactions.py",
)  # fmt: skip
HOT_LEVEL: Final = "-O2"
#: The level for parts of firmware that are watched.  It takes the compiler 0.6 of the time of `-O1`; their own
#: instructions are few beside those of who watches them.
WATCHED_LEVEL: Final = "-Og"


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


def parts(own: Iterable[Path] = (), *, alone: bool = False) -> dict[str, ProgramPart]:
    """What is compiled of the robot's programs, by its identity: many programs share a part.

    The programs are its firmware with the C files `own`, if there are any, and unless that one is meant `alone`, its
    firmware, and the same with all corrections: each as it runs, and as it is watched.  Raises ValueError for C files
    that cannot be linked.
    """
    own = list(own)
    # First the files that may be wrong: that is told before anything takes its time.
    variants: list[tuple[list[str], list[Path]]] = [([], own)] if own else []
    if not alone:
        variants += [([], []), ([ALL], [])]
    linked = [
        link(RobotBoard(), charge_by_call=True, fixes=fixes, firmware=files, watch=watch).linked
        for fixes, files in variants for watch in (False, True)
    ]  # fmt: skip
    return {part.identity: part for each in linked for part in each.parts}


def translate(root: Path, target: Path, parts: Mapping[str, ProgramPart]) -> list[Any]:
    """C for the listed modules and for parts of firmware, in `target`, as extensions that setuptools can build.

    What mypyc finds translated in `target` it does not translate again.
    """
    from mypyc.build import build_using_shared_lib, get_cflags, include_dir, mypyc_build, setup_mypycify_vars
    from mypyc.common import RUNTIME_C_FILES
    from mypyc.options import CompilerOptions

    core = listed(root)
    options = CompilerOptions(multi_file=True, separate=True, target_dir=str(target / "c"))
    # Nobody extends a class of another library here, so mypyc may use what it knows of all subclasses.
    options.global_opts = True
    arguments = [
        "--config-file=", "--ignore-missing-imports", "--no-sqlite-cache", f"--cache-dir={target / 'mypy'}"
    ]  # fmt: skip
    try:
        with (
            tempfile.TemporaryDirectory() as folder, _in_folder(root), contextlib.redirect_stdout(sys.stderr),
            uncollected(),
        ):  # fmt: skip
            own = [Path(folder) / f"{part_name(identity)}.py" for identity in parts]
            for file, part in zip(own, parts.values(), strict=True):
                file.write_text(typed_text(part), "utf-8")
            groups, made, more = mypyc_build(
                [*arguments, *core, *map(str, own)], options,
                separate=[(core, GROUP), *(([str(file)], _group(file.stem)) for file in own)],
            )  # fmt: skip
    except SystemExit as error:
        raise BuildError(f"mypyc cannot translate the sources: {error}") from None
    # From here on as `mypycify` does it, which has no way to set that option; mypyc's library is not copied.
    setup_mypycify_vars()
    library = [str(Path(include_dir(), name)) for name in (*RUNTIME_C_FILES, *(each.path for each in more))]
    folders = sorted({str(Path(include_dir(), folder)) for each in more for folder in each.include_dirs})
    flags = get_cflags(opt_level="1", debug_level="0", multi_file=True)
    return [
        extension
        for (sources, name), (files, headers) in zip(groups, made, strict=True)
        for extension in build_using_shared_lib(
            sources, str(name), [*files, *library], headers, str(target / "c"), [*flags], folders
        )
    ]  # fmt: skip


def reduce(translated: Path) -> None:
    """Leave of what `translate` made what a further part needs: nothing of parts, and of the emulator's C the headers.

    mypyc takes its work for valid without the C then.  Else it would read and digest all files of a library for each
    module in it: gigabytes, for the emulator.
    """
    for part in (translated / "mypy").rglob(f"{part_name('')}*"):
        part.unlink()
    for known in (translated / "mypy").rglob("*.ir.json"):
        known.write_text(json.dumps({**json.loads(known.read_bytes()), "src_hashes": {}}), "utf-8")
    for made in (translated / "c").rglob("*"):
        if made.is_file() and made.suffix != ".h":
            made.unlink()


def kept(store: Path) -> Path:
    """Where a build in `store` has mypyc's work.  Another version of mypyc does not find it: it would fit nothing."""
    try:
        return store / KEPT / version("mypy")
    except PackageNotFoundError:
        return store / KEPT / "none"


def _group(part: str) -> str:
    return f"c2000_{part}"


def _c_file(source: str) -> str:
    """The C file that mypyc writes for a source."""
    return f"__native_{source.replace('/', '___')}.c"


def _library(name: str) -> str:
    """The library of a part of firmware, or of the emulator (`GROUP`)."""
    return f"{name if name == GROUP else _group(name)}__mypyc"


def build(
    own: Iterable[Path] = (), *, root: Path = ROOT, store: Path = STORE,
    progress: Callable[[float], None] = lambda fraction: None,
) -> int:  # fmt: skip
    """Compile what is not compiled yet.  Returns how many modules that was.

    If a source of the emulator has changed, that is everything, and the new build takes the place of the one before.
    Else it is the parts of firmware that the build does not have, which are put beside the others: those of the C files
    `own`, if there are any.  `progress` is told the fraction 0..1 of the C files that are compiled.
    """
    own = list(own)
    sources = {name: digest(root / name) for name in _matching(root, *SOURCES)}
    state, known = find_build(store, root)
    fresh = state == "fresh" and kept(store).exists()
    wanted = {part_name(identity): (identity, part) for identity, part in parts(own, alone=fresh and bool(own)).items()}
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
            shutil.copytree(kept(store), kept(work))
        extensions = translate(root, kept(work), dict(wanted.values()))
        if any(digest(root / name) != before for name, before in sources.items()):
            raise BuildError("a source changed during the build: run hil build again")
        by_name = {e.name: e for e in extensions}
        if missing := {*modules, *wanted} - set(by_name):
            raise BuildError(f"mypyc did not compile {', '.join(sorted(missing))}")
        # The C of firmware takes longest: it is begun first.  `emulator/compiled.py` needs no more than the libraries.
        libraries = [*map(_library, wanted), *([] if fresh else [_library(GROUP)])]
        levels = {_c_file(name.removesuffix(".py")): HOT_LEVEL for name in HOT}
        levels |= {_c_file(name): WATCHED_LEVEL for name, (_, part) in wanted.items() if part.watch}
        _compile([by_name[name] for name in libraries], work, made, progress, levels)
        place = parts_of(made, sources)
        for name in wanted:
            (place / name).mkdir(parents=True)
            file = made / _file(made, _library(name))
            file.rename(place / name / file.name)
        # Running processes keep the files that they have.
        if fresh:
            _put_beside(place, parts_of(store, sources))
        else:
            manifest = {"sources": sources, "modules": modules, "library": _file(made, _library(GROUP))}
            (made / MANIFEST).write_text(json.dumps(manifest, indent=1), "utf-8")
            reduce(kept(work))
            (work / KEPT).rename(made / KEPT)
            clean(store)
            made.rename(store)
    return len(modules) + len(wanted)


def _put_beside(made: Path, place: Path) -> None:
    """Put each part that was made beside the others, unless another build has just done so."""
    for part in made.iterdir():
        try:
            part.rename(place / part.name)
        except FileNotFoundError:
            raise BuildError("another build has taken the place of this one: run hil build again") from None
        except OSError:
            if not (place / part.name).exists():
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
    _compile([Extension("probe", [str(source)])], work, work / "probe", lambda fraction: None, {})


def _compile(
    extensions: list[Any], work: Path, made: Path, progress: Callable[[float], None], levels: Mapping[str, str]
) -> None:  # fmt: skip
    """Compile extensions, and put what they become in `made`.  `levels`: C files that have another level than `-O1`."""
    from setuptools import Distribution
    from setuptools.command.build_ext import build_ext
    from setuptools.errors import BaseError, CCompilerError

    class SideBySide(build_ext):
        def build_extensions(self) -> None:
            headers: dict[str, list[str]] = {}
            if self.compiler.compiler_type == "unix":
                for extension in extensions:  # else a product and a sum become one operation where there is one (ARM)
                    extension.extra_compile_args.append("-ffp-contract=off")
                    # Nobody reads warnings about written C, and those about indentation are half of gcc's time.
                    extension.extra_compile_args.append("-Wno-all")
                    # Each C file of a library defines the table of the other one that it uses: one table for all.
                    extension.extra_compile_args.append("-fcommon")
                    # Libraries find each other by capsules.  Else each call between the C files of one goes through a
                    # table, because another library might replace the function: some 1.05 times the pace.
                    extension.extra_compile_args += ["-fvisibility=hidden", "-fno-plt"]
                    headers |= _read_headers_once(self.compiler, extension, work)
            _build_extensions(self, work, progress, levels, headers)

    command = SideBySide(Distribution({"name": GROUP, "ext_modules": extensions}))
    command.build_lib, command.build_temp = str(made), str(work / "objects")
    command.finalize_options()
    try:
        with _in_folder(work):
            command.run()
    except (BaseError, CCompilerError) as error:  # the second is no kind of the first
        raise BuildError(f"the C compiler failed: {error}") from None


def _read_headers_once(compiler: Any, extension: Any, work: Path) -> dict[str, list[str]]:
    """C file of the emulator's library -> flags with which it gets that library's headers as read already.

    They are two megabytes, and there are 160 files.
    """
    if extension.name != _library(GROUP):
        return {}
    header = work / f"{GROUP}.h"
    header.write_text(f'#include "__native_{GROUP}.h"\n#include "__native_internal_{GROUP}.h"\n', "ascii")
    folders = [f"-I{folder}" for folder in (*extension.include_dirs, *compiler.include_dirs)]
    flags = [*compiler.compiler_so, *folders, *extension.extra_compile_args]
    compiler.spawn([*flags, "-x", "c-header", str(header), "-o", f"{header}.gch"])
    return {source: ["-include", str(header)] for source in extension.sources if Path(source).is_relative_to(work)}


def _build_extensions(
    command: Any, work: Path, progress: Callable[[float], None], levels: Mapping[str, str],
    headers: Mapping[str, list[str]],
) -> None:  # fmt: skip
    """Compile one C file a core, each once, though libraries share some; setuptools does one after the other.

    Those that are not in `work` are mypyc's own: their objects are kept, and not made again if they are there.
    `headers` is flags for files that have no level of their own.
    """
    library = str(kept(work) / OBJECTS)
    total, done = len({source for extension in command.extensions for source in extension.sources}), 0
    compile_in_turn = command.compiler.compile
    objects: dict[str, Future[list[str]]] = {}

    def compiled(source: str, options: dict[str, Any]) -> list[str]:
        nonlocal done
        made: list[str] = []
        ours = Path(source).is_relative_to(work)
        if not ours:
            options = {**options, "output_dir": library}
            made = command.compiler.object_filenames([source], output_dir=library)
        # gcc takes headers that it has read for another level, too, and fails later.
        level = levels.get(Path(source).name, "" if ours else HOT_LEVEL)
        flags = [level] if level else headers.get(source, [])
        options = {**options, "extra_postargs": [*options["extra_postargs"], *flags]}
        if not made or not all(map(os.path.exists, made)):
            made = compile_in_turn([source], **options)
        with one_at_a_time:
            done += 1
            progress(done / total)
        return made

    def compile_side_by_side(sources: list[str], **options: Any) -> list[str]:
        with one_at_a_time:
            for source in sources:
                if source not in objects:
                    objects[source] = files.submit(compiled, source, options)
        return [file for source in sources for file in objects[source].result()]

    command.compiler.compile = compile_side_by_side
    one_at_a_time = Lock()
    with ThreadPoolExecutor(os.cpu_count()) as files, ThreadPoolExecutor(len(command.extensions)) as libraries:
        made = [libraries.submit(command.build_extension, extension) for extension in command.extensions]
        try:
            for each in made:
                each.result()
        except BaseException:
            files.shutdown(wait=False, cancel_futures=True)
            raise


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
