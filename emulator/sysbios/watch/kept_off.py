"""What keeps an interrupt routine and `main` apart without a mask, found in the source of a program without the kernel.

- A routine writes an object only while a flag has a certain value.  While it has another one, the object is `main`'s.
- `main` reads an object in a loop that reads it again if a routine has been there: a counter of its versions is not
  the same before and after.
- A routine uses one part of an array (a double buffer), and `main` another one, until the routine turns to it.
- A routine reads one element of an array in each run, round and round (the digits of a display).  All elements are
  never read in one run, so a mask would not keep them together.
- A routine writes one element of an array in each run, and `main` only adds elements up: the mean of the latest
  samples.  Which of them is replaced while `main` adds makes no difference.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from typing import Any, Final, NamedTuple, TypeAlias

from emulator.c28x.symbols import Module
from emulator.c28x.tree import (
    AddressOf,
    Assign,
    Binary,
    Break,
    Call,
    CallPointer,
    Compare,
    Conditional,
    Const,
    CopyStruct,
    Declare,
    Expr,
    For,
    Function,
    If,
    Index,
    Jump,
    Load,
    Logic,
    LValue,
    Not,
    RegisterAt,
    Return,
    Stmt,
    Switch,
    Variable,
    While,
)
from emulator.c28x.tree_queries import (
    assigned_variables,
    bare,
    blocks,
    leaves,
    own_nodes,
    parts,
    roots,
    statements,
    within,
)
from emulator.sysbios.watch.ways import interrupt_routines


class ScalarCondition(NamedTuple):
    """A scalar at file scope (path of its object, word in it) is equal to a value, or it is not."""

    path: str
    word: int
    equal: bool
    value: Any
    #: Whether an interrupt routine makes it false.  None makes it true: then it is left out.
    answered: bool = False

    def true_of(self, value: Any) -> bool:
        """Whether it is true if the scalar has this value."""
        return bool(value == self.value) is self.equal


def opposite(condition: ScalarCondition) -> ScalarCondition:
    """The condition that is true when this one is not."""
    return condition._replace(equal=not condition.equal)


#: The path of an object, and the offset of a word in it.
Word: TypeAlias = tuple[str, int]
_NOTHING: Final[frozenset[ScalarCondition]] = frozenset()
#: Of a local: what is true if it is true, and what is if it is not.
_Told = tuple[frozenset[ScalarCondition], frozenset[ScalarCondition]]
_NO_LOCALS: Final[Mapping[Variable, _Told]] = {}


def conditions(test: Expr, locals_: Mapping[Variable, _Told] = _NO_LOCALS) -> list[ScalarCondition]:
    """What is true if a test is: the conditions of one scalar each that it joins by `and`."""
    match bare(test):
        case Logic(op="and", operands=operands):
            return [condition for operand in operands for condition in conditions(operand, locals_)]
        case Logic():
            return []
        case Not(operand=operand):
            return failed(operand, locals_)
        case Compare(op="==" | "!=" as op, left=left, right=right) if isinstance(constant := bare(right), Const):
            if isinstance(loaded := bare(left), Load) and (place := _scalar(loaded.lvalue)) is not None:
                return [ScalarCondition(*place, op == "==", constant.value)]
        case Load(lvalue=lvalue) if (place := _scalar(lvalue)) is not None:
            return [ScalarCondition(*place, False, 0)]
        case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root in locals_:
            return list(locals_[root][0])
    return []


def failed(test: Expr, locals_: Mapping[Variable, _Told] = _NO_LOCALS) -> list[ScalarCondition]:
    """What is true if a test is not."""
    match bare(test):
        case Logic(op="or", operands=operands):
            return [condition for operand in operands for condition in failed(operand, locals_)]
        case Logic():
            return []
        case Not(operand=operand):
            return conditions(operand, locals_)
        case Load(lvalue=LValue(root=Variable() as root, indices=[])) if root in locals_:
            return list(locals_[root][1])
    return [opposite(condition) for condition in conditions(test, locals_)]


class UseConditions:
    """Under which conditions each routine uses an object, as its source says."""

    def __init__(self, modules: Iterable[Module]) -> None:
        own = {function.path: function for module in modules for function in module.functions}
        found: dict[tuple[str, str, bool], frozenset[ScalarCondition]] = {}
        by_word: dict[tuple[str, str, bool, int | None], frozenset[ScalarCondition]] = {}
        steps: dict[tuple[str, str], frozenset[ScalarCondition]] = {}
        given: dict[Word, set[Any]] = {}
        self._elsewhere: set[tuple[str, str, int]] = set()
        for routine, reached in interrupt_routines(own):
            for path, write, word, now in _uses(routine, own):
                key = (routine.name, path, write)
                found[key] = found.get(key, now) & now
                by_word[*key, word] = by_word.get((*key, word), now) & now
            for path, now in _steps(routine, own):
                steps[routine.name, path] = steps.get((routine.name, path), now) & now
            for function in reached:
                for place, value in _given(function):
                    given.setdefault(place, set()).add(value)
            self._elsewhere |= {(routine.name, *place) for place in _deciding_elsewhere(reached)}
        self._uses = {key: frozenset(_only_main_opens(now, given)) for key, now in found.items()}
        self._words = {key: frozenset(_only_main_opens(now, given)) for key, now in by_word.items()}
        self._steps = {key: frozenset(_only_main_opens(now, given)) for key, now in steps.items()}

    def writing(self, routine: str, path: str) -> frozenset[ScalarCondition]:
        """What is true whenever a routine writes the object, and only `main` makes true."""
        return self._uses.get((routine, path, True), frozenset())

    def stepping(self, routine: str, path: str) -> frozenset[ScalarCondition]:
        """As `writing`, for other writes than those of a constant."""
        return self._steps.get((routine, path), frozenset())

    def denies(self, routine: str, path: str, word: int, write: bool, flag: Word) -> bool:
        """Whether a flag keeps the routine from no use of a word of the object, though it reads the flag: it depends on
        it in tests only, and none of them decides on the use.
        """
        uses = [now for at in (word, None) if (now := self._words.get((routine, path, write, at))) is not None]
        if not uses or (routine, *flag) in self._elsewhere:
            return False
        return any(all((condition.path, condition.word) != flag for condition in now) for now in uses)


def _given(function: Function) -> Iterator[tuple[Word, Any]]:
    """The scalars at file scope that a function can change, each with the constant that it gets, or None."""
    for statement in statements(function.body):
        match statement:
            case Assign(target=LValue() as target, value=value) if (place := _scalar(target)) is not None:
                constant = bare(value)
                yield place, constant.value if isinstance(constant, Const) else None
    for part in within(function.body):
        if isinstance(part, AddressOf) and (place := _scalar(part.lvalue)) is not None:
            yield place, None


def _only_main_opens(now: Iterable[ScalarCondition], given: dict[Word, set[Any]]) -> Iterator[ScalarCondition]:
    """Those conditions that no interrupt routine makes true."""
    for condition in now:
        values = given.get((condition.path, condition.word), set())
        if not any(value is None or condition.true_of(value) for value in values):
            yield condition._replace(answered=bool(values))


def _uses(
    function: Function, own: dict[str, Function]
) -> Iterator[tuple[str, bool, int | None, frozenset[ScalarCondition]]]:
    """The objects that a function and those below it use, whether they may write them, and what is true then.

    With the word of the scalar that is used; None: any word may be meant.
    """
    for statement, here in _run(function, _NOTHING, own, ()):
        changed = statement.target if isinstance(statement, Assign | CopyStruct) else None
        for whole, part in [(each, part) for each in roots(statement) for part in parts(each)]:
            match part:
                case AddressOf(lvalue=LValue(root=Variable(kind="global") as root)):
                    yield root.declaration.path, True, None, here
                case LValue(root=Variable(kind="global") as root):
                    place = _scalar(part)
                    written = part is whole is changed  # in `n += x` the value reads the same node
                    yield root.declaration.path, written, None if place is None else place[1], here


def _steps(function: Function, own: dict[str, Function]) -> Iterator[tuple[str, frozenset[ScalarCondition]]]:
    """The objects of which a function and those below it change a scalar by a value, and what is true then."""
    for statement, here in _run(function, _NOTHING, own, ()):
        match statement:
            case Assign(target=LValue() as target, value=value) if (place := _scalar(target)) is not None:
                if not isinstance(bare(value), Const):
                    yield place[0], here


def _run(
    function: Function, now: frozenset[ScalarCondition], own: dict[str, Function], callers: tuple[str, ...]
) -> Iterator[tuple[Stmt, frozenset[ScalarCondition]]]:
    """The statements of a function and of those below it, with what is true when they are reached.

    `now` is true at the call of the function.
    """
    for statement, here in _under(function.body, now, {}):
        yield statement, here
        inner = own_nodes(statement)
        for called in {part.function.path for part in inner if isinstance(part, Call)}:
            if called in own and called not in callers and called != function.path:
                yield from _run(own[called], here, own, (*callers, function.path))


def _under(
    body: list[Stmt], now: frozenset[ScalarCondition], known: dict[Variable, _Told]
) -> Iterator[tuple[Stmt, frozenset[ScalarCondition]]]:
    """The statements of a block, and of those in it, with what was true when the tests above them were evaluated.

    `known`: what the values of locals say; kept up to date.
    """
    for statement in body:
        yield statement, now
        match statement:
            case Assign(target=LValue(root=Variable() as root, indices=[]), value=value) if root.kind != "global":
                known[root] = frozenset(conditions(value, known)), frozenset(failed(value, known))
            case Declare(variable=root, value=Expr() as value):
                known[root] = frozenset(conditions(value, known)), frozenset(failed(value, known))
            case If(test=test, then=then, otherwise=otherwise):
                met, not_met = frozenset(conditions(test, known)), frozenset(failed(test, known))
                inside, outside = dict(known), dict(known)
                yield from _under(then, now | met, inside)
                yield from _under(otherwise, now | not_met, outside)
                if leaves(then):
                    now = now | not_met
                elif otherwise and leaves(otherwise):
                    now = now | met
                _joined(known, bare(test), then, inside, [] if otherwise else None)
                _forget(known, otherwise)
            case Switch(subject=subject, cases=cases):
                place = _scalar(loaded.lvalue) if isinstance(loaded := bare(subject), Load) else None
                for values, block in cases:
                    here = now
                    if place is not None and values is not None and len(values) == 1:
                        here = now | {ScalarCondition(*place, True, values[0])}
                    yield from _under(block, here, dict(known))
                for _, block in cases:
                    _forget(known, block)
            case _:
                for block in blocks(statement):
                    _forget(known, block)
                for block in blocks(statement):
                    yield from _under(block, now, dict(known))


def _joined(
    known: dict[Variable, _Told], test: Expr, then: list[Stmt], inside: dict[Variable, _Told], otherwise: Any
) -> None:
    """Keep what locals say after an `if` whose block changes them.

    `t = a; if (t) t = b;` is C's `t = a && b`, and `t = a; if (!t) t = b;` is its `t = a || b`.
    """
    negated = isinstance(test, Not)
    tested = bare(test.operand) if isinstance(test, Not) else test
    local = tested.lvalue.root if isinstance(tested, Load) and not tested.lvalue.indices else None
    before = known.get(local) if isinstance(local, Variable) and otherwise is None else None
    _forget(known, then)
    if before is not None and isinstance(local, Variable) and local not in known and local in inside:
        after = inside[local]
        known[local] = (_NOTHING, before[1] | after[1]) if negated else (before[0] | after[0], _NOTHING)


def _forget(known: dict[Variable, _Told], body: list[Stmt]) -> None:
    """Forget what the locals say that a block changes."""
    for variable in assigned_variables(body):
        known.pop(variable, None)


#: What can decide: a local; or the path of an object at file scope, with the word of a scalar (None: any word).
_Decider = Variable | tuple[str, int | None]


def _deciding_elsewhere(functions: Iterable[Function]) -> set[Word]:
    """The scalars at file scope on which functions may depend otherwise than by a test that `conditions` understands.

    Such are those in other tests, in subscripts and pointers, in arguments and results, and what is assigned to another
    object that decides.  A value that is only computed with (`position += direction`) decides nothing.
    """
    elsewhere: set[_Decider] = set()
    tested: set[_Decider] = set()
    flows: list[tuple[_Decider, set[_Decider]]] = []
    for statement in (statement for function in functions for statement in statements(function.body)):
        nodes = own_nodes(statement)
        match statement:
            case Assign(target=target, value=value):
                elsewhere |= _read_at(inner for part in nodes for inner in _choosing(part))
                if isinstance(target, LValue) and isinstance(target.root, Variable):
                    flows.append((_decider(target), _read_at(parts(value))))
            case Declare(variable=variable, value=Expr() as value):
                elsewhere |= _read_at(inner for part in nodes for inner in _choosing(part))
                flows.append((variable, _read_at(parts(value))))
            case If(test=test) if len(conditions(test) + failed(test)) >= sum(isinstance(part, Load) for part in nodes):
                tested |= _read_at(nodes)
            case _:
                elsewhere |= _read_at(nodes)
    deciding, known = elsewhere | tested, -1
    while known != len(deciding):
        known = len(deciding)
        for given, values in flows:
            if any(_may_be(given, one) for one in deciding):
                elsewhere |= values
                deciding |= values
    return {(one[0], one[1]) for one in elsewhere if not isinstance(one, Variable) and one[1] is not None}


def _may_be(one: _Decider, other: _Decider) -> bool:
    """Whether two of them may be the same object."""
    if isinstance(one, Variable) or isinstance(other, Variable):
        return one is other
    return one[0] == other[0] and (one[1] == other[1] or one[1] is None or other[1] is None)


def _choosing(part: Any) -> list[Any]:
    """What decides, within an expression, which object is used or which function runs."""
    match part:
        case Index(expr=chosen) | LValue(root=Expr() as chosen) | RegisterAt(block=chosen) | Conditional(test=chosen):
            return parts(chosen)
        case Logic() | Call() | CallPointer():
            return parts(part)
    return []


def _read_at(nodes: Iterable[Any]) -> set[_Decider]:
    """The objects whose values or addresses are used among the nodes of expressions."""
    return {
        _decider(part.lvalue)
        for part in nodes if isinstance(part, Load | AddressOf) and isinstance(part.lvalue.root, Variable)
    }  # fmt: skip


def _decider(lvalue: LValue) -> _Decider:
    """A named object, as what may decide."""
    root = lvalue.root
    assert isinstance(root, Variable)
    if root.kind != "global":
        return root
    place = _scalar(lvalue)
    return (root.declaration.path, None) if place is None else place


def _scalar(lvalue: LValue) -> Word | None:
    """The path and word of a scalar at file scope that an lvalue names."""
    match lvalue:
        case LValue(root=Variable(kind="global") as root, indices=[], words=words, ctype=ctype) if ctype.leaves == 1:
            return root.declaration.path, words
    return None


def alternating(modules: Iterable[Module]) -> dict[str, set[str]]:
    """Arrays whose parts a routine uses in turn (double buffers), by their paths: what selects the part.

    Such an object is the first of several subscripts, a pointer to the array, or what a test of two arrays asks.  The
    routine toggles it, or changes it only when something is complete.
    """
    own = {function.path: function for module in modules for function in module.functions}
    chosen: dict[str, set[str]] = {}
    for _, reached in interrupt_routines(own):
        turned = set().union(*map(_turned_now_and_then, reached))
        for function in reached if turned else ():
            for path, selector in _selected(function.body):
                if selector in turned:
                    chosen.setdefault(path, set()).add(selector)
    pointed = {selector for selectors in chosen.values() for selector in selectors}
    for function in own.values() if pointed else ():
        for statement in statements(function.body):
            pointer = object_path(statement.target) if isinstance(statement, Assign) else None
            if isinstance(statement, Assign) and pointer is not None and pointer in pointed:
                for part in parts(statement.value):
                    if isinstance(part, AddressOf) and (array := object_path(part.lvalue)) is not None:
                        chosen.setdefault(array, set()).add(pointer)
    return chosen


def _turned_now_and_then(function: Function) -> set[str]:
    """The plain objects that a function toggles, or sets only in branches."""
    assigns = [statement for statement in statements(function.body) if isinstance(statement, Assign)]
    always = [statement for statement in function.body if isinstance(statement, Assign) and not _toggles(statement)]
    return written_objects([each for each in assigns if each.target.ctype.leaves == 1]) - written_objects(always)


def _toggles(statement: Assign) -> bool:
    """Whether a statement sets an object to the other one of two values: `x ^= 1`, `x = 1 - x`, `x = !x`."""
    value = bare(statement.value)
    match value:
        case Binary(op="^"):
            return True
        case Binary(op="-", left=left):
            return isinstance(bare(left), Const)
    return isinstance(value, Not)


def _selected(body: list[Stmt]) -> Iterator[tuple[str, str]]:
    """(path of an array, or of a pointer that statements go through; path of what selects it)."""
    for statement in statements(body):
        named = [statement.target] if isinstance(statement, Assign) else []
        named += [part.lvalue for part in own_nodes(statement) if isinstance(part, Load)]
        for lvalue in named:
            match lvalue:
                case LValue(root=Variable(kind="global") as root, indices=[Index(expr=first), _, *_]):
                    if isinstance(row := bare(first), Load) and (selector := object_path(row.lvalue)) is not None:
                        yield root.declaration.path, selector
                case LValue(root=Load(lvalue=pointed)) if (pointer := object_path(pointed)) is not None:
                    yield pointer, pointer
        if isinstance(statement, If):
            loads = (part for part in parts(statement.test) if isinstance(part, Load))
            asked = {path for load in loads if (path := object_path(load.lvalue)) is not None}
            if len(asked) == 1:
                for path in (written_objects(statement.then) ^ written_objects(statement.otherwise)) - asked:
                    yield path, min(asked)


def shown_in_turn(modules: Iterable[Module]) -> dict[str, set[str]]:
    """Arrays of which a routine shows one element after the other for ever: path -> the names of such routines.

    Each run reads one element, whatever the state, and the routine alone moves the subscript.  A routine that sends a
    buffer is not meant: it comes to an end, or somebody else sets its subscript.
    """
    own = {function.path: function for module in modules for function in module.functions}
    found: dict[str, set[str]] = {}
    for routine, reached in interrupt_routines(own):
        nodes = list(chain.from_iterable(within(function.body) for function in reached))
        used = Counter(path for node in nodes if (path := object_path(node)) is not None)
        always = (node for s in routine.body if not blocks(s) for node in own_nodes(s))
        for node in always:
            match node:
                case Load(lvalue=LValue(indices=[Index(expr=subscript)]) as element) if element.ctype.leaves == 1:
                    array, moved = object_path(element), bare(subscript)
                    index = object_path(moved.lvalue) if isinstance(moved, Load) else None
                    if array is None or index is None or used[array] != 1:
                        continue
                    others = [function for function in own.values() if function not in reached]
                    if not any(index == object_path(n) for f in others for n in within(f.body)):
                        found.setdefault(array, set()).add(routine.name)
    return found


def averaged(modules: Iterable[Module]) -> dict[str, set[str]]:
    """Arrays of samples whose elements are only added up: path -> the names of the routines that sample.

    Each run of a routine writes one element at most, by a subscript.  A routine that fills an array is not meant: the
    old and the new contents, added up, may be a sum that neither has.
    """
    own = {function.path: function for module in modules for function in module.functions}
    found: dict[str, set[str]] = {}
    for routine, reached in interrupt_routines(own):
        once = {id(s) for function in reached for s in _outside_of_loops(function.body)}
        written: dict[str, list[Stmt]] = {}
        mentioned: Counter[str] = Counter()
        for s in (s for function in reached for s in statements(function.body)):
            mentioned.update(path for node in own_nodes(s) if (path := object_path(node)) is not None)
            match s:
                case Assign(target=LValue(indices=[Index(expr=subscript)]) as element) if not isinstance(
                    subscript, Const
                ) and (path := object_path(element)) is not None:
                    written.setdefault(path, []).append(s)
        for path, writes in written.items():
            others = (function for function in own.values() if function not in reached)
            if len(writes) == mentioned[path] == 1 and id(writes[0]) in once and all(
                _adds_up(s, path) for f in others for s in statements(f.body)
            ):  # fmt: skip
                found.setdefault(path, set()).add(routine.name)
    return found


def _outside_of_loops(body: list[Stmt]) -> Iterator[Stmt]:
    for s in body:
        yield s
        if not isinstance(s, While | For):
            for block in blocks(s):
                yield from _outside_of_loops(block)


def _adds_up(s: Stmt, path: str) -> bool:
    """Whether a statement uses an object at most to add one element of it to a sum, or to set one to a constant."""
    if sum(object_path(node) == path for node in own_nodes(s)) == 0:
        return True
    match s:
        case Assign(target=target, value=Const()):
            return object_path(target) == path
        case Assign(target=LValue() as total, value=value):
            match bare(value):
                case Binary(op="+", left=left, right=right):
                    match bare(left), bare(right):
                        case Load(lvalue=before), Load(lvalue=added):
                            return before == total and object_path(added) == path
    return False


def ring_indices(modules: Iterable[Module]) -> dict[Word, bool]:
    """The scalars at file scope that statements only move round a ring buffer, or set to a constant.

    `i = (i + 1) % N`, or `next = (i + 1) % N; ... i = next`.  Each with whether it is volatile.
    """
    moved: dict[Word, bool] = {}
    otherwise: set[Word] = set()
    for function in (function for module in modules for function in module.functions):
        given: dict[Variable, list[Expr]] = {}
        for statement in statements(function.body):
            match statement:
                case Assign(target=LValue(root=Variable(kind="local") as local), value=value) | Declare(
                    variable=local, value=Expr() as value
                ):  # fmt: skip
                    given.setdefault(local, []).append(value)
        for statement in statements(function.body):
            match statement:
                case Assign(target=LValue(root=Variable() as root) as target, value=value) if (
                    place := _scalar(target)
                ) is not None:
                    value = bare(value)
                    of = value.lvalue.root if isinstance(value, Load) else None
                    if isinstance(of, Variable) and of.plain and len(given.get(of, ())) == 1:
                        value = bare(given[of][0])
                    if _round_a_ring(target, value):
                        moved[place] = root.volatile or target.volatile
                    elif not isinstance(value, Const):
                        otherwise.add(place)
            for part in own_nodes(statement):
                if isinstance(part, AddressOf) and (place := _scalar(part.lvalue)) is not None:
                    otherwise.add(place)
    return {place: volatile for place, volatile in moved.items() if place not in otherwise}


def _round_a_ring(target: LValue, value: Expr) -> bool:
    """Whether a value is that of its target plus a constant, within the size of a ring."""
    match value:
        case Binary(op="%" | "&", left=left, right=size) if isinstance(bare(size), Const):
            match bare(left):
                case Binary(op="+" | "-", left=old, right=by) if isinstance(bare(by), Const):
                    return isinstance(index := bare(old), Load) and index.lvalue == target
    return False


def written_objects(body: Iterable[Stmt]) -> set[str]:
    """The objects at file scope that statements assign."""
    targets = [statement.target for statement in statements(body) if isinstance(statement, Assign | CopyStruct)]
    return {path for target in targets if (path := object_path(target)) is not None}


def object_path(lvalue: Any) -> str | None:
    """The path of the object at file scope that an lvalue names a part of."""
    root = lvalue.root if isinstance(lvalue, LValue) else None
    return root.declaration.path if isinstance(root, Variable) and root.kind == "global" else None


def rereading_lines(modules: Iterable[Module]) -> frozenset[tuple[str, int]]:
    """(file, line) of the statements in loops that read again what a routine has changed meanwhile."""
    return frozenset(
        (function.where.file, statement.line)
        for module in modules for function in module.functions
        for loop in statements(function.body) if isinstance(loop, While) and rereads(loop)
        for statement in statements(loop.body)
    )  # fmt: skip


def rereads(loop: While) -> bool:
    """Whether a loop ends only when a shared object still has the value that the loop has copied from it."""
    copies: dict[Variable, set[Word]] = {}
    for statement in statements(loop.body):
        given: tuple[Variable, Expr] | None = None
        match statement:
            case Assign(target=LValue(root=Variable() as root, indices=[]), value=value):
                given = root, value
            case Declare(variable=root, value=Expr() as value):
                given = root, value
        loaded = bare(given[1]) if given is not None else None
        if given is not None and isinstance(loaded, Load) and (place := _scalar(loaded.lvalue)) is not None:
            copies.setdefault(given[0], set()).add(place)
    tests = [loop.test]
    for statement in statements(loop.body):
        if isinstance(statement, If) and any(
            isinstance(inner, Break | Return | Jump) for block in blocks(statement) for inner in statements(block)
        ):
            tests.append(statement.test)
    return any(_again(part, copies) for test in tests for part in parts(test) if isinstance(part, Compare))


def _again(test: Compare, copies: dict[Variable, set[Word]]) -> bool:
    """Whether a test compares an object with a copy of it, or two copies of it."""
    if test.op not in ("==", "!="):
        return False
    sides: list[set[Word]] = []
    for side in (bare(test.left), bare(test.right)):
        lvalue = side.lvalue if isinstance(side, Load) else None
        root = lvalue.root if lvalue is not None else None
        place = _scalar(lvalue) if lvalue is not None else None
        copied = copies.get(root, set()) if isinstance(root, Variable) else set[Word]()
        sides.append(copied if place is None else copied | {place})
    return bool(sides[0] & sides[1])
