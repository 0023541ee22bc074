"""Short names of fixtures and markers: `board` is `hil_board`.

If another plugin has a fixture with a short name, that plugin keeps the name, whichever plugin was loaded first.  A
conftest.py or a test file may override a short name as usual; the fixtures of this plugin use each other by their long
names.  A marker that the project or another plugin has registered keeps its meaning.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from inspect import Parameter, Signature, getattr_static
from types import ModuleType
from typing import Any, Final

import pytest

from hil.testing import settings
from hil.testing.stash import TAKEN, TAKEN_MARKERS

#: The fixtures that have a short name.
SHORT: Final = (
    "advance", "bench", "board", "expects", "fault", "feed", "fill", "findings", "firmware", "kernel", "later",
    "outside", "seed", "timeline", "uart", "until", "when",
)  # fmt: skip


def give_short_names(config: pytest.Config) -> None:
    """Add the fixtures with short names.  Those of a conftest.py override them."""
    plugins = config.pluginmanager.get_plugins()
    others = {name for plugin in plugins for name in _fixtures(plugin)}
    short_of_long = {f"hil_{name}": name for name in SHORT}
    docstrings = {
        short_of_long[n]: value.__doc__
        for plugin in plugins
        for n, value in _named(plugin).items()
        if n in short_of_long
    }
    taken: list[str] = [name for name in SHORT if name in others]
    config.stash[TAKEN] = taken
    names = ModuleType("c2000_hil_short_names")
    vars(names).update({name: _short(name, docstrings[name]) for name in SHORT if name not in others})
    config.pluginmanager.register(names, names.__name__)


def register_markers(config: pytest.Config) -> None:
    """Register the markers by their long names, and by those short names that are free."""
    others = {line.partition(":")[0].partition("(")[0].strip() for line in config.getini("markers")}
    names = [line.partition(":")[0].partition("(")[0] for line in settings.MARKERS]
    config.stash[TAKEN_MARKERS] = [name for name in names if name in others]
    for name, line in zip(names, settings.MARKERS, strict=True):
        config.addinivalue_line("markers", f"hil_{line}")
        if name not in others:
            config.addinivalue_line("markers", f"{name}: short for hil_{name}")


def _short(name: str, docstring: str) -> Callable[..., Any]:
    """The fixture `name`, which returns the value of the fixture `hil_name`."""
    long = f"hil_{name}"

    def give(**values: Any) -> Any:
        return values[long]

    give.__signature__ = Signature([Parameter(long, Parameter.KEYWORD_ONLY)])  # type: ignore[attr-defined]
    give.__doc__ = docstring
    return pytest.fixture(name=name)(give)


def _fixtures(plugin: object) -> Iterator[str]:
    """The names of the fixtures of a plugin.  A conftest.py gives none, because it overrides all plugins."""
    file = str(getattr(plugin, "__file__", ""))
    if file.endswith("conftest.py"):
        return
    for name, value in _named(plugin).items():
        # Of pytest 8.4 and later, and of those before; static, because a value may be anything.
        for attribute in ("_fixture_function_marker", "_pytestfixturefunction"):
            marker = getattr_static(value, attribute, None)
            if marker is not None:
                yield str(getattr(marker, "name", None) or name)


def _named(plugin: object) -> dict[str, Any]:
    return dict(vars(plugin if isinstance(plugin, ModuleType | type) else type(plugin)))
