"""The UxAS planning pipeline on messages: drivers of the proved kernels of `core.contracts`."""
