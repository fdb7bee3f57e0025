"""Order and timing of tasks: constraint rows and the earliest schedule under them."""
