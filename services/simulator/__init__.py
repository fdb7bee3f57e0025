"""The simulator: aircraft as AMASE flies them, on its earth, in fixed steps, from scenario files.

`earth` measures, `performance` knows the airframes, `motion` moves, `guidance` steers, `aircraft` puts
one vehicle together, `world` plays a scenario, `server` opens it to others. Every step is a pure
function over plain values: the same scenario gives the same flight on every run.
"""
