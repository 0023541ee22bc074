"""The fixture `bench`: the whole robot in its world.  It belongs to the plugin, which loads it by name."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

from hil.testing import settings
from hil.testing.fixtures import in_one_line

if TYPE_CHECKING:
    from hil.bench import Bench
    from hil.testing.case import Case


@pytest.fixture
def hil_bench(request: pytest.FixtureRequest, hil_seed: int, hil_fill: str, hil_case: Case) -> Iterator[Bench]:
    """The whole robot in its world, booted (2.2 s of virtual time), with the C files of the marker `firmware`."""
    from hil.bench import Bench
    from hil.collector import uncollected
    from hil.machine import Setup
    from hil.testing.session import session_of

    node = request.node
    with in_one_line(), uncollected():
        name, _ = settings.board(node)
        if name != "robot":
            raise ValueError(f"bench is the robot in its world, and the board of this test is {name}: ask for board")
        bench = Bench(
            Setup(
                settings.world(node), hil_seed, hil_fill, settings.realistic(node),
                float_division=settings.float_division(node), fixes=settings.fixes(node), watch=True, static=True,
                options=settings.options(node), **own_c(node),
            ),
            traced=False, coverage=session_of(request.config).coverage,
        )  # fmt: skip
    hil_case.watch(bench.findings, bench.close)
    bench.boot()
    yield bench
    bench.close()


def own_c(item: pytest.Item) -> dict[str, Any]:
    """The C files that replace modules of the robot in a test with `bench`, as arguments for `Setup`.

    An ini key that names no file of the robot is for other tests.  Raises ValueError for a marker that names other
    files than C files, or another ABI than the robot's.
    """
    from firmware_model.c_files import FILES, module_of

    named = settings.firmware_modules(item)
    if settings.nearest(item, "firmware") is None and not any(map(module_of, named)):
        return {}
    for name in named:
        if not name.lower().endswith(".c"):
            raise ValueError(f"firmware({name!r}) in a test with bench: the robot takes C files ({', '.join(FILES)})")
    given = settings.for_c(item)
    if given.get("abi", "coff") != "coff":
        raise ValueError(f"marker firmware(abi={given['abi']!r}) in a test with bench: the robot is built as coff")
    return {
        "firmware": tuple(settings.located(name, item.path.parent) for name in named),
        "include": tuple(map(str, given.get("include", ()))),
        "defines": tuple(given.get("defines", ())),
    }
