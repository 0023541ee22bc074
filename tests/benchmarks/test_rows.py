"""The rows' arithmetic, on rounds made by hand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from hil.instruments.trace_file import CHANNELS
from tests.benchmarks import worker
from tests.benchmarks.rows import ROWS, Row, ratios, table, values

#: CPU seconds in two rounds; the second ran on a machine half as fast.
NOW = [{"checked": 0.05, "watched": 0.10, "traced": 0.055}, {"checked": 0.10, "watched": 0.20, "traced": 0.11}]
BEFORE = [{"checked": 0.05, "watched": 0.25}, {"checked": 0.10, "watched": 0.50}]


def test_a_ratio_is_taken_within_a_round() -> None:
    # 0.10 / 0.05 and 0.20 / 0.10.
    assert values(Row("", "watched", "checked"), NOW) == pytest.approx([2.0, 2.0])


def test_a_rate_is_the_reciprocal_of_a_time() -> None:
    assert values(Row("", "checked", rate=True), NOW) == pytest.approx([20.0, 10.0])


def test_more_than_without_is_the_ratio_less_one() -> None:
    # 0.055 / 0.05 = 1.1
    assert values(Row("", "traced", "checked", less=1.0), NOW) == pytest.approx([0.1, 0.1])


def test_now_is_compared_with_before_round_by_round() -> None:
    # Ratios 2 and 2 now, 5 and 5 before.
    assert ratios(Row("", "watched", "checked"), NOW, BEFORE) == pytest.approx([0.4, 0.4])


def test_what_a_checkout_does_not_have_is_left_out() -> None:
    assert values(Row("", "link C first", "link first"), NOW) == []
    assert ratios(Row("", "traced"), NOW, BEFORE) == []
    text = table(NOW, BEFORE)
    assert "link C" not in text
    assert re.search(r"^trace digest.* 0\.100 \(0\.100 - 0\.100\) +- +-  below 0\.1$", text, re.MULTILINE)


def test_each_channel_of_a_trace_has_its_row() -> None:
    channels = {row.value.removeprefix("trace ") for row in ROWS if row.base == "trace none"}
    assert channels == set(CHANNELS)
    assert set(worker.trace(1)) == {f"trace {name}" for name in ("none", *channels)}


def test_the_robot_is_linked_from_the_c_files_of_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pycparser")
    monkeypatch.delenv(worker.FIRMWARE, raising=False)
    assert worker.link_c(0) == {}, "no folder, no row"
    (tmp_path / "Odometry.c").write_text(
        '#include "Odometry.h"\n'
        "void Odom_Trayect(ODOMETRY_Trayect *at, float V, float W, float df, float dr, float dl, float T)\n"
        "{\n    at->tita = V;\n}\n",
        encoding="utf-8",
    )
    monkeypatch.setenv(worker.FIRMWARE, str(tmp_path))
    assert worker.link_c(0)["link C"] > 0
