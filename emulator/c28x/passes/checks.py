"""Static checks on the typed tree of a whole image: findings without running the firmware.

They run if `CompileOptions.static` is set.  Each finding has the line of the statement.  A correct driver gets no
finding: what the trees alone do not decide is left to the detectors that run with the firmware.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from emulator.c28x.passes.admitted import check_admitted
from emulator.c28x.passes.anew import check_begun_anew
from emulator.c28x.passes.angles import check_angles
from emulator.c28x.passes.begun_again import check_begun_again
from emulator.c28x.passes.clamps import check_clamps
from emulator.c28x.passes.cleared import check_cleared
from emulator.c28x.passes.cleared_early import check_cleared_early
from emulator.c28x.passes.copied_socs import check_copied_socs
from emulator.c28x.passes.copies import check_copies
from emulator.c28x.passes.decided import check_decided
from emulator.c28x.passes.digits import check_digits
from emulator.c28x.passes.drained import check_drained
from emulator.c28x.passes.dropped import check_dropped
from emulator.c28x.passes.echoes import check_echoes
from emulator.c28x.passes.endless_waits import check_endless_waits
from emulator.c28x.passes.entrances import check_entrances
from emulator.c28x.passes.error_signs import check_error_signs
from emulator.c28x.passes.event_masks import check_event_masks, check_lost_events
from emulator.c28x.passes.feed_forward import check_feed_forward
from emulator.c28x.passes.flow import FlowReport
from emulator.c28x.passes.fraction_texts import check_fraction_texts
from emulator.c28x.passes.future_stamps import unreachable_exits
from emulator.c28x.passes.given import GivenValues
from emulator.c28x.passes.given_times import check_given_times
from emulator.c28x.passes.gone_locals import check_gone_locals
from emulator.c28x.passes.held import with_held_values
from emulator.c28x.passes.interrupted import driver_sides, sides_of
from emulator.c28x.passes.kept_flags import check_kept_flags, check_kept_marks
from emulator.c28x.passes.left_out import check_left_out
from emulator.c28x.passes.like_products import check_like_products
from emulator.c28x.passes.likes import check_likes
from emulator.c28x.passes.lost_writes import check_lost_writes
from emulator.c28x.passes.masked import check_masked
from emulator.c28x.passes.means import check_means
from emulator.c28x.passes.members import with_members
from emulator.c28x.passes.messages import check_messages
from emulator.c28x.passes.names import Liveness, Mentions, check_image, check_names, in_header
from emulator.c28x.passes.narrow_stamps import check_narrow_stamps
from emulator.c28x.passes.never_back import check_never_back
from emulator.c28x.passes.never_updated import check_never_counted, check_never_updated
from emulator.c28x.passes.null_tests import NullTests
from emulator.c28x.passes.off_by_one import check_off_by_one
from emulator.c28x.passes.one_sided import check_one_sided
from emulator.c28x.passes.only_grows import check_only_grows
from emulator.c28x.passes.open_integrals import check_open_integrals
from emulator.c28x.passes.out_of_reach import check_out_of_reach
from emulator.c28x.passes.port_writes import check_port_writes
from emulator.c28x.passes.published import check_published, check_published_elements
from emulator.c28x.passes.quotients import check_quotients
from emulator.c28x.passes.released import check_read_in_time, check_released
from emulator.c28x.passes.report import StaticFinding, StaticReport
from emulator.c28x.passes.ring_back import check_ring_back
from emulator.c28x.passes.search_end import check_searches
from emulator.c28x.passes.sent_buffers import check_sent_buffers
from emulator.c28x.passes.signs_of_life import check_signs_of_life
from emulator.c28x.passes.small_functions import with_small_functions
from emulator.c28x.passes.spans import check_spans
from emulator.c28x.passes.stamps import Stamps
from emulator.c28x.passes.state_tables import check_state_tables
from emulator.c28x.passes.stated import check_stated
from emulator.c28x.passes.states import States
from emulator.c28x.passes.stores import check_stores
from emulator.c28x.passes.tables import check_tables
from emulator.c28x.passes.taken_apart import check_taken_apart
from emulator.c28x.passes.targets import with_targets
from emulator.c28x.passes.timer_clock import check_timer_clocks
from emulator.c28x.passes.undone import check_undone
from emulator.c28x.passes.unlimited_lines import check_unlimited_lines
from emulator.c28x.passes.unread_inputs import check_unread_inputs
from emulator.c28x.passes.values import ValueChecks, file_scope, flag_words, macro_masks, results_of
from emulator.c28x.passes.waiting import WriterAnalysis, check_waiting
from emulator.c28x.passes.young_stamps import check_young_stamps
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Function, Variable
from emulator.c28x.tree_queries import once, source_text


def check(
    modules: Iterable[Module], objects: Mapping[Variable, list[Any] | None], stamps: Stamps,
    entries: frozenset[str] = frozenset(),
) -> list[StaticFinding]:
    """The static findings in the trees of `modules`.

    `objects` are the file-scope objects with their initial values (None: no initialiser).  `stamps` are the stamps of
    these modules, after a call of `suspicions`.  `entries` are functions (`module.name`) that the board itself calls.
    """
    modules = list(modules)
    initialisers = {variable: start or [] for variable, start in objects.items()}
    found: list[StaticFinding] = []
    reports = {module: StaticReport(module.c_file, found, module.double) for module in modules}
    mentions = Mentions(modules, initialisers)
    entered = mentions.by_address | entries
    threads = WriterAnalysis(modules, entered)
    functions = [function for module in modules for function in module.functions]
    flags, masks, results = flag_words(functions), macro_masks(functions), results_of(functions)
    for module, report in reports.items():
        for remark in module.remarks:
            at = remark.where
            place = Place(at.file, at.line, remark.function, module.c_file, at.column)
            found.append(StaticFinding(place, remark.rule, remark.message, remark.name, "", None))
        # The compiler may know what the small functions of the same file return, and no others.
        (own,) = with_small_functions([module], frozenset(entered))
        returned = {function.path: function for function in own.functions}
        for function in module.functions:
            unit = module.unit(function.name)
            found += _of_flow(function)
            ValueChecks(function, report, unit.symbols, flags, masks, results).run()
            found += _of_function(function)
            check_waiting(returned.get(function.path, function), threads, report)
            if not in_header(function.where, unit.file):
                used = mentions.by[function]
                check_names(function, unit, report, used, by_address=function.path in entered)
        for variable in module.variables:
            file_scope(variable, initialisers[variable], report)
    shown = with_small_functions(modules, frozenset(entered))
    shown_reports = {other: reports[module] for module, other in zip(modules, shown, strict=True)}
    whole = with_members(with_targets(with_held_values(shown)))
    of_whole = {other: reports[module] for module, other in zip(modules, whole, strict=True)}
    stamps_of_whole = Stamps(whole, entries)
    stamps_of_whole.suspicions()
    states = States(whole, entries, stamps_of_whole)
    states.check(of_whole)
    for module, function, test, state, label, why in unreachable_exits(states, whole):
        of_whole[module].report(
            function, test.where, "state-stuck",
            f"{function.path} never leaves {state.declaration.name} = {label} by itself: {source_text(test)} is "
            f"never true, for {why}",
            object=state.declaration.path, declaration=state.declaration,
        )  # fmt: skip
    for module, report in of_whole.items():
        for function in module.functions:
            check_decided(function, report)
            check_begun_anew(function, report)
    apart = with_members(modules)
    check_out_of_reach(apart, {other: reports[module] for module, other in zip(modules, apart, strict=True)})
    check_begun_again(whole, of_whole)
    check_open_integrals(of_whole)
    check_one_sided(whole, of_whole)
    check_signs_of_life(whole, of_whole)
    check_never_back(modules, reports)  # marks of data belong to their structures
    given = GivenValues(functions)
    check_tables(modules, reports, given)
    check_ring_back(reports, given)
    check_searches(reports, given)
    check_state_tables(whole, of_whole)
    check_off_by_one(whole, of_whole)
    check_only_grows(whole, of_whole)
    sides = sides_of(modules, reports)
    if sides is not None:
        check_port_writes(sides)
        check_published(sides)
        check_released(sides)
        check_read_in_time(sides)
        check_sent_buffers(sides)
        check_cleared(sides)
        check_lost_writes(sides)
    else:
        sides = driver_sides(modules, reports)
        if sides is not None:
            check_published_elements(sides)
    if sides is not None:
        check_taken_apart(sides)
    check_cleared_early(modules, reports)
    check_gone_locals(modules, reports)
    check_dropped(modules, reports)
    check_lost_events(reports)
    check_left_out(modules, reports)
    check_likes(modules, reports)
    check_messages(modules, reports)
    check_means(modules, reports)
    check_narrow_stamps(modules, reports)
    check_quotients(reports, given)
    check_error_signs(modules, reports)
    check_angles(modules, reports)
    check_echoes(modules, reports)
    check_feed_forward(modules, reports)
    check_stated(reports, given)
    check_fraction_texts(reports, given)
    check_spans(shown, shown_reports)
    check_drained(whole, of_whole)
    check_kept_flags(whole, of_whole)
    check_kept_marks(modules, reports)
    check_never_updated(modules, reports)
    check_never_counted(modules, reports)
    check_unlimited_lines(whole, of_whole)
    check_copied_socs(modules, reports)
    check_undone(modules, reports)
    check_unread_inputs(modules, reports)
    check_entrances(shown, shown_reports)
    owners = {function: report for module, report in reports.items() for function in module.functions}
    for function, s, stamp, against in stamps.cuts():
        name = source_text(stamp)
        wrong = f"{source_text(against)} is wrong once it is beyond 65535"
        message = f"{name} has 32 bits, and 16 of them are kept: {wrong}"
        owners[function].report(function, s.where, "stamp-compare", message, object=name)
    for function, s, since, unset in stamps.never_set():
        named = unset.declaration
        message = f"{source_text(since)}: no statement sets {named.name}: it is the time since the start, and wraps"
        owners[function].report(function, s.where, "stamp-compare", message, object=named.path)
    for function, s, unset in stamps.never_renewed():
        named = unset.declaration
        message = f"no statement sets {named.name} again: once {source_text(s.test)}, it is so in each pass"
        owners[function].report(function, s.where, "not-begun-again", message, object=named.path, declaration=named)
    for function, s, compare in stamps.ends():
        text = source_text(compare)
        message = f"{text}: the end of the time wraps before the counter does, and the comparison is wrong then"
        owners[function].report(function, s.where, "stamp-compare", message, object=text)
    check_given_times(modules, reports)
    check_young_stamps(modules, reports, stamps)
    check_image(modules, mentions, reports, entered, entries=bool(entries))
    check_timer_clocks(reports)
    return found


@once
def _of_flow(function: Function) -> list[StaticFinding]:
    """What the walk over one function found."""
    found: list[StaticFinding] = []
    FlowReport(function, StaticReport(function.c_file, found)).run()
    return found


@once
def _of_function(function: Function) -> list[StaticFinding]:
    """The findings for which one function, and those that it calls, are enough."""
    found: list[StaticFinding] = []
    report = StaticReport(function.c_file, found)
    Liveness(function, report).run()
    check_stores(function, report)
    check_copies(function, report)
    check_admitted(function, report)
    check_masked(function, report)
    check_event_masks(function, report)
    check_endless_waits(function, report)
    check_clamps(function, report)
    check_digits(function, report)
    check_like_products(function, report)
    NullTests(function, report).run()
    return found
