"""Tests the serial protocol of the robot: it sends orders in pieces, and compares the robot with a model.

`ProtocolModel` describes the protocol without the emulator.  A frame runs from `#` to a carriage return.  A `#` inside
begins a new frame.  A frame that does not fit the buffer is dropped.  An invalid order changes nothing.
`ProtocolMachine` is the Hypothesis machine.  A subclass chooses the firmware that is compared with the model, and the
frames that it gets:

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
#: The virtual time after the end mark within which an order takes effect.
EFFECT_S: Final = 0.01


# The model


@dataclass
class ProtocolModel:
    """The state and reference that the robot must have."""

    state: str = "STOP"
    v_m_s: float = 0.0
    w_rad_s: float = 0.0
    _frame: bytes | None = None

    def receive(self, data: bytes) -> None:
        """Take bytes from the line."""
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
    """The robot as the machine uses it: bytes go in, the state comes out."""

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
    """Sends frames: whole, in pieces, incomplete, with noise in between.  Then it compares state and reference."""

    #: The robot has ideal parts, so that its tasks react only to orders.
    setup: ClassVar[Setup] = Setup(world="box", realistic=False)
    #: The frames to send.
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
        """Send the beginning of an order only.  Later bytes do not belong to it, unless they have no begin mark."""
        self._send(beginning)

    @rule(data=strategies.noise())
    def noise_on_the_line(self, data: bytes) -> None:
        """Bytes that are no mark."""
        self._send(data)

    @invariant()
    def understood(self) -> None:
        """State and reference agree with the frames so far."""
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
