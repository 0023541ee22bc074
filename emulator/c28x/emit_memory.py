"""From typed tree to Python text: objects, elements, pointers and registers.

A check appears only where the translator cannot prove it away: an interval removes bounds, definite assignment removes
tests for never-written objects.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

from emulator.c28x import costs
from emulator.c28x.ctypes import CType, IntType, PointerType
from emulator.c28x.emit_needs import Needs, Options
from emulator.c28x.intervals import Interval
from emulator.c28x.runtime import Site
from emulator.c28x.sites import Place
from emulator.c28x.tree import (
    AddressOf,
    Binary,
    Const,
    Convert,
    Declaration,
    Expr,
    Function,
    Index,
    Load,
    LValue,
    PointerAdd,
    RegisterRef,
    Variable,
)  # fmt: skip
from emulator.c28x.tree_queries import source_text


@dataclass(frozen=True)
class Way:
    """The way to an element, as text: its scalar, its word, what tells it apart, what must hold, its subscripts."""

    leaf: str
    words: str
    key: str
    tests: str = ""
    names: str = ""


def wraps(lvalue: LValue) -> str:
    """The subscript that an unsigned operation computes, as the source says it."""
    for index in lvalue.indices:
        match index.expr:
            case Binary(ctype=IntType(signed=False), op="-" | "+" | "*") as computed:
                return source_text(computed)
    return ""


class MemoryEmitter(ABC):
    """Memory part of the emitter of one function."""

    def __init__(self, function: Function, needs: Needs, options: Options) -> None:
        self.function = function
        self.needs = needs
        self.options = options
        self.checked = options.checked
        self.numbers: dict[tuple[int, str], int] = {}
        self.cost = 0
        #: What is definitely written here: variables, and elements as (variable, index text).
        self.assigned: set[Any] | None = set()
        self.ranges: dict[Variable, Interval] = {}
        self.frame = False
        #: How many subscripts have been given a name.
        self.fresh = 0
        #: Results that are converted to a wider type after they have been computed, and remainders that are subscripts.
        self.widened: dict[int, str] = {}
        self.indexing: set[int] = set()
        #: Locals that are divided or widened somewhere in the function (None: not looked for yet).
        self.averaged: set[Variable] | None = None
        self.initials: dict[str, dict[str, Any]] = {}
        self.planted: dict[str, dict[int, Any]] = {}

    # Sites

    line = 0

    def place_number(self, kind: str = "") -> int:
        """The number of the statement that is written now; `kind` as in `Place`."""
        known = self.numbers.get((self.line, kind))
        if known is None:
            f = self.function
            place = Place(self.needs.file, self.line, f.name, f.c_file, kind=kind)
            known = self.numbers[self.line, kind] = self.needs.places.add(place)
        return known

    @abstractmethod
    def value(self, e: Expr) -> str:
        """Python text for the value of `e`."""

    @abstractmethod
    def literal(self, value: int | float) -> str:
        """Python text for a number."""

    @abstractmethod
    def interval(self, e: Expr) -> Interval:
        """Bounds of an integer expression."""

    def site(
        self, ctype: CType, name: str, declaration: Declaration | None = None, bound: int = 0, *, text: str = "",
        **more: Any,
    ) -> str:  # fmt: skip
        """A new place to report at; `more` is what only some rules need."""
        site = Site(ctype, declaration, name, bound, text)
        site.at = self.place_number()
        for attribute, known in more.items():
            setattr(site, attribute, known)
        if declaration is not None:
            site.initial = self.initials.setdefault(declaration.path, site.initial)
            site.planted = self.planted.setdefault(declaration.path, site.planted)
        return self.needs.constant("s", site)

    def base(self, variable: Variable) -> str:
        """The list that holds a memory object's scalars."""
        return variable.name if variable.kind != "global" else f"_g_{variable.declaration.module}_{variable.name}"

    def location(self, variable: Variable, words: str) -> str:
        """The address of a memory object's word, as text."""
        if variable.kind == "global":
            return f"{self.pointer_name(variable)}.addr + {words}"
        self.frame = True
        return f"_fp + {variable.frame_offset} + {words}"

    def pointer_name(self, variable: Variable) -> str:
        """The pointer to an object, made where the object is."""
        if variable.kind == "global":
            return f"_p_{variable.declaration.module}_{variable.name}"
        return f"_p_{variable.name}"

    def touched(self, text: str, variable: Variable, words: str) -> str:
        """`text`, which reads word `words` of `variable`, told to the watcher before."""
        if not self.watched(variable):
            return text
        return f"({self.touch(variable, words, write=False)} or {text})"

    def watched(self, variable: Variable) -> bool:
        """Whether accesses of `variable` are told: it is an object of the file, or a local that is pointed at."""
        return self.options.watch and (variable.kind == "global" or (variable.in_memory and variable.escapes))

    def touch(self, variable: Variable, words: str, *, write: bool) -> str:
        """What tells the watcher; its value is None."""
        return f"_c_touch({self.pointer_name(variable)}.obj, {words}, {write})"

    def bound(self, variable: Variable, index: Index) -> int:
        """The length of the array that `index` subscripts (`room` may have enlarged it)."""
        assert index.bound is not None
        if index.leaves == 1 and variable.declaration.path in self.options.room:
            return self.options.room[variable.declaration.path]
        return index.bound

    def load(self, lvalue: LValue) -> str:
        root = lvalue.root
        if isinstance(root, Expr):
            self.cost += costs.POINTER + costs.LOAD_MEMORY
            site = self.site(lvalue.ctype, self.describe(root), text=lvalue.text, wraps=wraps(lvalue))
            return f"_c_load({self.value(root)}, {self.offset_words(lvalue)}, {site})"
        if not root.in_memory and root.kind != "global":
            self.cost += costs.LOAD
            return self.defined(root.name, root, root, "0")
        self.cost += costs.LOAD_MEMORY
        data = self.base(root)
        if not lvalue.indices:
            word = str(lvalue.words)
            text = self.defined(f"{data}[{lvalue.leaf}]", root, (root, str(lvalue.leaf)), word, lvalue)
            return self.touched(text, root, word)
        if len(lvalue.indices) > 1:
            return self.load_deep(lvalue, root)
        index = lvalue.indices[0]
        self.cost += costs.INDEX
        text = self.index_value(index.expr)
        low, high = self.interval(index.expr)
        limit = self.bound(root, index)
        if low >= 0 and high < limit and not self.watched(root):
            place = self.leaf_text(text, index.leaves, lvalue.leaf)
            words = f"({text}) * {index.words} + {lvalue.words}"
            return self.defined(f"{data}[{place}]", root, (root, place), words, lvalue)
        place = self.leaf_text("_i", index.leaves, lvalue.leaf)
        key = (root, self.leaf_text(text, index.leaves, lvalue.leaf))
        word = f"_i * {index.words} + {lvalue.words}"
        inner = self.touched(self.defined(f"{data}[{place}]", root, key, word, lvalue), root, word)
        site = self.element_site(lvalue, root, limit)
        base = self.location(root, str(lvalue.words))
        outside = f"_c_oob_load({site}, _i, {index.words}, {base})"
        test = f"0 <= (_i := {text}) < {limit}" if low < 0 else f"(_i := {text}) < {limit}"
        return f"({inner} if {test} else {outside})"

    def element_site(self, lvalue: LValue, root: Variable, limit: int = 0) -> str:
        """A place to report an element at, with what its neighbours are."""
        frame = None if root.kind == "global" else (self.function, root.frame_offset + lvalue.words)
        dimensions = tuple((self.bound(root, index), index.words) for index in lvalue.indices)
        return self.site(
            lvalue.ctype, root.declaration.path, root.declaration, limit, text=lvalue.text, frame=frame,
            dimensions=dimensions, word=lvalue.words, wraps=wraps(lvalue),
        )  # fmt: skip

    def load_deep(self, lvalue: LValue, root: Variable) -> str:
        """More than one subscript: each is held against its own dimension."""
        way = self.subscripts(lvalue, root)
        text = self.defined(f"{self.base(root)}[{way.leaf}]", root, (root, way.key), way.words, lvalue)
        text = self.touched(text, root, way.words)
        if not way.tests:
            return text
        base, site = self.location(root, "0"), self.element_site(lvalue, root)
        return f"({text} if {way.tests} else _c_oob_deep_load({site}, {self.base(root)}, ({way.names},), {base}))"

    def subscripts(self, lvalue: LValue, root: Variable) -> Way:
        """The way to an element by several subscripts, each evaluated once."""
        self.cost += costs.INDEX * len(lvalue.indices)
        texts = [self.index_value(index.expr) for index in lvalue.indices]
        intervals = [self.interval(index.expr) for index in lvalue.indices]
        limits = [self.bound(root, index) for index in lvalue.indices]
        key = " + ".join(
            [*(self.leaf_text(t, i.leaves, 0) for t, i in zip(texts, lvalue.indices, strict=True)), str(lvalue.leaf)]
        )
        if not self.watched(root) and all(
            low >= 0 and high < limit for (low, high), limit in zip(intervals, limits, strict=True)
        ):
            words = " + ".join(f"({t}) * {i.words}" for t, i in zip(texts, lvalue.indices, strict=True))
            return Way(key, f"{words} + {lvalue.words}", key)
        names, tests = [], []
        for text, (low, _), limit in zip(texts, intervals, limits, strict=True):
            self.fresh += 1
            names.append(f"_i{self.fresh}")
            tests.append(f"({'0 <= ' if low < 0 else ''}({names[-1]} := {text}) < {limit})")
        leaf = " + ".join(
            [*(self.leaf_text(n, i.leaves, 0) for n, i in zip(names, lvalue.indices, strict=True)), str(lvalue.leaf)]
        )
        words = " + ".join(f"{n} * {i.words}" for n, i in zip(names, lvalue.indices, strict=True))
        # All of them are evaluated, whatever the first is: `&`, not `and`.
        return Way(leaf, f"{words} + {lvalue.words}", key, " & ".join(tests), ", ".join(names))

    @abstractmethod
    def index_value(self, e: Expr) -> str:
        """Python text for the value of a subscript."""

    def leaf_text(self, index: str, stride: int, leaf: int) -> str:
        text = index if stride == 1 else f"{index} * {stride}"
        return f"{text} + {leaf}" if leaf else text

    def offset_words(self, lvalue: LValue) -> str:
        """The distance of an lvalue from its root in words."""
        terms = [f"{self.member_index(lvalue, i)} * {i.words}" for i in lvalue.indices]
        if lvalue.words or not terms:
            terms.append(str(lvalue.words))
        return " + ".join(terms)

    def member_index(self, lvalue: LValue, index: Index) -> str:
        """A subscript behind a pointer, held against the array member that it is meant for."""
        text, root = self.index_value(index.expr), lvalue.root
        low, high = self.interval(index.expr)
        if not self.checked or index.bound is None or not isinstance(root, Expr) or (low >= 0 and high < index.bound):
            return text
        site = self.site(lvalue.ctype, self.describe(root), bound=index.bound, text=lvalue.text, wraps=wraps(lvalue))
        return f"_c_member_index({text}, {site})"

    def defined(self, text: str, root: Variable, key: Any, words: str, lvalue: LValue | None = None) -> str:
        """`text`, with a test for never-written where that is possible."""
        if not self.checked or root.kind == "parameter":
            return text
        if root.initialised and not (root.in_memory or root.kind == "global"):
            return text
        if root.initialised and not root.escapes:
            return text
        if self.assigned is None or key in self.assigned or (root in self.assigned and not root.escapes):
            return text
        ctype = lvalue.ctype if lvalue is not None else root.ctype
        name = root.declaration.path
        site = self.site(ctype, name, root.declaration, text=lvalue.text if lvalue is not None else "")
        where = "" if words == "0" else f", {words}"
        if self.options.residue and root.kind != "global":
            where = f", {words}, {self.location(root, words)}"
        if text.isidentifier():
            if self.renewed(root):
                return f"({text} if {text} is not None else _c_stale({site}, _old_{text}{where}))"
            return f"({text} if {text} is not None else _c_uninit({site}{where}))"
        return f"(_u if (_u := {text}) is not None else _c_uninit({site}{where}))"

    def renewed(self, variable: Variable) -> bool:
        """Whether a local begins anew, without a value, each time that its inner block is entered."""
        return variable.nested and not variable.in_memory and not variable.initialised

    def address(self, lvalue: LValue) -> str:
        self.cost += costs.POINTER
        root = lvalue.root
        if isinstance(root, Expr):
            whole = not lvalue.indices and not lvalue.words
            if whole and isinstance(root.ctype, PointerType) and root.ctype.target == lvalue.ctype:
                return self.value(root)
            base = self.value(root)
        else:
            base = self.pointer_name(root)
        target = getattr(lvalue.ctype, "element", lvalue.ctype)
        type_name = self.needs.constant("t", target, ("type", target.name, type(target).__name__))
        return f"_c_address({base}, {self.offset_words(lvalue)}, {type_name})"

    def describe(self, e: Expr) -> str:
        """The name of a pointer expression for a report."""
        match e:
            case Load(lvalue=LValue(root=Variable() as variable)):
                return variable.declaration.path
            case PointerAdd(pointer=pointer) | Convert(operand=pointer):
                return self.describe(pointer)
            case AddressOf(lvalue=LValue(root=Variable() as variable)):
                return variable.declaration.path
        return "pointer"

    # Registers

    def register_load(self, ref: RegisterRef) -> str:
        self.cost += costs.REGISTER
        if self.needs.looked_at(ref.block, ref.register):
            word = f"{self.needs.register(ref, 'source')}.value"
        else:
            word = f"{self.needs.register(ref, 'read')}()"
        if ref.field is None:
            return word
        self.cost += costs.REGISTER_FIELD
        shift = f" >> {ref.field.lo}" if ref.field.lo else ""
        return f"({word}{shift} & {(1 << ref.field.width) - 1})"

    def register_store(self, ref: RegisterRef, value: Expr) -> str:
        """The statement that writes a register or field."""
        self.cost += costs.REGISTER
        if ref.field is None:
            return f"{self.needs.register(ref, 'write')}({self.value(value)}, {0xFFFFFFFF})"
        self.cost += costs.REGISTER + costs.REGISTER_FIELD
        f = ref.field
        keep = ((1 << ref.bits) - 1) & ~f.mask
        if isinstance(value, Const):
            bits = str(int(value.value) << f.lo & f.mask)
        else:
            bits = self.value(value)
            low, high = self.interval(value)
            if f.lo:
                bits = f"{bits} << {f.lo}"
            if low < 0 or high << f.lo > f.mask:
                bits = f"{bits} & {f.mask}"
        if ref.reads_zero:
            return f"{self.needs.register(ref, 'write')}({bits}, {f.lane})"
        return f"{self.needs.register(ref, 'modify')}({keep}, {bits}, {f.lane})"
