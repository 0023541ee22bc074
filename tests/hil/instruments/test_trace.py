"""The trace file, and what it is written as for other tools."""

from __future__ import annotations

import csv
import itertools
import json
import math
import os
import shutil
import struct
import subprocess
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hil.bench import Bench
from hil.cli import invoke
from hil.instruments.export import FORMATS, export
from hil.instruments.recorder import recorded
from hil.instruments.serial_lines import serial_lines
from hil.instruments.trace_file import CHANNELS, RecordedTrace, checked, read
from hil.machine import Setup

ALL = checked(["all"])


def run(path: Path | None) -> Bench:
    """Half a second of a mission, recorded from power-up on."""
    bench = Bench(Setup(seed=3))
    if path is None:
        bench.boot()
        bench.feed(b"#MISN\r")
        bench.run_for(0.5)
    else:
        with recorded(path, bench, ALL):
            bench.boot()
            bench.feed(b"#MISN\r")
            bench.run_for(0.5)
    return bench


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Bench]:
    path = tmp_path_factory.mktemp("trace") / "run.trace"
    return path, run(path)


@pytest.fixture(scope="module")
def trace(recording: tuple[Path, Bench]) -> RecordedTrace:
    return read(recording[0])


def test_a_recorded_run_is_the_same_run(recording: tuple[Path, Bench]) -> None:
    plain, watched = run(None), recording[1]
    assert (watched.uart_sha256, watched.trace_sha256) == (plain.uart_sha256, plain.trace_sha256)
    assert [f.as_dict() for f in watched.findings] == [f.as_dict() for f in plain.findings]
    assert watched.clock.now == plain.clock.now


def test_nobody_listens_any_more_when_it_is_over(tmp_path: Path) -> None:
    bench = run(tmp_path / "t")
    size = (tmp_path / "t").stat().st_size
    bench.run_for(0.01)
    assert (tmp_path / "t").stat().st_size == size
    assert not any(wire.sampled.listeners for wire in bench.board.analog["A"])


def test_the_same_seed_gives_the_same_file(recording: tuple[Path, Bench], tmp_path: Path) -> None:
    run(tmp_path / "again.trace")
    assert (tmp_path / "again.trace").read_bytes() == recording[0].read_bytes()


def test_every_channel_has_what_it_says(trace: RecordedTrace, recording: tuple[Path, Bench]) -> None:
    bench = recording[1]
    counts = Counter(channel for _, channel, _, _ in trace.events)
    assert set(counts) == set(CHANNELS)
    assert counts["adc"] == bench.board.adc["A"].conversions
    assert counts["findings"] == len(bench.findings)
    sent = bytes(value for _, _, name, value in trace.of("serial") if name == "GPIO89")
    assert b"#ODO " in sent
    assert b"#MISN\r" in bytes(value for _, _, name, value in trace.of("serial") if name == "GPIO90")
    times = [event[0] for event in trace.events]
    assert times == sorted(times)


def test_variables_are_told_when_they_have_changed(trace: RecordedTrace, recording: tuple[Path, Bench]) -> None:
    servers = recording[1].firmware.servidores
    status = [(cycles, value) for cycles, _, name, value in trace.of("variables") if name == "servidores.ROBOT_Status"]
    assert len({value for _, value in status}) == len(status) == 2  # STOP, and MISSION for the rest
    assert status[-1][1] == servers.ROBOT_Status
    # The order was given after 2.2 s of start-up and takes 6 bytes of 1.04 ms: a look a millisecond sees it soon.
    assert 2.2 < status[-1][0] / 200e6 < 2.21 + 6 * 10 / 9600
    distances = [value for _, _, name, value in trace.of("variables") if name == "servidores.ROBOT_df"]
    assert all(one != other for one, other in itertools.pairwise(distances))
    assert servers.ROBOT_df == distances[-1]


def test_only_what_was_asked_for_is_recorded(tmp_path: Path) -> None:
    bench = Bench(Setup())
    with recorded(tmp_path / "t", bench, ("findings",)):
        bench.boot()
    assert {event[1] for event in read(tmp_path / "t").events} == {"findings"}


