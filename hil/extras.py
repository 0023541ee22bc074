"""Packages that the core does without: what needs each, and the extra that brings it.

`hil` says so in one line wherever one of them is missing, and so does what is called from Python.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from types import MappingProxyType
from typing import Final

#: Name in an `import` -> what needs it, and the extra of pyproject.toml.
EXTRAS: Final[Mapping[str, tuple[str, str]]] = MappingProxyType({
    "matplotlib": ("pictures need Matplotlib", "plot"),
    "numpy": ("tables of measurements need NumPy", "plot"),
    "textual": ("the console in the terminal needs Textual", "terminal"),
    "nicegui": ("the view needs NiceGUI", "view"),
    "vcd": ("VCD needs pyvcd", "trace"),
    "perfetto": ("Perfetto's format needs perfetto", "trace"),
    "mcap": ("MCAP needs mcap", "trace"),
    "pyarrow": ("Parquet needs pyarrow", "trace"),
    "mypyc": ("the compiled build needs mypyc", "speed"),
    "setuptools": ("the compiled build needs setuptools", "speed"),
    "wheel": ("a wheel with the compiled build needs wheel", "speed"),
    "sphinx": ("the site needs Sphinx", "docs"),
})  # fmt: skip


def hint(package: str) -> str:
    """The line that says what to install for a package that is missing; empty if no extra brings it."""
    needed, extra = EXTRAS.get(package.partition(".")[0], ("", ""))
    return f"{needed}: pip install 'c2000-hil[{extra}]'" if extra else ""


def has(package: str) -> bool:
    """Whether the package is installed."""
    try:
        return find_spec(package) is not None
    except ValueError:  # what was put into sys.modules by hand has no spec
        return False


def require(package: str) -> None:
    """Raise ModuleNotFoundError with the line of `hint` unless the package is installed."""
    if not has(package):
        raise ModuleNotFoundError(hint(package), name=package)
