"""What the registers do: one module a peripheral, named as in `emulator/registers`."""
