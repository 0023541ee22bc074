"""Step responses of the position controller for chosen Kp and Ki (thesis 3.2.3; three cases in annex 4).

The robot stands in a wide room and is to turn by an angle.  Every 50 ms, where TaskNAVIGATION calls it, `PI` of
main_Robot.c makes an angular velocity of the angle that the robot believes it has turned by; the servo task, motors,
wheels, gyro and world of the emulated robot do the rest.

The integrator has memory of its own (correction `MAIN-null-integrators`: as printed it points nowhere); the robot
itself has all corrections.  `PI` integrates with the step of the firmware, 2.5 ms, as in
the annex, or with the true one, 50 ms (`MAIN-pi-period`), which makes Ki twenty times as strong.

`faithful` is the firmware as it is in the C: the integral is whatever stands at address 0, and the
angle that it believes is the rate of the last 5 ms (`MAIN-heading`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import degrees, radians
from pathlib import Path
from typing import Any, Final

from emulator.clock import SYSCLK_HZ
from firmware_model.corrections import ALL, resolve
from firmware_model.image import link
from hil.bench import Bench
from hil.client.plot import save
from hil.machine import Setup
from hil.robot.board import RobotBoard
from hil.world.geometry import Segment
from hil.world.maps import WorldMap

#: Reference of annex 4, and limits of the action (main_Robot.c, `Position`).
REFERENCE_DEG: Final = 45.0
LIMIT_RAD_S: Final = 1.57
#: Kp, Ki and what annex 4 says of them.
ANNEX: Final = (
    (100.0, 0.0, "saturates"),
    (1.0, 100.0, "saturates"),
    (1.0, 10.0, "suitable: reaches 0.8 rad/s"),
)
_PERIOD_CYCLES: Final = SYSCLK_HZ // 20  # Navigation_Period: 50 ms
#: What TaskNAVIGATION takes at most, behind its release: 2 ms are far more than it needs.
_BEHIND_RELEASE_CYCLES: Final = SYSCLK_HZ // 500
#: The corrected firmware measures the gyro's offset after start-up, and moves only then.
_READY_S: Final = 3.0
_SETTLED: Final = 0.05
#: All corrections but the one that forgets the angle while no mission runs, and the one that stops a robot whose link
#: is silent: the reference comes from here, by no link.
_ROBOT: Final = tuple(sorted(resolve([ALL]) - {"MAIN-mission-resumed", "MAIN-link-silent"}))


@dataclass(frozen=True, slots=True)
class StepResponse:
    """A step response: a value each 50 ms.  Angles in rad, counter-clockwise; `action_rad_s` is what `PI` asked for."""

    faithful: bool
    kp: float
    ki: float
    reference_rad: float
    times_s: tuple[float, ...]
    action_rad_s: tuple[float, ...]
    believed_rad: tuple[float, ...]
    true_rad: tuple[float, ...]

    @property
    def saturated_s(self) -> float:
        """How long the action stood at its limit."""
        return sum(abs(w) >= LIMIT_RAD_S * 0.999 for w in self.action_rad_s) * _PERIOD_CYCLES / SYSCLK_HZ

    @property
    def peak_rad_s(self) -> float:
        """The greatest action."""
        return max(map(abs, self.action_rad_s))

    @property
    def overshoot(self) -> float:
        """How far the robot turned beyond the reference, as a share of it."""
        return max(0.0, max(self.true_rad) / self.reference_rad - 1.0)

    @property
    def settled_s(self) -> float | None:
        """From when on the robot stays within 5 % of the reference; None: it does not."""
        outside = [
            t for t, rad in zip(self.times_s, self.true_rad, strict=True)
            if abs(rad - self.reference_rad) > _SETTLED * self.reference_rad
        ]  # fmt: skip
        if not outside:
            return self.times_s[0]
        return next((t for t in self.times_s if t > outside[-1]), None)

    def sentence(self) -> str:
        """What it means for the robot."""
        action = (
            f"the action stands at its limit of {LIMIT_RAD_S} rad/s for {self.saturated_s:.2f} s"
            if self.saturated_s else f"the action reaches {self.peak_rad_s:.2f} rad/s and no limit"
        )  # fmt: skip
        settled = "does not settle" if self.settled_s is None else f"is within 5 % after {self.settled_s:.2f} s"
        turns = f"the robot turns {self.overshoot:.0%} too far and {settled}"
        if self.faithful:
            believed, true = degrees(self.believed_rad[-1]), degrees(self.true_rad[-1])
            return (
                f"The same, as in the C: {action}; {turns}: it believes that it turned by {believed:.1f} degrees, "
                f"where it turned by {true:.0f}."
            )
        return f"Kp {self.kp:g}, Ki {self.ki:g}: {action}; {turns}."

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {name: getattr(self, name) for name in StepResponse.__slots__} | {
            "saturated_s": self.saturated_s, "peak_rad_s": self.peak_rad_s, "overshoot": self.overshoot,
            "settled_s": self.settled_s, "sentence": self.sentence(),
        }  # fmt: skip


def respond(
    kp: float, ki: float, *, reference_deg: float = REFERENCE_DEG, for_s: float = 5.0, true_step: bool = False,
    faithful: bool = False, seed: int = 1, realistic: bool = False,
    progress: Callable[[float], None] = lambda fraction: None,
) -> StepResponse:  # fmt: skip
    """Turn the robot by an angle.  Raises ValueError for numbers that are no angle, time or gain.

    `faithful` is the firmware as it is in the C, which has no true step.
    """
    for name, value, least, most in (
        ("Kp", kp, 0.0, 1e4), ("Ki", ki, 0.0, 1e4), ("the reference", reference_deg, 1.0, 180.0),
        ("the time", for_s, 0.1, 600.0),
    ):  # fmt: skip
        if not least <= value <= most:
            raise ValueError(f"{name} {value:g}: expected {least:g} to {most:g}")
    fixes = ["MAIN-null-integrators", *(["MAIN-pi-period"] if true_step else [])]
    controller = link(RobotBoard(), fixes=[] if faithful else fixes).main_robot
    setup = Setup(seed=seed, realistic=realistic, fixes=() if faithful else _ROBOT)
    bench = Bench(setup, traced=False, world_map=_room())
    bench.boot()
    bench.feed(b"#TELE\r")
    bench.run_for(_READY_S)
    # Behind TaskNAVIGATION, which hands on what was ordered before.
    begin = -(-bench.clock.now // _PERIOD_CYCLES) * _PERIOD_CYCLES + _BEHIND_RELEASE_CYCLES
    reference = radians(reference_deg)
    rows: list[tuple[float, float, float, float]] = []
    steps = round(for_s * SYSCLK_HZ / _PERIOD_CYCLES)
    start: tuple[float, float] | None = None
    for step in range(steps):
        bench.run_until(begin + step * _PERIOD_CYCLES)
        believed, true = float(bench.firmware.main_robot.tita_abs), bench.world.pose.heading_rad
        start = start or (believed, true)
        turned = believed - start[0]
        action = float(controller.PI(reference, turned, kp, ki, controller.Ix, LIMIT_RAD_S, -LIMIT_RAD_S))
        # As `Action` and write_REF do in the mission; TaskNAVIGATION copies the ordered one in the next period.
        for place in ("ROBOT_Reference", "Telemanipulation_Reference"):
            getattr(bench.firmware.servidores, place).W = action
        rows.append((step * _PERIOD_CYCLES / SYSCLK_HZ, action, turned, true - start[1]))
        progress((step + 1) / steps)
    return StepResponse(faithful, kp, ki, reference, *(tuple(column) for column in zip(*rows, strict=True)))


def _room() -> WorldMap:
    """So wide that no wall is near."""
    corners = ((-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0))
    return WorldMap("hall", tuple(Segment(*a, *b) for a, b in zip(corners, (*corners[1:], corners[0]), strict=True)))


def plot(path: str | Path, responses: Sequence[StepResponse]) -> None:
    """Angle and action over time, a column a pair of gains; as in the C: thin.  PNG, SVG or PDF by the suffix."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    gains = list(dict.fromkeys((one.kp, one.ki) for one in responses))
    figure = Figure(figsize=(4.2 * len(gains), 5.4), layout="constrained")
    FigureCanvasAgg(figure)
    axes: Any = figure.subplots(2, len(gains), squeeze=False, sharex=True, sharey="row")
    for n, (kp, ki) in enumerate(gains):
        angle, action = axes[0][n], axes[1][n]
        angle.axhline(responses[0].reference_rad, color="black", linestyle=":", linewidth=1, label="reference")
        angle.set_title(f"Kp {kp:g}, Ki {ki:g}")
        for limit in (-LIMIT_RAD_S, LIMIT_RAD_S):
            action.axhline(limit, color="black", linestyle=":", linewidth=1)
        action.set_xlabel("time (s)")
        for axis in (angle, action):
            axis.grid(alpha=0.3)
    for one in responses:
        angle, action = axes[:, gains.index((one.kp, one.ki))]
        width, suffix = (0.8, ", as in the C") if one.faithful else (1.6, "")
        angle.plot(one.times_s, one.true_rad, color="tab:green", linewidth=width, label=f"robot{suffix}")
        angle.plot(
            one.times_s, one.believed_rad, "--", color="tab:blue", linewidth=width, label=f"what it believes{suffix}"
        )
        action.step(one.times_s, one.action_rad_s, where="post", color="tab:red", linewidth=width)
    axes[0][0].set_ylabel("angle (rad)")
    axes[0][0].legend(fontsize="x-small")
    axes[1][0].set_ylabel("action W (rad/s)")
    save(figure, path, dpi=100)
