"""An emulated robot in a thread of its own, behind a port."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable

import pytest

from hil.client.orders import order
from hil.machine import FirmwareStopped, Setup
from hil.terminal.link import Link
from hil.terminal.robot import EmulatedRobot
from tests.hil.scripted_machine import ScriptedMachine
from tests.hil.waiting import eventually

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")


class Workshop:
    """Machines, remembered with the thread that made them."""

    def __init__(self, change: Callable[[ScriptedMachine], None] = lambda _machine: None) -> None:
        self.machines: list[ScriptedMachine] = []
        self.threads: list[threading.Thread] = []
        self._change = change

    def __call__(self, setup: Setup) -> ScriptedMachine:
        self.machines.append(ScriptedMachine(setup))
        self.threads.append(threading.current_thread())
        self._change(self.machines[-1])
        return self.machines[-1]


def test_it_hears_orders_through_its_port_and_ends_when_told() -> None:
    workshop = Workshop()
    robot = EmulatedRobot(Setup(), machine=workshop, pace=10)
    eventually(lambda: robot.address is not None)
    line = Link(robot.address or "")
    assert line.order("mission")
    eventually(lambda: workshop.machines[0].received == order("mission"))
    eventually(lambda: line.traffic.frames > 1)
    line.close()
    assert line.stop_sent
    robot.end()
    assert workshop.machines[0].closed
    assert workshop.threads[0] is not threading.current_thread()
    assert not workshop.threads[0].is_alive()
    assert robot.failure is None
    assert [finding.rule for finding in robot.findings] == ["unwritten-read"]


def test_leaving_during_start_up_ends_it() -> None:
    waiting, leave = threading.Event(), threading.Event()

    def slow(machine: ScriptedMachine) -> None:
        booted = machine.boot

        def boot(progress: Callable[[float], None] | None = None) -> None:
            waiting.set()
            leave.wait(30)
            booted(progress)

        machine.boot = boot  # type: ignore[method-assign]

    workshop = Workshop(slow)
    robot = EmulatedRobot(Setup(), machine=workshop)
    assert waiting.wait(30)
    threading.Timer(0.1, leave.set).start()
    robot.end()
    assert workshop.machines[0].closed
    assert robot.failure is None
    assert robot.address is None


def test_firmware_that_stops_is_told_before_the_port_closes() -> None:
    def ill(machine: ScriptedMachine) -> None:
        running = machine.run_until

        def run_until(cycles: int) -> None:
            running(cycles)
            if machine.frames_sent > 3:
                raise FirmwareStopped("a poll that nothing can end")

        machine.run_until = run_until  # type: ignore[method-assign]

    robot = EmulatedRobot(Setup(), machine=Workshop(ill), pace=10)
    eventually(lambda: robot.failure is not None)
    assert isinstance(robot.failure, FirmwareStopped)
    robot.end()
    assert len(robot.findings) == 1


def test_a_world_that_does_not_exist_is_the_failure() -> None:
    robot = EmulatedRobot(Setup(world="moon"), machine=Workshop())
    eventually(lambda: robot.failure is not None)
    assert "no world 'moon'" in str(robot.failure)


def test_a_pace_that_cannot_be_is_refused_at_once() -> None:
    with pytest.raises(ValueError, match="pace 0"):
        EmulatedRobot(Setup(), machine=Workshop(), pace=0)
