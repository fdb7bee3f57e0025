"""Planning: from a mission to a plan, as pure stages; `services.pipeline` drives them by messages."""
