"""GPIO ports alone, in register language.  Facts: TRM GPIO chapter."""

from __future__ import annotations

from functools import partial
from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.findings import Findings
from emulator.clock import Clock
from emulator.cpu import Cpu
from emulator.peripherals.gpio import Gpio
from emulator.peripherals.gpio_qualifier import InputQualifier
from emulator.registers.gpio import PIN_COUNT, GpioCtrlRegs, GpioDataRegs
from emulator.signals import Wire


class Bench:
    def __init__(self) -> None:
        self.clock = Clock()
        self.findings = Findings(self.clock)
        self.cpu = Cpu(self.clock, self.findings)
        self.cpu.eallow = True
        self.ctrl = GpioCtrlRegs("GpioCtrlRegs", 0x7C00, self.cpu)
        self.data = GpioDataRegs("GpioDataRegs", 0x7F00, self.cpu)
        self.pins = [Wire(f"GPIO{n}") for n in range(PIN_COUNT)]
        self.gpio = Gpio(self.clock, self.cpu, self.ctrl, self.data, self.pins)
        self.muxes: list[tuple[int, int]] = []
        self.gpio.mux_changed.connect(lambda pin, mux: self.muxes.append((pin, mux)))


@pytest.fixture
def bench() -> Bench:
    return Bench()


# --- descriptions -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("register", "address"),
    # Port step 0x40 in the control block and 8 in the data block (F2837xS_gpio.h).
    [
        ("GPCDIR", 0x7C8A),
        ("GPCMUX1", 0x7C86),
        ("GPCGMUX1", 0x7CA0),
        ("GPBMUX2", 0x7C48),
        ("GPBGMUX2", 0x7C62),
        ("GPFCR", 0x7D7E),
    ],
)
def test_control_addresses(bench: Bench, register: str, address: int) -> None:
    assert bench.ctrl.registers[register].address == address


@pytest.mark.parametrize(
    ("register", "address"), [("GPADAT", 0x7F00), ("GPBDAT", 0x7F08), ("GPCTOGGLE", 0x7F16), ("GPFTOGGLE", 0x7F2E)]
)
def test_data_addresses(bench: Bench, register: str, address: int) -> None:
    assert bench.data.registers[register].address == address


def test_fields_stand_at_the_bit_of_their_pin(bench: Bench) -> None:
    fields = bench.ctrl.registers["GPBMUX2"].fields
    assert [(fields[f"GPIO{n}"].hi, fields[f"GPIO{n}"].lo) for n in (58, 61)] == [(21, 20), (27, 26)]
    assert list(bench.ctrl.registers["GPFDIR"].fields) == [f"GPIO{n}" for n in range(160, 169)]
    assert bench.ctrl.registers["GPCCSEL2"].fields["GPIO73"].lo == 4
    assert bench.ctrl.registers["GPFPUD"].value == 0x1FF


def test_a_misspelt_pin_is_an_error(bench: Bench) -> None:
    with pytest.raises(AttributeError):
        bench.ctrl.GPCDIR.bit.GPIO63 = 1


def test_every_pin_needs_a_wire(bench: Bench) -> None:
    with pytest.raises(ValueError, match="169"):
        Gpio(bench.clock, bench.cpu, bench.ctrl, bench.data, bench.pins[:168])


# --- outputs ----------------------------------------------------------------------------------------------------------


def test_a_pin_is_driven_only_as_an_output(bench: Bench) -> None:
    bench.data.GPCDAT.bit.GPIO69 = 1
    assert not bench.pins[69].driven()
    bench.ctrl.GPCDIR.bit.GPIO69 = 1
    # The latch that was written while the pin was an input appears now.
    assert (bench.pins[69].driven(), bench.pins[69].level) == (True, 1)
    bench.data.GPCDAT.bit.GPIO69 = 0
    assert bench.pins[69].level == 0
    bench.ctrl.GPCDIR.bit.GPIO69 = 0
    assert not bench.pins[69].driven()


