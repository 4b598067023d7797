"""The paper's quantitative claims, judged by what was measured (`evaluate`); claims.toml lists them."""

from vprbench.claims.evaluate import count_verdicts, evaluate
from vprbench.claims.model import Claim, Claims, load_claims
from vprbench.claims.rules import RULES, VERDICTS

__all__ = ["RULES", "VERDICTS", "Claim", "Claims", "count_verdicts", "evaluate", "load_claims"]
