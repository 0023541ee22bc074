"""The world: a map, a robot in it, and virtual time.

Modelled
    Lazy integration: nothing moves until a reader needs it; then everything moves up to exactly that time.  The bumper
    and walls are checked every 10 ms at the latest.  Obstacles that the bench adds, moves and removes, and posts
    that move by themselves, every 10 ms.
Not modelled
    Other robots, people, noise of the room.
Time
    `sync(cycles)` integrates from the last time to exactly `cycles`.  After `attach(clock)` it is called by encoder
    readers, before any change of a motor input, by `range_source` and `rate_source`, and by an event every 10 ms.
Sources
    None of its own.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from dataclasses import replace
from math import hypot, inf
from random import Random
from typing import Final

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ, Clock
from emulator.devices.lv_maxsonar_beam import Echo
from emulator.devices.nxt_motor import NxtMotor
from emulator.signal import Signal
from hil.world.geometry import Post
from hil.world.maps import WorldMap
from hil.world.movers import Mover
from hil.world.path import Path
from hil.world.robot import Robot
from hil.world.robot_params import Pose, RobotParams
from hil.world.sonar_rays import DEFAULT_MOUNTS, SonarMount, SonarRays

#: The plant is brought up to date at least this often, so that the bumper is not late.
CHECK_CYCLES: Final = 10 * CYCLES_PER_MS
#: Headings and yaw rates kept for sensors that ask about the past.
_HISTORY: Final = 512
#: The logged path: a point after this way or this turn.
_PATH_STEP_M: Final = 0.01
_PATH_STEP_RAD: Final = 0.05


class World:
    """Walls, posts and one robot.

    `seed` None is the ideal robot; a number draws a realistic one (wheels and tyres; motors are drawn by whoever
    makes them, with `NxtMotorParams.individual`).  All public quantities are SI, the unit in the name.
    """

    def __init__(
        self,
        world_map: WorldMap,
        left: NxtMotor,
        right: NxtMotor,
        *,
        params: RobotParams | None = None,
        mounts: Mapping[str, SonarMount] = DEFAULT_MOUNTS,
        sonar_vcc_v: float = 3.3,
        seed: int | None = None,
        max_step_s: float = 0.005,
    ) -> None:
        params = params or RobotParams()
        if seed is not None:
            params = params.individual(Random(seed))
        slip_left, slip_right = world_map.slip
        if slip_left or slip_right:
            params = replace(
                params, slip_left=params.slip_left + slip_left, slip_right=params.slip_right + slip_right
            )
        self.map = world_map
        self.robot = Robot(left, right, params, max_step_s)
        self.posts: list[Post] = [Post(p.x_m, p.y_m, p.radius_m, p.name) for p in world_map.posts]
        #: The posts that move by themselves: the name, and the mover.
        self._moving: list[tuple[str, Mover]] = [(world_map.posts[m.post].name, m) for m in world_map.movers]
        self.sonars = SonarRays(world_map.walls, self.posts, mounts, sonar_vcc_v)
        self.time_cycles = 0
        #: The time since when a second has its present length, in cycles and in seconds of the world.
        self._paced = (0, 0.0)
        #: The path of the robot, a point each centimetre or 3 degrees.
        self.path = Path()
        self.travelled_m = 0.0
        self.clock: Clock | None = None
        self._logged = (0.0, 0.0, 0.0)
        #: (pressed): the bumper is pressed or released (within 10 ms of it).
        self.bumper_changed: Signal[bool] = Signal()
        self._pressed = False
        #: Time in cycles, heading in rad, yaw rate in rad/s of each update; two headings where it was put down.
        self._past: list[tuple[int, float, float]] = []
        self.robot.surround(world_map.walls, self.posts, world_map.grip)
        self.place(Pose(*world_map.start))

    # Assembly

    def attach(self, clock: Clock) -> None:
        """Run on this clock: encoder reads and motor inputs sync the plant, and so does an event every 10 ms."""
        if self.clock is not None:
            raise ValueError("the world is attached already; make a new World for a new board")
        self.clock = clock
        self.time_cycles = clock.now
        self._past.clear()
        self._remember()
        for motor in (self.robot.left, self.robot.right):
            motor.encoder.looked_at.connect(self.sync_now)
            motor.bridge.in1.duty_changing.connect(self.sync_now)
            motor.bridge.in2.duty_changing.connect(self.sync_now)
        clock.after(CHECK_CYCLES, self._look)

    def _look(self) -> None:
        clock = self.clock
        assert clock is not None
        self.sync(clock.now)
        if self._moving:
            since, since_s = self._paced
            self._carry(since_s + int(clock.now - since) / self.robot.second_cycles)
        clock.schedule(clock.now + CHECK_CYCLES, self._look)

    def _carry(self, time_s: float) -> None:
        """Put moving posts at their present positions.  Removed posts stay away."""
        moved = False
        for name, mover in self._moving:
            for index, post in enumerate(self.posts):
                if post.name == name:
                    x, y = mover.at(time_s)
                    if (x, y) != (post.x_m, post.y_m):
                        self.posts[index] = Post(x, y, post.radius_m, name)
                        moved = True
        if moved:
            self._changed()

    # Time

    def sync_now(self) -> None:
        """Integrate up to the clock's time."""
        clock = self.clock
        assert clock is not None
        if clock.now > self.time_cycles:
            self.sync(clock.now)

    def sync(self, cycles: int) -> None:
        """Integrate from the last time up to exactly `cycles`; a time that has passed changes nothing."""
        start = self.time_cycles
        if cycles <= start:
            return
        self.time_cycles = cycles  # first: an encoder listener may look at us again
        robot = self.robot
        robot.advance(start, cycles)
        self._remember()
        self._log()
        if robot.bumper_pressed is not self._pressed:
            self._tell()

    def set_second(self, cycles: float) -> None:
        """Set the length of a second of the world in cycles from now on.  With a fast oscillator it has more cycles."""
        self._change()
        since, since_s = self._paced
        now = self.time_cycles
        self._paced = (now, since_s + (now - since) / self.robot.second_cycles)
        self.robot.set_second(cycles)

    def _remember(self) -> None:
        past, robot = self._past, self.robot
        past.append((self.time_cycles, robot.heading_rad, robot.w_rad_s))
        if len(past) > _HISTORY:
            del past[: _HISTORY // 2]

    def _tell(self) -> None:
        self._pressed = self.robot.bumper_pressed
        self.bumper_changed.emit(self._pressed)

    def _log(self) -> None:
        robot = self.robot
        x, y, heading = self._logged
        way = hypot(robot.x_m - x, robot.y_m - y)
        turned = robot.heading_rad - heading
        if way >= _PATH_STEP_M or not -_PATH_STEP_RAD < turned < _PATH_STEP_RAD:
            self._log_here()
            self.travelled_m += way

    def _log_here(self) -> None:
        robot = self.robot
        self._logged = (robot.x_m, robot.y_m, robot.heading_rad)
        self.path.add(self.time_cycles / SYSCLK_HZ, robot.x_m, robot.y_m, robot.heading_rad)

    # For the bench

    @property
    def pose(self) -> Pose:
        """The robot's true pose at `time_cycles`."""
        return self.robot.pose

    @property
    def bumper_pressed(self) -> bool:
        """Whether something pushes the bumper, at `time_cycles`."""
        return self.robot.bumper_pressed

    def place(self, pose: Pose) -> None:
        """Put the robot down at rest, here and now; the logged path starts again."""
        self._change()
        self.robot.place(pose)
        self._remember()
        self.path.clear()
        self._log_here()
        self.travelled_m = 0.0
        if self.robot.bumper_pressed is not self._pressed:
            self._tell()

    def add_obstacle(self, name: str, x_m: float, y_m: float, diameter_m: float) -> None:
        """Put a round obstacle down now.  ValueError for a name in use or a size that is none."""
        if any(post.name == name for post in self.posts):
            raise ValueError(f"there is an obstacle {name!r} already; move it, or choose another name")
        self._change()
        self.posts.append(Post(x_m, y_m, diameter_m / 2.0, name))
        self._changed()

    def move_obstacle(self, name: str, x_m: float, y_m: float) -> None:
        """Move an obstacle, or a post of the map, at once."""
        post = self._post(name)
        moved = Post(x_m, y_m, post.radius_m, name)
        self._change()
        self.posts[self.posts.index(post)] = moved
        self._changed()

    def remove_obstacle(self, name: str) -> None:
        """Remove an obstacle, or a post of the map."""
        post = self._post(name)
        self._change()
        self.posts.remove(post)
        self._changed()

    def _post(self, name: str) -> Post:
        for post in self.posts:
            if post.name == name:
                return post
        names = ", ".join(post.name for post in self.posts) or "none"
        raise ValueError(f"there is no obstacle {name!r}; there are: {names}")

    def _change(self) -> None:
        if self.clock is not None:
            self.sync_now()

    def _changed(self) -> None:
        self.robot.surround(self.map.walls, self.posts, self.map.grip)
        if self.robot.bumper_pressed is not self._pressed:
            self._tell()

    # For the sensors

    def yaw_rate_rad_s(self, cycles: int) -> float:
        """Rotation about the vertical at a virtual time: now, or up to some seconds ago.

        Its integral from one update of the robot to a later one is the change of the heading between them.  In between,
        the rate follows a parabola of that area from one rate to the other.  If such a parabola would turn back
        (something was hit), the rate is the mean rate.
        """
        if cycles >= self.time_cycles:
            self.sync(cycles)
            return self.robot.w_rad_s
        past = self._past
        index = bisect_right(past, (cycles, inf, inf))
        if index == 0:
            return past[0][2]
        (before, heading, first), (after, turned, last) = past[index - 1], past[index]
        mean = (turned - heading) * self.robot.second_cycles / (after - before)
        share = (cycles - before) / (after - before)
        bow = 6.0 * mean - 3.0 * (first + last)
        if abs(bow) > abs(last - first):
            return mean
        return first + share * (last - first + (1.0 - share) * bow)

    def rate_source(self, cycles: int) -> tuple[float, float, float]:
        """Rates about x, y, z in rad/s as a gyro lying flat on the robot takes them, z up."""
        return 0.0, 0.0, self.yaw_rate_rad_s(cycles)

    def range_source(self, name: str, cycles: int) -> Echo | None:
        """What the sonar `name` hears of a ping sent at `cycles`."""
        self.sync(cycles)
        return self.sonars.echoes(name, self.robot.pose)

    def cross_source(self, source: str, listener: str, cycles: int) -> float | None:
        """Path length in m of a ping from one sonar to another by way of one reflector."""
        self.sync(cycles)
        return self.sonars.cross_path(source, listener, self.robot.pose)
