"""What UxAS has and we do not have yet, by name, so that it is told from a name that nobody knows."""

from __future__ import annotations

SERVICES = ("SteeringService",)
"""Services of UxAS that we do not have; a configuration that names one is warned, or refused if strict."""
