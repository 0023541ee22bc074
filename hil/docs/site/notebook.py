"""A notebook with what its cells give."""

from __future__ import annotations

import os
from importlib.resources import files
from pathlib import Path

#: Seconds that a cell may take on a slow machine.
TIMEOUT_S = 300


def executed(text: str) -> str:
    """The notebook, run from top to bottom in a kernel of this Python.  Raises ValueError with the cell that fails."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError

    notebook = nbformat.reads(text, as_version=4)  # type: ignore[no-untyped-call]
    # Where the sources are: places of findings are shown from there.
    root = str(Path(str(files("hil"))).parent)
    client = NotebookClient(
        notebook, timeout=TIMEOUT_S, extra_arguments=["--log-level=ERROR"], resources={"metadata": {"path": root}}
    )
    search = os.pathsep.join([root, os.environ.get("PYTHONPATH", "")])
    try:
        client.execute(env={**os.environ, "PYTHONPATH": search})
    except CellExecutionError as error:
        raise ValueError(f"the notebook: {error}") from None
    made: str = nbformat.writes(notebook)  # type: ignore[no-untyped-call]
    return made
