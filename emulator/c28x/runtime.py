"""What translated firmware calls when a plain Python operation is not enough.

The generated code takes the fast path inline; it comes here for what must be watched or cannot be proven: a value that
was never written, an index outside, a pointer access, an overflow, a conversion.  One `Runtime` belongs to one linked
image.
"""

from __future__ import annotations

from emulator.c28x.runtime_arithmetic import ArithmeticRuntime
from emulator.c28x.runtime_base import EndlessPoll, IllegalCall, Site, UninitialisedRead, parse_fill
from emulator.c28x.runtime_memory import MemoryRuntime
from emulator.clock import CYCLES_PER_US

__all__ = ["EndlessPoll", "IllegalCall", "Runtime", "Site", "UninitialisedRead", "parse_fill"]


class Runtime(MemoryRuntime, ArithmeticRuntime):
    """Slow paths and policies of one image."""

    # Time

    def poll(self, site: Site, until: int) -> int:
        """A poll has run out of events, or of patience: raises, or reports and gives the next time to look again."""
        clock = self.clock
        if clock.now <= until:
            message = f"{site.name} is polled, but no event is left that could change it: the loop never ends"
            self.hit(site, "endless-poll", message)
            raise EndlessPoll(message)
        limit_s = self.poll_limit / CYCLES_PER_US / 1e6
        self.hit(site, "endless-poll", f"{site.name} has been polled for {limit_s:g} s without an end")
        return clock.now + self.poll_limit

    def endless(self, site: Site) -> None:
        """A loop that calls nothing and asks no register has computed for too long.

        A task goes on, as on the chip: the others have their time.  Outside of tasks nothing would ever come back:
        raises EndlessPoll.
        """
        alone = self.findings.context().startswith(("main", "Isr:"))
        if not alone and self.counted(site, "endless-loop"):
            return
        limit_s = self.loop_limit / CYCLES_PER_US / 1e6
        message = f"the loop over '{site.name}' has run for {limit_s:g} s and calls nothing that could end it"
        self.hit(site, "endless-loop", message)
        if alone:
            raise EndlessPoll(message)

    def stack_check(self, path: str) -> None:
        """The stack pointer has passed what the current stack can give to functions."""
        self.findings.report(
            "stack-overflow",
            f"{path}: the stack pointer {self.cpu.sp:#x} has passed {self.cpu.stack_limit:#x}: behind that this stack "
            "ends, or has no room left for an interrupt",
            object=self.findings.context(), value=self.cpu.sp,
        )  # fmt: skip
