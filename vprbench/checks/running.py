"""The two ways to run checks: as tests under pytest, and on an installed plug-in by its name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from vprbench.agents import Config, build, build_encoder, normalise, validate
from vprbench.checks.check import Check, DoesNotApply
from vprbench.checks.encoders import encoder_checks
from vprbench.checks.localizers import localizer_checks
from vprbench.errors import PluginError, VprbenchError
from vprbench.options import parameters
from vprbench.plugins import Kind, find, one_line, plugins
from vprbench.protocols import Encoder, Localizer

if TYPE_CHECKING:
    import pytest

__all__ = ["CheckResult", "parametrize_with_checks", "run_checks"]


@dataclass(frozen=True)
class CheckResult:
    """What came of one check.

    Attributes:
        name: of the check.
        fault: what is wrong, in one line; None if nothing is.
        inapplicable: why the check does not apply to this plug-in; None if it does.
    """

    name: str
    fault: str | None = None
    inapplicable: str | None = None


def parametrize_with_checks(
    *, encoder: Callable[[], Encoder] | None = None, localizer: Callable[[], Localizer] | None = None
) -> pytest.MarkDecorator:
    """A decorator that makes one test of each check of an encoder or a localizer.

    The test takes an argument `check` and runs it. Give one factory that needs no argument.
    """
    import pytest

    if (encoder is None) == (localizer is None):
        raise TypeError("parametrize_with_checks takes either encoder= or localizer=")
    checks = list(encoder_checks(encoder) if encoder else localizer_checks(localizer) if localizer else [])
    return pytest.mark.parametrize("check", checks, ids=[check.name for check in checks])


def run_checks(kind: Kind, config: Config, encoder: Config | None = None) -> list[CheckResult]:
    """The outcome of every check of an installed plug-in, given by name or as a table with options.

    A localizer that must look through an encoder gets `encoder`, by default the first that loads.

    Raises:
        ConfigError: the name or an option is unknown.
        PluginError: the plug-in does not load, or no encoder does.
    """
    table = normalise(config, kind)
    if kind == "encoder":
        validate(table, kind)
        checks = encoder_checks(partial(build_encoder, table))
    else:
        table |= _encoder_option(table, encoder)
        validate(table)
        checks = localizer_checks(partial(build, table))
    return [_outcome(check) for check in checks]


def _encoder_option(table: dict[str, Any], encoder: Config | None) -> dict[str, Config]:
    """The option `encoder` to add to a localizer's table, if any."""
    if encoder is not None:
        return {"encoder": encoder}
    option = parameters(find("localizer", table["localizer"]).load()).get("encoder")
    if option is None or option.default is not option.empty or "encoder" in table:
        return {}
    for plugin in plugins("encoder").values():
        if plugin.fault() is None:
            return {"encoder": plugin.name}
    raise PluginError(f"{table['localizer']} looks through an encoder, and none of those installed loads")


def _outcome(check: Check) -> CheckResult:
    try:
        check.run()
    except DoesNotApply as reason:
        return CheckResult(check.name, inapplicable=str(reason))
    except VprbenchError as error:
        return CheckResult(check.name, str(error))
    except Exception as error:
        return CheckResult(check.name, f"raised {one_line(error)}")
    return CheckResult(check.name)
