"""The world of the robot, as the view has it: hands on robot and obstacles, signals for the scope, what is seen."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Final

from hil.bench import Bench
from hil.robot.view.scene import Scene, Trails, scene_of, trails_of
from hil.view.stage import Hand
from hil.world.robot_params import Pose

#: What is recorded of the true robot.
QUANTITIES: Final = ("v_m_s", "w_rad_s", "x_m", "y_m", "heading_rad")


class Stage:
    """A robot's world: a `hil.view.stage.Stage`."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        world = bench.world
        self.hands: Mapping[str, Hand] = {
            "place": self.place, "add": world.add_obstacle, "move": world.move_obstacle,
            "remove": world.remove_obstacle,
        }  # fmt: skip
        self.signals: Mapping[str, Callable[[], float]] = {
            f"world {name}": partial(self._quantity, name) for name in QUANTITIES
        }

    def place(self, x_m: float, y_m: float, heading_rad: float) -> None:
        """Lift the robot and put it down at rest."""
        world = self._bench.world
        world.sync_now()
        world.place(Pose(x_m, y_m, heading_rad))

    def look(self) -> Scene:
        """What there is now."""
        return scene_of(self._bench)

    def trails(self) -> Trails:
        """The whole paths."""
        return trails_of(self._bench)

    def _quantity(self, name: str) -> float:
        return float(getattr(self._bench.world.robot, name))
