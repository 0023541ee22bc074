"""The behaviour of the registers: one module per peripheral, named as in `emulator/registers`."""
