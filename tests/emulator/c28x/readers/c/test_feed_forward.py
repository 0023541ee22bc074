"""Feed-forwards and errors that disagree about the wanted value: wrong regulators, and their right twins."""

from __future__ import annotations

import pytest

from tests.emulator.c28x.readers.c.workshop import CWorkshop

PROGRAM = """
#define KP 0.8f
float read(void);
void drive(float duty);
static const float feedForward = 0.4f, kff = 0.5f, back = -0.8f;
static const int orderFF = 3;
static float gain = 1.0f, wanted = 0.0f;
static void Step(void)
{{
    float speed = read(), error = 0.0f;
    int order = (int)wanted, count = (int)speed;
    gain = read();
    {body}
}}
int main(void) {{ for (;;) {{ wanted = read(); Step(); }} }}
"""


def told(body: str) -> list[str]:
    """The errors that are told of."""
    shop = CWorkshop(
        PROGRAM.format(body=body), static=True, externs={"read": lambda: 1.0, "drive": lambda _: None}
    )
    return [f.object for f in shop.findings if f.rule == "runs-away"]


@pytest.mark.parametrize(("body", "text"), [
    ("drive(feedForward * wanted + KP * (speed - wanted));", "speed - wanted"),
    ("drive(KP * (speed - wanted) + kff * wanted);", "speed - wanted"),
    ("drive(feedForward * wanted - KP * (wanted - speed));", "wanted - speed"),
    ("drive(feedForward * wanted + back * (wanted - speed));", "wanted - speed"),
    ("float e = speed - wanted; drive(feedForward * wanted + KP * e);", "speed - wanted"),
    ("drive(orderFF * order / 4 + 2 * (count - order));", "count - order"),
])  # fmt: skip
def test_one_of_the_two_has_the_wrong_sign(body: str, text: str) -> None:
    assert told(body) == [text]


@pytest.mark.parametrize("body", [
    "drive(feedForward * wanted + KP * (wanted - speed));",
    "drive(feedForward * wanted - KP * (speed - wanted));",
    "drive(feedForward * wanted + back * (speed - wanted));",
    "drive(-feedForward * wanted + KP * (speed - wanted));",
    "drive(feedForward * wanted + gain * (speed - wanted));",
    "drive(gain * wanted + KP * (speed - wanted));",
    "drive(KP * wanted + KP * (speed - wanted));",
    "drive(feedForward * wanted - KP * speed);",
    "error = wanted - speed; if (error < 0.0f) error = speed - wanted; drive(feedForward * wanted + KP * error);",
    "drive(feedForward * (wanted - speed) + KP * (speed - wanted));",
])  # fmt: skip
def test_they_agree_or_it_is_not_known(body: str) -> None:
    assert told(body) == []
