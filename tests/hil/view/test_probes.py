"""What the scope records."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest

from emulator.clock import CYCLES_PER_MS
from hil.client.orders import order, set_reference
from hil.machine import Setup
from hil.view.checkpoints import RewindableRun
from hil.view.kinds import Draw, SignalKind, kind_of
from hil.view.probes import Probes, gates, look_at, signals


@pytest.fixture(scope="module")
def run() -> Iterator[RewindableRun]:
    run = RewindableRun(Setup(world="room"), traced=False)
    run.boot()
    yield run
    run.close()


def probes_on(run: RewindableRun, *names: str) -> Probes:
    probes = Probes()
    probes.attach(run)
    for name in names:
        probes.add(name)
    return probes


def test_every_name_that_is_offered_can_be_looked_at_or_recorded(run: RewindableRun) -> None:
    probes = probes_on(run)
    names = signals(run)
    assert len(names) == len(set(names))
    for name in names:
        probes.add(name)
    assert probes.names == names


@pytest.mark.parametrize(
    "name", ["nothing", "us.nothing", "AdcaRegs.NOTHING", "AdcaRegs.ADCCTL2.NOTHING", "GPIO999", "gate nothing",
             "duty GPIO999", "world nothing", "byte GPIO999", "byte nothing", "SIMO SPI-Z", "edges GPIO998/999"],
)  # fmt: skip
def test_another_name_is_refused(run: RewindableRun, name: str) -> None:
    probes = probes_on(run)
    with pytest.raises(ValueError, match=r"no |has no "):
        probes.add(name)
    assert probes.names == []


def test_variables_are_sampled_at_the_period(run: RewindableRun) -> None:
    probes = probes_on(run, "main_robot.Wl")
    probes.set_period(2 * CYCLES_PER_MS)
    begin = run.clock.now
    run.run_until(begin + 100 * CYCLES_PER_MS)
    times = [cycles for cycles, _ in probes.values("main_robot.Wl", begin)]
    gaps = {b - a for a, b in itertools.pairwise(times[1:])}  # the first was planned before
    assert gaps == {2 * CYCLES_PER_MS}
    # From 5 ms (the period before) to 100 ms, each 2 ms.
    assert len(times[1:]) == 48
    assert look_at(run, "main_robot.Wl")() == run.bench.firmware.main_robot.Wl


def test_a_gate_is_one_while_it_is_owned(run: RewindableRun) -> None:
    name = "gate US_server"
    probes = probes_on(run, name)
    run.run_until(run.clock.now + 200 * CYCLES_PER_MS)
    values = [value for _, value in probes.values(name, 0)]
    assert set(values) == {0.0, 1.0}
    # Entered and left in turn: servidores.c never nests its gates.
    assert all(a != b for a, b in itertools.pairwise(values))


def test_a_field_is_cut_out_of_its_register(run: RewindableRun) -> None:
    # us.c sets PRESCALE = 6 (ADC clock 50 MHz).
    assert look_at(run, "AdcaRegs.ADCCTL2.PRESCALE")() == 6.0
    # A register of a structure within a block, and a field of it.
    assert look_at(run, "DmaRegs.CH2.SRC_WRAP_SIZE")() == float(0xFFFF)
    assert look_at(run, "DmaRegs.CH2.MODE.PERINTE")() == 0.0
    register = run.bench.board.register("AdcaRegs", "ADCCTL2")
    assert look_at(run, "AdcaRegs.ADCCTL2")() == float(register.value)


def test_a_voltage_is_recorded_as_the_adc_samples_it(run: RewindableRun) -> None:
    wires = [wire.name for wire in run.bench.board.analog["A"]]
    probes = probes_on(run, *wires)
    adc = run.bench.board.adc["A"]
    before = adc.conversions
    run.run_until(run.clock.now + 200 * CYCLES_PER_MS)
    samples = {name: values for name in wires if (values := probes.values(name, 0))}
    # us.c converts three pins, one a sonar, and every conversion samples one.
    assert len(samples) == 3
    assert sum(map(len, samples.values())) == adc.conversions - before > 0
    # LV-MaxSonar-EZ at 5 V: Vcc/512 an inch, 254 inches at the most.
    assert all(0.0 <= volts <= 254 * 5.0 / 512 + 0.1 for values in samples.values() for _, volts in values)


def test_what_the_robot_sends_is_recorded_byte_by_byte(run: RewindableRun) -> None:
    sent = bytearray()
    run.uart_sent.connect(lambda byte, _end_cycles: sent.append(byte))
    names = [name for name in signals(run) if name.startswith("byte ")]
    probes = probes_on(run, *names)
    run.run_until(run.clock.now + 1000 * CYCLES_PER_MS)
    recorded = [bytes(int(value) for _, value in probes.values(name, 0)) for name in names]
    assert bytes(sent) in recorded
    # 9600 baud, 8N1: ten bits.
    words = [word for name in names for word in probes.words(name, 0, run.clock.now)]
    assert {round((word.end - word.begin) / (10 * 1000 * CYCLES_PER_MS / 9600), 2) for word in words} == {1.0}
    # TaskODO: a frame each 250 ms.
    assert bytes(sent).count(b"#ODO ") == 4


def test_words_on_the_spi_are_those_that_the_driver_sends_and_gets(run: RewindableRun) -> None:
    run.feed(order("tele"))
    run.run_until(run.clock.now + 300 * CYCLES_PER_MS)
    run.feed(set_reference(0.0, 0.5))
    run.run_until(run.clock.now + 1000 * CYCLES_PER_MS)
    probes = probes_on(run, "SIMO SPI-A", "SOMI SPI-A")
    run.run_until(run.clock.now + 100 * CYCLES_PER_MS)
    run.feed(order("stop"))
    sent, got = (probes.values(name, 0) for name in probes.names)
    assert [cycles for cycles, _ in sent] == [cycles for cycles, _ in got]
    # getZ reads two bytes from OUT_Z_L on.  L3G4200D: bit 7 reads, bit 6 counts the address up, OUT_Z_L is 0x2C.
    reading = [float(0x80 | 0x40 | 0x2C), 0.0, 0.0]
    times = len(sent) // 3
    assert times >= 4
    assert [value for _, value in sent] == reading * times
    # get_GYRO: the low byte first, 250 deg/s for 32767, 0.0174 rad a degree.
    low, high = (int(value) for _, value in got[-2:])
    digits = (high << 8 | low) - (high >> 7 << 16)
    firmware = run.bench.firmware
    bias = firmware.main_robot.vZ_b + firmware.gyro.Z_dc_offset - firmware.gyro.Z_Calib_b
    assert firmware.main_robot.wZ_task == pytest.approx((digits - bias) * (250 / 32767) * 0.0174, rel=1e-5)
    assert firmware.main_robot.wZ_task > 0.1
    # SPI at 1 MHz: eight bits last 8 us.
    assert sent[-1][0] - sent[-2][0] >= 8 * CYCLES_PER_MS / 1000
    out, back = (probes.words(name, 0, run.clock.now) for name in probes.names)
    assert {word.end - word.begin for word in out + back} == {8 * CYCLES_PER_MS // 1000}
    assert [(word.end, float(word.value)) for word in out] == sent
    assert [word.meaning for word in out] == ["read OUT_Z_L", "", ""] * times
    assert [word.meaning for word in back] == ["", "OUT_Z_L", "OUT_Z_H"] * times
    # What is in sight between two times: also the word that one of them lies in.
    middle = (out[4].begin + out[4].end) // 2
    assert probes.words(probes.names[0], out[2].begin, middle) == out[2:5]
    probes.remove("SIMO SPI-A")
    assert probes.words("SIMO SPI-A", 0, run.clock.now) == []


def test_the_edges_of_an_encoder_are_those_that_its_driver_counts(run: RewindableRun) -> None:
    names = [name for name in signals(run) if name.startswith("edges ")]
    probes = probes_on(run, *names)
    run.feed(order("tele"))
    run.run_until(run.clock.now + 300 * CYCLES_PER_MS)
    run.feed(set_reference(0.2, 0.0))
    run.run_until(run.clock.now + 1000 * CYCLES_PER_MS)
    run.feed(order("stop"))
    moved = [values for name in names if len(values := probes.values(name, 0)) > 10]
    # Two wheels drive ahead, mirrored in the chassis; the first value is what there was before.
    assert len(moved) == 2
    assert all(abs(values[-1][1] - values[0][1]) > 100 for values in moved)


def test_what_a_signal_is_says_the_board(run: RewindableRun) -> None:
    line, square = Draw.LINE, Draw.SQUARE
    kinds = {
        "GPIO61": SignalKind(square, part="gyro CS"), "GPIO69": SignalKind(square, part="sonars start"),
        "gate US_server": SignalKind(square), "face bumper.pressed": SignalKind(square),
        "byte GPIO89": SignalKind(Draw.BYTES, part="link DIN"), "SIMO SPI-A": SignalKind(Draw.WORDS),
        "ADCIN3": SignalKind(line, "V", "sonars FRONT"), "duty GPIO2": SignalKind(line, "duty"),
        "edges GPIO10/11": SignalKind(line, "ticks"), "face gyro.temperature_c": SignalKind(line, "degrees C"),
        "world v_m_s": SignalKind(line, "m/s"), "main_robot.wZ": SignalKind(line, "rad/s"),
        "us.R_Calib_m": SignalKind(line),
        "AdcaRegs.ADCCTL2": SignalKind(line, "digits"),
    }  # fmt: skip
    assert {name: kind_of(run, name) for name in kinds} == kinds
    # Every unit that the world tells is of a signal that there is.
    assert run.stage is not None
    assert set(run.stage.units) <= set(signals(run))


def test_the_gates_of_the_firmware_are_named_as_it_names_them(run: RewindableRun) -> None:
    # servidores.c: one gate a server.
    expected = {"Status_server", "US_server", "GYRO_server", "Reference_server", "Odometry_server"}
    assert expected <= set(gates(run.bench).values())


def test_a_removed_signal_is_sampled_no_more(run: RewindableRun) -> None:
    probes = probes_on(run, "main_robot.Wl", "main_robot.Wr")
    probes.remove("main_robot.Wl")
    run.run_until(run.clock.now + 20 * CYCLES_PER_MS)
    assert probes.names == ["main_robot.Wr"]
    assert probes.values("main_robot.Wl", 0) == []
