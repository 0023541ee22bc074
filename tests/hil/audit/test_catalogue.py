"""Every entry of the catalogue shows on the faithful firmware, and on neither corrected one."""

from __future__ import annotations

import pytest

from emulator.image import Firmware
from emulator.rules import RULES, Severity
from firmware_model.catalogue import CATALOGUE, DefectKind
from firmware_model.corrections import ALL
from firmware_model.image import link
from hil.audit.demonstrations import DEMONSTRATIONS
from hil.audit.evidence import EvidenceKind
from hil.audit.rig import Rig
from hil.audit.run import all_but_one, demonstrate
from hil.robot.board import RobotBoard


def test_every_entry_has_a_demonstration_and_every_demonstration_an_entry() -> None:
    assert list(DEMONSTRATIONS) == list(CATALOGUE)


def test_every_entry_is_seen_by_a_rule_that_exists() -> None:
    assert {defect.rule for defect in CATALOGUE.values()} <= set(RULES)


def test_no_entry_leaves_a_question_open() -> None:
    for defect in CATALOGUE.values():
        for field in ("place", "wrong", "source", "symptom", "correction"):
            assert getattr(defect, field).strip(), f"{defect.id}.{field}"


def test_what_never_runs_or_stands_only_in_the_text_is_not_grave() -> None:
    grave = {defect.id for defect in CATALOGUE.values() if defect.severity is Severity.ERROR}
    assert grave
    never_runs = {d.id for d in CATALOGUE.values() if d.gone_with or d.rule == "never-called"}
    figures = {d.id for d in CATALOGUE.values() if d.kind is DefectKind.FIGURE}
    # No symptom on the robot, by their own words.
    harmless = {d.id for d in CATALOGUE.values() if d.symptom.startswith("None today")}
    assert grave.isdisjoint(never_runs | figures | harmless)


def functions(image: Firmware) -> set[tuple[str, str]]:
    """C file and name of each function of an image."""
    return {(f.c_file, f.name) for module in image.linked.program.modules.values() for f in module.functions}


def test_all_corrections_link_the_function_of_an_entry_or_the_entry_says_which_one_takes_it_away() -> None:
    faithful, corrected = functions(link(RobotBoard())), functions(link(RobotBoard(), fixes=[ALL]))
    gone = {d.id: d.gone_with for d in CATALOGUE.values() if (d.c_file, d.function) in faithful - corrected}
    takers = set(gone.values()) - {""}
    assert takers <= set(CATALOGUE)
    assert {name: taker for name, taker in gone.items() if name not in takers} == {
        d.id: d.gone_with for d in CATALOGUE.values() if d.gone_with
    }


def test_with_all_corrections_nothing_is_left_that_the_typed_tree_shows() -> None:
    assert [f"{f.rule}: {f.message}" for f in Rig([ALL], static=True).findings] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", DEMONSTRATIONS)
def test_an_entry_is_shown_by_evidence_of_its_rule(name: str) -> None:
    outcome = demonstrate(name)
    assert not outcome.error, outcome.error
    faithful, corrected, all_corrected = outcome.faithful, outcome.corrected, outcome.all_corrected
    assert faithful is not None
    assert faithful.seen, f"faithful: {faithful.line}"
    # The entry's rule is its evidence's: of a detector, whose findings are of that rule, or of a property.
    rule = CATALOGUE[name].rule
    assert {finding.rule for finding in faithful.findings} == (
        {rule} if faithful.by is EvidenceKind.DETECTOR else set()
    )
    assert (faithful.by is EvidenceKind.DETECTOR) == (RULES[rule].family != "property")
    assert faithful.by is not EvidenceKind.READ or CATALOGUE[name].kind is DefectKind.FIGURE
    assert outcome.proven == (faithful.by is not EvidenceKind.READ)
    assert corrected is not None
    assert not corrected.seen, f"corrected: {corrected.line}"
    assert all_corrected is not None
    assert not all_corrected.seen, f"all corrected: {all_corrected.line}"


COVERED = [(defect.id, other) for defect in CATALOGUE.values() for other in defect.covered_by]


@pytest.mark.slow
@pytest.mark.parametrize("name", DEMONSTRATIONS)
def test_an_entry_shows_again_when_its_correction_alone_is_missing(name: str) -> None:
    evidence = DEMONSTRATIONS[name](all_but_one(name))
    assert evidence.seen, evidence.line


@pytest.mark.slow
@pytest.mark.parametrize(("name", "other"), COVERED)
def test_what_an_entry_says_to_cover_it_does(name: str, other: str) -> None:
    assert not DEMONSTRATIONS[name](all_but_one(name) | {other}).seen
