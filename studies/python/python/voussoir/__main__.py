"""The command line: `voussoir`, or `python -m voussoir`."""

import sys

from . import _voussoir


def main() -> None:
    """Runs the command of the process arguments and exits with its exit code."""
    sys.stdout.flush()
    sys.exit(_voussoir.main(sys.argv[1:]))


if __name__ == "__main__":
    main()
