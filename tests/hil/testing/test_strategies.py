"""The strategies give what their names say."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from hil.robot.protocol_machine import ProtocolModel
from hil.testing import strategies as s


@given(s.outlier_windows())
def test_one_code_of_an_outlier_window_is_far_from_its_place(window: s.Outlier) -> None:
    different = [i for i, (a, b) in enumerate(zip(window.codes, window.clean, strict=True)) if a != b]
    assert different == [window.index]
    assert abs(window.codes[window.index] - window.clean[window.index]) >= 50


@given(s.adc_windows())
def test_a_window_has_twelve_codes_of_twelve_bits(window: list[int]) -> None:
    assert len(window) == 12
    assert all(0 <= code <= 4095 for code in window)


@given(s.steady_windows(noise=3))
def test_a_steady_window_lies_within_its_noise(window: list[int]) -> None:
    assert max(window) - min(window) <= 6


@given(s.slewing_windows())
def test_a_slewing_window_moves_one_way(window: list[int]) -> None:
    assert window in (sorted(window), sorted(window, reverse=True))


@given(s.gyro_words())
def test_register_bytes_are_the_word(word: int) -> None:
    low, high = s.register_bytes(word)
    value = low | high << 8
    assert (value - 0x10000 if value & 0x8000 else value) == word


@given(st.data(), s.orders())
def test_pieces_are_the_whole(data: st.DataObject, order: bytes) -> None:
    pieces = data.draw(s.split(order))
    assert b"".join(pieces) == order
    assert all(pieces)


@given(s.malformed_orders() | s.truncated_orders() | s.noise())
def test_what_is_no_order_changes_nothing(frame: bytes) -> None:
    """By the model of the protocol, which knows no strategy."""
    model = ProtocolModel(state="TELEMANIPULATION", v_m_s=0.25, w_rad_s=-1.5)
    model.receive(frame)
    assert (model.state, model.v_m_s, model.w_rad_s) == ("TELEMANIPULATION", 0.25, -1.5)


@given(s.orders())
def test_an_order_is_one_frame(order: bytes) -> None:
    assert order.startswith(b"#")
    assert order.endswith(b"\r")
    assert order.count(b"#") == order.count(b"\r") == 1


@given(s.paths())
def test_a_path_moves_within_its_limits(path: list[s.DriveSegment]) -> None:
    assert all(abs(p.v_m_s) <= 0.3 and abs(p.w_rad_s) <= 1.5 and 0.1 <= p.duration_s <= 2.0 for p in path)
