"""What no actor can be given."""


class NeverSent(Exception):
    """The trace delivers a message that was never sent."""