def test_set_clear_toggle_act_on_ones_and_read_0(bench: Bench) -> None:
    bench.ctrl.GPADIR.all = 0xFFFF_FFFF
    bench.data.GPASET.all = 0x8000_0005
    assert bench.data.GPADAT.all == 0x8000_0005
    bench.data.GPACLEAR.bit.GPIO2 = 1
    assert bench.data.GPADAT.all == 0x8000_0001
    bench.data.GPATOGGLE.all = 0x8000_0002
    assert bench.data.GPADAT.all == 0x0000_0003
    assert (bench.data.GPASET.all, bench.data.GPACLEAR.all, bench.data.GPATOGGLE.all) == (0, 0, 0)


def test_a_bit_field_write_of_dat_copies_the_other_pins_of_its_half_into_their_latches(bench: Bench) -> None:
    bench.ctrl.GPBDIR.bit.GPIO58 = 1
    # Inputs in the same half (GPIO61) and in the other half (GPIO40) are high from outside.
    for pin in (61, 40):
        bench.pins[pin].drive("peer", 1)
    bench.data.GPBDAT.bit.GPIO58 = 1
    for pin in (61, 40):
        bench.pins[pin].drive("peer", None)
    bench.ctrl.GPBDIR.all = 0xFFFF_FFFF
    assert bench.data.GPBDAT.all == 1 << (58 - 32) | 1 << (61 - 32)


def test_a_loaded_output_loses_its_latch_to_a_neighbours_bit_field_write(bench: Bench) -> None:
    bench.ctrl.GPADIR.all = 0b11
    bench.data.GPASET.all = 0b01
    bench.pins[0].drive("short", 0)
    bench.data.GPADAT.bit.GPIO1 = 1
    bench.pins[0].drive("short", None)
    assert bench.data.GPADAT.all == 0b10


def test_open_drain_only_pulls_low(bench: Bench) -> None:
    bench.ctrl.GPADIR.bit.GPIO3 = 1
    bench.ctrl.GPAODR.bit.GPIO3 = 1
    assert bench.pins[3].driven()
    bench.data.GPASET.bit.GPIO3 = 1
    assert not bench.pins[3].driven()
    bench.pins[3].drive("peer", 0)
    assert bench.data.GPADAT.bit.GPIO3 == 0


def test_two_drivers_against_each_other_are_a_finding(bench: Bench) -> None:
    bench.pins[5].drive("peer", 0)
    bench.ctrl.GPADIR.bit.GPIO5 = 1
    assert not bench.findings.of("contention")
    bench.data.GPASET.bit.GPIO5 = 1
    (finding,) = bench.findings.of("contention")
    assert (finding.object, finding.message) == ("GPIO5", "GPIO5 drives 1 against peer")


@given(
    accesses=st.lists(
        st.tuples(
            st.sampled_from(["DAT", "SET", "CLEAR", "TOGGLE"]),
            st.integers(0, 0xFFFF_FFFF),
            st.sampled_from([0xFFFF, 0xFFFF_0000, 0xFFFF_FFFF]),
        ),
        max_size=20,
    ),
    direction=st.integers(0, 0xFFFF_FFFF),
)
def test_latches_follow_the_model_of_four_registers(accesses: list[tuple[str, int, int]], direction: int) -> None:
    bench = Bench()
    bench.ctrl.GPDDIR.all = direction
    latch = 0
    for name, word, lanes in accesses:
        bench.data.registers[f"GPD{name}"].write(word, lanes)
        word &= lanes
        latch = {
            "DAT": latch & ~lanes | word, "SET": latch | word, "CLEAR": latch & ~word, "TOGGLE": latch ^ word,
        }[name]  # fmt: skip
        assert bench.data.GPDDAT.all == latch & direction
    bench.ctrl.GPDDIR.all = 0xFFFF_FFFF
    assert bench.data.GPDDAT.all == latch


# --- inputs -----------------------------------------------------------------------------------------------------------


def test_dat_reads_the_pin_whatever_its_function(bench: Bench) -> None:
    bench.pins[41].drive("peer", 1)
    assert bench.data.GPBDAT.bit.GPIO41 == 1
    bench.ctrl.GPBMUX1.bit.GPIO41 = 2
    assert bench.data.GPBDAT.all == 1 << 9


