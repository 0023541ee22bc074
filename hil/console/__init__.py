"""Running the console of the thesis, a Windows program, unmodified on Linux and macOS.

app.py      what the program demands      needs.py     is it there: Python packages, Tk, a display
folder.py   the folder it runs in         launcher.py  robot, port and program together
runner.py   what the program's process does before the program (with standins/ for what only Windows has)
"""
