"""The simulator: aircraft with AMASE's flight behaviour, on its earth model, in fixed steps, from scenario
files.

`earth` computes distances, `performance` models airframes, `motion` moves, `guidance` steers, `aircraft`
combines these for one vehicle, `world` plays a scenario, `server` opens it to clients. Every step is a pure
function over plain values: the same scenario gives the same flight on every run.
"""
