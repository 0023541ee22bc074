"""The compiled build: never used for other sources than its own, and then the same as Python."""

from __future__ import annotations

import ast
import gc
import itertools
import json
import os
import pickle
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from emulator import clock, compiled
from emulator.c28x.sites import Place
from firmware_model.image import link
from hil import build
from hil.bench import Bench
from hil.cli import accounts, invoke
from hil.robot.board import RobotBoard
from tests.emulator.c28x import as_methods

MODULE = "emulator.clock"
LIBRARY = "emulator.so"


def python(root: Path, *arguments: str, pure: bool = False) -> str:
    done = subprocess.run(
        [sys.executable, *arguments], cwd=root, capture_output=True, text=True, timeout=110,
        env={**os.environ, "HIL_PURE": "1" if pure else "0", "PYTHONPATH": str(root)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def chosen(root: Path, pure: bool = False) -> tuple[str, str]:
    """How a process that starts in `root` runs, and the end of the file it would take the clock from."""
    text = (
        "import emulator, importlib.util as u;"
        f"print(emulator.compiled.MODE, u.find_spec('{MODULE}').origin)"
    )  # fmt: skip
    mode, file = python(root, "-c", text, pure=pure).split()
    assert Path(file).is_relative_to(root)
    return mode, Path(file).suffix


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of the sources with a build that belongs to them (never loaded here, so an empty file will do)."""
    leave = shutil.ignore_patterns("__pycache__", "_compiled")
    shutil.copytree(compiled.ROOT / "emulator", tmp_path / "emulator", ignore=leave)
    (tmp_path / "hil").mkdir()
    shutil.copytree(compiled.ROOT / "hil" / "world", tmp_path / "hil" / "world", ignore=leave)
    store = tmp_path / compiled.STORE.relative_to(compiled.ROOT)
    store.mkdir(parents=True)
    (store / LIBRARY).touch()
    manifest = {"sources": sources_of(tmp_path), "modules": [MODULE], "library": LIBRARY}
    (store / compiled.MANIFEST).write_text(json.dumps(manifest), "utf-8")
    return tmp_path


def sources_of(tree: Path) -> dict[str, str]:
    return {p.relative_to(tree).as_posix(): compiled.digest(p) for p in sorted(tree.rglob("*.py"))}


def store_of(tree: Path) -> Path:
    return tree / compiled.STORE.relative_to(compiled.ROOT)


def test_a_build_of_these_sources_is_used_unless_it_is_declined(tree: Path) -> None:
    assert chosen(tree) == ("compiled", ".so")
    assert chosen(tree, pure=True) == ("pure", ".py")


@pytest.mark.parametrize("source", ["emulator/clock.py", "emulator/registers/core.py", "hil/world/robot.py"])
def test_after_any_change_the_source_runs(tree: Path, source: str) -> None:
    """registers/core.py is not compiled itself, but its constants are compiled into others."""
    path = tree / source
    before, times = path.read_bytes(), (path.stat().st_atime, path.stat().st_mtime)
    path.write_bytes(before + b"# changed\n")
    os.utime(path, times)  # not even the clock of the file system shows it
    assert chosen(tree) == ("stale", ".py")
    path.write_bytes(before)
    assert chosen(tree) == ("compiled", ".so")


@pytest.mark.parametrize("damage", ["source gone", "module gone", "no manifest", "manifest cut", "another form"])
def test_a_build_that_is_not_whole_is_left_alone(tree: Path, damage: str) -> None:
    store = store_of(tree)
    manifest = store / compiled.MANIFEST
    if damage == "source gone":
        (tree / "emulator" / "trace.py").unlink()
    elif damage == "module gone":
        (store / LIBRARY).unlink()
    elif damage == "no manifest":
        manifest.unlink()
    elif damage == "manifest cut":
        manifest.write_text(manifest.read_text("utf-8")[:-9], "utf-8")
    else:
        manifest.write_text("[]", "utf-8")
    assert compiled.find_build(store, tree) == ("stale", {})


def test_a_part_of_firmware_is_found_beside_the_build_that_it_was_compiled_with(tree: Path) -> None:
    store, sources = store_of(tree), sources_of(tree)
    one, other = compiled.parts_of(store, sources), compiled.parts_of(store, {**sources, MODULE: "0"})
    for place, name in ((one, "part_1"), (other, "part_2")):
        (place / name).mkdir(parents=True)
        (place / name / f"{name}.cpython.so").touch()
    state, files = compiled.find_build(store, tree)
    assert state == "fresh"
    assert files == {
        MODULE: str(store / LIBRARY), "part_1": str(one / "part_1" / "part_1.cpython.so"),
    }  # fmt: skip


@pytest.fixture
def small(tree: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., int]:
    """`hil build` in `tree` for parts of firmware of these identities: a library of C each."""
    setuptools = pytest.importorskip("setuptools", reason="needs the extra speed: pip install 'c2000-hil[speed]'")
    pytest.importorskip("mypyc", reason="needs the extra speed: pip install 'c2000-hil[speed]'")
    if shutil.which(os.environ.get("CC", "cc")) is None:
        pytest.skip("needs a C compiler: apt install gcc")
    compiled.parts_of(store_of(tree), sources_of(tree)).mkdir()
    build.kept(store_of(tree)).mkdir(parents=True)
    (build.kept(store_of(tree)) / "emulator").touch()

    def translate(_root: Path, target: Path, parts: dict[str, object]) -> list[Any]:
        assert [file.name for file in target.iterdir()] == ["emulator"]
        extensions = []
        for part in map(compiled.part_name, parts):
            name = build._library(part)
            source = target / f"{name}.c"
            source.write_text(f"#include <Python.h>\nPyMODINIT_FUNC PyInit_{name}(void) {{ return NULL; }}\n")
            extensions.append(setuptools.Extension(name, [str(source)]))
            extensions.append(setuptools.Extension(part, ["what makes one module of it.c"]))
        return [*extensions, setuptools.Extension(MODULE, ["of the build that is there.c"])]

    def made(*identities: str, meanwhile: Callable[[], object] = lambda: None) -> int:
        monkeypatch.setattr(build, "parts", lambda own, alone: dict.fromkeys(identities, SimpleNamespace(watch=True)))
        monkeypatch.setattr(build, "translate", lambda *of: (meanwhile(), translate(*of))[1])
        return build.build(root=tree, store=store_of(tree))

    return made


def test_a_part_that_is_missing_is_compiled_alone_and_put_beside_the_others(
    tree: Path, small: Callable[..., int]
) -> None:
    assert small("a" * 64) == 1
    _, one = compiled.find_build(store_of(tree), tree)
    assert set(one) == {MODULE, f"part_{'a' * 16}"}
    assert Path(one[f"part_{'a' * 16}"]).name.startswith(f"c2000_part_{'a' * 16}__mypyc.")
    assert small("b" * 64, "a" * 64) == 1
    state, both = compiled.find_build(store_of(tree), tree)
    assert state == "fresh"
    assert both.items() > one.items()
    assert set(both) - set(one) == {f"part_{'b' * 16}"}
    assert small("a" * 64, "b" * 64, meanwhile=lambda: pytest.fail("it was translated")) == 0
    assert [each.name for each in store_of(tree).parent.iterdir()] == [store_of(tree).name]


def test_what_another_mypyc_has_translated_is_not_used(
    tree: Path, small: Callable[..., int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A part that it makes does not fit the modules of that one: all is compiled anew."""
    monkeypatch.setattr(build, "version", lambda package: f"another {package}")
    with pytest.raises(FileNotFoundError):  # `small` translates nothing but parts
        small("a" * 64)
    assert not [*compiled.parts_of(store_of(tree), sources_of(tree)).iterdir()]


def test_two_builds_of_a_part_at_once_leave_one(tree: Path, small: Callable[..., int]) -> None:
    assert small("a" * 64, meanwhile=lambda: small("a" * 64)) == 1
    assert len(compiled.find_build(store_of(tree), tree)[1]) == 2


@pytest.mark.parametrize("change", ["a source", "the build"])
def test_a_part_is_left_out_when_something_has_changed_meanwhile(
    change: str, tree: Path, small: Callable[..., int]
) -> None:
    def changed() -> None:
        if change == "a source":
            (tree / "emulator" / "clock.py").write_text("", "utf-8")
        else:
            build.clean(store_of(tree))
            store_of(tree).mkdir()

    with pytest.raises(build.BuildError, match="run hil build again"):
        small("a" * 64, meanwhile=changed)
    assert not [*store_of(tree).glob("parts-*/*")]
    assert compiled.find_build(store_of(tree), tree) == ("stale", {})
    assert [each.name for each in store_of(tree).parent.iterdir()] == [store_of(tree).name]


def test_without_a_build_and_after_removing_it_python_runs(tree: Path) -> None:
    assert build.clean(store_of(tree))
    assert not build.clean(store_of(tree))
    assert compiled.find_build(store_of(tree), tree) == ("none", {})
    assert chosen(tree) == ("pure", ".py")


def test_a_stale_build_is_said_in_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(compiled, "MODE", "stale")
    assert invoke(["conformance", "no such file"]) == 2
    first, second, *more = capsys.readouterr().err.splitlines()
    assert "hil build" in first
    assert second.startswith("hil: error: ")
    assert not more


def test_without_a_compiler_the_command_says_what_is_missing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "mypyc", None)
    monkeypatch.setattr(build, "find_build", lambda store, root: ("none", {}))
    assert invoke(["build"]) == 2
    err = capsys.readouterr().err
    assert err.startswith("hil: error: ")
    assert "pip install 'c2000-hil[speed]'" in err
    assert build.STILL in err
    assert err.count("\n") == 1


def test_without_a_c_compiler_nothing_is_translated_and_the_build_before_stays(
    tree: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("mypyc", reason="needs the extra speed: pip install 'c2000-hil[speed]'")
    pytest.importorskip("setuptools", reason="needs the extra speed: pip install 'c2000-hil[speed]'")
    if sys.platform == "win32":
        pytest.skip("Visual C++ is found without CC")
    monkeypatch.setenv("CC", str(tree / "no-such-compiler"))
    monkeypatch.setattr(build, "translate", lambda root, target, parts: pytest.fail("it was translated"))
    with pytest.raises(build.BuildError, match="no-such-compiler") as told:
        build.build(root=tree, store=store_of(tree))
    assert str(told.value).endswith(build.STILL)
    assert "\n" not in str(told.value)
    assert compiled.find_build(store_of(tree), tree)[0] == "fresh"
    assert [each.name for each in store_of(tree).parent.iterdir()] == [store_of(tree).name]


def test_no_compiler_makes_one_operation_of_a_product_and_a_sum(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the machine has such an operation it rounds once: other bytes than Python's."""
    setuptools = pytest.importorskip("setuptools", reason="needs the extra speed: pip install 'c2000-hil[speed]'")
    seen: list[tuple[str, list[str]]] = []

    def seen_by(command: Any, _work: Path, *_more: object) -> None:
        seen.extend((command.compiler.compiler_type, each.extra_compile_args) for each in command.extensions)

    monkeypatch.setattr(build, "_build_extensions", seen_by)
    build._compile([setuptools.Extension("one", ["one.c"])], tmp_path, tmp_path / "made", lambda fraction: None, {})
    ((kind, options),) = seen
    assert kind != "unix" or "-ffp-contract=off" in options


def test_a_wheel_is_made_of_a_checkout_with_its_build(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    target = tmp_path_factory.mktemp("wheels")
    with pytest.raises(build.BuildError, match="no pyproject"):
        build.wheel(target, root=tree, store=store_of(tree))
    (tree / "pyproject.toml").touch()
    build.clean(store_of(tree))
    with pytest.raises(build.BuildError, match="run hil build first"):
        build.wheel(target, root=tree, store=store_of(tree))
    assert not [*target.iterdir()]


def test_a_wheel_that_cannot_be_made_is_one_line(tree: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    pytest.importorskip("wheel", reason="needs the extra speed: pip install 'c2000-hil[speed]'")
    (tree / "pyproject.toml").write_text("[build-system", "utf-8")
    target = tmp_path_factory.mktemp("wheels")
    with pytest.raises(build.BuildError, match="pip failed: ") as told:
        build.wheel(target, root=tree, store=store_of(tree))
    assert "\n" not in str(told.value)
    assert not [*target.iterdir()]


def test_why_lists_every_function_that_is_not_compiled_each_with_its_reason(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert invoke(["build", "--why", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    stays = {each["file"]: each for each in told["interpreted"]}
    assert all(each["functions"] and each["reason"] for each in stays.values())
    # Of the core: what is not compiled, and nothing else; of the firmware: what the image has.
    core = {p.relative_to(compiled.ROOT).as_posix() for p in (compiled.ROOT / "emulator").rglob("*.py")}
    core |= {f"hil/world/{p.name}" for p in (compiled.ROOT / "hil" / "world").glob("*.py")}
    left = {file for file in core - set(build.listed()) if [*build.functions_of(compiled.ROOT / file)]}
    assert left == {file for file in stays if file in core}
    image = link(RobotBoard())
    for path in image.linked.functions:
        module, _, name = path.rpartition(".")
        assert [file for file, each in stays.items() if name in each["functions"] and Path(file).stem == module], path
    assert told["compiled"] == sum(len([*build.functions_of(compiled.ROOT / name)]) for name in build.listed())

    assert invoke(["build", "--why"]) == 0
    lines = capsys.readouterr().out.splitlines()
    (line,) = (line for line in lines if line.startswith("  firmware_model/us.py: "))
    assert "Read_Distance" in line
    assert lines[lines.index(line) - 1] == f"{build.FIRMWARE_STAYS}:"


def test_each_reason_is_that_of_a_source() -> None:
    for reason, patterns in build.STAYS.items():
        for pattern in patterns:
            assert set(build._matching(compiled.ROOT, pattern)) - set(build.listed()), (reason, pattern)


def test_what_goes_together_with_why(capsys: pytest.CaptureFixture[str]) -> None:
    for wrong in (["--why", "--clean"], ["--json"]):
        assert invoke(["build", *wrong]) == 2
        assert "--why" in capsys.readouterr().err


def test_functions_are_found_by_name_methods_with_their_class(tmp_path: Path) -> None:
    source = tmp_path / "one.py"
    source.write_text("def f():\n  def g(): ...\nclass A:\n  def m(self): ...\n  class B:\n    def n(self): ...\n")
    assert [*build.functions_of(source)] == ["f", "A.m", "A.B.n"]


def test_the_command_explains_itself(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["build", "--help"]) == 0
    assert "hil build --clean" in capsys.readouterr().out


def test_what_must_stay_python_is_not_listed() -> None:
    listed = set(build.listed())
    assert {"emulator/clock.py", "emulator/peripherals/adc.py", "hil/world/robot.py"} <= listed
    stay = ("c28x/link.py", "c28x/sites.py", "sysbios/headers.py")
    for name in (f"emulator/{file}" for file in stay):
        assert (compiled.ROOT / name).exists()
        assert name not in listed
    assert not any(name.startswith("firmware_model") for name in listed)


def _has_float(node: ast.expr) -> bool:
    if isinstance(node, ast.Tuple):
        return any(map(_has_float, node.elts))
    return any(
        (isinstance(n, ast.Constant) and isinstance(n.value, float))
        or (isinstance(n, ast.BinOp) and isinstance(n.op, ast.Div))
        for n in ast.walk(node)
    )


@pytest.mark.parametrize("name", build.listed())
def test_no_constant_is_a_tuple_of_floats(name: str) -> None:
    """mypyc 2.4 takes such a `Final` for one that was never set, at run time; `tuple[float, ...]` is right."""
    for node in ast.walk(ast.parse((compiled.ROOT / name).read_text("utf-8"))):
        if isinstance(node, ast.AnnAssign) and isinstance(node.value, ast.Tuple):
            annotation = ast.unparse(node.annotation)
            if annotation.startswith("Final") and "..." not in annotation:
                assert not _has_float(node.value), f"{name}:{node.lineno}"


@pytest.mark.skipif(compiled.MODE != "compiled", reason="needs `hil build` (extra speed)")
def test_a_part_is_translated_alone_with_what_a_build_keeps(tmp_path: Path) -> None:
    kept = build.kept(compiled.STORE)
    there = shutil.copytree(kept, tmp_path / kept.name)
    before = {file: file.read_bytes() for file in (there / "c").rglob("*.h")}
    identity, part = next((i, p) for i, p in build.parts().items() if p.functions[0].function.module == "us")
    extensions = {each.name: each for each in build.translate(compiled.ROOT, there, {identity: part})}
    name = compiled.part_name(identity)
    sources = {Path(file).name for file in extensions[build._library(name)].sources}
    assert {f"__native_{name}.c", f"__native_{build._group(name)}.c"} < sources
    assert {file.name for file in (there / "c").glob("__native*.c")} < sources
    assert before == {file: file.read_bytes() for file in before}
    # What it has, and whose methods it calls, is known when it is compiled.
    written = (there / "c" / f"__native_{name}.c").read_text("utf-8")
    assert "Clock___run_due(" in written
    assert "CPY_GET_METHOD" not in written
    assert '"ProgramPart", "_c_clock"' not in written


@pytest.mark.skipif(compiled.MODE != "compiled", reason="needs `hil build` (extra speed)")
@pytest.mark.parametrize("more", [(), ("--realistic", "--fill", "stack", "--seed", "7"), ("--fix", "all")])
def test_both_ways_give_the_same_bytes_and_the_same_findings(more: tuple[str, ...]) -> None:
    run = ("-m", "hil", "run", "--no-port", "--pace", "max", "--for", "6", "--order", "mission", "--json", *more)
    one, other = (json.loads(python(compiled.ROOT, *run, pure=pure)) for pure in (False, True))
    assert one["uart_sha256"] == other["uart_sha256"]
    assert one["trace_sha256"] == other["trace_sha256"]
    assert one["findings"] == other["findings"]
    assert one["findings"] or "--fix" in more


@pytest.mark.parametrize("watch", [False, True])
@pytest.mark.parametrize("fixes", [(), ("all",)])
def test_a_robot_whose_functions_are_methods_drives_alike(
    fixes: tuple[str, ...], watch: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def driven(part: Callable[[str], Any]) -> tuple[Any, ...]:
        monkeypatch.setattr(compiled, "part", part)
        bench = Bench("room", fixes=fixes, watch=watch)
        bench.boot()
        bench.feed("#MISN\r")
        bench.run_for(1.0)
        told = [(f.rule, f.place, f.message, f.count) for f in bench.findings]
        with monkeypatch.context() as here:
            here.setattr(accounts, "MODE", "compiled")
            told_as.append(accounts.which_build(bench))
        return type(bench.firmware.linked.namespace), (bench.uart_sha256, bench.trace_sha256, told)

    told_as: list[str] = []
    texts = as_methods.modules(link(RobotBoard(), fixes=fixes, watch=watch).linked.parts)
    functions, one = driven(lambda _identity: None)
    methods, other = driven(texts.get)
    assert functions is dict
    assert methods is not dict
    assert one == other
    assert told_as == ["compiled build, interpreted firmware", "compiled build, compiled firmware"]


def test_an_interrupt_at_every_charge_finds_functions_and_methods_alike() -> None:
    """`Read_Distance`, interrupted after each 15 cycles more (no step is shorter); the routine changes what it uses."""

    def distances(part: Callable[[str], Any]) -> tuple[Any, ...]:
        board = RobotBoard()
        firmware = link(board, built=part)
        cpu, clock, findings = board.cpu, board.clock, firmware.linked.runtime.findings
        firmware.us.Init_US()

        def routine() -> None:
            interrupted.append((clock.now - begun, findings.here(3)))
            clock.charge(37)
            firmware.us.L_Calib_b = firmware.us.L_Calib_b + 1.0

        cpu.connect(12, routine)
        cpu.write_ier(1 << 11)
        cpu.enable_interrupts()
        codes = itertools.cycle((400, 380, 386, 1200, 1190, 300, 90))  # with steps over and under the filter's limit
        board.adc["A"].force_codes(lambda soc: next(codes))
        interrupted: list[tuple[int, tuple[Place, ...]]] = []
        results = []
        for after in range(0, 6000, 15):
            firmware.us.L_Calib_b = 0.0
            begun = clock.now
            clock.after(after, lambda: cpu.raise_line(12))
            results.append((firmware.us.Read_Distance(0), clock.now - begun, firmware.us.L_Calib_b))
        told = [(f.rule, f.place, f.message, f.count) for f in findings]
        return type(firmware.linked.namespace), (results, interrupted, told)

    texts = as_methods.modules(link(RobotBoard()).linked.parts)
    functions, one = distances(lambda _identity: None)
    methods, other = distances(texts.get)
    assert functions is dict
    assert methods is not dict
    assert one == other == distances(compiled.part)[1]  # the last is the compiled program, where there is a build
    results, interrupted, told = one
    assert {"Read_Distance", "Read_Channel"} <= {path[0].function for _, path in interrupted if path}
    assert {0.0, 1.0} <= {shift for _, _, shift in results}
    assert len({distance for distance, _, _ in results}) > 6
    assert {"index", "uninitialised"} <= {rule for rule, *_ in told}


def test_a_debugger_finds_the_firmware_interpreted(monkeypatch: pytest.MonkeyPatch) -> None:
    name = compiled.part_name("0123456789abcdef0")
    monkeypatch.setattr(sys, "meta_path", [compiled.Finder({name: "firmware.so"}), *sys.meta_path])
    monkeypatch.setitem(sys.modules, name, module := ModuleType(name))
    monkeypatch.delitem(sys.modules, "pydevd", raising=False)
    if sys.gettrace() is None:
        assert compiled.part("0123456789abcdef0") is module
    monkeypatch.setitem(sys.modules, "pydevd", ModuleType("pydevd"))
    assert compiled.part("0123456789abcdef0") is None


class Compiler:
    """A compiler that writes down what it compiles, and with which options."""

    def __init__(self) -> None:
        self.options: dict[str, list[str]] = {}

    def object_filenames(self, sources: list[str], *, output_dir: str) -> list[str]:
        return [f"{output_dir}/{Path(source).name}.o" for source in sources]

    def compile(self, sources: list[str], *, output_dir: str, extra_postargs: list[str]) -> list[str]:
        (source,) = sources
        assert source not in self.options
        self.options[source] = extra_postargs
        if source.endswith("bad.c"):
            raise OSError("bad.c")
        (made,) = self.object_filenames(sources, output_dir=output_dir)
        Path(made).parent.mkdir(parents=True, exist_ok=True)
        Path(made).touch()
        return [made]


class Command:
    """As setuptools' `build_ext`: makes each extension of its sources."""

    def __init__(self, objects: Path, *extensions: list[str]) -> None:
        self.compiler = Compiler()
        self.extensions = [SimpleNamespace(sources=sources) for sources in extensions]
        self.linked: list[list[str]] = []
        self._objects = str(objects)

    def build_extension(self, extension: SimpleNamespace) -> None:
        made = self.compiler.compile(extension.sources, output_dir=self._objects, extra_postargs=["-O1"])
        self.linked.append(made)


def test_files_are_compiled_side_by_side_each_once_and_linked_in_their_order(tmp_path: Path) -> None:
    names = [str(tmp_path / f"{number}.c") for number in range(8)]
    part, hot = str(tmp_path / "__native_part_1.c"), str(tmp_path / "__native_emulator___clock.c")
    told = list[float]()
    objects = tmp_path / "objects"
    command = Command(objects, names, [part, hot, *names])
    compiler = command.compiler
    headers = {name: ["-include", "read.h"] for name in (*names, hot)}
    build._build_extensions(command, tmp_path, told.append, {Path(hot).name: "-O2"}, headers)
    made = [str(objects / f"{Path(name).name}.o") for name in (part, hot, *names)]
    assert sorted(command.linked, key=len) == [made[2:], made]
    cold = {name: ["-O1", "-include", "read.h"] for name in names} | {part: ["-O1"]}
    assert compiler.options == cold | {hot: ["-O1", "-O2"]}
    assert told == pytest.approx([number / 10 for number in range(1, 11)])
    with pytest.raises(OSError, match=r"bad\.c"):
        build._build_extensions(
            Command(objects, [*names, str(tmp_path / "bad.c")], [part]), tmp_path, told.append, {}, {}
        )


def test_each_hot_source_is_compiled() -> None:
    assert set(build.HOT) <= set(build.listed())


@pytest.mark.skipif(compiled.MODE != "compiled", reason="needs `hil build` (extra speed)")
def test_a_build_has_a_library_for_the_emulator_and_one_a_part_and_modules_know_who_they_are() -> None:
    files = sorted(compiled.STORE.rglob(f"*{Path(clock.__file__).suffix}"))
    parts = [file for file in files if file.parent.name.startswith("part_")]
    assert [file.parent for file in files if file not in parts] == [compiled.STORE]
    assert len({file.parent for file in parts}) == len(parts)
    assert (clock.__name__, clock.__package__) == (MODULE, "emulator")
    assert clock.__spec__.name == MODULE
    assert Path(clock.__file__).is_relative_to(compiled.STORE)
    assert pickle.loads(pickle.dumps(clock.Clock)) is clock.Clock


@pytest.mark.skipif(compiled.MODE != "compiled", reason="needs `hil build` (extra speed)")
def test_a_module_that_was_forgotten_is_found_again() -> None:
    """Runs of pytest within a test forget what they have imported, and the library has the module's address."""
    identity = next(iter(build.parts()))
    first = compiled.part(identity)
    assert first is not None
    before = id(first)
    del sys.modules[compiled.part_name(identity)], first
    gc.collect()
    again = compiled.part(identity)
    assert (type(again), id(again)) == (ModuleType, before)
    assert hasattr(again, "ProgramPart")


def test_what_every_library_contains_is_compiled_once_and_kept(tmp_path: Path) -> None:
    """The C files of mypyc, which are not those of this build."""
    library, work, objects = str(tmp_path / "mypyc" / "int_ops.c"), tmp_path / "work", tmp_path / "work" / "objects"
    compiled_then, linked = [], []
    for number in range(2):
        command = Command(objects, [str(work / f"{number}.c"), library])
        build._build_extensions(command, work, lambda fraction: None, {}, {})
        compiled_then.append({Path(source).name for source in command.compiler.options})
        linked.append(command.linked[0][1])
    assert compiled_then == [{"0.c", "int_ops.c"}, {"1.c"}]
    assert linked == [str(build.kept(work) / build.OBJECTS / "int_ops.c.o")] * 2
