"""Reports: everything that a sweep left, on one page that a person wants to open.

Raises:
    ConfigError: on import, where Jinja is not installed.
"""

from importlib.util import find_spec

from vprbench.errors import ConfigError

if find_spec("jinja2") is None:
    raise ConfigError("reports are written by jinja2, which is not installed: pip install 'vprbench[report]'")
