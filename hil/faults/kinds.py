"""The declaration of a fault, as text, as a table and as data.  Nothing here knows a board."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import inf
from random import Random
from typing import TYPE_CHECKING, Any, Final

from emulator.seed import MAX_SEED
from hil.longest import LONGEST_S

if TYPE_CHECKING:
    from hil.faults.effect import Effect

Value = float | int | str


@dataclass(frozen=True, slots=True)
class FaultParameter:
    """A parameter of a fault: a number or a word.  Without a default it must be given."""

    name: str
    unit: str
    what: str
    default: Value | None = None
    low: float = -inf
    high: float = inf
    choices: tuple[str, ...] = ()
    #: float, int or str.
    type: type = float

    @property
    def range(self) -> str:
        """The permitted values, in words."""
        if self.choices:
            return ", ".join(self.choices)
        if self.type is str:
            return "a text"
        if self.low == -inf and self.high == inf:
            return "any number"
        return f"at least {self.low:g}" if self.high == inf else f"{self.low:.15g} to {self.high:.15g}"

    def read(self, value: Any) -> Value:
        """Convert a value of a text or a table.  Raises ValueError."""
        if self.type is str:
            if not isinstance(value, str):
                raise ValueError(f"{self.name}: {value!r} must be a text")
            if self.choices:
                same = [choice for choice in self.choices if choice.lower() == value.lower()]
                if not same:
                    raise ValueError(f"{self.name}: {value!r} is not one of {self.range}")
                return same[0]
            return value
        try:
            if isinstance(value, bool):
                raise ValueError
            number: float | int
            if self.type is int:
                number = int(value, 0) if isinstance(value, str) else int(value)
                if not isinstance(value, str) and number != value:
                    raise ValueError
            else:
                number = float(value)
        except (TypeError, ValueError, OverflowError):
            kind = "a whole number" if self.type is int else "a number"
            raise ValueError(f"{self.name}: {value!r} must be {kind}") from None
        if not self.low <= number <= self.high:
            raise ValueError(f"{self.name}: {value} must be {self.range}{f' {self.unit}' if self.unit else ''}")
        return number

    def drawn(self, random: Random) -> Value:
        """Draw a permitted value: one of the choices, or the default multiplied by a power of two.

        Raises ValueError for a parameter without choices and default.
        """
        if self.choices:
            return random.choice(self.choices)
        default = self.default
        if default is None:
            raise ValueError(f"{self.name}: it has no default")
        if isinstance(default, str) or default <= 0:
            return default
        number: float = min(max(default * 2.0 ** random.uniform(-2.0, 2.0), self.low), self.high)
        return round(number) if self.type is int else number

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON: no bound is null."""
        return {
            "name": self.name, "unit": self.unit, "what": self.what, "default": self.default,
            "low": None if self.low == -inf else self.low, "high": None if self.high == inf else self.high,
            "choices": list(self.choices),
        }  # fmt: skip


#: The parameters that every fault has.
AT: Final = FaultParameter(
    "at", "s", "when it begins, after start-up; before 0: during start-up, if it is mounted by then", 0.0,
    -10.0, LONGEST_S,
)  # fmt: skip
WHEN: Final = FaultParameter(
    "when", "", "what it waits for from `at` on: frame N, order NAME, finding RULE, pose x>MM", "", type=str
)
FOR: Final = FaultParameter("for", "s", "how long it lasts; inf: to the end", inf, 0.0)
SEED: Final = FaultParameter("seed", "", "decides what is left to chance in it", 1, 0, MAX_SEED, type=int)
COMMON: Final = (AT, WHEN, FOR, SEED)


@dataclass(frozen=True, slots=True)
class FaultKind:
    """A kind of fault: its name, its description, what it needs of the board, and its parameters."""

    name: str
    sentence: str
    needs: str
    effect: type[Effect]
    own: tuple[FaultParameter, ...] = ()
    #: How often: a probability or Hz; None: always, while it lasts.
    rate: FaultParameter | None = None
    #: Whether who reads what it changed is known only of an image that was linked with `watch`.
    watch: bool = False

    @property
    def parameters(self) -> tuple[FaultParameter, ...]:
        """Its own parameters, the rate if it has one, and those of every fault."""
        return (*self.own, *(() if self.rate is None else (self.rate,)), *COMMON)

    def as_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {
            "name": self.name, "sentence": self.sentence, "needs": self.needs,
            "parameters": [parameter.as_dict() for parameter in self.parameters],
        }  # fmt: skip


@dataclass(frozen=True, slots=True)
class Fault:
    """A declared fault: its kind, and the value of each parameter by name."""

    kind: FaultKind
    values: Mapping[str, Value] = field(default_factory=dict)

    @classmethod
    def of(cls, kind: str, given: Mapping[str, Any]) -> Fault:
        """Create a fault of a kind with some of its parameters.  Raises ValueError."""
        from hil.faults.all import FAULTS

        known = FAULTS.get(kind)
        if known is None:
            raise ValueError(f"no fault {kind!r}: there are {', '.join(FAULTS)}")
        wanted = {parameter.name: parameter for parameter in known.parameters}
        values: dict[str, Value] = {}
        for name, value in given.items():
            if name not in wanted:
                raise ValueError(f"{kind}: no parameter {name!r}: there are {', '.join(wanted)}")
            try:
                values[name] = wanted[name].read(value)
            except ValueError as error:
                raise ValueError(f"{kind}: {error}") from None
        for name, parameter in wanted.items():
            if name not in values:
                if parameter.default is None:
                    raise ValueError(f"{kind}: it needs {name} ({parameter.what}: {parameter.range})")
                values[name] = parameter.default
        fault = cls(known, values)
        from hil.faults.when import check

        check(str(values["when"]))
        return fault

    @classmethod
    def from_table(cls, table: Mapping[str, Any]) -> Fault:
        """Create a fault from a TOML table: `kind`, the parameters, `for` as `for_s`.  Raises ValueError."""
        given = dict(table)
        kind = given.pop("kind", None)
        if not isinstance(kind, str):
            raise ValueError("kind is missing: name the fault (hil faults lists them)")
        if "for" in given:
            raise ValueError(f"{kind}: no parameter 'for': in a table, write for_s")
        if "for_s" in given:
            given["for"] = given.pop("for_s")
        return cls.of(kind, given)

    @property
    def lasts_s(self) -> float:
        """The duration in seconds; inf: until the end of the run."""
        return float(self.values["for"])

    def __str__(self) -> str:
        """The text that `parse` reads, without parameters that have their default."""
        defaults = {parameter.name: parameter.default for parameter in self.kind.parameters}
        said = [f"{name}={str(value).removesuffix('.0')}" for name, value in self.values.items()
                if value != defaults[name]]  # fmt: skip
        return f"{self.kind.name}:{','.join(said)}" if said else self.kind.name


def parse(text: str) -> Fault:
    """Parse a fault of the command line: `adc-bit-stuck:input=A5,bit=3,value=1,at=2,for=1`.  Raises ValueError."""
    kind, _, rest = text.strip().partition(":")
    given: dict[str, str] = {}
    for part in filter(None, (part.strip() for part in rest.split(","))):
        name, equals, value = part.partition("=")
        if not equals:
            raise ValueError(f"fault {text!r}: {part!r} is not NAME=VALUE")
        if name.strip() in given:
            raise ValueError(f"fault {text!r}: {name.strip()} is given twice")
        given[name.strip()] = value.strip()
    return Fault.of(kind.strip(), given)
