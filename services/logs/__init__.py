"""Message logs: one SQLite schema, readers and writers of other formats, selection and replay.

`store` writes a log while messages arrive, `sqlite_log` reads it, `source` opens a log of any
format, `select` picks messages, `export` writes other formats, `replay` sends them again at any
rate.
"""
