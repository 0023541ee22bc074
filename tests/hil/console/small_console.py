"""A console of our own that makes the demands of the thesis' one: run by the tests, never imported.

Reads the port's name from a file on a Windows drive, opens it relative to the working directory, sends ``#STOP``, shows
whether a robot answers, and drives with keys.  Every byte that it read is kept beside its configuration.
"""

import subprocess
import sys
import tkinter as tk
from msvcrt import getch

import keyboard
import matplotlib
import matplotlib.pyplot as plt
import serial

FOLDER = "D:/Banco de pruebas/año 1"

with open("D:/Banco de pruebas/año 1/configuracion.txt") as configuration:
    port = serial.Serial(configuration.read()[0:4], 9600, timeout=0.25)
received = open("D:/Banco de pruebas/año 1/leido.bin", "wb")  # noqa: SIM115
port.write(b"#STOP\r")
first = port.read()
received.write(first)
print("robot answers:", bool(first))
print(
    "subprocess:",
    subprocess.run([sys.executable, "-c", "print('works')"], capture_output=True, text=True).stdout.strip(),
)
print("drawn with:", matplotlib.get_backend().lower())
print("getch:", callable(getch))
print("letters: ñ")

plt.ion()
window = tk.Tk()
window.title("Small console")
window.geometry("300x200")
v = 0


def drive():
    """Until Escape: the keys change the speed, the frames are read."""
    global v
    print("driving")
    while True:
        window.update()
        received.write(port.read(port.in_waiting))
        if keyboard.is_pressed("up"):
            v += 1
            print("up", v)
        elif keyboard.is_pressed("down"):
            v -= 1
            print("down", v)
        elif keyboard.is_pressed("esc"):
            # What the thesis' console does: here the program would leave without closing anything.
            sys.exit(3)
        window.after(100)
        for piece in (b"#SETR", str(v / 100).encode(), b",", b"0.0", b"\r"):
            port.write(piece)
        if keyboard.is_pressed("esc"):
            break
    received.flush()
    print("driven", v)


def draw():
    """A figure is another window, with a Tk of its own."""
    plt.plot([0, 1], [0, 1], color="red")
    plt.show()
    plt.pause(0.05)
    print("drawn")


def leave():
    """Without a word to the robot."""
    received.close()
    sys.exit(0)


tk.Button(window, text="DRIVE", command=drive).place(x=10, y=10, width=100, height=40)
tk.Button(window, text="DRAW", command=draw).place(x=10, y=60, width=100, height=40)
tk.Button(window, text="LEAVE", command=leave).place(x=10, y=110, width=100, height=40)
window.mainloop()
