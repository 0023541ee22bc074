"""Generates code from the annotated tree.  All decisions stand on the nodes; a writer only prints them."""
