"""The detectors of errors between threads: `kernel_watch.py` has them all."""
