"""From source to code: read, build, check, write.  The result does not depend on a board.

program = Program(modules)            # readers and builder: typed trees
compiled = compile_program(program, options, looked_at)
link(compiled, ...)                   # link.py: bound to one board
"""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Iterable

from emulator.c28x.compiled_program import Compiled, CompiledFunction, CompileOptions, LinkError
from emulator.c28x.emit.names import FunctionNames, of_file
from emulator.c28x.emit.python import PythonWriter
from emulator.c28x.float_division import float_division
from emulator.c28x.passes import frame
from emulator.c28x.passes.checks import check
from emulator.c28x.passes.costs import Costs
from emulator.c28x.passes.feedback import reversed_errors
from emulator.c28x.passes.fields import flag_scalars
from emulator.c28x.passes.flow import Flow
from emulator.c28x.passes.guards import Guards
from emulator.c28x.passes.intervals import annotate_bounds
from emulator.c28x.passes.pulses import pulses
from emulator.c28x.passes.signs import signed_words
from emulator.c28x.passes.stamps import Stamps
from emulator.c28x.passes.sums import sums_of_samples, used_as_numbers
from emulator.c28x.passes.taken import mark_copy_and_clear
from emulator.c28x.passes.wind_up import wind_up
from emulator.c28x.program import Program
from emulator.c28x.readers.reading import reading
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Where
from emulator.c28x.tree_queries import compared, limited, limited_scalars, made_float, only_compute


@reading(0)
def compile_program(program: Program, options: CompileOptions, looked_at: Callable[[str, str], bool]) -> Compiled:
    """Translate every function of `program`.

    `looked_at`: whether reading a register (block, name) only returns its stored word.  Raises SourceError for source
    outside the language, LinkError for an entry that matches no function.
    """
    modules = program.translate()
    for module in modules:
        for function in module.functions:
            if not function.where.file:
                function.where = Where(module.unit(function.name).file, function.line)
            annotate_bounds(function.body)
            Flow(function).run()
    objects = [(variable, variable.initial) for module in modules for variable in module.variables]
    entries = _entries(modules, options)
    stamps = Stamps(modules, entries)
    suspicions = stamps.suspicions()
    findings = check(modules, dict(objects), stamps, entries) if options.static else []
    cut_pulses = pulses(stamps)
    names_compared = compared(f for module in modules for f in module.functions)
    names_limited = limited(f for module in modules for f in module.functions)
    floats_made = made_float(f for module in modules for f in module.functions)
    in_a_range = limited_scalars(f for module in modules for f in module.functions)
    regulators = wind_up(f for module in modules for f in module.functions) if options.watch else {}
    words = signed_words(f for module in modules for f in module.functions)
    words |= reversed_errors(f for module in modules for f in module.functions)
    every = [f for module in modules for f in module.functions]
    flags, numbers = flag_scalars(every), used_as_numbers(every)
    sums, computing = sums_of_samples(every, numbers), only_compute(every)
    costs = Costs(float_division(options.float_division))
    owners: set[str] = set()
    functions = []
    for module in modules:
        for function in module.functions:
            owner = of_file(function.path.replace(".", "_"))
            while owner in owners:
                owner += "_"
            owners.add(owner)
            factors = options.calibration
            factor = factors.get(f"{module.name}.{function.name}", factors.get(module.name, 1.0))
            frame.lay_out(function, options.room, residue=options.residue)
            Guards(
                function, watch=options.watch, ieee=options.ieee, room=options.room, compared=names_compared,
                limited=names_limited, made_float=floats_made, in_a_range=in_a_range, stamps=suspicions,
                pulses=cut_pulses, regulators=regulators, words=words, flags=flags, numbers=numbers, sums=sums,
                computing=computing,
            ).run()  # fmt: skip
            costs.leave(function)
            mark_copy_and_clear(function)
            writer = PythonWriter(
                function, FunctionNames(owner, looked_at), costs=costs, factor=factor, watch=options.watch,
                residue=options.residue, keep_locals=options.keep_locals, coverage=options.coverage,
                steps=options.steps, follow=options.follow, charge_by_call=options.charge_by_call,
            )  # fmt: skip
            functions.append(CompiledFunction(function, function.where.file, writer.write()))
    return Compiled(program, options, functions, objects, findings)


def _entries(modules: Iterable[Module], options: CompileOptions) -> frozenset[str]:
    """The functions that `CompileOptions.entries` names.  Raises LinkError for an entry that matches none."""
    paths = [function.path for module in modules for function in module.functions]
    meant: set[str] = set()
    for entry in options.entries:
        found = fnmatch.filter(paths, entry)
        if not found and not set(entry) & set("*?["):
            raise LinkError(f"no function {entry} that could be an entry: write module.function")
        meant.update(found)
    return frozenset(meant)
