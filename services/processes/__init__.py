"""`cratous run --processes`: a mission flown by separate simulator, UxAS and ICAROUS processes."""