def test_a_file_that_was_cut_off_is_read_to_there(recording: tuple[Path, Bench], tmp_path: Path) -> None:
    lines = recording[0].read_bytes().splitlines(keepends=True)[:100]
    (tmp_path / "t").write_bytes(b"".join(lines)[:-3])
    assert len(read(tmp_path / "t").events) == 98


# Other tools


def test_vcd_is_read_by_another_parser(trace: RecordedTrace, tmp_path: Path) -> None:
    vcdvcd = pytest.importorskip("vcdvcd", reason="needs vcdvcd: pip install 'c2000-hil[test]'")
    export(trace, tmp_path / "t.vcd")
    found = vcdvcd.VCDVCD(str(tmp_path / "t.vcd"))
    assert float(found.timescale["timescale"]) == pytest.approx(1e-9)
    name = "GPIO69 sonars.start"
    changes: list[tuple[int, int]] = []
    for cycles, _, pin, level in trace.of("pins"):
        if pin == name and (not changes or changes[-1][1] != level):
            changes.append((cycles * 5, level))  # 200 MHz: 5 ns a cycle
    (signal,) = [signal for signal in found.signals if "GPIO69" in signal]
    assert [(time, int(level)) for time, level in found[signal].tv if level != "x"] == changes
    assert len(changes) > 1
    (task,) = [signal for signal in found.signals if signal.startswith("tasks.TaskUS")]
    assert {int(state, 2) for _, state in found[task].tv if "x" not in state} >= {0, 2}


def test_gtkwave_reads_what_was_written(trace: RecordedTrace, tmp_path: Path) -> None:
    """Through the reader and writer of GTKWave's own format: every signal, every change."""
    vcdvcd = pytest.importorskip("vcdvcd", reason="needs vcdvcd: pip install 'c2000-hil[test]'")
    if shutil.which("vcd2fst") is None:
        pytest.skip("needs vcd2fst and fst2vcd: apt install gtkwave")
    ours, fst, theirs = (tmp_path / name for name in ("t.vcd", "t.fst", "again.vcd"))
    export(trace, ours)
    subprocess.run(["vcd2fst", "-v", ours, "-f", fst], check=True, capture_output=True)
    subprocess.run(["fst2vcd", "-f", fst, "-o", theirs], check=True, capture_output=True)
    written, read_again = (vcdvcd.VCDVCD(str(path)) for path in (ours, theirs))
    assert set(read_again.signals) == set(written.signals)

    def changes(found: Any, name: str) -> list[tuple[int, float | str]]:
        """Of a signal, each change of its value; FST fills vectors up."""
        seen: list[tuple[int, float | str]] = []
        for time, digits in found[name].tv:
            value = "x" if set(digits) == {"x"} else float(digits)
            if not seen or seen[-1][1] != value:
                seen.append((time, value))
        return seen

    for name in written.signals:
        assert changes(read_again, name) == changes(written, name), name
    assert len(written.signals) > 50


def sigrok(vcd: Path, sampled_ns: int, *decode: str) -> list[str]:
    """What the decoders of PulseView make of the pins in a VCD."""
    if shutil.which("sigrok-cli") is None:
        pytest.skip("needs sigrok-cli: apt install sigrok-cli")
    done = subprocess.run(
        ["sigrok-cli", "-I", f"vcd:downsample={sampled_ns}", "-i", vcd, *decode],
        check=True,
        capture_output=True,
        text=True,
    )
    return [line.partition(": ")[2] for line in done.stdout.splitlines()]


