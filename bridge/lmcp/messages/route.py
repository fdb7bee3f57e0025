"""Messages of the series ROUTE; their types are in the stub of the same name."""

from cratous.bridge.lmcp.objects import members_of

__getattr__, __dir__ = members_of("ROUTE")
