"""How a place is written, alone and within a sentence."""

from __future__ import annotations

import re
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.sites import Place
from hil.reports.excerpt import location, places_in, readable, shown, source_line, statement

NAMES = st.from_regex(re.compile(r"[A-Za-z_]\w{0,20}", re.ASCII), fullmatch=True)
C_FILES = st.builds(
    lambda folder, stem, ending: f"/{folder}/{stem}.{ending}", NAMES, NAMES, st.sampled_from(["c", "h", "C"])
)
#: A folder beside the current one.
OUTSIDE = Path.cwd().parent / "nowhere"
LINES = st.integers(1, 99_999)
FUNCTIONS = NAMES | st.just("")
NO_TEXT = st.just("")
PLACES = st.one_of(
    st.builds(Place, C_FILES, LINES, FUNCTIONS, NO_TEXT, st.integers(0, 200), NO_TEXT),
    st.builds(Place, C_FILES.map(lambda file: f"{file}.py"), LINES, FUNCTIONS, NO_TEXT, st.just(0), NO_TEXT),
)


def test_a_place_names_the_file_in_which_its_line_counts() -> None:
    # Line 139 is one of us.py: the C file that us.py mirrors is not named with it.
    place = Place(f"{OUTSIDE}/us.py", 139, "Read_Distance", "us.c")
    assert location(place) == "../nowhere/us.py:139"
    assert shown(place) == "Read_Distance (../nowhere/us.py:139)"


def test_a_column_that_is_known_stands_behind_the_line() -> None:
    assert shown(Place(f"{OUTSIDE}/us.c", 94, "Read_Distance", "us.c", 12)) == "Read_Distance (../nowhere/us.c:94:12)"
    # But for Python: a statement of the port has its line to itself.
    assert shown(Place(f"{OUTSIDE}/us.py", 139, "Read_Distance", "us.c", 5)) == "Read_Distance (../nowhere/us.py:139)"


def test_a_place_outside_of_functions_says_so() -> None:
    place = Place(f"{OUTSIDE}/us.py", 7, "", "us.c")
    assert shown(place) == "file scope (../nowhere/us.py:7)"
    assert places_in(f"declared at {place} and nowhere else") == [Place(f"{OUTSIDE}/us.py", 7, "", "")]


@given(PLACES, PLACES)
def test_the_places_of_a_sentence_are_found_again(a: Place, b: Place) -> None:
    sentence = f"High (priority 3) writes it in {a}, at 2.500 us; Low reads it (word 1:2) in {b}"
    assert places_in(sentence) == [a, b]
    said = f"High (priority 3) writes it in {shown(a)}, at 2.500 us; Low reads it (word 1:2) in {shown(b)}"
    assert readable(sentence) == said


def test_a_file_that_was_edited_is_shown_as_it_is_now(tmp_path: Path) -> None:
    file = tmp_path / "edited.py"
    file.write_text("one = 1\n")
    assert source_line(str(file), 1) == statement(str(file), 1) == "one = 1"
    file.write_text("other = 22\n")
    assert source_line(str(file), 1) == statement(str(file), 1) == "other = 22"
    file.unlink()
    assert source_line(str(file), 1) == ""
