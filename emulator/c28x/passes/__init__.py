"""What is found out about a function before it is written: once, and left on the nodes of its tree."""
