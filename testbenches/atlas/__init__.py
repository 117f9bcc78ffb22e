"""All machines side by side: which organisation is fastest, or smallest, for which scene."""
