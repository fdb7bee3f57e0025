"""Number types for options that refuse NaN, which click accepts, even for ranges."""

from __future__ import annotations

import math
from typing import Any

import click
from click.types import FloatParamType


class AnyNumber(FloatParamType):
    """A number."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        number = super().convert(value, param, ctx)
        if math.isnan(number):
            self.fail(f"{value!r} is not a number.", param, ctx)
        return number


class Number(AnyNumber, click.FloatRange):
    """A number in a range."""
