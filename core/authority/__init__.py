"""Who commands a vehicle: the actuator gate, messages in time, right of way."""
