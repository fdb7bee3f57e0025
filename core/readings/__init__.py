"""How one kernel is read: compiled, enclosed in intervals, exactly, or tiered."""
