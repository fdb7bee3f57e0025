"""The message classes by series, as Python modules with types that editors and mypy know.

    from cratous.bridge.lmcp.messages.cmasi import AirVehicleState, NavigationMode
    state = AirVehicleState(ID=400, Mode=NavigationMode.Waypoint)

These are the classes of `cratous.bridge.lmcp.types`, made from the models on first access.
"""
