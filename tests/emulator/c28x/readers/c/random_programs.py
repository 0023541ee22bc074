"""Random C, free of undefined and of unspecified behaviour by construction.

Every expression is made with its type and the interval that holds its value, by C's rules for a 16-bit int: signed
arithmetic that could leave its type is done in the unsigned type, divisors are made positive, counts of shifts are
masked, indices too.  Within one full expression an object that is changed is named once, and functions that are called
there read nothing but their parameters and constants.  Every object has a start value, every loop a limit.

A program leaves a trace: `run()` fills an array, whose elements `at(i)` returns.  All its names begin with a prefix, so
that many programs make one file.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

#: Values that a program leaves.
TRACE: Final = 6


@dataclass(frozen=True)
class Type:
    """An integer type at the widths of the chip."""

    name: str
    bits: int
    signed: bool

    @property
    def low(self) -> int:
        """The smallest value."""
        return -(1 << self.bits - 1) if self.signed else 0

    @property
    def high(self) -> int:
        """The largest value."""
        return (1 << self.bits - self.signed) - 1


INT: Final = Type("int", 16, True)
UINT: Final = Type("unsigned int", 16, False)
LONG: Final = Type("long", 32, True)
ULONG: Final = Type("unsigned long", 32, False)
LONG_LONG: Final = Type("long long", 64, True)
ULONG_LONG: Final = Type("unsigned long long", 64, False)
CHAR: Final = Type("char", 16, True)
UCHAR: Final = Type("unsigned char", 16, False)
SHORT: Final = Type("short", 16, True)
TYPES: Final = (INT, INT, UINT, UINT, LONG, ULONG, LONG_LONG, ULONG_LONG, CHAR, UCHAR, SHORT)
_PROMOTED: Final = {(16, True): INT, (16, False): UINT, (32, True): LONG, (32, False): ULONG,
                    (64, True): LONG_LONG, (64, False): ULONG_LONG}  # fmt: skip
_UNSIGNED: Final = {INT: UINT, LONG: ULONG, LONG_LONG: ULONG_LONG}


@dataclass(frozen=True)
class Value:
    """An expression in C: its text, its type, and bounds of its value."""

    text: str
    ctype: Type
    low: int
    high: int


@dataclass(frozen=True)
class Place:
    """Something that can be assigned to; `name` is the object whose naming is watched for order."""

    text: str
    ctype: Type
    name: str


def promoted(v: Value) -> Value:
    """The value as an operand: bit-fields and small types become int or unsigned int."""
    return converted(v, INT if v.ctype.bits < 16 else _PROMOTED[v.ctype.bits, v.ctype.signed])


def usual(a: Type, b: Type) -> Type:
    """The common type of two promoted operands."""
    if a.bits != b.bits:
        return a if a.bits > b.bits else b
    return a if not a.signed else b


def converted(v: Value, ctype: Type) -> Value:
    """The bounds behind a conversion; the text says nothing of it."""
    inside = ctype.low <= v.low and v.high <= ctype.high
    return Value(v.text, ctype, v.low if inside else ctype.low, v.high if inside else ctype.high)


def cast(v: Value, ctype: Type) -> Value:
    """`(type)v`."""
    return converted(Value(f"({ctype.name})({v.text})", v.ctype, v.low, v.high), ctype)


def constant(value: int, ctype: Type) -> Value:
    """A constant of just that type."""
    suffix = {16: "", 32: "L", 64: "LL"}[ctype.bits]
    if not ctype.signed:
        return Value(f"{value}U{suffix}", ctype, value, value)
    if value == ctype.low:
        return Value(f"(-{ctype.high}{suffix} - 1)", ctype, value, value)
    text = f"{value}{suffix}" if value >= 0 else f"(-{-value}{suffix})"
    return Value(text, ctype, value, value)


class Generator:
    """Writes one program."""

    def __init__(self, seed: int, prefix: str) -> None:
        self.rng = random.Random(seed)
        self.p = prefix
        self.lines: list[str] = []
        self.depth = 0
        self.loops = 0
        self.counter = 0
        #: What may be read, and what may be assigned to, where the next statement stands.
        self.readable: list[Place] = []
        self.writable: list[Place] = []
        self.counters: list[Value] = []
        #: Names already used in the full expression that is being made; those that it changes.
        self.named: set[str] = set()
        self.changed: set[str] = set()
        self.effects = False
        self.pure: list[tuple[str, Type, tuple[Type, ...]]] = []
        self.tables: list[tuple[str, Type, tuple[Type, ...], int]] = []
        self.acting: list[tuple[str, Type, tuple[Type, ...]]] = []

    def fresh(self, stem: str) -> str:
        """A name that is used nowhere else."""
        self.counter += 1
        return f"{self.p}{stem}{self.counter}"

    # Expressions

    def number(self, ctype: Type) -> Value:
        """A constant, often at an edge."""
        edges = (0, 1, 2, 7, 255, 256, ctype.high, ctype.high - 1, ctype.low, ctype.high // 2)
        rng = self.rng
        value = rng.choice(edges) if rng.random() < 0.4 else rng.randint(ctype.low, ctype.high) >> rng.randrange(16)
        return constant(value, _PROMOTED[ctype.bits, ctype.signed])

    def leaf(self) -> Value:
        """An object, a counter or a constant."""
        free = [place for place in self.readable if place.name not in self.changed]
        choice = self.rng.random()
        if choice < 0.12 and self.counters:
            return self.rng.choice(self.counters)
        if choice < 0.75 and free:
            place = self.rng.choice(free)
            self.named.add(place.name)
            return Value(place.text, place.ctype, place.ctype.low, place.ctype.high)
        return self.number(self.rng.choice(TYPES))

    def value(self, depth: int) -> Value:
        """An expression of at most that depth."""
        if depth <= 0:
            return self.leaf()
        make: Callable[[int], Value] = self.rng.choices(
            (lambda d: self.leaf(), self.arithmetic, self.quotient, self.bits, self.shift, self.comparison, self.logic,
             self.unary, self.conversion, self.choice, self.call, self.effect, self.comma),
            (10, 22, 7, 12, 8, 8, 6, 6, 6, 6, 6, 8 if self.effects else 0, 1),
        )[0]  # fmt: skip
        return make(depth - 1)

    def pair(self, depth: int) -> tuple[Value, Value, Type]:
        """Two operands in parentheses, and their common type."""
        a, b = promoted(self.value(depth)), promoted(self.value(depth))
        return a, b, usual(a.ctype, b.ctype)

    def arithmetic(self, depth: int) -> Value:
        """+, -, *: in the unsigned type where the signed one might not hold the result."""
        a, b, ctype = self.pair(depth)
        operator = self.rng.choice("+-*")
        a, b = converted(a, ctype), converted(b, ctype)
        ends = {
            "+": (a.low + b.low, a.high + b.high),
            "-": (a.low - b.high, a.high - b.low),
            "*": (min(x * y for x in (a.low, a.high) for y in (b.low, b.high)),
                  max(x * y for x in (a.low, a.high) for y in (b.low, b.high))),
        }[operator]  # fmt: skip
        text = f"({a.text} {operator} {b.text})"
        if ctype.low <= ends[0] and ends[1] <= ctype.high:
            return Value(text, ctype, *ends)
        if ctype.signed:
            u = _UNSIGNED[ctype].name
            text = f"(({ctype.name})(({u}){a.text} {operator} ({u}){b.text}))"
        return Value(text, ctype, ctype.low, ctype.high)

    def quotient(self, depth: int) -> Value:
        """/ and %: by a constant or by something masked and incremented, so that it is positive."""
        a = promoted(self.value(depth))
        if self.rng.random() < 0.5:
            b = constant(self.rng.choice((2, 3, 7, 10, 100, 255, 1000, 32767)), INT)
        else:
            b = promoted(self.value(depth))
            mask = self.rng.choice((7, 15, 255, 1023))
            b = Value(f"(({b.text} & {mask}) + 1)", b.ctype, 1, mask + 1)
        if self.rng.random() < 0.2 and a.low > a.ctype.low and a.ctype.signed and b.ctype.signed:
            b = Value(f"(-{b.text})", b.ctype, -b.high, -b.low)
        ctype = usual(a.ctype, b.ctype)
        a, b = converted(a, ctype), converted(b, ctype)
        if self.rng.random() < 0.5:
            limit = max(abs(a.low), abs(a.high))
            low = -limit if a.low < 0 or b.low < 0 else 0
            return Value(f"({a.text} / {b.text})", ctype, max(low, ctype.low), min(limit, ctype.high))
        limit = max(abs(b.low), abs(b.high)) - 1
        return Value(f"({a.text} % {b.text})", ctype, -limit if a.low < 0 else 0, limit)

    def bits(self, depth: int) -> Value:
        """&, |, ^."""
        a, b, ctype = self.pair(depth)
        a, b = converted(a, ctype), converted(b, ctype)
        operator = self.rng.choice("&|^")
        low, high = ctype.low, ctype.high
        if a.low >= 0 and b.low >= 0:
            low, high = 0, (1 << max(a.high, b.high).bit_length()) - 1
        elif operator == "&" and max(a.low, b.low) >= 0:
            low, high = 0, a.high if a.low >= 0 else b.high
        return Value(f"({a.text} {operator} {b.text})", ctype, low, high)

    def shift(self, depth: int) -> Value:
        """<< and >>: a signed value is shifted left in the unsigned type."""
        a = promoted(self.value(depth))
        ctype = a.ctype
        if self.rng.random() < 0.6:
            count = constant(self.rng.randrange(ctype.bits), self.rng.choice((INT, UINT, LONG)))
        else:
            n = self.value(depth)
            count = Value(f"({n.text} & {ctype.bits - 1})", n.ctype, 0, ctype.bits - 1)
        if self.rng.random() < 0.5:
            return Value(f"({a.text} >> {count.text})", ctype, min(a.low, 0), max(a.high, 0))
        if ctype.signed:
            text = f"(({ctype.name})(({_UNSIGNED[ctype].name}){a.text} << {count.text}))"
        else:
            text = f"({a.text} << {count.text})"
        return Value(text, ctype, ctype.low, ctype.high)

    def comparison(self, depth: int) -> Value:
        """A comparison: 0 or 1."""
        a, b, _ = self.pair(depth)
        return Value(f"({a.text} {self.rng.choice(('<', '<=', '>', '>=', '==', '!='))} {b.text})", INT, 0, 1)

    def logic(self, depth: int) -> Value:
        """&&, || and !."""
        a = self.value(depth)
        if self.rng.random() < 0.2:
            return Value(f"(!{a.text})", INT, 0, 1)
        return Value(f"({a.text} {self.rng.choice(('&&', '||'))} {self.value(depth).text})", INT, 0, 1)

    def unary(self, depth: int) -> Value:
        """- and ~."""
        a = promoted(self.value(depth))
        ctype = a.ctype
        if self.rng.random() < 0.5:
            low, high = (~a.high, ~a.low) if ctype.signed else (ctype.low, ctype.high)
            return Value(f"(~{a.text})", ctype, low, high)
        if not ctype.signed:
            return Value(f"(- {a.text})", ctype, ctype.low, ctype.high)
        if a.low > ctype.low:
            return Value(f"(- {a.text})", ctype, -a.high, -a.low)
        return Value(f"(({ctype.name})(- ({_UNSIGNED[ctype].name}){a.text}))", ctype, ctype.low, ctype.high)

    def conversion(self, depth: int) -> Value:
        """A cast."""
        v = cast(self.value(depth), self.rng.choice(TYPES))
        return Value(f"({v.text})", v.ctype, v.low, v.high)

    def choice(self, depth: int) -> Value:
        """?:"""
        test = self.value(depth)
        a, b, ctype = self.pair(depth)
        a, b = converted(a, ctype), converted(b, ctype)
        return Value(f"({test.text} ? {a.text} : {b.text})", ctype, min(a.low, b.low), max(a.high, b.high))

    def comma(self, depth: int) -> Value:
        """A comma whose left side changes something, or is not needed."""
        left = self.effect(depth) if self.effects else cast(self.value(0), INT)
        right = self.value(depth)
        return Value(f"({left.text}, {right.text})", right.ctype, right.low, right.high)

    def call(self, depth: int) -> Value:
        """A call of a function without effects, by name or through a table."""
        if self.tables and self.rng.random() < 0.3:
            table, result, parameters, size = self.rng.choice(self.tables)
            name = f"{table}[{self.value(depth - 1).text} & {size - 1}]"
        elif self.pure:
            name, result, parameters = self.rng.choice(self.pure)
        else:
            return self.leaf()
        arguments = ", ".join(self.value(min(depth, 1)).text for _ in parameters)
        return Value(f"{name}({arguments})", result, result.low, result.high)

    def effect(self, depth: int) -> Value:
        """An assignment, op=, ++ or -- of an object that the full expression names nowhere else."""
        free = [place for place in self.writable if place.name not in self.named | self.changed]
        if not free:
            return self.leaf()
        place = self.rng.choice(free)
        self.changed.add(place.name)
        ctype = place.ctype
        whole = (ctype.low, ctype.high)
        if not ctype.signed and self.rng.random() < 0.5:
            text = self.rng.choice(("({}++)", "({}--)", "(++{})", "(--{})")).format(place.text)
            return Value(text, ctype, *whole)
        return Value(f"({self.assignment(place, depth)})", ctype, *whole)

    def assignment(self, place: Place, depth: int) -> str:
        """`place = ...` or `place op= ...`."""
        v = self.value(depth)
        if self.rng.random() < 0.5:
            return f"{place.text} = {v.text}"
        own = _PROMOTED[place.ctype.bits, place.ctype.signed]
        v = promoted(v)
        common = usual(own, v.ctype)
        operator = self.rng.choice(("+", "-", "*", "&", "|", "^", "<<", ">>", "/", "%"))
        match operator:
            case "+" | "-" | "*" if common.signed:
                text = cast(v, _UNSIGNED[common]).text
            case "<<" if own.signed:
                return f"{place.text} ^= {v.text}"
            case "<<" | ">>":
                text = f"({v.text} & {own.bits - 1})"
            case "/" | "%":
                text = f"(({v.text} & 255) + 1)"
            case _:
                text = v.text
        return f"{place.text} {operator}= {text}"

    def full(self, depth: int, *, effects: bool = False, without: str = "") -> Value:
        """A full expression."""
        self.named, self.changed = set(), {without} if without else set()
        self.effects = effects
        v = self.value(depth)
        self.effects = False
        return v

    # Statements

    def line(self, text: str) -> None:
        """Write a line at the present depth."""
        self.lines.append("    " * self.depth + text)

    def block(self, statements: int, leave: str = "") -> None:
        """Statements within braces, with locals of their own; `leave` is what may leave the loop around."""
        known = len(self.readable), len(self.writable)
        self.depth += 1
        if self.rng.random() < 0.4:
            self.local()
        for _ in range(statements):
            self.statement(leave)
        self.depth -= 1
        del self.readable[known[0] :], self.writable[known[1] :]

    def local(self, *, static: bool = True) -> None:
        """A local with a start value, sometimes static, where calls have an order: that one begins with a constant."""
        ctype, name = self.rng.choice(TYPES), self.fresh("x")
        if static and self.rng.random() < 0.2:
            self.line(f"static {ctype.name} {name} = {self.number(ctype).text};")
        else:
            self.line(f"{ctype.name} {name} = {self.full(2).text};")
        place = Place(name, ctype, name)
        self.readable.append(place)
        self.writable.append(place)

    def statement(self, leave: str = "") -> None:
        """One statement; few within loops and deep blocks, so that a program ends soon."""
        deep = self.depth > 4
        make: Callable[[str], None] = self.rng.choices(
            (self.assign, self.expression, self.branch, self.loop, self.switch, self.walk, self.copy, self.act,
             self.jump),
            (30, 14, 0 if deep else 12, 0 if deep or self.loops > 1 else 10, 0 if deep else 9, 5, 4, 6,
             3 if leave else 0),
        )[0]  # fmt: skip
        make(leave)

    def assign(self, leave: str) -> None:
        """An assignment; its value may have effects on other objects."""
        place = self.rng.choice(self.writable)
        self.named, self.changed = {place.name}, set()
        self.effects = self.rng.random() < 0.3
        text = self.assignment(Place(place.text, place.ctype, place.name), 3)
        self.effects = False
        if place.name in self.changed:
            raise AssertionError("an object is changed twice in one expression")
        self.line(f"{text};")

    def expression(self, leave: str) -> None:
        """x = y = ..., or an effect that stands alone."""
        self.named, self.changed, self.effects = set(), set(), True
        text = self.effect(3).text
        if self.rng.random() < 0.5:
            free = [place for place in self.writable if place.name not in self.named | self.changed]
            if free:
                text = f"{self.rng.choice(free).text} = {text}"
        self.effects = False
        self.line(f"{text};")

    def branch(self, leave: str) -> None:
        """if, else if, else."""
        self.line(f"if ({self.full(3, effects=self.rng.random() < 0.3).text}) {{")
        self.block(self.rng.randint(1, 3), leave)
        if self.rng.random() < 0.3:
            self.line(f"}} else if ({self.full(2).text}) {{")
            self.block(self.rng.randint(1, 2), leave)
        if self.rng.random() < 0.5:
            self.line("} else {")
            self.block(self.rng.randint(1, 2), leave)
        self.line("}")

    def loop(self, leave: str) -> None:
        """for, while, do: with a counter that nothing else changes."""
        i, ctype, n = self.fresh("i"), self.rng.choice((INT, UINT, LONG, UCHAR)), self.rng.randint(1, 5)
        count = Value(i, ctype, 0, n)
        kind = self.rng.randrange(5)
        step = self.rng.choice((f"{i}++", f"++{i}", f"{i} += 1"))
        self.line(f"{ctype.name} {i} = {n if kind in (3, 4) else 0};")
        heads = (
            f"for ({i} = 0; {i} < {n}; {step}) {{", f"for ({i} = {n}; {i} > 0; {i}--) {{", f"while ({i}++ < {n}) {{",
            f"while ({i}-- > 0) {{", "do {",
        )  # fmt: skip
        if kind == 3:
            count = Value(i, ctype, ctype.low, ctype.high)
        self.line(heads[kind])
        self.loops += 1
        self.counters.append(count)
        self.block(self.rng.randint(1, 3), "loop")
        self.counters.pop()
        self.loops -= 1
        self.line(f"}} while (--{i} > 0);" if kind == 4 else "}")

    def jump(self, leave: str) -> None:
        """break or continue, under a condition."""
        self.line(f"if ({self.full(2).text})")
        self.line("    " + self.rng.choice(("break;", "continue;") if leave == "loop" else ("break;",)))

    def switch(self, leave: str) -> None:
        """A switch over a few values; some cases fall through, some break in an if."""
        mask = self.rng.choice((3, 7))
        self.line(f"switch ({self.full(2, effects=self.rng.random() < 0.2).text} & {mask}) {{")
        labels = self.rng.sample(range(mask + 1), self.rng.randint(2, 4))
        default = self.rng.randrange(len(labels) + 2)
        for number, label in enumerate(labels):
            if number == default:
                self.line("default:")
            self.line(f"case {label}:")
            if self.rng.random() < 0.2:
                continue
            self.line("{")
            # A continue within a switch belongs to the loop around, if there is one.
            self.block(self.rng.randint(1, 2), "loop" if leave == "loop" else "switch")
            self.line("}")
            if self.rng.random() < 0.6:
                self.line("    break;")
        self.line("    ;" if default != len(labels) else "default:\n" + "    " * self.depth + "    ;")
        self.line("}")

    def walk(self, leave: str) -> None:
        """A pointer that walks over an array, reading and writing."""
        array, ctype = f"{self.p}v", INT
        p, q = self.fresh("p"), self.fresh("q")
        start, other = self.rng.randrange(3), self.rng.randrange(3)
        self.line("{")
        self.depth += 1
        self.line(f"{ctype.name} *{p} = {array} + {start};")
        self.line(f"const {ctype.name} *{q} = &{self.p}c[{other}];")
        for _ in range(self.rng.randint(1, 3)):
            self.line(self.rng.choice((
                f"*{p}++ = *{q}++;", f"*{p} ^= *{q}++;", f"*++{p} = {self.full(2).text};",
                f"*{p}++ = ({ctype.name})({self.full(2).text});", f"{self.p}u += (unsigned int)({p} - {array});",
                f"{self.p}u ^= {q}[1];", f"{p}[1] = {p}[0];",
            )))  # fmt: skip
        self.depth -= 1
        self.line("}")

    def copy(self, leave: str) -> None:
        """Structures, copied as a whole or passed by value."""
        s, rng = f"{self.p}s", self.rng
        i, k = rng.randrange(3), rng.randrange(3)
        self.line(rng.choice((
            f"{s}[{i}] = {s}[{k}];", f"{self.p}o = {s}[{k}];", f"*{self.p}ps = {self.p}o;",
            f"{self.p}ps = &{s}[{k}];", f"{self.p}ps = {s} + ((unsigned int){self.full(1).text} % 3U);",
            f"{s}[{i}] = {self.p}made({self.full(1).text}, {s}[{k}]);",
        )))  # fmt: skip

    def act(self, leave: str) -> None:
        """A call of a function that changes objects of the file: it stands alone."""
        if not self.acting:
            return self.assign(leave)
        name, _, parameters = self.rng.choice(self.acting)
        self.named, self.changed, self.effects = set(), set(), False
        arguments = ", ".join(self.value(1).text for _ in parameters)
        target = self.rng.choice([place for place in self.writable if place.text == place.name])
        self.line(f"{target.text} = {name}({arguments});")
        return None

    # The program

    def program(self) -> str:
        """The whole text."""
        p = self.p
        self.declarations()
        for _ in range(self.rng.randint(1, 3)):
            self.function(acting=False)
        self.table()
        self.made()
        objects = list(self.readable), list(self.writable)
        for _ in range(self.rng.randint(0, 2)):
            self.function(acting=True)
        self.line(f"void {p}run(void)")
        self.line("{")
        for k in range(TRACE):
            self.block(self.rng.randint(2, 4))
            self.line(f"    {p}mix();")
            self.line(f"    {p}trace[{k}] = {p}sum;")
            self.readable, self.writable = list(objects[0]), list(objects[1])
        self.line("}")
        self.line(f"unsigned long {p}at(int i)\n{{\n    return {p}trace[i];\n}}")
        return "\n".join(self.lines) + "\n"

    def declarations(self) -> None:
        """Objects of the file, and the function that folds them into the sum."""
        p, rng = self.p, self.rng
        mixed: list[str] = []
        for _ in range(rng.randint(5, 9)):
            ctype, name = rng.choice(TYPES), self.fresh("g")
            word = rng.choice(("", "", "static ", "volatile "))
            self.line(f"{word}{ctype.name} {name} = {self.number(ctype).text};")
            self.add(Place(name, ctype, name))
            mixed.append(name)
        values = ", ".join(self.number(INT).text for _ in range(8))
        self.line(f"static int {p}v[8] = {{ {values} }};")
        values = ", ".join(self.number(INT).text for _ in range(rng.randint(3, 8)))
        self.line(f"static const int {p}c[8] = {{ {values} }};")
        self.line(f"static unsigned long {p}m[2][3] = {{ {{ 1, 2 }}, {{ 3 }} }};")
        self.line(f"static unsigned int {p}u = 0;")
        self.line(f"struct {p}t {{\n    int a;\n    unsigned long b;\n    unsigned char c[3];\n    long long d;")
        self.line("    unsigned int e : 5;\n    int : 3;\n    unsigned int f : 7;\n    signed int h : 6;\n};")
        self.line(f"static struct {p}t {p}s[3] = {{ {{ 1, 2, {{ 3, 4, 5 }}, 6, 7, 8, -9 }}, {{ .d = -1, .a = 5 }} }};")
        self.line(f"static struct {p}t {p}o = {{ 0 }};")
        self.line(f"static struct {p}t *{p}ps = &{p}s[1];")
        self.line(f"static unsigned long {p}sum = 2166136261UL;\nstatic unsigned long {p}trace[{TRACE}];")
        five, seven, six = Type("", 5, False), Type("", 7, False), Type("", 6, True)
        for k in (0, 3, 7):
            self.add(Place(f"{p}v[{k}]", INT, f"{p}v"))
        self.readable.append(Place(f"{p}c[2]", INT, f"{p}c"))
        self.readable.append(Place(f"{p}v[{p}u & 7]", INT, f"{p}v"))
        self.add(Place(f"{p}m[1][{p}u & 1]", ULONG, f"{p}m"))
        self.add(Place(f"{p}m[0][2]", ULONG, f"{p}m"))
        for base, name in ((f"{p}s[1].", f"{p}s"), (f"{p}o.", f"{p}o"), (f"{p}ps->", f"{p}s")):
            for member, ctype in (("a", INT), ("b", ULONG), ("c[1]", UCHAR), ("d", LONG_LONG)):
                self.add(Place(base + member, ctype, name))
            for member, ctype in (("e", five), ("f", seven), ("h", six)):
                self.readable.append(Place(base + member, ctype, name))
        self.line(f"static void {p}add(unsigned long x)\n{{\n    {p}sum = ({p}sum ^ x) * 16777619UL;\n}}")
        self.line(f"static void {p}mix(void)\n{{\n    int i;")
        for name in mixed:
            self.line(f"    {p}add((unsigned long){name});\n    {p}add((unsigned long)({name} >> 8));")
        self.line(f"    for (i = 0; i < 8; i++)\n        {p}add((unsigned long){p}v[i]);")
        self.line(f"    for (i = 0; i < 6; i++)\n        {p}add({p}m[i / 3][i % 3]);")
        self.line(f"    for (i = 0; i < 3; i++) {{\n        const struct {p}t *q = &{p}s[i];")
        self.line(f"        {p}add((unsigned long)q->a);\n        {p}add(q->b);\n        {p}add(q->c[1]);")
        self.line(f"        {p}add((unsigned long)q->d);\n        {p}add((unsigned long)(q->d >> 32));")
        self.line(f"        {p}add(q->e);\n        {p}add(q->f);\n        {p}add((unsigned long)(long)q->h);\n    }}")
        self.line(f"    {p}add({p}u);\n    {p}add((unsigned long)({p}ps - {p}s));\n}}")

    def add(self, place: Place) -> None:
        """Something that can be read and written."""
        self.readable.append(place)
        self.writable.append(place)

    def function(self, *, acting: bool) -> None:
        """A function: of its parameters alone, or one that changes objects of the file."""
        name, result = self.fresh("f"), self.rng.choice(TYPES)
        parameters = [(self.fresh("a"), self.rng.choice(TYPES)) for _ in range(self.rng.randint(1, 3))]
        outside = self.readable, self.writable
        own = [Place(n, t, n) for n, t in parameters]
        self.readable = [*outside[0], *own] if acting else list(own)
        self.writable = [*outside[1], *own] if acting else list(own)
        declared = ", ".join(f"{t.name} {n}" for n, t in parameters)
        self.line(f"static {result.name} {name}({declared})")
        self.line("{")
        self.depth += 1
        self.local(static=acting)
        if acting:
            self.statement()
        for _ in range(self.rng.randint(1, 2)):
            self.assign("")
        self.line(f"return {self.full(3).text};")
        self.depth -= 1
        self.line("}")
        self.readable, self.writable = outside
        (self.acting if acting else self.pure).append((name, result, tuple(t for _, t in parameters)))

    def table(self) -> None:
        """Two functions of one type and a table of them."""
        p = self.p
        names = [self.fresh("h"), self.fresh("h")]
        outside = self.readable, self.writable
        for name in names:
            self.readable = [Place("a", INT, "a"), Place("b", ULONG, "b")]
            self.line(f"static long {name}(int a, unsigned long b)\n{{\n    return {self.full(2).text};\n}}")
        self.readable, self.writable = outside
        self.line(f"static long (*const {p}table[])(int, unsigned long) = {{ {', '.join(names)} }};")
        self.tables.append((f"{p}table", LONG, (INT, ULONG), 2))

    def made(self) -> None:
        """A function with a structure as parameter and result."""
        p = self.p
        outside = self.readable, self.writable
        self.readable = [Place("x", LONG, "x"), Place("s.a", INT, "s"), Place("s.b", ULONG, "s")]
        self.line(f"static struct {p}t {p}made(long x, struct {p}t s)\n{{")
        self.line(f"    s.a = {self.full(2).text};\n    s.d += (unsigned long long){self.full(1).text};")
        self.line(f"    s.e = {self.full(1).text};\n    s.h = {self.full(1).text};\n    return s;\n}}")
        self.readable, self.writable = outside


def program(seed: int, prefix: str = "p_") -> str:
    """The program number `seed`."""
    return Generator(seed, prefix).program()
