"""From where pictures of a scene are seen, one after another."""
