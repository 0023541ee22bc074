"""``hil docs``: the documentation pages of the package."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.markdown import Markdown
from rich.table import Table
from rich.text import Text

from hil.cli import show
from hil.docs import PAGES


def complete_page(incomplete: str) -> list[str]:
    """Shell completion of the names of pages."""
    return [name for name in PAGES if name.startswith(incomplete)]


def docs(
    page: Annotated[
        str | None, typer.Argument(metavar="[PAGE]", help="The name of a page.", autocompletion=complete_page)
    ] = None,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print the source text of the page.")] = False,
    site: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Build a site of all pages, rules and commands (extra docs).")
    ] = None,
) -> None:
    """Show a page of the documentation; without a name, list all pages.

    [bold]Examples[/bold]
      hil docs
      hil docs language
      hil docs testing --markdown > testing.md

      hil docs --site site   (open site/index.html in a browser; no server, no network)
    """
    with show.user_errors():
        if site is not None:
            if page is not None or markdown:
                raise ValueError("--site is for all pages: leave out the page and --markdown")
            _site(site)
            return
        if page is None:
            show.console().print(_table())
            return
        if page not in PAGES:
            raise ValueError(f"no page {page!r}: one of {', '.join(PAGES)}")
        text = PAGES[page].text()
        if markdown:
            sys.stdout.write(text)
            return
        terminal = show.console()
        terminal.print(Markdown(text), width=min(terminal.width, 120))


def _table() -> Table:
    """The pages, by section."""
    table = Table(show_header=False, box=None)
    table.add_column(no_wrap=True, style="bold")
    table.add_column(overflow="fold")
    section = ""
    for name, known in PAGES.items():
        if known.section != section:
            section = known.section
            table.add_row(Text(f"{section}:", "dim"), "")
        table.add_row(name, known.about)
    return table


def _site(target: Path) -> None:
    from hil.docs.site.build import build

    with show.busy("the notebook") as told:
        count = build(target, told)
    show.print_line(f"{target / 'index.html'}: {count} pages")
