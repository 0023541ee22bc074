"""The machine's thread with a board of a user's: no world, faces that are inputs of the run, signals by its parts."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import hil.view
from emulator.clock import SYSCLK_HZ
from hil.faults import FAULTS
from hil.machine import Setup
from hil.view.checkpoints import RewindableRun
from hil.view.engine import Engine
from hil.view.probes import labels, look_at, signals
from hil.view.snapshot import Mode
from hil.view.stepping import Step
from tests.hil.own_board import project
from tests.hil.waiting import eventually

pytest.importorskip("pycparser")

REPOSITORY = Path(__file__).parents[3]
SETUP = Setup(
    board="station_board.py", world="", firmware=("firmware",), realistic=False, put=("infrared.distance_m=0.16",)
)
State = tuple[int, str, str]


def state(run: RewindableRun) -> State:
    return run.clock.now, run.uart_sha256, run.trace_sha256


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    project.write(tmp_path)
    return tmp_path


@pytest.fixture
def engine(folder: Path) -> Iterator[Engine]:
    """A paused board that has been powered up."""
    engine = Engine(SETUP, pace=None)
    engine.pause()
    engine.start()
    engine.ready.wait()
    yield engine
    engine.close()
    assert engine.error is None


def run_to(engine: Engine, at_s: float) -> State:
    engine.go_to(round(at_s * SYSCLK_HZ)).result()
    return engine.submit(state).result()


def sent(engine: Engine) -> list[str]:
    return [entry.text for entry in engine.line.log.entries_since(0) if not entry.to_robot]


def test_there_is_no_world_and_the_parts_are_shown(engine: Engine) -> None:
    assert engine.snapshot.scene is None
    assert engine.trails is None
    # 0.24 V m / 0.16 m.
    assert engine.snapshot.faces == (
        ("thermometer", "temperature_c", 21.5), ("infrared", "distance_m", 0.16), ("infrared", "level_v", 1.5)
    )  # fmt: skip
    with pytest.raises(KeyError):
        engine.act("place", 0.0, 0.0, 0.0).result()


def test_what_is_put_to_a_face_is_done_again_at_its_cycle(engine: Engine) -> None:
    run_to(engine, 0.15)
    engine.act("put", "infrared", "distance_m", 0.32).result()
    middle = run_to(engine, 0.3)
    engine.act("put", "thermometer", "temperature_c", -1.0).result()
    end = run_to(engine, 0.5)
    assert sent(engine) == ["344 2048", "344 2048", "344 1024", "-16 1024", "-16 1024"]

    assert run_to(engine, 0.3) == middle
    assert ("thermometer", "temperature_c", 21.5) in engine.snapshot.faces
    assert ("infrared", "distance_m", 0.32) in engine.snapshot.faces
    assert run_to(engine, 0.5) == end
    with pytest.raises(ValueError, match=r"infrared.distance_m = 9: must be 0.08 to 2 m"):
        engine.act("put", "infrared", "distance_m", 9.0).result()


def told(engine: Engine) -> list[tuple[str, str]]:
    return [(str(fired), phase.value) for fired, phase in engine.snapshot.faults]


def test_what_is_broken_by_hand_breaks_again_at_its_cycle(engine: Engine) -> None:
    sound = run_to(engine, 0.15)
    engine.act("break", "adc-bit-stuck:input=B3,bit=4").result()
    broken = run_to(engine, 0.3)
    engine.act("mend", 0.0).result()
    end = run_to(engine, 0.5)
    # 1.5 V of 3 V are code 2048; its bit 4, which is 0, makes 16 more.
    assert sent(engine) == ["344 2048", "344 2048", "344 2064", "344 2048", "344 2048"]
    ((fired, phase),) = told(engine)
    assert fired.startswith("adc-bit-stuck:input=B3,bit=4: fired once, first at 0.")
    assert "first access by main at " in fired
    assert phase == "removed"

    assert run_to(engine, 0.15) == sound
    assert told(engine) == []
    assert run_to(engine, 0.3) == broken
    assert told(engine) == [(fired, "at work")]
    assert run_to(engine, 0.5) == end
    assert told(engine) == [(fired, "removed")]
    assert engine.submit(lambda run: [each.text for each in run.done]).result() == [
        "break adc-bit-stuck:input=B3,bit=4", "mend 0"
    ]  # fmt: skip


def test_a_fault_by_hand_may_wait_for_its_time(engine: Engine) -> None:
    engine.act("break", "adc-channel-open:input=B3,at=0.3,for=0.1").result()
    run_to(engine, 0.25)
    assert told(engine) == [("adc-channel-open:input=B3,at=0.3,for=0.1: it never fired", "waits")]
    run_to(engine, 0.5)
    assert [phase for _, phase in told(engine)] == ["over"]


def test_what_does_not_suit_the_board_says_why(engine: Engine) -> None:
    assert engine.unsuitable["sonar-deaf"] == "this board has no sonars"
    assert engine.unsuitable["wheel-slips"] == "this board has no motor with an encoder"
    assert engine.unsuitable["gyro-reset"] == "Station must have one gyro for this, and has none"
    assert engine.unsuitable["radio-loss"] == "this board has no radio (--xbee)"
    assert set(FAULTS) - set(engine.unsuitable) == {
        "adc-bit-stuck", "adc-reference-drift", "adc-channel-open", "adc-input-held", "adc-input-shorted", "adc-dead",
        "oscillator-drift", "task-slow", "ram-bit-flip",
        *(name for name in FAULTS if name.startswith("serial-")),
    }  # fmt: skip
    for text, why in (
        ("gyro-reset", "gyro-reset: Station must have one gyro for this"), ("mend", "no fault 'mend'"),
        ("adc-bit-stuck:input=E1", "'E1' is not one of A0 to D15"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=why):
            engine.act("break", text).result()
    with pytest.raises(ValueError, match="there is no fault 0: there are 0"):
        engine.act("mend", 0.0).result()
    assert engine.submit(lambda run: run.done).result() == []


def test_the_board_is_the_one_that_was_read_at_the_start(engine: Engine, folder: Path) -> None:
    end = run_to(engine, 0.3)
    (folder / "station_board.py").write_text("nothing any more (\n")
    engine.go_to(0).result()
    assert run_to(engine, 0.3) == end


def test_bytes_reach_the_board_and_come_back(engine: Engine) -> None:
    engine.line.write(b"?")
    run_to(engine, 0.35)
    assert "?344 2048" in sent(engine)
    assert (engine.line.log.bytes_to_robot, engine.line.log.byte_counts[-13:]) == (1, "1 bytes to it")


def test_statements_are_stepped_in_the_users_program(engine: Engine) -> None:
    engine.step(Step.STATEMENT).result()
    eventually(lambda: engine.snapshot.where is not None, what="no statement")
    where = engine.snapshot.where
    assert where is not None
    assert where.place is not None
    assert Path(where.place.file).name in ("main.c", "station.c")
    assert engine.snapshot.mode is Mode.HELD
    engine.resume().result()
    eventually(lambda: engine.snapshot.cycles > SYSCLK_HZ, what="it does not run on")


def test_signals_are_those_of_the_board(engine: Engine) -> None:
    names, offered = engine.submit(lambda run: (signals(run), labels(run))).result()
    assert names[:3] == ["face thermometer.temperature_c", "face infrared.distance_m", "face infrared.level_v"]
    assert not [name for name in names if name.startswith("world ")]
    assert "main.Sixteenths" in names
    assert offered["GPIO66"] == "GPIO66 (thermometer CS)"
    assert offered["ADCINB3"] == "ADCINB3 (infrared OUT)"
    assert offered["GPIO5"] == "GPIO5"
    engine.submit(lambda _run: [engine.probes.add(name) for name in names]).result()
    run_to(engine, 0.3)
    engine.act("put", "infrared", "distance_m", 0.32).result()
    run_to(engine, 0.5)
    values = engine.submit(lambda _run: {name: engine.probes.values(name, 0) for name in names}).result()
    assert {value for _, value in values["ADCINB3"]} == {1.5, 0.75}
    assert [value for _, value in values["face infrared.level_v"]][-1] == 0.75
    assert {value for _, value in values["GPIO66"]} == {0.0, 1.0}
    with pytest.raises(ValueError, match="no signal 'world v_m_s'"):
        engine.submit(lambda run: look_at(run, "world v_m_s")).result()


def test_no_robot_is_loaded_for_it(folder: Path) -> None:
    script = (
        "import sys\nfrom tests.hil.view.test_board_engine import SETUP\nimport hil.view.server\n"
        "from hil.view.engine import Engine\n"
        "engine = Engine(SETUP, pace=None)\nengine.start()\nengine.ready.wait()\nengine.close()\n"
        "loaded = [n for n in sys.modules if n.startswith(('firmware_model', 'hil.bench', 'hil.robot'))]\n"
        "print('loaded:', loaded, engine.error)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, timeout=120, check=True,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
    )  # fmt: skip
    assert done.stdout == "loaded: [] None\n"


def test_no_part_of_the_robot_is_named_in_what_shows_every_board() -> None:
    parts = re.compile(r"sonar|gyro|bumper|motor|xbee|odometry_t|robot_d|\bfront\b", re.IGNORECASE)
    named = [
        f"{file.name}: {line.strip()}"
        for file in sorted(Path(hil.view.__file__).parent.glob("*.py"))
        for line in file.read_text(encoding="utf-8").splitlines()
        if parts.search(line)
    ]
    assert named == []
