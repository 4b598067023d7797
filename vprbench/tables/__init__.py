"""Result tables: one metric of many cells pivoted (`make_table`), and written for people and programs."""

from vprbench.tables.formats import to_csv, to_latex, to_markdown, to_terminal
from vprbench.tables.model import Entry, Table
from vprbench.tables.pivot import make_table

__all__ = ["Entry", "Table", "make_table", "to_csv", "to_latex", "to_markdown", "to_terminal"]
