"""The PC's side of the line: build orders, decode frames, plot a drive.

Works with the emulated robot and with the real one; knows nothing of the bench.
"""
