"""Code Composer's `.cproject`: what it says of include folders and macros, and what is refused."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.c28x.readers.c.project import LARGEST_BYTES, CcsProject, read

TI = "com.ti.ccstudio.buildDefinitions.C2000_18.12.compilerID"


def text(folders: list[str], macros: list[str]) -> str:
    """A project with one configuration, as Code Composer writes it."""

    def values(kind: str, listed: list[str]) -> str:
        entries = "".join(f'<listOptionValue builtIn="false" value="{value}"/>' for value in listed)
        return f'<option id="{TI}.{kind}.1" superClass="{TI}.{kind}" valueType="stringList">{entries}</option>'

    options = values("INCLUDE_PATH", folders) + values("DEFINE", macros)
    return (
        '<?xml version="1.0" encoding="UTF-8" standalone="no"?>\n<?fileVersion 4.0.0?>'
        f'<cproject><storageModule><cconfiguration id="Debug">{options}</cconfiguration></storageModule></cproject>'
    )


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project called `lab` with a folder `include`."""
    folder = tmp_path / "lab"
    (folder / "include").mkdir(parents=True)
    return folder / ".cproject"


@pytest.mark.parametrize(
    "folder",
    [
        "include", "${PROJECT_ROOT}/include", "${ProjDirPath}/include", "${workspace_loc:/lab/include}",
        "${workspace_loc:/${ProjName}/include}", "&quot;${PROJECT_LOC}\\include&quot;",
    ],
)  # fmt: skip
def test_a_folder_of_the_project_is_an_include_folder(project: Path, folder: str) -> None:
    project.write_text(text([folder], []), encoding="utf-8")
    found = read(project)
    assert [Path(name) for name in found.include] == [(project.parent / "include").resolve()]
    assert found.notes == ()


@pytest.mark.parametrize("folder", ["${C2000WARE}/headers", "${workspace_loc:/other/include}", "nowhere"])
def test_what_is_not_known_here_is_left_out_with_a_note(project: Path, folder: str) -> None:
    project.write_text(text([folder, "include"], []), encoding="utf-8")
    found = read(project)
    assert len(found.include) == 1
    assert len(found.notes) == 1
    assert "left out" in found.notes[0]


def test_macros_keep_their_order_and_values(project: Path) -> None:
    project.write_text(text([], ["CPU1", "LAB=3", "${VARIANT}", "no name"]), encoding="utf-8")
    found = read(project)
    assert found.defines == ("CPU1", "LAB=3")
    assert [note.split("macro ")[1] for note in found.notes] == ["'${VARIANT}' is left out", "'no name' is left out"]


def test_the_first_configuration_that_says_anything_is_taken(project: Path) -> None:
    debug, release = text([], ["DEBUG"]), text([], ["RELEASE"])
    body = "".join(t.split("<storageModule>")[1].split("</storageModule>")[0] for t in (debug, release))
    project.write_text(f"<cproject><cconfiguration/>{body}</cproject>", encoding="utf-8")
    assert read(project).defines == ("DEBUG",)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("<cproject>", "not a project"),
        ("", "not a project"),
        ('<!DOCTYPE a [<!ENTITY b "bb"><!ENTITY c "&b;&b;">]><a>&c;</a>', "a DOCTYPE"),
        ("<!DOCTYPE a SYSTEM '/etc/passwd'><a/>", "a DOCTYPE"),
        ('<?xml version="1.0" encoding="nonsense"?><a/>', "not a project"),
        ("<a/>" + " " * LARGEST_BYTES, "has more than 2,000,000 bytes"),
    ],
)
def test_what_is_no_project_is_one_line(project: Path, content: str, message: str) -> None:
    project.write_text(content, encoding="utf-8")
    with pytest.raises(ValueError, match=message) as error:
        read(project)
    assert "\n" not in str(error.value)


@given(st.binary(max_size=300) | st.text(alphabet='<>/="&;![] abcproject', max_size=200).map(str.encode))
def test_any_bytes_are_a_project_or_one_error(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    path = tmp_path_factory.getbasetemp() / "any.cproject"
    path.write_bytes(content)
    with suppress(ValueError):
        assert isinstance(read(path), CcsProject)
