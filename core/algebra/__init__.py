"""Terms of the process algebra as data: which tasks of one are done, and whether as it permits."""
