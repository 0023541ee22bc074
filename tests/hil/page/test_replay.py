"""What a page knows of a run: compared with the run, the trace and the plots, not with itself."""

from __future__ import annotations

import base64
import itertools
import json
import re
import zlib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.rules import RULES, Severity
from hil.bench import Bench
from hil.client.decode import OdometryFrame
from hil.client.plot import place, sonar_points
from hil.instruments.timeline import TaskState, spans
from hil.instruments.trace_file import RecordedTrace, TraceWriter, read
from hil.page import replay as module
from hil.page.page import html
from hil.page.replay import Replay, differences
from hil.reports.policy import Policy


def data_of(page: str) -> dict[str, Any]:
    """What the page holds, opened as the browser does."""
    packed = re.search(r'<script type="application/octet-stream" id="run">([^<]*)</script>', page)
    assert packed is not None
    found: dict[str, Any] = json.loads(zlib.decompress(base64.b64decode(packed[1])))
    return found


def replayed(trace: RecordedTrace) -> dict[str, Any]:
    replay = Replay(trace.about)
    for event in trace.events:
        replay.event(*event)
    return replay.data()


@pytest.fixture(scope="module")
def data(drive: tuple[Path, Path, Bench]) -> dict[str, Any]:
    return data_of(drive[1].read_text(encoding="utf-8"))


@given(st.lists(st.integers(-(2**53), 2**53)))
def test_differences_add_up_to_the_values(values: list[int]) -> None:
    assert list(itertools.accumulate(differences(values))) == values


def test_a_trace_makes_the_page_that_the_run_made(
    drive: tuple[Path, Path, Bench], trace: RecordedTrace, tmp_path: Path
) -> None:  # fmt: skip
    from hil.instruments.export import export

    export(trace, tmp_path / "again.html")
    assert (tmp_path / "again.html").read_bytes() == drive[1].read_bytes()


def test_a_run_with_a_page_is_the_same_run(drive: tuple[Path, Path, Bench]) -> None:
    plain = Bench("corridor", seed=3)
    plain.world.add_obstacle("post", 1.6, 0.9, 0.1)
    plain.boot()
    plain.feed("#MISN\r")
    plain.run_for(2.0)
    assert (plain.uart_sha256, plain.trace_sha256) == (drive[2].uart_sha256, drive[2].trace_sha256)


def test_the_robot_is_where_it_was(data: dict[str, Any], drive: tuple[Path, Path, Bench]) -> None:
    robot = data["scene"]["robot"]
    x, y, heading = (sum(robot[name]) / data["units"] for name in "xyh")
    pose = drive[2].world.pose
    # The last look is 50 ms old at most: 2 cm at the 0.4 m/s that the motors can do.
    assert x == pytest.approx(pose.x_m, abs=0.02)
    assert y == pytest.approx(pose.y_m, abs=0.02)
    assert heading == pytest.approx(pose.heading_rad, abs=0.05)
    assert x > 0.5
    assert data["scene"]["posts"] == [[0, [["post", 1.6, 0.9, 0.05]]]]
    assert len(data["scene"]["walls"]) == len(drive[2].walls)


def test_the_cloud_is_that_of_the_frames(data: dict[str, Any], drive: tuple[Path, Path, Bench]) -> None:
    bench = drive[2]
    points = [
        point
        for row in bench.frames()
        for point in place(sonar_points(OdometryFrame(*row[1:])), *bench.map.start)
    ]  # fmt: skip
    cloud = data["scene"]["cloud"]
    columns = ([value / data["units"] for value in itertools.accumulate(cloud[name])] for name in "xy")
    drawn = list(zip(*columns, strict=True))
    assert len(drawn) == len(points) > 10
    for (x, y), point in zip(drawn, points, strict=True):
        assert (x, y) == pytest.approx(point, abs=1e-4)


def test_lanes_have_every_stretch_of_every_task(data: dict[str, Any], trace: RecordedTrace) -> None:
    found = spans([(c, name, value) for c, _, name, value in trace.of("kernel")], {}, trace.end)
    assert {lane["name"] for lane in data["lanes"]} == {span.lane for span in found}
    for lane in data["lanes"]:
        edges = list(itertools.accumulate(lane["running"]))
        wanted = [(s.begin, s.end) for s in found if s.lane == lane["name"] and s.state is TaskState.RUNNING]
        assert list(itertools.batched(edges, 2) if hasattr(itertools, "batched") else zip(*[iter(edges)] * 2)) == wanted  # noqa: B905
    assert [lane["name"] for lane in data["lanes"]][-1] == "Idle"
    assert data["lanes"][0]["name"].startswith("Hwi ")


