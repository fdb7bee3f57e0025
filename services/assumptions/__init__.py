"""The assumptions of the system theorems, watched in the messages of a flight.

`listing` says which there are and what rests on each; a watch keeps what was seen of those that can be. An
assumption that is broken violates no requirement by itself: it says for which of them no theorem speaks any more.
"""
