"""The kernel of the chip as firmware uses it: SYS/BIOS tasks, semaphores, Clock, Swi, Hwi, gates, System, Log."""