def test_findings_come_worst_first_and_bring_their_source(data: dict[str, Any], trace: RecordedTrace) -> None:
    found = data["findings"]
    assert len(found) == sum(1 for _ in trace.of("findings"))
    ranks = [RULES[each["rule"]].severity.rank for each in found]
    assert ranks == sorted(ranks, reverse=True)
    for one, other in itertools.pairwise(found):
        assert one["severity"] != other["severity"] or one["t"] <= other["t"]
    (index,) = (each for each in found if each["rule"] == "index" and each["object"].endswith(".v"))
    line = index["source"]["lines"][index["source"]["marked"] - index["source"]["first"]]
    file, number = re.search(r"\(([^():]+):(\d+)", index["where"]).groups()  # type: ignore[union-attr]
    assert line == Path(__file__).parents[3].joinpath(file).read_text(encoding="utf-8").splitlines()[int(number) - 1]
    assert set(data["rules"]) == {each["rule"] for each in found}


def test_the_project_weighs_the_findings(trace: RecordedTrace) -> None:
    replay = Replay(trace.about, Policy(severities={"index": Severity.NOTE, "uninitialised": None}))
    for event in trace.of("findings"):
        replay.event(*event)
    told = replay.data()
    assert {each["severity"] for each in told["findings"] if each["rule"] == "index"} == {"note"}
    assert "uninitialised" not in {each["rule"] for each in told["findings"]} | told["rules"].keys()


def test_orders_and_frames_are_told_apart(data: dict[str, Any], drive: tuple[Path, Path, Bench]) -> None:
    lines = data["lines"]
    by_way = {"received": [], "sent": []}  # type: ignore[var-annotated]
    for pin, text in zip(lines["pin"], lines["text"], strict=True):
        by_way["received" if lines["received"][pin] else "sent"].append(text)
    assert by_way["received"] == ["#MISN"]
    row = drive[2].frames()[-1]
    assert OdometryFrame(*row[1:]).encode().strip().decode() in by_way["sent"]


def test_a_minute_of_a_mission_stays_small(drive: tuple[Path, Path, Bench]) -> None:
    # Two of its seconds with start-up; 60 of them may grow the rest by thirty at most.
    assert drive[1].stat().st_size < 2_000_000 / 15


def test_a_board_without_wheels_has_faces_and_no_scene(tmp_path: Path) -> None:
    pytest.importorskip("pycparser", reason="needs the extra c: pip install 'c2000-hil[c]'")
    from hil.cli import invoke
    from tests.hil.own_board import project

    project.write(tmp_path)
    page = tmp_path / "station.html"
    assert invoke([
        "run", "--board", str(tmp_path / "station_board.py"), "--firmware", str(tmp_path / "firmware"), "--no-port",
        "--pace", "max", "--for", "0.3", "--put", "infrared.distance_m=0.4", "--put", "0.1:infrared.distance_m=0.9",
        "--page", str(page),
    ]) == 0  # fmt: skip
    found = data_of(page.read_text(encoding="utf-8"))
    assert found["scene"] is None
    (distance,) = (each for each in found["signals"] if each["name"] == "infrared.distance_m")
    assert distance["v"] == [0.4, 0.9]
    assert sum(distance["t"]) == 20_000_000  # 0.1 s
    assert found["end"] >= 60_000_000  # the whole 0.3 s


def test_what_the_source_accepts_has_its_reason_and_is_as_severe_as_ever(tmp_path: Path) -> None:
    pytest.importorskip("pycparser", reason="needs the extra c: pip install 'c2000-hil[c]'")
    from hil.cli import invoke
    from tests.hil.own_board import project

    project.write(tmp_path)
    main = tmp_path / "firmware" / "main.c"
    write = "CpuSysRegs.PCLKCR8.bit.SPI_C = 1;"
    allowed = f"{write} // hil: allow eallow, <b>the boot ROM</b> left it open\n"
    text = main.read_text(encoding="utf-8")
    main.write_text(text.replace("Init_Station();", f"{allowed}{write}\nInit_Station();"), encoding="utf-8")
    trace, page = tmp_path / "run.trace", tmp_path / "run.html"
    assert invoke([
        "run", "--board", str(tmp_path / "station_board.py"), "--firmware", str(tmp_path / "firmware"), "--no-port",
        "--pace", "max", "--for", "0.01", "--trace", str(trace), "--page", str(page),
    ]) == 0  # fmt: skip
    found = data_of(page.read_text(encoding="utf-8"))["findings"]
    assert [(each["rule"], each["severity"], each["accepted"]) for each in found] == [
        ("eallow", "error", "<b>the boot ROM</b> left it open"), ("eallow", "error", ""),
    ]  # fmt: skip
    # A trace has the reason as it was when the program ran.
    main.unlink()
    assert replayed(read(trace))["findings"] == found


