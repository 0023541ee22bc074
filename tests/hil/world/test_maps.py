"""Maps: the built-in ones, the format, and one clear line for every fault."""

from __future__ import annotations

import pickle
from math import pi
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hil.world import MapError, SonarRays, builtin_maps, load_map
from hil.world.maps import _MapReader, parse_map

GOOD = """
name = "lab"
[start]
x_m = 1
y_m = 0.5
heading_deg = 90
[floor]
grip = 0.5
[[wall]]
points_m = [[0, 0], [3, 0], [3, 2]]
closed = true
[[post]]
x_m = 2.0
y_m = 0.8
diameter_m = 0.1
"""


def test_a_good_map_is_read_as_written() -> None:
    lab = parse_map(GOOD)
    assert (lab.name, lab.grip, lab.start) == ("lab", 0.5, (1.0, 0.5, pi / 2))
    ends = [(w.ax, w.ay, w.bx, w.by) for w in lab.walls]
    assert ends == [(0, 0, 3, 0), (3, 0, 3, 2), (3, 2, 0, 0)]
    (post,) = lab.posts
    assert (post.x_m, post.y_m, post.radius_m, post.name) == (2.0, 0.8, 0.05, "post[0]")
    assert lab.bounds() == (0.0, 0.0, 3.0, 2.0)


def test_the_built_in_maps_all_load() -> None:
    assert builtin_maps() == ["box", "corridor", "paddock", "room"]
    for name in builtin_maps():
        assert load_map(name).name == name
        assert load_map(name).description


MOVED = 'path_m = [[2.0, 0.8], [2.0, 1.2]]\nspeed_m_s = 0.2\nfrom_s = 1.5\nand_back = true\n'


def test_a_copy_for_another_process_is_the_same_map() -> None:
    lab = parse_map(GOOD + MOVED)
    copy = pickle.loads(pickle.dumps(lab))
    assert repr(copy.walls) == repr(lab.walls)
    assert len(lab.movers) == 1
    assert copy.movers == lab.movers
    assert copy.bounds() == lab.bounds()
    x_m, y_m = 1.0, 0.5
    assert copy.room(x_m, y_m) == lab.room(x_m, y_m)
    assert [post.name for post in copy.posts] == [post.name for post in lab.posts]


def test_a_fence_has_a_post_at_each_corner_and_the_same_step_on_all_of_a_side() -> None:
    # Sides of 1 m, 0.5 m and the way back of 1.118 m, a post about every 0.3 m: 3, 2 and 4 steps.
    fence = "[[fence]]\npoints_m = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]]\nevery_m = 0.3\ndiameter_m = 0.1\n"
    posts = parse_map('name = "x"\n[start]\nx_m = 5\ny_m = 5\n' + fence).posts
    assert len(posts) == 3 + 2 + 4
    assert [p.x_m for p in posts[:6]] == pytest.approx([0, 1 / 3, 2 / 3, 1, 1, 1])
    assert [p.y_m for p in posts[:6]] == pytest.approx([0, 0, 0, 0, 0.25, 0.5])
    assert (posts[8].x_m, posts[8].y_m) == pytest.approx((0.25, 0.125))
    assert {p.radius_m for p in posts} == {0.05}
    assert len({p.name for p in posts}) == 9


def test_the_box_shows_the_distances_of_the_thesis_example() -> None:
    # TFG figure 15: dF 650, dR 1922, dL 427 mm
    box = load_map("box")
    rays = SonarRays(box.walls)
    for name, want in (("FRONT", 0.650), ("LEFT", 0.427), ("RIGHT", 1.922)):
        echo = rays.echo(name, box.start)
        assert echo is not None
        assert echo == (pytest.approx(want, abs=1e-9), 1.0)


def changed(old: str, new: str) -> str:
    assert old in GOOD
    return GOOD.replace(old, new)


