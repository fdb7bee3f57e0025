"""When a trajectory is permitted: no cylinder and no zone is entered at any instant."""
