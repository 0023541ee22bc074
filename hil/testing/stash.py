"""The keys under which pytest keeps the plugin's data of a session and of a test."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import pytest

if TYPE_CHECKING:
    from hil.testing.case import Case
    from hil.testing.session import ProjectSession

CASE: Final[pytest.StashKey[Case]] = pytest.StashKey()
SESSION: Final[pytest.StashKey[ProjectSession]] = pytest.StashKey()
#: Short names of fixtures that another plugin has.
TAKEN: Final[pytest.StashKey[list[str]]] = pytest.StashKey()
#: Short names of markers that the project, or another plugin, has registered.
TAKEN_MARKERS: Final[pytest.StashKey[list[str]]] = pytest.StashKey()