def test_inversion_is_of_the_input(bench: Bench) -> None:
    bench.ctrl.GPAINV.bit.GPIO7 = 1
    assert bench.data.GPADAT.all == 0x80
    bench.pins[7].drive("peer", 1)
    assert bench.data.GPADAT.all == 0


def test_pull_up_decides_about_an_undriven_pin(bench: Bench) -> None:
    bench.ctrl.GPFPUD.bit.GPIO168 = 0
    assert bench.data.GPFDAT.all == 0x100
    bench.ctrl.GPFPUD.bit.GPIO168 = 1
    assert bench.data.GPFDAT.all == 0


def test_three_sample_qualification_delays_an_edge_and_hides_a_glitch(bench: Bench) -> None:
    bench.ctrl.GPACTRL.bit.QUALPRD1 = 5
    bench.ctrl.GPAQSEL1.bit.GPIO9 = 1
    bench.clock.advance_to(1)
    bench.pins[9].drive("peer", 1)
    # Samples each 2 * 5 = 10 cycles: at 10, 20 and 30.
    bench.clock.advance_to(29)
    assert bench.data.GPADAT.bit.GPIO9 == 0
    bench.clock.advance_to(30)
    assert bench.data.GPADAT.bit.GPIO9 == 1
    bench.pins[9].drive("peer", 0)
    bench.clock.advance_to(55)
    # Seen low at 40 and 50 only.
    bench.pins[9].drive("peer", 1)
    bench.clock.advance_to(200)
    assert bench.data.GPADAT.bit.GPIO9 == 1


def test_asynchronous_input_passes_at_once(bench: Bench) -> None:
    bench.ctrl.GPACTRL.bit.QUALPRD0 = 0xFF
    bench.ctrl.GPAQSEL1.bit.GPIO0 = 2
    bench.pins[0].drive("peer", 1)
    assert bench.data.GPADAT.all == 0
    bench.ctrl.GPAQSEL1.bit.GPIO0 = 3
    assert bench.data.GPADAT.all == 1


@given(
    gaps=st.lists(st.integers(1, 40), min_size=1, max_size=30),
    period=st.sampled_from([1, 2, 6, 10]),
    samples=st.sampled_from([3, 6]),
)
def test_qualifier_equals_sampling_every_period(gaps: list[int], period: int, samples: int) -> None:
    clock = Clock()
    found: list[tuple[int, int]] = []
    qualifier = InputQualifier(clock, 0, samples, lambda: period, lambda level: found.append((clock.now, level)))
    times = list(accumulate(gaps))
    changes = {time: (i + 1) % 2 for i, time in enumerate(times)}

    def change(i: int) -> None:
        qualifier.change(changes[times[i]])
        if i + 1 < len(times):
            # Scheduled late on purpose: an edge in the cycle of a sample is seen by that sample, in any order.
            clock.schedule(times[i + 1], partial(change, i + 1))

    clock.schedule(times[0], partial(change, 0))
    end = times[-1] + 10 * period
    clock.advance_to(end)

    expected: list[tuple[int, int]] = []
    pin = accepted = run = 0
    for cycle in range(end + 1):
        pin = changes.get(cycle, pin)
        if cycle % period == 0:
            run = run + 1 if pin != accepted else 0
            if run == samples:
                accepted, run = pin, 0
                expected.append((cycle, accepted))
    assert found == expected


# --- function, lock, protection ---------------------------------------------------------------------------------------


def test_mux_is_gmux_and_mux_and_the_board_is_told(bench: Bench) -> None:
    bench.ctrl.GPBMUX2.bit.GPIO58 = 0
    bench.ctrl.GPBGMUX2.bit.GPIO58 = 3
    bench.ctrl.GPBMUX2.bit.GPIO58 = 3
    assert bench.muxes == [(58, 12), (58, 15)]
    assert bench.gpio.mux(58) == 15
    assert bench.gpio.mux(59) == 0
    with pytest.raises(ValueError, match="GPIO169"):
        bench.gpio.mux(169)


