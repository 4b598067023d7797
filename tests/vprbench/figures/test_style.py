from __future__ import annotations

import subprocess
import sys
from itertools import combinations

import matplotlib
import numpy as np
import pytest

from vprbench.figures.style import COLOURS, agent_colours, caption, house_style, new_figure


def test_each_agent_keeps_its_colour_whatever_else_is_named_again() -> None:
    colours = agent_colours(["b", "a", "b", "c"])
    assert list(colours) == ["b", "a", "c"]
    assert colours == agent_colours(["b", "a", "c"])
    assert list(colours.values()) == list(COLOURS[:3])


def test_twenty_four_agents_differ() -> None:
    assert len(set(agent_colours(map(str, range(24))).values())) == 24


# Linear RGB as protanopes and deuteranopes see it: F. Vienot, H. Brettel, J. Mollon, "Digital video colourmaps for
# checking the legibility of displays by dichromats", Color Research and Application 1999.
DICHROMATS = {
    "protan": [[0.11238, 0.88762, 0], [0.11238, 0.88762, 0], [0.00401, -0.00401, 1]],
    "deutan": [[0.29275, 0.70725, 0], [0.29275, 0.70725, 0], [-0.02234, 0.02234, 1]],
}


def seen(colour: str, by: np.ndarray) -> np.ndarray:
    """Lightness and tints (CIE L*a*b*) of a colour as one with this dichromacy sees it."""
    from skimage.color import rgb2lab

    linear = np.array(matplotlib.colors.to_rgb(colour)) ** 2.2
    return np.asarray(rgb2lab(np.clip(by @ linear, 0, 1) ** (1 / 2.2)))


@pytest.mark.parametrize("kind", DICHROMATS)
def test_the_palette_stays_apart_for_the_colour_blind(kind: str) -> None:
    lab = [seen(colour, np.array(DICHROMATS[kind])) for colour in COLOURS]
    apart = min(np.linalg.norm(one - other) for one, other in combinations(lab, 2))
    # A difference of 2.3 is the least that is noticed; matplotlib's own first eight colours come down to 5.
    assert apart > 15


def test_the_style_is_the_houses_within_and_the_users_without() -> None:
    with matplotlib.rc_context({"axes.titlesize": 31, "lines.marker": "x"}):
        with house_style():
            assert matplotlib.rcParams["axes.titlesize"] != 31
            assert matplotlib.rcParams["lines.marker"] == "None"
            assert matplotlib.rcParams["svg.hashsalt"] == "vprbench"
        assert matplotlib.rcParams["axes.titlesize"] == 31
        assert matplotlib.rcParams["lines.marker"] == "x"


@pytest.mark.parametrize("width", [3.2, 6.5, 9.0])
def test_a_caption_stays_within_its_figure(width: float) -> None:
    with house_style():
        figure = new_figure(2.0, width)
        figure.add_subplot()
        caption(figure, "Mean width of words, however many there may be of them in such a line; " * 5)
        figure.draw_without_rendering()
        extent = figure._supxlabel.get_window_extent()  # type: ignore[attr-defined]
    assert extent.x0 >= 0
    assert 0.75 * figure.bbox.width < extent.width < figure.bbox.width - extent.x0


def run(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


def test_matplotlib_is_not_loaded_before_something_is_drawn() -> None:
    code = """if True:
        import sys
        import vprbench_encoders.hsd
        from vprbench.cli import main
        sys.argv = ["vprbench", "--help"]
        try:
            main()
        except SystemExit as end:
            assert not end.code
        assert "matplotlib" not in sys.modules
        """
    finished = run(code)
    assert finished.returncode == 0, finished.stderr
    assert "sweep" in finished.stdout


def test_without_matplotlib_the_extra_is_named() -> None:
    code = "import sys; sys.modules['matplotlib'] = None; import vprbench.figures.style"
    last = run(code).stderr.strip().splitlines()[-1]
    assert "ConfigError" in last
    assert "pip install 'vprbench[figures]'" in last
