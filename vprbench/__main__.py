"""`python -m vprbench` is the command line."""

from vprbench.cli import main

main()