def test_a_pin_given_to_a_peripheral_is_released_and_comes_back(bench: Bench) -> None:
    bench.ctrl.GPADIR.bit.GPIO2 = 1
    bench.ctrl.GPAMUX1.bit.GPIO2 = 1
    assert not bench.pins[2].driven()
    bench.data.GPASET.bit.GPIO2 = 1
    assert not bench.pins[2].driven()
    bench.ctrl.GPAMUX1.bit.GPIO2 = 0
    assert bench.pins[2].level == 1


def test_gmux_alone_leaves_a_pin_gpio(bench: Bench) -> None:
    bench.ctrl.GPADIR.bit.GPIO2 = 1
    bench.ctrl.GPAGMUX1.bit.GPIO2 = 2
    assert bench.pins[2].driven()


def test_control_is_protected_and_data_is_not(bench: Bench) -> None:
    bench.cpu.eallow = False
    bench.ctrl.GPADIR.bit.GPIO0 = 1
    assert bench.ctrl.GPADIR.all == 0
    assert [finding.object for finding in bench.findings.of("eallow")] == ["GpioCtrlRegs.GPADIR"]
    bench.data.GPADAT.bit.GPIO0 = 1
    assert len(bench.findings) == 1


def test_lock_freezes_the_configuration_of_its_pin_only(bench: Bench) -> None:
    bench.ctrl.GPALOCK.bit.GPIO1 = 1
    bench.ctrl.GPADIR.all = 0b111
    bench.ctrl.GPAMUX1.all = 0b11_11_11
    assert bench.ctrl.GPADIR.all == 0b101
    assert bench.ctrl.GPAMUX1.all == 0b11_00_11
    assert len(bench.findings.of("locked")) == 2
    bench.ctrl.GPALOCK.all = 0
    bench.ctrl.GPADIR.all = 0b111
    assert bench.ctrl.GPADIR.all == 0b111


def test_commit_freezes_the_lock_until_reset(bench: Bench) -> None:
    bench.ctrl.GPALOCK.all = 0b01
    bench.ctrl.GPACR.all = 0b11
    bench.ctrl.GPACR.all = 0
    bench.ctrl.GPALOCK.all = 0b10
    assert bench.ctrl.GPACR.all == 0b11
    assert bench.ctrl.GPALOCK.all == 0b01
    bench.gpio.reset()
    bench.ctrl.GPALOCK.all = 0b10
    assert bench.ctrl.GPALOCK.all == 0b10


def test_writing_zeros_everywhere_as_start_up_code_does_is_no_finding(bench: Bench) -> None:
    for register in [*bench.ctrl, *bench.data]:
        if not register.name.endswith("PUD"):
            register.all = 0
    assert len(bench.findings) == 0
    assert bench.muxes == []


@pytest.mark.parametrize(("register", "field"), [("GPACSEL1", "GPIO0"), ("GPBAMSEL", "GPIO42")])
def test_unmodelled_fields_are_reported_by_name(bench: Bench, register: str, field: str) -> None:
    setattr(bench.ctrl.registers[register].bit, field, 1)
    assert [finding.object for finding in bench.findings.of("unmodelled")] == [f"GpioCtrlRegs.{register}.{field}"]


def test_reset_makes_every_pin_an_input(bench: Bench) -> None:
    bench.ctrl.GPADIR.bit.GPIO0 = 1
    bench.data.GPASET.bit.GPIO0 = 1
    bench.ctrl.GPAPUD.bit.GPIO1 = 0
    bench.ctrl.GPAMUX1.bit.GPIO2 = 1
    bench.gpio.reset()
    assert bench.data.GPADAT.all == 0
    assert not bench.pins[0].driven()
    assert bench.muxes == [(2, 1), (2, 0)]
    assert bench.ctrl.GPAPUD.all == 0xFFFF_FFFF
    bench.ctrl.GPADIR.bit.GPIO0 = 1
    assert bench.pins[0].level == 0
