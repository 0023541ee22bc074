"""The surroundings of a board in the view: a world with a robot, or nothing.

A board names the package of its stage (`Board.view`).  It has two modules.  `stage` has a class `Stage` (a
`StageProtocol`), made of each machine and living in its thread.  `panels` has a class `Panels` (a `PanelsProtocol`),
made of the engine for each page.  Without a stage there is only the board, and the page shows its parts instead.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol

from hil.running import RunningBoard

if TYPE_CHECKING:
    from hil.view.engine import Engine
    from hil.view.snapshot import Snapshot

#: Something that is done to the world from outside, with plain values.
Hand = Callable[..., None]


class StageProtocol(Protocol):
    """The world of one machine.  Everything is looked at without touching it."""

    #: What can be done to it, by name.
    hands: Mapping[str, Hand]
    #: What the scope can record of it, sampled: `world v_m_s`.
    signals: Mapping[str, Callable[[], float]]
    #: Units of these, and of variables of the firmware whose names tell none.
    units: Mapping[str, str]
    #: What happened in it that is worth a mark: cycle and words.
    happened: Sequence[tuple[int, str]]

    def look(self) -> Any:
        """What the page sees of it at one moment, some 20 a second: never changed afterwards."""

    def trails(self) -> Any:
        """The long paths, which are updated only four times a second."""

    def tell(self) -> Mapping[str, Any]:
        """What a trace records of it, by name (`hil.instruments.scene`), as plain data."""


class PanelsProtocol(Protocol):
    """The panels that a stage adds to the page of every board."""

    #: Keys and what they do, for the list.
    keys: Sequence[tuple[str, str]]
    actions: Mapping[str, Callable[[], Any]]
    #: Tabs that stand before all others: title -> what makes the content.
    tabs: Mapping[str, Callable[[], None]]

    def top(self) -> None:
        """The controls at the top of the page, such as STOP."""

    def picture(self) -> None:
        """The picture, in the place of the parts."""

    def status(self, now: Snapshot) -> Sequence[tuple[str, str]]:
        """What it is doing, as tiles of the head line: titles, which stay the same, and values."""

    def update(self, now: Snapshot) -> None:
        """20 times a second."""

    def key(self, name: str, down: bool) -> bool:
        """A key, before all others see it; whether it was taken."""

    def leave(self) -> None:
        """The page is closed."""


def stage_of(machine: RunningBoard) -> StageProtocol | None:
    """The world that a machine stands in; None: there is only the board."""
    package = machine.board.view
    if package is None:
        return None
    stage: StageProtocol = import_module(f"{package}.stage").Stage(machine)
    return stage


def panels_of(package: str | None, engine: Engine) -> PanelsProtocol | None:
    """What a page shows of the stage of a board."""
    if package is None:
        return None
    panels: PanelsProtocol = import_module(f"{package}.panels").Panels(engine)
    return panels