@pytest.mark.parametrize(
    ("text", "key", "right"),
    [
        (changed('name = "lab"', ""), "name: missing", 'give name = "..."'),
        (changed('name = "lab"', "name = 3"), "name: 3 is not a text", 'give name = "..."'),
        (changed('name = "lab"', 'name = "lab"\nwals = 1'), "wals: unknown key", "use name, description, start"),
        (changed("[start]", "[begin]"), "begin: unknown key", "start"),
        ('name = "x"\n[[wall]]\npoints_m=[[0,0],[1,0]]', "start: missing", "give [start]"),
        ('name = "x"\nstart = 3\n[[wall]]\npoints_m=[[0,0],[1,0]]', "start: 3 is not a table", "[start]"),
        ('name = "x"\n[start]\nx_m=0\ny_m=0', "wall: the world is empty", "[[wall]]"),
        (changed("x_m = 1\n", ""), "start.x_m: missing", "give a number"),
        (changed("x_m = 1\n", 'x_m = "1"\n'), "start.x_m: '1' is not a number", "give a number from -1000 to 1000"),
        (changed("x_m = 1\n", "x_m = true\n"), "start.x_m: True is not a number", "give a number"),
        (changed("x_m = 1\n", "x_m = nan\n"), "start.x_m: nan is out of range", "-1000 to 1000"),
        (changed("x_m = 1\n", "x_m = inf\n"), "start.x_m: inf is out of range", "-1000 to 1000"),
        (changed("heading_deg = 90", "heading = 90"), "start.heading: unknown key", "heading_deg"),
        (changed("heading_deg = 90", "heading_deg = 361"), "start.heading_deg: 361 is out of range", "-360 to 360"),
        (changed("grip = 0.5", "grip = 0"), "floor.grip: 0 is out of range", "0.01 to 2"),
        (changed("x_m = 1\ny_m = 0.5", "x_m = 2.95\ny_m = 1.0"), "start: the robot would stand in a", "0.125 m free"),
        (changed("x_m = 1\ny_m = 0.5", "x_m = 2.0\ny_m = 0.8"), "start: the robot would stand in a wall", "free"),
        (changed("y_m = 0.5", "y_m = 1.5"), "start: (1, 1.5) lies outside the closed wall", "x_m from 0 to 3"),
        (changed("x_m = 1\ny_m = 0.5", "x_m = -9\ny_m = 0.5"), "start: (-9, 0.5) lies outside", "y_m from 0 to 2"),
        (changed("[3, 2]]", "[3]]"), "wall[0].points_m[2]: [3] is not a point", "give [x, y]"),
        (changed("[3, 2]]", "[3, nan]]"), "wall[0].points_m[2][1]: nan is out of range", "give a number"),
        (changed("[3, 2]]", '[3, "2"]]'), "wall[0].points_m[2][1]: '2' is not a number", "give a number"),
        (changed("[3, 2]]", "[3, 0]]"), "wall[0].points_m[2]: the same point twice", "remove one"),
        (changed("[[0, 0], [3, 0], [3, 2]]", "[[0, 0]]"), "wall[0].points_m: [[0, 0]] is not a polyline", "two [x, y]"),
        (changed("[[0, 0], [3, 0], [3, 2]]", "[[0, 0], [3, 0]]"), "wall[0].points_m: a closed wall of two", "three"),
        (changed("points_m", "points"), "wall[0].points: unknown key", "points_m"),
        (changed("closed = true", "closed = 1"), "wall[0].closed: 1 is not a truth value", "true or false"),
        (changed("closed = true", 'material = "fur"'), "wall[0].material: 'fur' is unknown", "smooth"),
        (changed("diameter_m = 0.1", "diameter_m = 0"), "post[0].diameter_m: 0 is out of range", "0.001 to 10"),
        (changed("diameter_m = 0.1", ""), "post[0].diameter_m: missing", "0.001 to 10"),
        (GOOD + "[[fence]]\npoints_m = [[0, 0], [1, 0]]\nevery_m = 0.1", "fence[0].diameter_m: missing", "0.001 to 10"),
        (GOOD + "[[fence]]\npoints_m = [[0, 0], [900, 0]]\nevery_m = 0.1\ndiameter_m = 0.05",
         "fence[0].every_m: more than 1000 posts", "further apart"),
        ('name = "x"\nwall = 3\n[start]\nx_m=0\ny_m=0', "wall: 3 is not a list of tables", "[[wall]]"),
        ('name = "x"\nwall = [3]\n[start]\nx_m=0\ny_m=0', "wall[0]: 3 is not a table", "[[wall]]"),
    ],
)
def test_every_fault_is_one_line_with_file_key_and_what_would_be_right(text: str, key: str, right: str) -> None:
    with pytest.raises(MapError) as caught:
        parse_map(text, "lab.toml")
    message = str(caught.value)
    assert message.startswith(f"lab.toml: {key}")
    assert right in message
    assert "\n" not in message


def test_what_is_no_toml_says_the_line() -> None:
    with pytest.raises(MapError, match=r"^lab.toml:1: not TOML: .*; see the map format") as caught:
        parse_map("name = ", "lab.toml")
    assert "\n" not in str(caught.value)


def test_an_unknown_name_lists_the_maps_and_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(MapError, match=r"hall: no built-in map .* use one of box, corridor, paddock, room"):
        load_map("hall")
    with pytest.raises(MapError, match=r"none.toml: cannot be read"):
        load_map(tmp_path / "none.toml")
    with pytest.raises(MapError, match=r"not a plain file"):
        load_map(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b'name = "\xe9"')
    with pytest.raises(MapError, match=r"latin.toml: byte 8 is not UTF-8"):
        load_map(tmp_path / "latin.toml")


def test_a_map_file_is_found_by_path_even_with_a_built_in_name(tmp_path: Path) -> None:
    (tmp_path / "box.toml").write_text(GOOD)
    assert load_map(tmp_path / "box.toml").name == "lab"
    assert load_map(str(tmp_path / "box.toml")).name == "lab"


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=6), inner, max_size=4),
    max_leaves=6,
)


@settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    table=st.dictionaries(
        st.sampled_from(["name", "start", "floor", "wall", "post", "description", "x"]), VALUES, max_size=6
    )
)
def test_any_nonsense_is_a_map_error_and_nothing_else(table: dict[str, object]) -> None:
    with pytest.raises(MapError, match=r"\Af: [^\n]+\Z"):
        _MapReader("f").read(table)


@given(text=st.text(max_size=200))
def test_any_text_is_a_map_or_a_map_error(text: str) -> None:
    with pytest.raises(MapError):
        parse_map(text)


def test_a_closed_wall_that_something_stands_outside_of_is_no_border() -> None:
    island = changed("x_m = 1\ny_m = 0.5", "x_m = -1\ny_m = 0.5") + "\n[[wall]]\npoints_m = [[-5, -5], [-5, 5]]\n"
    assert parse_map(island).start[0] == -1.0
