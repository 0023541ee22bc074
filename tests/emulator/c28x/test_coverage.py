"""How often each line of firmware has run: counts derived by hand from the text."""

from __future__ import annotations

import pytest

from emulator.c28x.coverage import Coverage
from tests.emulator.c28x.readers.c.workshop import CWorkshop
from tests.emulator.c28x.specimens import Driver
from tests.emulator.c28x.test_specimens import DRIVERS, LIBRARY
from tests.emulator.c28x.workshop import HEADER, Workshop

TEXT = """\
int total;
static int half(int n)
{
    return n / 2;
}
int f(int n)
{
    int i, k;
    int sum = 0;
    for (i = 0; i < n; i++) {
        if (i == 2)
            continue;
        sum += half(i);
    }
    while (sum > 1) {
        sum--;
        if (sum == 5)
            break;
    }
    do {
        total++;
    } while (total < 3);
    switch (n) {
    case 1:
        total = 0;
        break;
    case 5:
        total += 10;
    case 6:
        total += 20;
        break;
    default:
        return -1;
    }
    for (k = 0; k < 4 && total; k++) total -= 10;
    return total;
}
"""

#: Of `f(5)`: the `for` is looked at for i = 0 ... 5, its body turns for 0 ... 4 and goes on at once for 2; the sum is
#: 0 + 0 + 1 + 2 = 3, so the `while` is looked at with 3, 2, 1; the `do` ends with total = 3; case 5 falls through, so
#: that the total is 33, and the last `for` is looked at for k = 0 ... 4, its body runs 4 times on the same line.  The
#: `break` that ends a case is the case's end, no statement.
HITS = {
    4: 4, 9: 1, 10: 6, 11: 5, 12: 1, 13: 4, 15: 3, 16: 2, 17: 2, 18: 0, 21: 3, 22: 3, 23: 1, 25: 0, 28: 1,
    30: 1, 33: 0, 35: 5, 36: 1,
}  # fmt: skip


def test_every_line_with_a_statement_has_its_hits() -> None:
    coverage = Coverage()
    assert CWorkshop(TEXT, coverage=coverage).call("f", 5) == 33 - 40
    counted = coverage.files()["drv.c"]
    assert counted.lines == HITS
    assert counted.functions == {"half": (2, 4), "f": (6, 1)}


def test_images_that_share_it_add_up() -> None:
    coverage = Coverage()
    for _ in range(2):
        CWorkshop(TEXT, coverage=coverage).call("f", 5)
    assert coverage.files()["drv.c"].lines == {line: 2 * hits for line, hits in HITS.items()}


def test_what_another_process_has_counted_is_added() -> None:
    here, there = Coverage(), Coverage()
    for coverage in (here, there):
        CWorkshop(TEXT, coverage=coverage).call("f", 5)
    here.add(there.data())
    assert here.files()["drv.c"].lines == {line: 2 * hits for line, hits in HITS.items()}
    fresh = Coverage()
    fresh.add(there.data())
    assert fresh.files() == there.files()


@pytest.mark.parametrize("watch", [False, True])
def test_counting_changes_no_time(watch: bool) -> None:
    plain, counted = CWorkshop(TEXT, watch=watch), CWorkshop(TEXT, watch=watch, coverage=Coverage())
    assert plain.call("f", 5) == counted.call("f", 5)
    assert plain.clock.now == counted.clock.now


@pytest.mark.parametrize("driver", DRIVERS, ids=lambda driver: driver.name)
def test_counting_changes_nothing_that_a_driver_does(driver: Driver) -> None:
    plain, counted = (Workshop(driver.source, header=LIBRARY, coverage=c) for c in (None, Coverage()))
    for arguments, _ in driver.results:
        assert getattr(plain, driver.function)(*arguments) == getattr(counted, driver.function)(*arguments)
        assert plain.clock.now == counted.clock.now


#: Lines below the header.  `Sum(6)`: the `for` is looked at for i = 0 ... 4 and left at 4 by `break`, so its `else if`
#: is not passed then; the endless loop turns three times, and is looked at three times: the last turn returns.
PYTHON = """
def Sum(n: int16) -> int16:
    i: int16
    s: int16 = 0
    for i in range(n):
        if i == 4:
            break
        elif i > 1:
            s += i
    while 1:
        s -= 1
        match s:
            case 2:
                return s
            case 3 | 4:
                pass
            case _:
                s = 0
"""


def test_c_shaped_python_is_counted_alike() -> None:
    coverage = Coverage()
    shop = Workshop(PYTHON, coverage=coverage)
    assert shop.Sum(6) == 2
    ((_, counted),) = coverage.files().items()
    first = HEADER.count("\n")
    found = {line - first: hits for line, hits in counted.lines.items()}
    assert found == {4: 1, 5: 5, 6: 5, 7: 1, 8: 4, 9: 2, 10: 3, 11: 3, 12: 3, 14: 1, 18: 0}
