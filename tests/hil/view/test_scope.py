"""The scope's picture: chart and lanes of one span of time."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any

import pytest

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ
from hil.instruments.timeline import Span, TaskState
from hil.view.kinds import Draw, SignalKind
from hil.view.lanes import LEFT, TIMES, WIDTH, picture, signal_lanes
from hil.view.probes import Sample
from hil.view.words import DecodedWord
from tests.hil.view.conftest import needs_view


@pytest.fixture
def panel() -> Any:
    """The panel's drawing without a browser: what it would send stays in its elements."""
    needs_view()
    from hil.view.scope import ScopePanel

    panel: Any = object.__new__(ScopePanel)
    panel._width = WIDTH
    panel._cursors = SimpleNamespace(value={"min": 250, "max": 750})
    panel._chart = SimpleNamespace(
        options={}, update=lambda: None, style=lambda _: None, set_visibility=lambda _: None
    )
    panel._lanes = SimpleNamespace(props={}, content="")
    panel._reading = SimpleNamespace(content="")
    panel._chart_key = panel._drawn_key = panel._lanes_key = panel._lanes_look = panel._pointer = panel._end = None
    return panel


def test_lanes_that_come_after_their_chart_are_drawn(panel: Any) -> None:
    from hil.view.scope import ScopeSpan

    at = SYSCLK_HZ
    panel._look = ScopeSpan(0, at, {}, None, ("TaskUS",))
    panel._draw()
    assert panel._chart.options["xAxis"][0]["max"] == 1.0
    assert panel._lanes.content == ""
    panel._look = ScopeSpan(0, at, {}, [Span("TaskUS", 0, at // 2, TaskState.RUNNING)], ("TaskUS",))
    panel._draw()
    assert 'class="running"' in panel._lanes.content
    # A span without a single event is drawn too: nothing of an earlier one stays.
    panel._look = ScopeSpan(at, 2 * at, {}, [], ("TaskUS",))
    panel._draw()
    assert 'class="running"' not in panel._lanes.content


def test_each_unit_has_its_axis_and_each_signal_its_unit(panel: Any) -> None:
    from hil.view.scope import ScopeSpan

    half = SYSCLK_HZ // 2
    values: dict[str, list[Sample]] = {"a": [(0, 1.5)], "b": [(0, 20.0), (half, 30.0)], "c": [(0, -1.0)]}
    kinds = {"a": SignalKind(Draw.LINE, "V"), "b": SignalKind(Draw.LINE, "cm"), "c": SignalKind(Draw.LINE, "V")}
    panel._look = ScopeSpan(0, SYSCLK_HZ, values, None, (), kinds, {})
    panel._draw()
    options = panel._chart.options
    assert [axis["name"] for axis in options["yAxis"]] == ["V", "cm"]
    assert options["legend"]["data"] == ["a, V", "b, cm", "c, V"]
    drawn = {each["name"]: each["yAxisIndex"] for each in options["series"]}
    assert (drawn["a, V"], drawn["b, cm"], drawn["c, V"]) == (0, 1, 0)
    # The axes stand below each other, and do not touch.
    first, second = options["grid"]
    assert first["top"] + first["height"] < second["top"]
    # Cursors at 250 and 750 of 1000: b changes between them.
    assert "<tr><th>b</th><td>20 cm</td><td>30 cm</td></tr>" in panel._reading.content
    panel._pointer = 0.1
    panel._draw()
    assert "<tr><th>c</th><td>-1 V</td><td>-1 V</td><td>-1 V</td></tr>" in panel._reading.content


@pytest.mark.parametrize(
    ("begin_s", "end_s", "width", "ticks"),
    [
        # A number of two digits of 7 pixels and a gap of 24 are less than the 58 pixels of a second.
        (22.15, 27.15, 293, [23.0, 24.0, 25.0, 26.0, 27.0]),
        # Half of the number 27 would be beyond the end.
        (22.1, 27.05, 293, [23.0, 24.0, 25.0, 26.0]),
        (0.0, 1.0, 576, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]),
        # Nine digits of 7 and the gap: 87 pixels, which are 2.6 us.
        (30.720410, 30.720427, 576, [30.720415, 30.72042, 30.720425]),
        (33.0, 38.0, 210, [34.0, 35.0, 36.0, 37.0]),
        (1.0, 1.0, 576, []),
    ],
)
def test_the_time_axis_has_round_numbers_and_none_at_its_ends(
    begin_s: float, end_s: float, width: int, ticks: list[float]
) -> None:
    needs_view()
    from hil.view.scope import tick_times

    assert tick_times(begin_s, end_s, width) == ticks


def test_lanes_are_drawn_for_the_width_that_is_in_sight(panel: Any) -> None:
    from hil.view.scope import ScopeSpan

    panel._look = ScopeSpan(0, SYSCLK_HZ, {}, [], ("TaskUS",))
    panel._resized(SimpleNamespace(args={"width": 400}))
    panel._draw()
    assert panel._lanes.props["width"] == 400
    # Another panel is in sight: the lanes have no width, and keep theirs.
    panel._resized(SimpleNamespace(args={"width": 0}))
    # The next look brings no tasks; the picture follows the width nevertheless.
    panel._look = ScopeSpan(0, SYSCLK_HZ, {}, None, ("TaskUS",))
    panel._draw()
    assert panel._lanes.props["width"] == 400
    panel._resized(SimpleNamespace(args={"width": 640}))
    panel._draw()
    assert panel._lanes.props["width"] == 640


def drawn(kind: SignalKind, values: list[Sample], words: list[DecodedWord], span: int) -> str:
    return signal_lanes({"s": kind}, {"s": values}, {"s": words}, 0, span)[0][1]


def test_a_level_is_drawn_as_a_square() -> None:
    span, level = 1000, SignalKind(Draw.SQUARE)
    # High from a quarter to a half of the span.
    a, b = LEFT + (WIDTH - LEFT) / 4, LEFT + (WIDTH - LEFT) / 2
    square = drawn(level, [(0, 0.0), (250, 1.0), (500, 0.0)], [], span)
    assert f"M{LEFT:.1f} 17H{a:.1f}V4H{b:.1f}V17H{WIDTH:.1f}" in square
    # 500 edges within a tenth of the span: one block, and the level after it.
    crowd: list[Sample] = [(n, float(n % 2)) for n in range(100, 200)]
    square = drawn(level, [(0, 0.0), *((at * 100, v) for at, v in crowd)], [], 100_000)
    assert square.count("many") == 1
    assert square.count("H") == 2
    assert drawn(level, [], [], span) == ""


def test_words_say_what_there_is_room_for() -> None:
    reading = [DecodedWord(100, 260, 0xEC, "read OUT_Z_L"), DecodedWord(270, 430, 0), DecodedWord(440, 600, 0x5)]
    # The picture has (720 - 144) / 1000 a cycle: 92 for a word of 160, 12 characters of 6.7 beside the slants.
    text = drawn(SignalKind(Draw.WORDS), [], reading, 1000)
    assert [part.partition("<")[0] for part in text.split('y="14.5">')[1:]] == ["read OUT_Z_L", "00", "05"]
    text = drawn(SignalKind(Draw.WORDS), [], reading, 600)
    assert ">EC read OUT_Z_L<" in text
    text = drawn(SignalKind(Draw.WORDS), [], reading, 200_000)
    assert ("<text" in text, 'class="busy"' in text) == (False, True)


def test_bytes_are_characters_or_their_line() -> None:
    sent = [DecodedWord(n * 100, n * 100 + 100, byte, chr(byte)) for n, byte in enumerate(b"#ODO 1,2\r")]
    assert drawn(SignalKind(Draw.BYTES), [], sent, 900).count("<text") == 9
    assert ">#ODO 1,2<" in drawn(SignalKind(Draw.BYTES), [], sent, 6000)


def test_lanes_have_their_names_and_the_cursors() -> None:
    kinds = {"GPIO61": SignalKind(Draw.SQUARE, part="gyro <CS>"), "V": SignalKind(Draw.LINE, "m/s")}
    lanes = signal_lanes(kinds, {}, {}, 0, CYCLES_PER_MS)
    svg, height = picture(lanes, [200.0, 300.0], 0, CYCLES_PER_MS)
    assert len(lanes) == 1
    assert "gyro &lt;CS&gt;" in svg
    assert svg.count('class="cursor"') == 2
    assert f"M200.0 0V{height - TIMES}" in svg
    assert re.findall(r">(\S+ s)</text>", svg) == ["0.000000 s", "0.001000 s"]


def test_a_narrow_picture_has_the_same_lanes_in_its_own_pixels() -> None:
    kinds, values = {"s": SignalKind(Draw.SQUARE)}, {"s": [(0, 0.0), (500, 1.0)]}
    ((_, narrow),) = signal_lanes(kinds, values, {}, 0, 1000, 344)
    middle = LEFT + (344 - LEFT) / 2
    assert f"M{LEFT:.1f} 17H{middle:.1f}V4H344.0" in narrow


@pytest.mark.parametrize(("turned", "span_s"), [(-100, 2 / 3), (100, 1.5)])
def test_the_wheel_zooms_about_the_pointer(panel: Any, turned: int, span_s: float) -> None:
    from hil.view.scope import ScopeSpan

    chosen: list[float] = []
    panel._span = SimpleNamespace(value=1.0, set_options=lambda _options, value: chosen.append(value))
    panel._hold = SimpleNamespace(value=False)
    panel._engine = SimpleNamespace(snapshot=SimpleNamespace(cycles=100 * SYSCLK_HZ))
    panel._look = ScopeSpan(10 * SYSCLK_HZ, 11 * SYSCLK_HZ, {}, None, ())
    # In the middle of the lanes, at 10.5 s: that stays in the middle.
    panel._wheel(SimpleNamespace(args=[(LEFT + (WIDTH - LEFT) / 2) / WIDTH, 0, turned]))
    assert chosen == [pytest.approx(span_s)]
    assert panel._hold.value
    assert panel._end == pytest.approx((10.5 + span_s / 2) * SYSCLK_HZ)
    # Turned on before the picture came: about the same place.
    panel._span.value = chosen[0]
    panel._wheel(SimpleNamespace(args=[(LEFT + (WIDTH - LEFT) / 2) / WIDTH, 0, turned]))
    assert panel._end == pytest.approx((10.5 + span_s**2 / 2) * SYSCLK_HZ)
    # Dragged by a tenth of the lanes to the right: what was there before comes into sight.
    panel._span.value = 1.0
    panel._pointerdown(SimpleNamespace(args=[0.5, 1, 0]))
    panel._pointermove(SimpleNamespace(args=[0.5 + 0.1 * (WIDTH - LEFT) / WIDTH, 1, 0]))
    assert panel._end == pytest.approx(10.9 * SYSCLK_HZ)
