"""`string.h` of the run-time support library: functions on blocks of memory and on strings.

Sizes are in 16-bit words; a character takes one word.  Cycles are CHOICE, in the order of magnitude of the library.
Not modelled: `strtok`, `strspn`, `strcspn`, `strpbrk`, `strerror`, locales.
"""

from __future__ import annotations

from math import inf
from typing import Final

from emulator.c28x.ctypes import CHAR as _CHAR
from emulator.c28x.ctypes import ArrayType, StructType, counts_octets, part_name
from emulator.c28x.heap_block import HeapBlock
from emulator.c28x.memory import Pointer
from emulator.c28x.rts_math import Mathematics

#: A string scan stops after this many characters (on the chip it runs on through memory).
_LONGEST: Final = 4096
#: A longer block is cut to this length: it has already covered all of RAM (CHOICE).
_LARGEST: Final = 0x1C000


class Strings(Mathematics):
    """The functions on blocks and strings of one image."""

    def _text(self, p: Pointer | None, reader: str, most: int = _LONGEST) -> str:
        """The characters that the function `reader` reads: up to the NUL, `most` at most."""
        if p is None:
            self._runtime.findings.report("null-dereference", f"{reader} was given NULL")
            return ""
        characters: list[str] = []
        for i in range(min(most, _LONGEST)):
            value = self._runtime.read_through(p, i, p.target if p.target.words == 1 else _CHAR, reader)
            if value == 0:
                break
            characters.append(chr(value & 0xFFFF))
        room = characters_left(p)
        if len(characters) >= room and most > room:
            path = _path(p)
            message = f"{reader} finds no NUL in {path}, a member with {room} words from there, and reads beyond it"
            self._runtime.findings.report("pointer-outside", message, object=path, value=room)
        self._runtime.touch_block(p, len(characters) + 1, False)
        return "".join(characters)

    def memcpy(self, to: Pointer | None, source: Pointer | None, n: int) -> Pointer | None:
        """Copy `n` words."""
        if to is None or source is None:
            self._runtime.findings.report("null-dereference", "memcpy was given NULL")
            return to
        self._examine("memcpy", 10, to, source, n)
        self._runtime.memory.copy(to, source, min(n, _LARGEST))
        return to

    def memmove(self, to: Pointer | None, source: Pointer | None, n: int) -> Pointer | None:
        """Copy `n` words; the blocks may overlap."""
        if to is None or source is None:
            self._runtime.findings.report("null-dereference", "memmove was given NULL")
            return to
        self._examine("memmove", 14, to, source, n)
        memory, count = self._runtime.memory, min(n, _LARGEST)
        if not 0 < to.addr - source.addr < count:
            memory.copy(to, source, count)
            return to
        words = [memory.read_word(source.addr + i) for i in range(count)]
        for i, word in enumerate(words):
            memory.write_word(to.addr + i, word)
        return to

    def _examine(self, function: str, cycles: int, to: Pointer, source: Pointer, n: int) -> None:
        """Charge the cycles of a copy of `n` words, check it, and pass its accesses to the detectors."""
        self._charge(cycles + 2 * n)
        self._check_size(function, "reads", source, n, to)
        self._check_size(function, "writes", to, n, source)
        self._check_written(function, source, n)
        self._runtime.touch_block(source, n, False)
        self._runtime.touch_block(to, n, True)

    def _check_size(
        self, function: str, verb: str, p: Pointer, n: int, other: Pointer | None, why: str = ""
    ) -> None:  # fmt: skip
        """Report a block that extends outside of its object, on either side.  `why`: where its size comes from."""
        obj = p.obj
        self._runtime.examine_block(p, function, "read" if verb == "reads" else "written")
        if obj is None or (p.offset >= 0 and p.offset + n <= obj.words):
            return
        path = obj.declaration.path
        outside = p.offset + n - obj.words if p.offset >= 0 else -p.offset
        octets = not why and any(_counted_in_octets(side, n) for side in (p, other))
        rule = "memcpy-octets" if octets else "memcpy-outside"
        if not why:
            why = f"{n} counts octets; in 16-bit words it is {n // 2}" if octets else "sizes count 16-bit words here"
        hit = self._runtime.memory.neighbour(obj.base + (obj.words if p.offset >= 0 else p.offset))
        self._runtime.findings.report(
            rule, f"{function} of {n} words {verb} {outside} words outside {path} ({obj.words} words): {why}",
            object=path, declaration=str(obj.declaration), value=n, details=(f"what lies there: {hit}",),
        )  # fmt: skip

    def _check_written(self, function: str, source: Pointer, n: int) -> None:
        """Report a block of which nothing was ever written.  A partly written block gives no finding."""
        obj = source.obj
        if obj is None or n == 0:
            return
        found = [obj.leaf(offset) for offset in range(max(source.offset, 0), min(source.offset + n, obj.words))]
        leaves = [leaf for leaf in found if leaf is not None]
        if leaves and all(obj.data[index] is None for index, _ in leaves):
            self._runtime.read_through(source, 0, leaves[0][1], function)

    def memset(self, to: Pointer | None, value: int, n: int) -> Pointer | None:
        """Set `n` words to `value`."""
        if to is None:
            self._runtime.findings.report("null-dereference", "memset was given NULL")
            return to
        self._charge(10 + 2 * n)
        self._check_size("memset", "writes", to, n, None)
        self._runtime.touch_block(to, n, True)
        for i in range(min(n, _LARGEST)):
            self._runtime.memory.store_through(to, i, _CHAR, value)
        return to

    def strlen(self, text: Pointer | None) -> int:
        """The number of characters before the NUL."""
        length = len(self._text(text, "strlen"))
        self._charge(8 + 4 * length)
        return length

    def strcmp(self, a: Pointer | None, b: Pointer | None) -> int:
        """A number less than, equal to, or greater than 0: text a comes before b, is equal, or comes after b."""
        first, second = self._text(a, "strcmp"), self._text(b, "strcmp")
        self._charge(8 + 6 * min(len(first), len(second)))
        return (first > second) - (first < second)

    def strcpy(self, to: Pointer | None, source: Pointer | None) -> Pointer | None:
        """Copy a string with its NUL."""
        return self._put_text("strcpy", to, 0, source)

    def strcat(self, to: Pointer | None, source: Pointer | None) -> Pointer | None:
        """Append a string with its NUL."""
        return self._put_text("strcat", to, len(self._text(to, "strcat")), source)

    def _put_text(self, name: str, to: Pointer | None, at: int, source: Pointer | None) -> Pointer | None:
        text = self._text(source, name)
        self._charge(10 + 4 * len(text))
        return self._write(name, to, at, text + "\0")

    def _write(self, name: str, to: Pointer | None, at: int, characters: str) -> Pointer | None:
        """Store characters from word `at` on."""
        if to is None:
            self._runtime.findings.report("null-dereference", f"{name} was given NULL")
            return to
        words = at + len(characters)
        why = "" if name == "strncpy" else f"the text has {words} characters with its NUL"
        self._check_size(name, "writes", to, words, None, why)
        if words > characters_left(to):
            path, room = _path(to), characters_left(to)
            message = f"{name} writes {words} words at {path}, a member with {room} words from there"
            self._runtime.findings.report("memcpy-outside", message, object=path, value=words)
        self._runtime.touch_block(to, at + len(characters), True)
        for i, character in enumerate(characters, at):
            code = ord(character)
            self._runtime.memory.store_through(to, i, _CHAR, code - 0x10000 if code > 0x7FFF else code)
        return to

    def memcmp(self, a: Pointer | None, b: Pointer | None, n: int) -> int:
        """Compare `n` words as unsigned numbers."""
        if a is None or b is None:
            self._runtime.findings.report("null-dereference", "memcmp was given NULL")
            return 0
        self._charge(10 + 4 * n)
        for p, other in ((a, b), (b, a)):
            self._check_size("memcmp", "reads", p, n, other)
            self._check_written("memcmp", p, n)
            self._runtime.touch_block(p, n, False)
        memory = self._runtime.memory
        first = [memory.read_word(a.addr + i) for i in range(min(n, _LARGEST))]
        second = [memory.read_word(b.addr + i) for i in range(min(n, _LARGEST))]
        return (first > second) - (first < second)

    def strncmp(self, a: Pointer | None, b: Pointer | None, n: int) -> int:
        """`strcmp` of the first `n` characters."""
        first, second = self._text(a, "strncmp", n), self._text(b, "strncmp", n)
        self._charge(10 + 6 * min(len(first), len(second), n))
        return (first > second) - (first < second)

    def strncpy(self, to: Pointer | None, source: Pointer | None, n: int) -> Pointer | None:
        """Copy `n` characters: a shorter text is filled up with NULs, a longer one gets none."""
        text = self._text(source, "strncpy", n)
        self._charge(12 + 4 * n)
        return self._write("strncpy", to, 0, text + "\0" * (min(n, _LARGEST) - len(text)))

    def strncat(self, to: Pointer | None, source: Pointer | None, n: int) -> Pointer | None:
        """Append `n` characters at most, and a NUL."""
        before, text = self._text(to, "strncat"), self._text(source, "strncat", n)
        self._charge(14 + 4 * (len(before) + len(text)))
        return self._write("strncat", to, len(before), text + "\0")

    def strchr(self, text: Pointer | None, character: int) -> Pointer | None:
        """The first place of `character` (the NUL counts as one); NULL if there is none."""
        characters = self._text(text, "strchr")
        self._charge(8 + 4 * len(characters))
        return _at(text, (characters + "\0").find(chr(character & 0xFFFF)))

    def strrchr(self, text: Pointer | None, character: int) -> Pointer | None:
        """The last place of `character` (the NUL counts as one); NULL if there is none."""
        characters = self._text(text, "strrchr")
        self._charge(8 + 4 * len(characters))
        return _at(text, (characters + "\0").rfind(chr(character & 0xFFFF)))

    def strstr(self, text: Pointer | None, part: Pointer | None) -> Pointer | None:
        """The first place of `part` in a text; NULL if there is none."""
        characters, wanted = self._text(text, "strstr"), self._text(part, "strstr")
        self._charge(10 + 6 * len(characters))
        return _at(text, characters.find(wanted))


