"""The assumptions of the system theorems, monitored in the messages of a flight.

`listing` names each assumption and what depends on it; a watch records what was observed of those
that can be observed. A broken assumption violates no requirement by itself: it says for which of
them no theorem applies any more.
"""
