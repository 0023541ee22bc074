"""Each defect of main_Robot.c is seen on the faithful firmware, and not with its correction nor with all of them."""

from __future__ import annotations

import pytest

from firmware_model.catalogue import main_robot as catalogue
from firmware_model.corrections import ALL
from hil.audit import main_robot

IDS = [defect.id for defect in catalogue.DEFECTS]


def test_every_entry_has_a_demonstration_and_no_demonstration_lacks_an_entry() -> None:
    assert sorted(IDS) == sorted(main_robot.DEMONSTRATIONS)


@pytest.mark.parametrize("name", IDS)
def test_the_defect_is_seen_on_the_faithful_firmware_only(name: str) -> None:
    demonstration = main_robot.DEMONSTRATIONS[name]
    faithful = demonstration(frozenset())
    assert faithful.seen, faithful.line
    for fixes in (frozenset({name}), frozenset({ALL})):
        corrected = demonstration(fixes)
        assert not corrected.seen, f"{sorted(fixes)}: {corrected.line}"
