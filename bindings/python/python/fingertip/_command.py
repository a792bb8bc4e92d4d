"""The command `fingertip`, as it comes with the package."""

from __future__ import annotations

import sys

from fingertip import _native


def main(arguments: list[str] | None = None) -> int:
    """Run the command as a shell would. It listens to Ctrl-C itself, in Python's place.

    Parameters
    ----------
    arguments : list of str, optional
        Behind the name of the command; those of this process by default.

    Returns
    -------
    int
        Its exit code.
    """
    given = sys.argv[1:] if arguments is None else arguments
    return _native.run_command(["fingertip", *given])


if __name__ == "__main__":
    sys.exit(main())
