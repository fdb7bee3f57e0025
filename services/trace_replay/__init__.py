"""Replays authority traces on the real actors: gate, ICAROUS, UxAS end and executive, over real sockets."""
