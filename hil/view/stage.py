"""The surroundings of a board in the view: a world with a robot, or nothing.

A board names the package of its stage (`Board.view`).  The package has two modules.  `stage` has a class `Stage` (a
`StageProtocol`), which is created for each machine, in its thread.  `panels` has a class `Panels` (a `PanelsProtocol`),
which is created for each page.  Without a stage, the page shows the parts of the board instead.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol

from hil.running import RunningBoard

if TYPE_CHECKING:
    from hil.view.engine import Engine
    from hil.view.snapshot import Snapshot

#: An action on the world from outside, with plain values as arguments.
Hand = Callable[..., None]


class StageProtocol(Protocol):
    """The world of one machine.  Looking at it does not change the run."""

    #: The actions on the world, by name.
    hands: Mapping[str, Hand]
    #: The quantities that the scope can sample: `world v_m_s`.
    signals: Mapping[str, Callable[[], float]]
    #: The units of these quantities, and of variables of the firmware whose names have no unit.
    units: Mapping[str, str]
    #: The events that get a mark: cycle and text.
    happened: Sequence[tuple[int, str]]

    def look(self) -> Any:
        """A snapshot for the page, about 20 a second.  It never changes afterwards."""

    def trails(self) -> Any:
        """The long paths, which are updated only four times a second."""

    def tell(self) -> Mapping[str, Any]:
        """The values for a trace, by name (`hil.instruments.scene`), as plain data."""


class PanelsProtocol(Protocol):
    """The panels that a stage adds to the page of every board."""

    #: The keys and their meanings, for the list.
    keys: Sequence[tuple[str, str]]
    actions: Mapping[str, Callable[[], Any]]
    #: The tabs before all others: title -> the function that builds the content.
    tabs: Mapping[str, Callable[[], None]]

    def top(self) -> None:
        """The controls at the top of the page, such as STOP."""

    def picture(self) -> None:
        """Add the picture, in the place of the parts."""

    def status(self, now: Snapshot) -> Sequence[tuple[str, str]]:
        """The state as tiles of the head line: titles, which stay the same, and values."""

    def update(self, now: Snapshot) -> None:
        """Update the panel, up to 20 times a second."""

    def key(self, name: str, down: bool) -> bool:
        """Handle a key before all others.  Returns whether it was used."""

    def leave(self) -> None:
        """Handle that the page was closed."""


def stage_of(machine: RunningBoard) -> StageProtocol | None:
    """The world of a machine; None: there is only the board."""
    package = machine.board.view
    if package is None:
        return None
    stage: StageProtocol = import_module(f"{package}.stage").Stage(machine)
    return stage


def panels_of(package: str | None, engine: Engine) -> PanelsProtocol | None:
    """The panels of a board's stage; None: the board has no stage."""
    if package is None:
        return None
    panels: PanelsProtocol = import_module(f"{package}.panels").Panels(engine)
    return panels
