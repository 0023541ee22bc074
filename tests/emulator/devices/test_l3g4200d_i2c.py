"""The L3G4200D on an I2C: sub-address, auto-increment, both addresses, one register file for both buses."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from emulator.clock import SYSCLK_HZ
from emulator.devices import l3g4200d_registers as r
from emulator.devices.l3g4200d import L3G4200D
from emulator.signals import I2cBus
from tests.emulator.devices.gyro_bench import counter, make, xyz
from tests.emulator.devices.gyro_bench import read as spi_read
from tests.emulator.devices.gyro_bench import write as spi_write

PERIOD = SYSCLK_HZ // 100


def on_bus(gyro: L3G4200D) -> I2cBus:
    bus = I2cBus("I2C-A")
    bus.attach(gyro.i2c.address, gyro.i2c)
    return bus


def write(bus: I2cBus, *data: int, address: int = 0x68) -> list[bool]:
    """S SAD+W SUB DATA... P: the acknowledgments."""
    bus.start()
    seen = [bus.address(address, False), *(bus.write(byte) for byte in data)]
    bus.stop()
    return seen


def read(bus: I2cBus, sub: int, count: int, address: int = 0x68) -> list[int]:
    """S SAD+W SUB Sr SAD+R DATA... P."""
    bus.start()
    assert bus.address(address, False)
    assert bus.write(sub)
    bus.start()
    assert bus.address(address, True)
    data = [bus.read() for _ in range(count)]
    bus.stop()
    return data


def test_who_am_i_at_the_address_that_sdo_chooses() -> None:
    for sdo, address in ((0, 0x68), (1, 0x69)):
        _, gyro, _ = make(sdo=sdo)
        bus = on_bus(gyro)
        assert read(bus, 0x0F, 1, address) == [0xD3]
        bus.start()
        assert not bus.address(address ^ 1, False)


@given(value=st.integers(0, 0xFF))
def test_both_buses_see_one_register_file(value: int) -> None:
    _, gyro, _ = make()
    bus = on_bus(gyro)
    assert write(bus, r.REFERENCE, value) == [True, True, True]
    assert spi_read(gyro, r.REFERENCE) == value
    spi_write(gyro, r.REFERENCE, value ^ 0xFF)
    assert read(bus, r.REFERENCE, 1) == [value ^ 0xFF]


def test_bit_7_of_the_sub_address_increments_and_without_it_the_register_is_repeated() -> None:
    _, gyro, _ = make()
    bus = on_bus(gyro)
    write(bus, 0x80 | r.INT1_THS_XH, 1, 2, 3)
    assert gyro.registers[0x32:0x35] == [1, 2, 3]
    assert read(bus, 0x80 | r.INT1_THS_XH, 3) == [1, 2, 3]
    assert read(bus, r.INT1_THS_XH, 3) == [1, 1, 1]
    write(bus, r.INT1_THS_XH, 7, 8, 9)
    assert gyro.registers[0x32:0x35] == [9, 2, 3]


def test_a_value_read_from_its_first_half_alone_is_told_at_the_second_time() -> None:
    _, gyro, reports = make()
    bus = on_bus(gyro)
    write(bus, r.CTRL_REG1, 0x0F)
    for told in (0, 1):
        read(bus, 0x2C, 2)
        assert [rule for rule, _ in reports].count("burst-repeats") == told


def test_bytes_that_are_read_again_on_purpose_are_told_nothing() -> None:
    _, gyro, reports = make()
    bus = on_bus(gyro)
    write(bus, r.CTRL_REG1, 0x0F)
    for _ in range(3):
        read(bus, r.STATUS_REG, 5)
        read(bus, 0x80 | 0x2C, 2)
        # One byte too many each time: the driver takes the first.
        read(bus, r.OUT_X_L, 2)
        read(bus, r.OUT_X_L + 1, 2)
    assert "burst-repeats" not in [rule for rule, _ in reports]


def test_bit_6_which_increments_on_spi_is_part_of_the_address() -> None:
    _, gyro, reports = make()
    # 0x4F is no register of the map.
    assert read(on_bus(gyro), 0x40 | r.WHO_AM_I, 1) == [0]
    assert [rule for rule, _ in reports] == ["device-register"]


def test_a_burst_of_the_outputs_is_one_sample() -> None:
    clock, gyro, reports = make(counter(PERIOD))
    bus = on_bus(gyro)
    write(bus, r.CTRL_REG1, 0x0F)
    for n in (30, 31, 40):  # it has settled after 250 ms
        clock.advance_to(n * PERIOD)
        data = read(bus, 0x80 | r.OUT_X_L, 6)
        words = [low | high << 8 for low, high in zip(data[::2], data[1::2], strict=True)]
        assert words == [n, 2 * n, -n & 0xFFFF]
    clock.advance_to(41 * PERIOD)
    assert xyz(gyro) == (41, 82, -41)
    assert reports == []


def test_with_chip_select_low_the_pins_are_those_of_spi() -> None:
    _, gyro, _ = make()
    bus = on_bus(gyro)
    gyro.select(0)
    bus.start()
    assert not bus.address(0x68, False)
    gyro.select(1)
    assert read(bus, 0x0F, 1) == [0xD3]


def test_an_axis_that_is_switched_off_is_told_on_this_bus_too() -> None:
    clock, gyro, reports = make()
    bus = on_bus(gyro)
    write(bus, r.CTRL_REG1, 0x0E)  # powered, X off
    clock.advance_to(SYSCLK_HZ)
    read(bus, r.OUT_X_L, 1)
    assert [rule for rule, _ in reports] == ["not-configured"]
