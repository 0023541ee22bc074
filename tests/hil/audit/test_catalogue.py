"""Every entry of the catalogue shows on the faithful firmware, and on neither corrected one."""

from __future__ import annotations

import pytest

from emulator.rules import RULES
from firmware_model.catalogue import CATALOGUE
from hil.audit.demonstrations import DEMONSTRATIONS
from hil.audit.run import demonstrate


def test_every_entry_has_a_demonstration_and_every_demonstration_an_entry() -> None:
    assert list(DEMONSTRATIONS) == list(CATALOGUE)


def test_every_entry_is_seen_by_a_rule_that_exists() -> None:
    assert {defect.rule for defect in CATALOGUE.values()} <= set(RULES)


def test_no_entry_leaves_a_question_open() -> None:
    for defect in CATALOGUE.values():
        for field in ("place", "wrong", "source", "symptom", "correction"):
            assert getattr(defect, field).strip(), f"{defect.id}.{field}"


@pytest.mark.parametrize("name", DEMONSTRATIONS)
def test_an_entry_is_proven(name: str) -> None:
    outcome = demonstrate(name)
    assert not outcome.error, outcome.error
    faithful, corrected, all_corrected = outcome.faithful, outcome.corrected, outcome.all_corrected
    assert faithful is not None
    assert faithful.seen, f"faithful: {faithful.line}"
    assert corrected is not None
    assert not corrected.seen, f"corrected: {corrected.line}"
    assert all_corrected is not None
    assert not all_corrected.seen, f"all corrected: {all_corrected.line}"
