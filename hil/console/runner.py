"""Runs an app with modules that only Windows has: ``python runner.py APP``.

The modules (or those that need root on other systems) come from `standins`.  Only the app gets them.  If everybody
found a module named ``msvcrt``, then ``subprocess``, ``getpass`` and others would assume Windows.  Import statements in
files of the app's own folder get the stand-in, which is in `sys.modules` under another name.

Not covered: ``importlib.import_module("msvcrt")`` in the app.

This file runs in the Python that runs the app.  That may not have this project, so the file imports nothing of it.
"""

from __future__ import annotations

import builtins
import importlib.util
import runpy
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

#: The modules in `standins`, each in a file of its name.
STAND_INS = ("keyboard", "msvcrt")
_FOLDER = Path(__file__).parent / "standins"


def load_stand_in(name: str) -> ModuleType:
    """Load a stand-in from its file, under a name that nobody imports."""
    spec = importlib.util.spec_from_file_location(f"stand_in_{name}", _FOLDER / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def serve(app_folder: Path) -> None:
    """From now on, imports of `STAND_INS` in files below `app_folder` get the stand-in."""
    loaded: dict[str, ModuleType] = {}
    ordinary = builtins.__import__

    def of_app(namespace: Mapping[str, Any] | None) -> bool:
        file = (namespace or {}).get("__file__")
        if not isinstance(file, str):
            return False
        path = Path(file).absolute()
        # A virtual environment may be in the folder of the app.
        return app_folder in path.parents and "site-packages" not in path.parts

    def imported(
        name: str,
        globals: Mapping[str, Any] | None = None,
        locals: Mapping[str, Any] | None = None,
        fromlist: Sequence[str] | None = (),
        level: int = 0,
    ) -> ModuleType:
        if name in STAND_INS and level == 0 and of_app(globals):
            if name not in loaded:
                loaded[name] = load_stand_in(name)
            return loaded[name]
        return ordinary(name, globals, locals, fromlist or (), level)

    builtins.__import__ = imported


def main() -> None:
    """Run the app like ``python APP``."""
    app = Path(sys.argv[1]).absolute()
    sys.argv = [str(app)]
    sys.path[0] = str(app.parent)
    serve(app.parent)
    runpy.run_path(str(app), run_name="__main__")


if __name__ == "__main__":
    main()
