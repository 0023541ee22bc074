"""Opening a port by its name or by an URL of pyserial."""

from __future__ import annotations

import os

import pytest
import serial

from hil.serial_url import BAUD, PortError, gone, open_url


@pytest.mark.skipif(os.name != "posix", reason="Windows has no pseudo-terminals to open")
def test_a_device_is_opened_with_both_time_limits() -> None:
    master, slave = os.openpty()
    with open_url(os.ttyname(slave), read_timeout_s=0.25, write_timeout_s=0.5) as line:
        assert (line.baudrate, line.timeout, line.write_timeout) == (BAUD, 0.25, 0.5)
    os.close(master)
    os.close(slave)


@pytest.mark.parametrize(
    "url",
    ["/dev/no-such-port", "nonsense://x", "/dev/null", "socket://127.0.0.1:1", "socket://localhost", "", "a\0b"],
)
def test_what_cannot_be_opened_is_one_line_that_names_it(url: str) -> None:
    with pytest.raises(PortError) as caught:
        open_url(url, read_timeout_s=0, write_timeout_s=0)
    text = str(caught.value)
    assert text.startswith(f"cannot open the serial port {url}: ")
    assert "\n" not in text


def test_a_port_that_has_failed_says_why_in_one_line() -> None:
    error = gone("COM3", serial.SerialException("read failed:\n  device disconnected"))
    assert str(error) == "COM3: the port has gone away (read failed: device disconnected)"
    assert str(gone("COM3", OSError())) == "COM3: the port has gone away (OSError)"
