"""Checks a flight's log against the proved composed steps of authority (`spec.system.authority`)."""
