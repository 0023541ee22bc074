"""The robot: two NXT motors, a differential drive on tyres, a round body with a bumper in front.

Modelled
    Chassis mass and yaw inertia reflected to both motors; dry friction with sticking; tyres that grip up to a limit and
    slide beyond it, along the wheel; small constant differences between the wheels when realistic; rolling resistance;
    a round body, ahead of the axle.  Walls and posts stop the body, and it rubs on them, so that a glancing hit turns
    the robot along the wall.  An obstacle put or dragged onto it moves it aside.  A bumper in front.
Not modelled
    Sideways slip, tilting, the caster, cable or battery weight shifts, elasticity, corners of the body.
Time
    `advance(start, end)` integrates between two virtual times, in steps of at most `max_step_s`.  Rolling steps
    are exact for the linear part (`rolling`); sliding and bumping steps are implicit, of first order (`contact`).
Sources
    TFG 2.2.1 (parts), annex 1 main_Robot.c (wheel radius 0.027 m, track 0.13 m), NXT.
"""

from __future__ import annotations

from math import cos, radians, sin
from typing import Final

from emulator.clock import SYSCLK_HZ
from emulator.devices.nxt_motor import NxtMotor
from hil.world.contact import ContactRow, Touch, nearby, pushed_out, solve, touches
from hil.world.geometry import Post, Segment, clearance
from hil.world.robot_params import Pose, RobotParams
from hil.world.rolling import one_wheel, two_wheels

GRAVITY_M_S2: Final = 9.81
CONTACT_STEP_S: Final = 0.005
#: Walls nearer than this to the body are handed to the contact solver.
NEAR_M: Final = 0.004
#: CHOICE: how fast an obstacle put or dragged onto the robot moves it aside.
PUSH_M_S: Final = 0.5


