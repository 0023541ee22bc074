"""``hil docs``: the pages that come with it."""

from __future__ import annotations

import sys
from typing import Annotated

import typer
from rich.markdown import Markdown
from rich.table import Table

from hil.cli import show
from hil.docs import PAGES


def complete_page(incomplete: str) -> list[str]:
    """Shell completion of the names of pages."""
    return [name for name in PAGES if name.startswith(incomplete)]


def docs(
    page: Annotated[
        str | None, typer.Argument(metavar="[PAGE]", help="The name of a page.", autocompletion=complete_page)
    ] = None,
    markdown: Annotated[bool, typer.Option("--markdown", help="The text of the page as it was written.")] = False,
) -> None:
    """Show a page of the documentation; without a name, list all pages.

    [bold]Examples[/bold]

      hil docs

      hil docs language

      hil docs testing --markdown > testing.md
    """
    with show.user_errors():
        if page is None:
            table = Table(show_header=False, box=None)
            table.add_column(no_wrap=True, style="bold")
            table.add_column(overflow="fold")
            for name, known in PAGES.items():
                table.add_row(name, known.about)
            show.console().print(table)
            return
        if page not in PAGES:
            raise ValueError(f"no page {page!r}: one of {', '.join(PAGES)}")
        text = PAGES[page].text()
        if markdown:
            sys.stdout.write(text)
            return
        terminal = show.console()
        terminal.print(Markdown(text), width=min(terminal.width, 120))
