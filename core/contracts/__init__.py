"""The control logic of the planning services as transition kernels, without messages or clock."""
