"""What is modelled and what is not, as the modules say it."""

from __future__ import annotations

from importlib.resources import files

import pytest

from hil.docs.modelled import FOLDERS, docstrings, page, statements


@pytest.mark.parametrize("folder", FOLDERS.values(), ids="/".join)
def test_no_module_that_says_it_is_left_out(folder: tuple[str, str]) -> None:
    shown = page()
    package, name = folder
    said = 0
    for module, text in docstrings(files(package) / name):
        if "Not modelled:" in text or "\nNot modelled\n" in text:
            assert statements(text)["Not modelled"], module
            assert f"\n### {module}\n" in shown
            assert statements(text)["Not modelled"] in shown
            said += 1
    assert said >= 2


@pytest.mark.parametrize(
    "text",
    [
        "A part.\n\nModelled: one thing,\nand two.\nNot modelled: three.\nTime: none.\nSources: DS.\n",
        "A part.\n\nModelled\n    one thing,\n    and two.\nNot modelled\n    three.\nTime\n    none.\n",
    ],
)
def test_both_ways_of_writing_it(text: str) -> None:
    told = statements(text)
    assert told["Modelled"] == "one thing, and two."
    assert told["Not modelled"] == "three."
    assert told["Time"] == "none."


def test_what_is_not_modelled_at_all_is_listed() -> None:
    assert "`Cla1Regs`" in page()
