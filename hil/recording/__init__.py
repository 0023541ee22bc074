"""Recordings of a serial line: bytes with their times are recorded, read, played again and compared.

log.py         the format            wire.py     a session or a tap writes it    tap.py      between program and robot
trajectory.py  the console's file    replay.py   orders or frames, again         compare.py  two runs beside each other
"""
