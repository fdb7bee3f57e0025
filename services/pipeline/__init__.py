"""The planning services of UxAS on the bus: they drive the proved kernels of `core.contracts`."""
