"""The assignment of tasks to vehicles: kernels of its steps, and the search that calls them."""
