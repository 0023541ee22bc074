"""The table of single faults as cells of text: for the terminal, and for the page of this package.

    python -m hil.safety.page        # writes the tables into README.md
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Final

from hil.files import replacing
from hil.safety.single_faults import MeasuredFault, Mission, missions, table

PAGE: Final = Path(__file__).with_name("README.md")
ROW_HEADINGS: Final = ("of", "fault", "noticed by", "after", "the robot", "after", "when it is over", "after")
MISSION_HEADINGS: Final = ("mission", "slows at", "nearest", "touched", "bumps", "told", "way in the last 5 s")
_BEGIN: Final = "<!-- hil faults --table: {} -->"
_END: Final = "<!-- end -->"


def row_cells(told: MeasuredFault) -> tuple[str, ...]:
    """The cells of a row.  A fault that cannot be noticed has its reason in brackets."""
    return (
        told.row.of, told.row.fault, told.noticed or f"({told.row.blind})", _ms(told.noticed_ms), told.does,
        _ms(told.does_ms), told.goes_on, _ms(told.goes_on_ms),
    )  # fmt: skip


def mission_cells(mission: Mission) -> tuple[str, ...]:
    """A mission where nothing is broken."""
    slows = "never" if mission.slows_m is None else f"{100 * mission.slows_m:.0f} cm"
    return (
        mission.place, slows, f"{100 * mission.nearest_m:.0f} cm", str(mission.touched), str(mission.bumps),
        ", ".join(mission.noticed), f"{100 * mission.goes_on_m:.0f} cm",
    )  # fmt: skip


def _ms(time_ms: float | None) -> str:
    return "" if time_ms is None else f"{time_ms:.0f} ms"


def markdown(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table of a page."""
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)


def page(told: Iterable[MeasuredFault], driven: Iterable[Mission]) -> str:
    """The page with its tables replaced by these."""
    text = PAGE.read_text(encoding="utf-8")
    for name, headings, rows in (
        ("faults", ROW_HEADINGS, [row_cells(one) for one in told]),
        ("missions", MISSION_HEADINGS, [mission_cells(one) for one in driven]),
    ):
        before, begin, rest = text.partition(_BEGIN.format(name))
        _, end, after = rest.partition(_END)
        text = f"{before}{begin}\n{markdown(headings, rows)}\n{end}{after}"
    return text


if __name__ == "__main__":
    with replacing(PAGE) as new:
        new.write_text(page(table(), missions()), encoding="utf-8")
