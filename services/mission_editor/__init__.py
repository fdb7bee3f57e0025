"""A mission file being edited: changes of its text, what it says, and a plan of it."""
