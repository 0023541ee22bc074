"""eQEP in register language: expected values follow from the manual's rules, derived in the comments."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.emulator.peripherals.eqep_bench import TOP, Bench


@pytest.fixture
def bench() -> Bench:
    return Bench()


# -- position ----------------------------------------------------------------------------------------------------


def test_every_edge_counts_and_sets_the_direction(bench: Bench) -> None:
    bench.turn(3)
    assert bench.regs.QPOSCNT == 3
    assert bench.regs.QEPSTS.bit.QDF == 1
    bench.turn(-5)
    assert bench.regs.QPOSCNT == 0xFFFF_FFFE  # 3 - 5 = -2 in 32 bits
    assert bench.regs.QEPSTS.bit.QDF == 0
    assert bench.regs.QFLG.bit.PCU == 1


def test_a_counter_whose_qposmax_is_0_stays_at_0() -> None:
    bench = Bench(maximum=0)
    bench.turn(7)
    assert bench.regs.QPOSCNT == 0
    bench.turn(-7)
    assert bench.regs.QPOSCNT == 0


def test_forward_from_qposmax_leads_to_0_with_pco_and_backward_from_0_to_qposmax_with_pcu() -> None:
    bench = Bench(maximum=4)
    bench.turn(4)
    assert (bench.regs.QPOSCNT, bench.regs.QFLG.bit.PCO) == (4, 0)
    bench.turn(1)
    assert (bench.regs.QPOSCNT, bench.regs.QFLG.bit.PCO, bench.regs.QFLG.bit.PCU) == (0, 1, 0)
    bench.turn(-1)
    assert (bench.regs.QPOSCNT, bench.regs.QFLG.bit.PCU) == (4, 1)


def test_direction_change_sets_qdc_and_the_same_direction_does_not(bench: Bench) -> None:
    bench.turn(1)  # QDF 0 after reset, 1 now
    bench.regs.QCLR.bit.QDC = 1
    bench.turn(10)
    assert bench.regs.QFLG.bit.QDC == 0
    bench.turn(-1)
    assert bench.regs.QFLG.bit.QDC == 1


def test_without_qpen_nothing_counts() -> None:
    bench = Bench(enable=False)
    bench.turn(9)
    assert bench.regs.QPOSCNT == 0
    assert bench.regs.QFLG.all == 0


def test_clearing_qpen_resets_flags_and_read_only_registers_and_keeps_what_was_programmed() -> None:
    bench = Bench(maximum=9)
    bench.turn(12)
    bench.eqep.index_edge()
    bench.regs.QEPCTL.bit.QPEN = 0
    assert bench.regs.QFLG.all == 0
    assert bench.regs.QEPSTS.all == 0
    assert bench.regs.QPOSILAT == 0
    assert bench.regs.QPOSMAX == 9


def test_reads_ask_the_wire_to_move_first(bench: Bench) -> None:
    pending = [5]
    bench.wire.looked_at.connect(lambda: bench.wire.move(pending.pop() if pending else 0, 0, bench.clock.now))
    assert bench.regs.QPOSCNT == 5
    pending.append(-6)
    assert bench.regs.QFLG.bit.PCU == 1


def test_edges_before_a_write_are_counted_before_it(bench: Bench) -> None:
    pending = [5]
    bench.wire.looked_at.connect(lambda: bench.wire.move(pending.pop() if pending else 0, 0, bench.clock.now))
    bench.regs.QPOSCNT = 100
    assert bench.regs.QPOSCNT == 100


def test_swi_loads_qposinit_and_reads_0(bench: Bench) -> None:
    bench.regs.QPOSINIT = 0x12345678
    bench.turn(4)
    bench.regs.QEPCTL.bit.SWI = 1
    assert bench.regs.QPOSCNT == 0x12345678
    assert bench.regs.QEPCTL.bit.SWI == 0
    assert bench.regs.QEPCTL.bit.QPEN == 1


@pytest.mark.parametrize(
    ("fields", "sign"),
    [({"SWAP": 1}, -1), ({"QAP": 1}, -1), ({"QBP": 1}, -1), ({"SWAP": 1, "QAP": 1}, 1), ({"QAP": 1, "QBP": 1}, 1)],
)
def test_exchanging_or_inverting_lines_turns_the_direction(bench: Bench, fields: dict[str, int], sign: int) -> None:
    # Inverting A maps 00 10 11 01 to 10 00 01 11, which is the same cycle run backwards; both inverted, forwards again.
    for name, value in fields.items():
        setattr(bench.regs.QDECCTL.bit, name, value)
    bench.turn(6)
    assert bench.regs.QPOSCNT == sign * 6 & TOP


@pytest.mark.parametrize(
    ("source", "rising_only", "edges", "expected"),
    [
        # From (A,B) = 00 forward: A rises with B = 0, B rises, A falls with B = 1, B falls.
        (1, 1, 8, -2),   # rising A finds B = 0 twice: down
        (1, 1, -8, 2),   # backwards: 00 01 11 10: A rises with B = 1: up
        (1, 0, 8, 0),    # down on the rising, up on the falling edge
        (2, 0, 8, 4),    # two A edges a line
        (2, 1, 8, 2),
        (2, 1, -8, 2),   # up-count has no direction
        (3, 0, 8, -4),
        (3, 1, 8, -2),
    ],
)  # fmt: skip
def test_count_modes_use_a_as_clock(bench: Bench, source: int, rising_only: int, edges: int, expected: int) -> None:
    bench.regs.QDECCTL.bit.QSRC = source
    bench.regs.QDECCTL.bit.XCR = rising_only
    bench.turn(edges)
    assert bench.regs.QPOSCNT == expected & TOP


@given(
    maximum=st.one_of(st.integers(0, 20), st.integers(0, TOP), st.just(TOP)),
    moves=st.lists(st.integers(-60, 60), max_size=12),
)
def test_position_is_the_sum_of_edges_modulo_qposmax_plus_1(maximum: int, moves: list[int]) -> None:
    bench = Bench(maximum=maximum)
    total = 0
    for edges in moves:
        before = total
        bench.turn(edges)
        total += edges
        span = maximum + 1
        assert bench.regs.QPOSCNT == total % span
        # A wrap is a multiple of the span crossed: quotients differ.
        assert bench.regs.QFLG.bit.PCO == (total // span > before // span)
        assert bench.regs.QFLG.bit.PCU == (total // span < before // span)
        bench.regs.QCLR.all = 0x0FFF


@given(
    maximum=st.integers(0, 12),
    start=st.integers(0, 16),
    target=st.integers(0, 16),
    edges=st.integers(-40, 40).filter(bool),
)
def test_batches_equal_single_edges_also_outside_qposmax(maximum: int, start: int, target: int, edges: int) -> None:
    def run(steps: list[int]) -> tuple[int, int]:
        bench = Bench(maximum=maximum)
        bench.regs.QPOSCNT = start
        bench.regs.QPOSCMP = target
        bench.regs.QPOSCTL.bit.PCE = 1
        for step in steps:
            bench.turn(step)
        return bench.regs.QPOSCNT, bench.regs.QFLG.all

    # The manual's comparator, one edge at a time.
    position, matched = start, False
    for _ in range(abs(edges)):
        if edges > 0:
            position = 0 if position == maximum else position + 1
        else:
            position = maximum if position == 0 else position - 1
        matched |= position == target
    single = run([1 if edges > 0 else -1] * abs(edges))
    assert run([edges]) == single
    assert single[0] == position
    assert bool(single[1] & 0x0100) == matched


# -- position compare --------------------------------------------------------------------------------------------


def test_compare_matches_on_arrival_in_both_directions() -> None:
    bench = Bench(maximum=9)
    bench.regs.QPOSCMP = 7
    bench.regs.QPOSCTL.bit.PCE = 1
    bench.turn(6)
    assert bench.regs.QFLG.bit.PCM == 0
    bench.turn(1)
    assert bench.regs.QFLG.bit.PCM == 1
    bench.regs.QCLR.bit.PCM = 1
    bench.turn(2)
    bench.turn(-2)
    assert bench.regs.QFLG.bit.PCM == 1


def test_a_shadowed_compare_value_is_taken_when_the_counter_passes_0() -> None:
    bench = Bench(maximum=9)
    bench.regs.QPOSCTL.all = 1 << 15 | 1 << 12  # PCSHDW, PCE, load at 0; active value 0
    bench.turn(1)
    bench.regs.QPOSCMP = 3
    bench.turn(8)  # 1 -> 9 passes 3, which is not active yet
    assert (bench.regs.QFLG.bit.PCM, bench.regs.QFLG.bit.PCR) == (0, 0)
    bench.turn(1)  # 0: the old active value matches, then the new one loads
    assert (bench.regs.QFLG.bit.PCM, bench.regs.QFLG.bit.PCR) == (1, 1)
    bench.regs.QCLR.all = 0x0FFF
    bench.turn(3)
    assert (bench.regs.QFLG.bit.PCM, bench.regs.QFLG.bit.PCR) == (1, 0)


def test_a_replaced_compare_value_no_longer_matches() -> None:
    bench = Bench(maximum=9)
    bench.regs.QPOSCNT = 8
    bench.regs.QPOSCMP = 5
    bench.regs.QPOSCTL.all = 1 << 15 | 1 << 12  # PCSHDW, PCE, load at 0; 5 is active
    bench.regs.QPOSCMP = 7
    bench.turn(8)  # 9, 0: 7 becomes active; 1 .. 6 passes 5
    assert (bench.regs.QPOSCNT, bench.regs.QFLG.bit.PCM, bench.regs.QFLG.bit.PCR) == (6, 0, 1)


# -- index and strobe --------------------------------------------------------------------------------------------


def test_pcrm_0_resets_on_every_index_and_flags_a_position_that_is_neither_0_nor_qposmax() -> None:
    bench = Bench(maximum=99)
    bench.turn(99)
    bench.eqep.index_edge()
    assert (bench.regs.QPOSILAT, bench.regs.QPOSCNT) == (99, 0)
    assert (bench.regs.QEPSTS.bit.PCEF, bench.regs.QEPSTS.bit.FIMF, bench.regs.QEPSTS.bit.FIDF) == (0, 1, 1)
    bench.turn(42)
    bench.eqep.index_edge()
    assert (bench.regs.QPOSILAT, bench.regs.QPOSCNT) == (42, 0)
    assert (bench.regs.QEPSTS.bit.PCEF, bench.regs.QFLG.bit.PCE) == (1, 1)
    bench.turn(-100)  # 0 - 100 modulo 100: 0 again, backwards
    bench.eqep.index_edge()
    assert (bench.regs.QPOSCNT, bench.regs.QEPSTS.bit.PCEF, bench.regs.QEPSTS.bit.QDLF) == (99, 0, 0)


def test_pcrm_2_resets_on_the_first_index_only() -> None:
    bench = Bench(maximum=99)
    bench.regs.QEPCTL.bit.PCRM = 2
    bench.turn(10)
    bench.eqep.index_edge()
    assert bench.regs.QPOSCNT == 0
    bench.turn(10)
    bench.eqep.index_edge()
    assert bench.regs.QPOSCNT == 10


def test_pcrm_1_ignores_the_index(bench: Bench) -> None:
    bench.regs.QEPCTL.bit.PCRM = 1
    bench.turn(10)
    bench.eqep.index_edge()
    assert (bench.regs.QPOSCNT, bench.regs.QFLG.bit.IEL) == (10, 0)


@pytest.mark.parametrize(("mode", "inverted", "rising"), [(1, 0, True), (2, 0, False), (1, 1, False), (2, 1, True)])
def test_iel_chooses_the_edge_that_latches_and_qip_inverts_it(mode: int, inverted: int, rising: bool) -> None:
    bench = Bench()
    bench.regs.QDECCTL.bit.QIP = inverted
    bench.regs.QEPCTL.bit.PCRM = 1
    bench.regs.QEPCTL.bit.IEL = mode
    bench.turn(5)
    bench.eqep.index_edge(not rising)
    assert (bench.regs.QPOSILAT, bench.regs.QFLG.bit.IEL) == (0, 0)
    bench.eqep.index_edge(rising)
    assert (bench.regs.QPOSILAT, bench.regs.QFLG.bit.IEL) == (5, 1)


def test_strobe_latches_and_loads(bench: Bench) -> None:
    bench.regs.QPOSINIT = 77
    bench.regs.QEPCTL.bit.SEI = 2
    bench.turn(5)
    bench.eqep.strobe_edge(False)
    assert (bench.regs.QPOSSLAT, bench.regs.QPOSCNT) == (0, 5)
    bench.eqep.strobe_edge(True)
    assert (bench.regs.QPOSSLAT, bench.regs.QPOSCNT, bench.regs.QFLG.bit.SEL) == (5, 77, 1)
    bench.regs.QEPCTL.bit.SEI = 0
    bench.regs.QEPCTL.bit.SEL = 1  # backwards the falling edge latches
    bench.turn(-7)
    bench.eqep.strobe_edge(True)
    assert bench.regs.QPOSSLAT == 5
    bench.eqep.strobe_edge(False)
    assert bench.regs.QPOSSLAT == 70


# -- interrupts --------------------------------------------------------------------------------------------------


def test_a_further_interrupt_waits_until_int_is_cleared(bench: Bench) -> None:
    bench.regs.QUPRD = 1_000
    bench.regs.QEINT.bit.UTO = 1
    bench.regs.QEPCTL.bit.UTE = 1
    bench.clock.advance_to(3_500)
    assert bench.pulses == [1_000]
    bench.regs.QCLR.bit.UTO = 1
    bench.regs.QCLR.bit.INT = 1
    bench.clock.advance_to(4_000)
    assert bench.pulses == [1_000, 4_000]


def test_clearing_int_before_its_source_gives_another_interrupt(bench: Bench) -> None:
    bench.regs.QEINT.bit.WTO = 1
    bench.regs.QFRC.bit.WTO = 1
    assert len(bench.pulses) == 1
    bench.regs.QCLR.bit.INT = 1
    assert len(bench.pulses) == 2
    assert bench.regs.QFLG.bit.INT == 1


def test_a_flag_without_its_enable_raises_no_interrupt(bench: Bench) -> None:
    bench.eqep.phase_error()
    assert (bench.regs.QFLG.bit.PHE, bench.pulses) == (1, [])
    bench.regs.QEINT.bit.QPE = 1
    assert len(bench.pulses) == 1


def test_qclr_clears_only_the_flags_written_and_reads_0(bench: Bench) -> None:
    bench.regs.QFRC.all = 0x0FFE
    bench.regs.QCLR.bit.PCO = 1
    assert bench.regs.QFLG.all == 0x0FFE & ~(1 << 6)
    assert (bench.regs.QCLR.all, bench.regs.QFRC.all) == (0, 0)


# -- clock, reset, unmodelled ------------------------------------------------------------------------------------


def test_a_gated_module_keeps_its_state_and_does_not_count(bench: Bench) -> None:
    bench.regs.QUPRD = 1_000
    bench.regs.QEPCTL.bit.UTE = 1
    bench.turn(4)
    bench.clock.advance_to(600)
    bench.eqep.set_clock(False)
    bench.turn(50)
    bench.clock.advance_to(10_000)
    bench.eqep.set_clock(True)
    assert (bench.regs.QPOSCNT, bench.regs.QUTMR) == (4, 600)
    bench.clock.advance_to(10_400)
    assert bench.regs.QFLG.bit.UTO == 1


def test_reset_returns_every_register_to_0_and_stops_the_timers(bench: Bench) -> None:
    bench.regs.QUPRD = 1_000
    bench.regs.QEPCTL.bit.UTE = 1
    bench.turn(4)
    bench.eqep.reset()
    bench.clock.advance_to(5_000)
    assert all(register.read() == 0 for register in bench.regs)


def test_the_sync_output_is_reported_as_unmodelled(bench: Bench) -> None:
    bench.regs.QDECCTL.bit.SOEN = 1
    assert [f.object for f in bench.findings.of("unmodelled")] == ["EQep1Regs.QDECCTL.SOEN"]


@pytest.mark.parametrize("clears", [True, False])
def test_an_interrupt_flag_that_is_never_cleared_swallows_the_next_interrupts(clears: bool) -> None:
    bench = Bench()
    bench.regs.QUPRD = 1000
    bench.regs.QEINT.bit.UTO = 1
    bench.regs.QEPCTL.bit.UTE = 1
    bench.regs.QEPCTL.bit.QPEN = 1
    for n in range(1, 5):
        bench.clock.advance_to(1000 * n)
        if clears:
            bench.regs.QCLR.bit.UTO = 1
            bench.regs.QCLR.bit.INT = 1
    # The first unit end interrupts; the second and third find INT set, and two in a row are reported.
    reported = bench.findings.of("flag-not-cleared")
    assert [finding.object for finding in reported] == ([] if clears else ["EQep1Regs.QFLG.INT"])
