"""What an assignment problem, its search steps and its lower bounds mean."""
