"""The reader of C-shaped Python (`emulator.c28x.language`): walks Python's syntax tree and calls the builder."""
