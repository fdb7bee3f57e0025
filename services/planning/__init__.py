"""Planning: from a mission to a plan, as pure stages and as the UxAS pipeline on the bus."""

from cratous.services.planning.plan import make_plan

__all__ = ["make_plan"]
