"""The wire log: what is written is read, and what cannot be read is said."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from hil.recording.log import (
    Direction,
    LogWriter,
    Record,
    Recording,
    escape,
    format_time,
    parse_log,
    read_log,
    unescape,
)

records = st.lists(
    st.builds(
        Record,
        st.integers(0, 10**17),
        st.sampled_from(Direction),
        st.binary(min_size=1, max_size=60) | st.sampled_from([b"#MISN\r", b"#ODO 1,2,3,4,5,6\n\r", b" ", b"\\n"]),
    ),
    max_size=8,
).map(lambda items: sorted(items, key=lambda record: record.time_ns))


def written(items: list[Record], header: dict[str, str] | None = None, *, end_ns: int | None = 10**17) -> bytes:
    file = io.StringIO()
    writer = LogWriter(file, header or {"clock": "virtual"})
    for record in items:
        writer.write(record)
    if end_ns is not None:
        writer.end(end_ns)
    return file.getvalue().encode("ascii")


@given(records)
def test_what_is_written_is_read(items: list[Record]) -> None:
    recording = parse_log(written(items), "x")
    assert recording.records == items
    assert recording.end_ns == 10**17
    assert recording.header == {"clock": "virtual"}
    assert recording.problems == []
    assert recording.statements() == []


def test_a_log_is_as_its_description_says() -> None:
    # The example of the module's docstring: times in microseconds to the cycle, bytes as C writes them.
    data = written(
        [
            Record(1_002_350_105, Direction.TO_ROBOT, b"#MISN\r"),
            Record(1_228_612_400, Direction.FROM_ROBOT, b"#ODO 0,0,0,1922,300,301\n\r"),
            Record(2_000_000_000, Direction.FROM_ROBOT, b"\x00\xff\\ "),
        ],
        end_ns=60_000_000_000,
    )
    lines = data.decode().split("\n")
    assert lines[:5] == [
        "hil-wire 1",
        "clock virtual",
        "> 1002350.105 #MISN\\r",
        "< 1228612.4 #ODO 0,0,0,1922,300,301\\n\\r",
        "< 2000000 \\x00\\xff\\\\\\x20",
    ]
    assert lines[5].startswith("end 60000000 ")
    assert lines[6:] == [""]


@given(st.binary(max_size=300))
def test_every_byte_can_be_written_on_a_line_of_ascii(data: bytes) -> None:
    text = escape(data)
    assert unescape(text) == data
    assert text.isascii()
    assert text.isprintable()
    assert not text.endswith(" ")


@given(st.integers(0, 10**17))
def test_times_have_as_many_decimals_as_they_need(time_ns: int) -> None:
    text = format_time(time_ns)
    whole, _, fraction = text.partition(".")
    assert int(whole) * 1000 + int(fraction.ljust(3, "0")) == time_ns
    assert not text.endswith((".", "0")) or "." not in text


@given(st.binary(max_size=400))
@example(b"")
@example(b"hil-wire")
@example(b"hil-wire 1")
@example(b"hil-wire 99999999999999999999\n")
def test_any_bytes_are_a_log_or_a_clear_error(data: bytes) -> None:
    try:
        recording = parse_log(data, "some.log")
    except ValueError as error:
        complaint = str(error)
    else:
        assert isinstance(recording, Recording)
        complaint = "some.log: none"
    assert complaint.startswith("some.log: ")
    assert "\n" not in complaint


@given(records, st.binary(max_size=200), st.binary(max_size=200))
def test_any_bytes_among_the_lines_do_not_hide_the_others(items: list[Record], noise: bytes, more: bytes) -> None:
    sound = written(items, end_ns=None)
    recording = parse_log(sound + b"\n" + noise.replace(b"hil", b"") + b"\n" + sound.split(b"\n", 1)[1] + more, "x")
    assert [r for r in recording.records if r in items] != [] or not items
    for record in items:
        assert recording.records.count(record) >= 1
    assert recording.problems


@given(records, st.data())
def test_a_cut_log_gives_what_was_before_and_says_so(items: list[Record], draw: st.DataObject) -> None:
    data = written(items)
    cut = draw.draw(st.integers(len(b"hil-wire 1\n"), len(data) - 1))
    recording = parse_log(data[:cut], "x")
    assert recording.records == items[: len(recording.records)]
    # All records whose line is whole are there.
    lines = data[:cut].split(b"\n")[:-1]
    assert len(recording.records) == sum(line[:1] in b"<>" for line in lines if line)
    assert any("cut" in problem for problem in recording.problems)


@given(records.filter(bool), st.data())
def test_a_changed_byte_is_noticed(items: list[Record], draw: st.DataObject) -> None:
    data = bytearray(written(items))
    place = draw.draw(st.integers(0, len(data) - 1))
    old = data[place]
    data[place] = draw.draw(st.integers(0, 255).filter(lambda byte: byte != old))
    try:
        recording = parse_log(bytes(data), "x")
    except ValueError:
        return
    end = data.rindex(b"end ") if b"end " in data else 0
    changed_time_of_end = recording.end_ns != 10**17 and place > end
    assert recording.problems or changed_time_of_end


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        (b"> 12", "damaged"),
        (b"> x #STOP\\r", "damaged"),
        (b"> 12 #STOP\\q", "damaged"),
        (b"> 12 #STOP\\", "damaged"),
        (b"> 12 #STOP\\x4", "damaged"),
        (b"> 1234567890123456 #STOP", "damaged"),
        (b"> 12 \xff", "damaged"),
        (b"port after records", "damaged"),
        (b"< 12 " + b"x" * 9000, "too long"),
    ],
)
def test_an_unreadable_line_is_left_out_and_said(line: bytes, complaint: str) -> None:
    whole = b"hil-wire 1\n> 1 a\n" + line + b"\n> 2 b\n"
    recording = parse_log(whole, "x.log")
    assert [record.data for record in recording.records] == [b"a", b"b"]
    assert any(f"x.log: line 3 is {complaint}" in statement for statement in recording.statements())


def test_editors_and_people_may_touch_it() -> None:
    data = b"hil-wire 1\r\n; a note\r\n\r\n> 2 b\r\n> 1 a\r\nend 3 00000000\r\n"
    recording = parse_log(data, "x")
    assert [(record.time_ns, record.data) for record in recording.records] == [(1000, b"a"), (2000, b"b")]
    assert recording.problems == ["was changed since it was recorded (the checksum at its end does not match)"]


def test_what_is_no_log_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "x").write_bytes(b"\x89PNG\r\n")
    with pytest.raises(ValueError, match="not a wire log"):
        read_log(tmp_path / "x")
    (tmp_path / "x").write_bytes(b"hil-wire 2\n")
    with pytest.raises(ValueError, match=r"version 2; this program reads version 1"):
        read_log(tmp_path / "x")
    with pytest.raises(ValueError, match="not a plain file"):
        read_log(tmp_path)
    with pytest.raises(ValueError, match="not a plain file"):
        read_log(Path("/dev/zero"))
    with pytest.raises(FileNotFoundError):
        read_log(tmp_path / "nothing")


def test_a_header_of_any_text_is_one_line_of_ascii() -> None:
    recording = parse_log(written([], {"port": "COM3\n> 1 #MISN\\r", "setup": '{"world": "mapa ñ.toml"}'}), "x")
    assert recording.records == []
    assert recording.header["port"] == "COM3 > 1 #MISN\\r"
    assert recording.problems == []
