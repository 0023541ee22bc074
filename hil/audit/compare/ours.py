"""What this tool reports about a specimen: the findings of its detectors, or the property that it fails."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from emulator.c28x.findings import Finding
from emulator.clock import SYSCLK_HZ
from emulator.image import Firmware
from firmware_model.image import link
from hil.audit.compare.specimen import Specimen
from hil.audit.evidence import Evidence, measured
from hil.robot.board import RobotBoard

#: Virtual time that a specimen with tasks gets.
RUN_S: Final = 2.5


def _way(fw: Firmware) -> Evidence:
    # 0.3 m/s for 250 ms is 75 mm, in whatever curve.
    return measured("way", fw.metres.way(0.3, 0.5, 250.0), "mm", low=74.9, high=75.1)


def _turn(fw: Firmware) -> Evidence:
    return measured("turn of -1 rad/s", fw.one_way.turn(-1.0), "rad/s", high=-0.9)


def _middle(fw: Firmware) -> Evidence:
    values = fw.array("float32", [1.0, 2.0, 3.0, 4.0])
    return measured("median of 1, 2, 3, 4", fw.even_median.middle(values, 4), low=2.5, high=2.5)


#: Specimens that only a property shows.
PROPERTIES: Final[Mapping[str, Callable[[Firmware], Evidence]]] = {
    "metres": _way,
    "one_way": _turn,
    "even_median": _middle,
}


class _SpecimenDone(Exception):
    """The specimen has shown what it is there for."""


def seen(specimen: Specimen) -> bool:
    """Whether the specimen's rule is reported at the marked line, or its property fails."""
    board = RobotBoard()
    firmware = link(board, modules=(specimen.module,), watch=True, static=True)
    prove = PROPERTIES.get(specimen.name)
    if prove is not None:
        return prove(firmware).seen
    if specimen.kernel:
        board.kernel.start(firmware.function(f"{specimen.name}.run"))
        board.kernel.run_until(round(RUN_S * SYSCLK_HZ))
        board.kernel.shutdown()
        return any(_is_expected(finding, specimen) for finding in board.findings)
    if any(_is_expected(finding, specimen) for finding in board.findings):
        return True

    def look(finding: Finding) -> None:
        if _is_expected(finding, specimen):
            raise _SpecimenDone

    board.findings.found.connect(look)
    try:
        getattr(firmware, specimen.name).run()
    except _SpecimenDone:
        return True
    return False


def _is_expected(finding: Finding, specimen: Specimen) -> bool:
    line = specimen.line(".py")
    return finding.rule == specimen.rule and any(
        place.line == line and Path(place.file).stem == specimen.name for place in finding.call_path
    )
