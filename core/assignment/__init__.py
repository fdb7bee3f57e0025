"""Assignment of tasks to vehicles: the kernels of its steps, and the search that calls them."""
