"""The error for impossible deliveries."""


class NeverSent(Exception):
    """The trace delivers a message that was never sent."""
