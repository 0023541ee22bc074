"""The annotated tree to code: what is decided stands on the nodes, a writer only says it."""
