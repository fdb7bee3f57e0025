"""What authority over a vehicle means: gate, times of messages, right of way."""
