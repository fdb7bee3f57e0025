"""`cratous run --processes`: a mission flown by simulator, UxAS and ICAROUS in processes of their own."""
