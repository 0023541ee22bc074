"""Generates code from the annotated tree.  The passes have made all decisions; a writer only prints them."""
