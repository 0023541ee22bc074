"""The machine's thread: it does what a plain bench does, however it is watched, stepped and gone back in."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import CancelledError
from importlib.resources import files
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from emulator.c28x.symbols import SourceError
from emulator.clock import SYSCLK_HZ
from emulator.image import Firmware
from hil.bench import BOOT_S, Bench
from hil.client.orders import TimedOrder, order, set_reference
from hil.machine import Setup
from hil.reports.policy import Policy
from hil.scenarios.scenario import load_scenario
from hil.serial_port import open_port
from hil.view.checkpoints import Checkpoint, CheckpointList, RecordedInput, RewindableRun, hands
from hil.view.engine import Engine
from hil.view.snapshot import Mode
from hil.view.stage import stage_of
from hil.view.stepping import Step
from tests.hil.waiting import eventually

SETUP = Setup(world="room", seed=3)
BOOT_CYCLES = int(BOOT_S * SYSCLK_HZ)
State = tuple[int, str, str, tuple[float, float, float]]


def state(run: RewindableRun) -> State:
    return run.clock.now, run.uart_sha256, run.trace_sha256, run.bench.world.pose


@pytest.fixture
def engine() -> Iterator[Engine]:
    """A paused robot that has just started up."""
    engine = Engine(SETUP, pace=None)
    engine.pause()
    engine.start()
    engine.ready.wait()
    yield engine
    engine.close()
    assert engine.error is None


def run_for(engine: Engine, seconds: float) -> None:
    now = engine.submit(lambda run: run.clock.now).result()
    engine.go_to(now + round(seconds * SYSCLK_HZ)).result()


def drive(engine: Engine) -> None:
    """Orders and hands on the world, at times that no slice knows."""
    engine.act("order", order("tele")).result()
    run_for(engine, 0.3000017)
    engine.act("order", set_reference(0.15, 0.2)).result()
    engine.act("add", "box", 2.0, 1.0, 0.3).result()
    run_for(engine, 0.7000003)
    engine.act("place", 1.5, 1.5, 0.7).result()
    engine.act("move", "box", 2.6, 1.2).result()
    run_for(engine, 0.5)


def test_a_watched_and_stepped_run_is_the_run_of_a_plain_bench(engine: Engine) -> None:
    for name in ("main_robot.Wl", "AdcaRegs.ADCCTL1", "GPIO69"):
        engine.submit(lambda _run, name=name: engine.probes.add(name)).result()
    drive(engine)
    for kind in (Step.STATEMENT, Step.STATEMENT, Step.ACCESS, Step.SWITCH):
        before = engine.snapshot
        engine.step(kind).result()
        eventually(lambda before=before: engine.snapshot.where not in (None, before.where), what=f"no {kind.value}")
    run_for(engine, 0.2)
    watched, done = engine.submit(lambda run: (state(run), list(run.done))).result()

    bench = Bench(SETUP)
    bench.boot()
    does = hands(bench, stage_of(bench))
    for each in done:
        bench.run_until(each.cycles)
        does[each.do](*each.values)
    bench.run_until(watched[0])
    assert (bench.clock.now, bench.uart_sha256, bench.trace_sha256, bench.world.pose) == watched
    assert [each.do for each in done] == ["order", "order", "add", "place", "move"]
    bench.close()


def test_going_back_and_on_again_is_the_same_run(engine: Engine) -> None:
    engine.act("order", order("mission")).result()
    run_for(engine, 0.6)
    middle = engine.submit(state).result()
    engine.act("order", order("stop")).result()
    run_for(engine, 0.4)
    end = engine.submit(state).result()

    engine.go_to(middle[0]).result()
    assert engine.submit(state).result() == middle
    eventually(lambda: engine.snapshot.ahead == 1, what="the stop lies ahead")
    engine.go_to(end[0]).result()
    assert engine.submit(state).result() == end
    assert engine.submit(lambda run: [each.values for each in run.done]).result() == [(b"#MISN\r",), (b"#STOP\r",)]


def test_doing_something_else_begins_a_new_future(engine: Engine) -> None:
    run_for(engine, 0.1)
    start = engine.submit(lambda run: run.clock.now).result()
    run_for(engine, 0.1)
    engine.act("order", order("mission")).result()
    engine.note("later").result()
    run_for(engine, 0.1)
    engine.go_to(start).result()
    engine.act("place", 1.0, 1.0, 0.0).result()
    done, ahead = engine.submit(lambda run: ([each.do for each in run.done], run.ahead)).result()
    assert done == ["place"]
    assert ahead == []
    assert all(moment.cycles <= start for moment in engine.moments.all)


def test_a_moment_during_start_up_can_be_gone_back_to(engine: Engine) -> None:
    engine.go_to(SYSCLK_HZ // 100).result()
    now = engine.submit(lambda run: run.clock.now).result()
    # At the first charge of the CPU that reaches it.
    assert SYSCLK_HZ // 100 <= now < SYSCLK_HZ // 100 + 2000
    run_for(engine, 3.0)
    assert engine.submit(lambda run: run.clock.now).result() > BOOT_CYCLES


def test_a_new_future_may_begin_during_start_up(engine: Engine) -> None:
    run_for(engine, 0.1)
    engine.act("order", order("mission")).result()
    engine.go_to(SYSCLK_HZ).result()
    engine.act("place", 1.0, 1.0, 0.0).result()
    engine.resume().result()
    eventually(lambda: engine.snapshot.cycles > BOOT_CYCLES, what="it does not run on")
    assert engine.moments.all[0].label == "ready"


def test_moments_with_a_name_outlive_those_without() -> None:
    moments = CheckpointList(BOOT_CYCLES, most=4)
    moments.note(BOOT_CYCLES + 1, "mine")
    for later in range(2, 20):
        moments.note(BOOT_CYCLES + later, "")
    assert [(each.cycles - BOOT_CYCLES, each.label) for each in moments.all] == [
        (0, "ready"), (1, "mine"), (18, ""), (19, ""),
    ]  # fmt: skip


def test_an_order_is_a_moment_to_go_back_to_just_before_it(engine: Engine) -> None:
    run_for(engine, 0.1)
    before = engine.submit(state).result()
    for data in (order("mission"), set_reference(0.1, 0.0), b"#MI", b"SN\r"):
        engine.act("order", data).result()
    run_for(engine, 0.1)
    named = [moment for moment in engine.moments.all if moment.label != "ready"]
    assert [(moment.cycles, moment.label) for moment in named] == [(before[0], "#MISN")]
    engine.go_to(named[0].cycles).result()
    assert engine.submit(state).result() == before
    assert engine.moments.all[1:] == named


def test_start_up_is_a_moment_however_many_orders_there_are() -> None:
    moments = CheckpointList(BOOT_CYCLES, most=4)
    for later in range(10):
        moments.note_order(RecordedInput(BOOT_CYCLES - 5 + later, "order", (order("stop"),)))
    assert Checkpoint(BOOT_CYCLES, "ready") in moments.all
    assert len(moments.all) == 4


def test_scripted_orders_survive_a_new_future() -> None:
    engine = Engine(SETUP, pace=None, orders=[TimedOrder(0.5, order("mission"))])
    engine.pause()
    engine.start()
    engine.ready.wait()
    engine.act("place", 1.0, 1.0, 0.0).result()
    engine.go_to(BOOT_CYCLES + SYSCLK_HZ).result()
    assert engine.submit(lambda run: [each.do for each in run.done]).result() == ["place", "order"]
    assert engine.submit(lambda run: run.bench.status().state).result() == "MISSION"
    engine.close()


def test_statements_follow_one_another_and_orders_wait_for_the_end_of_the_slice(engine: Engine) -> None:
    places = []
    for _ in range(12):
        before = engine.snapshot.where
        engine.step(Step.STATEMENT).result()
        eventually(lambda before=before: engine.snapshot.where not in (None, before), what="no statement")
        where = engine.snapshot.where
        assert where is not None
        assert where.place is not None
        places.append((where.cycles, where.place.function, where.place.line))
    assert engine.snapshot.mode is Mode.HELD
    assert [cycles for cycles, _, _ in places] == sorted(cycles for cycles, _, _ in places)
    # Several statements stand in the same charge: it is statements that are stepped, not charges.
    assert len({cycles for cycles, _, _ in places}) < len(places)

    waiting = engine.act("place", 1.0, 1.0, 0.0)
    assert engine.submit(lambda run: run.clock.now).result() == places[-1][0]
    assert not waiting.done()
    engine.resume().result()
    waiting.result(timeout=30)
    assert engine.submit(lambda run: run.done[-1].cycles).result() > places[-1][0]


def test_a_register_access_is_stopped_before_it_happens(engine: Engine) -> None:
    for _ in range(200):
        before = engine.snapshot.where
        engine.step(Step.ACCESS).result()
        eventually(lambda before=before: engine.snapshot.where not in (None, before), what="no access")
        where = engine.snapshot.where
        assert where is not None
        if where.text.endswith("to AdcaRegs.ADCSOCFRC1"):
            break
    # us.c: a conversion is started by writing 1 to SOCFRC1.
    assert where.text == "writes 0x0001 to AdcaRegs.ADCSOCFRC1"
    assert where.place is not None
    assert where.place.c_file == "us.c"
    # us.c: Read_Distance calls Read_Channel; whoever calls Read_Distance is a task of main_Robot.c.
    assert where.place.function == "Read_Channel"
    assert [caller.function for caller in where.callers[:1]] == ["Read_Distance"]
    assert where.callers[-1].c_file == "main_Robot.c"
    assert [name for name, _ in where.locals] == ["CH"]
    flags = engine.submit(lambda run: run.bench.board.register("AdcaRegs", "ADCSOCFLG1").value).result()
    assert flags == 0


def test_a_task_switch_and_a_frame_leave_the_robot_at_rest(engine: Engine) -> None:
    engine.step(Step.SWITCH).result()
    eventually(lambda: engine.snapshot.where is not None, what="no switch")
    assert engine.snapshot.where is not None
    assert engine.snapshot.where.text.startswith("the CPU goes to ")
    sent = engine.line.log.frame_count
    engine.step(Step.FRAME).result()
    eventually(lambda: engine.line.log.frame_count == sent + 1, what="no frame")
    eventually(lambda: engine.snapshot.mode is Mode.PAUSED, what="it does not stop")
    engine.act("order", order("stop")).result(timeout=30)
    assert engine.line.log.frame_count == sent + 1


def test_a_line_that_is_full_of_orders_says_so() -> None:
    engine = Engine(SETUP, pace=0.05)
    engine.start()
    engine.ready.wait()
    eventually(lambda: engine.line.flowing, what="it does not run")
    # 14 bytes each; the line takes 48 a second at this pace (9600 baud, ten bits a byte).
    for _ in range(10):
        engine.line.write(set_reference(0.15, 0.25))
    eventually(lambda: not engine.line.flowing, what="140 bytes wait, and nobody says so")
    assert engine.snapshot.mode is Mode.RUNNING
    engine.set_pace(None).result()
    eventually(lambda: engine.line.flowing, what="the line stays full")
    engine.close()


def test_the_last_writer_of_a_register_is_known_since_power_up(engine: Engine) -> None:
    register = "AdcaRegs", "ADCCTL1"
    writer = engine.submit(lambda run: engine.taps.writer(run.bench.board.register(*register))).result()
    # us.c, Init_US: the ADC is powered up by a write of ADCPWDNZ, in TaskUS.
    assert writer is not None
    assert writer.place is not None
    assert (writer.place.function, writer.task) == ("Init_US", "TaskUS")
    assert writer.place.file.endswith("firmware_model/us.py")
    engine.record(False).result()
    before = engine.submit(lambda _run: dict(engine.taps.writers)).result()
    run_for(engine, 0.2)
    assert engine.submit(lambda _run: dict(engine.taps.writers)).result() == before
    engine.go_to(SYSCLK_HZ).result()
    assert engine.submit(lambda _run: dict(engine.taps.writers)).result() == {}


def test_pausing_stops_the_time_and_running_goes_on(engine: Engine) -> None:
    before = engine.submit(lambda run: run.clock.now).result()
    assert engine.submit(lambda run: run.clock.now).result() == before
    engine.resume().result()
    eventually(lambda: engine.snapshot.cycles > before, what="it does not run")
    engine.pause().result()
    eventually(lambda: engine.snapshot.mode is Mode.PAUSED, what="it does not stop")


def test_what_cannot_be_done_is_told_to_whoever_asked(engine: Engine) -> None:
    with pytest.raises(ValueError, match="there is no obstacle 'nothing'"):
        engine.act("move", "nothing", 1.0, 1.0).result()
    with pytest.raises(ValueError, match="pace 0"):
        engine.set_pace(0.0)
    assert engine.submit(lambda run: run.done).result() == []


def test_a_firmware_that_stops_can_still_be_gone_back_in() -> None:
    engine = Engine(Setup(world="room", fill="trap"), pace=None)
    engine.start()
    engine.ready.wait()
    eventually(lambda: engine.snapshot.mode is Mode.STOPPED, what="it does not stop")
    assert "read before anything was written to it" in engine.snapshot.message
    stopped = engine.submit(lambda run: run.clock.now).result()
    engine.go_to(stopped // 2).result()
    assert engine.snapshot.mode is Mode.PAUSED
    assert engine.submit(lambda run: run.clock.now).result() < stopped
    engine.close()
    assert engine.error is None


def test_a_map_that_is_edited_meanwhile_does_not_change_the_past(tmp_path: Path) -> None:
    world = tmp_path / "mine.toml"
    maps = files("hil.world") / "maps"
    world.write_bytes((maps / "room.toml").read_bytes())
    engine = Engine(Setup(world=str(world), seed=3), pace=None)
    engine.pause()
    engine.start()
    engine.ready.wait()
    drive(engine)
    before = engine.submit(state).result()
    for edited in ((maps / "box.toml").read_bytes(), b"no map"):
        world.write_bytes(edited)
        engine.go_to(BOOT_CYCLES).result()
        assert engine.submit(lambda run: run.clock.now).result() == BOOT_CYCLES
        engine.go_to(before[0]).result()
        assert engine.submit(state).result() == before
    engine.close()
    assert engine.error is None


def test_a_scenario_says_start_floor_and_orders_that_wait(tmp_path: Path) -> None:
    file = tmp_path / "ice.scenario.toml"
    waiting = 'world = "room"\norders = []\n[[order]]\nsend = "mission"\nwhen = "frame 2"\n'
    file.write_text(waiting + "[start]\nx_m = 1.0\ny_m = 1.2\nheading_deg = 90\n[floor]\ngrip = 0.25\n")
    scenario, _ = load_scenario(file, Policy())
    engine = Engine(SETUP, pace=None, read=scenario.read())
    engine.pause()
    engine.start()
    engine.ready.wait()

    def begins(run: RewindableRun) -> tuple[float, float, float]:
        assert isinstance(run.bench, Bench)
        pose = run.bench.true_path()[0]
        return pose.x_m, pose.y_m, run.bench.map.grip

    later = []
    for _ in range(2):  # at first, and when an earlier moment was made again
        assert engine.submit(begins).result() == (1.0, 1.2, 0.25)
        assert engine.submit(lambda run: run.bench.status().state).result() == "STOP"
        run_for(engine, 1.0)  # three frames: the order has been given
        later.append(engine.submit(state).result())
        assert engine.submit(lambda run: run.bench.status().state).result() == "MISSION"
        engine.go_to(BOOT_CYCLES).result()
    assert later[0] == later[1]
    engine.close()
    assert engine.error is None


def test_a_driver_that_does_not_translate_any_more_leaves_the_run_as_it_is(
    engine: Engine, monkeypatch: pytest.MonkeyPatch
) -> None:
    def link(*_arguments: object, **_options: object) -> Firmware:
        raise SourceError("us.py", 12, "not a C type")

    run_for(engine, 0.1)
    before = engine.submit(state).result()
    monkeypatch.setattr("hil.bench.link", link)
    engine.go_to(BOOT_CYCLES).result()
    assert engine.submit(state).result() == before
    assert "us.py:12: not a C type" in engine.snapshot.message
    run_for(engine, 0.1)
    assert engine.submit(lambda run: run.clock.now).result() > before[0]


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
def test_a_port_that_goes_away_is_told_and_the_page_goes_on_without_it() -> None:
    master, slave = os.openpty()
    engine = Engine(SETUP, pace=None, open_port=lambda _machine: open_port(device=os.ttyname(slave)))
    engine.start()
    engine.ready.wait()
    eventually(lambda: engine.line.log.frame_count > 0, what="no frame")
    os.close(slave)
    os.close(master)
    eventually(lambda: engine.snapshot.mode is Mode.PAUSED, what="it does not stop")
    assert "the port has gone away" in engine.snapshot.message
    before = engine.snapshot.cycles
    engine.resume().result()
    eventually(lambda: engine.snapshot.cycles > before + SYSCLK_HZ, what="it does not run on")
    engine.close()
    assert engine.error is None


def test_a_machine_that_is_still_being_linked_is_left_and_ends_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    linking, linked = Event(), Event()

    def link(*given: Any, **options: Any) -> RewindableRun:
        linking.set()
        linked.wait()
        return RewindableRun(*given, **options)

    monkeypatch.setattr("hil.view.machine_thread.RewindableRun", link)
    engine = Engine(SETUP)
    engine.start()
    linking.wait()
    engine.close()
    assert not engine.ready.is_set()
    linked.set()
    engine.ready.wait()
    engine.close()  # waits for its end
    assert engine.error is None
    assert engine.snapshot.time_s == 0.0


def test_an_error_at_start_is_kept_and_nobody_waits_for_ever() -> None:
    engine = Engine(Setup(world="nowhere"))
    waiting = engine.submit(state)
    engine.start()
    engine.ready.wait()
    assert isinstance(engine.error, ValueError)
    with pytest.raises(CancelledError):
        waiting.result(timeout=30)


def test_an_error_of_ours_while_the_firmware_runs_stops_the_robot_and_nothing_else(engine: Engine) -> None:
    def fail() -> None:
        raise ZeroDivisionError("a defect of ours")

    engine.submit(lambda run: run.clock.after(1000, fail)).result()
    engine.go_to(BOOT_CYCLES + SYSCLK_HZ).result(timeout=30)
    assert "an error of this tool" in engine.stopped
    assert "ZeroDivisionError: a defect of ours" in engine.stopped
    assert engine.error is None


def test_an_error_on_the_way_ends_the_thread_and_is_told(engine: Engine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HIL_TRACEBACK", "1")  # errors of ours go on
    told: list[str] = []
    engine.on_error(lambda: told.append("told"))

    def fail() -> None:
        raise ZeroDivisionError("a defect of ours")

    engine.submit(lambda run: run.clock.after(1000, fail)).result()
    there = engine.go_to(BOOT_CYCLES + SYSCLK_HZ)
    with pytest.raises(CancelledError):
        there.result(timeout=30)
    eventually(lambda: told == ["told"], what="nobody is told")
    assert isinstance(engine.error, ZeroDivisionError)
    for late in (engine.submit(state), engine.go_to(0)):
        with pytest.raises(CancelledError):
            late.result(timeout=30)
    engine.on_error(lambda: told.append("again"))
    assert told == ["told", "again"]
    engine._machine.error = None  # the fixture takes it for a surprise
