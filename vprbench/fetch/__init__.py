"""Getting public data: the few files that a route needs, out of archives far larger.

From files to fetch: `archives` says which archive holds each, `addresses` where that archive is taken from, `http_file`
and `byte_source` read parts of it, `contents` says what it holds (and `names` which names spoil it), `plan` what of
that is not on disk yet, `ranges` in how few requests it can be had, and `extraction` writes it.
"""
