"""A compiled file that was cut off when it was written: the command says which one, and goes on without it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from hil.bytecode import incomplete_file
from tests.hil.waiting import TIMEOUT_S


def record(caches: Path) -> subprocess.CompletedProcess[str]:
    """The line of a command that imports `hil.cli`, itself and, late, a file of pyserial."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return subprocess.run(
        [sys.executable, "-m", "hil", "record", "loop://", "-o", "new.wire", "--for", "0.01", "--to", "missing"],
        env=environment | {"PYTHONPYCACHEPREFIX": str(caches)}, cwd=caches.parent, stdin=subprocess.DEVNULL,
        capture_output=True, text=True, timeout=TIMEOUT_S,
    )  # fmt: skip


@pytest.mark.parametrize("module", ["hil/cli/__init__", "hil/cli/record", "serial/urlhandler/protocol_loop"])
def test_a_line_names_the_file_that_was_cut_off(tmp_path: Path, module: str) -> None:
    caches = tmp_path / "caches"
    whole = record(caches)
    (path,) = caches.rglob(f"{module}.*.pyc")
    os.truncate(path, path.stat().st_size // 2)
    damaged = record(caches)
    assert damaged.returncode == 2
    (line,) = damaged.stderr.splitlines()
    assert line.startswith("hil: error: ")
    assert path.name in line
    assert line.endswith(": delete it, it is made again")
    path.unlink()
    again = record(caches)
    assert (again.returncode, again.stderr) == (whole.returncode, whole.stderr)
    assert "missing" in again.stderr


def test_the_end_of_another_file_is_not_taken_for_it() -> None:
    with pytest.raises(EOFError) as ended:
        raise EOFError("no more input")
    assert incomplete_file(ended.value) == ""
