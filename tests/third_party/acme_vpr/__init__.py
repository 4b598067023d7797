"""A third party's plug-ins for vprbench."""

ANSWER = 42
