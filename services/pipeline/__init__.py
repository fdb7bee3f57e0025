"""The planning services of UxAS on the bus: drivers of the proved kernels of `core.contracts`."""
