"""A drive as a moving picture, and one that has no time for all of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil.bench import Bench
from hil.robot import moving_picture

Image = pytest.importorskip("PIL.Image")


def test_hurried_it_has_few_pictures_and_says_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moving_picture, "FEW", 2)
    bench = Bench("corridor", seed=1)
    bench.boot()
    bench.feed("#MISN\r")
    bench.run_for(3.0)
    path = bench.true_path()

    def pictures(*, hurried: bool) -> tuple[bool, int]:
        file = tmp_path / "drive.gif"
        whole = moving_picture.save_moving(file, bench, [], "drive", hurried=hurried)
        with Image.open(file) as drawn:
            return whole, drawn.n_frames

    # Ten pictures a second, at eight times the robot's pace.
    whole, count = pictures(hurried=False)
    assert whole
    assert count == round(10 * (path[-1].time_s - path[0].time_s) / 8) > 2
    assert pictures(hurried=True) == (False, 2)
    bench.close()
