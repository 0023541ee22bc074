"""Runs to look at: pages of `hil run --page`, made while the site is."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Final

#: File -> what one sees there, and the run.
RUNS: Final[Mapping[str, tuple[str, tuple[str, ...]]]] = MappingProxyType({
    "mission": (
        "A mission in the corridor, with what the detectors find in the robot's firmware.",
        ("--for", "40", "--order", "mission"),
    ),
    "speed": (
        "A decimal point that slipped: the robot is ordered 9.9 m/s, believes it, and meets a wall.",
        ("--for", "5", "--world", "room", "--order", "0.5:tele", "--order", "0.6:#SETR9.9,0"),
    ),
})


def page() -> str:
    """The page that shows them."""
    parts = [
        "# Runs to look at\n\nEach plays again in your browser, which asks nothing of a network: arena, findings with\n"
        "their source, orders, frames, tasks. Space plays, arrow keys step, `n` and `p` go from finding to finding.\n"
    ]
    for name, (about, options) in RUNS.items():
        command = f"hil run {' '.join(_quoted(_arguments(name, options)))}"
        parts.append(
            f"\n## {name.capitalize()}\n\n{about} <a href=\"{name}.html\">Open it in the whole window.</a>\n\n"
            f'<iframe class="replay" src="{name}.html" title="{name}" loading="lazy"></iframe>\n\n'
            f"```sh\n{command}\n```\n"
        )
    return "".join(parts)


@contextmanager
def made(folder: Path) -> Iterator[None]:
    """The runs begin, each in a process of its own; when the block ends they are in the folder.

    Raises ValueError if one has failed.
    """
    folder.mkdir(parents=True)
    search = os.pathsep.join([str(Path(str(files("hil"))).parent), os.environ.get("PYTHONPATH", "")])
    running = {
        name: subprocess.Popen(
            [sys.executable, "-m", "hil", "run", *_arguments(name, options)], cwd=folder, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True, env={**os.environ, "PYTHONPATH": search},
        )
        for name, (_, options) in RUNS.items()
    }  # fmt: skip
    try:
        yield
        for name, process in running.items():
            _, said = process.communicate()
            if process.returncode:
                raise ValueError(f"the run {name}: {said.strip()}")
    finally:
        for process in running.values():
            process.kill()
            process.wait()


def _arguments(name: str, options: tuple[str, ...]) -> list[str]:
    return ["--no-port", "--pace", "max", *options, "--page", f"{name}.html"]


def _quoted(words: list[str]) -> list[str]:
    return [f'"{word}"' if "#" in word else word for word in words]
