"""Who commands a vehicle: the actuator gate, timeliness of messages, right of way."""
