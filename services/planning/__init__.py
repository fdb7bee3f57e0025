"""Planning: from a mission to a plan, as pure stages; `services.pipeline` runs them by messages."""
