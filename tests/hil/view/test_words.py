"""Words of buses, as a logic analyser decodes them."""

from __future__ import annotations

from emulator.devices.l3g4200d import L3G4200D
from emulator.devices.lis3dh import Lis3dh
from emulator.signals import Wire
from hil.view.words import DecodedWord, SpiTransfer, character, text_lines


class Sensor:
    """What the decoder wants of a device."""

    register_names = L3G4200D.register_names

    def after(self, address: int) -> int:
        return address + 1


def told(transfer: SpiTransfer, *sent: int) -> list[tuple[str, str]]:
    found = [transfer.meanings(word, 8) for word in sent]
    transfer.end()
    return found


def test_a_transfer_names_the_registers_of_the_data_sheet() -> None:
    # L3G4200D, SPI: bit 7 reads, bit 6 counts the address up; CTRL_REG1 20h, WHO_AM_I 0Fh, OUT_Z_L 2Ch, OUT_Z_H 2Dh.
    select = Wire("GPIO61")
    transfer = SpiTransfer([(select, Sensor())])
    assert told(transfer, 0xEC, 0, 0) == [("read OUT_Z_L", ""), ("", "OUT_Z_L"), ("", "OUT_Z_H")]
    assert told(transfer, 0x8F, 0) == [("read WHO_AM_I", ""), ("", "WHO_AM_I")]
    assert told(transfer, 0x20, 0x0F) == [("write CTRL_REG1", ""), ("CTRL_REG1", "")]
    # Without bit 6 the address stays; 00h is no register.
    assert told(transfer, 0x80, 0, 0) == [("read 0x00", ""), ("", "0x00"), ("", "0x00")]
    # Nobody is selected, or the words are no bytes.
    select.drive("test", 1)
    assert told(transfer, 0x8F) == [("", "")]
    select.drive("test", 0)
    assert transfer.meanings(0x8F, 16) == ("", "")


def test_the_accelerometer_is_told_by_its_own_names() -> None:
    # LIS3DH: TEMP_CFG_REG 1Fh, CTRL_REG6 25h, OUT_X_L 28h, OUT_Y_H 2Bh.
    names = Lis3dh.register_names
    assert [names[at] for at in (0x1F, 0x25, 0x28, 0x2B)] == ["TEMP_CFG_REG", "CTRL_REG6", "OUT_X_L", "OUT_Y_H"]


def test_characters_that_cannot_be_read_have_a_name_or_a_number() -> None:
    assert [character(byte) for byte in (*b"#\r\n ~", 0x7F, 0x01)] == ["#", "CR", "LF", "SP", "~", "7F", "01"]


def test_a_line_ends_at_a_cr_or_a_pause() -> None:
    def at(begin: int, text: bytes) -> list[DecodedWord]:
        return [DecodedWord(begin + 10 * n, begin + 10 * n + 10, byte) for n, byte in enumerate(text)]

    # The third begins 100 after the second: ten characters.
    lines = text_lines([*at(0, b"#STOP\r"), *at(60, b"#ODO"), *at(200, b"x")])
    assert lines == [DecodedWord(0, 60, 6, "#STOP"), DecodedWord(60, 100, 4, "#ODO"), DecodedWord(200, 210, 1, "x")]
