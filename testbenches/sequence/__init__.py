"""Pictures that one machine draws one after another."""