def test_pulseview_decodes_the_bits_on_the_pins(trace: RecordedTrace, tmp_path: Path) -> None:
    vcd = tmp_path / "pins.vcd"
    export(trace.only(["pins"]), vcd)
    # L3G4200D: mode 3, chip select low.
    pins = "clk=GPIO60_gyro.CLK:mosi=GPIO58_gyro.SIMO:miso=GPIO59_gyro.SOMI:cs=GPIO61_gyro.CS:cpol=1:cpha=1"
    words = [value for _, _, _, value in trace.of("spi")]
    for line, kind in enumerate(("mosi-data", "miso-data")):
        decoded = sigrok(vcd, 100, "-P", f"spi:{pins}", "-A", f"spi={kind}")
        assert decoded == [f"{word[line] & 0xFF:02X}" for word in words]
    assert len(words) > 100
    sent = "".join(chr(value) for _, _, pin, value in trace.of("serial") if pin == "GPIO89")
    decoded = sigrok(vcd, 1000, "-P", "uart:rx=GPIO89_link.DIN:baudrate=9600:format=ascii", "-A", "uart=rx-data")
    assert "".join(decoded) == "".join(f"[{ord(c):02X}]" if c < " " else c for c in sent)
    assert "#ODO" in sent


def fields(content: bytes) -> Iterator[tuple[int, int | bytes]]:
    """The fields of a protobuf message: number and value (Protocol Buffers encoding)."""
    at = 0

    def varint() -> int:
        nonlocal at
        value = shift = 0
        while True:
            byte = content[at]
            at += 1
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    while at < len(content):
        key = varint()
        kind = key & 7
        assert kind in (0, 1, 2, 5)
        if kind == 0:
            yield key >> 3, varint()
            continue
        size = varint() if kind == 2 else {1: 8, 5: 4}[kind]
        assert at + size <= len(content)
        yield key >> 3, content[at : at + size]
        at += size


def test_perfetto_has_tasks_gates_and_findings(
    trace: RecordedTrace, recording: tuple[Path, Bench], tmp_path: Path
) -> None:
    """By the field numbers of Perfetto's published protocol, without its package."""
    pytest.importorskip("perfetto", reason="needs perfetto: pip install 'c2000-hil[trace]'")
    export(trace, tmp_path / "t.pftrace")
    tracks: dict[int, str] = {}
    depth: Counter[int] = Counter()
    instants: Counter[str] = Counter()
    lines: list[str] = []
    volts: list[float] = []
    latest = 0
    for number, packet in fields((tmp_path / "t.pftrace").read_bytes()):
        assert number == 1  # Trace.packet
        assert isinstance(packet, bytes)
        for field, value in (inside := dict(fields(packet))).items():
            if field == 60:  # TracePacket.track_descriptor
                assert isinstance(value, bytes)
                described = dict(fields(value))
                name = described.get(2, b"")  # uuid is 1, name 2
                assert isinstance(name, bytes)
                assert isinstance(described[1], int)
                tracks[described[1]] = name.decode()
            elif field == 11:  # TracePacket.track_event
                assert isinstance(value, bytes)
                event = dict(fields(value))
                time, track, kind = inside[8], event[11], event[9]
                assert isinstance(time, int)
                assert isinstance(track, int)
                assert time >= latest
                latest = time
                assert track in tracks
                depth[track] += {1: 1, 2: -1}.get(int(str(kind)), 0)  # SLICE_BEGIN, SLICE_END
                assert depth[track] >= 0
                if kind == 3:
                    instants[tracks[track]] += 1
                elif kind == 1 and tracks[track] == "orders and frames GPIO90":
                    lines.append(str(event[23], "ascii"))  # type: ignore[arg-type]  # TrackEvent.name
                elif kind == 4 and tracks[track] == "ADCINA3 sonars.FRONT":
                    volts += struct.unpack("<d", event[44])  # type: ignore[arg-type]  # double_counter_value
    assert {"TaskUS", "TaskGYRO", "TaskODO", "findings"} <= set(tracks.values())
    assert any(name.startswith("gate ") for name in tracks.values())
    assert not any(depth.values())
    assert instants["findings"] == len(recording[1].findings)
    assert lines == ["#MISN"]
    assert volts == [value for _, _, name, value in trace.of("adc") if name == "ADCINA3 sonars.FRONT"]
    assert latest <= trace.end * 5


