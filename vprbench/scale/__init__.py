"""What a query, a place and learning cost as a map grows to the size of a city.

`city` makes places, `held` weighs memories, `growth` fills and times one agent, `table` writes the rows.
"""
