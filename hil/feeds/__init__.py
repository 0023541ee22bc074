"""What sensors see over virtual time, instead of the physics: README.md."""

from hil.feeds.feeding import PHYSICS, DeclaredFeed, Source, feed, load
from hil.feeds.inputs import Input, find, inputs

__all__ = ["PHYSICS", "DeclaredFeed", "Input", "Source", "feed", "find", "inputs", "load"]
