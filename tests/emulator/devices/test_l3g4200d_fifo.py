"""FIFO modes and interrupt pins of the L3G4200D.  Expected values come from the data sheet's tables."""

from __future__ import annotations

from emulator.clock import SYSCLK_HZ
from emulator.devices import l3g4200d_registers as r
from tests.emulator.devices.gyro_bench import DEG, MS, Source, counter, make, read, transfer, write, xyz


def test_bypass_with_fifo_en_gives_the_newest_sample_and_an_empty_fifo() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG5, 0x40)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(75 * MS)
    assert xyz(gyro) == (7, 14, -7)
    assert read(gyro, r.FIFO_SRC_REG) == 0x20


def test_bypass_computes_only_the_sample_that_is_read() -> None:
    asked: list[int] = []
    clock, gyro, _ = make(lambda c: (asked.append(c), (0.0, 0.0, 0.0))[1])  # type: ignore[func-returns-value]
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(SYSCLK_HZ)
    xyz(gyro)
    assert asked == [SYSCLK_HZ]
    assert clock.events_run == 0


def test_fifo_mode_keeps_the_first_32_sets_and_stops() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG5, 0x40)
    write(gyro, r.FIFO_CTRL_REG, 0x20 | 10)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(90 * MS)
    assert read(gyro, r.FIFO_SRC_REG) == 9
    clock.advance_to(100 * MS)
    assert read(gyro, r.FIFO_SRC_REG) == 0x80 | 10
    clock.advance_to(1000 * MS)
    assert read(gyro, r.FIFO_SRC_REG) == 0xC0 | 31
    burst = transfer(gyro, 0xE8, *[0] * 12)[1:]  # after OUT_Z_H comes OUT_X_L again
    assert (burst[0], burst[6]) == (1, 2)
    write(gyro, r.FIFO_CTRL_REG, 0)
    assert read(gyro, r.FIFO_SRC_REG) == 0x20


def test_stream_mode_drops_the_oldest() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    write(gyro, r.CTRL_REG5, 0x40)
    write(gyro, r.FIFO_CTRL_REG, 0x40)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(1000 * MS)
    assert xyz(gyro)[0] == 69  # sets 69..100 are the last 32
    assert read(gyro, r.FIFO_SRC_REG) & 0x1F == 31


def step(at: int, low: float, high: float) -> Source:
    return lambda c: (low * DEG if c < at else high * DEG, 0.0, 0.0)


def test_trigger_modes_change_on_the_int1_event() -> None:
    for mode, level in ((3, 32), (4, 32)):
        clock, gyro, _ = make(step(500 * MS, 1.0, 100.0))
        write(gyro, r.CTRL_REG5, 0x40)
        write(gyro, r.FIFO_CTRL_REG, mode << 5)
        write(gyro, r.INT1_THS_XH, 0x10)  # 4096 digits = 35.84 dps
        write(gyro, r.INT1_CFG, 0x02)
        write(gyro, r.CTRL_REG1, 0x0F)
        clock.advance_to(490 * MS)
        assert read(gyro, r.FIFO_SRC_REG) & 0x20 == (0x20 if mode == 4 else 0)
        clock.advance_to(2000 * MS)
        gyro.read_register(r.FIFO_SRC_REG)
        assert gyro.fifo.level == level
        # Stream-to-FIFO froze the 32 sets up to the event at sample 50; bypass-to-stream runs on to sample 200.
        oldest = gyro.fifo.oldest()
        assert oldest is not None
        assert oldest.number == (19 if mode == 3 else 169)


def test_int1_rises_with_the_sample_that_crosses_the_threshold_and_latches() -> None:
    clock, gyro, _ = make(lambda c: ((100.0 if 500 * MS <= c < 600 * MS else 1.0) * DEG, 0.0, 0.0))
    edges: list[tuple[int, int]] = []
    gyro.int1.changed.connect(lambda level: edges.append((clock.now, level)))
    write(gyro, r.INT1_THS_XH, 0x10)
    write(gyro, r.INT1_CFG, 0x42)  # LIR, XHIE
    write(gyro, r.CTRL_REG3, 0x80)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(800 * MS)
    assert edges == [(500 * MS, 1)]
    assert read(gyro, r.INT1_SRC) == 0x42  # IA, XH
    assert edges[-1] == (800 * MS, 0)
    assert read(gyro, r.INT1_SRC) == 0


def test_duration_delays_int1_and_wait_holds_it() -> None:
    clock, gyro, _ = make(lambda c: ((100.0 if 500 * MS <= c < 600 * MS else 1.0) * DEG, 0.0, 0.0))
    edges: list[tuple[int, int]] = []
    gyro.int1.changed.connect(lambda level: edges.append((clock.now, level)))
    write(gyro, r.INT1_THS_XH, 0x10)
    write(gyro, r.INT1_CFG, 0x02)
    write(gyro, r.INT1_DURATION, 0x80 | 3)
    write(gyro, r.CTRL_REG3, 0x80)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(800 * MS)
    # Present from 500 ms: three periods later.  Absent from the sample at 600 ms: the third absent one is at 620 ms.
    assert edges == [(530 * MS, 1), (620 * MS, 0)]


def test_int1_active_low_and_open_drain() -> None:
    _, gyro, _ = make()
    gyro.int1.set_pull(1)
    write(gyro, r.CTRL_REG3, 0x30)  # H_Lactive, PP_OD: inactive is high, and open drain releases it
    assert gyro.int1.level == 1
    assert not gyro.int1.driven()


def test_drdy_follows_zyxda() -> None:
    clock, gyro, _ = make(counter(10 * MS))
    edges: list[tuple[int, int]] = []
    gyro.drdy.changed.connect(lambda level: edges.append((clock.now, level)))
    write(gyro, r.CTRL_REG3, 0x08)
    write(gyro, r.CTRL_REG1, 0x0F)
    clock.advance_to(12 * MS)
    xyz(gyro)
    clock.advance_to(21 * MS)
    assert edges == [(10 * MS, 1), (12 * MS, 0), (20 * MS, 1)]
