"""The core runs without what extras bring, and says in one line which one is wanted."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Final

import pytest

from hil.extras import EXTRAS, hint

REPOSITORY: Final = Path(__file__).parents[2]
DECLARED: Final = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
#: A trace as small as one can be.
QUICK: Final = ("run", "--no-port", "--pace", "max", "--for", "0.2")


def without(packages: tuple[str, ...], folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """`hil` in a process in which these packages are not installed."""
    code = f"import sys; sys.modules.update(dict.fromkeys({packages})); from hil.cli import invoke; "
    return subprocess.run(
        [sys.executable, "-c", code + f"sys.exit(invoke({list(arguments)}))"], cwd=folder, capture_output=True,
        text=True, timeout=120, check=False, env={"PYTHONPATH": str(REPOSITORY), "PATH": "", "COLUMNS": "200"},
    )  # fmt: skip


def test_each_package_stands_in_its_extra_and_not_in_the_core() -> None:
    #: As `pip` calls what is imported under another name.
    distribution = {"vcd": "pyvcd", "mypyc": "mypy"}
    core = " ".join(DECLARED["dependencies"])
    for package, (_, extra) in EXTRAS.items():
        wanted = re.compile(rf"^{distribution.get(package, package)}\b")
        assert any(wanted.match(line) for line in DECLARED["optional-dependencies"][extra]), package
        assert not wanted.search(core)


def test_who_takes_all_lacks_nothing_for_users() -> None:
    everything, pytest_of_hil_new = DECLARED["optional-dependencies"]["all"]
    taken = set(re.findall(r"[\w-]+", everything.partition("[")[2]))
    assert taken == {extra for _, extra in EXTRAS.values()} - {"speed", "docs"} | {"c"}
    assert pytest_of_hil_new.startswith("pytest>=")


@pytest.mark.parametrize(
    ("package", "arguments"),
    [
        ("matplotlib", [*QUICK, "--plot", "drive.png"]),
        ("matplotlib", ["check", "--for", "1", "--html", "report.html"]),
        ("matplotlib", ["audit", "US-accumulator", "--plot", "accumulator.png"]),
        ("matplotlib", ["drive", "nowhere", "tele", "--png", "drive.png"]),
        ("matplotlib", ["tune", "--plot", "annex4.png"]),
        ("numpy", ["calibrate", "--thesis"]),
        ("numpy", ["compare-filters"]),
        ("numpy", ["blind-spots"]),
        ("textual", ["console"]),
        ("nicegui", ["run", "--view"]),
        ("nicegui", ["console", "--port", "nowhere", "--view"]),
    ],
)
def test_a_missing_one_is_one_line(package: str, arguments: list[str], tmp_path: Path) -> None:
    done = without((package,), tmp_path, *arguments)
    assert (done.returncode, done.stderr) == (2, f"hil: error: {hint(package)}\n")
    assert hint(package).count("pip install 'c2000-hil[") == 1
    assert not done.stdout
    assert not list(tmp_path.iterdir()), "nothing was begun"


def test_of_a_trace_too(tmp_path: Path) -> None:
    assert without(tuple(EXTRAS), tmp_path, *QUICK, "--trace", "run.trace").returncode == 0
    suffixes = {"vcd": "vcd", "numpy": "npz", "mcap": "mcap", "pyarrow": "parquet", "perfetto": "pftrace"}
    for package, suffix in suffixes.items():
        done = without((package,), tmp_path, "export", "run.trace", f"run.{suffix}")
        assert (done.returncode, done.stderr) == (2, f"hil: error: {hint(package)}\n")
        assert not (tmp_path / f"run.{suffix}").exists()
    assert without(tuple(EXTRAS), tmp_path, "export", "run.trace", "run.csv").returncode == 0


@pytest.mark.slow
def test_nothing_else_wants_any(tmp_path: Path) -> None:
    for arguments in (
        [*QUICK, "--order", "mission", "--json"],
        ["check", "--for", "2", "--fail-on", "never", "--json"],
        ["tasks", "--for", "1"], ["audit", "US-accumulator"], ["scenario", "--schema"], ["board"],
        ["docs", "rules"], ["explain", "index"], ["faults"], ["new", "mine", "--language", "python"],
    ):  # fmt: skip
        done = without(tuple(EXTRAS), tmp_path, *arguments)
        assert done.returncode == 0, (arguments, done.stderr)
    done = without(tuple(EXTRAS), tmp_path, "demo")
    assert done.returncode == 2
    assert done.stderr.count("pip install 'c2000-hil[") == 3
    assert done.stderr.count("\n") == 1
