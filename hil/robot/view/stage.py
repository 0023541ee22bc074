"""The world of the robot for the view: actions on robot and obstacles, signals for the scope, snapshots."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, Final

from hil.bench import Bench
from hil.robot.view.scene import Scene, Trails, scene_of, trace_values, trails_of
from hil.view.stage import Hand
from hil.world.robot_params import Pose

#: The recorded quantities of the true robot.
QUANTITIES: Final = ("v_m_s", "w_rad_s", "x_m", "y_m", "heading_rad")
#: The units of these quantities, and of the firmware's variables (from the text of the thesis).
_UNITS: Final = {
    "m": "world x_m, world y_m",
    "m/s": "world v_m_s, servidores.ROBOT_Reference.V, servidores.Telemanipulation_Reference.V, "
           "main_robot.Robot_Reference_N.V, main_robot.Robot_Reference_S.V, main_robot.V_pi",
    "rad": "world heading_rad, servidores.ROBOT_Odometry.tita, servidores.ROBOT_Odometry_T.tita, main_robot.odoT.tita, "
           "main_robot.tita_abs, main_robot.titaref",
    "rad/s": "world w_rad_s, servidores.ROBOT_Reference.W, servidores.Telemanipulation_Reference.W, "
             "servidores.ROBOT_wz, main_robot.Robot_Reference_N.W, main_robot.Robot_Reference_S.W, main_robot.wZ, "
             "main_robot.wZ_task, main_robot.Wpi, main_robot.Wpos, main_robot.Wabs, main_robot.Wciego, main_robot.Wl, "
             "main_robot.Wr, main_robot.Wl_ref, main_robot.Wr_ref, main_robot.Wl_ref_pi, main_robot.Wr_ref_pi",
    "cm": "servidores.ROBOT_dl, servidores.ROBOT_df, servidores.ROBOT_dr, main_robot.dl, main_robot.df, main_robot.dr, "
          "main_robot.Left_distance, main_robot.Front_distance, main_robot.Right_distance, us.L_Calib_b, us.F_Calib_b, "
          "us.R_Calib_b",
    "mm": "servidores.ROBOT_Odometry.X, servidores.ROBOT_Odometry.Y, servidores.ROBOT_Odometry_T.X, "
          "servidores.ROBOT_Odometry_T.Y, main_robot.odoT.X, main_robot.odoT.Y",
    "digits": "gyro.Z_dc_offset, gyro.X_Calib_b, gyro.Y_Calib_b, gyro.Z_Calib_b, main_robot.vX_b, main_robot.vY_b, "
              "main_robot.vZ_b",
}  # fmt: skip


class Stage:
    """A robot's world: a `hil.view.stage.StageProtocol`."""

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
        self.happened: list[tuple[int, str]] = []
        world.bumper_changed.connect(self._bumped)
        self.units: Mapping[str, str] = {name: unit for unit, names in _UNITS.items() for name in names.split(", ")}

    def place(self, x_m: float, y_m: float, heading_rad: float) -> None:
        """Move the robot to another pose, at rest."""
        world = self._bench.world
        world.sync_now()
        world.place(Pose(x_m, y_m, heading_rad))

    def _bumped(self, pressed: bool) -> None:
        if pressed:
            self.happened.append((self._bench.clock.now, "bump"))

    def look(self) -> Scene:
        """The present scene."""
        return scene_of(self._bench)

    def trails(self) -> Trails:
        """The whole paths."""
        return trails_of(self._bench)

    def tell(self) -> Mapping[str, Any]:
        """The scene as plain data for a trace."""
        return trace_values(self._bench)

    def _quantity(self, name: str) -> float:
        return float(getattr(self._bench.world.robot, name))
