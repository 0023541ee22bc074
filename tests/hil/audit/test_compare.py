"""Specimens: this tool sees every one at its line; a PC's tools are asked only where they are installed.

The table in README.md is what `hil audit --compare --markdown` prints: the form of all of it, and each column against
its tool where that is installed in the version that README.md names.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from emulator.rules import RULES
from hil.audit.compare.ours import seen
from hil.audit.compare.specimen import SPECIMENS, Specimen
from hil.audit.compare.table import OURS, SEEN, VersionComparison
from hil.audit.compare.tools import TOOLS, Tool, versions

README = Path(__file__).parents[3] / "README.md"


@pytest.fixture(scope="module")
def block() -> str:
    """What stands between the marks in README.md."""
    found = re.search(r"<!-- audit-compare -->\n(.*?)\n<!-- /audit-compare -->", README.read_text("utf-8"), re.DOTALL)
    assert found is not None
    return found[1]


@pytest.fixture(scope="module")
def readme(block: str) -> VersionComparison:
    """What README.md says that each tool sees."""
    lines = block.splitlines()
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|")]
    tools = table[0][2:]
    rows = {row[0]: dict(zip(tools, [mark == SEEN for mark in row[2:]], strict=True)) for row in table[2:-1]}
    by = re.findall(r"([\w-]+) ([\d.]+\d)", lines[-1])
    return VersionComparison(tools, {specimen.name: rows[specimen.about] for specimen in SPECIMENS}, dict(by))


def test_the_table_in_the_readme_has_the_form_that_the_command_prints(block: str, readme: VersionComparison) -> None:
    assert list(readme.tools) == [*(tool.name for tool in TOOLS), OURS]
    assert set(readme.versions) == {program for tool in TOOLS for program in tool.needs}
    assert readme.markdown() == block


@pytest.mark.parametrize("tool", TOOLS, ids=lambda t: t.name)
def test_the_readme_says_what_a_tool_sees(tool: Tool, readme: VersionComparison, tmp_path: Path) -> None:
    if tool.missing:
        pytest.skip(f"needs {tool.package}")
    known = {program: readme.versions[program] for program in tool.needs}
    installed = versions([tool])
    sees = {specimen.name: tool.sees(specimen, tmp_path) for specimen in SPECIMENS}
    assert any(sees.values()), "a tool that sees nothing at all is run wrongly"
    if installed != known:
        pytest.skip(f"README.md is about {known}, here is {installed}")
    assert sees == {name: row[tool.name] for name, row in readme.seen.items()}


@pytest.mark.parametrize("specimen", SPECIMENS, ids=lambda s: s.name)
def test_this_tool_sees_the_specimen_at_its_line(specimen: Specimen, readme: VersionComparison) -> None:
    assert specimen.rule in RULES
    assert seen(specimen)
    assert readme.seen[specimen.name][OURS]


def test_specimens_compile(tmp_path: Path) -> None:
    compiler = next((tool.needs[0] for tool in TOOLS if not tool.missing), None)
    if compiler is None:
        pytest.skip("needs gcc or clang")
    for specimen in SPECIMENS:
        subprocess.run([compiler, "-c", str(specimen.c_file), "-o", str(tmp_path / "x.o")], check=True)
