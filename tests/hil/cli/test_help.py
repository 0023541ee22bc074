"""Help is read, not searched: groups where there are many options, lists without gaps, examples that fit a line."""

from __future__ import annotations

import re
from typing import Any

import pytest
from typer.core import TyperOption

from hil.cli import commands, invoke
from hil.cli.help import GROUPS, MAX_UNGROUPED, with_lists
from hil.client.orders import KEYWORDS

COMMANDS: dict[str, Any] = {name: unopened.whole for name, unopened in commands.COMMANDS.items()}


@pytest.fixture(params=sorted(COMMANDS))
def helped(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> str:
    """The help of a command in a terminal of 80 columns."""
    monkeypatch.setenv("COLUMNS", "80")
    assert invoke([request.param, "--help"]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize("name", sorted(COMMANDS))
def test_many_options_are_grouped_each_in_one_group(name: str) -> None:
    options = [each for each in COMMANDS[name].params if isinstance(each, TyperOption)]
    if len(options) > MAX_UNGROUPED:
        groups = {each.name: each.rich_help_panel for each in options}
        assert all(group in GROUPS for group in groups.values()), groups
        assert len(set(groups.values())) > 1
    else:
        assert all(each.rich_help_panel is None for each in options)


def test_a_name_belongs_to_one_group_and_some_command_has_it() -> None:
    names = [name for each in GROUPS.values() for name in each]
    assert len(names) == len(set(names))
    assert set(names) <= {option.name for command in COMMANDS.values() for option in command.params}


def test_examples_and_exit_status_stand_below_each_other_each_on_its_line(helped: str) -> None:
    written = helped.splitlines()
    lines = [line.strip() for line in written]
    assert not re.search(r"Examples +hil |Exit status +\d", helped)
    for heading in {"Examples", "Exit status"} & set(lines):
        listed = lines[lines.index(heading) + 1 :]
        listed = listed[: listed.index("")]
        assert listed
        begin = lines.index(heading) + 1
        # A column of typer's own, and two more.
        assert all(line.startswith("   ") for line in written[begin : begin + len(listed)])
        assert all(re.match(r"hil |\d+ ", line) for line in listed), listed


@pytest.mark.parametrize(
    ("name", "usage"),
    [
        ("drive", "hil drive [OPTIONS] PORT ORDER..."), ("check", "hil check [OPTIONS] [SCENARIO.toml | FILE...]"),
        ("rta", "hil rta [OPTIONS] [SHEET]"), ("compare", "hil compare [OPTIONS] LOG LOG"),
        ("audit", "hil audit [OPTIONS] [ID...]"), ("new", "hil new [OPTIONS] NAME"),
    ],
)  # fmt: skip
def test_the_usage_is_written_as_manual_pages_write_it(
    name: str, usage: str, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    assert invoke([name, "--help"]) == 0
    assert f" Usage: {usage} " in capsys.readouterr().out


@pytest.mark.parametrize("name", ["run", "check", "tasks", "diff"])
def test_the_spellings_of_orders_are_listed(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    monkeypatch.setenv("COLUMNS", "300")
    assert invoke([name, "--help"]) == 0
    (told,) = (line for line in capsys.readouterr().out.splitlines() if "[TIME:]ORDER" in line)
    assert all(word in told for word in (*KEYWORDS, "set V W", "#RAW"))


def test_prose_is_joined_and_lists_are_kept() -> None:
    text = "What it\n  does.\n\n\n\n[bold]Examples[/bold]\n    hil x\n    hil y\n"
    indent = "[bold][/bold]  "
    assert with_lists(text) == f"What it does.\n\n\b[bold]Examples[/bold]\n{indent}hil x\n{indent}hil y"


def test_no_option_takes_an_infinity_nan_or_a_number_of_hundreds_of_digits(capsys: pytest.CaptureFixture[str]) -> None:
    numbers = [
        (name, param.opts[0])
        for name, command in commands.COMMANDS.items()
        for param in command.whole.params
        if isinstance(param, TyperOption) and param.type.name.startswith("float")
    ]
    assert ("run", "--for") in numbers
    for name, option in numbers:
        for number in ("inf", "nan", "-inf", "1e303"):
            assert invoke([name, option, number]) == 2
            assert re.search(rf"'{option}': \S+ is not (a number from|in the range)", capsys.readouterr().err)
