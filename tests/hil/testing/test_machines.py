"""The stateful machines hold for this project's kernel and firmware, and see a kernel or firmware that does not."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis.stateful import run_state_machine_as_test

from emulator import compiled
from hil.robot.protocol_machine import ProtocolMachine, ProtocolModel, RobotUnderTest
from hil.testing.machines.gates import GateMachine, GateModel, GateRig

SLOW = (HealthCheck.too_slow, HealthCheck.data_too_large)
FEW = settings(
    max_examples=12, stateful_step_count=12, deadline=None, derandomize=True, database=None, suppress_health_check=SLOW
)
#: To find something, not to show it at its smallest.
SEEN = settings(FEW, max_examples=100, stateful_step_count=20, phases=[Phase.generate])

changes_the_kernel = pytest.mark.skipif(compiled.MODE == "compiled", reason="a compiled kernel takes no other method")


def test_gates_of_the_kernel_do_what_the_model_says() -> None:
    run_state_machine_as_test(GateMachine, settings=settings(FEW, max_examples=40, stateful_step_count=25))


class NoInheritance(GateRig):
    """A kernel whose gate owners keep their priority."""

    def __init__(self, priorities: dict[str, int], gates: int) -> None:
        super().__init__(priorities, gates)
        tasks = self.kernel.tasks
        tasks.set_priority = lambda task, priority: task.priority  # type: ignore[method-assign]


@changes_the_kernel
def test_a_gate_without_inheritance_is_seen() -> None:
    class Machine(GateMachine):
        def open(self) -> GateRig:
            return NoInheritance(self.priorities, self.gates)

    with pytest.raises(AssertionError):
        run_state_machine_as_test(Machine, settings=SEEN)


@changes_the_kernel
def test_waiters_in_order_of_arrival_are_seen() -> None:
    class Machine(GateMachine):
        def open(self) -> GateRig:
            rig = GateRig(self.priorities, self.gates)
            rig.kernel.gates._insert = lambda gate, task: gate.waiters.append(task)  # type: ignore[method-assign]
            return rig

    with pytest.raises(AssertionError, match="waiters"):
        run_state_machine_as_test(Machine, settings=SEEN)


def test_model_returns_to_the_priority_the_gate_was_taken_with() -> None:
    """low takes gate 0, high waits: low runs at 9; after leaving it has 2 again and high owns the gate."""
    model = GateModel({"low": 2, "high": 9}, 1)
    model.enter("low", 0)
    model.enter("high", 0)
    assert model.priority["low"] == 9
    model.leave("low", 0)
    assert model.priority["low"] == 2
    assert model.gates[0].owner == "high"


def test_protocol_of_the_firmware_does_what_the_model_says() -> None:
    run_state_machine_as_test(ProtocolMachine, settings=FEW)


def test_a_firmware_that_loses_an_order_is_seen() -> None:
    class Deaf(RobotUnderTest):
        def send(self, data: bytes) -> None:
            super().send(data.replace(b"M", b"m"))

    class Machine(ProtocolMachine):
        def open(self) -> RobotUnderTest:
            return Deaf(self.setup)

    with pytest.raises(AssertionError):
        run_state_machine_as_test(Machine, settings=SEEN)


@pytest.mark.parametrize(
    ("data", "state"),
    [
        (b"#MISN\r", "MISSION"),
        (b"#MI#TELE\r", "TELEMANIPULATION"),  # a begin mark inside begins anew
        (b"MISN\r", "STOP"),  # no begin mark
        (b"#MISN", "STOP"),  # no end mark yet
        (b"#MISN" + b"x" * 75 + b"\r", "STOP"),  # 81 characters do not fit 80
        (b"#misn\r", "STOP"),  # letters are capital
    ],
)
def test_model_of_the_protocol(data: bytes, state: str) -> None:
    model = ProtocolModel()
    model.receive(data)
    assert model.state == state


@pytest.mark.parametrize("frame", [b"#SETR0.1\r", b"#SETRx,y\r", b"#SETR0.1,\r", b"#SETR,0.2\r"])
def test_model_takes_no_reference_that_is_none(frame: bytes) -> None:
    model = ProtocolModel()
    model.receive(b"#SETR0.5,-1\r" + frame)
    assert (model.v_m_s, model.w_rad_s) == (0.5, -1.0)
