"""The bad day, a few cases of each figure; `--bad-day SECONDS`: each test goes on with further seeds for so long.

`python -m tests.bad_day --seconds 600` prints the table.
"""

from __future__ import annotations

import os
import re
import signal
import time
from collections.abc import Callable, Iterator

import pytest

import hil.cli
from tests.bad_day import commands, files, view
from tests.bad_day.family import FIGURES, tried
from tests.bad_day.figure import Figure, forked

#: Seeds beyond those of every run, a stretch for each test.
FURTHER = 1_000_000
BATCHES = [
    pytest.param(figure, first, id=f"{figure.name.replace(' ', '-')}-{first}")
    for figure in FIGURES
    for first in range(0, figure.few, figure.batch)
]


def _seeds(figure: Figure, first: int, seconds: float) -> Iterator[int]:
    yield from range(first, min(first + figure.batch, figure.few))
    end, seed = time.monotonic() + seconds, FURTHER + first * 1000
    while time.monotonic() < end:
        yield seed
        seed += 1


@pytest.mark.slow
@pytest.mark.parametrize(("figure", "first"), BATCHES)
def test_it_comes_to_nothing_worse_than_a_line(figure: Figure, first: int, request: pytest.FixtureRequest) -> None:
    if why := figure.missing():
        pytest.skip(why)
    seconds = request.config.getoption("--bad-day")
    failures = [found for seed in _seeds(figure, first, seconds) if (found := tried(figure, seed))]
    if figure.case is view.case:
        failures += view.ended()
    assert not failures, "\n".join(failures)


def test_the_walk_meets_all_that_the_commands_take() -> None:
    walked = {(case.command, option) for case in commands.CASES for option in case.given if option.startswith("--")}
    taken = {(command, option) for command, _, kind, option in commands.parameters() if kind in (int, float, str)}
    named = {each for each in taken if each[1].startswith("--")}
    assert named
    assert named <= walked
    assert len({case.command for case in commands.CASES}) >= 25
    assert {commands.chosen(seed) for seed in range(len(commands.CASES))} == set(commands.CASES)


def test_no_option_takes_a_whole_number_of_hundreds_of_digits(capsys: pytest.CaptureFixture[str]) -> None:
    numbers = [(command, option) for command, _, kind, option in commands.parameters() if kind is int]
    assert ("run", "--seed") in numbers
    for command, option in numbers:
        assert hil.cli.invoke([command, option, "9" * 400]) == 2
        assert re.search(rf"'{option}': 99\S+ is not in the range \d+<=x<=\d+", capsys.readouterr().err), option


def test_each_option_that_writes_is_tried_on_a_bad_disk() -> None:
    writing = set(files.writing())
    assert writing == files.OUTPUTS.keys() | files.LEFT_OUT.keys()
    assert len(files.OUTPUTS) >= 25


def _defect() -> int:
    """A command of which an exception escapes that nobody expected.  In a child, so the application is lost with it."""
    hil.cli.app = lambda **_: {}["nothing"]  # type: ignore[assignment]
    return hil.cli.invoke(["board", "--json"])


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs os.fork, which this system lacks")
@pytest.mark.parametrize(
    ("does", "found"),
    [
        (lambda: 2, "0 lines"),
        (lambda: int("x"), "status 99"),
        (lambda: _defect(), "status 70"),
        (lambda: os.kill(os.getpid(), signal.SIGKILL), "signal 9"),
        (lambda: len(bytearray(400 << 20)) * 0, "MB"),
        (lambda: hil.cli.print_error("x y " * 2000) or 2, "endless"),
        (lambda: hil.cli.print_error("late") or sum(range(200_000_000)) * 0 + 2, "s of CPU"),
    ],
)
def test_the_walk_sees_what_is_wrong(does: Callable[[], int], found: str) -> None:
    assert any(found in each for each in commands.wrong(forked(does)))