class Robot:
    """State and integration.  `x_m`, `y_m`, `heading_rad`, `v_m_s`, `w_rad_s` are plain attributes, read after
    `advance`; write them only through `place`."""

    __slots__ = (
        "_breakaway", "_bumper_cos", "_dry", "_free_m", "_inverse_det", "_m", "_posts", "_radii", "_rest", "_settled",
        "_sliding", "_walls", "bumper_pressed", "collisions", "grip", "heading_rad", "left", "max_step_s", "params",
        "right", "second_cycles", "slipped_m", "v_m_s", "w_rad_s", "x_m", "y_m",
    )  # fmt: skip

    def __init__(
        self, left: NxtMotor, right: NxtMotor, params: RobotParams | None = None, max_step_s: float = 0.005
    ) -> None:
        if not 0.0 < max_step_s <= 0.005:
            raise ValueError(f"max_step_s {max_step_s}: must be above 0 and at most 0.005 s")
        self.params = params = params or RobotParams()
        self.left, self.right = left, right
        self.max_step_s = max_step_s
        self.second_cycles = float(SYSCLK_HZ)
        self.x_m = self.y_m = self.heading_rad = self.v_m_s = self.w_rad_s = 0.0
        self.bumper_pressed = False
        #: The number of collisions of the body; the way that the tyres slid on the floor.
        self.collisions = 0
        self.slipped_m = 0.0
        self.grip = 1.0
        self._walls: tuple[Segment, ...] = ()
        self._posts: list[Post] = []
        self._free_m = 0.0
        self._sliding = False
        self._settled = False
        #: The motors' inputs with which the robot was last seen to stay at rest; None while it moves.
        self._rest: tuple[float, ...] | None = None
        self._bumper_cos = cos(radians(params.bumper_half_angle_deg))
        self.hamper()

    def hamper(
        self, *, slip_left: float = 0.0, slip_right: float = 0.0, hold_left_nm: float = 0.0, hold_right_nm: float = 0.0
    ) -> None:
        """From now on the wheels lose this much more of their way (0..1), and this much more torque holds them."""
        params, left, right = self.params, self.left, self.right
        radius, track = params.wheel_radius_m, params.track_m
        r_left = radius * (1.0 - params.slip_left) * (1.0 - slip_left)
        r_right = radius * (1.0 - params.slip_right) * (1.0 - slip_right)
        self._radii = (r_left, r_right)
        own = params.mass_kg / 4.0 + params.yaw_inertia_kg_m2 / track**2
        shared = params.mass_kg / 4.0 - params.yaw_inertia_kg_m2 / track**2
        m11 = left.params.inertia_kg_m2 + r_left * r_left * own
        m22 = right.params.inertia_kg_m2 + r_right * r_right * own
        m12 = r_left * r_right * shared
        self._m = (m11, m12, m22)
        self._inverse_det = 1.0 / (m11 * m22 - m12 * m12)
        rolling = params.rolling_resistance * self._tyre_load_n() * radius
        held_left, held_right = rolling + hold_left_nm, rolling + hold_right_nm
        self._dry = (left.params.coulomb_nm + held_left, right.params.coulomb_nm + held_right)
        self._breakaway = (left.params.static_nm + held_left, right.params.static_nm + held_right)
        self._rest = None
        self._settled = False

    def set_second(self, cycles: float) -> None:
        """Set the length of a second in cycles from now on, for the chassis and its motors."""
        self.second_cycles = self.left.second_cycles = self.right.second_cycles = cycles

    @property
    def pose(self) -> Pose:
        """The pose of the middle between the wheels."""
        return Pose(self.x_m, self.y_m, self.heading_rad)

    def _tyre_load_n(self) -> float:
        return 0.5 * self.params.driven_share * self.params.mass_kg * GRAVITY_M_S2

    def surround(self, walls: tuple[Segment, ...], posts: list[Post], grip: float = 1.0) -> None:
        """Put walls and posts around the robot; call again whenever one of them moved."""
        self._walls, self._posts, self.grip = walls, posts, grip
        self._free_m = 0.0
        self._settled = False
        self._rest = None
        self._press(self._walls, self._posts)

    def place(self, pose: Pose) -> None:
        """Lift the robot and put it down at rest."""
        self.x_m, self.y_m, self.heading_rad = pose
        self.v_m_s = self.w_rad_s = self.left.omega_rad_s = self.right.omega_rad_s = 0.0
        self._free_m = 0.0
        self._settled = False
        self._rest = None
        self._press(self._walls, self._posts)

    def advance(self, start_cycles: int, end_cycles: int) -> None:
        """Integrate from one virtual time to another, in equal steps."""
        if self._rest is not None:
            if not self.left.omega_rad_s and not self.right.omega_rad_s and self._rest == self._inputs():
                return
            self._rest = None
        span = end_cycles - start_cycles
        longest = int(self.max_step_s * SYSCLK_HZ)
        steps = -(-span // longest)
        now = start_cycles
        for index in range(1, steps + 1):
            until = start_cycles + span * index // steps
            if self._sliding or self._free_m <= 0.0:
                self._bump(now, until)
            else:
                self._roll(now, until)
            now = until

    def _inputs(self) -> tuple[float, ...]:
        """The inputs that decide the torque of a motor at rest."""
        left, right = self.left.bridge, self.right.bridge
        a, b, c, d = left.in1, left.in2, right.in1, right.in2
        return (
            a.duty, b.duty, c.duty, d.duty, left.supply_v, right.supply_v,
            a.period_cycles, b.period_cycles, c.period_cycles, d.period_cycles,
        )  # fmt: skip

    # Rolling: both tyres hold, nothing is near.

    def _roll(self, now: int, until: int) -> None:
        """One step with both tyres holding.  It ends early where a wheel stops or starts."""
        left, right = self.left, self.right
        m11, m12, m22 = self._m
        inverse = self._inverse_det
        dry_left, dry_right = self._dry
        for _ in range(6):
            w1, w2 = left.omega_rad_s, right.omega_rad_s
            t1, d1 = left.torque_line(w1)
            t2, d2 = right.torque_line(w2)
            s1 = 1.0 if w1 > 0.0 else -1.0 if w1 < 0.0 else 0.0
            s2 = 1.0 if w2 > 0.0 else -1.0 if w2 < 0.0 else 0.0
            if s1 == 0.0 or s2 == 0.0:
                s1, s2 = self._break_away(s1, s2, t1, t2, w1, w2, d1, d2)
                if s1 == 0.0 and s2 == 0.0:
                    self.v_m_s = self.w_rad_s = 0.0
                    self._rest = self._inputs()
                    return
            b1 = t1 - s1 * dry_left - d1 * w1
            b2 = t2 - s2 * dry_right - d2 * w2
            span = (until - now) / self.second_cycles
            reached = until
            share = 1.0
            if s1 and s2:
                p = (m22 * inverse * d1, -m12 * inverse * d2, -m12 * inverse * d1, m11 * inverse * d2)
                a1, a2 = (m22 * b1 - m12 * b2) * inverse, (m11 * b2 - m12 * b1) * inverse
                v1, v2, turn1, turn2 = two_wheels(w1, w2, a1, a2, p, span)
            else:
                p = (0.0, 0.0, 0.0, 0.0)
                a1 = b1 / m11 if s1 else 0.0
                a2 = b2 / m22 if s2 else 0.0
                v1, turn1 = one_wheel(w1, t1 - s1 * dry_left, d1, m11, span) if s1 else (0.0, 0.0)
                v2, turn2 = one_wheel(w2, t2 - s2 * dry_right, d2, m22, span) if s2 else (0.0, 0.0)
            if v1 * s1 < 0.0 or v2 * s2 < 0.0:
                # A wheel stops within the step: go to that time first (the speed passes zero nearly straight), then on.
                share = min(w1 / (w1 - v1) if v1 * s1 < 0.0 else 1.0, w2 / (w2 - v2) if v2 * s2 < 0.0 else 1.0)
                if share <= 0.0:
                    break
                stops1 = v1 * s1 < 0.0 and w1 / (w1 - v1) <= share
                stops2 = v2 * s2 < 0.0 and w2 / (w2 - v2) <= share
                span *= share
                reached = min(until, now + max(1, round(span * self.second_cycles)))
                if s1 and s2:
                    v1, v2, turn1, turn2 = two_wheels(w1, w2, a1, a2, p, span)
                else:
                    v1, turn1 = one_wheel(w1, t1 - s1 * dry_left, d1, m11, span) if s1 else (0.0, 0.0)
                    v2, turn2 = one_wheel(w2, t2 - s2 * dry_right, d2, m22, span) if s2 else (0.0, 0.0)
                if stops1 or v1 * s1 < 0.0:
                    v1 = 0.0
                if stops2 or v2 * s2 < 0.0:
                    v2 = 0.0
            if self._tyres_slide(a1, a2):
                break
            self._move(now, reached, v1, v2, turn1, turn2)
            if reached >= until:
                return
            now = reached
            if self._free_m <= 0.0:
                break
        self._bump(now, until)

    def _break_away(
        self, s1: float, s2: float, t1: float, t2: float, w1: float, w2: float, d1: float, d2: float
    ) -> tuple[float, float]:
        """Senses of motion: a resting wheel starts when torque and the other wheel's pull exceed static friction."""
        m11, m12, m22 = self._m
        hold1, hold2 = self._breakaway
        pull1 = t1 if s2 == 0.0 else t1 - m12 * (t2 - d2 * w2 - s2 * self._dry[1]) / m22
        pull2 = t2 if s1 == 0.0 else t2 - m12 * (t1 - d1 * w1 - s1 * self._dry[0]) / m11
        if s1 == 0.0 and abs(pull1) > hold1:
            s1 = 1.0 if pull1 > 0.0 else -1.0
        if s2 == 0.0 and abs(pull2) > hold2:
            s2 = 1.0 if pull2 > 0.0 else -1.0
        return s1, s2

    def _tyres_slide(self, a1: float, a2: float) -> bool:
        """Whether this acceleration of the chassis needs more force of a tyre than its grip allows."""
        params = self.params
        r1, r2 = self._radii
        v_rate = 0.5 * (r1 * a1 + r2 * a2)
        w_rate = (r2 * a2 - r1 * a1) / params.track_m
        half = 0.5 * params.mass_kg * v_rate
        couple = params.yaw_inertia_kg_m2 * w_rate / params.track_m
        limit = params.tyre_friction * self.grip * self._tyre_load_n()
        if -limit <= half - couple <= limit and -limit <= half + couple <= limit:
            return False
        self._sliding = True
        return True

    def _move(self, now: int, until: int, w1: float, w2: float, turn1: float, turn2: float) -> None:
        """Wheels turned without slipping: encoders, pose along the exact arc, velocities."""
        left, right = self.left, self.right
        before1, before2 = left.omega_rad_s, right.omega_rad_s
        left.omega_rad_s, right.omega_rad_s = w1, w2
        r1, r2 = self._radii
        track = self.params.track_m
        self._drive(0.5 * (r1 * turn1 + r2 * turn2), (r2 * turn2 - r1 * turn1) / track)
        self.v_m_s = 0.5 * (r1 * w1 + r2 * w2)
        self.w_rad_s = (r2 * w2 - r1 * w1) / track
        left.turn(turn1, now, until, before1)
        right.turn(turn2, now, until, before2)

    def _drive(self, way_m: float, turned_rad: float) -> None:
        """Follow an arc of this length and angle."""
        half = 0.5 * turned_rad
        chord = way_m * (sin(half) / half) if half > 1e-5 or half < -1e-5 else way_m * (1.0 - half * half / 6.0)
        course = self.heading_rad + half
        self.x_m += chord * cos(course)
        self.y_m += chord * sin(course)
        self.heading_rad += turned_rad
        self._free_m -= abs(way_m) + self.params.body_ahead_m * abs(turned_rad)

    # Sliding or near something.

    def _middle(self) -> tuple[float, float]:
        """The position of the middle of the body."""
        ahead = self.params.body_ahead_m
        return self.x_m + ahead * cos(self.heading_rad), self.y_m + ahead * sin(self.heading_rad)

    def _bump(self, now: int, until: int) -> None:
        """Take implicit steps while the robot slides or touches something; find out when that is over."""
        params = self.params
        if self._settled:
            if (
                abs(self.left.torque_line(0.0)[0]) <= self._breakaway[0]
                and abs(self.right.torque_line(0.0)[0]) <= self._breakaway[1]
            ):
                return
            self._settled = False
        while now < until:
            cx, cy = self._middle()
            if self._free_m <= 0.0:
                self._free_m = clearance(cx, cy, self._walls, self._posts) - params.body_radius_m - NEAR_M
                if self._free_m > 0.0 and not self._sliding:
                    self._press(self._walls, self._posts)
                    self._roll(now, until)
                    return
            steps = -(-(until - now) // int(CONTACT_STEP_S * SYSCLK_HZ))
            reached = now + (until - now) // steps
            near: list[Touch] = []
            if self._free_m <= 0.0:  # a body in a wall comes out by its radius at most
                walls, posts = nearby(cx, cy, 2.0 * params.body_radius_m, self._walls, self._posts)
                near = touches(cx, cy, params.body_radius_m, 2.0 * NEAR_M, walls, posts)
            self._contact_step(now, reached, near)
            if near:
                self._leave(PUSH_M_S * (reached - now) / self.second_cycles, walls, posts)
                self._press(walls, posts)
            now = reached

    def _contact_step(self, now: int, until: int, near: list[Touch]) -> None:
        params = self.params
        left, right = self.left, self.right
        span = (until - now) / self.second_cycles
        w1, w2 = left.omega_rad_s, right.omega_rad_s
        t1, d1 = left.torque_line(w1)
        t2, d2 = right.torque_line(w2)
        j1, j2 = left.params.inertia_kg_m2 + span * d1, right.params.inertia_kg_m2 + span * d2
        masses = (1.0 / j1, 1.0 / j2, 1.0 / params.mass_kg, 1.0 / params.yaw_inertia_kg_m2)
        velocities = [
            (left.params.inertia_kg_m2 * w1 + span * t1) / j1,
            (right.params.inertia_kg_m2 * w2 + span * t2) / j2,
            self.v_m_s,
            self.w_rad_s,
        ]
        r1, r2 = self._radii
        half = 0.5 * params.track_m
        friction1 = span * (self._dry[0] if w1 else self._breakaway[0])
        friction2 = span * (self._dry[1] if w2 else self._breakaway[1])
        grip = span * params.tyre_friction * self.grip * self._tyre_load_n()
        tyre1 = ContactRow((-r1, 0.0, 1.0, -half), 0.0, -grip, grip, masses)
        tyre2 = ContactRow((0.0, -r2, 1.0, half), 0.0, -grip, grip, masses)
        rows = [
            ContactRow((1.0, 0.0, 0.0, 0.0), 0.0, -friction1, friction1, masses),
            ContactRow((0.0, 1.0, 0.0, 0.0), 0.0, -friction2, friction2, masses),
            tyre1,
            tyre2,
        ]
        ex, ey = cos(self.heading_rad), sin(self.heading_rad)
        normals = []
        for touch in near:
            toward, across = touch.nx * ex + touch.ny * ey, touch.ny * ex - touch.nx * ey
            want = -touch.gap_m / span if touch.gap_m > 0.0 else 0.0  # what is left of a gap may be used up
            normal = ContactRow((0.0, 0.0, toward, params.body_ahead_m * across), want, 0.0, 1e9, masses)
            # Tangent (-ny, nx): the rim moves with the body's middle and by its own rotation.
            rub = (0.0, 0.0, -across, params.body_ahead_m * toward - params.body_radius_m)
            rows.append(normal)
            rows.append(ContactRow(rub, 0.0, -params.wall_friction, params.wall_friction, masses, normal))
            normals.append(normal)
        approach = self._approach(near, ex, ey)
        solve(velocities, rows, masses, span)
        v1, v2, v, w = velocities
        if abs(v1) < 1e-9:
            v1 = 0.0
        if abs(v2) < 1e-9:
            v2 = 0.0
        self._settled = v1 == v2 == 0.0 and abs(v) < 1e-7 and abs(w) < 1e-6
        if self._settled:
            v = w = 0.0
        if approach > 0.01 and any(normal.impulse > 0.0 for normal in normals):
            self.collisions += 1
        slide1, slide2 = v - half * w - r1 * v1, v + half * w - r2 * v2
        held = abs(slide1) < 1e-4 and abs(slide2) < 1e-4
        self._sliding = not held
        if not held:
            self.slipped_m += 0.5 * span * (abs(slide1) + abs(slide2))
        self.v_m_s, self.w_rad_s = v, w
        self._drive(v * span, w * span)
        left.omega_rad_s, right.omega_rad_s = v1, v2
        left.turn(v1 * span, now, until, v1)
        right.turn(v2 * span, now, until, v2)

    def _leave(self, push_m: float, walls: tuple[Segment, ...], posts: list[Post]) -> None:
        """Move the body out of an overlap, on skidding tyres.  Wheels and velocities do not change."""
        cx, cy = self._middle()
        x, y = pushed_out(cx, cy, self.params.body_radius_m, push_m, walls, posts)
        self.x_m += x - cx
        self.y_m += y - cy
        if abs(x - cx) + abs(y - cy) > 1e-9:
            self._settled = False

    def _approach(self, near: list[Touch], ex: float, ey: float) -> float:
        """The greatest speed in m/s at which the body approaches a wall or post that it is about to touch."""
        fastest = 0.0
        ahead = self.params.body_ahead_m
        for touch in near:
            toward, across = touch.nx * ex + touch.ny * ey, touch.ny * ex - touch.nx * ey
            speed = -(self.v_m_s * toward + self.w_rad_s * ahead * across)
            if speed > fastest and touch.gap_m < speed * CONTACT_STEP_S:
                fastest = speed
        return fastest

    def _press(self, walls: tuple[Segment, ...], posts: list[Post]) -> None:
        """Update whether something presses the bumper, with its travel as hysteresis."""
        limit = self.params.bumper_travel_m if self.bumper_pressed else 2e-4
        ex, ey = cos(self.heading_rad), sin(self.heading_rad)
        cx, cy = self._middle()
        near = touches(cx, cy, self.params.body_radius_m, limit, walls, posts)
        self.bumper_pressed = any(-(touch.nx * ex + touch.ny * ey) >= self._bumper_cos for touch in near)
