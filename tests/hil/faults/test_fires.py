"""Every fault fires, is met where the firmware reads what it changed, and the corrected robot does what it can.

A run is four seconds of a mission in the corridor, with all corrections.  What is right without a fault is `sound`: the
robot drives some 0.5 m along the corridor, its heading stays within 0.01 rad, and it sends four frames a second.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import pytest

from emulator.clock import CYCLES_PER_MS
from hil.bench import Bench
from hil.faults import FAULTS, FaultOutcome, parse
from hil.machine import Setup

#: The corrected firmware begins a round of its sonars so often.
ROUND_MS = 150


@dataclass(frozen=True)
class Ran:
    """What the robot did."""

    fired: tuple[FaultOutcome, ...]
    state: str
    way_m: float
    heading_rad: float
    #: Its speed at the end, in true metres and seconds.
    v_m_s: float
    #: What odometry believes.
    believed_m: float
    front_cm: float
    frames: int
    cpu_load: float
    #: Samples of the gyro since power-up, and the time from a ping of the left sonar to one of the front sonar.
    samples: int
    next_ping_ms: float
    #: Rules of what was found, and how often it ran into something.
    findings: frozenset[str]
    collisions: int
    uart_sha256: str


@cache
def drive(fault: str = "") -> Ran:
    setup = Setup(
        xbee=fault.startswith("radio"), fixes=("all",), faults=(fault,) if fault else (),
        watch=bool(fault) and parse(fault).kind.watch,
    )  # fmt: skip
    bench = Bench(setup, traced=False)
    seen: list[int] = []
    bench.boot()
    bench.uart_sent.connect(lambda byte, cycles: seen.append(cycles) if byte == 0x0D else None)
    bench.measure_tasks()
    began = bench.status()
    bench.feed(b"#MISN\r")
    bench.run_for(4.0)
    status = bench.status()
    sonars = bench.board.sonars.sensors
    ran = Ran(
        tuple(each.report() for each in bench.faults), status.state, status.x_m - began.x_m, status.heading_rad,
        bench.world.robot.v_m_s, bench.firmware.servidores.ROBOT_Odometry_T.X / 1000.0, status.distances_cm[0],
        len(seen), bench.task_statistics().cpu_load, bench.board.gyro.last_sample_index,
        (sonars["FRONT"].last_ping_cycles - sonars["LEFT"].last_ping_cycles) / CYCLES_PER_MS % ROUND_MS,
        frozenset(finding.rule for finding in bench.findings), bench.world.robot.collisions, bench.uart_sha256,
    )  # fmt: skip
    bench.close()
    return ran


def as_sound(ran: Ran) -> bool:
    """It drives as if nothing were."""
    sound = drive()
    return ran.state == "MISSION" and abs(ran.way_m - sound.way_m) < 0.03 and abs(ran.heading_rad) < 0.02


def late(ran: Ran, stood_s: float) -> bool:
    """It drives as if nothing were, but for some seconds in which it stood."""
    return ran.state == "MISSION" and abs(ran.way_m - (drive().way_m - stood_s * drive().v_m_s)) < 0.03


def stands(ran: Ran) -> bool:
    """It was told to drive, and does not."""
    return ran.state == "MISSION" and ran.way_m == 0.0


def stays(ran: Ran) -> bool:
    """It has never been told to drive."""
    return ran.state == "STOP" and ran.way_m == 0.0


#: Fault, who reads what it changed first (of several the first), and what the corrected robot does.
CASES: list[tuple[str, str, Callable[[Ran], bool]]] = [
    # 64 of 4096 codes more or less are some 19 cm: neither wall nor stop lies within that.
    ("adc-bit-stuck:input=A3,bit=6", "TaskUS", lambda r: as_sound(r) and r.front_cm != drive().front_cm),
    # Distances shrink as the reference grows: 1/1.1.
    ("adc-reference-drift:percent=10", "TaskUS", lambda r: as_sound(r) and abs(
        r.front_cm / drive().front_cm - 1 / 1.1) < 0.01),
    # The front reads the left sonar's charge, 0.57 m instead of 2.7: it drives, slower.
    # 0 V is no distance, and 3 V are 900 cm: a mission stands, and goes on.
    ("adc-input-shorted:input=A3,at=1,for=1", "TaskUS", lambda r: r.front_cm > 0.0 and late(r, 1.0)),
    ("adc-input-shorted:input=A3,volts=3,at=1,for=1", "TaskUS", lambda r: r.front_cm > 0.0 and late(r, 1.0)),
    # The same distance over 25 cm of way: stuck; it has braked 0.2 s behind that.
    ("adc-input-held:input=A3,at=1", "TaskUS", lambda r: r.v_m_s == 0.0 and 0.25 < r.way_m < 0.4),
    ("adc-channel-open:input=A3", "TaskUS", lambda r: r.front_cm < 60.0 and 0.1 < r.way_m < drive().way_m),
    # Without a reading a mission stands, and tells -1 cm; with readings again it goes on.  It asks every 150 ms: 2 cm.
    ("adc-dead:at=2", "TaskUS", lambda r: r.v_m_s == 0.0 and r.front_cm == -1.0 and late(r, 2.0)),
    ("adc-dead:at=1,for=0.5", "TaskUS", lambda r: r.v_m_s > 0.1 and r.front_cm > 0.0 and late(r, 0.5)),
    # 255 inches are 6.5 m: it believes in a free way.
    ("sonar-deaf", "TaskUS", lambda r: as_sound(r) and r.front_cm > 600.0),
    # A wall 6 inches ahead: it does not drive into it, but goes back.
    ("sonar-stuck", "TaskUS", lambda r: r.front_cm < 20.0 and r.way_m <= 0.0),
    ("sonar-cross-talk", "TaskUS", lambda r: as_sound(r) and r.front_cm < drive().front_cm),
    # All ones is what the gyro never answers to a read of CTRL_REG1: a mission does not begin to drive.
    ("gyro-miso-stuck", "TaskGYRO", stands),
    ("gyro-select-lost", "TaskGYRO", stands),
    # A gyro in power-down answers, with another CTRL_REG1 than it was given: it is set up again, and the mission stands
    # for the 300 ms that it takes to turn on; braking and speeding up cost some 50 ms more.
    ("gyro-reset:at=1", "TaskGYRO", lambda r: r.v_m_s > 0.1 and late(r, 0.35)),
    # At rest a jump is learned as the new zero; in motion it is taken for a rotation.
    ("gyro-bias-jump", "TaskGYRO", as_sound),
    ("gyro-bias-jump:at=2", "TaskGYRO", lambda r: r.state == "MISSION" and r.heading_rad < -0.2),
    ("gyro-saturation", "TaskGYRO", as_sound),
    # Of the left wheel one edge in twenty does not count: it turns more than it says, so the robot bears to the right.
    ("encoder-edge-lost", "TaskSERVO", lambda r: -0.1 < r.heading_rad < -0.015),
    # Feedback with the wrong sign: a wheel that goes faster the other way is one that does not follow.  It stands.
    ("encoder-phases-swapped", "TaskSERVO", lambda r: r.v_m_s == 0.0 and abs(r.heading_rad) < 0.5 and r.way_m < 0.1),
    # The left wheel loses its way, the robot bears to the left and comes less far.
    ("wheel-slips", "TaskSERVO", lambda r: r.heading_rad > 0.1 and r.way_m < drive().way_m - 0.05),
    # A wheel that does not follow for 0.4 s: it stands, turned about the one that was blocked.
    ("wheel-blocked", "TaskSERVO", lambda r: r.v_m_s == 0.0 and 0.1 < r.heading_rad < 0.8 and r.way_m < 0.1),
    # The controller makes up for it by its duty: a little later at the same place.
    ("supply-sag", "", lambda r: as_sound(r) and r.way_m < drive().way_m),
    # The gyro comes back in power-down and is set up again, the sonars need 450 ms to start: the mission stands.
    ("brown-out:at=1,for=0.05", "TaskGYRO", lambda r: r.v_m_s > 0.1 and late(r, 0.75)),
    # The gyro bears 2.4 V.  Sonars are dark until they have started up again: a front of 0 inches, for which it stops.
    ("brown-out:at=1,for=0.05,volts=2.45", "TaskUS", lambda r: r.state == "MISSION" and abs(r.heading_rad) < 0.02
        and r.front_cm > drive().front_cm and 0.3 < r.way_m < drive().way_m - 0.05),
    ("bumper-stuck", "TaskNAVIGATION", lambda r: r.way_m <= 0.0),
    ("bumper-stuck:state=released", "none", as_sound),
    ("bumper-bouncing", "TaskNAVIGATION", lambda r: r.way_m < drive().way_m - 0.1),
    ("serial-bit-flipped", "Hwi:XBee_Receive", stays),
    ("serial-bit-flipped:direction=from-chip,rate=0.1", "", as_sound),
    ("serial-byte-lost", "", stays),
    ("serial-byte-doubled", "Hwi:XBee_Receive", stays),
    ("serial-burst", "Hwi:XBee_Receive", stays),
    ("serial-stall:for=0.5", "Hwi:XBee_Receive", as_sound),
    ("serial-break:for=0.1", "Hwi:XBee_Receive", stays),
    ("serial-wrong-baud", "Hwi:XBee_Receive", stays),
    ("radio-loss", "", lambda r: stays(r) and r.frames < 5),
    ("radio-latency", "", as_sound),
    # 8 % are 0.8 of a bit at the stop bit: beyond what a UART bears.
    ("oscillator-drift:percent=8", "Hwi:XBee_Receive", stays),
    ("oscillator-drift:percent=1", "Hwi:XBee_Receive", as_sound),
    # It measures speed by a clock that is fast: as far in as many cycles, so faster in true seconds.
    # The gyro takes 100 samples in a true second, of which 3.5 s hold 3.5 / 1.1 now; a sonar's cycle is longer.
    ("oscillator-drift:percent=10,at=0.5", "", lambda r: as_sound(r) and abs(r.v_m_s / drive().v_m_s - 1.1) < 0.005
        and abs(drive().samples - r.samples - 350 * (1 - 1 / 1.1)) <= 1
        and abs(r.next_ping_ms / drive().next_ping_ms - 1.1) < 0.005),
    # 40 times a second 3 ms more are 12 % of the CPU.
    ("task-slow:task=TaskSERVO,us=3000", "TaskSERVO", lambda r: as_sound(r) and abs(
        r.cpu_load - drive().cpu_load - 0.12) < 0.01),
    # A distance that is wrong for one period.
    ("ram-bit-flip:word=servidores.ROBOT_df,bit=14,at=1", "TaskNAVIGATION", as_sound),
]  # fmt: skip


@pytest.mark.parametrize(("text", "who", "does"), CASES, ids=[text for text, _, _ in CASES])
def test_fires(text: str, who: str, does: Callable[[Ran], bool]) -> None:
    ran = drive(text)
    if who == "none":
        # Nothing touches the robot in this drive: a contact that cannot close changes nothing.
        assert not ran.fired[0].count
        assert as_sound(ran)
        return
    (fired,) = ran.fired
    assert fired.count > 0
    assert 0.0 <= fired.times_s[0] <= 4.0
    assert list(fired.times_s) == sorted(fired.times_s)
    met = fired.met
    if not who:
        assert met is None
    else:
        assert met is not None
        assert met.task == who
        assert met.time_s >= fired.times_s[0]
        assert met.place.partition(":")[0].endswith(".py")
        assert met.function
    assert does(ran), ran
    # Whatever breaks, the corrected robot runs into nothing; nothing is said of its code but that it asks a dead
    # converter again.
    assert ran.collisions == 0
    assert ran.findings == ({"data-lost"} if text.startswith("adc-dead") else set())


def test_every_kind_has_a_case() -> None:
    """WHO_AM_I is read by no line of the robot's firmware: `test_drivers.py` has a driver that does."""
    assert {text.partition(":")[0] for text, _, _ in CASES} | {"gyro-who-am-i"} == set(FAULTS)


def test_same_seed_same_bytes() -> None:
    text = "serial-bit-flipped:direction=from-chip,rate=0.1"
    first = drive(text)
    drive.cache_clear()
    again = drive(text)
    assert again == first
    assert drive(f"{text},seed=2").uart_sha256 != first.uart_sha256


def test_chance_of_a_fault_is_its_own() -> None:
    """A fault that draws but is not there yet changes nothing."""
    assert drive("sonar-cross-talk:at=3.999").uart_sha256 == drive().uart_sha256


def test_a_fault_of_the_radio_outlasts_one_that_began_before_it() -> None:
    faults = ("radio-loss:at=0.1,for=0.5", "radio-loss:at=0.3,for=1.5")
    bench = Bench("box", realistic=False, xbee=True, faults=faults)
    bench.boot()
    for seconds, state in ((0.7, "STOP"), (1.5, "MISSION")):
        bench.run_for(seconds)
        bench.feed("#MISN\r")
        bench.run_for(0.5)
        assert bench.status().state == state
    bench.close()
