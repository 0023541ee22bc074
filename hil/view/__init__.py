"""The robot in the browser: arena, console, findings, registers, scope, time.  `README.md` is the map."""
