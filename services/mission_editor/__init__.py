"""Editor of a mission file: changes of its text, its content, and a plan for it."""