def characters_left(p: Pointer) -> float:
    """The words from a pointer to the end of the array of characters, a member, that it points into; else infinity."""
    obj, offset = p.obj, p.offset
    if obj is None or isinstance(obj, HeapBlock) or not 0 <= offset < obj.words:
        return inf
    ctype = obj.declaration.ctype
    while True:
        match ctype:
            case ArrayType(element=StructType() | ArrayType() as element):
                ctype, offset = element, offset % max(1, element.words)
            case StructType(word_backed=False, members=members):
                inner = next((m for m in members if 0 <= offset - m.offset < m.ctype.words), None)
                if inner is None:
                    return inf
                ctype, offset = inner.ctype, offset - inner.offset
                if isinstance(ctype, ArrayType) and ctype.element == _CHAR:
                    return ctype.words - offset
            case _:
                return inf


def _path(p: Pointer) -> str:
    """The C name of the target of a pointer."""
    assert p.obj is not None
    declaration = p.obj.declaration
    return declaration.path + part_name(declaration.ctype, p.offset)


def _at(text: Pointer | None, index: int) -> Pointer | None:
    """A pointer to character `index` of a text; NULL for -1."""
    return None if text is None or index < 0 else text.at(index)


def _counted_in_octets(p: Pointer | None, n: int) -> bool:
    if p is None or p.obj is None:
        return False
    element = p.obj.element
    return counts_octets(n, p.obj.words - p.offset, 0 if element is None else element.words)
