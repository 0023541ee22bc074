"""The page of the options tells the truth: its drivers are run on its parts, its commands give what stands there."""

from __future__ import annotations

import pytest

from tests import pages
from tests.hil.robot.options.page import SECTIONS


@pytest.mark.parametrize("title", SECTIONS)
def test_section(
    title: str, pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:  # fmt: skip
    pages.run(SECTIONS[title], pytester, monkeypatch, capsys)
