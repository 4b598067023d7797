"""What is wrong with the data of a route, or odd about them, as named findings."""

from vprbench.data_checks.checking import RouteCheck, check_route
from vprbench.data_checks.finding import Finding

__all__ = ["Finding", "RouteCheck", "check_route"]
