"""Traces of authority played on the actors that fly: gate, ICAROUS, UxAS's end and executive, over real sockets."""