# What is too much, and what is hostile


def test_what_is_more_than_a_page_holds_is_said(trace: RecordedTrace, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MAX_SPANS", 100)
    monkeypatch.setattr(module, "MAX_LINES", 2)
    monkeypatch.setattr(module, "MAX_SAMPLES", 1)
    found = replayed(trace)
    assert {what for what, _ in found["full"]} >= {"what tasks do", "lines of the serial pins"}
    assert len(found["lines"]["text"]) == 2
    assert sum(len(lane.get("running", ())) // 2 for lane in found["lanes"]) <= 101


NAMES = ("</script><script>alert(1)</script>", '"><img src=x onerror=alert(1)>', "{{ 7 * 7 }}", "\N{LINE SEPARATOR}'\\")


@pytest.mark.parametrize("name", NAMES)
def test_names_from_outside_are_words_and_nothing_else(name: str) -> None:
    replay = Replay({"title": name, name: name})
    replay.event(1, "kernel", "switch", name)
    replay.event(2, "findings", name, {
        "message": name, "object": name, "place": name, "task": name, "details": [name], "called_from": [name],
        "source": {"first": 1, "marked": 1, "lines": [name]},
    })  # fmt: skip
    replay.event(3, "faces", name, 1.0)
    replay.event(4, "scene", "posts", [[name, 0.0, 0.0, 0.1]])
    replay.event(4, "scene", "robot", [0.0, 0.0, 0.0])
    replay.event(4, "scene", "state", name)
    page = html(replay.data())
    assert page.count("<script") == 2
    assert "<img" not in page
    assert "49" not in page.partition("<style>")[0]
    assert data_of(page)["findings"][0]["message"] == name


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("walls", [[1, 2, 3]]), ("walls", 7), ("posts", [["post", 1.0, 2.0, "3"]]), ("robot", [1.0, 2.0]),
        ("robot", [1.0, 2.0, float("nan")]), ("sonar FRONT", [1.0, 2.0]), ("mount FRONT", None), ("state", 3),
        ("nothing", 1), ("bumper", 2),
    ],
)  # fmt: skip
def test_a_scene_that_is_none_is_refused_with_its_line(tmp_path: Path, name: str, value: Any) -> None:
    path = tmp_path / "t.trace"
    with path.open("w", encoding="utf-8") as file:
        TraceWriter(file, ["scene"]).event(1, "scene", name, value)
    with pytest.raises(ValueError, match=r"t\.trace:2: expected"):
        read(path)


@pytest.mark.parametrize("about", ["7", '{"seed": 1}'])
def test_a_head_that_is_none_is_refused(tmp_path: Path, about: str) -> None:
    path = tmp_path / "t.trace"
    path.write_text(f'{{"hil_trace": 1, "cycles_per_second": 200000000, "channels": [], "about": {about}}}\n')
    with pytest.raises(ValueError, match=r"t\.trace:1: about"):
        read(path)


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)
_SCENES = ("walls", "posts", "start", "robot", "believed", "state", "bumper", "happened", "mount FRONT", "sonar FRONT")


@given(st.lists(st.tuples(
    st.sampled_from(["kernel", "serial", "findings", "pose", "scene", "faces", "adc", "pins", "spi"]),
    st.sampled_from([*_SCENES, "true", "switch", "hwi", "hwi end", "GPIO1"]),
    json_values | st.lists(st.floats(allow_nan=False, allow_infinity=False, width=32), min_size=3, max_size=3)
    | st.fixed_dictionaries({"message": st.text(), "place": st.text(), "task": st.text(), "source": json_values}),
), max_size=12))  # fmt: skip
def test_whatever_a_trace_holds_is_refused_or_becomes_a_page(
    tmp_path_factory: pytest.TempPathFactory, events: list[tuple[str, str, Any]]
) -> None:  # fmt: skip
    path = tmp_path_factory.getbasetemp() / "any.trace"
    with path.open("w", encoding="utf-8") as file:
        writer = TraceWriter(file, ["kernel"])
        for cycles, (channel, name, value) in enumerate(events):
            writer.event(cycles, channel, name, value)
    try:
        trace = read(path)
    except ValueError:
        return
    data_of(html(replayed(trace)))
