"""A run as one HTML file: data, script and style in it, nothing loaded from elsewhere.

The data are JSON, deflated and in base64, which each browser since 2023 opens by itself (`DecompressionStream`).  A
minute of a mission is 3.5 MB of JSON and stays below 0.1 MB so: tasks do the same again and again.
"""

from __future__ import annotations

import base64
import hashlib
import json
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from hil.files import replacing
from hil.instruments.recorder import Recorder, about_of
from hil.instruments.trace_file import DEFAULT, RecordedTrace
from hil.page.replay import Replay
from hil.reports.policy import Policy
from hil.robot.view.arena_drawing import LEGEND
from hil.running import RunningBoard
from hil.view.rated_finding import KINDS
from hil.view.style import ARENA, DARK, LIGHT, WORDS

#: How the gestures of the view's arena begin, which is a component there and an object here.
_COMPONENT: Final = "export default {"


@contextmanager
def paged(
    path: str | Path, machine: RunningBoard, channels: tuple[str, ...] = DEFAULT, about: Mapping[str, str] | None = None
) -> Iterator[None]:
    """Write a page of what a board does while this lasts; `about` says what ran.

    The project of the current folder weighs the findings.  Raises ValueError if its policy is wrong, OSError at the end
    if the page cannot be written.
    """
    replay = Replay(about_of(machine, about or {}), Policy.load(Path.cwd()))
    recorder = Recorder(machine, replay, channels)
    try:
        yield
    finally:
        recorder.close()
        content = html(replay.data())
        with replacing(path) as new:
            _write(new, content)


def write_page(path: str | Path, trace: RecordedTrace) -> None:
    """Write a page of a trace to `path`: the same that `paged` writes.  Raises ValueError for a wrong policy."""
    replay = Replay(trace.about, Policy.load(Path.cwd()))
    for event in trace.events:
        replay.event(*event)
    _write(path, html(replay.data()))


def _write(path: str | Path, content: str) -> None:
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(content)


def html(data: Mapping[str, Any]) -> str:
    """What `Replay.data` gives, as the text of the page."""
    environment = Environment(
        loader=PackageLoader("hil.page", "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    script = _script()
    packed = zlib.compress(json.dumps(data, separators=(",", ":"), allow_nan=False).encode(), 9)
    return environment.get_template("page.html.j2").render(
        title=title(data["about"]),
        about=data["about"],
        light=Markup(LIGHT), dark=Markup(DARK), shared=Markup(WORDS + ARENA), legend=LEGEND,
        kinds=KINDS,
        # The browser runs this script and no other, whatever the run wrote into its names.
        digest=base64.b64encode(hashlib.sha256(script.encode()).digest()).decode(),
        script=Markup(script),
        run=Markup(base64.b64encode(packed).decode()),
    )  # fmt: skip


def title(about: Mapping[str, str]) -> str:
    """What a reader calls the run."""
    return about.get("title") or "A run"


def _script() -> str:
    """The page's script, with the gestures of the view's arena before it."""
    gestures = files("hil.robot.view").joinpath("layers.js").read_text(encoding="utf-8")
    own = files("hil.page").joinpath("page.js").read_text(encoding="utf-8")
    return f"\n{gestures.replace(_COMPONENT, 'const arenaWindow = {')}\n{own}"
