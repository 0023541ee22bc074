"""Passes over the tree of a function, before code is generated.  Each pass stores its results on the nodes."""
