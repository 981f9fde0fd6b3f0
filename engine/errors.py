"""What can go wrong beyond bad input."""


class StepError(ArithmeticError):
    """A step gave a state that is not finite; the message names the body and the stage."""


class TooLarge(StepError):
    """A scene has more than its solver can solve at once; no body has moved."""
