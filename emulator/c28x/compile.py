"""From source to code: read, build, check, write.  The result does not depend on a board.

program = Program(modules)            # readers and builder: typed trees
compiled = compile_program(program, options, looked_at)
link(compiled, ...)                   # link.py: bound to one board
"""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Iterable

from emulator.c28x.compiled_program import Compiled, CompiledFunction, Depends, LinkError
from emulator.c28x.emit.names import FunctionNames, of_file
from emulator.c28x.emit.python import PythonWriter
from emulator.c28x.float_division import float_division
from emulator.c28x.options import CompileOptions
from emulator.c28x.passes import frame
from emulator.c28x.passes.checks import check
from emulator.c28x.passes.costs import Costs
from emulator.c28x.passes.flow import Flow
from emulator.c28x.passes.guards import Guards
from emulator.c28x.passes.image_facts import ImageFacts, facts_of
from emulator.c28x.passes.intervals import annotate_bounds
from emulator.c28x.passes.stamps import Stamps
from emulator.c28x.passes.taken import mark_copy_and_clear
from emulator.c28x.program import Program
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import NotAlike
from emulator.c28x.tree import Function, Where


@reading(0)
def compile_program(
    program: Program, options: CompileOptions, looked_at: Callable[[str, str], bool], like: Compiled | None = None
) -> Compiled:  # fmt: skip
    """Translate every function of `program`.

    `looked_at`: whether reading a register (block, name) only returns its stored word.  `like`: the program that
    `program` takes functions from, with the same options but `static`; their code is taken too.  Raises SourceError for
    source outside the language, LinkError for an entry that matches no function, NotAlike if `like` is of no use.
    """
    modules = program.translate()
    every = {function: module for module in modules for function in module.functions}
    taken = {} if like is None else {compiled.function: compiled for compiled in like.functions}
    for function, module in every.items():
        if function in taken:
            continue
        if not function.where.file:
            function.where = Where(module.unit(function.name).file, function.line)
        annotate_bounds(function.body)
        Flow(function).run()
    objects = [(variable, variable.initial) for module in modules for variable in module.variables]
    entries = _entries([function.path for function in every], options)
    stamps = Stamps(modules, entries)
    facts = facts_of([*every], stamps, watch=options.watch)
    depends = _depends(every, facts)
    if any(function in taken and taken[function].depends != own for function, own in depends.items()):
        raise NotAlike
    findings = check(modules, dict(objects), stamps, entries) if options.static else []
    costs = Costs(float_division(options.float_division))
    functions = []
    for function, module in every.items():
        if function in taken:
            functions.append(taken[function])
            continue
        factor = options.calibration.get(function.path, options.calibration.get(module.name, 1.0))
        frame.lay_out(function, options.room, residue=options.residue)
        Guards(function, facts, watch=options.watch, ieee=options.ieee, room=options.room).run()
        costs.leave(function)
        mark_copy_and_clear(function)
        own = depends[function]
        names = FunctionNames(own.owner, looked_at)
        writer = PythonWriter(function, names, options, costs=costs, factor=factor, idle=facts.idle)
        functions.append(CompiledFunction(function, writer.write(), own))
    return Compiled(program, options, functions, objects, findings)


def _depends(functions: Iterable[Function], facts: ImageFacts) -> dict[Function, Depends]:
    """What the code of each function depends on in the others.  Its names end in a text that no other function has."""
    owners: set[str] = set()
    found = {}
    for function in functions:
        owner = of_file(function.path.replace(".", "_"))
        while owner in owners:
            owner += "_"
        owners.add(owner)
        found[function] = Depends(owner, facts.about(function))
    return found


def _entries(paths: Iterable[str], options: CompileOptions) -> frozenset[str]:
    """The functions that `CompileOptions.entries` names.  Raises LinkError for an entry that matches none."""
    meant: set[str] = set()
    for entry in options.entries:
        found = fnmatch.filter(paths, entry)
        if not found and not set(entry) & set("*?["):
            raise LinkError(f"no function {entry} that could be an entry: write module.function")
        meant.update(found)
    return frozenset(meant)
