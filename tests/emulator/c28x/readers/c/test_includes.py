"""Headers: found whatever their case, and only below the folders that were named."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from emulator.c28x.readers.c.preprocessor import Limits, PreprocessorOptions, preprocess
from emulator.c28x.symbols import SourceError


def write(folder: Path, **files: str) -> Path:
    for name, text in files.items():
        path = folder / name.replace("__", "/").replace("_c", ".c").replace("_h", ".h")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def out(path: Path, **options: object) -> str:
    return " ".join(token.text for token in preprocess(path, PreprocessorOptions(**options)).tokens)  # type: ignore[arg-type]


def refused(path: Path, **options: object) -> str:
    with pytest.raises(SourceError) as error:
        out(path, **options)
    return str(error.value).replace(str(path.parent), "DIR")


def test_case_does_not_matter_and_both_slashes_part_a_path(tmp_path: Path) -> None:
    write(tmp_path, a_c='#include "INC\\Device.h"\n#include "inc/device.H"\n', Inc__deVice_h="x")
    assert out(tmp_path / "a.c") == "x x"


def test_the_exact_name_wins(tmp_path: Path) -> None:
    write(tmp_path, a_c='#include "x.h"\n#include "X.h"\n', x_h="small", X_h="large")
    if len(os.listdir(tmp_path)) == 2:
        pytest.skip("the file system is case-blind itself")
    assert out(tmp_path / "a.c") == "small large"


def test_quotes_begin_beside_the_file_that_asks_and_brackets_with_the_folders(tmp_path: Path) -> None:
    write(tmp_path / "src", a_c='#include "x.h"\n#include <x.h>\n#include "sub/y.h"\n', x_h="beside")
    write(tmp_path / "src", sub__y_h='#include "z.h"\n#include "x.h"', sub__z_h="z", sub__x_h="sub")
    write(tmp_path / "inc", x_h="folder")
    assert out(tmp_path / "src" / "a.c", include=[tmp_path / "inc"]) == "beside folder z sub"


def test_headers_of_ours_come_first_asked_for_in_lower_case(tmp_path: Path) -> None:
    write(tmp_path, a_c="#include <Ti\\STDINT.h>\n", ti__stdint_h="theirs")
    assert out(tmp_path / "a.c", builtin={"ti/stdint.h": "ours"}.get) == "ours"


def test_a_header_of_c_itself_gives_way_to_a_file_beside_in_quotes(tmp_path: Path) -> None:
    write(tmp_path, a_c='#include "limits.h"\n#include <limits.h>\n#include "dev.h"\n', limits_h="mine", dev_h="mine")
    write(tmp_path, sub__b_c='#include "limits.h"\n')
    ours = {"limits.h": "C", "dev.h": "ours"}.get
    assert out(tmp_path / "a.c", builtin=ours, standard="limits.h".__eq__) == "mine C ours"
    assert out(tmp_path / "sub" / "b.c", builtin=ours, standard="limits.h".__eq__, include=[tmp_path]) == "C"


def test_a_place_shows_the_folder_as_it_was_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path, src__a_c='\n#include "B.h"\n', inc__b_h=" b")
    monkeypatch.chdir(tmp_path)
    unit = preprocess("src/a.c", PreprocessorOptions(include=["inc"]))
    assert str(unit.tokens[0].where) == os.path.join("inc", "b.h") + ":1:2"
    assert sorted(source.file for source in unit.files.values()) == [
        os.path.join("inc", "b.h"), os.path.join("src", "a.c"),
    ]  # fmt: skip


def test_a_header_that_is_nowhere_is_named_with_what_to_do(tmp_path: Path) -> None:
    write(tmp_path, a_c='int a;\n  #include "nowhere.h"\n')
    assert refused(tmp_path / "a.c") == ("DIR/a.c:2:12: there is no header nowhere.h: name its folder with -I FOLDER")


def test_a_computed_name_is_expanded(tmp_path: Path) -> None:
    write(tmp_path, a_c="#define N(x) <x.h>\n#define M N(b)\n#include M\n", b_h="b")
    assert out(tmp_path / "a.c") == "b"


def test_a_way_to_a_copy_of_a_device_header_leads_to_ours(tmp_path: Path) -> None:
    text = '#include "../base/F28x_Project.h"\n#include "inc\\f2837xs_device.h"\n#include "inc/b.h"\n'
    write(tmp_path, a_c=text, inc__b_h="b")
    ours = {"f28x_project.h": "project", "f2837xs_device.h": "device", "b.h": "no"}.get
    assert out(tmp_path / "a.c", builtin=ours) == "project device b"


def test_once_is_once(tmp_path: Path) -> None:
    write(tmp_path, a_c='#include "b.h"\n#include "B.H"\n#include "o.h"\n#include "O.h"', b_h="#pragma once\nb")
    assert out(tmp_path / "a.c", builtin={"o.h": "#pragma once\no"}.get) == "b o"


def test_up_and_down_into_a_named_folder_is_allowed(tmp_path: Path) -> None:
    write(tmp_path, src__a_c='#include "../INC/b.h"\n', inc__b_h="b")
    assert out(tmp_path / "src" / "a.c", include=[tmp_path / "inc"]) == "b"


@pytest.mark.parametrize("name", ['"/etc/hostname"', "<../../secret.h>", '"..\\secret.h"', '"C:\\secret.h"', '"/"'])
def test_what_leaves_the_folders_is_refused_whether_it_is_there_or_not(tmp_path: Path, name: str) -> None:
    write(tmp_path, src__a_c=f"#include {name}\n", secret_h="secret")
    assert refused(tmp_path / "src" / "a.c").endswith(" leaves the include path: name its folder with -I FOLDER")


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="no links on this system")
def test_a_link_is_resolved_before_it_is_checked(tmp_path: Path) -> None:
    write(
        tmp_path, src__a_c='#include "link.h"\n', src__b_c='#include "way/secret.h"\n', secret_h="secret", src__r_h="r"
    )
    source = tmp_path / "src"
    (source / "link.h").symlink_to(tmp_path / "secret.h")
    (source / "way").symlink_to(tmp_path)
    (source / "c.c").symlink_to(tmp_path / "secret.h")
    (source / "d.c").write_text('#include "fine.h"\n')
    (source / "fine.h").symlink_to(source / "r.h")
    assert "a.c:1:10: link.h is a link to " in refused(source / "a.c")
    assert "is a link that leaves the include path" in refused(source / "b.c")
    assert "outside its folder: name that folder with -I" in refused(source / "c.c")
    assert out(source / "d.c") == "r"
    assert out(source / "a.c", include=[tmp_path]) == "secret"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes on this system")
def test_only_regular_files_are_opened(tmp_path: Path) -> None:
    write(tmp_path, a_c='#include "pipe.h"\n', b_c='#include "folder.h"\n')
    os.mkfifo(tmp_path / "pipe.h")
    (tmp_path / "folder.h").mkdir()
    assert refused(tmp_path / "a.c") == "DIR/a.c:1:10: DIR/pipe.h is not a regular file"
    assert refused(tmp_path / "b.c") == "DIR/b.c:1:10: DIR/folder.h is not a regular file"
    assert refused(tmp_path / "pipe.h") == "DIR/pipe.h:1: DIR/pipe.h is not a regular file"
    assert "cannot be read" in refused(tmp_path / "absent.c")


def test_a_file_has_its_size(tmp_path: Path) -> None:
    write(tmp_path, a_c="/*" + "*" * 2000 + "*/")
    assert refused(tmp_path / "a.c", limits=Limits(file_bytes=1000)).endswith("has more than 1,000 bytes")


def test_a_file_in_utf_16_is_refused_by_that_name(tmp_path: Path) -> None:
    (tmp_path / "a.c").write_bytes("int x;\n".encode("utf-16"))
    with pytest.raises(SourceError, match=r"a\.c is UTF-16: save it as UTF-8"):
        preprocess(tmp_path / "a.c")


def test_a_file_that_is_not_utf_8_is_latin_1(tmp_path: Path) -> None:
    (tmp_path / "a.c").write_bytes('char *s = "año";'.encode("latin-1"))
    assert out(tmp_path / "a.c") == 'char * s = "año" ;'


def test_a_file_that_includes_itself_ends_with_the_place(tmp_path: Path) -> None:
    write(tmp_path, a_c='x\n#include "a.c"\n')
    assert refused(tmp_path / "a.c") == "DIR/a.c:2:10: #include nested deeper than 64: does a.c include itself?"


def test_files_that_include_one_another_twice_end_by_the_number_of_files(tmp_path: Path) -> None:
    # 2^20 files without the limit.
    for number in range(20):
        write(tmp_path, **{f"f{number}_h": f'#include "f{number + 1}.h"\n' * 2})
    write(tmp_path, f20_h="", a_c='#include "f0.h"\n')
    assert refused(tmp_path / "a.c").endswith("more than 5,000 files are included")


def test_a_header_that_a_project_makes_gives_way_to_the_users_own_of_that_name(tmp_path: Path) -> None:
    def made(name: str) -> str | None:
        return "made\n" if name == "parts.h" else None

    (tmp_path / "a.c").write_text('#include "parts.h"\n')
    options = PreprocessorOptions(fallback=made)
    assert [token.text for token in preprocess(tmp_path / "a.c", options).tokens] == ["made"]
    (tmp_path / "Parts.h").write_text("own\n")
    assert [token.text for token in preprocess(tmp_path / "a.c", options).tokens] == ["own"]
