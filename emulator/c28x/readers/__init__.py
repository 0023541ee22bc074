"""Readers: source text to typed trees, by way of the builder (`emulator.c28x.build`)."""
