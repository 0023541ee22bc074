"""The PC's side of the line: it builds orders, decodes frames and plots a drive.

It works with the emulated robot and with the real one, and does not use the bench.
"""
