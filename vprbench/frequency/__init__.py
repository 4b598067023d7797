"""How many queries a second agents answer, by how many places they have learned.

`subjects` makes the memories, `filling` finds frames to fill them with, `rounds` times them by turns, `table` puts the
times into rows.
"""
