from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import cv2
import matplotlib
import numpy as np
import pytest

from vprbench.errors import DataError
from vprbench.figures.files import save_figure
from vprbench.figures.style import caption, house_style, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def example() -> Figure:
    """A drawing of every kind of thing: lines, marks, a picture, clipping, words."""
    with house_style():
        figure = new_figure(2.0, 3.0)
        left, right = figure.subplots(1, 2)
        left.plot([0, 1, 2], [0, 1, 0], marker="o", label="a line")
        left.legend()
        right.imshow(np.arange(12.0).reshape(3, 4), cmap="gray")
        caption(figure, "Every kind of thing.")
    return figure


def test_equal_figures_give_equal_bytes_whatever_the_users_style(tmp_path: Path) -> None:
    first = save_figure(example(), tmp_path / "one", "figure")
    with matplotlib.rc_context({"svg.fonttype": "none", "savefig.dpi": 40, "svg.hashsalt": None, "font.size": 20}):
        second = save_figure(example(), tmp_path / "two", "figure")
    again = save_figure(example(), tmp_path / "one", "figure")
    for one, two, three in zip(first, second, again, strict=True):
        assert one.read_bytes() == two.read_bytes() == three.read_bytes()
    assert sorted(file.name for file in (tmp_path / "one").iterdir()) == ["figure.png", "figure.svg"]


def test_a_figure_that_is_saved_twice_stays_as_it_was(tmp_path: Path) -> None:
    figure = example()
    first = [file.read_bytes() for file in save_figure(figure, tmp_path, "a")]
    assert [file.read_bytes() for file in save_figure(figure, tmp_path, "a")] == first


def test_the_picture_has_two_hundred_pixels_an_inch(tmp_path: Path) -> None:
    picture = cv2.imread(str(save_figure(example(), tmp_path, "a").png))
    assert picture is not None
    assert picture.shape[:2] == (400, 600)
    assert picture.std() > 10


def test_the_drawing_needs_no_other_file_and_no_font(tmp_path: Path) -> None:
    text = save_figure(example(), tmp_path, "a").svg.read_text()
    root = ElementTree.fromstring(text)
    links = [value for node in root.iter() for name, value in node.attrib.items() if name.endswith("href")]
    assert links
    assert all(link.startswith(("#", "data:image/png;base64,")) for link in links)
    assert not re.search(r"url\((?!#)|@import|@font-face", text)
    assert not list(root.iter("{http://www.w3.org/2000/svg}text"))
    assert "<dc:date>" not in text


def test_where_nothing_can_be_written_the_place_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(DataError, match=r"file.*'a'"):
        save_figure(example(), tmp_path / "file", "a")
