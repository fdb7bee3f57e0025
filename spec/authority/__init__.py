"""Definitions of authority over a vehicle: gate, message times, right of way."""
