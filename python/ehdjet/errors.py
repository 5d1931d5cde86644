"""What ehdjet raises. The texts are those of the command."""


class InputError(ValueError):
    """A scene, an argument or a file is wrong; nothing has run. The text names file, line, key, value, unit and
    allowed range, as far as they apply."""


class RunError(RuntimeError):
    """A run failed. The text says when, at which bead and because of which force, and where the results up to
    then are."""


class ContractViolation(RuntimeError):
    """A bug in ehdjet."""
