"""The unit that a name or a comment states: `timeoutMs`, `SUPPLY_MIN_MV`, `temp_tenths_C`, `// 0.1 degree`, `[mV]`.

A name states a unit by its end, in snake_case or camelCase.  An end that has other meanings too (`_s`, `_A`, `Dc`)
counts only if another word of the name names the quantity: `timeout_s`, `motorCurrent_A`, `temperatureDc`.  Names with
`per` are rates or factors, which are not followed.

An end that could also be a channel or a phase (`halten_s`, `LIMIT_A`), or that is rare (`cbar`), states a unit where
the other side of a comparison, a sum or an assignment has a unit of the same quantity: `unit_in_context`.  Two units
one behind the other are one of a product (`rest_mA_ms`), or of a rate (`mm_s`), which is not followed.

A comment states a unit if it begins with nothing but a unit (`// rpm, filtered`), or has one in brackets.  A comment
that speaks of a scale in another form makes the unit of the name unknown.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi
from typing import Final


@dataclass(frozen=True, slots=True)
class PhysicalUnit:
    """A unit.  `scale` is its size in the base unit of its quantity (s, m, V, degree, degree Celsius, Hz, ...).

    `prefix` is the power of ten in its name: 0.001 of mV, 0.1 of a tenth of a degree.  A unit that is only a prefix
    (`tempMilli`) has no quantity.  One that nothing here knows has the scale 0: it is only equal to itself.
    """

    name: str
    quantity: str = ""
    scale: float = 0.0
    prefix: float = 1.0

    def ratio(self, other: PhysicalUnit) -> float:
        """How many of the `other` unit one of this is; 0: they are units of different quantities, or it is not known.

        Tenths beside mm may be those of a millimetre or of a metre.
        """
        if self.scale and other.scale:
            if not self.quantity or not other.quantity:
                whole = self.quantity == other.quantity or 1.0 in (self.prefix, other.prefix)
                return self.prefix / other.prefix if whole or self.prefix == other.prefix else 0.0
            if self.quantity == other.quantity or (self.is_degree and other.is_degree):
                return self.scale / other.scale
        return 1.0 if self.name == other.name else 0.0

    @property
    def is_degree(self) -> bool:
        """Whether it is a degree, of an angle or of Celsius (names often leave open of which), or a part of one."""
        return self.quantity in ("angle", "temperature") and "rad" not in self.name

    def divided(self, by: float) -> PhysicalUnit:
        """A unit that is smaller by a factor."""
        return replace(self, name=f"1/{by:g} {self.name}", scale=self.scale / by, prefix=self.prefix / by)

    def inverse(self) -> PhysicalUnit | None:
        """The unit of a number divided by a value in this unit: a rate, or a period; None: it has no name."""
        quantity = {"time": "frequency", "frequency": "time"}.get(self.quantity)
        if quantity is None or not self.scale:
            return None
        return PhysicalUnit(f"1/({self.name})", quantity, 1 / self.scale, 1 / self.prefix)

    def multiplied(self, other: PhysicalUnit) -> PhysicalUnit | None:
        """The unit of a product with a value in the `other` unit; None: it has no name."""
        for one, two in ((self, other), (other, self)):
            quantity = _PRODUCTS.get((one.quantity, two.quantity))
            if quantity is not None and one.scale and two.scale:
                return PhysicalUnit(f"{one.name} {two.name}", quantity, one.scale * two.scale, one.prefix * two.prefix)
        return None


#: Quantities of which a product is another one, in the base units (A s, V A, W s).
_PRODUCTS: Final = {
    ("current", "time"): "charge", ("power", "time"): "energy", ("voltage", "current"): "power",
}  # fmt: skip


def _units() -> Iterator[tuple[PhysicalUnit, tuple[str, ...], tuple[str, ...]]]:
    """The units, each with the ends of names, in small letters, that state it, and with more texts of comments.

    Words that are also something else (a second, a meter, an amp, a bar, the degree of a filter) are for comments only.
    """
    whole = (
        ("V", "voltage", "", ("volts",), ("v", "volt")), ("A", "current", "", ("amps", "amperes"), ("a", "ampere")),
        ("W", "power", "", ("watts",), ("w", "watt")), ("s", "time", "", ("sec", "secs", "seconds"), ("s", "second")),
        ("m", "length", "", ("metres", "meters"), ("m", "metre", "meter")), ("J", "energy", "", ("joules",), ("j",)),
        ("Hz", "frequency", "", ("hz", "hertz"), ()), ("Pa", "pressure", "", ("pascals",), ("pa",)),
        ("g", "mass", "", ("grams",), ("g", "gram")),
        ("bar", "pressure", "", (), ("bar",)), ("rad", "angle", "", ("radians",), ("radian", "rad")),
        ("degree", "angle", "deg", ("deg", "degs", "degrees"), ("degree", "°")),
        ("degree Celsius", "temperature", "c", ("celsius", "degc", "degreesc"),
         ("c", "°c", "deg c", "degree c", "degrees c", "degree celsius", "degrees celsius")),
    )  # fmt: skip
    prefixes = (
        ("", "", 1.0), ("m", "milli", 1e-3), ("u", "micro", 1e-6), ("n", "nano", 1e-9), ("k", "kilo", 1e3),
        ("c", "centi", 1e-2), ("d", "deci", 1e-1),
    )  # fmt: skip
    #: Short names that occur in programs; others (`cV`, `dA`) are not worth a mistake.
    usual = {
        "mv", "uv", "kv", "ua", "mw", "kw", "ms", "us", "ns", "mm", "cm", "um", "km", "khz", "mj", "mbar", "kpa", "hpa",
        "kg", "mg", "mdeg", "ddeg", "cdeg", "mrad",
    }  # fmt: skip
    for symbol, quantity, brief, words, more in whole:
        size = {"rad": 180 / pi, "bar": 1e5}.get(symbol, 1.0)
        for letter, prefix, power in prefixes:
            short = f"{letter}{brief or symbol}".lower()
            ends = [f"{prefix}{word}" for word in words if word != "hz"]
            ends += [short] if short in usual else []
            if quantity == "time" and letter in "mu" and letter:
                ends += [f"{letter}sec", f"{letter}secs", *(["millis"] if letter == "m" else [])]
            if symbol == "Hz" and not letter:
                ends.append("hz")
            name = f"{letter}{symbol}" if len(symbol) < 4 else f"{prefix}{symbol}"
            texts = more if not letter else (f"{prefix}{more[1]}",) if len(more) > 1 else ()
            yield PhysicalUnit(name, quantity, power * size, power), tuple(ends), texts
    yield PhysicalUnit("MHz", "frequency", 1e6, 1e6), ("mhz", "megahertz"), ()
    # Not in Hz: of a wheel with sixty teeth, the frequency in Hz is the speed in rpm.
    yield PhysicalUnit("rpm", "rotation", 1.0), ("rpm",), ()
    yield PhysicalUnit("percent", "ratio", 1e-2), ("percent", "pct"), ("%",)
    yield PhysicalUnit("permille", "ratio", 1e-3), ("permille", "promille"), ()
    for size, words in (
        (1e-1, ("tenths",)),
        (1e-2, ("hundredths",)),
        (0.0625, ("sixteenths",)),
        (1e-3, ("milli", "thousandths")),
    ):
        yield PhysicalUnit(f"{words[-1]} of a unit", "", size, size), words, ()


_BY_NAME: Final = {unit.name: unit for unit, _, _ in _units()}
#: End of a name, in small letters -> unit.
_ENDS: Final = {end: unit for unit, ends, _ in _units() for end in ends}
#: Text of a comment, in small letters -> unit.
_TEXTS: Final = {
    **{text: unit for unit, _, texts in _units() for text in texts},
    **{end: unit for end, unit in _ENDS.items() if unit.quantity},
    "ma": _BY_NAME["mA"],
}  # fmt: skip
#: Symbols of one letter, as they are written.
_LETTERS: Final = "VAWJCgsm"
#: Ends that have other meanings: each with its unit, and the beginnings of words one of which the name must have too.
_AMBIGUOUS: Final = {
    "s": ("s", (
        "time", "timeout", "delay", "period", "interval", "duration", "elapsed", "wait", "uptime",
        "zeit", "dauer", "frist", "tiempo", "duracion", "retardo", "plazo", "espera",
    )),
    "v": ("V", (
        "volt", "vout", "vin", "supply", "vref", "batt", "vbat", "spannung", "versorgung", "akku", "tension", "bateria",
    )),
    "a": ("A", ("current", "curr", "iout", "strom", "corriente")),
    "m": ("m", (
        "distance", "dist", "length", "height", "depth", "abstand", "strecke", "laenge", "hoehe", "longitud", "altura",
    )),
    "w": ("W", ("power", "leistung", "potencia")),
    "c": ("degree Celsius", ("temp", "hot", "cold", "warm", "heiss", "kalt")),
    "dc": ("decidegree Celsius", ("temp",)),
    "mc": ("millidegree Celsius", ("temp",)),
    "ma": ("mA", (
        "i", "current", "curr", "iout", "imax", "load", "amp", "charge", "limit", "phase", "motor", "strom",
        "corriente",
    )),
    "rad": ("rad", (
        "angle", "heading", "yaw", "pitch", "roll", "theta", "phi", "phase", "turn", "rotation", "tilt",
        "winkel", "kurs", "drehung", "neigung", "angulo", "rumbo", "giro",
    )),
}  # fmt: skip
#: Products of units, as names spell them.
_SPELLED: Final = {
    spelling: PhysicalUnit(f"{letter}{symbol}", quantity, size * power, power)
    for symbol, quantity, size in (
        ("As", "charge", 1.0), ("Ah", "charge", 3600.0), ("Ws", "energy", 1.0), ("Wh", "energy", 3600.0),
    )
    for letter, power in (("", 1.0), ("m", 1e-3), ("u", 1e-6), ("k", 1e3))
    for spelling in ((f"{letter}{symbol}", f"{letter}{symbol}".upper()) if letter else (symbol,))
}  # fmt: skip
#: Ends, as they are written, that state a unit only where the other side has one of the same quantity.
_IN_CONTEXT: Final = {
    **{end: _BY_NAME[end] for end in ("s", "V", "A", "W", "cbar", "dbar", "cV", "cA")}, "C": _BY_NAME["degree Celsius"],
}  # fmt: skip
#: The words for `per`: the name of a rate.
PER: Final = frozenset(("per", "je", "pro", "por"))
#: Parts of a unit: how a comment or a name writes them.
_PARTS: Final = {
    "tenth": 10.0, "tenths": 10.0, "hundredth": 100.0, "hundredths": 100.0, "thousandth": 1000.0,
    "thousandths": 1000.0, "sixteenth": 16.0, "sixteenths": 16.0, "deci": 10.0, "centi": 100.0,
    "0.1": 10.0, "0.01": 100.0, "0.001": 1000.0, "1/10": 10.0, "1/100": 100.0, "1/1000": 1000.0,
}  # fmt: skip
#: Names that are a unit and nothing else.
_ALONE: Final = frozenset((
    "ms", "us", "mv", "mm", "rpm", "hz", "khz", "degrees", "millivolts", "celsius", "percent", "permille", "promille",
    "millis", "milliseconds", "microseconds",
))  # fmt: skip
#: An amount in a name: `RATE_6400_Hz` and `TIMEOUT_500MS` need not be numbers of this unit.
_AMOUNT: Final = re.compile(r"(?:_|^)\d+_?[A-Za-z]+$|[a-z]\d+[A-Z][a-z]+$")
_HUMPS: Final = re.compile(r"[A-Z]{2,}s(?![a-z])|[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
#: What a comment says about a value that is not in the unit of its name.
_SCALED: Final = re.compile(
    r"\b(?:per|tenths?|hundredths?|thousandths?|scaled?|fixed|counts?|ticks?|lsbs?|raw|digits?|codes?|units?|times|"
    r"factor|ratio|loops?|cycles?|steps?|q\d+|x ?10+)\b|[*/×%]|0\.\d|\d\.\.",
    re.IGNORECASE,
)  # fmt: skip
#: How long a tick lasts; it does not scale the value beside it.
_TICK_LASTS: Final = re.compile(
    r"\b(?:one|1|a|each|the) (?:\w+ )?tick (?:is|=|lasts) (?:1|one) ?(?:ms|millisecond)\b", re.IGNORECASE
)
_STATED: Final = re.compile(r"^(?:in )?(?:(?P<part>[a-z]+|[01][./]\d+)(?: of)?(?: an?)? )?(?P<unit>\S+(?: \S+)?)$")
_NUMBER: Final = r"[-+]?\d+(?:\.\d*)?"


def unit_of_name(name: str) -> PhysicalUnit | None:
    """The unit that the end of an identifier states; None: none, or one that is not certain."""
    words: list[str] = []
    written = name.split("_")
    for part in written:
        whole = part.lower() in _ENDS or part in ("kHz", "MHz", "mHz", "mA", "mC", "dC")
        words += [part] if whole else _HUMPS.findall(part)
    small = [word.lower() for word in words]
    if not PER.isdisjoint(small) or not small:
        return None
    if len(written) > 1 and written[-1] in _SPELLED:
        return _SPELLED[written[-1]]
    if len(small) == 1:
        return _ENDS[small[0]] if small[0] in _ALONE else None
    if small[-2] == "x" and small[-1] in ("10", "100", "1000"):
        unit = unit_of_name(name[: -len(small[-1]) - 1].rstrip("_"))
        return unit and unit.divided(float(small[-1]))
    if _AMOUNT.search(name):
        return None
    if words[-1] in ("mHz", "MW", "MA", "MV") and not name.isupper():
        return None  # mega or milli
    if len(small) > 2 and small[-2] + small[-1] in _ENDS and small[-1] != "s":  # degrees a second
        return _ENDS[small[-2] + small[-1]]
    end = small[-1]
    before = _whole_word(written[-2]) if len(written) > 2 else None
    if before is not None:
        last = _whole_word(written[-1])
        return before.multiplied(last) if last is not None else None
    if end in _AMBIGUOUS:
        unit_name, quantities = _AMBIGUOUS[end]
        known = any(word == q or (len(q) > 2 and word.startswith(q)) for word in small[:-1] for q in quantities)
        unit = _BY_NAME[unit_name] if known else None
    else:
        unit = _ENDS.get(end)
    if unit is not None and unit.quantity and small[-2] in _PARTS:
        return unit.divided(_PARTS[small[-2]])
    return unit


def unit_in_context(name: str) -> PhysicalUnit | None:
    """The unit that the end of an identifier may state, where another unit shows the quantity; None: none."""
    *before, end = name.split("_")
    unit = _IN_CONTEXT.get(end) or (_IN_CONTEXT.get(end.lower()) if name.isupper() else None)
    if not before or len(before[-1]) < 2 or _whole_word(before[-1]) is not None or not PER.isdisjoint(words_of(name)):
        return None  # a rate, or an index of one letter
    return unit


def unit_per(name: str) -> PhysicalUnit | None:
    """The unit of which the name of a factor says how many counts make one: `STEPS_PER_MM`, `PULSE_JE_ML`."""
    words = name.split("_")
    if len(words) < 3 or words[-2].lower() not in PER or any(_whole_word(word) is not None for word in words[:-2]):
        return None
    return _whole_word(words[-1])


def _whole_word(word: str) -> PhysicalUnit | None:
    """The unit that a word is, and nothing else; no symbol of one letter."""
    if len(word) < 2:
        return None
    unit = _BY_NAME.get(word) or _BY_NAME.get("mA" if word == "MA" else "") or _ENDS.get(word.lower())
    return unit if unit is not None and unit.quantity and unit.quantity != "ratio" else None


def unit_of_text(text: str) -> PhysicalUnit | None:
    """The unit that a text is the name of: `mm`, `0.1 degree`, `tenths of a degree`, `in thousandths of a mm`."""
    text = " ".join(text.split()).rstrip(".")
    if len(text) == 1 and text.isalpha() and text not in _LETTERS:
        return None
    text = text.lower()
    if text in _TEXTS:
        return _TEXTS[text]
    match = _STATED.match(text)
    unit = _TEXTS.get(match["unit"]) if match is not None else None
    if match is None or unit is None or match["part"] is None:
        return unit
    return unit.divided(_PARTS[match["part"]]) if match["part"] in _PARTS else None


@dataclass(frozen=True, slots=True)
class UnitRemark:
    """What the comment beside a declaration says about its unit."""

    unit: PhysicalUnit | None = None
    #: It speaks of a scale: then the end of the name says nothing certain.
    unclear: bool = False
    #: `85 degrees`: the number before the unit.
    amount: float | None = None


@lru_cache(maxsize=4096)
def remark(comment: str) -> UnitRemark:
    """What a comment says; its text without the marks."""
    text = _TICK_LASTS.sub("", " ".join(comment.split())).strip()
    bracket = re.search(r"\[([^\]]+)\]", text)
    if bracket is not None and (unit := unit_of_text(bracket[1])) is not None:
        return UnitRemark(unit)
    first = re.split(r"[,;:(]", text)[0].strip()
    if len(first) > 1 and (unit := unit_of_text(first)) is not None:  # one letter can be a channel, or a footnote
        return UnitRemark(unit, unclear=_SCALED.search(text[len(first) :]) is not None)
    amount = re.match(rf"^({_NUMBER}) ?(\D.*)$", first)
    if amount is not None and (unit := unit_of_text(amount[2])) is not None:
        return UnitRemark(unit, _SCALED.search(text[len(first) :]) is not None, float(amount[1]))
    return UnitRemark(unclear=_SCALED.search(text) is not None)


def words_of(name: str) -> list[str]:
    """The words of an identifier, in small letters."""
    return [word.lower() for part in name.split("_") for word in _HUMPS.findall(part)]