def records(content: bytes) -> Iterator[tuple[int, bytes]]:
    """MCAP records, by the published specification: opcode, length in 8 bytes, content; chunks are opened."""
    import zstandard

    at = 0
    while at < len(content):
        code, size = struct.unpack_from("<BQ", content, at)
        body = content[at + 9 : at + 9 + size]
        assert len(body) == size
        at += 9 + size
        if code != 6:  # Chunk: start, end, size, CRC, name of the compression, records
            yield code, body
            continue
        name, after = prefixed(body, 8 + 8 + 8 + 4)
        assert name == b"zstd"
        packed = body[after + 8 :]
        assert len(packed) == struct.unpack_from("<Q", body, after)[0]
        yield from records(zstandard.ZstdDecompressor().decompress(packed))


def prefixed(body: bytes, at: int) -> tuple[bytes, int]:
    """Bytes with their length in 4 bytes before them, and where they end."""
    (size,) = struct.unpack_from("<I", body, at)
    return body[at + 4 : at + 4 + size], at + 4 + size


def test_mcap_has_poses_sensors_frames_and_findings(
    trace: RecordedTrace, recording: tuple[Path, Bench], tmp_path: Path
) -> None:  # fmt: skip
    """By the published specification, without its package; each message fits the schema that the file holds."""
    pytest.importorskip("mcap", reason="needs mcap: pip install 'c2000-hil[trace]'")
    from jsonschema import Draft202012Validator

    export(trace, tmp_path / "t.mcap")
    content = (tmp_path / "t.mcap").read_bytes()
    magic = b"\x89MCAP0\r\n"
    assert content.startswith(magic)
    assert content.endswith(magic)
    schemas: dict[int, tuple[str, Draft202012Validator]] = {}
    topics: dict[int, tuple[str, int]] = {}
    messages: dict[str, list[tuple[int, dict[str, object]]]] = {}
    for code, body in records(content[8:-8]):
        if code == 3:  # Schema: id, name, encoding, data
            name, at = prefixed(body, 2)
            encoding, at = prefixed(body, at)
            assert encoding == b"jsonschema"
            fields_of = json.loads(prefixed(body, at)[0])
            schemas[struct.unpack_from("<H", body)[0]] = name.decode(), Draft202012Validator(fields_of)
        elif code == 4:  # Channel: id, id of the schema, topic, encoding
            channel, schema = struct.unpack_from("<HH", body)
            topic, at = prefixed(body, 4)
            assert prefixed(body, at)[0] == b"json"
            topics[channel] = topic.decode(), schema
        elif code == 5:  # Message: id of the channel, number, two times, data
            channel, _, logged, published = struct.unpack_from("<HIQQ", body)
            topic_name, schema = topics[channel]
            message = json.loads(body[22:])
            schemas[schema][1].validate(message)
            assert logged == published == message["timestamp"]["sec"] * 10**9 + message["timestamp"]["nsec"]
            messages.setdefault(topic_name, []).append((logged, message))
    kinds = {topic: schemas[schema][0] for topic, schema in topics.values()}
    assert kinds["/pose/true"] == kinds["/pose/odometry"] == "foxglove.PoseInFrame"
    assert kinds["/findings"] == "foxglove.Log"

    truth = [(cycles * 5, value) for cycles, _, name, value in trace.of("pose") if name == "true"]
    assert len(messages["/pose/true"]) == len(truth) > 1
    for (logged, message), (time_ns, (x_m, y_m, heading_rad)) in zip(messages["/pose/true"], truth, strict=True):
        pose: dict[str, dict[str, float]] = message["pose"]  # type: ignore[assignment]
        assert (logged, pose["position"]["x"], pose["position"]["y"]) == (time_ns, x_m, y_m)
        turn = 2 * math.atan2(pose["orientation"]["z"], pose["orientation"]["w"])
        assert math.cos(turn - heading_rad) == pytest.approx(1)
    volts = [value for _, _, name, value in trace.of("adc") if name == "ADCINA3 sonars.FRONT"]
    assert [message["volts"] for _, message in messages["/sensors/ADCINA3_sonars_FRONT"]] == volts
    found = messages["/findings"]
    assert len(found) == len(recording[1].findings) > 0
    assert {message["line"] for _, message in found} == {f.place.line for f in recording[1].findings if f.place}
    assert "#MISN\r" in [message["text"] for _, message in messages["/frames/GPIO90"]]


