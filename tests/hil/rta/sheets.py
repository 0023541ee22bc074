"""A sheet of two tasks that share a gate."""

from typing import Final

SHEET: Final = """\
[[task]]
name = "a"
priority = 2
period_us = 1000
computation_us = 100
sections = [{ gate = "g", time_us = 10 }]

[[task]]
name = "b"
priority = 1
period_us = 2000
computation_us = 300
start_up_us = 50
sections = [{ gate = "g", time_us = 20 }]
"""
