"""The control logic of the planning services as transition kernels: no messages, no clock."""
