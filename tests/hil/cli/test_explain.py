"""``hil explain``."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from emulator.rules import RULES
from hil.cli import invoke
from hil.cli.explain import complete_rule


def test_the_table_has_every_rule(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["explain"]) == 0
    words = set(capsys.readouterr().out.split())
    assert set(RULES) <= words


@pytest.mark.parametrize("rule", RULES)
def test_every_page_is_shown(rule: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["explain", rule]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert out.startswith(f"{rule} {RULES[rule].family}, {RULES[rule].how}, {RULES[rule].severity.value}")
    assert " ".join(RULES[rule].title.split()) in out
    # Markdown is rendered, not printed.
    assert "**" not in out
    assert "```" not in out


def test_an_unknown_rule_is_one_line_with_what_may_be_meant(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["explain", "rotation-sing"]) == 2
    err = capsys.readouterr().err
    assert err.startswith("hil: error: no rule 'rotation-sing': did you mean rotation-sign")
    assert err.count("\n") == 1


def test_json_has_the_rule_or_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert invoke(["explain", "unit", "--json"]) == 0
    one = json.loads(capsys.readouterr().out)
    assert one["page"] == RULES["unit"].page
    assert invoke(["explain", "--json"]) == 0
    rules = json.loads(capsys.readouterr().out)["rules"]
    assert [rule["id"] for rule in rules] == list(RULES)
    assert one in rules


def test_identifiers_are_completed() -> None:
    assert set(complete_rule("rotation-")) == {"rotation-sign", "rotation-scale", "rotation-bias"}
    done = subprocess.run(
        [sys.executable, "-c", "from hil.__main__ import main; main()"],
        env={**os.environ, "_HIL_COMPLETE": "complete_bash", "COMP_WORDS": "hil explain rotation-s", "COMP_CWORD": "2"},
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert set(done.stdout.split()) == {"rotation-sign", "rotation-scale"}
