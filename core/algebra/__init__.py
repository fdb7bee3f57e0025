"""Process-algebra terms as data: which tasks of a term are done, and whether as it permits."""
