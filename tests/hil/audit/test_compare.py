"""Specimens: this tool sees every one at its line; a PC's tools are asked only where they are installed."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from emulator.rules import RULES
from hil.audit.compare.ours import seen
from hil.audit.compare.specimen import SPECIMENS, Specimen
from hil.audit.compare.tools import TOOLS, Tool


@pytest.mark.parametrize("specimen", SPECIMENS, ids=lambda s: s.name)
def test_this_tool_sees_the_specimen_at_its_line(specimen: Specimen) -> None:
    assert specimen.rule in RULES
    assert seen(specimen)


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
def test_a_tool_is_able_to_see_something(tool: Tool, tmp_path: Path) -> None:
    """A tool that sees nothing at all is run wrongly: each is known for one of these."""
    if tool.missing:
        pytest.skip(f"needs {tool.package}")
    known = {"accumulator", "null_pointer", "chained", "octets"}
    assert any(tool.sees(specimen, tmp_path) for specimen in SPECIMENS if specimen.name in known)


def test_specimens_compile(tmp_path: Path) -> None:
    compiler = next((tool.needs[0] for tool in TOOLS if not tool.missing), None)
    if compiler is None:
        pytest.skip("needs gcc or clang")
    for specimen in SPECIMENS:
        subprocess.run([compiler, "-c", str(specimen.c_file), "-o", str(tmp_path / "x.o")], check=True)
