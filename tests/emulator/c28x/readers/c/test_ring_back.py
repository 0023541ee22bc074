"""Ways back from the index of a ring, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import findings_of

HEAD = """typedef unsigned int Uint16;
static int events[8], taps[4] = {1, 2, 3, 4}, places[9];
static Uint16 next, count, dump, length;
volatile Uint16 in;
void Add(int e) { events[next] = e; next = (next + 1) % 8; if (count < 8) count++; }
void Mask(int e) { events[next] = e; next = (next + 1) & 7; dump = count; }
void Put(int c) { places[length] = c; if (length < 8) length++; else length = 0; }
"""


def told(body: str) -> bool:
    """Whether a function is told that it goes back beyond the first element."""
    text = f"{HEAD}int f(void)\n{{\n{body}\n}}\n"
    return ("table-short", HEAD.count("\n") + 3) in findings_of(text)


@pytest.mark.parametrize(
    "body",
    [
        "if (dump == 0) return 0; return events[next - dump];",
        "return events[next - 1];",
        "int k, sum = 0; for (k = 0; k < 4; k++) sum += taps[k] * events[next - k]; return sum;",
    ],
)
def test_a_way_back_below_the_first_element_is_told(body: str) -> None:
    assert told(body)


@pytest.mark.parametrize(
    "body",
    [
        "return events[(next + 8 - dump) % 8];",
        "return events[next - 1 & 7];",
        "return next >= dump ? events[next - dump] : events[next + 8 - dump];",
        "if (!next) return events[7]; return events[next - 1];",
        "Uint16 back = next / 2; return events[next - back];",
        "int k, sum = 0; for (k = 0; k < next; k++) sum += events[next - k]; return sum;",
        "return places[length - 1];",  # no ring: it is filled once
        "return places[next - dump];",  # another table
        "return events[next];",
    ],
)
def test_a_way_back_around_the_end_or_a_test_is_silent(body: str) -> None:
    assert not told(body)
