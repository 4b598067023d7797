"""A plug-in whose dependency is not installed."""

import acme_missing_dependency  # type: ignore[import-not-found]  # noqa: F401
