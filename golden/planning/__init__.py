"""Which machine a scene needs, and machines for no scene in particular."""
