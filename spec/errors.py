"""The errors that users see: each states what happened, where, and what was expected and found."""

from __future__ import annotations


class CratousError(Exception):
    """Base of all errors that a user can act on. `exit_code` is the exit code of the command line."""

    exit_code = 2


class BadInput(CratousError):
    """Input that cannot be used.

    where: the file (and line) or text that contains it; item: path inside it, e.g. `vehicles[1].id`.
    """

    def __init__(
        self, what: str, *, where: str = "", item: str = "", expected: str = "", got: str = ""
    ) -> None:
        self.what, self.where, self.item = what, where, item
        self.expected, self.got = expected, got
        super().__init__(str(self))

    def __str__(self) -> str:
        place = ": ".join(part for part in (self.where, self.item) if part)
        text = f"{place}: {self.what}" if place else self.what
        if self.expected:
            text += f"; expected {self.expected}"
        if self.got:
            text += f"; got {self.got}"
        return text

    def data(self) -> dict[str, str]:
        """The same as a dictionary, for `--json`."""
        return {
            "error": self.what,
            "where": self.where,
            "item": self.item,
            "expected": self.expected,
            "got": self.got,
        }


class NoPlan(CratousError):
    """The input is well formed but no plan exists; `reasons` in the user's terms."""

    exit_code = 1

    def __init__(self, reasons: tuple[str, ...]) -> None:
        self.reasons = reasons
        super().__init__("no plan exists, because " + "; ".join(reasons))


class Refused(CratousError):
    """The product refuses to act, for example because a kernel's proof does not match its source."""

    exit_code = 2


class NotInstalled(CratousError):
    """A library of an optional part of the product is missing; `extra` names the extra that installs it."""

    def __init__(self, library: str, extra: str) -> None:
        self.library, self.extra = library, extra
        super().__init__(
            f"{library} is not installed; expected the extra {extra!r}: "
            f"pip install 'cratous[{extra}]'"
        )
