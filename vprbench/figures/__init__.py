"""Drawings, by matplotlib's objects alone: no pyplot, no display, nothing global but a style while it draws.

Raises:
    ConfigError: on import, where matplotlib is not installed.
"""

from importlib.util import find_spec

from vprbench.errors import ConfigError

if find_spec("matplotlib") is None:
    raise ConfigError("figures are drawn by matplotlib, which is not installed: pip install 'vprbench[figures]'")
