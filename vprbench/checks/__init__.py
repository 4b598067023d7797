"""Conformance: what the protocols ask of a plug-in, as named checks.

In the tests of a plug-in, one decorator makes one test of each check::

    @parametrize_with_checks(encoder=MyEncoder)
    def test_my_encoder_conforms(check: Check) -> None:
        check.run()

`vprbench check NAME` runs the same checks on an installed plug-in, without any test.
"""

from vprbench.checks.check import Check, CheckFailed, DoesNotApply
from vprbench.checks.encoders import encoder_checks
from vprbench.checks.localizers import localizer_checks
from vprbench.checks.running import CheckResult, parametrize_with_checks, run_checks

__all__ = [
    "Check",
    "CheckFailed",
    "CheckResult",
    "DoesNotApply",
    "encoder_checks",
    "localizer_checks",
    "parametrize_with_checks",
    "run_checks",
]
