"""The figures of Ellsworth (1994), for our models and machines."""
