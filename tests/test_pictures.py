"""Pictures of the pages are what their commands draw."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from PIL import Image

from tests.hil.view.conftest import CHROMIUM
from tests.pictures import Picture, pictures, shown


def test_every_picture_says_its_command() -> None:
    assert shown() == {picture.file for picture in pictures()}
    for picture in pictures():
        assert picture.command.startswith(("hil ", "tests."))
        assert picture.file.name in picture.command
        assert picture.file.stat().st_size < 300_000


def needs_browser() -> None:
    pytest.importorskip("playwright", reason="needs the extra view-test (playwright)")
    if not Path(CHROMIUM).is_file():
        pytest.skip(f"needs Debian's package chromium ({CHROMIUM} is not there)")


def assert_moves(made: Path, kept: Path) -> None:
    """Picture by picture the same, and each another than the one before."""
    with Image.open(made) as new, Image.open(kept) as old:
        assert (new.size, new.n_frames) == (old.size, old.n_frames), "python -m tests.pictures --write"  # type: ignore[attr-defined]
        before = None
        for number in range(new.n_frames):  # type: ignore[attr-defined]
            new.seek(number)
            old.seek(number)
            shown, known = (np.asarray(picture.convert("RGB"), dtype=int) for picture in (new, old))
            assert (np.abs(shown - known).max(axis=2) > 64).mean() < 0.002, "python -m tests.pictures --write"
            assert before is None or (shown != before).any()
            before = shown


@pytest.mark.slow
@pytest.mark.parametrize("picture", pictures(), ids=lambda picture: picture.file.name)
def test_it_is_what_the_command_draws(picture: Picture, tmp_path: Path) -> None:
    in_browser = picture.command.startswith(("tests.hil.view.", "tests.hil.page.", "tests.hil.docs."))
    if in_browser:
        needs_browser()
    made = picture.make(tmp_path)
    if folder := os.environ.get("HIL_SCREENSHOTS"):
        os.makedirs(folder, exist_ok=True)
        shutil.copy(made, folder)
    if picture.file.suffix == ".gif":
        assert_moves(made, picture.file)
        return
    new, kept = imread(made), imread(picture.file)
    assert new.shape == kept.shape, "python -m tests.pictures --write"
    assert new.std() > 0.02, "a blank page"
    # Another release of matplotlib may set a letter a pixel further; another curve changes thousands of pixels.
    # A browser's letters differ more, and with them where lines are broken.
    other = np.abs(new - kept).max(axis=2) > 0.25
    assert other.mean() < (0.05 if in_browser else 0.002), "python -m tests.pictures --write"
