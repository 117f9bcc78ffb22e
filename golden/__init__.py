"""What the right picture is: pure Python and numpy, never hardware.

Nothing in this folder imports the hardware description.  The hardware imports from here only the
shared specification: configuration, formats, the interlace of pixels over memory units, and the
words of the command stream.
"""
