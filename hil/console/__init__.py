"""Runs the console of the thesis, an unmodified Windows program, on Linux and macOS.

app.py      the needs of the program      needs.py     checks them: Python packages, Tk, a display
folder.py   the folder it runs in         launcher.py  runs robot, port and program together
runner.py   prepares the program's process (with standins/ for modules that only Windows has)
"""
