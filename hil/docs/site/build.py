"""From pages to a site: the folder that Sphinx reads, its settings, and the run of it."""

from __future__ import annotations

import io
import os
import shutil
import tempfile
from collections.abc import Callable
from importlib.metadata import metadata, version
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

from hil.docs import BEGIN, LOOK_UP, PAGES, DocPage
from hil.docs.site import api, catalogue, commands, links, notebook, replays, rules
from hil.extras import require

#: What a finished site has in it, so that it may be replaced.
MARK: Final = ".buildinfo"
#: Where the runs to look at are.
REPLAYS: Final = "runs"
#: Folders of pages that are made of data, by their section of the list at the side.
_MADE: Final = {BEGIN: (REPLAYS,), LOOK_UP: ("commands", "rules", "catalogue", "api")}

SETTINGS: Final[dict[str, Any]] = {
    "project": "c2000-hil",
    "extensions": ["myst_nb", "sphinx_copybutton"],
    "root_doc": "index",
    "source_suffix": {".md": "myst-nb", ".ipynb": "myst-nb"},
    "myst_heading_anchors": 4,
    "myst_enable_extensions": ["attrs_block"],
    # Sources are C, shells and tables besides Python; a piece of one need not be whole.
    "suppress_warnings": ["misc.highlighting_failure"],
    "nb_execution_mode": "off",  # that is done before
    "nb_merge_streams": True,
    "highlight_language": "text",
    "smartquotes": False,  # `--for` is no dash
    "html_theme": "furo",
    "html_title": "c2000-hil",
    "html_copy_source": False,
    "html_show_sourcelink": False,
    "html_show_copyright": False,
    "html_show_sphinx": False,
    "html_static_path": [str(Path(__file__).with_name("static"))],
    "html_css_files": ["site.css"],
    "copybutton_prompt_text": r"\$ |>>> ",
    "copybutton_prompt_is_regexp": True,
    "html_theme_options": {"navigation_with_keys": True},
}


def build(target: Path, progress: Callable[[str], None] = lambda told: None) -> int:
    """Build the site into a folder that is new, empty, or holds an earlier site; returns the number of pages.

    Raises ValueError with the warnings, one after the other; then the folder is as it was.
    """
    require("sphinx")
    target = target.absolute()
    if target.exists() and not (target.is_dir() and (not any(target.iterdir()) or (target / MARK).exists())):
        raise ValueError(f"{target}: is there, and is no site: give another folder")
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=".site-") as work:
        source, made, extra = Path(work, "source"), Path(work, "site"), Path(work, "extra")
        with replays.made(extra / REPLAYS):
            lay_out(source)
        progress("pages")
        count = run_sphinx(source, made, Path(work, "trees"), extra, progress)
        if target.exists():
            shutil.rmtree(target)
        made.rename(target)
    return count


def lay_out(source: Path) -> None:
    """The pages as files, each where its sources are, so that links from one to the other hold."""
    for page in PAGES.values():
        place = source / page.path
        place.parent.mkdir(parents=True, exist_ok=True)
        if place.suffix == ".ipynb":
            place.write_text(notebook.executed(page.source()), encoding="utf-8")
        else:
            place.with_suffix(".md").write_text(links.mended(page.text(), page.path, source), encoding="utf-8")
    index = links.mended(read_me(), links.ROOT / "README.md", source)
    (source / "index.md").write_text(index + _contents(), encoding="utf-8")
    _write(source / REPLAYS, {"all": replays.page()})
    _write(source / "rules", {"all": rules.index(), **{
        rule.id: rules.page(rule) for _, members in rules.families() for rule in members
    }})  # fmt: skip
    _write(source / "catalogue", {"all": catalogue.index(), **{
        catalogue.slug(name): catalogue.page(name, defects) for name, defects in catalogue.files()
    }})  # fmt: skip
    _write(source / "commands", {"all": commands.index(), **{
        name: commands.page(name, command) for name, command in commands.commands()
    }})  # fmt: skip
    _write(source / "api", {"all": api.index(), **{name: api.page(*what) for name, what in api.PAGES.items()}})


def read_me() -> str:
    """README.md of the project: beside the packages in a checkout, else as the wheel carries it."""
    beside = Path(str(files("hil"))).parent / "README.md"
    return beside.read_text(encoding="utf-8") if beside.exists() else metadata("c2000-hil")["Description"]


def _contents() -> str:
    """The list at the side: the sections of `hil docs`, and what is made of data."""
    sections: dict[str, list[str]] = {}
    for page in PAGES.values():
        sections.setdefault(page.section, []).append(f"{_short(page)} <{page.path.with_suffix('')}>")
    parts = []
    for section, entries in sections.items():
        made = [f"{folder}/all" for folder in _MADE.get(section, ())]
        listed = "\n".join([*entries, *made])
        parts.append(f"\n```{{toctree}}\n:hidden:\n:caption: {section}\n\n{listed}\n```\n")
    return "".join(parts)


def _short(page: DocPage) -> str:
    """Its title in that list: of `faults: what breaks on purpose` the first word is enough."""
    heading = page.text().partition("\n")[0].removeprefix("# ")
    first = heading if page.section == BEGIN else heading.partition(":")[0]
    return first[0].upper() + first[1:]


def _write(folder: Path, pages: dict[str, str]) -> None:
    folder.mkdir(parents=True)
    for name, text in pages.items():
        (folder / f"{name}.md").write_text(text, encoding="utf-8")


def run_sphinx(source: Path, made: Path, trees: Path, extra: Path, progress: Callable[[str], None]) -> int:
    """Run Sphinx; returns the number of pages.  Raises ValueError with its warnings."""
    from pygments.lexers.special import TextLexer
    from sphinx.application import Sphinx
    from sphinx.highlighting import lexer_classes

    lexer_classes["csv"] = TextLexer
    warnings = io.StringIO()
    name = f"c2000-hil {version('c2000-hil')}"
    settings = {**SETTINGS, "release": version("c2000-hil"), "html_title": name, "html_extra_path": [str(extra)]}
    app = Sphinx(
        source, None, made, trees, "html", confoverrides=settings, status=None, warning=warnings, warningiserror=True,
        parallel=os.cpu_count() or 1,
    )  # fmt: skip
    app.connect("source-read", lambda app, name, text: progress(name))
    app.build()
    if app.statuscode or warnings.getvalue():
        raise ValueError(f"the site has warnings: {warnings.getvalue().strip()}".replace(f"{source}{os.sep}", ""))
    return len(app.env.found_docs)

