"""All signatures of one memory have one size: an encoder that is fitted again may give others."""

from __future__ import annotations

from vprbench.errors import PluginError

__all__ = ["require_size"]


def require_size(size: int, stored: int) -> None:
    """Refuse signatures of another size than those stored.

    Raises:
        PluginError: they are.
    """
    if size != stored:
        raise PluginError(
            f"the encoder gives signatures of {size} values, the places stored have {stored}:"
            " clear them after fitting an encoder again"
        )