def test_mcap_is_whole_for_its_own_reader(trace: RecordedTrace, tmp_path: Path) -> None:
    """The reference reader, with all checksums, finds by its index what is there one after the other."""
    reader = pytest.importorskip("mcap.reader", reason="needs mcap: pip install 'c2000-hil[trace]'")
    export(trace, tmp_path / "t.mcap")
    with open(tmp_path / "t.mcap", "rb") as file:
        by_index = [m.log_time for _, _, m in reader.SeekingReader(file, validate_crcs=True).iter_messages()]
    with open(tmp_path / "t.mcap", "rb") as file:
        streamed = [m.log_time for _, _, m in reader.NonSeekingReader(file, validate_crcs=True).iter_messages()]
    assert by_index == streamed == sorted(by_index)
    assert len(by_index) > sum(1 for _ in trace.of("pose", "adc", "spi", "findings"))


def test_parquet_is_read_by_another_engine(trace: RecordedTrace, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow", reason="needs pyarrow: pip install 'c2000-hil[trace]'")
    duckdb = pytest.importorskip("duckdb", reason="needs duckdb: pip install 'c2000-hil[test]'")
    export(trace, tmp_path / "t.parquet")
    database = duckdb.connect(config={"autoinstall_known_extensions": "false"})

    def asked(rest: str) -> list[tuple[object, ...]]:
        rows: list[tuple[object, ...]] = database.execute(f"SELECT {rest}", [str(tmp_path / "t.parquet")]).fetchall()
        return rows

    # One row an event; a word of SPI is two, a pose three.
    counts = Counter(channel for _, channel, _, _ in trace.events)
    wanted = {channel: count * {"spi": 2, "pose": 3}.get(channel, 1) for channel, count in counts.items()}
    assert dict(asked("channel, count(*) FROM read_parquet(?) GROUP BY channel")) == wanted  # type: ignore[arg-type]
    volts = [(cycles * 5, value) for cycles, _, name, value in trace.of("adc") if name == "ADCINA3 sonars.FRONT"]
    assert asked("time_ns, number FROM read_parquet(?) WHERE name = 'ADCINA3 sonars.FRONT'") == volts
    ways = [value[0] for _, _, name, value in trace.of("pose") if name == "true"]
    assert [x for (x,) in asked("number FROM read_parquet(?) WHERE name = 'true.x_m'")] == ways
    switches = [name for _, _, kind, name in trace.of("kernel") if kind == "switch"]
    assert [text for (text,) in asked("text FROM read_parquet(?) WHERE name = 'switch' AND number IS NULL")] == switches


def test_tables_hold_every_event(trace: RecordedTrace, tmp_path: Path) -> None:
    export(trace, tmp_path / "t.csv")
    with open(tmp_path / "t.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(trace.events)
    for row, (cycles, channel, name, _) in zip(rows, trace.events, strict=True):
        assert (round(float(row["time_s"]) * 200e6), row["channel"], row["name"]) == (cycles, channel, name)
    export(trace, tmp_path / "t.npz")
    arrays = np.load(tmp_path / "t.npz")
    volts = [value for _, channel, name, value in trace.events if (channel, name) == ("adc", "ADCINA3 sonars.FRONT")]
    assert list(arrays["adc/ADCINA3 sonars.FRONT/value"]) == volts
    assert arrays["pose/true/value"].shape[1] == 3
    export(trace, tmp_path / "t.txt")
    text = (tmp_path / "t.txt").read_text(encoding="utf-8")
    assert "GPIO90: b'#MISN\\r'" in text
    told = [float(line.split(" s ")[0]) for line in text.splitlines()]
    assert told == sorted(told)


def test_an_empty_trace_is_written_too(tmp_path: Path) -> None:
    for suffix, package in ((".mcap", "mcap"), (".parquet", "pyarrow"), (".csv", "csv"), (".txt", "csv")):
        pytest.importorskip(package)
        export(RecordedTrace(("pose",), []), tmp_path / f"t{suffix}")
        assert (tmp_path / f"t{suffix}").exists()


@given(st.lists(st.tuples(st.sampled_from(["GPIO89", "GPIO90"]), st.integers(0, 255))))
def test_lines_lose_no_byte(sent: list[tuple[str, int]]) -> None:
    trace = RecordedTrace(("serial",), [(at, "serial", pin, byte) for at, (pin, byte) in enumerate(sent)])
    lines = list(serial_lines(trace))
    for pin in ("GPIO89", "GPIO90"):
        content = [line.content for line in lines if line.pin == pin]
        assert b"".join(content) == bytes(byte for name, byte in sent if name == pin)
        assert all(b"\r" not in line[:-1] and 0 < len(line) <= 80 for line in content)
    for line in lines:
        assert sent[line.begin] == (line.pin, line.content[0])
        assert sent[line.end] == (line.pin, line.content[-1])


# What can go wrong


@given(st.binary(max_size=300))
def test_any_bytes_are_a_trace_or_one_line(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    path = tmp_path_factory.mktemp("t") / "t.trace"
    header = json.dumps({"hil_trace": 1, "channels": ["pins"]}).encode() + b"\n"
    for whole in (content, header + content):
        path.write_bytes(whole)
        said = None
        try:
            read(path)
        except ValueError as error:
            said = str(error)
        assert said is None or said.startswith(f"{path}:")


@pytest.mark.parametrize("line", [
    "[1]", '[-1, "pins", "a", 1]', '[1, "pins", "a", 2.5]', '[1, "no", "a", 1]', "{}", "x",
])  # fmt: skip
def test_an_event_that_is_none_is_told_with_its_line(line: str, tmp_path: Path) -> None:
    path = tmp_path / "t"
    path.write_text(f'{{"hil_trace": 1, "channels": ["pins"]}}\n[1, "pins", "a", 1]\n{line}\n', encoding="utf-8")
    with pytest.raises(ValueError, match=r"t:3: "):
        read(path)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="wants a device that is full")
@pytest.mark.parametrize("log", ["--trace", "--wire"])
def test_a_full_disk_ends_the_log_and_not_the_run(log: str, capsys: pytest.CaptureFixture[str]) -> None:
    run = ["run", "--no-port", "--pace", "max", "--for", "0.1", "--order", "stop"]
    assert invoke([*run, "--json"]) == 0
    whole = json.loads(capsys.readouterr().out)
    assert invoke([*run, "--json", log, "/dev/full"]) == 2
    out, error = capsys.readouterr()
    summary = json.loads(out)
    assert summary["incomplete"] == ["/dev/full: No space left on device"]
    assert error == "hil: error: /dev/full: No space left on device\n"
    for name in ("virtual_s", "uart_sha256", "trace_sha256"):
        assert summary[name] == whole[name]
    assert invoke([*run, log, "/dev/full"]) == 2
    assert "incomplete: /dev/full: No space left on device\n" in capsys.readouterr().out


def test_the_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    trace = tmp_path / "t.trace"
    assert invoke(["run", "--no-port", "--pace", "max", "--for", "0.1", "--trace", str(trace), "--json"]) == 0
    capsys.readouterr()
    for suffix in FORMATS:
        target = tmp_path / f"t{suffix}"
        assert invoke(["export", str(trace), str(target)]) == 0
        assert target.stat().st_size > 0
    capsys.readouterr()
    assert invoke(["export", "--channels", "--json"]) == 0
    assert set(json.loads(capsys.readouterr().out)["channels"]) == set(CHANNELS)


@pytest.mark.parametrize("arguments", [
    ["export"], ["export", "none.trace", "t.vcd"], ["export", __file__, "t.vcd"],
    ["run", "--no-port", "--channel", "pins"], ["run", "--no-port", "--trace", "t", "--channel", "pin"],
    ["run", "--no-port", "--trace", "none/t"],
])  # fmt: skip
def test_what_a_user_can_get_wrong_is_one_line(
    arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert invoke(arguments) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_another_suffix_is_one_line(trace: RecordedTrace, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"no format for \.xyz: expected \.vcd"):
        export(trace, tmp_path / "t.xyz")
