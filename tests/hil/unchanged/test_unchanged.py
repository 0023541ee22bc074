"""What exists stays true: digests, findings (rule, object, place, order) and task times are as they were recorded.

A difference that is meant stands in `ALLOWED` with its reason; the record itself stays as it is.
"""

from __future__ import annotations

from typing import Final

import pytest

from tests.hil.unchanged.comparison import Allowed, Gone, Moved, Named, New, Reworded, Value, differences, expected
from tests.hil.unchanged.record import FOLDER, file_of, read
from tests.hil.unchanged.scenarios import SCENARIOS

CAUSED: Final = "a part's finding stands at the statement that set the transfer going, watched or not"

#: Reviewed differences from what was recorded, in the order in which they are put into the record.  For instance
#:
#:     Moved(rule="index", object="us.M_DIST", before="firmware_model/us.py:139 Read_Distance",
#:           after="firmware_model/us.py:140 Read_Distance", because="the statement's second line holds the access"),
#:     New(rule="unsequenced", because="two effects on one object without an order are a finding now"),
ALLOWED: Final[tuple[Allowed, ...]] = (
    *(
        Moved(
            rule=rule, object=f"sonar {which} AN", before="firmware_model/us.py:106 Read_Channel",
            after="firmware_model/us.py:104 Read_Channel", because=CAUSED,
        )
        for rule in ("startup-read", "slew-read") for which in ("LEFT", "FRONT", "RIGHT")
    ),
    *(
        Moved(
            rule=rule, object=f"L3G4200D.{which}", before="firmware_model/board_support/spi.py:66 SPI_transfer",
            after="firmware_model/board_support/spi.py:65 SPI_transfer", because=CAUSED,
        )
        for rule, which in (("startup-read", "OUT_Z"), ("fifo-bypassed", "FIFO_CTRL_REG.FM"))
    ),
)  # fmt: skip


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_run_gives_what_was_recorded_but_for_reviewed_differences(name: str) -> None:
    recorded, _ = expected(name, read(name), ALLOWED)
    found = differences(recorded, SCENARIOS[name](), ALLOWED)
    if found:
        pytest.fail(f"{name}:\n" + "\n".join(found), pytrace=False)


def test_every_scenario_is_recorded_and_every_file_has_its_scenario() -> None:
    assert {file.name for file in FOLDER.iterdir()} == {file_of(name).name for name in SCENARIOS}


def test_every_reviewed_difference_has_a_reason_and_is_one() -> None:
    used = set[Allowed]()
    rules = set[str]()
    for name in SCENARIOS:
        text = file_of(name).read_text(encoding="utf-8")
        rules |= {rule for rule in _new_rules() if f'"rule":"{rule}"' in text}
        used |= expected(name, read(name), ALLOWED)[1]
    assert not rules, "recorded already, so not new"
    for difference in ALLOWED:
        assert difference.because
        match difference:
            case New():
                continue
            case Moved() | Named() | Reworded() | Gone() | Value():
                assert difference in used, "nothing in the record is concerned"


def _new_rules() -> set[str]:
    return {difference.rule for difference in ALLOWED if isinstance(difference, New)}
