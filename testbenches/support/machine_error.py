"""What a machine did wrong."""


class MachineError(RuntimeError):
    """The machine answered something it should not have, or nothing.

    >>> import cardcage
    >>> raise cardcage.MachineError("the machine hangs")
    Traceback (most recent call last):
    cardcage.testbenches.support.machine_error.MachineError: the machine hangs
    """
