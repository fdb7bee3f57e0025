"""A flight's log, held against the composed steps of authority that are proved (`spec.system.authority`)."""
