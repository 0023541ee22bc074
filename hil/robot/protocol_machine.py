"""The serial protocol of the robot, fed with orders in pieces, beside a model of what an order must change.

`ProtocolModel` states the protocol and knows nothing of the emulator: a frame runs from `#` to a carriage return, a `#`
inside begins it anew, a frame that does not fit the buffer is dropped, an order that is none changes nothing.
`ProtocolMachine` is the Hypothesis machine.  A subclass says which firmware it holds against the model, and what it is
fed with:

    class TestProtocol(ProtocolMachine.TestCase): ...

    class MyMachine(ProtocolMachine):
        setup = Setup(world="room", realistic=False, fixes=("all",))
        frames = one_of(orders(), malformed_orders())

Sources: the thesis' protocol.c and console (annexes 1 and 2).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import ClassVar, Final

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from hil.bench import Bench
from hil.client.orders import LONGEST_ORDER
from hil.machine import Setup
from hil.testing import strategies

#: The four letters of an order -> the state that it puts the robot in.
STATES: Final = {
    b"STOP": "STOP", b"MISN": "MISSION", b"TELE": "TELEMANIPULATION", b"CALB": "CALIBRATION", b"INIT": "INITIALITATION",
}  # fmt: skip
_NUMBER: Final = rb"[+-]?(?:\d+\.?\d*|\.\d+)"
_REFERENCE: Final = re.compile(rb"#SETR(%b),(%b)\r" % (_NUMBER, _NUMBER))
#: Virtual time in which an order has its effect, once its end mark is in.
EFFECT_S: Final = 0.01


# The model


@dataclass
class ProtocolModel:
    """What the robot has understood."""

    state: str = "STOP"
    v_m_s: float = 0.0
    w_rad_s: float = 0.0
    _frame: bytes | None = None

    def receive(self, data: bytes) -> None:
        """Bytes off the line."""
        for byte in data:
            if byte == ord("#"):
                self._frame = b""
            if self._frame is None:
                continue
            self._frame += bytes((byte,))
            if byte == ord("\r"):
                self._order(self._frame)
                self._frame = None
            elif len(self._frame) >= LONGEST_ORDER:
                self._frame = None

    def _order(self, frame: bytes) -> None:
        reference = _REFERENCE.fullmatch(frame)
        if reference is not None:
            self.v_m_s, self.w_rad_s = float(reference[1]), float(reference[2])
        self.state = STATES.get(frame[1:5], self.state)


# The system


class RobotUnderTest:
    """The robot as the machine sees it: bytes in, state out."""

    def __init__(self, setup: Setup) -> None:
        self.bench = Bench(setup, traced=False)
        self.bench.boot()

    def send(self, data: bytes) -> None:
        """Put bytes on the line and let them arrive."""
        self.bench.feed(data)
        while self.bench.pending_to_robot:
            self.bench.run_for(0.001)

    def wait(self, duration_s: float) -> None:
        """Let time pass."""
        self.bench.run_for(duration_s)

    def state(self) -> str:
        """The name of the robot's state."""
        return self.bench.status().state

    def reference(self) -> tuple[float, float]:
        """The reference of the telemanipulation, in m/s and rad/s."""
        reference = self.bench.firmware.servidores.Telemanipulation_Reference
        return reference.V, reference.W

    def close(self) -> None:
        """End the robot."""
        self.bench.close()


class ProtocolMachine(RuleBasedStateMachine):
    """Frames whole, cut at any places, given up half-way, with noise between; then state and reference are compared."""

    #: The robot: ideal parts, so that its tasks have nothing but orders to react to.
    setup: ClassVar[Setup] = Setup(world="box", realistic=False)
    #: What is sent as a frame.
    frames: ClassVar[st.SearchStrategy[bytes]] = strategies.orders()

    robot: RobotUnderTest
    model: ProtocolModel

    def open(self) -> RobotUnderTest:
        """The system under test; a subclass may give another."""
        return RobotUnderTest(self.setup)

    @initialize()
    def begin(self) -> None:
        """A robot that has booted, and a new model."""
        self.robot = self.open()
        self.model = ProtocolModel()

    def _send(self, data: bytes) -> None:
        self.robot.send(data)
        self.model.receive(data)

    @rule(data=st.data(), pause_ms=st.integers(0, 30))
    def frame_in_pieces(self, data: st.DataObject, pause_ms: int) -> None:
        """A frame, cut at any places, with silence between its pieces."""
        for piece in data.draw(strategies.split(data.draw(self.frames, label="frame")), label="pieces"):
            self._send(piece)
            self.robot.wait(pause_ms / 1000.0)

    @rule(beginning=strategies.truncated_orders())
    def frame_given_up(self, beginning: bytes) -> None:
        """The beginning of an order; what comes next is none of it, unless it has no begin mark of its own."""
        self._send(beginning)

    @rule(data=strategies.noise())
    def noise_on_the_line(self, data: bytes) -> None:
        """Bytes that are no mark."""
        self._send(data)

    @invariant()
    def understood(self) -> None:
        """State and reference are what the frames so far say."""
        if "robot" not in self.__dict__:
            return
        self.robot.wait(EFFECT_S)
        assert self.robot.state() == self.model.state
        v, w = self.robot.reference()
        # float32 carries seven digits.
        assert abs(v - self.model.v_m_s) <= 1e-6 * max(1.0, abs(self.model.v_m_s)), f"V is {v}"
        assert abs(w - self.model.w_rad_s) <= 1e-6 * max(1.0, abs(self.model.w_rad_s)), f"W is {w}"

    def teardown(self) -> None:
        """End the robot."""
        if "robot" in self.__dict__:
            self.robot.close()
